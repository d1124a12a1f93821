//! A loop as a Rust module: constants, the types that fit them, a function that builds the law.

use super::Export;
use crate::scenario::CompensatorSpec;
use crate::simulate::Precision;
use controller_core::plant_model::Factor;
use controller_core::{
    AntiWindupConfig, AnyCompensator, ControllerConfig, EstimatorConfig, FallbackAction, Fingerprint,
    ObserverConfig, Real,
};
use std::fmt::Write;

/// Stands for what only the model of an observer needs.
const FACTOR: &str = "Factor";

/// The module.
pub(super) fn text(export: &Export<'_>, origin: &str) -> String {
    let mut module = Module { text: String::new(), names: vec!["ConfigErrors", "ControllerConfig"] };
    module.body(export);
    let names = std::mem::take(&mut module.names);
    head(export, origin, names) + &module.text
}

fn head(export: &Export<'_>, origin: &str, mut names: Vec<&'static str>) -> String {
    names.extend([
        "Action",
        "AlarmConfig",
        "AntiWindupConfig",
        "Controller",
        "ControllerState",
        "FallbackAction",
        "FallbackConfig",
        "FallbackReturn",
        "Fingerprint",
        "IntegralRule",
        "LimitConfig",
        "PidConfig",
        "SetpointConfig",
    ]);
    let model = names.contains(&FACTOR);
    names.retain(|name| *name != FACTOR);
    names.sort_unstable();
    names.dedup();
    let mut text = String::new();
    let mut line = |words: &str| text.extend([words, "\n"]);
    line(&format!(
        "//! {}: the loop of `{}`, exported by `controller-sim export`.",
        one_line(&export.spec.name),
        one_line(origin)
    ));
    line("//!");
    line(
        "//! Do not change numbers here: they have passed checks that this file cannot repeat, and the compiler will",
    );
    line(
        "//! refuse others. Change the design file and export it again. Declare it as `#[rustfmt::skip] mod ...;`.",
    );
    line("");
    if model {
        line("use controller_core::plant_model::{Factor, PlantModel};");
    }
    line("use controller_core::{");
    let mut row = String::from("   ");
    for name in names {
        if row.len() + name.len() + 2 > 100 {
            line(&row);
            row = String::from("   ");
        }
        let _ = write!(row, " {name},");
    }
    line(&row);
    line("};");
    text
}

/// The module below its imports.
struct Module {
    text: String,
    names: Vec<&'static str>,
}

impl Module {
    fn line(&mut self, words: &str) {
        self.text.push_str(words);
        self.text.push('\n');
    }

    /// A constant, with what it is.
    fn constant(&mut self, doc: &str, name: &str, kind: &str, value: &str) {
        self.line(&format!("\n/// {doc}\npub const {name}: {kind} = {value};"));
    }

