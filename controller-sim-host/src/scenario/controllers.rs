//! A `[[controller]]` as it is read, and as events change it.

use super::adrc;
use super::compensators;
use super::designs;
use super::fault::{Fault, code};
use super::log::Log;
use super::pid::PidDraft;
use super::places::Places;
use super::plants::Plant;
use super::sections::{alarms, anti_windup, fallback, limits, mode, range, setpoint, take, take_optional};
use super::table::Table;
use super::value::shortened;
use super::{CompensatorSpec, ControllerSpec};
use controller_core::{ControllerConfig, Mode, Param};
use controller_design::model::TransferFunction;
use std::ops::Range;

const PID: &str = "`pid = { kp = 1.0, ki = 0.5 }`";
const LIMITS: &str = "`limits = { lo = 0.0, hi = 100.0 }`";
const SETPOINT: &str = "`setpoint = { lo = 0.0, hi = 100.0 }`";
const SETPOINT_LIMITS: &str = "`setpoint_limits = { lo = 0.0, hi = 100.0 }`";
const ANTI_WINDUP: &str = "`anti_windup = { rule = \"back-calculation\" }`";
const SECONDARY: &str = "`[controller.secondary]` and below it `pid = { kp = 1.0, ki = 0.5 }`";
const RANGE: &str = "`{ lo = 0.0, hi = 100.0 }`";

/// The keys of an event that change parameters, in the order they are read.
pub(super) const PARAMETER_KEYS: [&str; 8] =
    ["pid", "adrc", "limits", "setpoint_limits", "anti_windup", "deadband", "estimator", "observer"];

/// Longest name: it heads the lines of tables.
const LONGEST_NAME: usize = 60;

/// A controller as far as it was read, with the places of its parameters.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    pid: PidDraft,
    spec: ControllerSpec,
    /// The name and where it is; none when it is missing or wrong.
    pub(super) name_span: Option<Range<usize>>,
    pub(super) places: Places,
    /// The loop inside of a cascade, and where its key is.
    pub(super) secondary: Option<(Box<Draft>, Range<usize>)>,
    /// What its parameters are to be designed from.
    wish: Option<designs::Wish>,
}

impl Draft {
    /// Reads a controller. It comes back whole even with faults, so that the rest can be checked, too.
    pub(super) fn read(table: Table<'_>) -> Self {
        let (name, name_span) = read_name(&table);
        let mode = mode(&table).unwrap_or(Mode::Auto);
        let secondary = table.table("secondary", SECONDARY).map(|part| {
            let place = table.key_span("secondary").unwrap_or(part.place.clone());
            (Box::new(Self::read_secondary(part, &name)), place)
        });
        if let Some((_, place)) = &secondary {
            refuse_compensator(&table, place);
        }
        let mut draft = Self { name_span, secondary, ..Self::read_law(table, name, mode) };
        if draft.secondary.is_some() {
            draft.spec.compensator = CompensatorSpec::None;
        }
        draft
    }

    /// Reads the secondary controller of the one called `primary`.
    fn read_secondary(table: Table<'_>, primary: &str) -> Self {
        for (key, problem) in [
            ("name", "a secondary controller is called after its primary one"),
            ("mode", "a secondary controller is always in mode cascade"),
            ("secondary", "a cascade has two controllers"),
        ] {
            if let Some(span) = table.key_span(key) {
                table.log.fault(Fault::new(code::CONFLICT, span, problem).help("remove it"));
            }
        }
        Self::read_law(table, format!("{primary} (secondary)"), Mode::Cascade)
    }

    /// Reads everything but the name, the mode and the loop inside.
    fn read_law(table: Table<'_>, name: String, mode: Mode) -> Self {
        let mut places = Places::new(table.place.clone());
        let mut config = ControllerConfig::default();
        let wish = designs::read(&table, &mut places);
        let at = adrc::place(&table);
        let (pid, adrc, compensator) = match &at {
            None => {
                let pid = read_pid(&table, &mut places);
                // It is one of the known keys.
                let _ = table.span("adrc");
                (pid, None, compensators::read(&table, &mut places))
            }
            Some(at) => (PidDraft::default(), adrc::read(&table, at, &mut places), CompensatorSpec::None),
        };
        if let Some(part) = table.table("limits", LIMITS) {
            limits(part, &mut config.limits, &mut places);
        }
        if let Some(part) = table.table("setpoint", SETPOINT) {
            setpoint(part, &mut config.setpoint, &mut places);
        }
        if let Some(part) = table.table("anti_windup", ANTI_WINDUP) {
            anti_windup(part, &mut config.anti_windup, &mut places);
        }
        if at.is_none() {
            take(&table, "deadband", Param::Deadband, &mut places, &mut config.deadband);
        }
        if let Some(part) = table.table("measurement", RANGE) {
            let params = [Param::MeasurementLo, Param::MeasurementHi];
            range(part, params, &mut config.measurement_lo, &mut config.measurement_hi, &mut places);
        }
        if let Some(part) = table.table("offset", RANGE) {
            let params = [Param::OffsetLo, Param::OffsetHi];
            range(part, params, &mut config.offset_lo, &mut config.offset_hi, &mut places);
        }
        if let Some(part) = table.table("fallback", "`fallback = { hold_samples = 3, action = \"hold\" }`") {
            fallback(part, &mut config.fallback, &mut places);
        }
        if let Some(part) = table.table("alarms", "`alarms = { hi = 80.0, lo = 20.0, hysteresis = 1.0 }`") {
            alarms(part, &mut config.alarms, &mut places);
        }
        take_optional(&table, "off_output", Param::OffOutput, &mut places, &mut config.off_output);
        take(&table, "initial_output", Param::InitialOutput, &mut places, &mut config.initial_output);
        table.finish();
        let spec = ControllerSpec { name, config, adrc, compensator, mode, secondary: None };
        Self { pid, spec, name_span: None, places, secondary: None, wish }
    }

