//! An axis: its range, its ticks at 1, 2 or 5 times a power of ten, and what stands beside them.

use std::ops::RangeInclusive;

/// Values beyond this are drawn at it: the sums and differences of what is drawn stay finite.
const MOST: f64 = 1e300;
/// Values below this are drawn as 0.
const LEAST: f64 = 1e-290;
/// A range this much smaller than its values is labelled as a difference from a round number.
const CLOSE: f64 = 1e-4;
/// Sizes that differ by more than this factor are shown by their ratios.
const RATIO: f64 = 30.0;

/// A labelled place on an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tick {
    /// Its place, from 0 to 1.
    pub(super) share: f64,
    /// Its number.
    pub(super) label: String,
    /// It is left out where there is room for half of the numbers only.
    pub(super) minor: bool,
}

/// Most numbers of an axis of time on a narrow page.
const FEW: usize = 6;

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    lo: f64,
    hi: f64,
    /// Its ticks, from below.
    pub(super) ticks: Vec<Tick>,
    /// Places of finer steps, without labels.
    pub(super) between: Vec<f64>,
    /// Round number that the labels are counted from.
    origin: f64,
    /// Power of ten that the labels are multiplied by.
    power: i32,
    /// Equal ratios are equally long.
    ratios: bool,
}

impl Axis {
    /// The axis of signals that reach from `lo` to `hi`, with some room at both ends and about `most` ticks.
    pub(super) fn of_values(range: Option<(f64, f64)>, most: usize) -> Self {
        let (lo, hi) = range.unwrap_or((0.0, 1.0));
        let (lo, hi) = (kept(lo), kept(hi));
        let size = lo.abs().max(hi.abs());
        // A signal that does not move, or by rounding only, is shown in the middle, not as noise of full height.
        let least = if size > 0.0 { size * 1e-9 } else { 1.0 };
        let room = if hi - lo <= least { least.max(size * 0.1) } else { (hi - lo) * 0.06 };
        Self::new(lo - room, hi + room, most)
    }

    /// The axis of time, exactly from `from` to `to` \[s\].
    pub(super) fn of_time(from: f64, to: f64, most: usize) -> Self {
        Self::new(from, if to > from { to } else { from + 1.0 }, most)
    }

    /// As [`of_values`](Self::of_values); numbers above 0 that are far apart stand by their ratios.
    pub(super) fn of_sizes(range: Option<(f64, f64)>, most: usize) -> Self {
        match range {
            Some((lo, hi)) if lo >= 1e-99 && hi <= 1e99 && hi >= RATIO * lo => {
                Self::by_ratio(lo, hi, most, 0.06)
            }
            _ => Self::of_values(range, most),
        }
    }

    /// The axis of frequencies, exactly from the first to the last, by their ratios.
    pub(super) fn of_frequencies((lo, hi): (f64, f64)) -> Self {
        let mut axis = Self::by_ratio(lo, if hi > lo { hi } else { 10.0 * lo }, FEW, 0.0);
        let (start, end) = (axis.lo, axis.hi);
        let parts = (start.floor() as i32..=end.ceil() as i32).flat_map(|e| (2..10).map(move |k| (e, k)));
        let parts = parts.map(|(e, k)| (f64::from(e) + libm::log10(f64::from(k)) - start) / (end - start));
        axis.between = parts.filter(|share| (0.0..=1.0).contains(share)).collect();
        axis
    }

    /// The axis of angles in degrees, ticks at multiples of 45, 90 or 180.
    pub(super) fn degrees((lo, hi): (f64, f64)) -> Self {
        let (start, end) = (lo - 10.0, hi + 10.0);
        let steps = [45_i64, 90, 180];
        let step = steps.into_iter().find(|step| (end - start) / (*step as f64) <= 7.0).unwrap_or(180);
        let range = (start / step as f64).ceil() as i64..=(end / step as f64).floor() as i64;
        let tick = |k: i64| Tick {
            share: ((k * step) as f64 - start) / (end - start),
            label: decimal(k * step, 0),
            minor: false,
        };
        let ticks = range.map(tick).collect();
        Self { lo: start, hi: end, ticks, between: Vec::new(), origin: 0.0, power: 0, ratios: false }
    }

