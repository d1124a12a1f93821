//! The laws that run, as frequency responses: nothing but their own coefficients is read.

use std::vec::Vec;

use controller_core::{
    Adrc, AdrcCoefficients, AdrcConfig, AnyCompensator, Coefficients, CompensatorConfig, ConfigErrors, Pid,
    PidCoefficients, PidConfig, Real,
};

use super::owned::OwnedCoefficients;
use crate::hold::{delay_by, minus_one};
use crate::model::Complex;

/// A controller as it runs: a PID and, if there is one, a disturbance compensator, or an ADRC. [`new`](Self::new) and its
/// like build it in double precision; [`of_pid`](Self::of_pid) and [`of_adrc`](Self::of_adrc) take the coefficients of a law
/// that was built in any number type, whose values they hold exactly.
///
/// ```text
/// v = -C(z)*y + u_f,   u_f = C_u(z)*u + C_y(z)*y
/// ```
///
/// for a constant set-point and no limit in force. The responses are those of the difference equations in
/// [`Pid`] and [`Compensator`](controller_core::Compensator), term by term.
///
/// Cost of a response: one division per lag.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::margins::DiscreteLaw;
/// let law = DiscreteLaw::new(&PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() }, 0.1).expect("valid");
/// // At the Nyquist frequency z = -1: kp + ki*ts*z/(z-1).
/// assert!((law.pid(core::f64::consts::PI).re - 2.025).abs() < 1e-15);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DiscreteLaw {
    kind: Kind,
    compensator: Option<OwnedCoefficients>,
    ts: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Pid(PidCoefficients<f64>),
    Adrc(AdrcCoefficients<f64>),
}

impl DiscreteLaw {
    /// A PID alone, discretised for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every fault of [`PidConfig::validate`].
    pub fn new(pid: &PidConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let kind = Kind::Pid(Pid::<f64>::new(pid, ts)?.coefficients());
        Ok(Self { kind, compensator: None, ts })
    }

    /// A PID with a disturbance compensator, whose configuration carries the loop's latency.
    ///
    /// # Errors
    /// Every fault of the two configurations, that of contradicting signs included.
    ///
    /// ```
    /// use controller_core::{EstimatorConfig, PidConfig};
    /// use controller_design::margins::DiscreteLaw;
    /// let pid = PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, ..PidConfig::default() };
    /// let model = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
    /// assert!(DiscreteLaw::with_compensator(&pid, &model.to_compensator(0.0), 0.01).is_ok());
    /// ```
    pub fn with_compensator(
        pid: &PidConfig,
        compensator: &CompensatorConfig,
        ts: f64,
    ) -> Result<Self, ConfigErrors> {
        let capacity = AnyCompensator::<f64, Vec<f64>>::needed_capacity(compensator, ts).saturating_add(2);
        // Both are built before either fails, so that all faults show at once.
        let built =
            (Pid::<f64>::new(pid, ts), AnyCompensator::<f64, Vec<f64>>::new(compensator, ts, capacity));
        let (law, compensation) = match built {
            (Ok(law), Ok(compensation)) => (law, compensation),
            (Err(first), Err(second)) => return Err(first.and(&second)),
            (Err(faults), _) | (_, Err(faults)) => return Err(faults),
        };
        compensator.check_sign(pid)?;
        Ok(Self::of_pid(&law.coefficients(), Some(&compensation.coefficients()), ts))
    }

    /// The law with these coefficients, as a target runs it every `ts` \[s\]: those of an `f32` law are the ones it has
    /// after rounding.
    ///
    /// ```
    /// use controller_core::{Pid, PidConfig};
    /// use controller_design::margins::DiscreteLaw;
    /// let config = PidConfig { kp: 2.0, ki: 0.3, ..PidConfig::default() };
    /// let flashed = Pid::<f32>::new(&config, 0.1).expect("valid").coefficients();
    /// let law = DiscreteLaw::of_pid(&flashed, None, 0.1);
    /// // At z = -1 the integral term is ki*ts/2, with the product in single precision.
    /// assert_eq!(law.pid(core::f64::consts::PI).re, 2.0 + 0.5 * f64::from(0.03_f32));
    /// ```
    #[must_use]
    pub fn of_pid<T: Real>(
        pid: &PidCoefficients<T>,
        compensator: Option<&Coefficients<'_, T>>,
        ts: f64,
    ) -> Self {
        let PidCoefficients { ki_now, ki_before, g, p_r, h_r, p_y, h_y } = *pid;
        let pid = PidCoefficients {
            ki_now: ki_now.to_f64(),
            ki_before: ki_before.to_f64(),
            g: g.to_f64(),
            p_r: p_r.to_f64(),
            h_r: h_r.to_f64(),
            p_y: p_y.to_f64(),
            h_y: h_y.to_f64(),
        };
        Self { kind: Kind::Pid(pid), compensator: compensator.map(OwnedCoefficients::of), ts }
    }

