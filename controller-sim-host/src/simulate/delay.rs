//! What lies in time between an output and the plant: whole samples in a line, a fraction of one in the grid of steps.

use super::curve::SAME;

/// Outputs that have not arrived yet, as a ring; one more than the delay for the part of a sample before the new output
/// arrives.
#[derive(Debug, Clone)]
pub(super) struct Delay {
    line: Vec<f64>,
    /// Where the next output is written; the oldest is there.
    write: usize,
}

impl Delay {
    /// A delay of so many samples, full of `u0`; the fraction of a sample that is over the whole ones, too.
    pub(super) fn new(samples: f64, u0: f64) -> (Self, f64) {
        let whole = if (samples - samples.round()).abs() < SAME { samples.round() } else { samples.floor() };
        let fraction =
            if whole == samples.floor() && samples - whole >= SAME { samples - whole } else { 0.0 };
        (Self { line: vec![u0; whole as usize + 2], write: 0 }, fraction)
    }

    /// Puts `u` into the line: the output that arrives within this sample, and the one before it.
    #[inline]
    pub(super) fn push(&mut self, u: f64) -> (f64, f64) {
        let size = self.line.len();
        self.line[self.write] = u;
        // The oldest but one arrives; it was written `size - 2` samples ago.
        let wrap = |i: usize| if i >= size { i - size } else { i };
        let oldest = wrap(self.write + 1);
        let (before, arrived) = (self.line[oldest], self.line[wrap(oldest + 1)]);
        self.write = oldest;
        (arrived, before)
    }
}

/// One step of the grid inside a sample: begins at `start` (a fraction of the sample), lasts `h` seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    pub(super) start: f64,
    pub(super) h: f64,
    pub(super) new_output: bool,
}

/// The steps inside one sample: `substeps` equal ones, that in which the new output arrives divided there.
pub(super) fn grid(ts: f64, substeps: usize, fraction: f64) -> Vec<Step> {
    let whole = ts / substeps as f64;
    let mut steps = Vec::new();
    let mut add = |start: f64, h: f64, new_output: bool| steps.push(Step { start, h, new_output });
    for j in 0..substeps {
        let (start, end) = (j as f64 / substeps as f64, (j + 1) as f64 / substeps as f64);
        if fraction > start + SAME && fraction < end - SAME {
            let first = (fraction - start) * ts;
            add(start, first, false);
            add(fraction, whole - first, true);
        } else {
            add(start, whole, start >= fraction - SAME);
        }
    }
    steps
}
