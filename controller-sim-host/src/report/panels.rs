//! What is drawn of a run: which signals share a panel, and the limits beside them.

use super::path::Between;
use super::words;
use crate::scenario::{Change, CompensatorSpec, ControllerSpec, Scenario, Sensor};
use crate::simulate::{Envelope, Record, sample_of};

/// A controller with what was recorded of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Loop<'a> {
    /// Its place in the order of controllers: colour and pattern of its lines.
    pub(super) index: usize,
    /// What it is at the start.
    pub(super) spec: &'a ControllerSpec,
    /// Its signals.
    pub(super) record: &'a Record,
    /// Those of the loop inside of a cascade.
    pub(super) inner: Option<&'a Record>,
}

impl Loop<'_> {
    /// Who gives the output: in a cascade the controller of the inner loop.
    fn acting(&self) -> &ControllerSpec {
        self.spec.secondary.as_deref().unwrap_or(self.spec)
    }

    fn has_compensator(&self) -> bool {
        self.acting().compensator != CompensatorSpec::None
    }
}

/// How a line looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// Thin and dark: what is asked for, what disturbs.
    Reference,
    /// Thin, in the colour of a controller: what it asks of its inner loop.
    Asked(usize),
    /// The line of a controller.
    Controller(usize),
    /// Faint, in the colour of a controller: its measurement with all that a sensor does.
    Faint(usize),
    /// Dotted, in the colour of a controller: what the actuator applies.
    Applied(usize),
}

/// A signal in a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trace<'a> {
    pub(super) envelope: &'a Envelope,
    pub(super) between: Between,
    pub(super) look: Look,
    /// What is taken off the signal before it is drawn.
    pub(super) origin: f64,
}

impl Trace<'_> {
    /// The smallest and the largest value that is drawn.
    fn range(&self) -> Option<(f64, f64)> {
        self.envelope.range().map(|(lo, hi)| (lo - self.origin, hi - self.origin))
    }
}

/// A limit while it holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Level {
    /// From when to when \[s\].
    pub(super) time: (f64, f64),
    pub(super) value: f64,
    /// Whose it is; `None`: of all, or of the actuator.
    pub(super) owner: Option<usize>,
    pub(super) label: &'static str,
}

/// Signals over one value axis.
#[derive(Debug, Clone)]
pub(super) struct Panel<'a> {
    pub(super) title: &'static str,
    pub(super) unit: String,
    pub(super) height: f64,
    pub(super) traces: Vec<Trace<'a>>,
    pub(super) levels: Vec<Level>,
    /// What is smaller than this is rounding: it is not spread over the whole height.
    pub(super) least: f64,
}

impl Panel<'_> {
    /// The smallest and the largest value that is drawn.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let join = |a: Option<(f64, f64)>, (lo, hi): (f64, f64)| {
            Some(a.map_or((lo, hi), |(l, h)| (l.min(lo), h.max(hi))))
        };
        let signals = self.traces.iter().filter_map(Trace::range).fold(None, join);
        let (lo, hi) = self.levels.iter().map(|level| (level.value, level.value)).fold(signals, join)?;
        // What stands still far from 0 has an axis of its own size.
        let is_near = lo.abs().max(hi.abs()) <= 1e3 * self.least;
        let missing = if is_near { (self.least - (hi - lo)).max(0.0) } else { 0.0 };
        Some((lo - missing / 2.0, hi + missing / 2.0))
    }
}

