//! From the load or the set-point to the end of the response, element by element.

use std::vec;
use std::vec::Vec;

use core::ops::ControlFlow;

use super::Drive;
use super::map::Map;
use super::measure::Element;
use super::mesh::{length, mesh};
use super::nodes::{NODES, Values, misfit, size, tail};
use super::realisation::Realisation;
use crate::Refusal;

/// Elements after which a response counts as one that does not end.
const MAX_STEPS: usize = 60_000;
/// Doublings after which nothing is left that rounding errors do not hide.
const MAX_DOUBLINGS: usize = 150;
/// Largest plant input, in unit loads, of a loop that is not yet called unstable.
const MAX_INPUT: f64 = 1e12;

/// The loop, ready to be marched through.
#[derive(Debug, Clone)]
pub(super) struct March {
    pub(super) realisation: Realisation,
    accuracy: f64,
    plan: Plan,
}

/// The elements of the first phase.
#[derive(Debug, Clone)]
struct Plan {
    /// Levels of the elements of one dead time; none without dead time.
    mesh: Vec<u32>,
    /// Map of each level, from the longest.
    maps: Vec<Map>,
    /// The map from which steps are doubled, and its step.
    closed: Map,
    step: f64,
}

/// What one march came to.
pub(super) enum Outcome {
    /// The visitor has what it wants.
    Stopped,
    /// Elements were too long for what happens in them.
    Unresolved,
    Unstable,
    Endless,
}

fn too_stiff() -> Refusal {
    Refusal::NoSolution {
        why: "the time constants of the loop are too far apart from its dead time to be resolved",
        help: "drop what is far faster than the dead time from the plant",
    }
}

impl Plan {
    fn new(r: &Realisation, reach: f64) -> Result<Self, Refusal> {
        let mut norm = r.a.norm();
        if r.delay == 0.0 {
            norm +=
                r.b.iter().map(|b| b.abs()).fold(0.0, f64::max) * r.k.iter().map(|k| k.abs()).sum::<f64>();
        }
        if !norm.is_finite() {
            return Err(too_stiff());
        }
        let mut doublings = 0;
        while length(doublings) * norm > 0.5 && doublings < 1000 {
            doublings += 1;
        }
        let mut step = length(doublings);
        let mut map = Map::short(r, step);
        if r.delay == 0.0 {
            return if map.is_finite() {
                Ok(Self { mesh: Vec::new(), maps: Vec::new(), closed: map, step })
            } else {
                Err(too_stiff())
            };
        }
        let mesh = mesh(&r.modes, reach).ok_or_else(too_stiff)?;
        let finest = mesh.iter().copied().max().unwrap_or(0);
        if doublings < finest {
            (doublings, step) = (finest, length(finest));
            map = Map::short(r, step);
        }
        let mut maps = Vec::new();
        for level in (0..=doublings).rev() {
            if level <= finest {
                maps.push(map.clone());
            }
            if level > 0 {
                map = map.doubled();
                step *= 2.0;
            }
        }
        maps.reverse();
        let closed = map.closed();
        if maps.iter().all(|m| m.is_finite()) {
            Ok(Self { mesh, maps, closed, step })
        } else {
            Err(too_stiff())
        }
    }
}

impl March {
    pub(super) fn new(realisation: Realisation, accuracy: f64) -> Result<Self, Refusal> {
        // The error of an element goes with the ninth power of its length.
        let reach = (2.0 * libm::pow(accuracy / 1e-6, 1.0 / 9.0)).clamp(0.5, 4.0);
        let mut march = Self { plan: Plan::new(&realisation, reach)?, realisation, accuracy };
        for refinement in 1..5 {
            if march.resolves() {
                break;
            }
            march.plan = Plan::new(&march.realisation, reach * libm::ldexp(1.0, -refinement))?;
        }
        Ok(march)
    }

