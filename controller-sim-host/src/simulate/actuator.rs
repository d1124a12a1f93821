//! What lies between the controller and the plant: range, dead band, rate and resolution of the actuator.

use super::sensor::rounded;
use crate::scenario::{Actuator, Stiction};

/// An actuator at a position.
#[derive(Debug, Clone, Copy)]
pub(super) struct Positioner {
    actuator: Actuator,
    /// Furthest movement in a sample \[u\].
    step: f64,
    /// Neither range nor rate, resolution, dead band or stiction: it goes where it is told.
    ideal: bool,
    position: f64,
    /// Where the stem is that follows the position \[u\].
    stem: f64,
}

impl Positioner {
    /// At rest at `u0`, or at the end of its range next to it.
    pub(super) fn new(actuator: Actuator, ts: f64, u0: f64) -> Self {
        let Actuator { lo, hi, rate, resolution, deadband, stiction, read_back: _ } = actuator;
        let free = [-lo, hi, rate].iter().all(|&bound| bound == f64::INFINITY);
        let ideal = free && resolution == 0.0 && deadband == 0.0 && stiction.is_none();
        let position = u0.clamp(lo, hi);
        Self { actuator, step: rate * ts, ideal, position, stem: position }
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
        self.stem = match self.actuator.stiction {
            None => self.position,
            Some(stiction) => stiction.follow(self.stem, self.position),
        };
        rounded(self.stem, resolution).clamp(lo, hi)
    }
}

impl Stiction {
    /// Where a stem at `stem` goes under the signal `signal` \[u\].
    ///
    /// He's cumulative force is the distance from stem to signal: so it needs no sum, which would gather roundings.
    fn follow(self, stem: f64, signal: f64) -> f64 {
        let (still, moving) = (0.5 * (self.band + self.jump), 0.5 * (self.band - self.jump));
        let force = signal - stem;
        if force.abs() > still { signal - moving.copysign(force) } else { stem }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn range_dead_band_rate_and_resolution() {
        let actuator =
            Actuator { lo: 0.0, hi: 10.0, rate: 2.0, resolution: 0.5, deadband: 0.2, ..Actuator::default() };
        let mut positioner = Positioner::new(actuator, 0.5, 1.0);
        // 1 a sample at most; stays within the dead band of where it is.
        let applied = [20.0, 20.0, 3.1, 3.4, -5.0, 0.0].map(|u| positioner.apply(u));
        assert_eq!(applied, [2.0, 3.0, 3.0, 3.5, 2.5, 1.5]);
        let mut plain = Positioner::new(Actuator::default(), 0.5, 1.0);
        assert_eq!([1e9, -0.1].map(|u| plain.apply(u)), [1e9, -0.1]);
    }

    /// By hand, band 4 and jump 1: static friction 2.5, kinetic 1.5. After a turn the signal goes through the band, from
    /// 1.5 above the stem to 2.5 below it, and the stem jumps by 1.
    #[test]
    fn a_sticky_stem_jumps_after_a_turn() {
        let actuator = Actuator { stiction: Some(Stiction { band: 4.0, jump: 1.0 }), ..Actuator::default() };
        let mut positioner = Positioner::new(actuator, 0.5, 10.0);
        let signals = [12.0, 12.5, 13.0, 13.5, 14.0, 16.0, 14.0, 12.5, 12.0, 11.75, 11.5];
        let stems = signals.map(|u| positioner.apply(u));
        //  The stem follows 1.5 behind in jumps of at least 1: at 13, 14 and 16; downwards only below 14.5 - 2.5.
        assert_eq!(stems, [10.0, 10.0, 11.5, 11.5, 11.5, 14.5, 14.5, 14.5, 14.5, 13.25, 13.25]);
        // Without a jump: play, the stem half the band behind the signal.
        let play = Actuator { stiction: Some(Stiction { band: 1.0, jump: 0.0 }), ..Actuator::default() };
        let mut positioner = Positioner::new(play, 0.5, 0.0);
        let stems = [0.25, 0.5, 0.75, 2.0, 1.5, 1.0, 0.75].map(|u| positioner.apply(u));
        assert_eq!(stems, [0.0, 0.0, 0.25, 1.5, 1.5, 1.5, 1.25]);
        // As wide as the band the jump takes the stem to the signal.
        let exact = Actuator { stiction: Some(Stiction { band: 1.0, jump: 1.0 }), ..Actuator::default() };
        let mut positioner = Positioner::new(exact, 0.5, 0.0);
        assert_eq!([1.0, 1.1, 1.5, 0.0].map(|u| positioner.apply(u)), [0.0, 1.1, 1.1, 0.0]);
    }
}
