//! Samples of a loop, dense enough to count encirclements and to bracket every peak and crossing.

use core::f64::consts::PI;
use std::vec::Vec;

use super::continuous::UNSTABLE;
use crate::Refusal;
use crate::frequency::{Features, MAX_POINTS, ascending};
use crate::model::Complex;

/// Points of a decade.
const PER_DECADE: u32 = 50;
/// Most that the phase of the dead time turns between two samples, in rad.
const TURN: f64 = 0.2;
/// The phase of the dead time up to which it is followed in any case, in rad.
const TURNS: f64 = 60.0;
/// Most decades a grid grows beyond the features at either end.
const GROWTH: usize = 15;
/// Loop gain that has no bearing on anything any more.
const NEGLIGIBLE: f64 = 1e-3;
/// Most that the characteristic function changes between two samples, relative to its size: a turn of 30 degrees.
const CHANGE: f64 = 0.5;

/// The refusal of a loop whose dead time turns it too often where it counts.
pub(crate) const TOO_LONG: Refusal = Refusal::NoSolution {
    why: "the dead time is too long against the loop's other times to follow all its turns",
    help: "lower the gains, or raise the filter time constant",
};

/// A loop at one frequency: `L = gain/rest`, `S = rest/(rest + gain)`, `T = gain/(rest + gain)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) omega: f64,
    /// `1 - C_u`.
    pub(super) rest: Complex,
    /// `G*(C - C_y)`.
    pub(super) gain: Complex,
    /// `|C_u|`.
    pub(super) inner: f64,
}

impl Point {
    /// The characteristic function: its zeros are the closed loop's poles.
    pub(super) fn characteristic(&self) -> Complex {
        self.rest + self.gain
    }

    pub(super) fn sensitivity(&self) -> f64 {
        self.rest.abs() / self.characteristic().abs()
    }

    pub(super) fn complementary(&self) -> f64 {
        self.gain.abs() / self.characteristic().abs()
    }

    /// `|L|` against 1: -1 to 1, 0 where they are equal.
    pub(super) fn excess(&self) -> f64 {
        let (gain, rest) = (self.gain.abs(), self.rest.abs());
        (gain - rest) / (gain + rest)
    }

    pub(super) fn loop_gain(&self) -> Complex {
        self.gain / self.rest
    }

    /// How far the characteristic function can be from 1 whatever the dead times do to the phases.
    fn envelope(&self) -> f64 {
        self.inner + self.gain.abs()
    }
}

/// Samples in ascending order of frequency.
#[derive(Debug, Clone)]
pub(super) struct Scan {
    pub(super) points: Vec<Point>,
    poles_at_origin: usize,
    /// Whether a dead time keeps turning the loop gain at high frequency.
    pub(super) delayed: bool,
}

impl Scan {
    pub(super) fn new(
        at: &dyn Fn(f64) -> Point,
        features: &Features,
        poles_at_origin: usize,
    ) -> Result<Self, Refusal> {
        let (mut low, mut high) = features.range().unwrap_or((1e-4, 300.0));
        let mut scan = Self { points: Vec::new(), poles_at_origin, delayed: features.longest_delay() > 0.0 };
        for _ in 0..GROWTH {
            if scan.start_phase(&at(low)).abs() < 0.1 {
                break;
            }
            low *= 0.1;
        }
        for _ in 0..GROWTH {
            let (end, before) = (at(high).envelope(), at(0.1 * high).envelope());
            if end < NEGLIGIBLE || (end / before - 1.0).abs() < NEGLIGIBLE {
                break;
            }
            high *= 10.0;
        }
        let all = features.logarithmic(low, high, PER_DECADE);
        let edge = if scan.delayed { TURNS / features.longest_delay() } else { high };
        let mut near: Vec<f64> = all.iter().copied().filter(|omega| *omega <= edge).collect();
        near.extend(features.turning(low, edge.min(high), TURN));
        for omega in ascending(near) {
            scan.push(at, omega, true)?;
        }
        // Farther out only what could still be a peak or a crossing is worth following turn by turn.
        let far: Vec<Point> = all.iter().filter(|omega| **omega > edge).map(|&omega| at(omega)).collect();
        let (ms, reach) = scan.so_far();
        for point in far {
            let before = scan.points.last().copied();
            let matters = |p: &Point| {
                let left = 1.0 - p.envelope();
                left <= 0.0 || (1.0 + p.inner) / left > ms || p.gain.abs() > reach * (1.0 - p.inner)
            };
            let follow = matters(&point) || before.is_some_and(|p| matters(&p));
            if follow {
                let from = before.map_or(low, |p| p.omega);
                for omega in features.turning(from, point.omega, TURN) {
                    scan.push(at, omega, true)?;
                }
            }
            scan.push(at, point.omega, follow)?;
        }
        Ok(scan)
    }

