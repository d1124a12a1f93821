//! From a design to the file that is run, analysed, exported and flashed.

use crate::scenario::{self, ControllerSpec, DesignFile, Units};
use controller_core::{LimitConfig, PidConfig};
use controller_design::design::{Design, Law};

/// Longest run of a design file, in samples.
const LONGEST: f64 = 2e6;

/// The design file of `made`: its controller, and unit steps of the set-point and of the load. `command` is what made it.
#[must_use]
pub fn of(made: &Design, limits: Option<(f64, f64)>, command: &str) -> DesignFile {
    let title = made.method.title();
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
        initial_load: 0.0,
        setpoint_step: 1.0,
        load_step: 1.0,
        window: window(made),
        noise: 0.0,
        resolution: 0.0,
        controller,
    }
}

/// A title has room for 120 characters.
fn shortened(plant: &str) -> String {
    if plant.chars().count() <= 90 {
        return plant.to_owned();
    }
    let start: String = plant.chars().take(87).collect();
    format!("{start}...")
}

/// Time until the response to a step is over: 14 of the slowest time constants there are (`exp(-14)` is 1e-6), in
/// whole samples.
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
        slowest = slowest.max(mode + lags.sum::<f64>()).max(adrc.kd / adrc.kp);
    }
    let samples = ((14.0 * slowest + 10.0 * dead_time) / made.ts).clamp(10.0, LONGEST);
    // By way of text: a round number of seconds stays one.
    format!("{:.11e}", samples.ceil() * made.ts).parse().unwrap_or(made.ts)
}
