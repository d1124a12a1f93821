//! What a design is asked for.

use super::Method;
use crate::rules::Wish;

/// A wish for a controller. Times in seconds.
///
/// ```
/// use controller_design::design::{Method, Request};
/// let request = Request::new(Method::DeMomi, 0.05);
/// assert_eq!((request.ts, request.ms), (0.05, None));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// The rule.
    pub method: Method,
    /// Sampling period \[s\].
    pub ts: f64,
    /// From reading `y` to acting `u` \[s\]; part of the dead time the rules see.
    pub latency: f64,
    /// Filter of the PID.
    pub filter: Filter,
    /// Filter of the disturbance estimator.
    pub estimator_filter: EstimatorFilter,
    /// Filter of the disturbance observer.
    pub observer_filter: ObserverFilter,
    /// Maximum sensitivity the rule designs for, where it takes one (`pi-ms`, `dob`: default 1.4; `ah`: 1.4 or 2,
    /// default 1.4; `adrc`: default 1.6).
    pub ms: Option<f64>,
    /// Gain at high frequencies that an `adrc` is given.
    pub b0: AdrcGain,
    /// Time constant of the closed loop for `simc` \[s\]; `None`: the dead time of its model.
    pub tau_c: Option<f64>,
    /// Largest maximum sensitivity that is accepted of a compensated loop: a `de-momi` first raises `tfd`, then cuts `kfd`; a
    /// `dob` raises `alpha`. `None`: whatever it is.
    pub ms_max: Option<f64>,
}

/// The gain `b0` of an ADRC, `y'' = b0*u + ...` [y/u/s^2].
///
/// The chapter chooses it by hand, as the gain of a second-order model at high frequencies; larger for plants with dead time,
/// which that makes slower.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AdrcGain {
    /// `gain/a2` of the reduced model; with a first-order model `gain/(a1*dead_time)`.
    Model,
    /// The one, around that of the model, whose fastest loop within `ms` has the largest integral gain, as `pi-ms` does for a
    /// PI: for `omega_o = 4*omega_c` that is `64/73*omega_c^3/b0`. Cost: some ten times that of the others.
    Search,
    /// This one, of the sign of the plant's gain.
    Value(f64),
}

/// Filter of a PID.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filter {
    /// Noise gain `4/|K|`, or 1.05 times the least attainable one if that is larger; less where a loop with that much would not
    /// be stable. For `ah`, `amigo` and `simc` a tenth of the derivative time, at least `ts`.
    Default,
    /// This time constant `tf` \[s\].
    Time(f64),
    /// This noise gain `K_PIDn` [u/y] at half the Nyquist frequency, eq. (28) of Vrančić & Huba 2021.
    NoiseGain(f64),
}

/// Filter of a disturbance estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EstimatorFilter {
    /// The noise gain of the PID.
    Default,
    /// This time constant `tfd` \[s\].
    Time(f64),
    /// This noise gain `K_DEn` [u/y] at half the Nyquist frequency, eq. (30) of Vrančić & Huba 2021.
    NoiseGain(f64),
}

/// Filter of a disturbance observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ObserverFilter {
    /// The smallest noise ratio up to 4 whose loop keeps `ms_max` (default 2).
    Default,
    /// This time constant `alpha` \[s\].
    Time(f64),
    /// The noise gain `A_n` over that of the PI alone, above 1.
    NoiseRatio(f64),
    /// The slowest filter with this index of the continuous loop after a unit load.
    Wanted(Wish),
}

impl Request {
    /// A design by `method` for the sampling period `ts` \[s\], with defaults for the rest.
    #[must_use]
    pub const fn new(method: Method, ts: f64) -> Self {
        Self {
            method,
            ts,
            latency: 0.0,
            filter: Filter::Default,
            estimator_filter: EstimatorFilter::Default,
            observer_filter: ObserverFilter::Default,
            ms: None,
            b0: AdrcGain::Model,
            tau_c: None,
            ms_max: None,
        }
    }
}
