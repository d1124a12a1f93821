//! When a response is over, and what a march that ends otherwise means.

use core::ops::ControlFlow;

use super::march::Outcome;
use super::measure::{Element, Sums};
use super::nodes;
use crate::Refusal;

/// Gathers the indices until what is left is negligible.
pub(super) struct Settling {
    pub(super) sums: Sums,
    accuracy: f64,
    limit: f64,
    /// Time and ITAE at the last look, and the largest y and v since.
    since: (f64, f64),
    y_max: f64,
    v_max: f64,
    v_ever: f64,
}

impl Settling {
    pub(super) fn new(accuracy: f64, limit: f64) -> Self {
        let sums = Sums::default();
        Self { sums, accuracy, limit, since: (0.0, 0.0), y_max: 0.0, v_max: 0.0, v_ever: 0.0 }
    }

    pub(super) fn visit(&mut self, e: &Element<'_>) -> ControlFlow<()> {
        self.sums.add(e);
        self.y_max = self.y_max.max(nodes::size(e.y));
        self.v_max = self.v_max.max(nodes::size(e.v));
        if self.sums.iae > self.limit {
            return ControlFlow::Break(());
        }
        let time = e.start + e.length;
        // A mode that dies out leaves less behind than it gave over the last quarter of the time, once it has
        // fallen to a millionth.
        if time < 1.25 * self.since.0 {
            return ControlFlow::Continue(());
        }
        self.v_ever = self.v_ever.max(self.v_max);
        let small = 0.1 * self.accuracy;
        let over = self.sums.y_max > 0.0
            && self.sums.itae - self.since.1 <= small * self.sums.itae
            && self.y_max <= small * self.sums.y_max
            && self.v_max <= small * self.v_ever;
        self.since = (time, self.sums.itae);
        (self.y_max, self.v_max) = (0.0, 0.0);
        if over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

pub(super) fn unstable() -> Refusal {
    Refusal::NoSolution {
        why: "the loop of this plant and controller is unstable",
        help: "lower kp and ki, or check the sign of the gain",
    }
}

pub(super) fn verdict(outcome: Outcome) -> Result<(), Refusal> {
    match outcome {
        Outcome::Stopped | Outcome::Unresolved => Ok(()),
        Outcome::Unstable => Err(unstable()),
        Outcome::Endless => Err(Refusal::NoSolution {
            why: "the response of this loop does not settle in any reasonable time",
            help: "lower kp, or raise ki if the tail is slow",
        }),
    }
}
