//! Lines along which values on a rectangular grid are equal.
//!
//! Marching squares: between two neighbouring points a value is interpolated linearly, in a cell with two points above on one
//! diagonal and two below on the other the mean of the four decides which of them hang together. Points without a value are
//! holes: cells with such a corner have no line, and lines end at them.
//!
//! ```
//! use controller_sim_host::contour::Field;
//!
//! let (x, y) = ([0.0, 1.0, 3.0], [0.0, 1.0]);
//! let field = Field::new(&x, &y, &[0.0, 1.0, 3.0, 0.0, 1.0, 3.0]);
//! assert_eq!(field.lines(2.0, 0.0), [[(2.0, 0.0), (2.0, 1.0)]]);
//! ```

use std::collections::BTreeMap;

/// A point of a line.
pub type Place = (f64, f64);

/// Values on a grid.
#[derive(Debug, Clone, Copy)]
pub struct Field<'a> {
    x: &'a [f64],
    y: &'a [f64],
    values: &'a [f64],
}

/// The stretch between two neighbouring points, by the number of the first one and whether it runs along y.
type Edge = (usize, bool);

impl<'a> Field<'a> {
    /// `values` at rising places `x` and `y`: all of the first y, in the order of x, then all of the second. What is not
    /// finite is a hole. Values that are missing at the end are holes, too.
    #[must_use]
    pub fn new(x: &'a [f64], y: &'a [f64], values: &'a [f64]) -> Self {
        Self { x, y, values }
    }

    fn value(&self, point: usize) -> f64 {
        self.values.get(point).copied().unwrap_or(f64::NAN)
    }

    fn place(&self, point: usize) -> Place {
        (self.x[point % self.x.len()], self.y[point / self.x.len()])
    }

    /// The lines of `level`; one that is closed ends where it begins. A value up to `level + margin` counts as not above it, so
    /// that a plain at this level, but for rounding, has no lines. Cost: one look at every cell.
    #[must_use]
    pub fn lines(&self, level: f64, margin: f64) -> Vec<Vec<Place>> {
        let width = self.x.len();
        let is_above = |point: usize| self.value(point) > level + margin;
        // Each edge that is crossed, with the edges that the line goes on to: one for each cell beside it.
        let mut next: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
        for row in 0..self.y.len().saturating_sub(1) {
            for column in 0..width.saturating_sub(1) {
                // Counter-clockwise from the corner of least x and y; edge i runs from corner i to the next.
                let first = row * width + column;
                let corners = [first, first + 1, first + width + 1, first + width];
                if corners.iter().any(|&corner| !self.value(corner).is_finite()) {
                    continue;
                }
                let edges: [Edge; 4] =
                    [(first, false), (first + 1, true), (first + width, false), (first, true)];
                let above = corners.map(is_above);
                let crossed: Vec<usize> = (0..4).filter(|&i| above[i] != above[(i + 1) % 4]).collect();
                let pairs: &[[usize; 2]] = match *crossed {
                    [a, b] => &[[a, b]],
                    [_, _, _, _] => {
                        let mean = corners.iter().map(|&corner| 0.25 * self.value(corner)).sum::<f64>();
                        // Corner 0 is cut off where the middle is on the other side.
                        if above[0] == (mean > level + margin) {
                            &[[0, 1], [2, 3]]
                        } else {
                            &[[3, 0], [1, 2]]
                        }
                    }
                    _ => &[],
                };
                for &[a, b] in pairs {
                    next.entry(edges[a]).or_default().push(edges[b]);
                    next.entry(edges[b]).or_default().push(edges[a]);
                }
            }
        }
        let ends: Vec<Edge> = next.iter().filter(|(_, on)| on.len() == 1).map(|(edge, _)| *edge).collect();
        let mut lines = Vec::new();
        for end in ends {
            lines.extend(self.follow(&mut next, end, level));
        }
        while let Some(edge) = next.keys().next().copied() {
            lines.extend(self.follow(&mut next, edge, level));
        }
        lines
    }

