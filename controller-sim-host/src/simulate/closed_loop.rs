//! The plant side of a sampled loop: held output, latency, dead time, disturbance, exactly between the samples.

use super::curve::{Curve, SAME};
use super::delay::{self, Delay};
use crate::plant::{Input, LinearPlant, StateSpace, Wave};
use crate::scenario::Signal;
use controller_design::model::TransferFunction;

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
    /// The plant's number for steps of this length.
    index: usize,
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
    delay: Delay,
    disturbance: Curve,
    waves: Vec<Wave>,
    /// Number of this sample: whole, as a float since it is a time at every step.
    sample: f64,
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
        let u0 = w0 - d0;
        let (delay, fraction) = Delay::new((plant.dead_time() + latency) / ts, u0);
        let disturbance = Curve::new(d0, disturbances, plant.dead_time(), ts);
        let frequencies = disturbance.frequencies();
        let waves = vec![Wave::default(); frequencies.len()];
        let mut plant = LinearPlant::with_waves(system, x, frequencies);
        let with_number = |step: delay::Step| {
            let delay::Step { start, h, new_output } = step;
            Grid { start, h, index: plant.prepare(h), new_output }
        };
        let grid = delay::grid(ts, substeps.max(1), fraction).into_iter().map(with_number).collect();
        Some((Self { plant, ts, grid, delay, disturbance, waves, sample: 0.0, w_before: w0 }, u0))
    }

    /// The measurement of this sample, before its output acts \[y\].
    #[must_use]
    pub fn measure(&self) -> f64 {
        self.plant.output(self.w_before)
    }

    /// Time of this sample \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.sample * self.ts
    }

    /// Applies `u` \[u\] and moves to the next sample; `each` sees the output between the samples.
    #[inline]
    pub fn hold(&mut self, u: f64, mut each: impl FnMut(SubStep)) {
        let (arrived, before) = self.delay.push(u);
        let k = self.sample;
        self.sample += 1.0;
        // Nothing begins before the next sample and no sine runs: the usual sample, without a question at each step.
        if self.disturbance.next() < k + 1.0 - SAME || !self.waves.is_empty() {
            return self.hold_over_breaks(k, (arrived, before), &mut each);
        }
        for &Grid { start, h, index, new_output } in &self.grid {
            let output = if new_output { arrived } else { before };
            let (d, slope) = self.disturbance.line(k + start);
            let value = output + d;
            let y0 = self.plant.output(value);
            self.plant.advance_by(index, Input { value, slope }, &[]);
            self.w_before = value + slope * h;
            let t0 = (k + start) * self.ts;
            each(SubStep { t0, y0, t1: t0 + h, y1: self.plant.output(self.w_before) });
        }
    }

    #[inline(never)]
    fn hold_over_breaks(&mut self, k: f64, (arrived, before): (f64, f64), each: &mut impl FnMut(SubStep)) {
        for index in 0..self.grid.len() {
            let step = self.grid[index];
            let output = if step.new_output { arrived } else { before };
            self.advance_over_breaks(k, step, output, each);
        }
    }

    /// A step of the grid, divided where the disturbance breaks.
    fn advance_over_breaks(&mut self, k: f64, step: Grid, output: f64, each: &mut impl FnMut(SubStep)) {
        let mut start = step.start;
        let mut left = step.h;
        let mut index = Some(step.index);
        loop {
            let at = self.disturbance.next() - k;
            let until = (at - start) * self.ts;
            // The last break may be infinitely far away.
            if until > left - SAME * self.ts {
                break;
            }
            if until > SAME * self.ts {
                self.advance(k + start, None, until, output, each);
                start = at;
                left -= until;
                index = None;
            }
            self.disturbance.enter_next();
        }
        self.advance(k + start, index, left, output, each);
    }

    /// Moves from the instant `s` (in samples) through `h` seconds.
    fn advance(&mut self, s: f64, index: Option<usize>, h: f64, output: f64, each: &mut impl FnMut(SubStep)) {
        let (d, slope) = self.disturbance.line(s);
        let value = output + d;
        let t0 = s * self.ts;
        if self.waves.is_empty() {
            let y0 = self.plant.output(value);
            match index {
                Some(index) => self.plant.advance_by(index, Input { value, slope }, &[]),
                None => self.plant.advance(h, Input { value, slope }, &[]),
            }
            self.w_before = value + slope * h;
            each(SubStep { t0, y0, t1: t0 + h, y1: self.plant.output(self.w_before) });
            return;
        }
        let sum = |waves: &[Wave]| waves.iter().map(|wave| wave.sin).sum::<f64>();
        self.disturbance.waves(s, &mut self.waves);
        let y0 = self.plant.output(value + sum(&self.waves));
        self.plant.advance(h, Input { value, slope }, &self.waves);
        self.disturbance.waves(s + h / self.ts, &mut self.waves);
        self.w_before = value + slope * h + sum(&self.waves);
        each(SubStep { t0, y0, t1: t0 + h, y1: self.plant.output(self.w_before) });
    }
}
