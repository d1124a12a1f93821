//! From a design to the file that is run, analysed, exported and flashed.

use crate::scenario::{self, ControllerSpec, DesignFile, Units};
use controller_core::{LimitConfig, PidConfig};
use controller_design::design::{Design, Law};

/// The slowest time constants there are until a step is over: what is left is about
/// `exp(-14)`, 1e-6.
const SETTLING: f64 = 14.0;
/// Height of a peak of the sensitivities from which a loop swings.
const RESONANT: f64 = 1.3;
/// Longest run of a design file, in samples.
const LONGEST: f64 = 2e6;

/// The design file of `made`: its controller, and unit steps of the set-point and of the load. With `limits` the loop rests
/// in the middle of them and the steps are as large as they allow. `command` is what made it.
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
    DesignFile {
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
    }
}

/// The middle of the output's range, and steps of set-point and load after which the output stays well inside: the load
/// moves it by a tenth of the range, the set-point by that at the end and by at most a third at once.
fn within(made: &Design, (lo, hi): (f64, f64)) -> (f64, [f64; 2]) {
    let range = hi - lo;
    let at_once = match &made.law {
        Law::Pid { pid, .. } if pid.tf > 0.0 => {
            (pid.b * pid.kp).abs().max((pid.b * pid.kp + pid.c * pid.kd / pid.tf).abs())
        }
        Law::Pid { pid, .. } => (pid.b * pid.kp).abs(),
        Law::Adrc(adrc) => (adrc.kp / adrc.b0).abs(),
    };
    let by_kick = range / (3.0 * at_once);
    let by_rest =
        if made.plant.integrators() > 0 { f64::INFINITY } else { 0.1 * range * made.plant.gain().abs() };
    let setpoint = by_kick.min(by_rest);
    let setpoint = if setpoint.is_finite() && setpoint > 0.0 { setpoint } else { 1.0 };
    (0.5 * (lo + hi), [round_down(setpoint), round_down(0.1 * range)])
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

/// Time until the response to a step is over: in whole samples.
fn window(made: &Design) -> f64 {
    let plant = &made.plant;
    let poles = plant.poles();
    let lags = poles.iter().map(|pole| 1.0 / pole.abs()).filter(|lag| lag.is_finite());
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
    let samples = ((SETTLING * slowest + 10.0 * dead_time) / made.ts).clamp(10.0, LONGEST);
    // By way of text: a round number of seconds stays one.
    format!("{:.11e}", samples.ceil() * made.ts).parse().unwrap_or(made.ts)
}
