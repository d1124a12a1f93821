//! A signal of a scenario as it is at any time: pieces of straight lines, and sines on top of them.

use super::noise::Gaussian;
use crate::plant::Wave;
use crate::scenario::{Between, Recording, Signal};
use std::sync::Arc;

/// How near two instants count as one, in samples: decimal numbers must not make steps of length 1e-16.
pub(super) const SAME: f64 = 1e-9;

/// An instant in samples, on the grid when it is as good as on it. Both sides of the comparison carry the rounding of
/// the quotient, which grows with it.
fn snapped(s: f64) -> f64 {
    let near = s.round();
    if (s - near).abs() < SAME + 4.0 * f64::EPSILON * near.abs() { near } else { s }
}

/// A straight line: `value` at the instant `at` (in samples), rising by `slope` per second.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    at: f64,
    value: f64,
    slope: f64,
}

impl Line {
    #[inline]
    fn value(&self, s: f64, ts: f64) -> f64 {
        if self.slope == 0.0 { self.value } else { self.value + self.slope * (s - self.at) * ts }
    }
}

/// Part of a signal: straight from one break to the next. Breaks are in samples.
#[derive(Debug, Clone)]
enum Part {
    /// Known breaks.
    Lines { list: Vec<Line>, current: usize },
    /// The rows of a recording, until the steady level is set anew; it is 0 before and after.
    Rows { recording: Arc<Recording>, start: f64, end: f64, row: Option<usize>, ended: bool, delayed: f64 },
    /// The steps of a random walk, made when they come.
    Walk { start: f64, every: f64, end: f64, std: f64, source: Gaussian, made: u64, level: f64, delayed: f64 },
}

impl Part {
    /// The next break, if there is one.
    fn next(&self, ts: f64) -> f64 {
        match self {
            Self::Lines { list, current } => list.get(current + 1).map_or(f64::INFINITY, |line| line.at),
            Self::Rows { ended: true, .. } => f64::INFINITY,
            Self::Rows { recording, start, end, row, delayed, .. } => {
                let index = row.map_or(0, |row| row + 1);
                let last = snapped((end + delayed) / ts);
                let own = |t: f64| snapped((start + t + delayed) / ts);
                recording.times.get(index).map_or(last, |&t| own(t).min(last))
            }
            Self::Walk { start, every, end, made, delayed, .. } => {
                let t = start + *made as f64 * every;
                if t < *end { snapped((t + delayed) / ts) } else { f64::INFINITY }
            }
        }
    }

    /// Goes over the next break, which is at `at`.
    fn enter(&mut self, at: f64, ts: f64) {
        match self {
            Self::Lines { current, .. } => *current += 1,
            Self::Rows { end, row, ended, delayed, .. } => {
                if at >= snapped((*end + *delayed) / ts) {
                    *ended = true;
                } else {
                    *row = Some(row.map_or(0, |row| row + 1));
                }
            }
            Self::Walk { std, source, made, level, .. } => {
                *level += *std * source.sample();
                *made += 1;
            }
        }
    }

    /// The line that holds from the break at `at` on.
    fn line(&self, at: f64, ts: f64) -> Line {
        let level = |value| Line { at, value, slope: 0.0 };
        match self {
            Self::Lines { list, current } => list[*current],
            Self::Rows { row: None, .. } | Self::Rows { ended: true, .. } => level(0.0),
            Self::Rows { recording, start, row: Some(row), delayed, .. } => {
                let (times, values) = (&recording.times, &recording.values);
                match times.get(row + 1) {
                    Some(next) if recording.between == Between::Line => Line {
                        at: (start + times[*row] + delayed) / ts,
                        value: values[*row],
                        slope: (values[row + 1] - values[*row]) / (next - times[*row]),
                    },
                    _ => level(values[*row]),
                }
            }
            Self::Walk { level: value, .. } => level(*value),
        }
    }
}

/// A sine: between `start` and `end` [s], shifted by the delay.
#[derive(Debug, Clone, Copy)]
struct Sine {
    start: f64,
    end: f64,
    amplitude: f64,
    omega: f64,
    phase: f64,
}

/// Signals added up, with a cursor that only moves forward.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    parts: Vec<Part>,
    sines: Vec<Sine>,
    ts: f64,
    delay: f64,
    now: Line,
    next: f64,
    /// As `next` on a level piece without sines; else before everything.
    level_until: f64,
    /// Sines that are on, one for each of `sines`.
    on: Vec<bool>,
}

