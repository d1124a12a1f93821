//! What a loop reads and gives in one sample.

use crate::mode::Mode;
use crate::real::Real;
use crate::sample::Quality;
use crate::status::Status;

/// What a [`Controller`](crate::Controller) reads in one sample. Named fields: swapped arguments flip loops.
///
/// Any bit pattern is allowed in any number; the comments say what happens to an unusable one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ControllerInput<T> {
    /// Local set-point \[y\]; clamped to its range, the last good one if not finite.
    pub r: T,
    /// Remote set-point \[y\], used in [`Mode::Cascade`]; treated like `r`.
    pub r_remote: T,
    /// Measurement \[y\]; not finite or out of range: a bad sample.
    pub y: T,
    /// What the sender says of `y`.
    pub quality: Quality,
    /// Requested mode.
    pub mode: Mode,
    /// Output in [`Mode::Manual`] \[u\], limited; `None` or not finite: the output stays where it is.
    pub manual: Option<T>,
    /// Output in [`Mode::Track`] \[u\], limited; not finite: the output stays where it is.
    pub track: T,
    /// Offset (feed-forward) added inside the limits \[u\]; clamped to its range, the last good one if not finite.
    pub offset: T,
    /// Output that was really applied since the last sample \[u\], read back from the actuator or the inner loop;
    /// `None` or not finite: the loop's own last output.
    pub u_applied: Option<T>,
    /// Use the compensator. It runs in any case, so that this can change without a bump.
    pub compensate: bool,
    /// The output must not be driven further up: the integral term does not rise.
    pub inhibit_up: bool,
    /// The output must not be driven further down: the integral term does not fall.
    pub inhibit_down: bool,
    /// Lets a latched fallback end.
    pub acknowledge: bool,
}

impl<T: Real> Default for ControllerInput<T> {
    fn default() -> Self {
        Self {
            r: T::ZERO,
            r_remote: T::ZERO,
            y: T::ZERO,
            quality: Quality::Good,
            mode: Mode::Auto,
            manual: None,
            track: T::ZERO,
            offset: T::ZERO,
            u_applied: None,
            compensate: true,
            inhibit_up: false,
            inhibit_down: false,
            acknowledge: false,
        }
    }
}

/// What a [`Controller`](crate::Controller) gives in one sample. Every number is finite, `u` is in its range.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ControllerOutput<T> {
    /// Output, limited \[u\].
    pub u: T,
    /// Output before the limits \[u\].
    pub v: T,
    /// Integral term; of an ADRC minus the estimated disturbance \[u\].
    pub i: T,
    /// Filtered proportional and derivative terms; of an ADRC the feedback of its other estimates \[u\].
    pub pd: T,
    /// Output of the compensator \[u\], whether it is used or not.
    pub u_f: T,
    /// Estimated disturbance at the plant input \[u\], relative to the point of initialisation.
    pub d_hat: T,
    /// Working set-point \[y\].
    pub r: T,
    /// For a primary loop whose output is this loop's set-point: a higher set-point cannot act (the primary's
    /// `inhibit_up`). What the primary reads back as its `u_applied` is `r`.
    pub blocked_up: bool,
    /// A lower set-point cannot act (the primary's `inhibit_down`).
    pub blocked_down: bool,
    /// Mode in force.
    pub mode: Mode,
    /// Status bits.
    pub status: Status,
}
