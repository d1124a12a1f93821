//! From the envelope of a signal to the path of an SVG picture: nothing that the envelope shows is lost.

use crate::simulate::{Band, Envelope, Record};
use std::fmt::Write;

/// Where a signal is drawn: time and value to hundredths of a unit of the picture.
pub(super) struct Plane<'a> {
    /// What tells the time of the bands.
    pub(super) record: &'a Record,
    /// Time at the left and at the right edge \[s\].
    pub(super) time: (f64, f64),
    /// The value's place, 0 at the bottom and 1 at the top.
    pub(super) share: &'a dyn Fn(f64) -> f64,
    /// Width and height in units of the picture.
    pub(super) size: (f64, f64),
}

/// What a signal does between its samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Between {
    /// It moves on to the next value: the plant's output.
    Moves,
    /// It is held: what a sampled controller reads and gives.
    Held,
}

/// The paths of a signal, as the attribute `d` takes them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Paths {
    /// The line.
    pub(super) line: String,
    /// What the signal covers within a band beyond the line, to be filled; empty when the line says all.
    pub(super) area: String,
}

/// A band at least this wide has room for its extreme value as a point of the line.
const WIDE: i64 = 300;

impl Plane<'_> {
    /// The place of a time, in hundredths.
    pub(super) fn x(&self, t: f64) -> i64 {
        let (from, to) = self.time;
        hundredths((t - from) / (to - from) * self.size.0)
    }

    /// The place of a value, in hundredths.
    pub(super) fn y(&self, value: f64) -> i64 {
        hundredths((1.0 - (self.share)(value)) * self.size.1)
    }

    /// The beginning and the end of a band.
    pub(super) fn span(&self, index: usize) -> (i64, i64) {
        (self.x(self.record.time(index)), self.x(self.record.time(index + 1).min(self.time.1)))
    }

    /// Draws a signal. A band of one sample is its value; of a band of many samples all from the smallest to the
    /// largest value is covered, by the line or by the area.
    pub(super) fn draw(&self, envelope: &Envelope, between: Between) -> Paths {
        let places: Vec<Option<Place>> = (0..)
            .zip(&envelope.bands)
            .map(|(i, band)| band.map(|band| self.place(i, &band, between)))
            .collect();
        let (mut line, mut area) = (Pen::default(), Area::default());
        let fills = |i: Option<usize>| i.and_then(|i| *places.get(i)?).is_some_and(|place| place.fills);
        for (index, place) in places.iter().enumerate() {
            let Some(place) = place else {
                line.lift();
                area.end();
                continue;
            };
            let middle = (place.left + place.right) / 2;
            if place.fills {
                area.add(place);
            } else {
                area.end();
            }
            if place.fills && (fills(index.checked_sub(1)) || fills(Some(index + 1))) {
                // Noise: which of many values was the first says nothing.
                line.to(middle, (place.top + place.bottom) / 2);
                continue;
            }
            if between == Between::Held {
                line.across(place.left);
            }
            line.to(place.left, place.first);
            match (between, place.turn) {
                (Between::Moves, Some(turn)) => line.to(middle, turn),
                // The change is somewhere inside; of two samples it is exactly here.
                (Between::Held, _) if place.first != place.last => {
                    line.across(middle);
                    line.to(middle, place.last);
                }
                _ => {}
            }
            line.to(place.right, place.last);
        }
        area.end();
        Paths { line: line.finish(), area: area.pen.finish() }
    }

    fn place(&self, index: usize, band: &Band, between: Between) -> Place {
        let (left, right) = self.span(index);
        let [first, top, bottom, last] = [band.first, band.max, band.min, band.last].map(|v| self.y(v));
        // Upwards the numbers fall.
        let (above, below) = (top < first.min(last), bottom > first.max(last));
        let turns = between == Between::Moves && above != below && right - left >= WIDE;
        let turn = turns.then_some(if above { top } else { bottom });
        Place { left, right, first, top, bottom, last, turn, fills: (above || below) && !turns }
    }
}

/// A band in the picture.
#[derive(Debug, Clone, Copy)]
struct Place {
    left: i64,
    right: i64,
    first: i64,
    top: i64,
    bottom: i64,
    last: i64,
    /// The extreme value where the line turns.
    turn: Option<i64>,
    /// The line alone does not cover all values.
    fills: bool,
}

/// Writes a path: relative steps of hundredths, without those that go nowhere.
#[derive(Debug, Default)]
pub(super) struct Pen {
    text: String,
    down: bool,
    x: i64,
    y: i64,
    /// The last step, not written yet: a longer one of the same direction takes its place.
    step: (i64, i64),
}

impl Pen {
    /// The next point begins a new line.
    pub(super) fn lift(&mut self) {
        self.write_step();
        self.down = false;
    }

