//! The load-response experiment: is this PI loop tuned to reject loads?
//!
//! The loop is in automatic, steady, without error. The operator switches to manual, steps the output, and switches back
//! to automatic. For the loop this is a load step at the input of the process. The response of a loop whose IAE is the
//! least a PI can have looks the same for all processes with dead time: a dip of 5 to 13 % of the first peak a little
//! after twice its time, then a small third peak. [`assess`] measures these three and says how far off they are.
//!
//! | feature | is | near-optimal |
//! |---|---|---|
//! | `dip` | where it turns after the first peak, in first peaks | -0.18 to 0 |
//! | `t_ratio` | time of the dip over time of the first peak, from the step | 1.85 to 2.30 |
//! | `r3` | peak after the dip, in first peaks | up to 0.30 |
//!
//! Values count to the side of the first peak: of a process with negative gain everything is upside down.
//!
//! The procedure is that of Airikka 2021, section 7; the ranges are tighter than the paper's curves alone would give:
//! they were found on loops off their optimum by up to 2.5 times in gain and 3 times in integral time, so that the IAE
//! of an accepted loop is within some 15 % of the optimum. The paper's product `P1/P2*P3/P2` is far too sensitive to
//! tell anything.
//!
//! ```
//! use controller_design::assessment::{AssessOptions, Experiment, Verdict, assess};
//!
//! // 1/(1+s) with a dead time of 1 s under the PI of least IAE, sampled every 0.02 s; 5 s of rest, then the step.
//! let (kp, ti, ts) = (1.0194, 1.451, 0.02);
//! let (mut y, mut i, mut u) = (0.0, 0.0, vec![0.0; 50]);
//! let (mut t, mut pv, mut co) = (vec![], vec![], vec![]);
//! for k in 0..2000 {
//!     let manual = (250..260).contains(&k);
//!     if manual { i = 1.0 + kp * y } else { i -= kp * ts / ti * y }
//!     (t.push(ts * k as f64), pv.push(y), co.push(i - kp * y));
//!     u.push(i - kp * y);
//!     y += (u[k] - y) * ts;
//! }
//! let setpoint = [0.0; 2000];
//! let experiment = Experiment::new(&t, &setpoint, &pv, &co);
//! let assessment = assess(&experiment, &AssessOptions::default()).expect("a record");
//! assert_eq!(assessment.verdict, Verdict::NearOptimal);
//! assert!((assessment.features.unwrap().t1 - 2.32).abs() < 0.05);
//! ```

mod baseline;
mod features;
mod judge;
mod locate;
mod reason;
mod record;
mod smoothing;

use std::vec::Vec;

use crate::refusal::Refusal;
use crate::warning::Warnings;

pub use judge::{Acceptance, Change, Changes, Verdict};
pub use reason::Reason;

/// A recorded load-response experiment: slices of equal length, a sample each.
///
/// Times \[s\] rise but need not be equidistant; of several samples with one time the first counts. A sample with a value
/// that is not finite is left out.
#[derive(Debug, Clone, Copy)]
pub struct Experiment<'a> {
    /// Time \[s\].
    pub t: &'a [f64],
    /// Set-point \[y\]; empty when it was not recorded.
    pub setpoint: &'a [f64],
    /// Measurement, the output of the process \[y\].
    pub output: &'a [f64],
    /// Output of the controller, the input of the process \[u\].
    pub input: &'a [f64],
    /// The first sample with the stepped output: the largest jump within five samples of it is taken. `None`: the largest
    /// jump of the record while the set-point stands still.
    pub step_at: Option<usize>,
    /// The first sample in automatic after that. `None`: the first whose output has left the stepped value by 0.5 % of the
    /// step.
    pub auto_at: Option<usize>,
}

impl<'a> Experiment<'a> {
    /// A record in which the step and the return to automatic are to be found.
    #[must_use]
    pub const fn new(t: &'a [f64], setpoint: &'a [f64], output: &'a [f64], input: &'a [f64]) -> Self {
        Self { t, setpoint, output, input, step_at: None, auto_at: None }
    }
}

