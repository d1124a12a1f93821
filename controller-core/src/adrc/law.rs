//! The discretised ADRC and its state.

use super::config::AdrcConfig;
use super::poles::one_minus_q;
use crate::accumulator::Accumulator;
use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::real::{Real, coefficient};

/// The second-order ADRC of the [module](crate::adrc), discretised for one sampling period.
///
/// The model `y'' = b0*(u + d)` is taken through one sample exactly (held `u`), then corrected with the measurement of
/// this sample; the observer's poles are `exp(ts*s)` of the continuous ones. The states are signals: `z1` \[y\],
/// `w = ts*z2` [y per sample], `d = z3/b0` \[u\]. With `g = b0*ts^2`, `a` the output applied since the last sample, and
/// `e1, e2, e3` the elementary symmetric functions of `1 - exp(ts*s)`:
///
/// ```text
/// x     = g*(a + d[k-1])
/// e[k]  = y[k] - (z1[k-1] + w[k-1] + x/2)                       innovation
/// z1[k] = z1[k-1] + w[k-1] + x/2 + (e1 - e2 + e3)*e[k]
/// w[k]  = w[k-1] + x + (e2 - 3/2*e3)*e[k]
/// d[k]  = d[k-1] + e3/g*e[k]
/// u[k]  = kp/b0*(r[k] - z1[k]) - kd/(b0*ts)*w[k] - d[k]
/// ```
///
/// The observer is told what was applied, so that a saturated output winds nothing up. The three sums are compensated
/// ([`Accumulator`]); every number of the state is a signal and stays valid when the law is replaced.
///
/// Inputs must be finite: a bare law does not check them, [`Controller`](crate::Controller) does.
/// Cost: 35 additions, subtractions and multiplications, no division, no branch.
/// Source: figure 13 of Vrančić & Huba 2021; the sampled observer after Miklosovic, Radke & Gao 2006.
///
/// ```
/// use controller_core::{Adrc, AdrcConfig, AdrcInput, AdrcState};
/// // A motor y'' = 50*(u + d) with a load d = -0.4.
/// let law = Adrc::<f64>::new(&AdrcConfig::from_bandwidths(50.0, 10.0, 40.0), 0.001).unwrap();
/// let mut state = AdrcState::default();
/// let (mut y, mut speed, mut u) = (0.0, 0.0, 0.0);
/// for _ in 0..3000 {
///     u = law.step(&mut state, AdrcInput { r: 1.0, y, u }).u();
///     let acceleration = 50.0 * (u - 0.4);
///     y += 0.001 * speed + 0.5e-6 * acceleration;
///     speed += 0.001 * acceleration;
/// }
/// assert!((y - 1.0).abs() < 1e-9 && (state.disturbance() + 0.4).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adrc<T> {
    g: T,
    half_g: T,
    l1: T,
    l2: T,
    l3: T,
    kp: T,
    kd: T,
    /// Bounds that no state passes in regular use: beyond them a product could overflow.
    most_y: T,
    most_u: T,
    ts: T,
}

/// The coefficients of an [`Adrc`] as numbers: what an export writes and what an analysis of the deployed law reads. The
/// difference equation is that of [`Adrc`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AdrcCoefficients<T> {
    /// `b0*ts^2` [y/u].
    pub g: T,
    /// Share of the innovation in `z1`.
    pub l1: T,
    /// Share of the innovation in `w`.
    pub l2: T,
    /// Share of the innovation in `d` [u/y].
    pub l3: T,
    /// `kp/b0` [u/y].
    pub kp: T,
    /// `kd/(b0*ts)` [u/y].
    pub kd: T,
}

/// State of an [`Adrc`]: signals only.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AdrcState<T> {
    z1: Accumulator<T>,
    w: Accumulator<T>,
    d: Accumulator<T>,
    r: T,
}

/// What an [`Adrc`] reads in one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdrcInput<T> {
    /// Set-point \[y\].
    pub r: T,
    /// Measurement \[y\].
    pub y: T,
    /// Output that was applied since the last sample, limited \[u\].
    pub u: T,
}

/// What an [`Adrc`] gives in one sample \[u\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AdrcOutput<T> {
    /// Feedback of the estimated `y` and `y'`.
    pub pd: T,
    /// Estimate of everything that the model leaves out, as an input of the plant.
    pub d: T,
}

impl<T: Real> AdrcOutput<T> {
    /// The output before any offset or limit: `pd - d`.
    #[must_use]
    #[inline(always)]
    pub fn u(&self) -> T {
        self.pd - self.d
    }
}

