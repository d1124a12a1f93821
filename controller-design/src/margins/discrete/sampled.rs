//! The sampled loop as a frequency response, and its stability.

use super::delay::delay_margin;
use super::extremes::extremes;
use super::jitter::jitter_margin;
use super::law::DiscreteLaw;
use super::noise::{NoiseGains, increment, noise_gains};
use super::sweep::Sweep;
use crate::Refusal;
use crate::hold::{HoldEquivalent, minus_one};
use crate::margins::Margins;
use crate::model::{Complex, TransferFunction};

/// A plant behind a zero-order hold with the discrete law that controls it.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::margins::{DiscreteLaw, DiscreteLoop};
/// use controller_design::model::parse;
///
/// // An integrator sampled every second under kp: L = kp/(z-1), the closed loop's pole is 1-kp.
/// let plant = parse("1/s").expect("a plant");
/// let law = DiscreteLaw::new(&PidConfig { kp: 0.5, ..PidConfig::default() }, 1.0).expect("valid");
/// let held = DiscreteLoop::new(&plant, law, 0.0).expect("in range");
/// let margins = held.margins().expect("a stable loop");
/// assert!((margins.gm - 4.0).abs() < 1e-12);
/// assert!((held.noise().white - libm::sqrt(1.0 / 3.0)).abs() < 1e-9);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DiscreteLoop {
    plant: TransferFunction,
    held: HoldEquivalent,
    law: DiscreteLaw,
    latency: f64,
}

/// Everything about a loop at one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopResponse {
    /// `w*ts` in rad.
    pub theta: f64,
    /// The hold equivalent `G_d` of the plant \[y/u\].
    pub plant: Complex,
    /// `C - C_y`, from `-y` to `u` before the compensator's `u` path \[u/y\].
    pub feedback: Complex,
    /// `1 - C_u`.
    pub own: Complex,
}

impl LoopResponse {
    /// `F = 1 - C_u + G_d*(C - C_y)`.
    #[must_use]
    pub fn denominator(&self) -> Complex {
        self.own + self.plant * self.feedback
    }

    /// The loop gain `L` at the plant input.
    #[must_use]
    pub fn open(&self) -> Complex {
        self.plant * self.feedback / self.own
    }

    /// The sensitivity `S = 1/(1+L)`.
    #[must_use]
    pub fn sensitivity(&self) -> Complex {
        self.own / self.denominator()
    }

    /// The complementary sensitivity `T = L/(1+L)`.
    #[must_use]
    pub fn complementary(&self) -> Complex {
        self.plant * self.feedback / self.denominator()
    }

    /// The controller by itself, `(C - C_y)/(1 - C_u)`, from `-y` to `u` \[u/y\].
    #[must_use]
    pub fn controller(&self) -> Complex {
        self.feedback / self.own
    }

    /// From measurement noise to `u` in the closed loop, `-(C - C_y)/F` \[u/y\].
    #[must_use]
    pub fn noise(&self) -> Complex {
        -self.feedback / self.denominator()
    }
}

/// The refusal of a loop whose delay turns too often below the Nyquist frequency.
pub(crate) const TOO_MANY_TURNS: Refusal = Refusal::NoSolution {
    why: "the dead time is too many samples long to follow all its turns",
    help: "choose a longer ts: a hundredth of the dead time is short enough for any loop",
};

impl DiscreteLoop {
    /// The loop of `plant` and `law`; `latency` \[s\] from reading `y` to acting `u`. The law's compensator keeps the
    /// latency it was configured with.
    ///
    /// # Errors
    /// Those of [`HoldEquivalent::new`].
    pub fn new(plant: &TransferFunction, law: DiscreteLaw, latency: f64) -> Result<Self, Refusal> {
        let held = HoldEquivalent::new(plant, law.ts(), latency)?;
        Ok(Self { plant: plant.clone(), held, law, latency })
    }

    /// The same loop with `extra` seconds more between the controller's output and the plant.
    pub(super) fn later(&self, extra: f64) -> Result<Self, Refusal> {
        Self::new(&self.plant, self.law.clone(), self.latency + extra)
    }

