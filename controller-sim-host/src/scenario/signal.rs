//! What a set-point or a disturbance does over time.

use std::sync::Arc;

/// A part of a signal that begins with an event. The steady level is that of the last [`Step`](Self::Step) or
/// [`Recorded`](Self::Recorded); everything else adds to it. Times are counted from the event.
#[derive(Debug, Clone, PartialEq)]
pub enum Signal {
    /// The steady level becomes this.
    Step(f64),
    /// A ramp of `slope` per second for `duration` \[s\] (infinite: to the end); the level it reached stays.
    Ramp {
        /// Per second.
        slope: f64,
        /// Length \[s\].
        duration: f64,
    },
    /// A pulse of `height` for `duration` \[s\].
    Pulse {
        /// Height.
        height: f64,
        /// Length \[s\].
        duration: f64,
    },
    /// `amplitude * sin(2*pi*t/period + phase)` for `duration` \[s\] (infinite: to the end), then 0.
    Sine {
        /// Amplitude.
        amplitude: f64,
        /// Period \[s\].
        period: f64,
        /// Phase at the event \[rad\].
        phase: f64,
        /// Length \[s\].
        duration: f64,
    },
    /// A random walk: every `every` seconds, first at the event, the level rises by a Gaussian number of the standard
    /// deviation `std`; the level it reached after `duration` \[s\] stays.
    Walk {
        /// Standard deviation of a step.
        std: f64,
        /// Time between two steps \[s\].
        every: f64,
        /// Seed of the generator.
        seed: u64,
        /// Length \[s\].
        duration: f64,
    },
    /// A recorded signal: the steady level is its value, after its end the last one.
    Recorded(Arc<Recording>),
}

/// A column of a table with its times, beginning at 0 with the event.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// File and column, for people.
    pub name: String,
    /// Times \[s\]: the first is 0, each is above the one before.
    pub times: Vec<f64>,
    /// As many finite values.
    pub values: Vec<f64>,
    /// What holds between two rows.
    pub between: Between,
}

/// What holds between two rows of a [`Recording`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Between {
    /// The value of the row before.
    #[default]
    Hold,
    /// The straight line.
    Line,
}
