//! Ordinary loops, tuned for the plant they control: they forget what was done to them.

use super::built::{AnyBlock, Built, Checked};
use super::configs::{CAPACITY, Case};
use super::draw::Draw;
use super::driven::Driven;
use controller_core::plant_model::PlantModel;
use controller_core::{
    Action, AntiWindupConfig, CompensatorConfig, ControllerConfig, ControllerInput, EstimatorConfig,
    FallbackAction, FallbackConfig, FallbackReturn, IntegralRule, LimitConfig, ObserverConfig, PidConfig,
    Real, SetpointConfig,
};

/// Bytes that one plant with its loop reads at most.
pub(crate) const LOOP_BYTES: usize = 96;

/// A first-order lag behind a dead time of whole samples, `x <- x + g*(K*u - x)`.
struct Plant {
    gain: f64,
    g: f64,
    x: f64,
    line: Vec<f64>,
}

impl Plant {
    fn step(&mut self, u: f64) {
        self.line.push(u);
        self.x += self.g * (self.gain * self.line.remove(0) - self.x);
    }
}

/// A plant, a loop for it, a set-point, and after how many samples it must be reached.
struct Ordinary {
    plant: Plant,
    case: Case,
    r: f64,
    samples: usize,
}

/// How far from the set-point \[y\] counts as there; the set-points are of size 5.
const NEAR: f64 = 0.01;

/// PI by lambda tuning, optionally with a filtered derivative, on a lag of 5 to 200 samples.
fn ordinary(bytes: &[u8]) -> Ordinary {
    let mut draw = Draw::new(bytes);
    let ts = draw.decades(-4.0, 3.0);
    let tau = ts * draw.decades(0.7, 2.3);
    let gain = draw.signed_decades(-2.0, 2.0);
    let dead = draw.index(CAPACITY / 3);
    let dead_time = ts * dead as f64;
    let derivative = draw.rarely(3);
    let tf = if derivative || draw.flag() { ts * draw.decades(0.0, 1.0) } else { 0.0 };
    let delay = dead_time + tf + ts;
    let lambda = (tau * draw.decades(-0.5, 0.3)).max(2.0 * delay);
    let kp = tau / (gain * (lambda + delay));
    let ti = tau.min(4.0 * (lambda + delay));
    let direct = draw.flag();
    let sign = if direct { -1.0 } else { 1.0 };
    let kd = if derivative { 0.3 * kp * delay } else { 0.0 };
    // Time for the whole range of a signal.
    let rate =
        |draw: &mut Draw<'_>, range: f64| draw.rarely(3).then(|| range / (lambda * draw.decades(-1.0, 1.0)));
    let span = draw.between(8.0, 40.0) / gain.abs();
    let limits = LimitConfig {
        lo: -span,
        hi: span,
        rate_up: rate(&mut draw, 2.0 * span),
        rate_down: rate(&mut draw, 2.0 * span),
    };
    let setpoint = SetpointConfig {
        lo: -5.0,
        hi: 5.0,
        rate_up: rate(&mut draw, 10.0),
        rate_down: rate(&mut draw, 10.0),
        track: draw.flag(),
    };
    let output = draw.between(-span, span);
    let ramp = FallbackAction::Ramp { output, rate: span / lambda };
    let config = ControllerConfig {
        pid: PidConfig {
            kp: sign * kp,
            ki: sign * kp / ti,
            kd: sign * kd,
            tf,
            b: draw.share(),
            c: draw.share(),
            action: if direct { Action::Direct } else { Action::Reverse },
            integral_rule: draw.pick(&[IntegralRule::Backward, IntegralRule::Trapezoid]),
        },
        limits,
        setpoint,
        anti_windup: match draw.index(3) {
            0 => AntiWindupConfig::BackCalculation { tt: None },
            1 => AntiWindupConfig::BackCalculation { tt: Some(ti * draw.decades(-0.5, 0.5)) },
            _ => AntiWindupConfig::Conditional,
        },
        measurement_lo: -20.0,
        measurement_hi: 20.0,
        offset_lo: -1.0 / gain.abs(),
        offset_hi: 1.0 / gain.abs(),
        fallback: FallbackConfig {
            hold_samples: u16::from(draw.byte() % 6),
            action: draw.pick(&[FallbackAction::Hold, FallbackAction::Substitute { output }, ramp]),
            back: draw.pick(&[FallbackReturn::Automatic, FallbackReturn::Acknowledged]),
        },
        ..ControllerConfig::default()
    };
    let filter = lambda * draw.between(0.3, 1.0);
    let block = if draw.flag() {
        let kfd = draw.share();
        let model = EstimatorConfig { gain, a1: tau, a2: 0.0, dead_time, kfd, tfd: filter / 3.0 };
        model.to_compensator(0.0)
    } else {
        let observer = ObserverConfig {
            model: PlantModel::first_order(gain, tau, dead_time),
            alpha: filter,
            order: None,
        };
        CompensatorConfig { gain: draw.pick(&[1.0, 0.0, 0.5]), ..observer.to_compensator(0.0) }
    };
    // The slowest of all ramps takes ten times lambda.
    let samples = (60.0 * (lambda + delay + tau) / ts).ceil() as usize;
    let plant = Plant { gain, g: 1.0 - (-ts / tau).exp(), x: 0.0, line: vec![0.0; dead] };
    Ordinary { plant, case: Case { ts, config, block }, r: draw.between(-5.0, 5.0), samples }
}

/// Any operations on an ordinary loop with its plant; then good samples, which must bring it to its set-point.
pub(crate) fn recovers<T: Real>(bytes: &[u8], operations: &[Vec<u8>]) -> Checked {
    let Ordinary { mut plant, case, r, samples } = ordinary(bytes);
    let laws =
        [Built::<T, AnyBlock<T>>::new(&case).map_err(|faults| format!("refused: {faults}\n{case:?}"))?];
    let mut driven = Driven::new(&laws);
    for bytes in operations {
        driven.operate(bytes)?;
        plant.step(driven.state.u().to_f64());
    }
    let mut there = 0;
    for _ in 0..samples {
        let y = plant.x.clamp(-20.0, 20.0);
        let input = ControllerInput {
            r: T::from_f64(r),
            y: T::from_f64(y),
            acknowledge: true,
            ..ControllerInput::default()
        };
        let out = driven.step(&input)?;
        there = if (y - r).abs() <= NEAR { there + 1 } else { 0 };
        plant.step(out.u.to_f64());
    }
    driven.check_state()?;
    let least = samples / 10;
    if there < least {
        let (y, u) = (plant.x, driven.state.u());
        return Err(format!(
            "at the set-point {r} for {there} samples, not {least}; y = {y}, u = {u:?}\n{case:?}"
        ));
    }
    Ok(())
}
