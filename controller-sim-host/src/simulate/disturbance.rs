//! The disturbance at the plant input as a piecewise linear curve.

use crate::scenario::Signal;

/// How near two instants count as one, in samples: decimal numbers must not make steps of length 1e-16.
pub(super) const SAME: f64 = 1e-9;

/// A piece: from `at` (in samples) on, `value` rising by `slope` per second.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    at: f64,
    value: f64,
    slope: f64,
}

/// Steps, ramps and pulses added up, with a cursor that only moves forward.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pieces: Vec<Piece>,
    current: usize,
    ts: f64,
}

impl Curve {
    /// The curve that is `d0` before the first of `list`; every instant is shifted by `delay` \[s\].
    pub(super) fn new(d0: f64, list: &[(f64, Signal)], delay: f64, ts: f64) -> Self {
        // Every disturbance as changes of level and slope at instants.
        let mut changes: Vec<(f64, f64, f64)> = Vec::new();
        let mut level = d0;
        for (at, signal) in list {
            let at = *at;
            match *signal {
                Signal::Step(value) => {
                    changes.push((at, value - level, 0.0));
                    level = value;
                }
                Signal::Ramp { slope, duration } => {
                    changes.push((at, 0.0, slope));
                    if duration.is_finite() {
                        changes.push((at + duration, 0.0, -slope));
                    }
                }
                Signal::Pulse { height, duration } => {
                    changes.push((at, height, 0.0));
                    changes.push((at + duration, -height, 0.0));
                }
                Signal::Sine { .. } | Signal::Walk { .. } | Signal::Recorded(_) => {}
            }
        }
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut pieces = vec![Piece { at: f64::NEG_INFINITY, value: d0, slope: 0.0 }];
        for (at, rise, bend) in changes {
            let s = (at + delay) / ts;
            let at = if (s - s.round()).abs() < SAME { s.round() } else { s };
            let last = pieces[pieces.len() - 1];
            let passed = if last.slope == 0.0 { 0.0 } else { (at - last.at) * ts };
            let next = Piece { at, value: last.value + last.slope * passed + rise, slope: last.slope + bend };
            if last.at == at {
                pieces.pop();
            }
            pieces.push(next);
        }
        Self { pieces, current: 0, ts }
    }

    /// Where the next piece begins, in samples.
    pub(super) fn next(&self) -> Option<f64> {
        self.pieces.get(self.current + 1).map(|piece| piece.at)
    }

    /// Goes to the next piece.
    pub(super) fn enter_next(&mut self) {
        self.current += 1;
    }

    /// Value \[u\] and slope \[u/s\] of the present piece at the instant `s`, in samples.
    pub(super) fn now(&self, s: f64) -> (f64, f64) {
        let piece = self.pieces[self.current];
        let passed = if piece.slope == 0.0 { 0.0 } else { (s - piece.at) * self.ts };
        (piece.value + piece.slope * passed, piece.slope)
    }

    /// Value at the instant `s`, in samples, going forward to the piece that holds then \[u\].
    pub(super) fn advance_to(&mut self, s: f64) -> f64 {
        while self.next().is_some_and(|at| at <= s + SAME) {
            self.enter_next();
        }
        self.now(s).0
    }
}
