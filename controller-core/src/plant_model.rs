//! The plant as the disturbance blocks need it: gain, factors, dead time.
//!
//! `G(s) = K * prod(zeros) * exp(-s*dead_time) / (s^k * prod(poles))`, each factor `1 + a1*s + a2*s^2`
//! (Tena et al. 2022, eq. (22), with second-order factors allowed).

use heapless::Vec;

/// The largest order of a plant model's denominator, integrators included.
pub const MAX_ORDER: usize = 8;

/// Room for factors: one more than can be valid, so that a model of too high an order is refused, never cut.
pub const MAX_FACTORS: usize = MAX_ORDER + 1;

/// One factor `1 + a1*s + a2*s^2` of a transfer function, unit gain at `s = 0`.
///
/// `a1` in seconds, `a2` in seconds squared. `a2 = 0` is a first-order factor: a lag when it stands in a
/// denominator, a zero at `s = -1/a1` when in a numerator (negative `a1`: a right-half-plane zero).
///
/// ```
/// use controller_core::plant_model::Factor;
/// assert_eq!(Factor::first(0.5), Factor { a1: 0.5, a2: 0.0 });
/// assert_eq!(Factor::second(1.2, 0.2).order(), 2);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Factor {
    /// Coefficient of `s` \[s\].
    pub a1: f64,
    /// Coefficient of `s^2` [s^2]; 0 for a first-order factor.
    pub a2: f64,
}

impl Factor {
    /// `1 + t*s`.
    #[must_use]
    pub const fn first(t: f64) -> Self {
        Self { a1: t, a2: 0.0 }
    }

    /// `1 + a1*s + a2*s^2`.
    #[must_use]
    pub const fn second(a1: f64, a2: f64) -> Self {
        Self { a1, a2 }
    }

    /// 2 when `a2` is not zero, else 1.
    #[must_use]
    pub const fn order(&self) -> usize {
        if self.a2 == 0.0 { 1 } else { 2 }
    }
}

/// A plant model: `gain * prod(zeros) * exp(-s*dead_time) / (s^integrators * prod(poles))`.
///
/// Units: with an output in `\[y\]` and an input in `\[u\]`, `gain` is `[y/u/s^integrators]`; times in seconds.
///
/// ```
/// use controller_core::plant_model::{Factor, PlantModel};
/// // 1.98 * exp(-3.2 s) / (1 + 80.3 s), the tank of Tena et al., eq. (48)
/// let tank = PlantModel::first_order(1.98, 80.3, 3.2);
/// assert_eq!(tank.poles[0], Factor::first(80.3));
/// assert_eq!(tank.order(), 1);
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlantModel {
    /// Static gain `K` (gain of the rate for an integrating plant); not zero.
    pub gain: f64,
    /// Number `k` of pure integrators `1/s`.
    pub integrators: usize,
    /// Denominator factors; stable: `a1 > 0`, `a2 >= 0`.
    pub poles: Vec<Factor, MAX_FACTORS>,
    /// Numerator factors; any sign.
    pub zeros: Vec<Factor, MAX_FACTORS>,
    /// Dead time \[s\], `>= 0`.
    pub dead_time: f64,
}

impl PlantModel {
    /// `gain * exp(-s*dead_time) / (1 + tau*s)`.
    #[must_use]
    pub fn first_order(gain: f64, tau: f64, dead_time: f64) -> Self {
        Self::default().with_gain(gain).with_pole(Factor::first(tau)).with_dead_time(dead_time)
    }

    /// `gain * exp(-s*dead_time) / (1 + a1*s + a2*s^2)`, the model of eq. (13) of Vrančić & Huba 2021.
    #[must_use]
    pub fn second_order(gain: f64, a1: f64, a2: f64, dead_time: f64) -> Self {
        Self::default().with_gain(gain).with_pole(Factor::second(a1, a2)).with_dead_time(dead_time)
    }

    /// `gain * exp(-s*dead_time) / s`.
    #[must_use]
    pub fn integrating(gain: f64, dead_time: f64) -> Self {
        Self { gain, integrators: 1, dead_time, ..Self::default() }
    }

    /// The same model with another gain.
    #[must_use]
    pub fn with_gain(mut self, gain: f64) -> Self {
        self.gain = gain;
        self
    }

    /// The same model with another dead time \[s\].
    #[must_use]
    pub fn with_dead_time(mut self, dead_time: f64) -> Self {
        self.dead_time = dead_time;
        self
    }

    /// The same model with one more denominator factor. Beyond [`MAX_FACTORS`] a factor cannot be stored, but a
    /// model that full has an order above [`MAX_ORDER`] and is refused by every block anyway.
    #[must_use]
    pub fn with_pole(mut self, pole: Factor) -> Self {
        let _ = self.poles.push(pole);
        self
    }

    /// The same model with one more numerator factor; room as for [`with_pole`](Self::with_pole).
    #[must_use]
    pub fn with_zero(mut self, zero: Factor) -> Self {
        let _ = self.zeros.push(zero);
        self
    }

    /// Order of the denominator, integrators included.
    #[must_use]
    pub fn order(&self) -> usize {
        self.integrators.saturating_add(self.poles.iter().map(Factor::order).sum())
    }

    /// Order of the numerator.
    #[must_use]
    pub fn zeros_order(&self) -> usize {
        self.zeros.iter().map(Factor::order).sum()
    }
}

impl Factor {
    /// The factor as `(1 + slow*s)*(1 + fast*s)`, `slow >= fast` \[s\], or `None` when its roots are complex.
    /// A first-order factor gives `fast = 0`.
    ///
    /// ```
    /// use controller_core::plant_model::Factor;
    /// assert_eq!(Factor::second(3.0, 2.0).real_time_constants(), Some((2.0, 1.0)));
    /// assert_eq!(Factor::second(0.4, 1.0).real_time_constants(), None);
    /// ```
    #[must_use]
    pub fn real_time_constants(&self) -> Option<(f64, f64)> {
        if self.a2 == 0.0 {
            return Some((self.a1, 0.0));
        }
        let half = 0.5 * self.a1;
        let discriminant = half * half - self.a2;
        if discriminant < 0.0 {
            return None;
        }
        // The larger root first, the other from the product: no cancellation.
        let root = libm::sqrt(discriminant);
        let large = if half < 0.0 { half - root } else { half + root };
        let small = self.a2 / large;
        Some(if large > small { (large, small) } else { (small, large) })
    }
}
