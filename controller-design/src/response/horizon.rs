//! Indices up to a given time instead of to the end of the response.

use core::ops::ControlFlow;

use super::measure::{Element, Sums, interpolated};
use super::nodes::{Values, nodes};

/// Gathers the indices up to a time, in the units of the realisation.
pub(super) struct Horizon {
    pub(super) sums: Sums,
    /// Integral of the output, with its sign.
    pub(super) area: f64,
    end: f64,
}

impl Horizon {
    pub(super) fn new(end: f64) -> Self {
        Self { sums: Sums::default(), area: 0.0, end }
    }

    pub(super) fn visit(&mut self, e: &Element<'_>) -> ControlFlow<()> {
        if e.start + e.length < self.end {
            self.add(e);
            return ControlFlow::Continue(());
        }
        // A part of a polynomial is a polynomial: nothing is lost at the cut.
        let length = self.end - e.start;
        let part = |values: &Values| -> Values {
            core::array::from_fn(|i| interpolated(values, length / e.length * i as f64 / 8.0))
        };
        let (v, y) = (part(e.v), part(e.y));
        self.add(&Element { start: e.start, length, v: &v, y: &y });
        ControlFlow::Break(())
    }

    fn add(&mut self, e: &Element<'_>) {
        self.sums.add(e);
        self.area += e.length * nodes().weights.iter().zip(e.y).map(|(w, y)| w * y).sum::<f64>();
    }
}