    fn body(&mut self, export: &Export<'_>) {
        let real = match export.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        };
        let (ts, latency) = (export.scenario.ts, export.scenario.latency);
        self.constant(
            "Sampling period \\[s\\]: the timer that runs the loop must have it.",
            "TS",
            "f64",
            &number(ts),
        );
        self.constant("From reading the measurement to acting \\[s\\].", "LATENCY", "f64", &number(latency));
        self.constant(
            "PID, limits, set-point, anti-windup, bad samples, alarms.",
            "CONTROLLER",
            "ControllerConfig",
            &controller(&export.spec.config),
        );
        let taken = Fingerprint::new().number(ts).number(latency).controller(&export.spec.config);
        let check = "Fingerprint::new().number(TS).number(LATENCY).controller(&CONTROLLER)";
        match (&export.spec.adrc, &export.spec.compensator) {
            (Some(adrc), _) => {
                self.names.extend(["Adrc", "AdrcConfig", "NoCompensator"]);
                let fields = [
                    ("b0", adrc.b0),
                    ("kp", adrc.kp),
                    ("kd", adrc.kd),
                    ("beta1", adrc.beta1),
                    ("beta2", adrc.beta2),
                    ("beta3", adrc.beta3),
                ];
                self.constant(
                    "The ADRC that closes the loop.",
                    "ADRC",
                    "AdrcConfig",
                    &record("AdrcConfig", &fields),
                );
                self.types(real, "NoCompensator", Some("Adrc"));
                self.function(real, &format!("Controller::with_adrc(&controller.rounded::<{real}>(), &ADRC.rounded::<{real}>(), ts)"));
                self.check(&format!("{check}.adrc(&ADRC)"), taken.adrc(adrc));
            }
            (None, CompensatorSpec::None) => {
                self.names.push("NoCompensator");
                self.types(real, "NoCompensator", None);
                self.function(real, &format!("Controller::new(&controller.rounded::<{real}>(), ts)"));
                self.check(check, taken);
            }
            (None, CompensatorSpec::Estimator(estimator)) => {
                self.names.extend(["Compensator", "EstimatorConfig"]);
                self.constant(
                    "The disturbance estimator.",
                    "ESTIMATOR",
                    "EstimatorConfig",
                    &of_estimator(estimator),
                );
                self.compensated(export, real, "ESTIMATOR.to_compensator(LATENCY)");
                self.check(
                    &format!("{check}.estimator(&ESTIMATOR).word(CAPACITY as u64)"),
                    taken.estimator(estimator).word(export.capacity as u64),
                );
            }
            (None, CompensatorSpec::Observer(observer)) => {
                self.names.extend(["Compensator", "ObserverConfig", FACTOR]);
                self.observer(observer);
                self.compensated(export, real, "observer().to_compensator(LATENCY)");
                let order = observer.order.map_or(0, |order| order as u64);
                let model = &observer.model;
                let taken = taken
                    .numbers(&[model.gain, model.dead_time, observer.alpha])
                    .word(order)
                    .word(model.integrators as u64)
                    .factors(&model.poles)
                    .factors(&model.zeros)
                    .word(export.capacity as u64);
                self.check(
                    &format!("{check}\n        .numbers(&[GAIN, DEAD_TIME, ALPHA])\n        .word(ORDER)\n        .word(INTEGRATORS)\n        .factors(&POLES)\n        .factors(&ZEROS)\n        .word(CAPACITY as u64)"),
                    taken,
                );
            }
        }
    }

    /// The constants of an observer, and a function that puts them together: lists cannot be made by the compiler.
    fn observer(&mut self, observer: &ObserverConfig) {
        let model = &observer.model;
        self.constant("Gain of the observer's model.", "GAIN", "f64", &number(model.gain));
        self.constant("Integrators of the model.", "INTEGRATORS", "u64", &model.integrators.to_string());
        self.constant(
            "Denominator of the model.",
            "POLES",
            &format!("[Factor; {}]", model.poles.len()),
            &factors(&model.poles),
        );
        self.constant(
            "Numerator of the model.",
            "ZEROS",
            &format!("[Factor; {}]", model.zeros.len()),
            &factors(&model.zeros),
        );
        self.constant("Dead time of the model \\[s\\].", "DEAD_TIME", "f64", &number(model.dead_time));
        self.constant("Filter time constant \\[s\\].", "ALPHA", "f64", &number(observer.alpha));
        let order = observer.order.unwrap_or(0).to_string();
        self.constant("Filter order; 0: the smallest possible.", "ORDER", "u64", &order);
        self.line("\nfn observer() -> ObserverConfig {");
        self.line("    let mut model = PlantModel::default().with_gain(GAIN).with_dead_time(DEAD_TIME);");
        self.line("    model.integrators = INTEGRATORS as usize;");
        self.line("    for pole in POLES {\n        model = model.with_pole(pole);\n    }");
        self.line("    for zero in ZEROS {\n        model = model.with_zero(zero);\n    }");
        self.line("    let order = if ORDER == 0 { None } else { Some(ORDER as usize) };");
        self.line("    ObserverConfig { model, alpha: ALPHA, order }\n}");
    }

    fn compensated(&mut self, export: &Export<'_>, real: &str, config: &str) {
        self.constant(
            "Samples of delay memory; more of it leaves room for longer dead times.",
            "CAPACITY",
            "usize",
            &export.capacity.to_string(),
        );
        // It was built when the export was checked: there is a shape.
        let shape = match export.precision {
            Precision::F32 => shape::<f32>(export),
            Precision::F64 => shape::<f64>(export),
        };
        let (n, e) = shape.unwrap_or_default();
        self.types(real, &format!("Compensator<{real}, {n}, {e}, CAPACITY>"), None);
        self.function(
            real,
            &format!("Controller::with_compensator(\n        &controller.rounded::<{real}>(),\n        Compensator::new(&{config}.rounded::<{real}>(), ts)?,\n        ts,\n    )"),
        );
    }

    fn types(&mut self, real: &str, compensator: &str, law: Option<&str>) {
        let law = law.map_or(String::new(), |law| format!(", {law}<{real}>"));
        self.line(&format!("\n/// The law: built once, never changed.\npub type Law = Controller<{real}, {compensator}{law}>;"));
        self.line("\n/// Its state: `law.zeroed()` settles itself on the first good sample.");
        let state = match (compensator, law.is_empty()) {
            ("NoCompensator", true) => format!("ControllerState<{real}, ()>"),
            ("NoCompensator", false) => {
                format!("ControllerState<{real}, (), controller_core::AdrcState<{real}>>")
            }
            _ => {
                format!(
                    "ControllerState<{real}, controller_core::CompensatorState<{}",
                    compensator.trim_start_matches("Compensator<")
                ) + ">"
            }
        };
        self.line(&format!("pub type State = {state};"));
    }

    fn function(&mut self, real: &str, made: &str) {
        self.line("\n/// Builds the law.\n///\n/// # Errors\n/// None: this very law was built when it was exported.");
        self.line("pub fn law() -> Result<Law, ConfigErrors> {\n    law_of(&CONTROLLER)\n}");
        self.line("\n/// Builds the same loop with other parameters, every number rounded to the type it runs in.\n///");
        self.line("/// # Errors\n/// Every fault of `controller`.");
        self.line("pub fn law_of(controller: &ControllerConfig) -> Result<Law, ConfigErrors> {");
        let ts = if real == "f32" { "f64::from(TS as f32)" } else { "TS" };
        self.line(&format!("    let ts = {ts};\n    {made}\n}}"));
    }

    fn check(&mut self, made: &str, taken: Fingerprint) {
        self.line("\nconst _: () = assert!(");
        self.line(&format!("    {made}.value()\n        == {:#018x},", taken.value()));
        self.line("    \"a number was changed by hand: change the design file and export it again\"\n);");
    }
}