    /// A line to a point, or the beginning of one.
    pub(super) fn to(&mut self, x: i64, y: i64) {
        if !self.down {
            self.down = true;
            self.text.push('M');
            push_pair(&mut self.text, x, y);
        } else {
            let (dx, dy) = (x - self.x, y - self.y);
            let (sx, sy) = self.step;
            let along_x = sy == 0 && dy == 0 && sx.signum() * dx.signum() >= 0;
            let along_y = sx == 0 && dx == 0 && sy.signum() * dy.signum() >= 0;
            if !(along_x || along_y) {
                self.write_step();
            }
            self.step = (self.step.0 + dx, self.step.1 + dy);
        }
        (self.x, self.y) = (x, y);
    }

    /// A level line to `x`, when there is a line.
    pub(super) fn across(&mut self, x: i64) {
        if self.down {
            self.to(x, self.y);
        }
    }

    /// A line back to where this one began.
    pub(super) fn close(&mut self) {
        self.lift();
        self.text.push('z');
    }

    /// The path.
    pub(super) fn finish(mut self) -> String {
        self.lift();
        self.text
    }

    fn write_step(&mut self) {
        let (dx, dy) = std::mem::take(&mut self.step);
        match (dx, dy) {
            (0, 0) => {}
            (dx, 0) => {
                self.text.push('h');
                push_number(&mut self.text, dx);
            }
            (0, dy) => {
                self.text.push('v');
                push_number(&mut self.text, dy);
            }
            (dx, dy) => {
                self.text.push('l');
                push_pair(&mut self.text, dx, dy);
            }
        }
    }
}

/// The outlines of neighbouring bands as one.
#[derive(Debug, Default)]
struct Area {
    pen: Pen,
    bands: Vec<Place>,
}

impl Area {
    fn add(&mut self, place: &Place) {
        self.bands.push(*place);
    }

    fn end(&mut self) {
        if self.bands.is_empty() {
            return;
        }
        for place in &self.bands {
            self.pen.to(place.left, place.top);
            self.pen.to(place.right, place.top);
        }
        for place in self.bands.iter().rev() {
            self.pen.to(place.right, place.bottom);
            self.pen.to(place.left, place.bottom);
        }
        self.pen.close();
        self.bands.clear();
    }
}

/// To hundredths.
pub(super) fn hundredths(x: f64) -> i64 {
    (x * 100.0).round() as i64
}

fn push_pair(text: &mut String, x: i64, y: i64) {
    push_number(text, x);
    if y >= 0 {
        text.push(' ');
    }
    push_number(text, y);
}

