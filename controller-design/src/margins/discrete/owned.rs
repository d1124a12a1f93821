//! The coefficients of a compensator, kept.

use std::vec::Vec;

use controller_core::{Coefficients, Real};

/// The [`Coefficients`] of a compensator of any number type, in double precision, which holds their values exactly.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OwnedCoefficients {
    g: Vec<f64>,
    y_feed: Vec<f64>,
    y_lead: Vec<f64>,
    y_dc: Vec<f64>,
    u_lead: Vec<f64>,
    e_gain: Vec<f64>,
    inv_gain: f64,
    gain: f64,
    delay: usize,
}

impl OwnedCoefficients {
    pub(super) fn of<T: Real>(from: &Coefficients<'_, T>) -> Self {
        let list = |list: &[T]| list.iter().map(|x| x.to_f64()).collect();
        Self {
            g: list(from.g),
            y_feed: list(from.y_feed),
            y_lead: list(from.y_lead),
            y_dc: list(from.y_dc),
            u_lead: list(from.u_lead),
            e_gain: list(from.e_gain),
            inv_gain: from.inv_gain.to_f64(),
            gain: from.gain.to_f64(),
            delay: from.delay,
        }
    }

    pub(super) fn view(&self) -> Coefficients<'_, f64> {
        Coefficients {
            g: &self.g,
            y_feed: &self.y_feed,
            y_lead: &self.y_lead,
            y_dc: &self.y_dc,
            u_lead: &self.u_lead,
            e_gain: &self.e_gain,
            inv_gain: self.inv_gain,
            gain: self.gain,
            delay: self.delay,
        }
    }
}
