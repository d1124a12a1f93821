//! The plant side of a sampled loop whose plant is not linear: the same hold, latency, dead time and disturbance as for a
//! linear one, the course between their changes by an integrator.

use super::closed_loop::SubStep;
use super::curve::{Curve, SAME};
use super::delay::{Delay, Step, grid};
use crate::plant::{CONDITIONS, Integrator, Nonlinear};
use crate::scenario::{Signal, show_short};

/// How long a plant has been in a condition.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Spell {
    seconds: f64,
    /// When it was first so \[s\].
    first: f64,
}

/// A non-linear plant behind a zero-order hold, sampled every `ts`; used as a [`ClosedLoop`](super::ClosedLoop).
#[derive(Debug, Clone)]
pub(super) struct NonlinearLoop {
    plant: Integrator,
    ts: f64,
    grid: Vec<Step>,
    delay: Delay,
    disturbance: Curve,
    /// Whether the disturbance adds to the input; else it is a load of its own.
    at_input: bool,
    /// Number of this sample.
    sample: f64,
    /// One for each condition of the plant.
    spells: [Spell; CONDITIONS],
    /// When the integrator could not go on \[s\].
    stuck: Option<f64>,
}

impl NonlinearLoop {
    /// The loop at rest at `y0` under the disturbance `d0`, and the output that holds it there; `None` when there is none.
    pub(super) fn new(
        plant: Nonlinear,
        ts: f64,
        latency: f64,
        substeps: usize,
        (y0, d0): (f64, f64),
        disturbances: &[(f64, Signal)],
    ) -> Option<(Self, f64)> {
        let (x, u0) = plant.rest(y0, d0)?;
        let (delay, fraction) = Delay::new((plant.dead_time() + latency) / ts, u0);
        let at_input = plant.is_disturbed_at_input();
        let later = if at_input { plant.dead_time() } else { 0.0 };
        let built = Self {
            plant: Integrator::new(plant, x),
            ts,
            grid: grid(ts, substeps.max(1), fraction),
            delay,
            disturbance: Curve::new(d0, disturbances, later, ts),
            at_input,
            sample: 0.0,
            spells: Default::default(),
            stuck: None,
        };
        Some((built, u0))
    }

    /// The measurement of this sample \[y\].
    pub(super) fn measure(&self) -> f64 {
        self.plant.output()
    }

    /// Time of this sample \[s\].
    pub(super) fn time(&self) -> f64 {
        self.sample * self.ts
    }

    /// When the plant could not be integrated any further \[s\]; it stands still from there.
    pub(super) fn stuck(&self) -> Option<f64> {
        self.stuck
    }

    /// Applies `u` \[u\] and moves to the next sample; `each` sees the output between the samples.
    pub(super) fn hold(&mut self, u: f64, mut each: impl FnMut(SubStep)) {
        let (arrived, before) = self.delay.push(u);
        let k = self.sample;
        self.sample += 1.0;
        for index in 0..self.grid.len() {
            let step = self.grid[index];
            let output = if step.new_output { arrived } else { before };
            let (mut start, mut left) = (step.start, step.h);
            // As for a linear plant: divided where the disturbance breaks.
            loop {
                let at = self.disturbance.next() - k;
                let until = (at - start) * self.ts;
                if until > left - SAME * self.ts {
                    break;
                }
                if until > SAME * self.ts {
                    self.advance(k + start, until, output, &mut each);
                    start = at;
                    left -= until;
                }
                self.disturbance.enter_next();
            }
            self.advance(k + start, left, output, &mut each);
        }
    }

    /// Moves from the instant `s` (in samples) through `h` seconds.
    fn advance(&mut self, s: f64, h: f64, output: f64, each: &mut impl FnMut(SubStep)) {
        let (t0, y0) = (s * self.ts, self.plant.output());
        let (level, slope) = self.disturbance.line(s);
        let (curve, ts, at_input) = (&self.disturbance, self.ts, self.at_input);
        let has_sines = curve.has_sines();
        let inputs = |t: f64| {
            let d = level + slope * t;
            let d = if has_sines { curve.with_sines(s + t / ts, d) } else { d };
            if at_input { [output + d, 0.0] } else { [output, d] }
        };
        if self.stuck.is_none() && self.plant.advance(h, inputs).is_err() {
            self.stuck = Some(t0);
        }
        let [u, d] = inputs(h);
        self.note(t0, h, u, d);
        each(SubStep { t0, y0, t1: t0 + h, y1: self.plant.output() });
    }

    /// Counts what holds at the end of a step.
    fn note(&mut self, t0: f64, h: f64, u: f64, d: f64) {
        let holding = self.plant.plant().conditions(self.plant.states(), u, d);
        for (spell, holds) in self.spells.iter_mut().zip(holding) {
            if holds {
                spell.first = if spell.seconds == 0.0 { t0 } else { spell.first };
                spell.seconds += h;
            }
        }
    }

    /// What to say of the run.
    pub(super) fn remarks(&self) -> Vec<String> {
        let texts = self.plant.plant().condition_texts();
        let lasting = self.spells.iter().zip(texts).filter(|(spell, _)| spell.seconds > 0.0);
        let say = |(spell, text): (&Spell, &str)| {
            format!("{text} for {} s, from {} s on", show_short(spell.seconds), show_short(spell.first))
        };
        lasting.map(|(spell, text)| say((spell, text))).collect()
    }
}