    /// Whether the elements are short enough in the first few dead times, where most happens.
    fn resolves(&self) -> bool {
        let mut trial = |e: &Element<'_>| {
            if e.start < 6.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        !matches!(self.run(Drive::Step, true, &mut trial).0, Outcome::Unresolved)
    }

    /// Shows every element to the visitor until it breaks off. Gives the states at the end as well.
    pub(super) fn run(
        &self,
        drive: Drive,
        check: bool,
        visit: &mut dyn FnMut(&Element<'_>) -> ControlFlow<()>,
    ) -> (Outcome, Vec<f64>) {
        let mut z = self.realisation.start(drive);
        let scale = 1.0 + self.realisation.end(drive).unwrap_or(0.0).abs();
        let mut walk = Walk { steps: 0, time: 0.0, limit: MAX_INPUT * scale };
        if self.plan.mesh.is_empty() {
            let outcome = self.double(&mut z, walk, visit);
            return (outcome, z);
        }
        let mut history = if drive == Drive::Setpoint {
            // The controller acts from the first moment on, with the plant still at rest.
            let before = [self.realisation.before_setpoint(); NODES];
            vec![(before, [0.0; NODES]); self.plan.mesh.len()]
        } else {
            walk.time = 1.0;
            match self.dead_time(drive, visit) {
                Ok(history) => history,
                Err(outcome) => return (outcome, z),
            }
        };
        if let Some(outcome) = self.elements(&mut z, &mut history, &mut walk, check, visit) {
            return (outcome, z);
        }
        let n = z.len();
        z.extend(self.coarse(&history.iter().map(|h| h.0).collect::<Vec<_>>()));
        let outcome = self.double(&mut z, walk, visit);
        z.truncate(n);
        (outcome, z)
    }

    /// Nothing reaches the output yet.
    fn dead_time(
        &self,
        drive: Drive,
        visit: &mut dyn FnMut(&Element<'_>) -> ControlFlow<()>,
    ) -> Result<Vec<(Values, Values)>, Outcome> {
        let mut history = Vec::with_capacity(self.plan.mesh.len());
        let mut start = 0.0;
        for &level in &self.plan.mesh {
            let length = length(level);
            let v = core::array::from_fn(|i| match drive {
                Drive::Ramp => start + length * i as f64 / 8.0,
                _ => 1.0,
            });
            let y = [0.0; NODES];
            if visit(&Element { start, length, v: &v, y: &y }).is_break() {
                return Err(Outcome::Stopped);
            }
            history.push((v, y));
            start += length;
        }
        Ok(history)
    }

    /// The first phase: dead time by dead time over the mesh, until one element is enough for all of it.
    fn elements(
        &self,
        z: &mut [f64],
        history: &mut [(Values, Values)],
        walk: &mut Walk,
        check: bool,
        visit: &mut dyn FnMut(&Element<'_>) -> ControlFlow<()>,
    ) -> Option<Outcome> {
        let n = z.len();
        let (mut input, mut output) = (vec![0.0; n + NODES], vec![0.0; n + 2 * NODES]);
        let mut v_max: f64 = 1.0;
        for count in 0_usize.. {
            let begin = walk.time;
            let mut offset = 0.0;
            for (&level, (v, y)) in self.plan.mesh.iter().zip(&mut *history) {
                let length = length(level);
                input[..n].copy_from_slice(z);
                input[n..].copy_from_slice(v);
                self.plan.maps[level as usize].apply(&input, &mut output);
                z.copy_from_slice(&output[..n]);
                v.copy_from_slice(&output[n..n + NODES]);
                y.copy_from_slice(&output[n + NODES..]);
                if let Some(outcome) = walk.beyond(v) {
                    return Some(outcome);
                }
                v_max = v_max.max(size(v));
                if check && tail(v) > 0.3 * self.accuracy * v_max {
                    return Some(Outcome::Unresolved);
                }
                if visit(&Element { start: begin + offset, length, v, y }).is_break() {
                    return Some(Outcome::Stopped);
                }
                offset += length;
            }
            walk.time = begin + 1.0;
            if count > 2 && (self.plan.mesh.len() == 1 || (count % 4 == 0 && self.is_smooth(history))) {
                break;
            }
        }
        None
    }

    /// v over the last dead time at the nodes of one element.
    fn coarse(&self, elements: &[Values]) -> Values {
        core::array::from_fn(|i| {
            let at = i as f64 / 8.0;
            let mut start = 0.0;
            for (&level, values) in self.plan.mesh.iter().zip(elements) {
                let end = start + length(level);
                if at <= end {
                    return super::measure::interpolated(values, (at - start) / length(level));
                }
                start = end;
            }
            elements.last().map_or(0.0, |v| v[8])
        })
    }

    /// Whether one element would do for the last dead time.
    fn is_smooth(&self, history: &[(Values, Values)]) -> bool {
        [0, 1].into_iter().all(|signal| {
            let of = |h: &(Values, Values)| if signal == 0 { h.0 } else { h.1 };
            let elements: Vec<Values> = history.iter().map(of).collect();
            let whole = super::nodes::nodes().polynomial(&self.coarse(&elements));
            let allowed = self.allowed(elements.iter().map(size).fold(0.0, f64::max));
            let mut start = 0.0;
            self.plan.mesh.iter().zip(&elements).all(|(&level, values)| {
                let fits = values.iter().enumerate().all(|(i, value)| {
                    let x = start + length(level) * i as f64 / 8.0;
                    (whole.at(2.0 * x - 1.0) - value).abs() <= allowed
                });
                start += length(level);
                fits
            })
        })
    }

    fn allowed(&self, size: f64) -> f64 {
        0.01 * self.accuracy * size
    }

    /// The second phase: steps of one map, squared whenever two steps in a row are as well one.
    fn double(
        &self,
        state: &mut [f64],
        mut walk: Walk,
        visit: &mut dyn FnMut(&Element<'_>) -> ControlFlow<()>,
    ) -> Outcome {
        let mut map = self.plan.closed.clone();
        let mut step = self.plan.step;
        let n = map.states;
        let mut output = vec![0.0; n + 2 * NODES];
        let mut last: Option<[Values; 2]> = None;
        let (mut smooth, mut doublings) = (0, 0);
        loop {
            map.apply(state, &mut output);
            state.copy_from_slice(&output[..n]);
            let v: Values = core::array::from_fn(|i| output[n + i]);
            let y: Values = core::array::from_fn(|i| output[n + NODES + i]);
            if let Some(outcome) = walk.beyond(&v) {
                return outcome;
            }
            if visit(&Element { start: walk.time, length: step, v: &v, y: &y }).is_break() {
                return Outcome::Stopped;
            }
            walk.time += step;
            let Some(first) = last.take() else {
                last = Some([v, y]);
                continue;
            };
            let fits = |first: &Values, second: &Values| {
                misfit(first, second) <= self.allowed(size(first).max(size(second)))
            };
            smooth = if fits(&first[0], &v) && fits(&first[1], &y) { smooth + 1 } else { 0 };
            if smooth == 2 {
                map = map.squared();
                step *= 2.0;
                smooth = 0;
                doublings += 1;
                if doublings > MAX_DOUBLINGS {
                    return Outcome::Endless;
                }
            }
        }
    }
}

/// How far a march has come.
struct Walk {
    steps: usize,
    time: f64,
    limit: f64,
}

impl Walk {
    fn beyond(&mut self, v: &Values) -> Option<Outcome> {
        self.steps += 1;
        // Not `>`: what is no number any more is out of bounds as well.
        if !v.iter().all(|v| v.abs() <= self.limit) {
            Some(Outcome::Unstable)
        } else if self.steps > MAX_STEPS {
            Some(Outcome::Endless)
        } else {
            None
        }
    }
}
