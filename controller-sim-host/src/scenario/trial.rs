//! Building a controller's law while a scenario is read, so that every fault shows at its place.

use super::ControllerSpec;
use super::controllers::Draft;
use super::explain::explain;
use super::fault::{Fault, code};
use super::library::Library;
use super::log::Log;
use super::number::show_short;
use crate::simulate::Precision;
use controller_core::{
    AnyCompensator, CompensatorConfig, ConfigError, ConfigErrors, Controller, Param, Real, Reason,
};
use controller_design::model::TransferFunction;
use std::ops::Range;

/// Most samples of dead time and latency together.
pub(super) const LONGEST_DELAY: f64 = 1e7;

/// What a controller is built for.
#[derive(Debug, Clone)]
pub(super) struct Context<'a> {
    /// Sampling period \[s\]; none when the text has no usable one.
    pub(super) ts: Option<f64>,
    /// Where the sampling period is written.
    pub(super) ts_span: Option<Range<usize>>,
    /// Latency \[s\].
    pub(super) latency: f64,
    /// Where the latency is written.
    pub(super) latency_span: Option<Range<usize>>,
    /// The plant, when it could be read.
    pub(super) plant: Option<TransferFunction>,
    /// The number type of the run.
    pub(super) precision: Precision,
    /// Length of the run \[s\], when it is known.
    pub(super) duration: Option<f64>,
    /// The files there are.
    pub(super) library: &'a Library<'a>,
}

/// Parameters whose range depends on the sampling period.
const OF_THE_PERIOD: [Param; 11] = [
    Param::Ts,
    Param::AdrcKp,
    Param::AdrcKd,
    Param::Tf,
    Param::Tfd,
    Param::Alpha,
    Param::ModelPoles,
    Param::DeadTime,
    Param::Latency,
    Param::FilterOrder,
    Param::Overflow,
];

/// Reports everything that keeps `draft` from being built, and what is odd about it. `faults_before` is the
/// number of faults before the draft was read.
pub(super) fn check(draft: &Draft, context: &Context<'_>, log: &Log<'_>, faults_before: usize) {
    let spec = draft.spec();
    let too_long = delay_is_too_long(draft, &spec, context, log);
    let in_double = faults::<f64>(&spec, context);
    let reported = |fault: &ConfigError| {
        let params = related_to(fault);
        params.iter().any(|param| draft.places.is_reported(*param, log))
            // Without a period nothing can be said of what it bounds; what overflows may follow from any
            // fault.
            || (context.ts.is_none() && OF_THE_PERIOD.contains(&fault.param))
            || (fault.param == Param::Overflow && log.count() > faults_before)
            || (too_long && matches!(fault.param, Param::DeadTime | Param::Latency))
    };
    let mut clean = true;
    for fault in in_double.iter().filter(|fault| !reported(fault)) {
        log.fault(explain(fault, draft, &spec, context, log));
        clean = false;
    }
    if clean && context.precision == Precision::F32 && context.ts.is_some() && log.count() == faults_before {
        for fault in faults::<f32>(&spec, context) {
            let mut fault = explain(&fault, draft, &spec, context, log);
            fault.message.push_str(", in single precision");
            fault.help = Some("run with `--precision f64`, or choose numbers that f32 holds".to_owned());
            log.fault(fault);
        }
    }
    if log.count() == faults_before {
        warn(draft, &spec, context, log);
    }
}

/// Every fault of a law for `spec` in `T`.
fn faults<T: Real>(spec: &ControllerSpec, context: &Context<'_>) -> Vec<ConfigError> {
    // As in a run: what runs in T is told its numbers in T.
    let round = |x: f64| T::from_f64(x).to_f64();
    let ts = round(context.ts.unwrap_or(1.0));
    let config = spec.config.rounded::<T>();
    let list = |errors: ConfigErrors| errors.as_slice().to_vec();
    if let Some(adrc) = &spec.adrc {
        let built = Controller::<T, _, _>::with_adrc(&config, &adrc.rounded::<T>(), ts);
        return built.err().map_or_else(Vec::new, list);
    }
    let Some(compensator) = spec.compensator_config(context.latency) else {
        return Controller::<T>::new(&config, ts).err().map_or_else(Vec::new, list);
    };
    let compensator: CompensatorConfig = compensator.rounded::<T>();
    let capacity = spec.needed_capacity(ts, context.latency);
    match AnyCompensator::<T, Vec<T>>::new(&compensator, ts, capacity) {
        Ok(built) => {
            let mut all = Controller::with_compensator(&config, built, ts).err().map_or_else(Vec::new, list);
            all.extend(compensator.check_sign(&config.pid).err().map_or_else(Vec::new, list));
            all
        }
        Err(errors) => {
            let mut all = Controller::<T>::new(&config, ts).err().map_or_else(Vec::new, list);
            all.extend(list(errors));
            all.extend(compensator.check_sign(&config.pid).err().map_or_else(Vec::new, list));
            all
        }
    }
}

