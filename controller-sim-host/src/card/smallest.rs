//! The smallest error that still moves the output, in the number type of the target.

use super::deployed::{Deployed, rest};
use controller_core::{ControllerInput, Real};

/// Most samples of a trial, and fewest: by then the filters of a law have settled.
const MOST: f64 = 1_048_576.0;
const FEWEST: f64 = 8192.0;
/// Trials last this many times what the integral term takes for one step of the output.
const LONG: f64 = 16.0;

/// A constant error that moves the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Smallest {
    /// Its size \[y\].
    pub(super) error: f64,
    /// Distance of the measurement's neighbours in the number type, at the operating point \[y\].
    pub(super) spacing: f64,
    /// From which error on the compensated sum of the integral term moves \[y\]; infinite without one.
    pub(super) sum: f64,
    /// The same of a plain sum \[y\].
    pub(super) plain: f64,
    /// Where it was looked at \[y\].
    pub(super) level: f64,
    /// Samples after which the output of the real step still moved; none where that takes longer than a trial.
    pub(super) seen: Option<u64>,
}

/// Derives it and tries it with the law itself.
///
/// Two things swallow an error. The measurement next to the set-point is one unit in its last place away, `s`: nothing
/// smaller can be told. And an increment of the integral term must reach its sum: the compensated one loses what is below
/// `eps^2*|I|/4`, a plain one what is below `eps*|I|/2`, so with `gamma` the increment per unit of error
/// `e = max(s, eps^2*|I|/(4*gamma))`, and a deadband comes on top. With that error the law runs until its filters have
/// settled, and as long again: the output must be another one at the end, or the error is doubled. Without an integral
/// term the error must move the output at all.
pub(super) fn smallest<T: Real>(deployed: &Deployed<'_, T>) -> Option<Smallest> {
    let point = &deployed.point;
    let config = &deployed.spec.config;
    let y0 = T::from_f64(point.y0 + point.setpoint).to_f64();
    let u0 = output(deployed, y0);
    let spacing = unit::<T>(y0);
    let gamma = drift(deployed);
    let level = integral(deployed, y0, u0).abs();
    let (sum, plain) = (0.25 * T::EPS * T::EPS * level / gamma, 0.5 * T::EPS * level / gamma);
    let integrates = gamma > 0.0;
    let mut steps = if integrates { (sum / spacing).ceil().max(1.0) } else { 1.0 };
    let error = |steps: f64| config.deadband + steps * spacing;
    let found = |steps: f64, seen: Option<u64>| Smallest {
        error: error(steps),
        spacing,
        sum: if integrates { sum } else { f64::INFINITY },
        plain: if integrates { plain } else { f64::INFINITY },
        level: y0,
        seen,
    };
    while steps * spacing <= 1e6 * (y0.abs() + point.setpoint.abs()) {
        // Until the integral term has moved by a unit in the last place of the output.
        let due = unit::<T>(u0).max(unit::<T>(level)) / (gamma * steps * spacing);
        if integrates && due * LONG > MOST {
            return Some(found(steps, None));
        }
        let long = if integrates { (due * LONG).max(FEWEST) as u64 } else { 0 };
        if moves(deployed, (y0, u0), error(steps), long) {
            return Some(found(steps, Some(long.max(1))));
        }
        steps *= 2.0;
    }
    None
}

/// The output at rest there \[u\]: an integrating plant needs none without a load, and at a limit nothing could move.
fn output<T: Real>(deployed: &Deployed<'_, T>, y0: f64) -> f64 {
    let (point, limits) = (&deployed.point, &deployed.spec.config.limits);
    let at = |load: f64| rest(deployed.scenario, (y0, load));
    let free = at(point.d0);
    let u0 = if free == 0.0 { at(point.d0 + point.load) } else { free };
    if limits.lo < u0 && u0 < limits.hi { u0 } else { 0.5 * (limits.lo + limits.hi) }
}

/// Whether a constant error to either side moves the output of the law: in the second half of `long` samples, or at all in
/// [`FEWEST`] when `long` is 0.
fn moves<T: Real>(deployed: &Deployed<'_, T>, (y0, u0): (f64, f64), error: f64, long: u64) -> bool {
    let one = |error: f64| {
        let mut law = deployed.law.clone();
        law.settle(deployed.spec.mode, y0, y0, u0);
        let sample = |y: f64| ControllerInput {
            r: T::from_f64(y0),
            r_remote: T::from_f64(y0),
            y: T::from_f64(y),
            mode: deployed.spec.mode,
            ..ControllerInput::default()
        };
        let mut before = law.step(&sample(y0)).u;
        let off = sample(y0 - error);
        for _ in 0..long / 2 {
            before = law.step(&off).u;
        }
        let rest = if long == 0 { FEWEST as u64 } else { long / 2 };
        (0..rest).any(|_| law.step(&off).u != before)
    };
    one(error) && one(-error)
}

/// How much the output drifts in one sample per unit of a constant error [u/y], by the integral term, or else by whatever
/// integrates in its place: `(z-1) K(z)` for `z` to 1.
fn drift<T: Real>(deployed: &Deployed<'_, T>) -> f64 {
    let own = deployed.law.pid().map_or(0.0, |pid| (pid.ki_now.to_f64() + pid.ki_before.to_f64()).abs());
    if own > 0.0 {
        return own;
    }
    const NEAR: f64 = 1e-7;
    let here = NEAR * deployed.sampled.at(NEAR).controller().abs();
    let above = 10.0 * NEAR * deployed.sampled.at(10.0 * NEAR).controller().abs();
    // Without an integral term it falls with the frequency.
    if here < 0.5 * above || !here.is_finite() { 0.0 } else { here }
}

/// The sum that integrates at rest \[u\].
fn integral<T: Real>(deployed: &Deployed<'_, T>, y0: f64, u0: f64) -> f64 {
    deployed.law.pid().map_or(u0, |pid| u0 - (pid.p_r.to_f64() - pid.p_y.to_f64()) * y0)
}

/// Distance from `x` to the next number of `T` away from 0.
fn unit<T: Real>(x: f64) -> f64 {
    let (_, exponent) = libm::frexp(x);
    let least = T::SMALLEST_NORMAL * T::EPS;
    (T::EPS * libm::ldexp(0.5, exponent)).max(least)
}