impl Curve {
    /// The curve that is `level` before the first of `list`; every instant is shifted by `delay` \[s\].
    pub(super) fn new(level: f64, list: &[(f64, Signal)], delay: f64, ts: f64) -> Self {
        let mut parts = vec![levels(level, list, delay, ts), added(list, delay, ts)];
        let mut sines = Vec::new();
        let sets_level = |signal: &Signal| matches!(signal, Signal::Step(_) | Signal::Recorded(_));
        for (index, (at, signal)) in list.iter().enumerate() {
            match signal {
                Signal::Recorded(recording) => {
                    let later = list[index + 1..].iter().find(|(_, signal)| sets_level(signal));
                    let end = later.map_or(f64::INFINITY, |(at, _)| *at);
                    let recording = Arc::clone(recording);
                    parts.push(Part::Rows {
                        recording,
                        start: *at,
                        end,
                        row: None,
                        ended: false,
                        delayed: delay,
                    });
                }
                &Signal::Walk { std, every, seed, duration } => parts.push(Part::Walk {
                    start: *at,
                    every,
                    end: at + duration,
                    std,
                    source: Gaussian::new(seed),
                    made: 0,
                    level: 0.0,
                    delayed: delay,
                }),
                &Signal::Sine { amplitude, period, phase, duration } => sines.push(Sine {
                    start: *at,
                    end: at + duration,
                    amplitude,
                    omega: 2.0 * std::f64::consts::PI / period,
                    phase,
                }),
                Signal::Step(_) | Signal::Ramp { .. } | Signal::Pulse { .. } => {}
            }
        }
        let start = Line { at: f64::NEG_INFINITY, value: level, slope: 0.0 };
        let on = vec![false; sines.len()];
        let mut this = Self {
            parts,
            sines,
            ts,
            delay,
            now: start,
            next: f64::INFINITY,
            level_until: f64::NEG_INFINITY,
            on,
        };
        this.find_next(f64::NEG_INFINITY);
        this
    }

    /// Angular frequencies of the sines \[rad/s\].
    pub(super) fn frequencies(&self) -> Vec<f64> {
        self.sines.iter().map(|sine| sine.omega).collect()
    }

    /// Where the next piece begins, in samples; infinite after the last.
    #[inline]
    pub(super) fn next(&self) -> f64 {
        self.next
    }

    /// Goes to the next piece.
    pub(super) fn enter_next(&mut self) {
        let (at, ts) = (self.next, self.ts);
        for part in &mut self.parts {
            while part.next(ts) <= at {
                part.enter(at, ts);
            }
        }
        let mut sum = Line { at, value: 0.0, slope: 0.0 };
        for part in &self.parts {
            let line = part.line(at, ts);
            sum.value += line.value(at, ts);
            sum.slope += line.slope;
        }
        self.now = sum;
        self.find_next(at);
    }

    fn find_next(&mut self, at: f64) {
        let (ts, delay) = (self.ts, self.delay);
        let mut next = self.parts.iter().map(|part| part.next(ts)).fold(f64::INFINITY, f64::min);
        for (sine, on) in self.sines.iter().zip(&mut self.on) {
            let [start, end] = [sine.start, sine.end].map(|t| snapped((t + delay) / ts));
            *on = at >= start && at < end;
            for bound in [start, end] {
                if bound > at && bound < next {
                    next = bound;
                }
            }
        }
        self.next = next;
        let level = self.now.slope == 0.0 && self.sines.is_empty();
        self.level_until = if level { next } else { f64::NEG_INFINITY };
    }

    /// Value \[u\] and slope \[u/s\] of the present straight piece at the instant `s`, in samples, without the sines.
    #[inline]
    pub(super) fn line(&self, s: f64) -> (f64, f64) {
        (self.now.value(s, self.ts), self.now.slope)
    }

    /// The sines at the instant `s`, in samples: one wave for each frequency.
    pub(super) fn waves(&self, s: f64, waves: &mut [Wave]) {
        let t = s * self.ts - self.delay;
        for ((sine, on), wave) in self.sines.iter().zip(&self.on).zip(waves) {
            *wave = if *on {
                let angle = sine.omega * (t - sine.start) + sine.phase;
                Wave { sin: sine.amplitude * libm::sin(angle), cos: sine.amplitude * libm::cos(angle) }
            } else {
                Wave::default()
            };
        }
    }

    /// `value` and the sines that are on at the instant `s`, in samples.
    pub(super) fn with_sines(&self, s: f64, mut value: f64) -> f64 {
        let t = s * self.ts - self.delay;
        for (sine, _) in self.sines.iter().zip(&self.on).filter(|(_, on)| **on) {
            value += sine.amplitude * libm::sin(sine.omega * (t - sine.start) + sine.phase);
        }
        value
    }

    /// Whether there is any sine.
    pub(super) fn has_sines(&self) -> bool {
        !self.sines.is_empty()
    }

    /// Value at the instant `s`, in samples, sines included, going forward to the piece that holds then.
    #[inline]
    pub(super) fn advance_to(&mut self, s: f64) -> f64 {
        if self.level_until > s + SAME { self.now.value } else { self.go_to(s) }
    }

    #[inline(never)]
    fn go_to(&mut self, s: f64) -> f64 {
        while self.next <= s + SAME {
            self.enter_next();
        }
        let value = self.now.value(s, self.ts);
        if self.has_sines() { self.with_sines(s, value) } else { value }
    }
}

