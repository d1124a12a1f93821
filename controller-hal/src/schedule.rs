//! Laws for several operating points.

use crate::faults::{Faults, RANGE_LIMIT};
use crate::sense::Reading;
use controller_core::{ConfigErrors, Instance, Law, Param, Quality, Real, Reason};

/// A law and where it belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OperatingPoint<L> {
    /// Scheduling signal at this point, in its own unit.
    pub at: f64,
    /// The law that was designed there.
    pub law: L,
}

/// A loop whose law is chosen by a scheduling signal, such as a flow, a level or a speed.
///
/// All laws are built and checked before the first sample (a `Pid`, a `Controller`, an `Adrc`: any
/// [`Law`]); a step builds none. The border between two neighbours is half way between them; the signal must pass it by half
/// of the hysteresis before the law changes, and the new law adopts the state: a bumpless transfer, within the bounds that its
/// `adopt` names. For a finer schedule take more points: they cost memory only.
///
/// The signal may be approximate (`SquareRootFlow` of the feature `micromath`, a filtered measurement): it chooses, it is
/// not calculated with. It comes as a [`Reading`], because the value of a failed transmitter means nothing: a reading that is
/// [`Quality::Bad`] or not finite leaves the law as it is; an uncertain one counts. Cost: 4 compares a sample while nothing
/// changes; a change copies a law and adopts, at most once a sample.
///
/// ```
/// use controller_core::{Pid, PidConfig, PidInput, PidState};
/// use controller_core::Quality;
/// use controller_hal::{GainSchedule, OperatingPoint, Reading};
/// let law = |kp: f64| Pid::<f32>::new(&PidConfig { kp, ki: kp, ..PidConfig::default() }, 0.1).unwrap();
/// // The plant's gain falls with the flow.
/// let points = [10.0, 50.0, 100.0].map(|at| OperatingPoint { at, law: law(0.02 * at) });
/// let input = PidInput { r: 1.0, y: 1.0 };
/// let mut loops = GainSchedule::new(points, 8.0, 12.0_f32, |law| {
///     let mut state = PidState::default();
///     law.settle(&mut state, input, 5.0);
///     state
/// }).unwrap();
/// let mut at = |reading| (loops.step(reading, &input).u(), loops.active());
/// assert_eq!(at(Reading::good(33.0)), (5.0, 0)); // the border is at 30, half of 8 around it
/// assert_eq!(at(Reading::good(35.0)), (5.0, 1)); // no bump
/// assert_eq!(at(Reading::good(27.0)), (5.0, 1));
/// assert_eq!(at(Reading { value: 0.0, quality: Quality::Bad }), (5.0, 1)); // a broken wire is not a flow of 0
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GainSchedule<L, S, T, const N: usize> {
    laws: [L; N],
    /// The borders at which the law changes upwards from point `i` to `i + 1`, and downwards from there; the last is never
    /// passed.
    up: [T; N],
    down: [T; N],
    active: usize,
    instance: Instance<L, S>,
}

impl<T: Real, S, L: Law<State = S> + Copy, const N: usize> GainSchedule<L, S, T, N> {
    /// A schedule over `points` in ascending order, with `hysteresis` in the unit of the signal. It begins with the law next
    /// to `signal` and the state that `begin` makes for it, settled or zeroed. Until the transmitter answers, `signal` is what
    /// to assume of the plant: a value that is safe to start at, not that of a bad reading.
    ///
    /// # Errors
    /// No points, points that are not finite or not ascending; a hysteresis below 0, or as large as the distance of two
    /// neighbours.
    pub fn new(
        points: [OperatingPoint<L>; N],
        hysteresis: f64,
        signal: T,
        begin: impl FnOnce(&L) -> S,
    ) -> Result<Self, ConfigErrors> {
        let mut faults = Faults::default();
        let mut nearest_neighbours = 2.0 * RANGE_LIMIT;
        for point in &points {
            faults.range(Param::OperatingPoint, point.at, -RANGE_LIMIT, RANGE_LIMIT);
        }
        for (lower, upper) in points.iter().zip(points.iter().skip(1)) {
            if lower.at >= upper.at {
                faults.fault(Param::OperatingPoint, Reason::Inverted, lower.at, -RANGE_LIMIT, upper.at);
            } else {
                nearest_neighbours = (upper.at - lower.at).min(nearest_neighbours);
            }
        }
        faults.range(Param::Hysteresis, hysteresis, 0.0, 0.999 * nearest_neighbours);
        // Of two equally near ones the lower, for a NaN the first.
        let beyond =
            |(a, b): &(&OperatingPoint<L>, &OperatingPoint<L>)| signal.to_f64() > 0.5 * a.at + 0.5 * b.at;
        let active = points.iter().zip(points.iter().skip(1)).take_while(beyond).count();
        let Some(first) = points.get(active) else {
            faults.fault(Param::OperatingPoint, Reason::OutOfRange, 0.0, 0.0, 0.0);
            return faults.finish(()).and(Err(ConfigErrors::default()));
        };
        let instance = Instance::new(first.law, begin(&first.law));
        let mut borders = points.iter().zip(points.iter().skip(1)).map(|(a, b)| 0.5 * a.at + 0.5 * b.at);
        // Beyond every signal, for the last point.
        let never = T::from_f64(T::LARGEST);
        let (mut up, mut down) = ([never; N], [never; N]);
        for (up, down) in up.iter_mut().zip(&mut down) {
            if let Some(border) = borders.next() {
                *up = T::from_f64(border + 0.5 * hysteresis);
                *down = T::from_f64(border - 0.5 * hysteresis);
            }
        }
        faults.finish(Self { laws: points.map(|point| point.law), up, down, active, instance })
    }

    /// Chooses the law for `signal`, then one sample.
    pub fn step(&mut self, signal: Reading<T>, input: &L::Input) -> L::Output {
        let _ = self.choose(signal);
        self.instance.step(input)
    }

    /// Chooses the law for `signal`, and lets it adopt the state if it is another one; whether it is. A reading that is bad
    /// or not finite chooses nothing.
    pub fn choose(&mut self, signal: Reading<T>) -> bool {
        let mut to = self.active;
        let Reading { value, quality } = signal;
        if quality != Quality::Bad && value.is_finite_number() {
            while self.up.get(to).is_some_and(|&border| value > border) {
                to += 1;
            }
            while to > 0 && self.down.get(to - 1).is_some_and(|&border| value < border) {
                to -= 1;
            }
        }
        match self.laws.get(to) {
            Some(&law) if to != self.active => {
                self.active = to;
                self.instance.adopt(law);
                true
            }
            _ => false,
        }
    }

    /// The number of the point whose law is in force, from 0.
    #[must_use]
    pub fn active(&self) -> usize {
        self.active
    }

    /// The law in force and its state.
    #[must_use]
    pub fn instance(&self) -> &Instance<L, S> {
        &self.instance
    }

    /// The state, to settle or restore it.
    #[must_use]
    pub fn state_mut(&mut self) -> &mut S {
        self.instance.state_mut()
    }
}