    /// The ADRC with these coefficients, as a target runs it every `ts` \[s\].
    #[must_use]
    pub fn of_adrc<T: Real>(law: &AdrcCoefficients<T>, ts: f64) -> Self {
        let AdrcCoefficients { g, l1, l2, l3, kp, kd } = *law;
        let law = AdrcCoefficients {
            g: g.to_f64(),
            l1: l1.to_f64(),
            l2: l2.to_f64(),
            l3: l3.to_f64(),
            kp: kp.to_f64(),
            kd: kd.to_f64(),
        };
        Self { kind: Kind::Adrc(law), compensator: None, ts }
    }

    /// A second-order ADRC, discretised for the sampling period `ts` \[s\].
    ///
    /// # Errors
    /// Every fault of [`AdrcConfig::validate`]; a coefficient out of range.
    pub fn adrc(config: &AdrcConfig, ts: f64) -> Result<Self, ConfigErrors> {
        let kind = Kind::Adrc(Adrc::<f64>::new(config, ts)?.coefficients());
        Ok(Self { kind, compensator: None, ts })
    }

    /// The sampling period \[s\].
    #[must_use]
    pub fn ts(&self) -> f64 {
        self.ts
    }

    /// Whether there is an integral term.
    #[must_use]
    pub fn integrates(&self) -> bool {
        matches!(self.kind, Kind::Pid(pid) if pid.ki_now != 0.0 || pid.ki_before != 0.0)
    }

    /// `C(exp(j*theta))` of the PID alone, from `-y` to `u`; `theta = w*ts` in rad, above 0 and up to pi. Of an ADRC its
    /// `-C_y`.
    #[must_use]
    pub fn pid(&self, theta: f64) -> Complex {
        let z_minus_one = minus_one(theta);
        let c = match &self.kind {
            Kind::Pid(pid) => pid,
            Kind::Adrc(law) => return Estimator::new(law, theta).feedback(law),
        };
        let tap = Tap::new(c.g, z_minus_one);
        let filtered = tap.value * c.p_y + tap.difference * c.h_y;
        if !self.integrates() {
            return filtered;
        }
        let z = z_minus_one + Complex::ONE;
        filtered + (z * c.ki_now + Complex::real(c.ki_before)) / z_minus_one
    }

    /// `(1 - C_u, C_y)` of the compensator at `theta = w*ts`, `(1, 0)` without one. `1 - C_u` is put together without the
    /// difference: an observer's vanishes at low frequencies.
    #[must_use]
    pub fn compensator(&self, theta: f64) -> (Complex, Complex) {
        if let Kind::Adrc(law) = &self.kind {
            return (Estimator::new(law, theta).own(law), Complex::ZERO);
        }
        let Some(law) = &self.compensator else { return (Complex::ONE, Complex::ZERO) };
        let law = law.view();
        let z_minus_one = minus_one(theta);
        let tap = |g: f64| Tap::new(g, z_minus_one);
        let shared = shared_loss(&law, tap);
        let from_u = u_loss(&law, tap);
        let samples = law.delay.saturating_add(1);
        let late = delay_by(theta, samples);
        // 1 - late = -(exp(-j*n*theta) - 1), small angles exactly.
        let turned = theta * samples as f64;
        let delay_loss = if turned < 1.0 { -minus_one(-turned) } else { Complex::ONE - late };
        let path_loss = delay_loss + late * (from_u + (Complex::ONE - from_u) * shared);
        let one_minus_cu = Complex::real(1.0 - law.gain) + path_loss * law.gain;
        let from_y = y_path(&law, tap) * (Complex::ONE - shared);
        (one_minus_cu, from_y * (-law.gain * law.inv_gain))
    }

    /// The jump of the output in the same sample per unit of a jump of `-y` \[u/y\]: `C - C_y` for `z` to infinity.
    #[must_use]
    pub fn step_gain(&self) -> f64 {
        let pid = match &self.kind {
            Kind::Pid(pid) => pid.h_y + pid.ki_now,
            Kind::Adrc(law) => law.kp * law.l1 + law.kd * law.l2 + law.l3,
        };
        self.compensator.as_ref().map_or(pid, |law| {
            let law = law.view();
            let tap = |_: f64| Tap { value: Complex::ZERO, difference: Complex::ONE };
            let shared: f64 = law.e_gain.iter().map(|g| 0.5 * g).product();
            pid + law.gain * law.inv_gain * y_path(&law, tap).re * shared
        })
    }

