//! A run divided at its events.

use super::metrics::Metrics;
use crate::scenario::{Change, Scenario};

/// What began a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The run itself, when no event is at `t = 0`.
    Start,
    /// A set-point change.
    Setpoint,
    /// A disturbance.
    Disturbance,
    /// Anything else, or more than one kind at once.
    Other,
}

/// The time from one event to the next. All controllers of a run have the same stretches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// When it began \[s\].
    pub at: f64,
    /// What began it.
    pub kind: EventKind,
    /// Its indices.
    pub metrics: Metrics,
}

/// The first sample at or after the time `at`.
#[must_use]
pub fn sample_of(at: f64, ts: f64) -> u64 {
    let s = at / ts;
    let near = s.round();
    (if (s - near).abs() < 1e-9 + 4.0 * f64::EPSILON * near.abs() { near } else { s.ceil() }) as u64
}

/// When the stretches of a scenario begin \[s\], and what begins them.
#[must_use]
pub fn windows(scenario: &Scenario) -> Vec<(f64, EventKind)> {
    let (list, _) = Stretches::new(scenario).finish();
    list.into_iter().map(|stretch| (stretch.at, stretch.kind)).collect()
}

/// Collects the indices of each stretch of one controller.
#[derive(Debug)]
pub(super) struct Stretches {
    /// When each takes effect \[s\]: a disturbance at its time, everything else with the next sample.
    list: Vec<(f64, Stretch)>,
    current: usize,
    /// The current one; its place in the list gets it when it ends.
    now: Stretch,
    /// When the next one takes effect \[s\]; infinite in the last.
    next: f64,
}

impl Stretches {
    /// The stretches of `scenario`, cut at the events of all its controllers, so that a table compares equal windows.
    pub(super) fn new(scenario: &Scenario) -> Self {
        let mut list: Vec<(f64, Stretch)> = Vec::new();
        let begin = |at: f64, kind| Stretch { at, kind, metrics: Metrics::default() };
        for event in &scenario.events {
            let next_sample = sample_of(event.at, scenario.ts) as f64 * scenario.ts;
            for change in &event.changes {
                let (kind, start) = match change {
                    Change::Setpoint(_) | Change::RemoteSetpoint(_) => (EventKind::Setpoint, next_sample),
                    Change::Disturbance(_) => (EventKind::Disturbance, event.at),
                    _ => (EventKind::Other, next_sample),
                };
                match list.last_mut() {
                    Some((begun, last)) if last.at == event.at => {
                        *begun = begun.min(start);
                        if last.kind != kind {
                            last.kind = EventKind::Other;
                        }
                    }
                    _ => list.push((start, begin(event.at, kind))),
                }
            }
        }
        if list.first().is_none_or(|(start, _)| *start > 0.0) {
            list.insert(0, (0.0, begin(0.0, EventKind::Start)));
        }
        // What waits for the next sample may begin after a disturbance that is written later: windows follow the text.
        for index in (1..list.len()).rev() {
            list[index - 1].0 = list[index - 1].0.min(list[index].0);
        }
        let next = list.get(1).map_or(f64::INFINITY, |(start, _)| *start);
        let now = list[0].1;
        Self { list, current: 0, now, next }
    }

    /// Goes to the stretch that holds at the time `t`.
    #[inline]
    fn enter(&mut self, t: f64) {
        while self.next <= t {
            self.go_on();
        }
    }

    #[cold]
    #[inline(never)]
    fn go_on(&mut self) {
        self.list[self.current].1 = self.now;
        self.current += 1;
        self.now = self.list[self.current].1;
        self.next = self.list.get(self.current + 1).map_or(f64::INFINITY, |(start, _)| *start);
    }

    /// A sample at the time `t`: error, output before and after.
    #[inline]
    pub(super) fn sample(&mut self, t: f64, ts: f64, e: f64, u_before: f64, u: f64) {
        // Sums of periods are not exact; an event on the grid belongs to its sample.
        self.enter(t + 1e-9 * ts);
        self.now.metrics.add_sample(ts, e, u_before, u);
    }

    /// The error between two samples, divided where a stretch begins inside.
    #[inline]
    pub(super) fn step(&mut self, from: (f64, f64), to: (f64, f64)) {
        if self.next < to.0 { self.step_divided(from, to) } else { self.add(from, to) }
    }

    #[cold]
    #[inline(never)]
    fn step_divided(&mut self, (mut t0, mut e0): (f64, f64), (t1, e1): (f64, f64)) {
        while self.next < t1 {
            let start = self.next;
            if start > t0 {
                let e = e0 + (e1 - e0) * ((start - t0) / (t1 - t0));
                self.add((t0, e0), (start, e));
                (t0, e0) = (start, e);
            }
            self.go_on();
        }
        self.add((t0, e0), (t1, e1));
    }

    #[inline]
    fn add(&mut self, (t0, e0): (f64, f64), (t1, e1): (f64, f64)) {
        let at = self.now.at;
        self.now.metrics.add_step((t0 - at, e0), (t1 - at, e1));
    }

    /// The stretches and the indices of the whole run.
    pub(super) fn finish(mut self) -> (Vec<Stretch>, Metrics) {
        self.list[self.current].1 = self.now;
        let list: Vec<Stretch> = self.list.into_iter().map(|(_, stretch)| stretch).collect();
        let total = list.iter().fold(Metrics::default(), |sum, s| sum.plus(&s.metrics));
        (list, total)
    }
}