    /// Reads the parameter keys of an event over what the controller had so far.
    pub(super) fn change(&mut self, event: &Table<'_>) {
        let Self { pid, spec, places, .. } = self;
        places.whole = event.place.clone();
        adrc::change(event, spec, places);
        if let (None, Some(part)) = (&spec.adrc, event.table("pid", PID)) {
            pid.change(part, &spec.name, places);
        }
        if let Some(part) = event.table("limits", LIMITS) {
            limits(part, &mut spec.config.limits, places);
        }
        if let Some(part) = event.table("setpoint_limits", SETPOINT_LIMITS) {
            setpoint(part, &mut spec.config.setpoint, places);
        }
        if let Some(part) = event.table("anti_windup", ANTI_WINDUP) {
            anti_windup(part, &mut spec.config.anti_windup, places);
        }
        if spec.adrc.is_none() {
            take(event, "deadband", Param::Deadband, places, &mut spec.config.deadband);
            compensators::change(event, spec, places);
        }
    }

    /// Fulfils a wish for a design, once the plant and the sampling period are known.
    pub(super) fn design(&mut self, plant: &Plant, ts: f64, latency: f64, log: &Log<'_>) {
        if let (Some((inner, _)), Some([part, _])) = (&mut self.secondary, &plant.parts) {
            inner.fulfil(part, ts, latency, log);
        }
        self.fulfil(&plant.whole, ts, latency, log);
        if let (Some(_), Some(wish)) = (&plant.nonlinear, &self.wish) {
            log.warn(wish.of_linear_model(&plant.whole));
        }
    }

    fn fulfil(&mut self, plant: &TransferFunction, ts: f64, latency: f64, log: &Log<'_>) {
        let Some(wish) = &self.wish else { return };
        match wish.fulfil(plant, ts, latency, &mut self.spec) {
            Ok(warnings) => warnings.into_iter().for_each(|warning| log.warn(warning)),
            Err(fault) => log.fault(fault),
        }
        self.pid = PidDraft::parallel(self.spec.config.pid);
    }

    pub(super) fn name(&self) -> &str {
        &self.spec.name
    }

    /// What the controller is now.
    pub(super) fn spec(&self) -> ControllerSpec {
        let mut spec = self.spec.clone();
        spec.config.pid = self.pid.config();
        spec.secondary = self.secondary.as_ref().map(|(inner, _)| Box::new(inner.spec()));
        spec
    }

    /// The places of its parameters and of those of the loop inside.
    pub(super) fn all_places(&self) -> Places {
        let mut places = self.places.clone();
        places.inner = self.secondary.as_ref().map(|(inner, _)| Box::new(inner.places.clone()));
        places
    }

    pub(super) fn has_converted_gains(&self) -> bool {
        self.pid.is_converted()
    }
}

/// The model of a disturbance block is one of what the controller drives: here a closed loop.
fn refuse_compensator(table: &Table<'_>, secondary: &Range<usize>) {
    for key in ["estimator", "observer", "design"] {
        if let Some(span) = table.key_span(key) {
            let message =
                format!("a primary controller has no `{key}`: it drives a closed loop, not the plant");
            let fault = Fault::new(code::CONFLICT, span, message);
            let help = "write it in `secondary`, whose plant is the inner part";
            table.log.fault(fault.help(help).related(secondary.clone(), "the secondary controller"));
        }
    }
}

fn read_name(table: &Table<'_>) -> (String, Option<Range<usize>>) {
    if table.span("name").is_none() {
        table.missing("name", "`name = \"PI\"`");
    }
    let Some(name) = table.text("name") else {
        return (String::new(), None);
    };
    let length = name.value.chars().count();
    let problem = if name.value.trim().is_empty() {
        "is empty"
    } else if length > LONGEST_NAME {
        "is too long"
    } else if name.value.chars().any(char::is_control) {
        "has a character that cannot be printed"
    } else {
        return (name.value.to_owned(), Some(name.span));
    };
    let message = format!(
        "`name = \"{}\"` {problem}; allowed: 1 to {LONGEST_NAME} characters on one line",
        shortened(name.value)
    );
    table.log.fault(Fault::new(code::OUT_OF_RANGE, name.span, message));
    (String::new(), None)
}

fn read_pid(table: &Table<'_>, places: &mut Places) -> PidDraft {
    let design = table.key_span("design");
    if table.span("pid").is_none() && design.is_none() {
        table.missing("pid", PID);
    }
    table.table("pid", PID).map_or_else(PidDraft::default, |part| PidDraft::read(part, places))
}