    /// Gains of all lags and the samples of delay, for the choice of frequencies.
    pub(super) fn lags(&self) -> (Vec<f64>, usize) {
        let mut gains = match &self.kind {
            Kind::Pid(pid) => Vec::from([pid.g]),
            // About the poles of the observer and of the feedback.
            Kind::Adrc(law) => Vec::from([law.l1 / 3.0, law.kp / law.kd, law.kd * law.g]),
        };
        let mut delay = 0;
        if let Some(law) = &self.compensator {
            let law = law.view();
            gains.extend(law.g);
            gains.extend(law.e_gain);
            delay = law.delay.saturating_add(1);
        }
        (gains, delay)
    }

    /// Whether there is a compensator.
    #[must_use]
    pub fn compensates(&self) -> bool {
        self.compensator.is_some()
    }
}

/// The state observer of an ADRC at one frequency. With `q = 1/z`, `n = 1 - q` and the innovation `e`
///
/// ```text
/// P*e = n^3*y - g*q*n*(1+q)/2*u,   P = n^2*(n*(1-l1) + l1) + q*n*l2 + g*q*(1+q)/2*l3
/// ```
struct Estimator {
    q: Complex,
    n: Complex,
    p: Complex,
    /// `g*q*(1+q)/2`.
    push: Complex,
    /// `n*(n*(1-l1) + l1) + q*l2`.
    rest: Complex,
}

impl Estimator {
    fn new(law: &AdrcCoefficients<f64>, theta: f64) -> Self {
        let z_minus_one = minus_one(theta);
        let q = minus_one(-theta) + Complex::ONE;
        // 1 - 1/z = (z - 1)/z, without the difference.
        let n = z_minus_one * q;
        let push = q * (q + Complex::ONE) * (0.5 * law.g);
        let rest = n * (n * (1.0 - law.l1) + Complex::real(law.l1)) + q * law.l2;
        Self { q, n, p: n * rest + push * law.l3, push, rest }
    }

    /// `-C_y`: from `-y` to `u`.
    fn feedback(&self, law: &AdrcCoefficients<f64>) -> Complex {
        let Self { q, n, p, .. } = *self;
        let square = n * n;
        let z1 = Complex::ONE - square * n / p * (1.0 - law.l1);
        let w = (q * n * (law.g * law.l3) + square * law.l2) / p;
        let d = square / p * law.l3;
        z1 * law.kp + w * law.kd + d
    }

    /// `1 - C_u`, which vanishes at low frequencies.
    fn own(&self, law: &AdrcCoefficients<f64>) -> Complex {
        let Self { q, n, p, push, rest } = *self;
        let e = n * push / p;
        let z1 = e * (1.0 - law.l1);
        let w = (q * rest * law.g - push * law.l2) / p;
        n * rest / p + z1 * law.kp + w * law.kd
    }
}

/// State of a lag and difference of its input from it, per unit of its input.
#[derive(Clone, Copy)]
struct Tap {
    value: Complex,
    difference: Complex,
}

impl Tap {
    fn new(g: f64, z_minus_one: Complex) -> Self {
        let pole = z_minus_one + Complex::real(g);
        Self { value: Complex::real(g) / pole, difference: z_minus_one / pole }
    }
}

/// One minus the response of the shared lags, `value + g/2*difference` each.
fn shared_loss(law: &Coefficients<'_, f64>, tap: impl Fn(f64) -> Tap) -> Complex {
    law.e_gain.iter().fold(Complex::ZERO, |loss, &g| {
        let own = tap(g).difference * (1.0 - 0.5 * g);
        loss + (Complex::ONE - loss) * own
    })
}

/// One minus the response of the `u` chain: `sum (1 - E_j)*(w_(j-1) - w_j)`.
fn u_loss(law: &Coefficients<'_, f64>, tap: impl Fn(f64) -> Tap) -> Complex {
    let mut x = Complex::ONE;
    let mut loss = Complex::ZERO;
    for (&g, &lead) in law.g.iter().zip(law.u_lead) {
        let lag = tap(g);
        loss = loss + x * lag.difference * (1.0 - lead);
        x = x * lag.value;
    }
    loss
}

/// The response of the `y` sections.
fn y_path(law: &Coefficients<'_, f64>, tap: impl Fn(f64) -> Tap) -> Complex {
    let mut x = Complex::ONE;
    let leads = law.y_feed.chunks(2).zip(law.y_lead.chunks(2));
    for ((g, (feed, lead)), dc) in law.g.chunks(2).zip(leads).zip(law.y_dc.chunks(2)) {
        x = match (g, feed, lead, dc) {
            (&[g1, g2], &[feed, _], &[e1, e2], &[_, dc]) => {
                let (one, two) = (tap(g1), tap(g2));
                let between = one.value + one.difference * feed;
                x * ((two.value * dc + two.difference * e2) * between + one.difference * e1)
            }
            (&[g], _, &[lead], &[dc]) => {
                let lag = tap(g);
                x * (lag.value * dc + lag.difference * lead)
            }
            // The lists have one length.
            _ => x,
        };
    }
    x
}