    /// The law.
    #[must_use]
    pub fn law(&self) -> &DiscreteLaw {
        &self.law
    }

    /// The hold equivalent.
    #[must_use]
    pub fn held(&self) -> &HoldEquivalent {
        &self.held
    }

    /// The plant.
    #[must_use]
    pub fn plant(&self) -> &TransferFunction {
        &self.plant
    }

    /// The sampling period \[s\].
    #[must_use]
    pub fn ts(&self) -> f64 {
        self.law.ts()
    }

    /// The loop at `theta = w*ts` in rad, above 0 and up to pi.
    #[must_use]
    pub fn at(&self, theta: f64) -> LoopResponse {
        let (own, from_y) = self.law.compensator(theta);
        LoopResponse { theta, plant: self.held.at(theta), feedback: self.law.pid(theta) - from_y, own }
    }

    /// The angles in rad, ascending, at which every feature of the loop shows: from well below its slowest one to pi.
    #[must_use]
    pub fn angles(&self) -> Vec<f64> {
        Sweep::of(self).points.iter().map(|p| p.theta).collect()
    }

    /// Number of closed-loop poles outside the unit circle or on it; 0 means stable.
    ///
    /// By the argument principle for `F*prod(1 - p_i/z)` over the plant's poles and that of the integral term, which
    /// has no poles outside and no zero at infinity: no pole is computed. A loop at its very limit counts as unstable.
    #[must_use]
    pub fn unstable_poles(&self) -> usize {
        Sweep::of(self).unstable_poles()
    }

    /// The margins; frequencies in rad/s, up to the Nyquist frequency.
    ///
    /// `gm` and `gm_low` are the factors on the loop gain at which the sampled loop comes to its limit, `delay_margin`
    /// the extra dead time in s, fractions of a sample held exactly; divide by [`ts`](Self::ts) for samples.
    /// Cost: some ms; more with delays of many thousand samples.
    ///
    /// # Errors
    /// An unstable loop has no margins; nor has one whose delay is too many samples long to follow all its turns, some
    /// 25 000 when the loop gain does not fall.
    pub fn margins(&self) -> Result<Margins, Refusal> {
        Ok(self.margins_of(&self.stable()?))
    }

    /// The [`margins`](Self::margins) of a stable loop, of another one its number of
    /// [unstable poles](Self::unstable_poles), at the price of the margins.
    ///
    /// # Errors
    /// A delay that is too many samples long to follow all its turns: whether the loop is stable is not known.
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// use controller_design::margins::{DiscreteLaw, DiscreteLoop};
    /// use controller_design::model::parse;
    ///
    /// // An integrator sampled every second under kp: the closed loop's pole is 1-kp.
    /// let of = |kp: f64| {
    ///     let law = DiscreteLaw::new(&PidConfig { kp, ..PidConfig::default() }, 1.0).expect("valid");
    ///     DiscreteLoop::new(&parse("1/s").expect("a plant"), law, 0.0).expect("in range").margins_or_poles()
    /// };
    /// assert!(of(1.9).expect("known").is_ok());
    /// assert_eq!(of(2.1).expect("known"), Err(1));
    /// ```
    pub fn margins_or_poles(&self) -> Result<Result<Margins, usize>, Refusal> {
        let sweep = Sweep::of(self);
        if sweep.is_cut {
            return Err(TOO_MANY_TURNS);
        }
        Ok(match sweep.unstable_poles() {
            0 => Ok(self.margins_of(&sweep)),
            poles => Err(poles),
        })
    }

    /// [`margins`](Self::margins) and [`noise`](Self::noise) at the price of one.
    ///
    /// # Errors
    /// As for [`margins`](Self::margins).
    pub(crate) fn margins_and_noise(&self) -> Result<(Margins, NoiseGains), Refusal> {
        let sweep = self.stable()?;
        Ok((self.margins_of(&sweep), noise_gains(self, &sweep)))
    }