    /// Takes the line that begins at an edge.
    fn follow(&self, next: &mut BTreeMap<Edge, Vec<Edge>>, from: Edge, level: f64) -> Option<Vec<Place>> {
        let (mut here, mut edges) = (from, 1);
        let mut line = Vec::new();
        let mut on = next.remove(&from)?;
        loop {
            let place = self.crossing(here, level);
            if line.last() != Some(&place) {
                line.push(place);
            }
            let Some(to) = on.iter().find(|edge| next.contains_key(edge)).copied() else { break };
            on = next.remove(&to).unwrap_or_default();
            (here, edges) = (to, edges + 1);
        }
        // Of a line of one stretch the beginning is the end's neighbour, too.
        if edges > 2 && on.contains(&from) {
            line.push(self.crossing(from, level));
        }
        // A line that touches a point of the grid only is none.
        (line.len() > 1).then_some(line)
    }

    fn crossing(&self, (point, along_y): Edge, level: f64) -> Place {
        let other = point + if along_y { self.x.len() } else { 1 };
        let ((a, b), (from, to)) =
            ((self.place(point), self.place(other)), (self.value(point), self.value(other)));
        let share = ((level - from) / (to - from)).clamp(0.0, 1.0);
        (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaced(count: usize) -> Vec<f64> {
        (0..count).map(|i| -1.0 + 2.0 * i as f64 / (count - 1) as f64).collect()
    }

    fn of(x: &[f64], y: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        y.iter().flat_map(|&y| x.iter().map(move |&x| (x, y))).map(|(x, y)| f(x, y)).collect()
    }

    fn is_closed(line: &[Place]) -> bool {
        line.len() > 3 && line.first() == line.last()
    }

    /// Linear interpolation of a quadratic is off by at most h^2/8 of its second derivative, 2: `r^2` by h^2/4 along an edge.
    #[test]
    fn circles_are_closed_and_round() {
        let x = spaced(41);
        let values = of(&x, &x, |x, y| x * x + y * y);
        let field = Field::new(&x, &x, &values);
        for radius in [0.13, 0.5, 0.77, 0.95] {
            let lines = field.lines(radius * radius, 0.0);
            assert_eq!(lines.len(), 1, "{radius}");
            assert!(is_closed(&lines[0]), "{radius}");
            for (x, y) in &lines[0] {
                let off = x * x + y * y - radius * radius;
                assert!((-1e-12..=0.05 * 0.05 / 4.0 + 1e-12).contains(&-off), "{radius}: {off}");
            }
            // The polygon has nearly the area of the circle.
            let area: f64 = lines[0].windows(2).map(|w| 0.5 * (w[0].0 * w[1].1 - w[1].0 * w[0].1)).sum();
            let exact = core::f64::consts::PI * radius * radius;
            assert!((area.abs() - exact).abs() < 0.004, "{radius}: {area} {exact}");
        }
        // Beyond the nearest border four arcs are left, and beyond the corners nothing.
        let arcs = field.lines(1.5, 0.0);
        assert!(arcs.len() == 4 && arcs.iter().all(|line| !is_closed(line)));
        assert!(field.lines(2.5, 0.0).is_empty() && field.lines(-0.1, 0.0).is_empty());
    }

    /// `x*y`: two branches on either side; at the level of the saddle itself they do not cross.
    #[test]
    fn branches_of_a_saddle() {
        let x = spaced(20);
        let values = of(&x, &x, |x, y| x * y);
        let field = Field::new(&x, &x, &values);
        for level in [0.25, -0.25, 0.01, -0.01, 1e-6] {
            let lines = field.lines(level, 0.0);
            assert_eq!(lines.len(), 2, "{level}");
            for (x, y) in lines.iter().flatten() {
                // On an edge x*y is linear: exact.
                assert!((x * y - level).abs() < 1e-12, "{level}: {x} {y}");
            }
        }
        // One cell: the mean decides.
        let one = [0.0, 1.0];
        let both = |mean_above: bool| {
            let values = if mean_above { [1.0, 0.4, 0.4, 1.0] } else { [0.6, 0.0, 0.0, 0.6] };
            Field::new(&one, &one, &values).lines(0.5, 0.0)
        };
        // Above: the corners that are below are cut off, (1,0) and (0,1); else (0,0) and (1,1).
        let near = |lines: &[Vec<Place>], corner: Place| {
            lines
                .iter()
                .any(|line| line.iter().all(|p| (p.0 - corner.0).abs() + (p.1 - corner.1).abs() < 0.9))
        };
        let (above, below) = (both(true), both(false));
        assert!(above.len() == 2 && near(&above, (1.0, 0.0)) && near(&above, (0.0, 1.0)), "{above:?}");
        assert!(below.len() == 2 && near(&below, (0.0, 0.0)) && near(&below, (1.0, 1.0)), "{below:?}");
    }

    /// A plane on an uneven grid: exact.
    #[test]
    fn a_plane_on_an_uneven_grid() {
        let (x, y) = ([0.0, 0.1, 0.7, 1.0, 4.0], [-3.0, 0.0, 0.5]);
        let values = of(&x, &y, |x, y| 2.0 * x - y);
        let lines = Field::new(&x, &y, &values).lines(1.0, 0.0);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|(x, y)| (2.0 * x - y - 1.0).abs() < 1e-12));
        let ends = [lines[0].first().expect("a point").1, lines[0].last().expect("a point").1];
        assert!(ends.contains(&0.5) && ends.contains(&-1.0), "{ends:?}");
    }

