//! The plant side of a sampled loop: held output, latency, dead time, disturbance, exactly between the samples.

use super::disturbance::{Curve, SAME};
use crate::plant::{Input, LinearPlant, StateSpace};
use crate::scenario::Signal;
use controller_design::model::TransferFunction;
use std::collections::VecDeque;

/// The plant's output over a step between samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SubStep {
    /// Beginning \[s\].
    pub t0: f64,
    /// Output at the beginning \[y\].
    pub y0: f64,
    /// End \[s\].
    pub t1: f64,
    /// Output at the end \[y\].
    pub y1: f64,
}

/// One step of the grid inside a sample: begins at `start` (a fraction of the sample), lasts `h` seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Grid {
    start: f64,
    h: f64,
    new_output: bool,
}

/// A plant behind a zero-order hold, sampled every `ts`.
///
/// In sample `k`: [`measure`](Self::measure) gives `y(k*ts)`, [`hold`](Self::hold) makes `u[k]` act from
/// `k*ts + latency` on and moves to `(k+1)*ts`. The disturbance adds to the output before the dead time.
#[derive(Debug, Clone)]
pub struct ClosedLoop {
    plant: LinearPlant,
    ts: f64,
    grid: Vec<Grid>,
    line: VecDeque<f64>,
    disturbance: Curve,
    sample: u64,
    w_before: f64,
}

impl ClosedLoop {
    /// The loop at rest at the measurement `y0` under the disturbance `d0`; gives the output that holds it there, too.
    /// `disturbances` begin at their times \[s\]; `substeps` is at least 1. `None` when the plant cannot rest at `y0`.
    #[must_use]
    pub fn new(
        plant: &TransferFunction,
        ts: f64,
        latency: f64,
        substeps: usize,
        (y0, d0): (f64, f64),
        disturbances: &[(f64, Signal)],
    ) -> Option<(Self, f64)> {
        let system = StateSpace::new(plant, ts);
        let (x, w0) = system.rest(y0)?;
        let delay = (plant.dead_time() + latency) / ts;
        let whole = if (delay - delay.round()).abs() < SAME { delay.round() } else { delay.floor() };
        let fraction = if whole == delay.floor() && delay - whole >= SAME { delay - whole } else { 0.0 };
        let u0 = w0 - d0;
        // Newest first; one more than the delay for the part of a sample before the new output arrives.
        let line = VecDeque::from(vec![u0; whole as usize + 2]);
        let disturbance = Curve::new(d0, disturbances, plant.dead_time(), ts);
        let this = Self {
            plant: LinearPlant::new(system, x),
            ts,
            grid: grid(ts, substeps.max(1), fraction),
            line,
            disturbance,
            sample: 0,
            w_before: w0,
        };
        Some((this, u0))
    }

    /// The measurement of this sample, before its output acts \[y\].
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.plant.output(self.w_before)
    }

    /// Time of this sample \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.sample as f64 * self.ts
    }

    /// Applies `u` \[u\] and moves to the next sample; `each` sees the output between the samples.
    pub fn hold(&mut self, u: f64, mut each: impl FnMut(SubStep)) {
        self.line.pop_back();
        self.line.push_front(u);
        let oldest = self.line.len() - 1;
        let (arrived, before) = (self.line[oldest - 1], self.line[oldest]);
        let k = self.sample as f64;
        for index in 0..self.grid.len() {
            let step = self.grid[index];
            let output = if step.new_output { arrived } else { before };
            let mut start = step.start;
            let mut left = step.h;
            // A piece of the disturbance that begins inside the step divides it.
            while let Some(next) = self.disturbance.next() {
                let at = next - k;
                let until = (at - start) * self.ts;
                if until > left - SAME * self.ts {
                    break;
                }
                if until > SAME * self.ts {
                    self.advance(k, start, until, output, &mut each);
                    start = at;
                    left -= until;
                }
                self.disturbance.enter_next();
            }
            self.advance(k, start, left, output, &mut each);
        }
        self.sample += 1;
    }

    fn advance(&mut self, k: f64, start: f64, h: f64, output: f64, each: &mut impl FnMut(SubStep)) {
        let (d, slope) = self.disturbance.now(k + start);
        let w = output + d;
        let y0 = self.plant.output(w);
        self.plant.advance(h, Input { value: w, slope });
        self.w_before = w + slope * h;
        let t0 = (k + start) * self.ts;
        each(SubStep { t0, y0, t1: t0 + h, y1: self.plant.output(self.w_before) });
    }
}

/// The steps inside one sample: `substeps` equal ones, that in which the new output arrives divided there.
fn grid(ts: f64, substeps: usize, fraction: f64) -> Vec<Grid> {
    let h = ts / substeps as f64;
    let mut steps = Vec::new();
    for j in 0..substeps {
        let (start, end) = (j as f64 / substeps as f64, (j + 1) as f64 / substeps as f64);
        if fraction > start + SAME && fraction < end - SAME {
            let first = (fraction - start) * ts;
            steps.push(Grid { start, h: first, new_output: false });
            steps.push(Grid { start: fraction, h: h - first, new_output: true });
        } else {
            steps.push(Grid { start, h, new_output: start >= fraction - SAME });
        }
    }
    steps
}