impl<T: Real> Adrc<T> {
    /// Discretises `config` for the sampling period `ts` \[s\]; computed in `f64`, each coefficient rounded once.
    ///
    /// # Errors
    /// Every fault of [`AdrcConfig::validate`], all at once; a coefficient that `T` cannot hold, as
    /// [`Param::Overflow`].
    pub fn new(config: &AdrcConfig, ts: f64) -> Result<Self, ConfigErrors> {
        config.validate(ts)?;
        let [e1, e2, e3] = one_minus_q([config.beta1, config.beta2, config.beta3], ts);
        let g = config.b0 * ts * ts;
        let (kp, kd) = (config.kp / config.b0, config.kd / (config.b0 * ts));
        let [l1, l2, l3] = [e1 - e2 + e3, e2 - 1.5 * e3, e3 / g];
        let mut check = Checker::default();
        // What is flushed to 0 or overflows would make another law.
        let (least, most) = (2.0 * T::SMALLEST_NORMAL, 1e-6 * T::LARGEST);
        for size in [g, l1, l2, l3, kp, kd].map(f64::abs) {
            if size.is_nan() || size < least || size > most {
                check.fault(Param::Overflow, Reason::OutOfRange, size, least, most);
                break;
            }
        }
        let gains = [kp, kd, l2, l3].iter().fold(1.0, |m: f64, x| if x.abs() > m { x.abs() } else { m });
        let most_y = 1e-3 * T::LARGEST / gains;
        // What `d` moves in one sample is no more than what the other estimates may be.
        let most_u = (most_y / g.abs()).min(1e-3 * T::LARGEST);
        check.finish(Self {
            g: coefficient(g),
            half_g: coefficient(0.5 * g),
            l1: coefficient(l1),
            l2: coefficient(l2),
            l3: coefficient(l3),
            kp: coefficient(kp),
            kd: coefficient(kd),
            most_y: coefficient(most_y),
            most_u: coefficient(most_u),
            ts: coefficient(ts),
        })
    }

    /// One sample. See the type for the equation, units and cost.
    #[inline]
    pub fn step(&self, state: &mut AdrcState<T>, input: AdrcInput<T>) -> AdrcOutput<T> {
        self.observe(state, input.y, input.u);
        state.r = input.r;
        AdrcOutput { pd: self.feedback(state, input.r), d: state.d.value() }
    }

    /// Takes the observer through the last sample, in which `u` was applied \[u\], and corrects it with `y` \[y\].
    #[inline(always)]
    pub(crate) fn observe(&self, state: &mut AdrcState<T>, y: T, u: T) {
        let push = u + state.d.value();
        state.z1.add(state.w.value() + self.half_g * push);
        let e = state.z1.short_of(y);
        state.z1.add(self.l1 * e);
        state.w.add(self.g * push + self.l2 * e);
        state.d.add(self.l3 * e);
    }

    /// `kp/b0*(r - z1) - kd/b0*z2` \[u\].
    #[inline(always)]
    pub(crate) fn feedback(&self, state: &AdrcState<T>, r: T) -> T {
        self.kp * state.z1.short_of(r) - self.kd * state.w.value()
    }

    /// Puts the observer at rest at `input.y`, with the estimate of `d` such that the output is `input.u`:
    /// `z1 = y`, `w = 0`, `d = kp/b0*(r - y) - u`. Nothing moves when `r = y`.
    pub fn settle(&self, state: &mut AdrcState<T>, input: AdrcInput<T>) {
        *state = AdrcState {
            z1: Accumulator::new(input.y),
            w: Accumulator::new(T::ZERO),
            d: Accumulator::new(self.kp * (input.r - input.y) - input.u),
            r: input.r,
        };
    }

    /// Takes `state` over from the law `old` without a bump: estimates of the plant's output and its slope are kept, `d`
    /// absorbs the difference of the feedbacks. The sampling period may differ.
    pub fn adopt(&self, old: &Self, state: &mut AdrcState<T>) {
        let r = state.r;
        let shift = self.convert(old, state, r);
        state.d.add(-shift);
    }

    /// Converts the slope to this law's sampling period; returns by how much its feedback at the set-point `r` falls short
    /// of what the old law's was \[u\].
    pub(crate) fn convert(&self, old: &Self, state: &mut AdrcState<T>, r: T) -> T {
        let before = old.feedback(state, state.r);
        if self.ts != old.ts {
            state.w.set(state.w.value() / old.ts * self.ts);
        }
        before - self.feedback(state, r)
    }

    /// Every number of the law.
    pub(crate) const fn numbers(&self) -> [T; 10] {
        let Self { g, half_g, l1, l2, l3, kp, kd, most_y, most_u, ts } = *self;
        [g, half_g, l1, l2, l3, kp, kd, most_y, most_u, ts]
    }