    #[test]
    fn lines_end_at_holes() {
        let x = spaced(21);
        let hole = |x: f64, y: f64| x.abs() < 0.01 && y > 0.3 && y < 0.7;
        let values = of(&x, &x, |x, y| if hole(x, y) { f64::NAN } else { x * x + y * y });
        let lines = Field::new(&x, &x, &values).lines(0.25, 0.0);
        assert!(lines.len() == 1 && !is_closed(&lines[0]));
        assert!(lines[0].iter().all(|(x, y)| x.abs() >= 0.09 || *y < 0.0), "none in a cell at the hole");
        let all = vec![f64::NAN; 441];
        assert!(Field::new(&x, &x, &all).lines(0.25, 0.0).is_empty());
        assert!(Field::new(&x, &x, &[]).lines(0.25, 0.0).is_empty());
        assert!(Field::new(&[], &[], &[]).lines(0.0, 0.0).is_empty());
    }

    /// A plain at the level has lines where it rises beyond it only.
    #[test]
    fn a_plain_has_no_lines() {
        let x = spaced(11);
        let values =
            of(&x, &x, |x, y| 1.0 + 1e-9 * (37.0 * x + 11.0 * y).sin() + if x < 0.0 { x } else { 0.0 });
        let field = Field::new(&x, &x, &values);
        assert!(!field.lines(1.0, 0.0).is_empty(), "rounding");
        assert!(field.lines(1.0, 1e-6).is_empty());
        assert_eq!(field.lines(0.5, 1e-6).len(), 1);
    }

    /// Every end is on the border, every line is crossed by as many changes of sign as the grid has.
    #[test]
    fn nothing_is_lost() {
        let x = spaced(30);
        for k in 1..40 {
            let k = f64::from(k);
            let values = of(&x, &x, |x, y| (k * x).sin() + ((k + 3.0) * y).cos() * 0.7 + 0.1 * x);
            let field = Field::new(&x, &x, &values);
            let lines = field.lines(0.2, 0.0);
            let above = |i: usize| values[i] > 0.2;
            let across = (0..900).filter(|i| i % 30 < 29 && above(*i) != above(i + 1)).count();
            let along = (0..870).filter(|i| above(*i) != above(i + 30)).count();
            let points: usize = lines.iter().map(|line| line.len() - usize::from(is_closed(line))).sum();
            assert_eq!(points, across + along, "{k}");
            for line in lines.iter().filter(|line| !is_closed(line)) {
                for (x, y) in [line[0], line[line.len() - 1]] {
                    assert!(x.abs().max(y.abs()) > 1.0 - 1e-12, "{x} {y}");
                }
            }
        }
    }
}
