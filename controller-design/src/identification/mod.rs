//! A process from a recorded change between two steady states.
//!
//! Two ways lead from a record to the areas that the rules of Vrančić & Huba 2021 start from: their definition, nested
//! integrals of the record itself ("raw areas"), and a model fitted by least squares, whose areas follow from eq. (5).
//! The first assumes nothing but loses to noise quickly; the second assumes a few lags and dead time. [`identify`]
//! goes both ways, tells how uncertain each is, and chooses.

mod choice;
mod estimate;
mod fit;
mod gains;
mod identified;
mod moments;
mod noise;
mod record;
mod response;
mod settling;
mod simulation;
mod solve;
mod structures;

pub use identified::{Chosen, Fit, Identified, SecondOrder};

use crate::Refusal;

/// Rows of a log: `u[i]` acts from `t[i]` on until the next row; `y[i]` is measured at `t[i]`.
///
/// Times in seconds, not falling, at any distances. Of rows with one time stamp the last holds, and a change of `u`
/// between them is a step at that time.
#[derive(Debug, Clone, Copy)]
pub struct Recording<'a> {
    /// Times in s.
    pub t: &'a [f64],
    /// The input of the process, held between rows.
    pub u: &'a [f64],
    /// The output of the process.
    pub y: &'a [f64],
}

/// Wishes for [`identify`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct IdentifyOptions {
    /// Filter time in s of the controller whose gain decides between the two ways; by default `A1/A0/25`.
    pub tf: Option<f64>,
    /// The time of the change, when it is not the first row at which the input moves.
    pub change_at: Option<f64>,
}

/// The process behind a recorded change between two steady states: steps, ramps, filtered steps or a closed loop.
///
/// With `t = 0` at the change, `du` the change of `u`, and `y_inf` the final output, the areas are
/// `A_0 = (y_inf - y_0)/du`, `A_k = y_k - sum(A_(k-i)*u_i, i = 1..k)`, where `u_k` and `y_k` are the integrals of
/// `t^(k-1)/(k-1)!` times `1 - (u - u_0)/du` and `(y_inf - y)/du`. The held input is integrated exactly, the output by
/// the trapezoid with end correction (fourth order in the step). The fit has two lags and dead time, more lags or a zero
/// only when the record asks for them. Raw areas are chosen when the standard deviation of the magnitude optimum's
/// `K_P` that follows from them is at most 10 %, the fit otherwise. That deviation and the interval of `K_P` are one
/// statement: the interval is 1.8 deviations wide to either side.
///
/// Intervals come from the noise seen in the steady stretches, the quantisation that noise does not average out, the
/// truncation of the integrals, correlation of the fit's residuals, and the distance to the next richer structure: in
/// full where the record determines that structure, at most up to three times the fit's own interval where it does not.
/// Not covered: a disturbance during the record, a process that is not linear or not of a few lags, a wrong time axis.
///
/// Takes some milliseconds for a thousand rows.
///
/// # Errors
/// [`Refusal::Data`] for a record from which nothing can be concluded: no change of the input, an output that does not
/// move beyond its noise, does not settle or keeps its rate (an integrating process), too few rows, gains of the wrong sign.
///
/// ```
/// use controller_design::identification::{IdentifyOptions, Recording, identify};
/// // 2*exp(-s)/(1 + 5*s), a step of 3 at t = 10.
/// let t: Vec<f64> = (0..1500).map(|i| 0.1 * f64::from(i)).collect();
/// let u: Vec<f64> = t.iter().map(|t| if *t < 10.0 { 1.0 } else { 4.0 }).collect();
/// let y: Vec<f64> = t.iter().map(|t| 7.0 + 6.0 * (1.0 - libm::exp(-(t - 11.0).max(0.0) / 5.0))).collect();
/// let found = identify(&Recording { t: &t, u: &u, y: &y }, &IdentifyOptions::default()).expect("a clean step");
/// let model = found.model.expect("a model");
/// assert!((model.gain - 2.0).abs() < 1e-6 && (model.a1 - 5.0).abs() < 1e-4 && (model.dead_time - 1.0).abs() < 1e-4);
/// assert!((found.raw_areas.values()[1] - 12.0).abs() < 1e-2);
/// ```
pub fn identify(recording: &Recording<'_>, options: &IdentifyOptions) -> Result<Identified, Refusal> {
    identified::identify(recording, options)
}

const fn too_few() -> Refusal {
    Refusal::Data {
        why: "there are too few rows after the change of the input",
        help: "record at least a dozen rows, better some hundred, from the change until the output is at rest",
    }
}
