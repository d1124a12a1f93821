//! Random configurations of a loop over the whole of the documented ranges: gains of 1e-15 to 1e15, sampling periods
//! of 1e-9 s to 1e9 s, signal ranges up to 1e12, models of order 1 to 8 with every kind of pole and zero.
//!
//! Half of the choices are moderate, or nearly every product of gain and range would be refused as an overflow.

use super::draw::Draw;
use controller_core::plant_model::{Factor, PlantModel};
use controller_core::{
    Action, AlarmConfig, AntiWindupConfig, CompensatorConfig, ControllerConfig, EstimatorConfig,
    FallbackAction, FallbackConfig, FallbackReturn, FilterNames, IntegralRule, LimitConfig, PidConfig,
    SetpointConfig,
};

/// Delay memory of every compensator \[samples\].
pub(crate) const CAPACITY: usize = 24;

/// Bytes that one configuration reads at most; more would read as zero.
pub(crate) const CONFIG_BYTES: usize = 160;

/// A loop as it is written, not yet built.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) ts: f64,
    pub(crate) config: ControllerConfig,
    pub(crate) block: CompensatorConfig,
}

impl Case {
    /// Any configuration. `same_ts` \[s\] replaces the sampling period, so that most swaps keep it.
    pub(crate) fn draw(bytes: &[u8], same_ts: Option<f64>) -> Self {
        let mut draw = Draw::new(bytes);
        let own = if draw.flag() { draw.decades(-9.0, 9.0) } else { draw.decades(-4.0, 1.0) };
        let ts = same_ts.filter(|_| !draw.rarely(8)).unwrap_or(own);
        let (measurement_lo, measurement_hi) = range(&mut draw);
        let (offset_lo, offset_hi) = range(&mut draw);
        let limits = limits(&mut draw);
        let config = ControllerConfig {
            pid: pid(&mut draw, ts),
            limits,
            setpoint: setpoint(&mut draw),
            anti_windup: anti_windup(&mut draw, ts),
            deadband: if draw.rarely(4) { draw.decades(-12.0, 12.0) } else { 0.0 },
            measurement_lo,
            measurement_hi,
            offset_lo,
            offset_hi,
            fallback: fallback(&mut draw, limits),
            alarms: alarms(&mut draw),
            off_output: if draw.flag() { Some(draw.between(limits.lo, limits.hi)) } else { None },
            initial_output: if draw.flag() { draw.signed_decades(-3.0, 12.0) } else { 0.0 },
        };
        let mut block = block(&mut draw, ts);
        // The integral action and the model have the same sign.
        let [_, ki, _] = config.pid.signed_gains();
        block.model.gain *= if ki * block.model.gain < 0.0 { -1.0 } else { 1.0 };
        Self { ts, config, block }
    }
}

/// 0, a moderate or an extreme size, either sign.
fn gain(draw: &mut Draw<'_>) -> f64 {
    match draw.index(8) {
        0..4 => draw.signed_decades(-3.0, 3.0),
        4 | 5 => draw.signed_decades(-15.0, 15.0),
        6 => draw.pick(&[1e15, -1e15]),
        _ => 0.0,
    }
}

/// A lower and an upper bound.
fn range(draw: &mut Draw<'_>) -> (f64, f64) {
    match draw.index(8) {
        0 => (-1e6, 1e6),
        1 => (0.0, 100.0),
        2 => (-1e12, 1e12),
        3 | 4 => {
            let half = draw.decades(-3.0, 6.0);
            (-half, half)
        }
        5 => {
            let half = draw.decades(-30.0, 12.0);
            (-half, half)
        }
        // Far from zero and narrow: in single precision both ends may be one number.
        _ => {
            let lo = draw.signed_decades(-3.0, 11.0);
            (lo, lo + draw.decades(-6.0, 11.0))
        }
    }
}