/// The steady level of steps, each exactly as it is written. While a recording has the level it is 0 here.
fn levels(level: f64, list: &[(f64, Signal)], delay: f64, ts: f64) -> Part {
    let mut lines = vec![Line { at: f64::NEG_INFINITY, value: level, slope: 0.0 }];
    for (at, signal) in list {
        let value = match signal {
            Signal::Step(value) => *value,
            Signal::Recorded(_) => 0.0,
            _ => continue,
        };
        push(&mut lines, Line { at: snapped((at + delay) / ts), value, slope: 0.0 });
    }
    Part::Lines { list: lines, current: 0 }
}

/// Ramps and pulses added up: changes of level and slope at instants.
fn added(list: &[(f64, Signal)], delay: f64, ts: f64) -> Part {
    let mut changes: Vec<(f64, f64, f64)> = Vec::new();
    for &(at, ref signal) in list {
        match *signal {
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
            Signal::Step(_) | Signal::Recorded(_) | Signal::Sine { .. } | Signal::Walk { .. } => {}
        }
    }
    changes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut lines = vec![Line { at: f64::NEG_INFINITY, value: 0.0, slope: 0.0 }];
    for (at, rise, bend) in changes {
        let at = snapped((at + delay) / ts);
        let last = lines[lines.len() - 1];
        push(&mut lines, Line { at, value: last.value(at, ts) + rise, slope: last.slope + bend });
    }
    Part::Lines { list: lines, current: 0 }
}

/// Of two lines from the same instant the later one holds.
fn push(lines: &mut Vec<Line>, line: Line) {
    if lines.last().is_some_and(|last| last.at == line.at) {
        lines.pop();
    }
    lines.push(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(list: &[(f64, Signal)], ts: f64, n: u64) -> Vec<f64> {
        let mut curve = Curve::new(0.5, list, 0.0, ts);
        (0..n).map(|k| curve.advance_to(k as f64)).collect()
    }

    fn recording(between: Between) -> Signal {
        let (times, values) = (vec![0.0, 1.0, 3.0], vec![1.0, 2.0, 4.0]);
        Signal::Recorded(Arc::new(Recording { name: "x".to_owned(), times, values, between }))
    }

    #[test]
    fn a_recording_is_the_level_until_the_next_step() {
        let list = |between| [(1.0, recording(between)), (4.5, Signal::Step(7.0))];
        let held = values(&list(Between::Hold), 0.5, 11);
        assert_eq!(held, [0.5, 0.5, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 4.0, 7.0, 7.0]);
        let line = values(&list(Between::Line), 0.5, 11);
        assert_eq!(line, [0.5, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 7.0, 7.0]);
    }

    #[test]
    fn everything_else_adds_to_the_level() {
        let list = [
            (0.0, Signal::Step(1.0)),
            (1.0, Signal::Ramp { slope: 2.0, duration: 1.0 }),
            (2.0, Signal::Pulse { height: -1.0, duration: 1.0 }),
            (2.0, recording(Between::Hold)),
            (4.0, Signal::Step(0.0)),
        ];
        // The ramp leaves 2 behind; the recording takes the level of 1 over.
        assert_eq!(values(&list, 0.5, 10), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 4.0, 4.0, 2.0, 2.0]);
    }

    #[test]
    fn a_step_has_exactly_the_value_that_is_written() {
        let steps = [0.1, 1e12, 0.1, 0.0].into_iter().zip(0..).map(|(x, k)| (f64::from(k), Signal::Step(x)));
        assert_eq!(values(&steps.collect::<Vec<_>>(), 1.0, 4), [0.1, 1e12, 0.1, 0.0]);
    }

    #[test]
    fn instants_of_long_runs_keep_their_place() {
        assert_eq!([snapped(1e8 + 0.05), snapped(1e8 + 1e-8), snapped(0.3 / 0.1)], [1e8 + 0.05, 1e8, 3.0]);
    }

    #[test]
    fn a_sine_begins_and_ends() {
        let sine = Signal::Sine { amplitude: 2.0, period: 4.0, phase: 0.0, duration: 4.0 };
        for (value, exact) in
            values(&[(1.0, sine)], 1.0, 7).into_iter().zip([0.5, 0.5, 2.5, 0.5, -1.5, 0.5, 0.5])
        {
            assert!((value - exact).abs() < 1e-12, "{value} {exact}");
        }
    }

    /// The walk of the delayed curve is that of the other one, later: the plant and the record see the same steps.
    #[test]
    fn a_walk_is_the_same_behind_a_delay() {
        let walk = Signal::Walk { std: 1.0, every: 0.25, seed: 5, duration: 10.0 };
        let list = [(0.5, walk)];
        let mut now = Curve::new(0.0, &list, 0.0, 0.5);
        let mut later = Curve::new(0.0, &list, 1.5, 0.5);
        let now: Vec<f64> = (0..40).map(|k| now.advance_to(f64::from(k))).collect();
        let later: Vec<f64> = (0..40).map(|k| later.advance_to(f64::from(k))).collect();
        assert_eq!(now[..37], later[3..]);
        assert_eq!(now[0], 0.0);
        assert!(now[1] != 0.0 && now[1] != now[2]);
        // Steps at 0.5, 0.75 .. 10.25: none after the duration.
        assert!(now[21..].iter().all(|x| *x == now[21]) && now[20] != now[21]);
    }
}