fn shape<T: Real>(export: &Export<'_>) -> Option<(usize, usize)> {
    let config = export.compensator()?.rounded::<T>();
    let ts = T::from_f64(export.scenario.ts).to_f64();
    AnyCompensator::<T, Vec<T>>::new(&config, ts, export.capacity).ok().map(|law| law.shape())
}

/// A number that the compiler reads back bit for bit.
fn number(x: f64) -> String {
    format!("{x:?}")
}

fn option(x: Option<f64>) -> String {
    x.map_or("None".to_owned(), |x| format!("Some({})", number(x)))
}

fn record(name: &str, fields: &[(&str, f64)]) -> String {
    let fields: String = fields.iter().map(|(field, x)| format!("\n    {field}: {},", number(*x))).collect();
    format!("{name} {{{fields}\n}}")
}

fn of_estimator(e: &EstimatorConfig) -> String {
    let fields = [
        ("gain", e.gain),
        ("a1", e.a1),
        ("a2", e.a2),
        ("dead_time", e.dead_time),
        ("kfd", e.kfd),
        ("tfd", e.tfd),
    ];
    record("EstimatorConfig", &fields)
}

fn factors(list: &[Factor]) -> String {
    let list: Vec<String> = list
        .iter()
        .map(|factor| format!("Factor::second({}, {})", number(factor.a1), number(factor.a2)))
        .collect();
    format!("[{}]", list.join(", "))
}