/// The parameters a fault is about: one that was reported already says it.
fn related_to(fault: &ConfigError) -> Vec<Param> {
    let mut params = vec![fault.param];
    match (fault.param, fault.reason) {
        (_, Reason::NeedsFilter) => params.push(Param::Tf),
        (_, Reason::SignMismatch) => params.push(Param::Ki),
        (Param::OutputLo, Reason::Inverted) => params.push(Param::OutputHi),
        (Param::SetpointLo, Reason::Inverted) => params.push(Param::SetpointHi),
        (Param::MeasurementLo, Reason::Inverted) => params.push(Param::MeasurementHi),
        (Param::OffsetLo, Reason::Inverted) => params.push(Param::OffsetHi),
        (Param::AlarmHi | Param::AlarmLo | Param::AlarmLoLo, Reason::Inverted) => {
            params.extend([Param::AlarmHiHi, Param::AlarmHi, Param::AlarmLo]);
        }
        (Param::FilterOrder, _) => params.push(Param::ModelPoles),
        _ => {}
    }
    params
}

/// The delay line of a compensator is memory: its length has a limit of its own.
fn delay_is_too_long(draft: &Draft, spec: &ControllerSpec, context: &Context<'_>, log: &Log<'_>) -> bool {
    let (Some(ts), Some(compensator)) = (context.ts, spec.compensator_config(context.latency)) else {
        return false;
    };
    if context.latency / ts > LONGEST_DELAY {
        // Reported where it is written.
        return true;
    }
    let samples = (compensator.model.dead_time + context.latency) / ts;
    if samples.is_nan() || samples <= LONGEST_DELAY {
        return false;
    }
    if !draft.places.is_reported(Param::DeadTime, log) {
        let span = draft.places.of(Param::DeadTime).map_or(draft.places.whole.clone(), |s| s.span.clone());
        log.fault(delay_fault("the model's dead time and the latency are", samples, span));
    }
    true
}

/// The fault of a delay of `samples` samples; `what` ends with the verb.
pub(super) fn delay_fault(what: &str, samples: f64, span: Range<usize>) -> Fault {
    let message = format!("{what} {} samples long; allowed: at most {LONGEST_DELAY:e}", show_short(samples));
    Fault::new(code::TOO_LARGE, span, message).help("choose a longer `ts`, or a shorter delay")
}

/// What can be built and is odd all the same.
fn warn(draft: &Draft, spec: &ControllerSpec, context: &Context<'_>, log: &Log<'_>) {
    let place = |param| draft.places.of(param).map_or(draft.places.whole.clone(), |s| s.span.clone());
    let pid = &spec.config.pid;
    if let Some(ts) = context.ts
        && pid.tf != 0.0
        && pid.tf < ts
    {
        let message = format!(
            "`pid.tf = {}` is shorter than a sample, {} s: it filters little",
            show_short(pid.tf),
            show_short(ts)
        );
        log.warn(Fault::new(code::FAST_FILTER, place(Param::Tf), message));
    }
    let [kp, ki, _] = pid.signed_gains();
    if kp * ki < 0.0 {
        let message = format!(
            "`kp` and `ki` have opposite signs ({} and {}): one of them drives away from the set-point",
            show_short(pid.kp),
            show_short(pid.ki)
        );
        let help = "give both the same sign; `action` changes the sign of all gains";
        log.warn(
            Fault::new(code::SIGN, place(Param::Ki), message).help(help).related(place(Param::Kp), "`kp`"),
        );
        return;
    }
    let Some(plant) = &context.plant else { return };
    // The sign of the gain says how an unstable plant rests, not which way it has to be driven.
    if is_unstable(plant) {
        return;
    }
    let gain = plant.gain();
    if let Some(compensator) = spec.compensator_config(context.latency)
        && compensator.model.gain * gain < 0.0
    {
        let message = format!(
            "the model's gain is {}, the plant's {}: the disturbance is compensated the wrong way",
            show_short(compensator.model.gain),
            show_short(gain)
        );
        log.warn(Fault::new(code::SIGN, place(Param::ModelGain), message).help("give both the same sign"));
        return;
    }
    if let Some(adrc) = &spec.adrc {
        if adrc.b0 * gain < 0.0 {
            let message = format!(
                "`adrc.b0` and the plant's gain have opposite signs ({} and {}): the loop drives away from the set-point",
                show_short(adrc.b0),
                show_short(gain)
            );
            log.warn(Fault::new(code::SIGN, place(Param::B0), message).help("change the sign of `b0`"));
        }
        return;
    }
    let (name, param, acting) = if ki == 0.0 { ("kp", Param::Kp, kp) } else { ("ki", Param::Ki, ki) };
    if acting * gain < 0.0 {
        let message = format!(
            "`{name}` and the plant's gain have opposite signs ({} and {}): the loop drives away from the set-point",
            show_short(acting),
            show_short(gain)
        );
        let help = "change the sign of the gains, or the `action` of the PID";
        log.warn(Fault::new(code::SIGN, place(param), message).help(help));
    }
}

/// Whether the plant has a pole to the right of the imaginary axis; one on it may be computed a little beside.
fn is_unstable(plant: &TransferFunction) -> bool {
    plant.poles().iter().any(|pole| pole.re > 1e-6 * pole.re.hypot(pole.im))
}
