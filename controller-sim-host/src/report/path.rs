//! From the envelope of a signal to the path of an SVG picture: nothing that the envelope shows is lost.

use crate::simulate::{Envelope, Record};
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
        let (mut line, mut area) = (Pen::default(), Area::default());
        for (index, band) in envelope.bands.iter().enumerate() {
            let Some(band) = band else {
                line.lift();
                area.end();
                continue;
            };
            let (left, right) = self.span(index);
            let [first, min, max, last] = [band.first, band.min, band.max, band.last].map(|v| self.y(v));
            if between == Between::Held {
                line.across(left);
            }
            line.to(left, first);
            // Upwards the numbers fall.
            let (above, below) = (max < first.min(last), min > first.max(last));
            let middle = (left + right) / 2;
            let one_point = between == Between::Moves && above != below && right - left >= WIDE;
            if (above || below) && !one_point {
                area.add(left, right, max, min);
            } else {
                area.end();
            }
            match between {
                Between::Moves if one_point => line.to(middle, if above { max } else { min }),
                // The change is somewhere inside; of two samples it is exactly here.
                Between::Held if first != last => {
                    line.across(middle);
                    line.to(middle, last);
                }
                _ => {}
            }
            line.to(right, last);
        }
        area.end();
        Paths { line: line.finish(), area: area.pen.finish() }
    }
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
    bands: Vec<[i64; 4]>,
}

impl Area {
    fn add(&mut self, left: i64, right: i64, top: i64, bottom: i64) {
        self.bands.push([left, right, top, bottom]);
    }

    fn end(&mut self) {
        if self.bands.is_empty() {
            return;
        }
        for [left, right, top, _] in &self.bands {
            self.pen.to(*left, *top);
            self.pen.to(*right, *top);
        }
        for [left, right, _, bottom] in self.bands.iter().rev() {
            self.pen.to(*right, *bottom);
            self.pen.to(*left, *bottom);
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