    /// With a share `room` of the range at both ends.
    fn by_ratio(lo: f64, hi: f64, most: usize, room: f64) -> Self {
        let (start, end) = (libm::log10(lo), libm::log10(hi));
        let room = room * (end - start);
        let (start, end) = (start - room, end + room);
        let decades = (end.ceil() - start.floor()) as i32;
        let every = 1.max(decades / most.max(1) as i32 + i32::from(decades % most.max(1) as i32 > 0));
        let tick = |(mantissa, e): (i64, i32)| Tick {
            share: (f64::from(e) + libm::log10(mantissa as f64) - start) / (end - start),
            label: match e {
                -3..5 => decimal(mantissa, e),
                _ if mantissa == 1 => format!("10{}", superscript(e)),
                _ => format!("{mantissa}\u{b7}10{}", superscript(e)),
            },
            minor: false,
        };
        let inside = |tick: &Tick| (-1e-9..=1.0 + 1e-9).contains(&tick.share);
        let exponents = || (start.floor() as i32..=end.ceil() as i32).filter(|e| e % every == 0);
        let mut ticks: Vec<Tick> = exponents().map(|e| tick((1, e))).filter(inside).collect();
        if ticks.len() < 2 {
            // One number alone does not tell the scale.
            ticks = exponents().flat_map(|e| [1, 2, 5].map(|m| tick((m, e)))).filter(inside).collect();
        }
        Self { lo: start, hi: end, ticks, between: Vec::new(), origin: 0.0, power: 0, ratios: true }
    }

    fn new(lo: f64, hi: f64, most: usize) -> Self {
        let (size, span) = (lo.abs().max(hi.abs()), hi - lo);
        let origin = if span < CLOSE * size { rounded(lo + span / 2.0, exponent(span) + 1) } else { 0.0 };
        let (start, end) = (lo - origin, hi - origin);
        // Rounding of the ends must not lose a tick that stands at one.
        let ends = |step: f64| (((start / step) - 1e-9).ceil() as i64, ((end / step) + 1e-9).floor() as i64);
        let sized = |(mantissa, e): (i64, i32)| mantissa as f64 * power_of_ten(e);
        // One number alone does not tell the scale.
        let tells = |most: &usize| {
            let (first, last) = ends(sized(step(end - start, *most)));
            last > first
        };
        let most = (most..most + 4).find(tells).unwrap_or(most + 4);
        let (mantissa, e) = step(end - start, most);
        let step = sized((mantissa, e));
        let (first, last) = ends(step);
        let power = shared_power(start.abs().max(end.abs()));
        let tick = |i: i64| Tick {
            share: ((i as f64 * step - start) / (end - start)).clamp(0.0, 1.0),
            label: decimal(i * mantissa, e - power),
            minor: i % 2 != 0 && (last - first) as usize >= FEW,
        };
        let ticks = (first..=last).map(tick).collect();
        let parts = if mantissa == 2 { 4 } else { 5 };
        let between = ((first - 1) * parts..(last + 1) * parts).filter(|j| j % parts != 0);
        let between = between.map(|j| (j as f64 * step / parts as f64 - start) / (end - start));
        let between = between.filter(|share| (0.0..=1.0).contains(share)).collect();
        Self { lo, hi, ticks, between, origin, power, ratios: false }
    }

    /// The place of a value, 0 at the beginning of the axis and 1 at its end.
    pub(super) fn share(&self, value: f64) -> f64 {
        let value = if self.ratios { libm::log10(value) } else { kept(value) };
        (value - self.lo) / (self.hi - self.lo)
    }

    /// What the axis covers.
    pub(super) fn range(&self) -> RangeInclusive<f64> {
        self.lo..=self.hi
    }

    /// Its unit in brackets with the power of ten of its labels, and the round number they are counted from.
    pub(super) fn unit(&self, unit: &str) -> String {
        let times = if self.power == 0 { String::new() } else { format!("10{}", superscript(self.power)) };
        let mut text = match (&*times, unit) {
            ("", "") => String::new(),
            ("", unit) => format!(" [{unit}]"),
            (times, "") => format!(" [\u{d7}{times}]"),
            (times, unit) => format!(" [{times} {unit}]"),
        };
        if self.origin != 0.0 {
            let sign = if self.origin > 0.0 { "\u{2212}" } else { "+" };
            let size = crate::scenario::show(self.origin.abs());
            text = format!(" {sign} {size}{text}");
        }
        text
    }
}

/// A value within what can be drawn.
fn kept(x: f64) -> f64 {
    if x.abs() < LEAST { 0.0 } else { x.clamp(-MOST, MOST) }
}

/// Mantissa (1, 2 or 5) and exponent of the step that divides `span` into at most `most` parts.
pub(super) fn step(span: f64, most: usize) -> (i64, i32) {
    let least = span / most.max(1) as f64;
    let e = exponent(least);
    let fits = |m: &&(i64, i32)| m.0 as f64 * power_of_ten(m.1) >= least * (1.0 - 1e-9);
    let choices = [(1, e), (2, e), (5, e), (1, e + 1)];
    *choices.iter().find(fits).unwrap_or(&choices[3])
}

