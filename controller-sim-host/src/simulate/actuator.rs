//! What lies between the controller and the plant: range, dead band, rate and resolution of the actuator.

use super::sensor::rounded;
use crate::scenario::Actuator;

/// An actuator at a position.
#[derive(Debug, Clone, Copy)]
pub(super) struct Positioner {
    actuator: Actuator,
    /// Furthest movement in a sample \[u\].
    step: f64,
    /// Neither range nor rate, resolution or dead band: it goes where it is told.
    ideal: bool,
    position: f64,
}

impl Positioner {
    /// At rest at `u0`, or at the end of its range next to it.
    pub(super) fn new(actuator: Actuator, ts: f64, u0: f64) -> Self {
        let Actuator { lo, hi, rate, resolution, deadband, read_back: _ } = actuator;
        let free = [-lo, hi, rate].iter().all(|&bound| bound == f64::INFINITY);
        let ideal = free && resolution == 0.0 && deadband == 0.0;
        Self { actuator, step: rate * ts, ideal, position: u0.clamp(lo, hi) }
    }

    /// What acts on the plant when the controller asks for `u` \[u\].
    #[inline]
    pub(super) fn apply(&mut self, u: f64) -> f64 {
        if !self.ideal {
            return self.apply_limited(u);
        }
        // As below: an equal zero of the other sign is no movement.
        if u != self.position {
            self.position = u;
        }
        self.position
    }

    #[inline(never)]
    fn apply_limited(&mut self, u: f64) -> f64 {
        let Actuator { lo, hi, resolution, deadband, .. } = self.actuator;
        let target = u.clamp(lo, hi);
        let way = target - self.position;
        if way.abs() > deadband {
            self.position =
                if way.abs() <= self.step { target } else { self.position + way.signum() * self.step };
        }
        rounded(self.position, resolution).clamp(lo, hi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn range_dead_band_rate_and_resolution() {
        let actuator =
            Actuator { lo: 0.0, hi: 10.0, rate: 2.0, resolution: 0.5, deadband: 0.2, read_back: false };
        let mut positioner = Positioner::new(actuator, 0.5, 1.0);
        // 1 a sample at most; stays within the dead band of where it is.
        let applied = [20.0, 20.0, 3.1, 3.4, -5.0, 0.0].map(|u| positioner.apply(u));
        assert_eq!(applied, [2.0, 3.0, 3.0, 3.5, 2.5, 1.5]);
        let mut plain = Positioner::new(Actuator::default(), 0.5, 1.0);
        assert_eq!([1e9, -0.1].map(|u| plain.apply(u)), [1e9, -0.1]);
    }
}
