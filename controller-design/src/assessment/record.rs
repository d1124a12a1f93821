//! The record without what cannot be used.

use std::vec::Vec;

use super::Experiment;
use super::locate::Parts;
use crate::refusal::Refusal;
use crate::warning::{Warning, Warnings};

/// Beyond this, sums of squares would overflow.
const LARGEST: f64 = 1e100;
/// Below this, squares of times would vanish.
const SHORTEST: f64 = 1e-100;

/// Samples with finite values at rising times.
#[derive(Debug)]
pub(super) struct Record {
    pub(super) t: Vec<f64>,
    pub(super) sp: Vec<f64>,
    pub(super) pv: Vec<f64>,
    pub(super) co: Vec<f64>,
    pub(super) step_at: Option<usize>,
    pub(super) auto_at: Option<usize>,
    /// Without one, `sp` is 0.
    pub(super) has_setpoint: bool,
    left_out: usize,
}

impl Record {
    pub(super) fn new(e: &Experiment<'_>) -> Result<Self, Refusal> {
        let n = e.t.len();
        if n == 0 {
            return Err(Refusal::Data {
                why: "the record has no samples",
                help: "record the loop from before the step of the output until it has settled",
            });
        }
        let has_setpoint = !e.setpoint.is_empty();
        if (has_setpoint && e.setpoint.len() != n) || [e.output.len(), e.input.len()] != [n; 2] {
            return Err(Refusal::Data {
                why: "time, set-point, measurement and output have different lengths",
                help: "give one value of each for every sample",
            });
        }
        let mut record = Self {
            t: Vec::with_capacity(n),
            sp: Vec::with_capacity(n),
            pv: Vec::with_capacity(n),
            co: Vec::with_capacity(n),
            step_at: None,
            auto_at: None,
            has_setpoint,
            left_out: 0,
        };
        for k in 0..n {
            // The sample asked for, or the next one that can be used.
            let here = record.t.len();
            let asked = |at: Option<usize>, found: &mut Option<usize>| {
                if at == Some(k) {
                    *found = Some(here);
                }
            };
            asked(e.step_at, &mut record.step_at);
            asked(e.auto_at, &mut record.auto_at);
            record.add([e.t[k], e.setpoint.get(k).copied().unwrap_or(0.0), e.output[k], e.input[k]])?;
        }
        let index = |parameter, at: Option<usize>| match at {
            Some(at) if at >= n => {
                Err(Refusal::OutOfRange { parameter, value: at as f64, min: 0.0, max: (n - 1) as f64 })
            }
            _ => Ok(()),
        };
        index("step_at", e.step_at)?;
        index("auto_at", e.auto_at)?;
        if let [first, .., last] = record.t[..]
            && last - first < SHORTEST
        {
            return Err(Refusal::Data {
                why: "the record is shorter than 1e-100 s",
                help: "give the times in seconds",
            });
        }
        if record.t.is_empty() {
            return Err(Refusal::Data {
                why: "no sample has finite values of time, set-point, measurement and output",
                help: "check that the columns are the right ones",
            });
        }
        Ok(record)
    }

    fn add(&mut self, sample: [f64; 4]) -> Result<(), Refusal> {
        if sample.iter().any(|x| !x.is_finite()) {
            self.left_out += 1;
            return Ok(());
        }
        if sample.iter().any(|x| x.abs() > LARGEST) {
            return Err(Refusal::Data {
                why: "a value of the record is larger than 1e100",
                help: "check that the columns are the right ones",
            });
        }
        let [t, sp, pv, co] = sample;
        match self.t.last() {
            Some(&last) if t < last => {
                return Err(Refusal::Data {
                    why: "the times of the record do not rise",
                    help: "give the samples in the order of time, one record at a time",
                });
            }
            Some(&last) if t == last => {
                self.left_out += 1;
                return Ok(());
            }
            _ => {}
        }
        self.t.push(t);
        self.sp.push(sp);
        self.pv.push(pv);
        self.co.push(co);
        Ok(())
    }

    /// The part of the record that belongs to the experiment, and its parts counted in it.
    pub(super) fn cut(&self, parts: Parts) -> (Self, Parts) {
        let range = parts.begin..parts.end;
        let of = |list: &[f64]| list[range.clone()].to_vec();
        let auto = parts.auto.filter(|auto| *auto < parts.end).map(|auto| auto - parts.begin);
        let record = Self {
            t: of(&self.t),
            sp: of(&self.sp),
            pv: of(&self.pv),
            co: of(&self.co),
            step_at: None,
            auto_at: None,
            has_setpoint: self.has_setpoint,
            left_out: 0,
        };
        (record, Parts { begin: 0, step: parts.step - parts.begin, auto, end: range.len(), ..parts })
    }

    pub(super) fn len(&self) -> usize {
        self.t.len()
    }

    pub(super) fn warn(&self, warnings: &mut Warnings) {
        if !self.has_setpoint {
            let text = "not recorded; that the loop was at it and that it stood still is not checked";
            let _ = warnings.push(Warning::Text { about: "setpoint", text });
        }
        if self.left_out > 0 {
            // A full list of warnings has said enough.
            let _ = warnings.push(Warning::Value {
                about: "samples",
                value: self.left_out as f64,
                text: "so many were left out: a value is not finite, or the time is that of the sample before",
            });
        }
    }
}

/// The median; sorts the list. 0 of nothing.
pub(super) fn median(list: &mut [f64]) -> f64 {
    list.sort_unstable_by(f64::total_cmp);
    let n = list.len();
    match n {
        0 => 0.0,
        n if n % 2 == 1 => list[n / 2],
        n => 0.5 * (list[n / 2 - 1] + list[n / 2]),
    }
}

/// The mean; 0 of nothing.
pub(super) fn mean(list: &[f64]) -> f64 {
    let n = list.len().max(1) as f64;
    list.iter().map(|x| x / n).sum()
}