    /// Largest `|S|`, and largest `|L|` below 1 with a phase near -180 degrees.
    fn so_far(&self) -> (f64, f64) {
        self.points.iter().fold((1.0, 0.0), |(ms, reach): (f64, f64), p| {
            let l = p.loop_gain();
            let crosses = l.re < 0.0 && l.im.abs() < -l.re && l.re > -1.0;
            (ms.max(p.sensitivity()), if crosses { reach.max(0.8 * l.abs()) } else { reach })
        })
    }

    /// Adds a sample and, if `follow`, as many before it as it takes to follow the characteristic function.
    fn push(&mut self, at: &dyn Fn(f64) -> Point, omega: f64, follow: bool) -> Result<(), Refusal> {
        let mut waiting = Vec::from([omega]);
        while let Some(&omega) = waiting.last() {
            let point = at(omega);
            if !(point.rest.is_finite() && point.gain.is_finite()) {
                return Err(Refusal::NoSolution {
                    why: "the loop gain leaves the range of numbers",
                    help: "use units in which gains and times are moderate",
                });
            }
            let f = point.characteristic();
            if f.abs() <= 1e-13 * (point.rest.abs() + point.gain.abs()) {
                return Err(UNSTABLE);
            }
            if let Some(before) = self.points.last()
                && follow
            {
                let g = before.characteristic();
                let middle = libm::sqrt(before.omega) * libm::sqrt(omega);
                let narrow = middle <= before.omega * (1.0 + 1e-13) || middle >= omega;
                if (f - g).abs() > CHANGE * f.abs().min(g.abs()) && !narrow {
                    waiting.push(middle);
                    continue;
                }
            }
            if self.points.len() >= 2 * MAX_POINTS {
                return Err(TOO_LONG);
            }
            self.points.push(point);
            waiting.pop();
        }
        Ok(())
    }

    /// How far the phase at low frequency is from the one the poles at the origin make.
    fn start_phase(&self, first: &Point) -> f64 {
        let quarter = 0.5 * PI * f64::from(u32::try_from(self.poles_at_origin).unwrap_or(0));
        from_half_turn(first.characteristic().arg() + quarter)
    }

    /// The number of closed-loop poles in the right half-plane, by the argument principle, when the open loop has
    /// `open` of them.
    pub(super) fn unstable_poles(&self, open: i32) -> Result<i32, Refusal> {
        let undecided = Refusal::NoSolution {
            why: "the closed loop is at its stability limit, or a mode of the plant is out of the controller's reach",
            help: "change the gains; an integrating plant needs kp, and ki must not cancel against a zero",
        };
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else {
            return Err(undecided);
        };
        let (start, end) = (self.start_phase(first), from_half_turn(last.characteristic().arg()));
        if start.abs() > 0.8 || (end.abs() > 0.8 && !self.delayed) {
            return Err(undecided);
        }
        let turned: f64 = self
            .points
            .windows(2)
            .map(|pair| match pair {
                [a, b] => (b.characteristic() / a.characteristic()).arg(),
                _ => 0.0,
            })
            .sum();
        let end = if self.delayed { last.characteristic().arg() } else { end };
        let quarter = 0.5 * PI * f64::from(u32::try_from(self.poles_at_origin).unwrap_or(0));
        let half_turns = (turned + start - end - quarter) / PI;
        #[allow(clippy::cast_possible_truncation)] // saturates, and is then refused
        let count = libm::round(half_turns) as i32;
        if (half_turns - f64::from(count)).abs() > 0.01 {
            return Err(undecided);
        }
        Ok(open.saturating_sub(count))
    }
}

/// The angle from the nearest multiple of a half turn.
fn from_half_turn(angle: f64) -> f64 {
    angle - PI * libm::round(angle / PI)
}