/// The exponent of the largest power of ten that is no larger than `x`, a number above 0.
fn exponent(x: f64) -> i32 {
    // What is printed is exact, a logarithm is not.
    format!("{x:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0)
}

fn power_of_ten(e: i32) -> f64 {
    format!("1e{e}").parse().unwrap_or(1.0)
}

/// The multiple of `10^e` next to `x`.
fn rounded(x: f64, e: i32) -> f64 {
    format!("{}e{e}", (x / power_of_ten(e)).round()).parse().unwrap_or(x)
}

/// The power of ten, a multiple of 3, that keeps labels of this size short.
fn shared_power(size: f64) -> i32 {
    match exponent(size) {
        -2..5 => 0,
        e => 3 * e.div_euclid(3),
    }
}

/// `n*10^e` as a decimal number, with a true minus sign.
fn decimal(n: i64, e: i32) -> String {
    let digits = n.unsigned_abs().to_string();
    let text = if n == 0 {
        "0".to_owned()
    } else if e >= 0 {
        digits + &"0".repeat(e as usize)
    } else {
        let places = e.unsigned_abs() as usize;
        let padded = format!("{digits:0>width$}", width = places + 1);
        let (whole, part) = padded.split_at(padded.len() - places);
        format!("{whole}.{part}")
    };
    if n < 0 { format!("\u{2212}{text}") } else { text }
}

fn superscript(e: i32) -> String {
    let digit = |c: char| match c.to_digit(10) {
        Some(1) => '\u{b9}',
        Some(d @ 2..=3) => char::from_u32(0xb0 + d).unwrap_or('?'),
        Some(d) => char::from_u32(0x2070 + d).unwrap_or('?'),
        None => '\u{207b}',
    };
    e.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| &*tick.label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(&Axis::of_time(0.0, 20.0, 6)), ["0", "5", "10", "15", "20"]);
        assert_eq!(labels(&Axis::of_time(0.0, 0.3, 4)), ["0", "0.1", "0.2", "0.3"]);
        let axis = Axis::of_values(Some((-0.3, 1.1)), 5);
        assert_eq!(labels(&axis), ["0", "0.5", "1.0"]);
        let axis = Axis::of_values(Some((-5.0, 5.0)), 6);
        assert_eq!(labels(&axis), ["\u{2212}4", "\u{2212}2", "0", "2", "4"]);
    }

    #[test]
    fn long_numbers_are_shared_with_the_unit() {
        let axis = Axis::of_time(0.0, 4e6, 5);
        assert_eq!((&*labels(&axis).join(" "), &*axis.unit("s")), ("0 1 2 3 4", " [10\u{2076} s]"));
        let axis = Axis::of_values(Some((0.0, 3e-5)), 4);
        assert_eq!(
            (&*labels(&axis).join(" "), &*axis.unit("")),
            ("0 10 20 30", " [\u{d7}10\u{207b}\u{2076}]")
        );
        let axis = Axis::of_values(Some((1000.0, 1000.002)), 4);
        assert_eq!(axis.unit("K"), " \u{2212} 1000 [10\u{207b}\u{b3} K]");
        assert_eq!(labels(&axis), ["0", "1", "2"]);
    }

    #[test]
    fn no_axis_has_a_single_number() {
        for most in 2..9 {
            for k in 1..400 {
                let (lo, hi) = (-0.013 * f64::from(k % 7), 0.37 * f64::from(k));
                let axis = Axis::of_values(Some((lo, hi)), most);
                assert!((2..=most + 5).contains(&axis.ticks.len()), "{lo} {hi} {axis:?}");
                let sizes = Axis::of_sizes(Some((0.03 * f64::from(k), 0.03 * f64::from(k) * 31.0)), most);
                assert!(sizes.ticks.len() >= 2, "{k} {sizes:?}");
                let omega = Axis::of_frequencies((0.02 * f64::from(k), 0.2 * f64::from(k)));
                assert!(omega.ticks.len() >= 2, "{k} {omega:?}");
            }
        }
    }

    #[test]
    fn any_range_has_an_axis() {
        let values = [0.0, 1.0, -1.0, 1e-320, 5e-310, 1e300, f64::MAX, f64::MIN, 1e12, -1e-12, 123_456.789];
        for lo in values {
            for hi in values.into_iter().filter(|hi| *hi >= lo) {
                let axis = Axis::of_values(Some((lo, hi)), 5);
                assert!((2..=7).contains(&axis.ticks.len()), "{lo} {hi} {axis:?}");
                assert!(axis.ticks.iter().all(|t| (0.0..=1.0).contains(&t.share)), "{axis:?}");
                assert!(axis.ticks.iter().all(|t| t.label.chars().count() <= 8), "{axis:?}");
                assert!((0.0..=1.0).contains(&axis.share(lo)) && (0.0..=1.0).contains(&axis.share(hi)));
            }
        }
    }
}
