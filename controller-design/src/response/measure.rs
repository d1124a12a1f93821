//! Indices gathered element by element.

use super::nodes::{Centred, NODES, Values, nodes, position, size};

/// One element of a response, in the units of the realisation.
pub(super) struct Element<'a> {
    /// Time at its start.
    pub(super) start: f64,
    pub(super) length: f64,
    /// Plant input, load included, at the nodes.
    pub(super) v: &'a Values,
    /// Output at the nodes.
    pub(super) y: &'a Values,
}

/// Sums so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) iae: f64,
    pub(super) ise: f64,
    pub(super) itae: f64,
    pub(super) tv: f64,
    pub(super) y_max: f64,
    pub(super) t_max: f64,
}

impl Sums {
    pub(super) fn add(&mut self, element: &Element<'_>) {
        let (h, y) = (element.length, element.y);
        let weights = &nodes().weights;
        self.ise += h * weights.iter().zip(y).map(|(w, y)| w * y * y).sum::<f64>();
        self.add_absolute(element);
        if size(y) > 0.9 * self.y_max {
            self.add_peak(element);
        }
        self.tv += variation(element.v);
    }

    fn add_absolute(&mut self, element: &Element<'_>) {
        let (h, y) = (element.length, element.y);
        if y.iter().all(|y| *y >= 0.0) || y.iter().all(|y| *y <= 0.0) {
            let (mut area, mut moment) = (0.0, 0.0);
            for (i, (w, y)) in nodes().weights.iter().zip(y).enumerate() {
                area += w * y;
                moment += w * y * (element.start + h * i as f64 / 8.0);
            }
            self.iae += h * area.abs();
            self.itae += h * moment.abs();
            return;
        }
        let p = nodes().polynomial(y);
        let middle = element.start + 0.5 * h;
        let (mut area, mut moment) = (0.0, 0.0);
        let mut to = |x: f64| {
            let (next_area, next_moment) = (0.5 * h * p.integral(x), 0.25 * h * h * p.moment(x));
            let (da, dm) = (next_area - area, next_moment - moment);
            self.iae += da.abs();
            self.itae += (middle * da + dm).abs();
            (area, moment) = (next_area, next_moment);
        };
        for i in 1..NODES {
            if (y[i - 1] < 0.0 && y[i] > 0.0) || (y[i - 1] > 0.0 && y[i] < 0.0) {
                to(p.root(position(i - 1), position(i)));
            } else if y[i - 1] == 0.0 {
                to(position(i - 1));
            }
        }
        to(1.0);
    }

    fn add_peak(&mut self, element: &Element<'_>) {
        for (i, y) in element.y.iter().enumerate() {
            self.raise(element, position(i), *y);
        }
        turns(element.y, |x, y| self.raise(element, x, y));
    }

    fn raise(&mut self, element: &Element<'_>, x: f64, y: f64) {
        if y.abs() > self.y_max {
            self.y_max = y.abs();
            self.t_max = element.start + 0.5 * element.length * (1.0 + x);
        }
    }
}

/// Calls `turn(position, value)` for every extremum inside an element.
pub(super) fn turns(values: &Values, mut turn: impl FnMut(f64, f64)) {
    if nodes().is_monotonic(values) {
        return;
    }
    let p = nodes().polynomial(values);
    let slope = p.slope();
    let at: Values = core::array::from_fn(|i| slope.at(position(i)));
    for i in 1..NODES {
        if at[i - 1] * at[i] < 0.0 {
            let x = slope.root(position(i - 1), position(i));
            turn(x, p.at(x));
        }
    }
}

/// Total variation inside an element.
fn variation(values: &Values) -> f64 {
    let (mut sum, mut last) = (0.0, values[0]);
    turns(values, |_, value| {
        sum += (value - last).abs();
        last = value;
    });
    sum + (values[8] - last).abs()
}

/// The value at a position, 0 at the start and 1 at the end of the element.
pub(super) fn interpolated(values: &Values, x: f64) -> f64 {
    let p: Centred = nodes().polynomial(values);
    p.at(2.0 * x - 1.0)
}