    /// The largest sensitivity, and the number of points it took.
    ///
    /// # Errors
    /// As for [`margins`](Self::margins).
    pub(crate) fn ms(&self) -> Result<(f64, usize), Refusal> {
        let sweep = self.stable()?;
        Ok((sweep.peak(self, |p| p.sensitivity().abs()).1, sweep.points.len()))
    }

    fn stable(&self) -> Result<Sweep, Refusal> {
        let sweep = Sweep::of(self);
        if sweep.is_cut {
            return Err(TOO_MANY_TURNS);
        }
        if sweep.unstable_poles() > 0 {
            return Err(Refusal::NoSolution {
                why: "the sampled loop is unstable",
                help: "lower the gains, sample faster, or check the sign of the plant's gain",
            });
        }
        Ok(sweep)
    }

    fn margins_of(&self, sweep: &Sweep) -> Margins {
        let mut margins = extremes(self, sweep);
        let (delay_margin, omega_delay) = delay_margin(self, sweep);
        margins.delay_margin = delay_margin;
        margins.omega_delay = omega_delay;
        margins
    }

    /// The gains from measurement noise to the output.
    #[must_use]
    pub fn noise(&self) -> NoiseGains {
        noise_gains(self, &Sweep::of(self))
    }

    /// `std(u[k] - u[k-1])/std(n)` of the closed loop for white noise `n` \[u/y\]: how much of the noise's variation the
    /// actuator sees. Of Gaussian noise the output's total variation grows by `sqrt(2/pi)` times it in each sample, on
    /// average. Meaningless when the loop is unstable.
    #[must_use]
    pub fn noise_increment(&self) -> f64 {
        increment(self, &Sweep::of(self))
    }

    /// The jitter margin in s: the loop stays stable when every output comes late by any time from 0 to this, another one in
    /// each sample, on top of its latency; what comes after a newer one is dropped. Infinite if nothing is fed back.
    ///
    /// Sufficient, not necessary: the loop may bear more, up to [`Margins::delay_margin`], which is the limit for a
    /// lateness that does not change. Cost: some 10 ms.
    /// Source: the criterion of Kao & Lincoln 2004 (Automatica 40:1429) for sampled controllers of continuous plants, and
    /// the margin of Cervin et al. 2004 (RTCSA) made of it, for the dead time and the latency of this loop.
    ///
    /// # Errors
    /// As for [`margins`](Self::margins).
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// use controller_design::margins::{DiscreteLaw, DiscreteLoop};
    /// use controller_design::model::parse;
    ///
    /// // An integrator under kp, sampled fast: w*|T| comes up to kp, so a lateness of 1/kp is safe.
    /// let plant = parse("1/s").expect("a plant");
    /// let law = DiscreteLaw::new(&PidConfig { kp: 0.5, ..PidConfig::default() }, 0.01).expect("valid");
    /// let jitter = DiscreteLoop::new(&plant, law, 0.0).expect("in range").jitter_margin().expect("stable");
    /// assert!((jitter - 2.0).abs() < 0.02);
    /// ```
    pub fn jitter_margin(&self) -> Result<f64, Refusal> {
        Ok(jitter_margin(self, &self.stable()?))
    }

    /// The largest `|u/n|` in the closed loop and its frequency in rad/s.
    #[must_use]
    pub fn noise_peak(&self) -> (f64, f64) {
        let sweep = Sweep::of(self);
        let (theta, gain) = sweep.peak(self, |p| p.noise().abs());
        (gain, theta / self.ts())
    }

    /// `F` with its poles on and outside the unit circle taken away, as a direction; its zeros outside are the
    /// unstable poles.
    pub(super) fn characteristic(&self, at: &LoopResponse) -> Complex {
        let z_minus_one = minus_one(at.theta);
        let back = Complex::new(0.0, -at.theta).exp();
        let mut value = unit(at.denominator());
        if self.law.integrates() {
            value = value * unit(z_minus_one * back);
        }
        for &fall in self.held.falls() {
            value = value * unit((z_minus_one - fall) * back);
        }
        value
    }
}

fn unit(x: Complex) -> Complex {
    let size = x.abs();
    if size > 0.0 { Complex::new(x.re / size, x.im / size) } else { x }
}
