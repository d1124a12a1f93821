//! What lies between the plant and the controller: noise, range and resolution; and recorded measurements.

use super::noise::Gaussian;
use crate::scenario::{Between, Noise, Recording, Sensor};
use std::sync::Arc;

/// A sensor with its noise.
#[derive(Debug, Clone)]
pub(super) struct Measuring {
    sensor: Sensor,
    noise: Option<(f64, Gaussian)>,
    /// Neither noise nor range nor resolution: it shows what there is.
    ideal: bool,
}

impl Measuring {
    pub(super) fn new(sensor: Sensor, noise: Option<Noise>) -> Self {
        let Sensor { lo, hi, resolution } = sensor;
        let free = lo == f64::NEG_INFINITY && hi == f64::INFINITY && resolution == 0.0;
        let ideal = free && noise.is_none();
        Self { sensor, noise: noise.map(|noise| (noise.std, Gaussian::new(noise.seed))), ideal }
    }

    /// What the sensor shows of `y`; a sample of the noise is used up.
    #[inline]
    pub(super) fn show(&mut self, y: f64) -> f64 {
        if self.ideal { y } else { self.show_real(y) }
    }

    #[inline(never)]
    fn show_real(&mut self, y: f64) -> f64 {
        let noisy = match &mut self.noise {
            Some((std, source)) => y + *std * source.sample(),
            None => y,
        };
        let Sensor { lo, hi, resolution } = self.sensor;
        rounded(noisy.clamp(lo, hi), resolution)
    }
}

/// The nearest multiple of `resolution`; of 0 every number is one.
pub(super) fn rounded(x: f64, resolution: f64) -> f64 {
    if resolution > 0.0 { libm::round(x / resolution) * resolution } else { x }
}

/// A recorded measurement that is played from the sample at `start` \[s\] on.
#[derive(Debug, Clone)]
pub(super) struct Replay {
    recording: Arc<Recording>,
    start: f64,
    ts: f64,
    row: usize,
}

impl Replay {
    pub(super) fn new(recording: &Arc<Recording>, start: f64, ts: f64) -> Self {
        Self { recording: Arc::clone(recording), start, ts, row: 0 }
    }

    /// The recorded value at the time `t` \[s\], after the end the last one; `t` never falls.
    pub(super) fn value(&mut self, t: f64) -> f64 {
        let Recording { times, values, between, .. } = &*self.recording;
        let t = t - self.start;
        // Sums of periods are not exact: a row at the time of a sample belongs to it.
        let due = |next: &f64| *next <= t + 1e-9 * self.ts + 4.0 * f64::EPSILON * (t.abs() + self.start);
        while times.get(self.row + 1).is_some_and(due) {
            self.row += 1;
        }
        let row = self.row;
        match (between, times.get(row + 1)) {
            (Between::Line, Some(next)) => {
                let share = ((t - times[row]) / (next - times[row])).clamp(0.0, 1.0);
                values[row] + share * (values[row + 1] - values[row])
            }
            _ => values[row],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn range_comes_before_resolution() {
        let sensor = Sensor { lo: 0.0, hi: 10.0, resolution: 0.25 };
        let mut measuring = Measuring::new(sensor, None);
        let shown = [-1.0, 0.1, 0.13, 9.9, 12.0].map(|y| measuring.show(y));
        assert_eq!(shown, [0.0, 0.0, 0.25, 10.0, 10.0]);
    }

    #[test]
    fn a_recording_is_played_by_its_own_clock() {
        let recording = |between| {
            let (times, values) = (vec![0.0, 0.3, 1.0], vec![1.0, 2.0, 4.0]);
            Arc::new(Recording { name: "x".to_owned(), times, values, between })
        };
        let play = |between| {
            let mut replay = Replay::new(&recording(between), 2.0, 0.1);
            [2.0, 2.1, 2.1 + 0.2, 2.65, 9.0].map(|t| replay.value(t))
        };
        assert_eq!(play(Between::Hold), [1.0, 1.0, 2.0, 2.0, 4.0]);
        let line = play(Between::Line);
        for (value, exact) in line.into_iter().zip([1.0, 1.0 + 1.0 / 3.0, 2.0, 3.0, 4.0]) {
            assert!((value - exact).abs() < 1e-12, "{line:?}");
        }
    }
}