/// What is asked of the assessment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AssessOptions {
    /// The ranges of a near-optimal loop.
    pub acceptance: Acceptance,
}

/// What was measured on the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Features {
    /// First peak: size of the largest deviation from the baseline \[y\].
    pub p1: f64,
    /// Its time from the step \[s\].
    pub t1: f64,
    /// The dip after it, as a share of `p1`, negative beyond the baseline; `None`: there is none.
    pub dip: Option<f64>,
    /// Time of the dip from the step, in `t1`.
    pub t_ratio: Option<f64>,
    /// Third peak after the dip, as a share of `p1`, to the side of the first.
    pub r3: Option<f64>,
    /// Standard deviation of the noise of a sample \[y\].
    pub sigma: f64,
}

/// A place in the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Time, as in the record \[s\].
    pub t: f64,
    /// Smoothed measurement \[y\].
    pub y: f64,
}

/// Where everything is, for a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Marks {
    /// Time of the step \[s\].
    pub step: f64,
    /// Time of the return to automatic \[s\].
    pub auto: Option<f64>,
    /// What was looked at: from the beginning of the baseline to the end \[s\].
    pub span: (f64, f64),
    /// Mean measurement before the step \[y\].
    pub baseline: f64,
    /// Mean output before the step, and the stepped output \[u\].
    pub inputs: (f64, f64),
    /// First peak.
    pub peak: Option<Place>,
    /// Dip; `None` also when it is less than two standard deviations of a sample deep, which no eye sees.
    pub dip: Option<Place>,
    /// Third peak; `None` when the dip is.
    pub third: Option<Place>,
    /// The smoothed measurement over the span.
    pub smoothed: Vec<Place>,
}

impl Marks {
    /// Whether the measurement falls when the output is raised: process and controller have negative gains then, the
    /// first peak of a step upwards points downwards, and the dip upwards.
    #[must_use]
    pub fn is_reverse(&self) -> bool {
        self.peak.is_some_and(|peak| (peak.y - self.baseline) * (self.inputs.1 - self.inputs.0) < 0.0)
    }
}

/// What the experiment says about the loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// How the loop is tuned.
    pub verdict: Verdict,
    /// Why; at least one.
    pub reasons: Vec<Reason>,
    /// What to change in the controller.
    pub advice: Changes,
    /// What was measured, as far as the record allows.
    pub features: Option<Features>,
    /// Where it was measured.
    pub marks: Option<Marks>,
    /// What to know about the record.
    pub warnings: Warnings,
}

/// Judges a loop by its response to a step of its output by hand: Airikka 2021, section 7.
///
/// The baseline is the mean before the step. The response is smoothed by a local quadratic of half width `0.1*t1`; what is
/// smaller than four standard deviations of the smoothed noise is nothing. A record that does not show the response
/// clearly gives [`Verdict::Inconclusive`] with the reason.
///
/// Cost: in proportion to the record, at most some ten million operations for a million samples.
///
/// # Errors
/// [`Refusal::Data`]: no data at all, lists of different lengths, times that fall, numbers beyond 1e100.
/// [`Refusal::OutOfRange`]: `step_at` or `auto_at` is not a sample of the record, or a range of the options is reversed.
pub fn assess(experiment: &Experiment<'_>, options: &AssessOptions) -> Result<Assessment, Refusal> {
    options.acceptance.check()?;
    let record = record::Record::new(experiment)?;
    let mut assessment = Assessment {
        verdict: Verdict::Inconclusive,
        reasons: Vec::new(),
        advice: Changes::default(),
        features: None,
        marks: None,
        warnings: Warnings::new(),
    };
    record.warn(&mut assessment.warnings);
    match features::measure(&record, &mut assessment) {
        Ok(shape) => {
            (assessment.verdict, assessment.reasons) = judge::judge(&shape, &options.acceptance);
        }
        Err(reason) => assessment.reasons.push(reason),
    }
    assessment.advice = Changes::of(&assessment.reasons);
    Ok(assessment)
}
