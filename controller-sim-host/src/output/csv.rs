//! Every sample of every controller as CSV.

use super::samples::{Columns, NUMBERS};
use crate::simulate::Sample;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes samples as lines as they come: `controller,t,r,y,u,applied,u_f,d_hat,d,mode,status`, before these
/// `scenario,case` and after `d` `inner_r,inner_y` when the [columns](Columns) ask for them. Numbers in SI units with all
/// their digits; a measurement that is bad is `NaN`; `status` is the number of its bits; what a controller has not is
/// empty. Needs no memory that grows with the run.
#[derive(Debug)]
pub struct CsvWriter<W> {
    to: W,
    columns: Columns,
    /// The fields of the chapter, with the comma after them.
    chapter: String,
    /// The fields in front of the numbers.
    front: String,
    line: String,
    cells: [Cell; NUMBERS.len()],
    inner: [Cell; 2],
}

/// A number as text. Many signals stand still for long: their digits are found once.
#[derive(Debug, Default)]
struct Cell {
    bits: u64,
    text: String,
}

impl Cell {
    fn set(&mut self, x: f64) -> &str {
        if self.text.is_empty() || self.bits != x.to_bits() {
            self.bits = x.to_bits();
            self.text.clear();
            push_number(&mut self.text, x);
        }
        &self.text
    }
}

impl<W: Write> CsvWriter<W> {
    /// Begins a file with the names of its columns.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn new(mut to: W, columns: Columns) -> io::Result<Self> {
        writeln!(to, "{}", columns.names().collect::<Vec<_>>().join(","))?;
        let (chapter, front, line) = (String::new(), String::new(), String::new());
        Ok(Self { to, columns, chapter, front, line, cells: Default::default(), inner: Default::default() })
    }

    /// The samples of this scenario and case follow.
    pub fn chapter(&mut self, scenario: &str, case: Option<&str>) {
        if self.columns.chapters {
            self.chapter = format!("{},{},", field(scenario), field(case.unwrap_or("")));
        }
    }

    /// The samples of this controller follow.
    pub fn controller(&mut self, name: &str) {
        self.front = format!("{}{}", self.chapter, field(name));
    }

    /// Writes one sample.
    ///
    /// # Errors
    /// Whatever the writer cannot do.
    pub fn sample(&mut self, s: &Sample) -> io::Result<()> {
        self.line.clear();
        self.line.push_str(&self.front);
        let (numbers, inner) = super::samples::numbers(s);
        for (cell, x) in self.cells.iter_mut().zip(numbers) {
            self.line.push(',');
            self.line.push_str(cell.set(x));
        }
        if self.columns.inner {
            for (i, cell) in self.inner.iter_mut().enumerate() {
                self.line.push(',');
                self.line.push_str(inner.map_or("", |both| cell.set(both[i])));
            }
        }
        // Writing to a string does not fail.
        let _ = writeln!(self.line, ",{},{}", s.mode.name(), s.status.bits());
        self.to.write_all(self.line.as_bytes())
    }

    /// The writer, with everything handed to it.
    pub fn into_inner(self) -> W {
        self.to
    }
}

/// Adds the shortest digits that are read back as `x`, without an exponent: as short as `{x}`, and much faster.
fn push_number(text: &mut String, x: f64) {
    let mut buffer = zmij::Buffer::new();
    let digits = buffer.format(x);
    // Very large and very small numbers come with an exponent.
    if x.is_finite() && !digits.contains('e') {
        text.push_str(digits.strip_suffix(".0").unwrap_or(digits));
    } else {
        // Writing to a string does not fail.
        let _ = write!(text, "{x}");
    }
}