/// The panels of a run, from above.
pub(super) fn panels<'a>(scenario: &'a Scenario, loops: &[Loop<'a>]) -> Vec<Panel<'a>> {
    let [y, u] = [&scenario.units.y, &scenario.units.u].map(|unit| words::unit(unit));
    let mut list = vec![output(scenario, loops, y)];
    list.extend(inner(loops));
    list.push(control(scenario, loops, u.clone()));
    // A disturbance is a small difference of large outputs.
    let outputs = loops.iter().filter_map(|l| l.record.u.range());
    let least = 1e-9 * outputs.fold(0.0_f64, |size, (lo, hi)| size.max(lo.abs()).max(hi.abs()));
    let compensated: Vec<Loop<'_>> = loops.iter().copied().filter(Loop::has_compensator).collect();
    let disturbed = scenario.initial.disturbance != 0.0
        || scenario.events.iter().flat_map(|e| &e.changes).any(|c| matches!(c, Change::Disturbance(_)));
    if disturbed || !compensated.is_empty() {
        let mut traces: Vec<Trace<'a>> = compensated
            .iter()
            .map(|l| Trace {
                envelope: &l.record.d_hat,
                between: Between::Held,
                look: Look::Controller(l.index),
                origin: 0.0,
            })
            .collect();
        // Above the estimates, whose noise would cover it.
        let origin = estimate_from(scenario, loops);
        traces.extend(
            references(loops, |record| &record.d)
                .into_iter()
                .map(|trace| Trace { origin: origin.unwrap_or(0.0), ..trace }),
        );
        let title = match (compensated.is_empty(), origin) {
            (true, _) => "Disturbance d",
            (false, None) => "Disturbance d, estimate d_hat",
            (false, Some(_)) => "Disturbance d \u{2212} d(0), estimate d_hat",
        };
        list.push(Panel { title, unit: u.clone(), height: 120.0, traces, levels: Vec::new(), least });
    }
    if !compensated.is_empty() {
        let trace = |l: &Loop<'a>| Trace {
            envelope: &l.record.u_f,
            between: Between::Held,
            look: Look::Controller(l.index),
            origin: 0.0,
        };
        let traces = compensated.iter().map(trace).collect();
        let title = "Output of the disturbance block u_f";
        list.push(Panel { title, unit: u, height: 100.0, traces, levels: Vec::new(), least });
    }
    list
}

/// The disturbance of the operating point, when there are estimates: they begin at 0 wherever the loop rests, and the
/// disturbance is drawn from there, too.
pub(super) fn estimate_from(scenario: &Scenario, loops: &[Loop<'_>]) -> Option<f64> {
    let at_rest = scenario.initial.disturbance;
    (at_rest != 0.0 && loops.iter().any(Loop::has_compensator)).then_some(at_rest)
}

/// Whether the measurement is something else than the plant's output.
pub(super) fn shows_measurement(scenario: &Scenario) -> bool {
    scenario.noise.is_some_and(|noise| noise.std > 0.0)
        || scenario.sensor != Sensor::default()
        || scenario.events.iter().flat_map(|e| &e.changes).any(|c| matches!(c, Change::Measurement(Some(_))))
}

/// Whether the actuator applies something else than the controller gives.
pub(super) fn shows_applied(l: &Loop<'_>) -> bool {
    l.record.applied != l.record.u
}

fn output<'a>(scenario: &'a Scenario, loops: &[Loop<'a>], unit: String) -> Panel<'a> {
    let mut traces = Vec::new();
    if shows_measurement(scenario) {
        traces.extend(loops.iter().map(|l| Trace {
            envelope: &l.record.y,
            between: Between::Held,
            look: Look::Faint(l.index),
            origin: 0.0,
        }));
    }
    traces.extend(references(loops, |record| &record.r));
    traces.extend(loops.iter().map(|l| Trace {
        envelope: &l.record.output,
        between: Between::Moves,
        look: Look::Controller(l.index),
        origin: 0.0,
    }));
    Panel {
        title: "Plant output y, set-point r",
        unit,
        height: 230.0,
        traces,
        levels: Vec::new(),
        least: 0.0,
    }
}

/// What a cascade does between its two controllers.
fn inner<'a>(loops: &[Loop<'a>]) -> Option<Panel<'a>> {
    let mut traces = Vec::new();
    for (l, record) in loops.iter().filter_map(|l| l.inner.map(|record| (l, record))) {
        let trace = |envelope, between, look| Trace { envelope, between, look, origin: 0.0 };
        traces.push(trace(&record.r, Between::Held, Look::Asked(l.index)));
        traces.push(trace(&record.output, Between::Moves, Look::Controller(l.index)));
    }
    let title = "Inner loop: output, set-point (thin)";
    (!traces.is_empty()).then(|| Panel {
        title,
        unit: String::new(),
        height: 140.0,
        traces,
        levels: Vec::new(),
        least: 0.0,
    })
}