    /// The coefficients, for export and analysis.
    #[must_use]
    pub const fn coefficients(&self) -> AdrcCoefficients<T> {
        let Self { g, l1, l2, l3, kp, kd, .. } = *self;
        AdrcCoefficients { g, l1, l2, l3, kp, kd }
    }

    /// Gain from a step of `y` to the output in the same sample [u/y], as a size:
    /// `kp/b0*(e1 - e2 + e3) + kd/(b0*ts)*(e2 - 3/2*e3) + e3/g`.
    #[must_use]
    pub fn high_frequency_gain(&self) -> T {
        (self.kp * self.l1 + self.kd * self.l2 + self.l3).magnitude()
    }

    /// Whether the output has to fall for the plant's output to rise: `b0 < 0`.
    #[must_use]
    pub fn is_reversed(&self) -> bool {
        self.g < T::ZERO
    }

    /// The smallest constant innovation \[y\] that still moves `d` when that is of size `level` \[u\]; see
    /// [`Pid::resolution`](crate::Pid::resolution).
    #[must_use]
    pub fn resolution(&self, level: T) -> f64 {
        let spacing = T::EPS * level.to_f64().abs();
        0.25 * T::EPS * spacing / self.l3.to_f64().abs()
    }

    /// The largest number that a step can form from signals up to `y` and outputs up to `u` in size, for overflow checks:
    /// no estimate goes far beyond what it is made from.
    pub(crate) fn bound(&self, y: f64, u: f64) -> f64 {
        let size = |x: T| x.to_f64().abs();
        let (g, l3) = (size(self.g), size(self.l3));
        let d = u + 8.0 * l3 * y;
        let moves = 8.0 * y + 8.0 * g * (u + d);
        (size(self.kp) + size(self.kd) + l3 + 1.0) * moves + d
    }

    /// The largest number that a step can form from `state`.
    pub(crate) fn reach(&self, state: &AdrcState<T>, r: f64, y: f64, u: f64) -> f64 {
        let size = |x: T| x.to_f64().abs();
        let [z1, z1_carry, w, w_carry, d, d_carry, _] = state.parts().map(|x| x.to_f64().abs());
        let moves = z1 + z1_carry + w + w_carry + y + 2.0 * size(self.g) * (u + d + d_carry);
        let gains = size(self.kp) + size(self.kd) + size(self.l3) + 2.0;
        gains * (2.0 * moves + r) + d + d_carry
    }

    /// Keeps the estimates where no product overflows: only an observer with hardly any damping comes near.
    #[inline(always)]
    pub(crate) fn bound_estimates(&self, state: &mut AdrcState<T>) {
        state.z1.keep_within(self.most_y);
        state.w.keep_within(self.most_y);
        self.bound_disturbance(state);
    }

    /// Keeps the estimate of the disturbance where no product overflows.
    #[inline(always)]
    pub(crate) fn bound_disturbance(&self, state: &mut AdrcState<T>) {
        state.d.keep_within(self.most_u);
    }
}

impl<T: Real> AdrcState<T> {
    /// The estimate of the plant's output, `z1` \[y\].
    #[must_use]
    pub fn output(&self) -> T {
        self.z1.value()
    }

    /// The estimate of the plant's slope in one sampling period, `ts*z2` \[y\].
    #[must_use]
    pub fn slope(&self) -> T {
        self.w.value()
    }

    /// The estimate of everything that the model leaves out, `z3/b0` \[u\].
    #[must_use]
    #[inline(always)]
    pub fn disturbance(&self) -> T {
        self.d.value()
    }

    /// Sets the estimate of the disturbance \[u\].
    #[inline(always)]
    pub(crate) fn set_disturbance(&mut self, d: T) {
        self.d.set(d);
    }

    /// Moves the estimate of the disturbance \[u\].
    #[inline(always)]
    pub(crate) fn shift_disturbance(&mut self, by: T) {
        self.d.add(by);
    }

    /// The set-point of this sample.
    #[inline(always)]
    pub(crate) fn set_r(&mut self, r: T) {
        self.r = r;
    }

    /// The numbers of the state, for a snapshot.
    pub(crate) fn parts(&self) -> [T; 7] {
        let (z1, w, d) = (&self.z1, &self.w, &self.d);
        [z1.value(), z1.carry(), w.value(), w.carry(), d.value(), d.carry(), self.r]
    }

    /// The inverse of [`parts`](Self::parts).
    pub(crate) fn from_parts(parts: [T; 7]) -> Self {
        let [z1, z1_carry, w, w_carry, d, d_carry, r] = parts;
        Self {
            z1: Accumulator::from_parts(z1, z1_carry),
            w: Accumulator::from_parts(w, w_carry),
            d: Accumulator::from_parts(d, d_carry),
            r,
        }
    }
}