/// A text as a CSV field: in quotes when it has a comma, a quote, a line break or a space at an end.
pub(super) fn field(text: &str) -> String {
    if text.contains([',', '"', ';', '\n', '\r']) || text.trim() != text {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::InnerSample;
    use controller_core::{Mode, Status};

    #[test]
    fn a_name_with_a_comma_is_one_field() {
        assert_eq!(field("PI, \"fast\""), "\"PI, \"\"fast\"\"\"");
        assert_eq!(field("PI + DOB"), "PI + DOB");
    }

    #[test]
    fn a_number_that_stands_still_is_written_again() {
        let (mode, status) = (Mode::Auto, Status::BAD_INPUT);
        let sample = |t, y| Sample {
            t,
            r: 0.1,
            y,
            u: -0.0,
            applied: 1e-7,
            u_f: 0.0,
            d_hat: 2.0,
            d: 0.0,
            mode,
            status,
            inner: None,
        };
        let mut csv = CsvWriter::new(Vec::new(), Columns { chapters: true, inner: false }).expect("memory");
        csv.chapter("a,b.toml", Some("latency = 0.1"));
        csv.controller("PI");
        for s in [sample(0.0, 1.0), sample(0.5, f64::NAN), sample(1.0, 0.0)] {
            csv.sample(&s).expect("memory");
        }
        csv.chapter("c.toml", None);
        csv.controller("PI");
        csv.sample(&sample(0.0, -0.0)).expect("memory");
        let expected = "\
scenario,case,controller,t,r,y,u,applied,u_f,d_hat,d,mode,status
\"a,b.toml\",latency = 0.1,PI,0,0.1,1,-0,0.0000001,0,2,0,auto,32
\"a,b.toml\",latency = 0.1,PI,0.5,0.1,NaN,-0,0.0000001,0,2,0,auto,32
\"a,b.toml\",latency = 0.1,PI,1,0.1,0,-0,0.0000001,0,2,0,auto,32
c.toml,,PI,0,0.1,-0,-0,0.0000001,0,2,0,auto,32
";
        assert_eq!(String::from_utf8(csv.into_inner()).expect("text"), expected);
    }

    #[test]
    fn a_loop_inside_has_two_columns() {
        let mut csv = CsvWriter::new(Vec::new(), Columns { chapters: false, inner: true }).expect("memory");
        let (mode, status, inner) = (Mode::Auto, Status::default(), None);
        let one = Sample {
            t: 0.0,
            r: 1.0,
            y: 2.0,
            u: 3.0,
            applied: 4.0,
            u_f: 5.0,
            d_hat: 6.0,
            d: 7.0,
            mode,
            status,
            inner,
        };
        csv.controller("single");
        csv.sample(&one).expect("memory");
        csv.controller("cascade");
        csv.sample(&Sample { inner: Some(InnerSample { r: 8.0, y: 9.5 }), ..one }).expect("memory");
        let expected = "\
controller,t,r,y,u,applied,u_f,d_hat,d,inner_r,inner_y,mode,status
single,0,1,2,3,4,5,6,7,,,auto,0
cascade,0,1,2,3,4,5,6,7,8,9.5,auto,0
";
        assert_eq!(String::from_utf8(csv.into_inner()).expect("text"), expected);
    }

    /// All kinds of bit patterns, and numbers as signals have them: each is read back as it was, and no text is longer than
    /// that of the standard library. Of two texts as short and as near (`...320.2` and `...320.3`) either will do.
    #[test]
    fn numbers_are_short_and_lose_nothing() {
        let mut bits = 1_u64;
        let special = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            1e15,
            1e16,
            1e17,
            1e21,
            1e-4,
            1e-5,
            1e-6,
            5e-324,
            f64::MAX,
            f64::NAN,
            f64::INFINITY,
        ];
        let random = (0..300_000).map(|i| {
            // A generator of full period: all that matters is that every exponent comes up.
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let whole = bits >> 11;
            match i % 3 {
                0 => f64::from_bits(bits),
                1 => whole as f64 / 9_007_199_254_740_992.0,
                _ => (whole % 1_000_000) as f64 * 0.001 - 500.0,
            }
        });
        for x in special.into_iter().chain(random) {
            let mut text = String::new();
            push_number(&mut text, x);
            let read: f64 = text.parse().expect("a number");
            assert!(read.to_bits() == x.to_bits() || (x.is_nan() && text == "NaN"), "{x}: {text}");
            assert_eq!(text.len(), format!("{x}").len(), "{x}: {text}");
        }
    }
}
