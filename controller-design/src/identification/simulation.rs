//! The output that the identified models give for a recorded input.

use super::Recording;
use super::identified::{Fit, Identified, SecondOrder};
use super::response::{Chain, Lag, Moves};
use std::vec::Vec;

impl Identified {
    /// The output of the fitted second-order model, baseline included, at the rows of the recording it is from.
    #[must_use]
    pub fn simulate(&self, recording: &Recording<'_>) -> Option<Vec<f64>> {
        let SecondOrder { gain, a1, a2, dead_time } = self.model?;
        let (x, _) = self.response(recording, [0.0, 0.0, a1, a2], dead_time)?;
        Some(x.into_iter().map(|x| self.model_offset + gain * x).collect())
    }

    /// The output of [`fit`](Self::fit), the structure that explains the record best, at the rows of the recording.
    #[must_use]
    pub fn simulate_fit(&self, recording: &Recording<'_>) -> Option<Vec<f64>> {
        let Fit { gain, b1, dead_time, factors, offset, .. } = self.fit?;
        let (x, slope) = self.response(recording, factors, dead_time)?;
        Some(x.iter().zip(slope).map(|(x, slope)| offset + gain * (x + b1 * slope)).collect())
    }

    /// Response and slope \[1/s\] for unit gain of the lags `1/((1 + f[0]*s + f[1]*s^2)*(1 + f[2]*s + f[3]*s^2))`.
    fn response(
        &self,
        recording: &Recording<'_>,
        factors: [f64; 4],
        dead_time: f64,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let span = recording.t.last()? - self.change_at;
        let mut before = self.u0;
        let mut moves = Moves::default();
        for (t, u) in recording.t.iter().zip(recording.u) {
            if *t >= self.change_at && *u != before {
                moves.at.push((t - self.change_at) / span);
                moves.by.push(u - before);
                before = *u;
            }
        }
        let lag = |a1: f64, a2: f64| Lag { a1: a1 / span, a2: a2 / (span * span) };
        let times: Vec<f64> = recording.t.iter().map(|t| (t - self.change_at) / span).collect();
        let mut chain = Chain::new(&[lag(factors[0], factors[1]), lag(factors[2], factors[3])]);
        let (x, slope) = chain.response(&times, &moves, dead_time / span);
        Some((x, slope.into_iter().map(|slope| slope / span).collect()))
    }
}