/// A rate per second: one that matters for a signal of size 1, one of any size, or none.
fn rate(draw: &mut Draw<'_>) -> Option<f64> {
    match draw.index(4) {
        0 | 1 => None,
        2 => Some(draw.decades(-3.0, 6.0)),
        _ => Some(draw.decades(-300.0, 15.0)),
    }
}

fn pid(draw: &mut Draw<'_>, ts: f64) -> PidConfig {
    let tf = match draw.index(8) {
        0..3 => 0.0,
        3 | 4 => ts * draw.decades(-0.301, 2.0),
        5 | 6 => (ts * draw.decades(-0.301, 12.0)).min(1e12),
        _ => draw.pick(&[0.5 * ts, 1e12]),
    };
    PidConfig {
        kp: gain(draw),
        ki: gain(draw),
        kd: if tf > 0.0 { gain(draw) } else { 0.0 },
        tf,
        b: draw.pick(&[1.0, 0.0, 0.5, 2.0]),
        c: draw.pick(&[0.0, 1.0, 2.0]),
        action: draw.pick(&[Action::Reverse, Action::Direct]),
        integral_rule: draw.pick(&[IntegralRule::Backward, IntegralRule::Trapezoid]),
    }
}

fn limits(draw: &mut Draw<'_>) -> LimitConfig {
    let (lo, hi) = range(draw);
    LimitConfig { lo, hi, rate_up: rate(draw), rate_down: rate(draw) }
}

fn setpoint(draw: &mut Draw<'_>) -> SetpointConfig {
    let (lo, hi) = range(draw);
    SetpointConfig { lo, hi, rate_up: rate(draw), rate_down: rate(draw), track: draw.flag() }
}

fn anti_windup(draw: &mut Draw<'_>, ts: f64) -> AntiWindupConfig {
    match draw.index(5) {
        0 => AntiWindupConfig::BackCalculation { tt: None },
        1 => AntiWindupConfig::BackCalculation { tt: Some((ts * draw.decades(-1.0, 3.0)).min(1e12)) },
        2 => AntiWindupConfig::BackCalculation { tt: Some(draw.decades(-300.0, 12.0)) },
        3 => AntiWindupConfig::Conditional,
        _ => AntiWindupConfig::None,
    }
}

fn fallback(draw: &mut Draw<'_>, limits: LimitConfig) -> FallbackConfig {
    let output = draw.between(limits.lo, limits.hi);
    FallbackConfig {
        hold_samples: match draw.index(8) {
            0..4 => 3,
            4..7 => u16::from(draw.byte() % 4),
            _ => draw.short(),
        },
        action: match draw.index(3) {
            0 => FallbackAction::Hold,
            1 => FallbackAction::Substitute { output },
            _ => FallbackAction::Ramp { output, rate: rate(draw).unwrap_or(1e15) },
        },
        back: draw.pick(&[FallbackReturn::Automatic, FallbackReturn::Acknowledged]),
    }
}

fn alarms(draw: &mut Draw<'_>) -> AlarmConfig {
    let mut level = draw.signed_decades(-3.0, 11.0);
    let mut next = |draw: &mut Draw<'_>| {
        level -= draw.decades(-3.0, 11.0);
        draw.flag().then_some(level)
    };
    AlarmConfig {
        hi_hi: next(draw),
        hi: next(draw),
        lo: next(draw),
        lo_lo: next(draw),
        deviation: draw.flag().then(|| draw.decades(-12.0, 12.0)),
        hysteresis: if draw.flag() { draw.decades(-12.0, 12.0) } else { 0.0 },
    }
}

/// A filter or model time constant in samples: moderate or anything that is allowed.
fn samples(draw: &mut Draw<'_>) -> f64 {
    if draw.rarely(4) { draw.decades(-2.99, 8.99) } else { draw.decades(-0.5, 2.5) }
}

