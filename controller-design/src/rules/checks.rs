//! What every rule asks of the numbers it is given, and of those it gives.

use controller_core::PidConfig;

use crate::Refusal;

/// A gain: finite, not 0.
pub(super) fn gain(value: f64) -> Result<(), Refusal> {
    if value.is_finite() && value != 0.0 {
        Ok(())
    } else {
        Err(Refusal::Plant {
            must: "have a finite gain other than 0",
            help: "check the gain of the model or the size of the recorded change",
        })
    }
}

/// Above 0 and finite.
pub(super) fn positive(parameter: &'static str, value: f64) -> Result<(), Refusal> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(Refusal::OutOfRange { parameter, value, min: 0.0, max: f64::INFINITY })
    }
}

/// 0 or more and finite.
pub(super) fn not_negative(parameter: &'static str, value: f64) -> Result<(), Refusal> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(Refusal::OutOfRange { parameter, value, min: 0.0, max: f64::INFINITY })
    }
}

/// A dead time above 0, which a rule divides by.
pub(super) fn some_dead_time(value: f64) -> Result<(), Refusal> {
    if value == 0.0 {
        return Err(Refusal::Plant {
            must: "have a dead time: without one the rule asks for an infinite gain",
            help: "add what the loop itself delays: half of ts, and the latency",
        });
    }
    positive("dead_time", value)
}

/// The configuration, unless a number of it left the range of `f64`.
pub(super) fn in_range(pid: PidConfig) -> Result<PidConfig, Refusal> {
    let PidConfig { kp, ki, kd, tf, b, c, .. } = pid;
    let lost = |x: f64| x != 0.0 && x.abs() < f64::MIN_POSITIVE;
    if [kp, ki, kd, tf, b, c].iter().all(|x| x.is_finite())
        && ki != 0.0
        && ![kp, ki, kd].into_iter().any(lost)
    {
        Ok(pid)
    } else {
        Err(OUT_OF_RANGE)
    }
}

/// Numbers that are too large or too small.
pub(super) const OUT_OF_RANGE: Refusal = Refusal::NoSolution {
    why: "the gains do not fit into double precision",
    help: "scale the plant: a gain and time constants near 1",
};
