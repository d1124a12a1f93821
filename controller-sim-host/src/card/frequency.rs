//! What the frequency response of the deployed loop says.

use super::deployed::Deployed;
use controller_core::Real;
use controller_design::margins::{Margins, NoiseGains};

/// Margins and noise.
pub(super) struct Frequency {
    pub(super) margins: Margins,
    /// \[s\].
    pub(super) jitter: f64,
    pub(super) noise: NoiseGains,
    /// `std(u[k] - u[k-1])/std(n)` [u/y].
    pub(super) increment: f64,
}

impl Frequency {
    pub(super) fn new<T: Real>(deployed: &Deployed<'_, T>) -> Result<Self, String> {
        let sampled = &deployed.sampled;
        let margins = sampled.margins().map_err(|why| why.to_string())?;
        let jitter = sampled.jitter_margin().map_err(|why| why.to_string())?;
        Ok(Self { margins, jitter, noise: sampled.noise(), increment: sampled.noise_increment() })
    }
}