/// Every field, none left to a default that another version might change.
fn controller(config: &ControllerConfig) -> String {
    let mut text = String::from("ControllerConfig {");
    let mut field = |name: &str, value: String| {
        let _ = write!(text, "\n    {name}: {value},");
    };
    let p = &config.pid;
    let gains = [("kp", p.kp), ("ki", p.ki), ("kd", p.kd), ("tf", p.tf), ("b", p.b), ("c", p.c)];
    let gains: String = gains.iter().map(|(name, x)| format!("\n        {name}: {},", number(*x))).collect();
    field(
        "pid",
        format!(
            "PidConfig {{{gains}\n        action: Action::{:?},\n        integral_rule: IntegralRule::{:?},\n    }}",
            p.action, p.integral_rule
        ),
    );
    let l = &config.limits;
    let range = |name: &str, lo: f64, hi: f64, up: Option<f64>, down: Option<f64>, more: &str| {
        format!(
            "{name} {{\n        lo: {},\n        hi: {},\n        rate_up: {},\n        rate_down: {},{more}\n    }}",
            number(lo),
            number(hi),
            option(up),
            option(down)
        )
    };
    field("limits", range("LimitConfig", l.lo, l.hi, l.rate_up, l.rate_down, ""));
    let s = &config.setpoint;
    let track = format!("\n        track: {},", s.track);
    field("setpoint", range("SetpointConfig", s.lo, s.hi, s.rate_up, s.rate_down, &track));
    field(
        "anti_windup",
        match config.anti_windup {
            AntiWindupConfig::BackCalculation { tt } => {
                format!("AntiWindupConfig::BackCalculation {{ tt: {} }}", option(tt))
            }
            AntiWindupConfig::Conditional => "AntiWindupConfig::Conditional".to_owned(),
            AntiWindupConfig::None => "AntiWindupConfig::None".to_owned(),
        },
    );
    field("deadband", number(config.deadband));
    field("measurement_lo", number(config.measurement_lo));
    field("measurement_hi", number(config.measurement_hi));
    field("offset_lo", number(config.offset_lo));
    field("offset_hi", number(config.offset_hi));
    let action = match config.fallback.action {
        FallbackAction::Hold => "FallbackAction::Hold".to_owned(),
        FallbackAction::Substitute { output } => {
            format!("FallbackAction::Substitute {{ output: {} }}", number(output))
        }
        FallbackAction::Ramp { output, rate } => {
            format!("FallbackAction::Ramp {{ output: {}, rate: {} }}", number(output), number(rate))
        }
    };
    let fallback = &config.fallback;
    field(
        "fallback",
        format!(
            "FallbackConfig {{\n        hold_samples: {},\n        action: {action},\n        back: FallbackReturn::{:?},\n    }}",
            fallback.hold_samples, fallback.back
        ),
    );
    let a = &config.alarms;
    let levels =
        [("hi_hi", a.hi_hi), ("hi", a.hi), ("lo", a.lo), ("lo_lo", a.lo_lo), ("deviation", a.deviation)];
    let levels: String =
        levels.iter().map(|(name, x)| format!("\n        {name}: {},", option(*x))).collect();
    field("alarms", format!("AlarmConfig {{{levels}\n        hysteresis: {},\n    }}", number(a.hysteresis)));
    field("off_output", option(config.off_output));
    field("initial_output", number(config.initial_output));
    text.push_str("\n}");
    text
}

/// Text of a person in a comment of one line.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