/// Hundredths as the shortest number.
pub(super) fn push_number(text: &mut String, hundredths: i64) {
    let (whole, part) = (hundredths.unsigned_abs() / 100, hundredths.unsigned_abs() % 100);
    if hundredths < 0 {
        text.push('-');
    }
    // Writing to a text cannot fail.
    let _ = match (whole, part) {
        (whole, 0) => write!(text, "{whole}"),
        (0, part) if part % 10 == 0 => write!(text, ".{}", part / 10),
        (0, part) => write!(text, ".{part:02}"),
        (whole, part) if part % 10 == 0 => write!(text, "{whole}.{}", part / 10),
        (whole, part) => write!(text, "{whole}.{part:02}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::View;

    /// Smallest and largest height of every point of a path, per column of the picture.
    fn extents(path: &str, columns: usize) -> Vec<Option<(i64, i64)>> {
        let mut list = vec![None; columns];
        let (mut x, mut y, mut numbers, mut command) = (0, 0, Vec::new(), 'M');
        let mut start = (0, 0);
        let mut token = String::new();
        let mut visit = |x: i64, y: i64| {
            // A point between two columns belongs to both.
            for column in [(x - 1).div_euclid(100), x.div_euclid(100)] {
                if let Some(slot) = usize::try_from(column).ok().and_then(|c| list.get_mut(c)) {
                    let (lo, hi) = slot.unwrap_or((y, y));
                    *slot = Some((lo.min(y), hi.max(y)));
                }
            }
        };
        for c in path.chars().chain(['M']) {
            let ends = c.is_ascii_alphabetic() || c == ' ' || c == '-' || (c == '.' && token.contains('.'));
            if ends && !token.is_empty() {
                numbers.push(hundredths(token.parse::<f64>().expect("a number")));
                token.clear();
            }
            let needs = if matches!(command, 'h' | 'v') { 1 } else { 2 };
            if numbers.len() == needs {
                (x, y) = match command {
                    'M' => (numbers[0], numbers[1]),
                    'h' => (x + numbers[0], y),
                    'v' => (x, y + numbers[0]),
                    _ => (x + numbers[0], y + numbers[1]),
                };
                if command == 'M' {
                    start = (x, y);
                }
                visit(x, y);
                numbers.clear();
            }
            match c {
                'z' => (x, y) = start,
                'M' | 'h' | 'v' | 'l' => command = c,
                ' ' => {}
                c => token.push(c),
            }
        }
        list
    }

    /// A picture of `columns` columns, as wide and as high as there are.
    fn drawn(samples: &[f64], columns: usize, between: Between) -> (Paths, Envelope) {
        let view = View { from: 0.0, to: samples.len() as f64, columns };
        let record = Record::new(view, 1.0, samples.len() as u64);
        let bands = samples.chunks(record.samples as usize).map(|chunk| {
            let mut values = chunk.iter().copied().filter(|x| x.is_finite());
            let (min, max) = (values.clone().reduce(f64::min)?, values.clone().reduce(f64::max)?);
            let last = values.clone().next_back()?;
            Some(Band { first: values.next()?, min, max, last })
        });
        let envelope = Envelope { bands: bands.collect() };
        let size = (columns as f64, 100.0);
        let plane = Plane { record: &record, time: (0.0, samples.len() as f64), share: &|x| x, size };
        (plane.draw(&envelope, between), envelope)
    }

    #[test]
    fn nothing_that_a_band_holds_is_lost() {
        // A sequence without any pattern: the fractional parts of the multiples of an irrational number.
        let samples: Vec<f64> = (0..20_000).map(|k| (f64::from(k) * 0.618_033_988_749_9).fract()).collect();
        for between in [Between::Moves, Between::Held] {
            let (paths, envelope) = drawn(&samples, 1000, between);
            let (line, area) = (extents(&paths.line, 1000), extents(&paths.area, 1000));
            for (index, band) in envelope.bands.iter().enumerate() {
                let band = band.expect("no gap");
                let places = [line[index], area[index]].into_iter().flatten();
                let (top, bottom) =
                    places.reduce(|(a, b), (c, d)| (a.min(c), b.max(d))).expect("something is drawn");
                assert!(top <= hundredths((1.0 - band.max) * 100.0), "{index} {band:?} {top}");
                assert!(bottom >= hundredths((1.0 - band.min) * 100.0), "{index} {band:?} {bottom}");
            }
        }
    }

    #[test]
    fn one_sample_of_a_million_is_seen() {
        let mut samples = vec![0.25; 1_000_000];
        samples[345_678] = 0.75;
        for between in [Between::Moves, Between::Held] {
            let (paths, _) = drawn(&samples, 1000, between);
            assert_eq!(extents(&paths.area, 1000)[345], Some((2500, 7500)));
            assert_eq!(paths.line, "M0 75h1000");
            assert_eq!(paths.area, "M345 25h1v50h-1z");
        }
    }

    #[test]
    fn single_samples_are_exact() {
        let (paths, _) = drawn(&[0.1, 0.1, 0.8, 0.5], 4, Between::Held);
        assert_eq!((&*paths.line, &*paths.area), ("M0 90h2v-70h1v30h1", ""));
        // The envelope of a moving signal has its end in it, here that of the held value.
        let (paths, _) = drawn(&[0.1, 0.8], 2, Between::Moves);
        assert_eq!(paths.line, "M0 90h1v-70h1");
    }

    #[test]
    fn two_samples_in_a_band_are_exact_too() {
        let (paths, _) = drawn(&[0.1, 0.2, 0.8, 0.5], 2, Between::Held);
        assert_eq!((&*paths.line, &*paths.area), ("M0 90h.5v-10h.5v-60h.5v30h.5", ""));
    }

    #[test]
    fn what_is_not_known_is_a_gap() {
        let (paths, _) = drawn(&[0.1, f64::NAN, 0.8], 3, Between::Held);
        assert_eq!(paths.line, "M0 90h1M2 20h1");
    }

    #[test]
    fn noise_is_one_area_with_a_line_in_its_middle() {
        let samples: Vec<f64> = (0..40).map(|k| [0.5, 0.9, 0.1, 0.5][k % 4]).collect();
        let (paths, _) = drawn(&samples, 10, Between::Held);
        assert_eq!(paths.area, "M0 10h10v80h-10z");
        assert_eq!(paths.line, "M.5 50h9");
    }

    #[test]
    fn numbers_are_short() {
        let shown = |x| {
            let mut text = String::new();
            push_number(&mut text, hundredths(x));
            text
        };
        assert_eq!(
            [0.0, -0.001, 0.05, -0.5, 12.0, -3.25, 100.1].map(shown),
            ["0", "0", ".05", "-.5", "12", "-3.25", "100.1"]
        );
    }
}