fn control<'a>(scenario: &'a Scenario, loops: &[Loop<'a>], unit: String) -> Panel<'a> {
    let mut traces: Vec<Trace<'a>> = Vec::new();
    for l in loops {
        let held = |envelope, look| Trace { envelope, between: Between::Held, look, origin: 0.0 };
        if shows_applied(l) {
            traces.push(held(&l.record.applied, Look::Applied(l.index)));
        }
        traces.push(held(&l.record.u, Look::Controller(l.index)));
    }
    let mut panel =
        Panel { title: "Controller output u", unit, height: 160.0, traces, levels: Vec::new(), least: 0.0 };
    if let Some((lo, hi)) = panel.range() {
        // A limit far away would press the signals flat.
        let room = 0.25 * (hi - lo).max(1e-9 * lo.abs().max(hi.abs()));
        let near = |value: f64| (lo - room..=hi + room).contains(&value);
        panel.levels = limits(scenario, loops).into_iter().filter(|level| near(level.value)).collect();
    }
    panel
}

/// A signal that does not depend on the controllers, once; as often as it differs otherwise.
fn references<'a>(loops: &[Loop<'a>], signal: impl Fn(&'a Record) -> &'a Envelope) -> Vec<Trace<'a>> {
    let mut different: Vec<&'a Envelope> = Vec::new();
    for envelope in loops.iter().map(|l| signal(l.record)) {
        if !different.contains(&envelope) {
            different.push(envelope);
        }
    }
    let trace = |envelope| Trace { envelope, between: Between::Held, look: Look::Reference, origin: 0.0 };
    different.into_iter().map(trace).collect()
}

/// The limits of every controller, those of all as one, and of the actuator.
fn limits(scenario: &Scenario, loops: &[Loop<'_>]) -> Vec<Level> {
    let mut list: Vec<Level> = Vec::new();
    for l in loops {
        for level in own_limits(scenario, l) {
            list.push(Level { owner: Some(l.index), ..level });
        }
    }
    let mut levels: Vec<Level> = Vec::new();
    for level in &list {
        let same = list.iter().filter(|o| (o.time, o.value) == (level.time, level.value)).count();
        let owner = if same == loops.len() { None } else { level.owner };
        let shown = Level { owner, ..level.clone() };
        if !levels.contains(&shown) {
            levels.push(shown);
        }
    }
    let ends = (0.0, scenario.duration);
    let actuator = [scenario.actuator.lo, scenario.actuator.hi];
    levels.extend(actuator.into_iter().filter(|value| value.is_finite()).map(|value| Level {
        time: ends,
        value,
        owner: None,
        label: "actuator limit",
    }));
    levels
}

fn own_limits(scenario: &Scenario, l: &Loop<'_>) -> Vec<Level> {
    let mut list: Vec<Level> = Vec::new();
    let mut begin = |at: f64, spec: &ControllerSpec| {
        let limits = &spec.config.limits;
        for (value, label) in [(limits.lo, "lower limit"), (limits.hi, "upper limit")] {
            if let Some(last) = list.iter_mut().rev().find(|level| level.label == label) {
                if last.value == value {
                    continue;
                }
                last.time.1 = at;
            }
            list.push(Level { time: (at, scenario.duration), value, owner: None, label });
        }
    };
    begin(0.0, l.acting());
    for event in &scenario.events {
        for change in &event.changes {
            if let Change::Parameters(specs) = change
                && let Some((_, spec)) = specs.iter().find(|(index, _)| *index == l.index)
            {
                let acting = spec.secondary.as_deref().unwrap_or(spec);
                begin(sample_of(event.at, scenario.ts) as f64 * scenario.ts, acting);
            }
        }
    }
    list
}
