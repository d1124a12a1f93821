//! From a design to the file that is run, analysed, exported and flashed.

use crate::scenario::{self, ControllerSpec, DesignFile, Units};
use controller_core::{LimitConfig, PidConfig};
use controller_design::design::{Design, Law};

/// The slowest time constants there are until a step is over: what is left is about
/// `exp(-14)`, 1e-6.
const SETTLING: f64 = 14.0;
/// Height of a peak of the sensitivities from which a loop swings.
const RESONANT: f64 = 1.3;
/// Longest window of a design file, in samples.
const LONGEST: f64 = 2e6;
/// Range of the controller's signals that no file needs to write: the default.
const USUAL: f64 = 1e6;
/// Widest range that there is.
const WIDEST: f64 = 1e12;
/// Share of the widest range that a signal is expected to take at most; steps are made smaller above it.
const MOST: f64 = 0.1;

/// The design file of `made`: its controller, and unit steps of the set-point and of the load. With `limits` the loop rests
/// in the middle of them and the steps are as large as they allow. Where the controller's ranges would be too narrow for the
/// signals the file has wider ones, and smaller steps where none is wide enough. `command` is what made it.
#[must_use]
pub fn of(made: &Design, limits: Option<(f64, f64)>, command: &str) -> DesignFile {
    let title = made.method.title();
    let (rest, [setpoint_step, load_step]) = limits.map_or((0.0, [1.0, 1.0]), |range| within(made, range));
    let mut controller = ControllerSpec::pid(title, PidConfig::default());
    scenario::apply(made, &mut controller);
    if let Some((lo, hi)) = limits {
        controller.config.limits = LimitConfig { lo, hi, ..LimitConfig::default() };
    }
    let mut comments = vec![format!("{title} ({}), made by", made.method.source()), command.to_owned()];
    comments.extend(made.warnings.iter().map(|warning| format!("note: {warning}")));
    comments.extend(cut(made).map(|cut| format!("note: {cut}")));
    let mut file = DesignFile {
        comments,
        title: format!("{title} for {}", shortened(&made.plant.to_string())),
        units: Units::default(),
        ts: made.ts,
        latency: made.latency,
        plant: made.plant.clone(),
        initial_setpoint: 0.0,
        initial_load: -rest,
        setpoint_step,
        load_step,
        window: window(made),
        noise: 0.0,
        resolution: 0.0,
        controller,
    };
    let [(y, u), (y_load, u_load)] = expected(made, &file);
    let most = MOST * WIDEST;
    // Linear in the step: one that asks for too much becomes that much smaller.
    for (step, asked) in [(&mut file.setpoint_step, y.max(u)), (&mut file.load_step, y_load.max(u_load))] {
        if asked > most && asked.is_finite() {
            *step = round_down(*step * most / asked);
            file.comments
                .push(format!("note: a step of {step} instead of 1, or the signals are beyond {WIDEST:e}"));
        }
    }
    widen(&mut file, made, limits);
    file
}

/// The largest measurement and output that the steps of the set-point and of the load are expected to ask for, about.
fn expected(made: &Design, file: &DesignFile) -> [(f64, f64); 2] {
    let at_once = at_once(made);
    let integrates = made.plant.integrators() > 0;
    let rest = if integrates { 0.0 } else { 1.0 / made.plant.gain().abs() };
    let kp = match &made.law {
        Law::Pid { pid, .. } => pid.kp.abs(),
        Law::Adrc(adrc) => (adrc.kp / adrc.b0).abs(),
    };
    let moved = if integrates { 2.0 / kp } else { made.plant.gain().abs() };
    let (setpoint, load) = (file.setpoint_step.abs(), file.load_step.abs());
    [(2.0 * setpoint, 2.0 * setpoint * (at_once + rest)), (load * moved, 2.0 * load)]
}

/// Gives the controller of `file` the ranges that its signals need: of the set-point and the measurement, and of the output
/// where `limits` do not say it. Powers of ten, 100 times the largest signal that is expected; the default where it does.
pub(crate) fn widen(file: &mut DesignFile, made: &Design, limits: Option<(f64, f64)>) {
    let [(y, u), (y_load, u_load)] = expected(made, file);
    let level = file.initial_setpoint.abs();
    let rest = if made.plant.integrators() > 0 { 0.0 } else { level / made.plant.gain().abs() };
    let y = range(level + y + y_load);
    let u = limits.map_or_else(
        || range(rest + file.initial_load.abs() + u + u_load),
        |(lo, hi)| if lo.abs().max(hi.abs()) > USUAL { WIDEST } else { USUAL },
    );
    let config = &mut file.controller.config;
    (config.setpoint.lo, config.setpoint.hi) = (-y, y);
    (config.measurement_lo, config.measurement_hi) = (-y, y);
    (config.offset_lo, config.offset_hi) = (-u, u);
    (config.limits.lo, config.limits.hi) = limits.unwrap_or((-u, u));
}

/// Half the width of a range for signals up to `largest`.
fn range(largest: f64) -> f64 {
    if 10.0 * largest <= USUAL {
        return USUAL;
    }
    // By way of text: exactly a power of ten.
    let decade = libm::ceil(libm::log10(100.0 * largest));
    format!("1e{decade}").parse().unwrap_or(WIDEST).min(WIDEST)
}

