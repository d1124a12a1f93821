//! How far a loop is from instability.
//!
//! [`ContinuousLoop`] answers for the continuous design: plant, PID and, if there is one, disturbance estimator or
//! observer, with dead times as they are (no Padé approximation). The plant may differ from the compensator's model.
//!
//! ```
//! use controller_core::PidConfig;
//! use controller_design::margins::ContinuousLoop;
//! use controller_design::model::parse;
//!
//! // An integrator: L = 0.5*exp(-s)/s crosses 1 at 0.5 rad/s with the phase -90 deg - 0.5 rad.
//! let plant = parse("exp(-s)/s").expect("a valid plant");
//! let margins = ContinuousLoop::new(&plant, &PidConfig { kp: 0.5, ..PidConfig::default() }).margins();
//! let margins = margins.expect("a stable loop");
//! assert!((margins.gm - core::f64::consts::PI).abs() < 1e-12);
//! assert!((margins.pm_deg - (90.0 - 0.5_f64.to_degrees())).abs() < 1e-9);
//! assert!((margins.delay_margin - (core::f64::consts::PI - 1.0)).abs() < 1e-12);
//! ```

mod adrc;
mod continuous;
pub mod discrete;
mod measure;
mod paths;
mod scan;

pub use continuous::ContinuousLoop;
pub(crate) use discrete::TOO_MANY_TURNS;
pub use discrete::{DiscreteLaw, DiscreteLoop, LoopResponse, NoiseGains};
pub(crate) use paths::{Paths, lead, split_zeros};
pub(crate) use scan::TOO_LONG;

/// The distances of a stable loop from instability; frequencies in rad/s.
///
/// `L` is the loop gain at the plant input, `S = 1/(1+L)`, `T = L/(1+L)`. Of several crossings the one nearest to
/// instability counts. A margin that cannot be used up is infinite and has no frequency.
///
/// For a stable loop `gm >= ms/(ms-1)` and `pm_deg >= 2*asin(1/(2*ms))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margins {
    /// Largest sensitivity `max|S|`: the reciprocal of the Nyquist curve's distance to -1.
    pub ms: f64,
    /// Where `|S|` is largest. The largest value may be a limit at high frequency; then this is the highest
    /// frequency looked at.
    pub omega_ms: f64,
    /// Largest complementary sensitivity `max|T|`.
    pub mt: f64,
    /// Where `|T|` is largest.
    pub omega_mt: f64,
    /// Gain margin: the least factor above 1 on `L` that brings the loop to its limit; infinite if none does.
    pub gm: f64,
    /// Phase crossover that belongs to `gm`.
    pub omega_gm: Option<f64>,
    /// Largest factor below 1 on `L` that brings the loop to its limit; 0 if none does. Conditionally stable loops,
    /// those with two integrations in the loop among them, have one.
    pub gm_low: f64,
    /// Phase crossover that belongs to `gm_low`.
    pub omega_gm_low: Option<f64>,
    /// Phase margin in degrees, 0 to 180: the least turn of `L`, to either side, that brings the loop to its limit;
    /// infinite if `|L|` is nowhere 1.
    pub pm_deg: f64,
    /// Gain crossover that belongs to `pm_deg`.
    pub omega_pm: Option<f64>,
    /// The least extra dead time in s that brings the loop to its limit; infinite if `|L|` is nowhere 1.
    pub delay_margin: f64,
    /// Gain crossover that belongs to `delay_margin`.
    pub omega_delay: Option<f64>,
}

impl Margins {
    /// The peaks, with no crossing found yet; each value comes with its frequency.
    fn of_peaks((omega_ms, ms): (f64, f64), (omega_mt, mt): (f64, f64)) -> Self {
        Self {
            ms,
            omega_ms,
            mt,
            omega_mt,
            gm: f64::INFINITY,
            omega_gm: None,
            gm_low: 0.0,
            omega_gm_low: None,
            pm_deg: f64::INFINITY,
            omega_pm: None,
            delay_margin: f64::INFINITY,
            omega_delay: None,
        }
    }
}