fn block(draw: &mut Draw<'_>, ts: f64) -> CompensatorConfig {
    let dead_time = dead_time(draw, ts);
    let latency = if draw.rarely(4) { ts * draw.share() } else { 0.0 };
    let size = if draw.rarely(4) { draw.decades(-15.0, 15.0) } else { draw.decades(-2.0, 2.0) };
    let model_gain = if draw.flag() { -size } else { size };
    if draw.rarely(3) {
        let (t1, t2) = (ts * samples(draw), ts * samples(draw));
        let config = EstimatorConfig {
            gain: model_gain,
            a1: t1 + t2,
            a2: if draw.rarely(4) { 0.0 } else { t1 * t2 },
            dead_time,
            kfd: share_fed_back(draw),
            tfd: ts * samples(draw),
        };
        return config.to_compensator(latency);
    }
    let mut model = PlantModel { gain: model_gain, dead_time, ..PlantModel::default() };
    let order = 1 + draw.index(8);
    model.integrators = match draw.index(4) {
        0 | 1 => 0,
        2 => 1.min(order),
        _ => draw.index(order + 1),
    };
    while model.order() < order {
        let pole = pole(draw, ts, order - model.order() > 1);
        model = model.with_pole(pole);
    }
    let mut moved = 0;
    let zeros = if draw.flag() { draw.index(order) } else { 0 };
    while model.zeros_order() < zeros {
        let (zero, to_y) = zero(draw, ts, zeros - model.zeros_order() > 1);
        moved += to_y;
        model = model.with_zero(zero);
    }
    CompensatorConfig {
        order: if draw.flag() { Some(order - moved + draw.index(4)) } else { None },
        model,
        gain: share_fed_back(draw),
        time_constant: ts * samples(draw),
        latency,
        names: FilterNames::Observer,
    }
}

fn share_fed_back(draw: &mut Draw<'_>) -> f64 {
    match draw.index(4) {
        0 | 1 => 1.0,
        2 => draw.share(),
        _ => draw.pick(&[0.0, 1e-300, 1e-30, 1e-9]),
    }
}

/// None, whole samples, any fraction, up to what the memory holds.
fn dead_time(draw: &mut Draw<'_>, ts: f64) -> f64 {
    let most = draw.index(CAPACITY) as f64;
    match draw.index(4) {
        0 => 0.0,
        1 | 2 => ts * most,
        _ => ts * most * draw.share(),
    }
}

fn pole(draw: &mut Draw<'_>, ts: f64, two: bool) -> Factor {
    let first = ts * samples(draw);
    if !two || draw.flag() {
        return Factor::first(first);
    }
    match draw.index(4) {
        0 => {
            let second = ts * samples(draw);
            Factor::second(first + second, first * second)
        }
        // Two equal ones: rounding decides whether they are a pair.
        1 => Factor::second(2.0 * first, first * first),
        // A pair: below the Nyquist frequency, damped by 1e-6 to 1.
        _ => {
            let omega = draw.decades(-4.0, 0.49) / ts;
            let damping = draw.decades(-6.0, -1e-9);
            Factor::second(2.0 * damping / omega, 1.0 / (omega * omega))
        }
    }
}

/// A zero, and how many of its roots belong into the `y` path: real, in the left half plane, not faster than a sample.
fn zero(draw: &mut Draw<'_>, ts: f64, two: bool) -> (Factor, usize) {
    let slow = ts * draw.decades(0.001, 3.0);
    let fast = ts * draw.decades(-3.0, -0.001);
    let single = if two { draw.index(7) } else { draw.index(4) };
    match single {
        0 => (Factor::first(slow), 1),
        1 => (Factor::first(fast), 0),
        2 => (Factor::first(-slow), 0),
        3 => (Factor::first(-fast), 0),
        4 => (Factor::second(slow + fast, slow * fast), 1),
        5 => (Factor::second(slow - fast, -(slow * fast)), 1),
        _ => {
            let damping = draw.between(-0.9, 0.9);
            (Factor::second(2.0 * damping * slow, slow * slow), 0)
        }
    }
}