/// Whether the range of the output is one that [`of`] or the default gives, not the limits of an actuator.
#[must_use]
pub(crate) fn is_open(limits: &LimitConfig) -> bool {
    limits.hi >= USUAL && limits.lo == -limits.hi
}

/// The middle of the output's range, and steps of set-point and load after which the output stays well inside: the load
/// moves it by a tenth of the range, the set-point by that at the end and by at most a third at once.
fn within(made: &Design, (lo, hi): (f64, f64)) -> (f64, [f64; 2]) {
    let range = hi - lo;
    let by_kick = range / (3.0 * at_once(made));
    let by_rest =
        if made.plant.integrators() > 0 { f64::INFINITY } else { 0.1 * range * made.plant.gain().abs() };
    let setpoint = by_kick.min(by_rest);
    let setpoint = if setpoint.is_finite() && setpoint > 0.0 { setpoint } else { 1.0 };
    (0.5 * (lo + hi), [round_down(setpoint), round_down(0.1 * range)])
}

/// The output's jump with a unit step of the set-point.
fn at_once(made: &Design) -> f64 {
    match &made.law {
        Law::Pid { pid, .. } if pid.tf > 0.0 => {
            (pid.b * pid.kp).abs().max((pid.b * pid.kp + pid.c * pid.kd / pid.tf).abs())
        }
        Law::Pid { pid, .. } => (pid.b * pid.kp).abs(),
        Law::Adrc(adrc) => (adrc.kp / adrc.b0).abs(),
    }
}

/// The next number below of the series 1, 2, 5.
pub(crate) fn round_down(x: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(x)));
    let step = [5.0, 2.0, 1.0].into_iter().find(|step| step * decade <= x).unwrap_or(1.0);
    // By way of text: the nearest number to the decimal one.
    format!("{:.0e}", step * decade).parse().unwrap_or(x)
}

/// A title has room for 120 characters.
fn shortened(plant: &str) -> String {
    if plant.chars().count() <= 90 {
        return plant.to_owned();
    }
    let start: String = plant.chars().take(87).collect();
    format!("{start}...")
}

/// Time for each of the two steps: in whole samples, so that a round number of seconds stays one.
fn window(made: &Design) -> f64 {
    let samples = settling(made).clamp(10.0, LONGEST);
    // By way of text.
    format!("{:.11e}", samples.ceil() * made.ts).parse().unwrap_or(made.ts)
}

/// What to know when the window of a design file is too short for the response.
#[must_use]
pub fn cut(made: &Design) -> Option<String> {
    let needed = settling(made);
    (needed > LONGEST).then(|| shortage(needed, LONGEST))
}

/// That a response is simulated in part only.
pub(crate) fn shortage(needed: f64, given: f64) -> String {
    format!(
        "the response needs about {} samples to come to rest and is simulated for {} only: its integrals may lack a part; a longer ts needs fewer",
        scenario::show_short(two_digits(needed)),
        scenario::show_short(given)
    )
}

fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// Samples until the response to a step is over.
fn settling(made: &Design) -> f64 {
    let plant = &made.plant;
    let poles = plant.poles();
    // The time constant of the envelope, also where the pair of poles hardly decays.
    let lags = poles.iter().map(|pole| 1.0 / pole.re.abs()).filter(|lag| lag.is_finite());
    let mut slowest = lags.clone().fold(made.ts, f64::max);
    let mut dead_time = plant.dead_time() + made.latency;
    if let Law::Pid { pid, estimator, observer } = &made.law {
        // The slow mode that the integral term makes: (1 + K*kp)/(K*ki), kp/ki with an integrator.
        let gain = if plant.integrators() > 0 { 0.0 } else { 1.0 / plant.gain() };
        let mode = ((gain + pid.kp) / pid.ki).abs();
        if mode.is_finite() {
            slowest = slowest.max(mode);
        }
        slowest = slowest.max(pid.tf);
        slowest = slowest.max(estimator.map_or(0.0, |e| e.tfd));
        slowest = slowest.max(observer.as_ref().map_or(0.0, |o| o.alpha));
        dead_time += estimator.map_or(0.0, |e| e.dead_time);
    }
    if let Law::Adrc(adrc) = &made.law {
        // What the closed form of the IE says of its slow mode, and the lags that come on top of it.
        let mode = made.predicted.ie_setpoint.map_or(0.0, f64::abs);
        let mode = if plant.integrators() > 0 { 4.0 * mode } else { mode };
        slowest = slowest.max(mode + lags.sum::<f64>()).max(adrc.kd / adrc.kp);
    }
    // A resonance of height m at w has a damping of about 1/(2*m) and decays with w/(2*m).
    let (one, two) = (&made.robustness, &made.sampled.margins);
    let peaks =
        [(one.ms, one.omega_ms), (one.mt, one.omega_mt), (two.ms, two.omega_ms), (two.mt, two.omega_mt)];
    for (height, omega) in peaks {
        if height > RESONANT && omega > 0.0 {
            slowest = slowest.max(2.0 * height / omega);
        }
    }
    (SETTLING * slowest + 10.0 * dead_time) / made.ts
}
