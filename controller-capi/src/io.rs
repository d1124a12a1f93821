//! Inputs and outputs of a step.

use controller_core::{ControllerInput, ControllerOutput, Mode, Quality, Real, Status};

/// `ctl_f32_input`, `ctl_f64_input`: what a step reads. All zeros: set-point 0, measurement 0 and good, no read-back, the mode
/// that was set. Any bit pattern is allowed in any field.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Input<T> {
    /// Local set-point \[y\]; moved into its range, the last good one if not finite.
    pub r: T,
    /// Remote set-point \[y\], used in mode Cascade; treated like `r`.
    pub r_remote: T,
    /// Measurement \[y\]; not finite or out of range: a bad sample.
    pub y: T,
    /// Output that was really applied since the last sample \[u\]; counts only with `has_u_applied`.
    pub u_applied: T,
    /// Output in mode Manual \[u\]; counts only with `has_manual`, else the output stays where it is.
    pub manual: T,
    /// Output in mode Track \[u\].
    pub track: T,
    /// Feed-forward, added inside the limits \[u\].
    pub offset: T,
    /// Requested mode: 0, the one that was set; else one of [`mode`]. An unknown number keeps the mode that was asked for
    /// last, with [`Status::REJECTED`].
    pub mode: i32,
    /// 0 good, 1 uncertain, 2 bad; an unknown number is bad.
    pub quality: i32,
    /// `u_applied` is given.
    pub has_u_applied: i32,
    /// `manual` is given.
    pub has_manual: i32,
    /// The compensator runs, but its output is not used.
    pub compensator_off: i32,
    /// The output must not be driven further up.
    pub inhibit_up: i32,
    /// The output must not be driven further down.
    pub inhibit_down: i32,
    /// Lets a latched fallback end.
    pub acknowledge: i32,
}

/// `ctl_f32_output`, `ctl_f64_output`: what a step gives. Every number is finite, `u` is in its range.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Output<T> {
    /// Output, limited \[u\].
    pub u: T,
    /// Output before the limits \[u\].
    pub v: T,
    /// Integral term \[u\].
    pub i: T,
    /// Filtered proportional and derivative terms \[u\].
    pub pd: T,
    /// Output of the compensator \[u\], whether it is used or not.
    pub u_f: T,
    /// Estimated disturbance at the plant input \[u\], relative to the point of initialisation.
    pub d_hat: T,
    /// Working set-point \[y\].
    pub r: T,
    /// Mode in force, one of [`mode`].
    pub mode: i32,
    /// Status bits, those of [`Status`].
    pub status: u32,
    /// A higher set-point cannot act: `inhibit_up` of a primary loop.
    pub blocked_up: i32,
    /// A lower set-point cannot act: `inhibit_down` of a primary loop.
    pub blocked_down: i32,
}

/// The numbers of the modes: those of [`Mode`] and one more, so that 0 can mean "as it was set".
pub mod mode {
    use super::Mode;

    /// In [`Input::mode`](super::Input::mode): the mode of `set_mode`.
    pub const AS_SET: i32 = 0;

    /// The number of a mode.
    #[must_use]
    pub const fn number(mode: Mode) -> i32 {
        mode as i32 + 1
    }

    /// The mode that may be asked for by this number.
    #[must_use]
    pub const fn requested(number: i32) -> Option<Mode> {
        Some(match number {
            1 => Mode::Off,
            2 => Mode::Manual,
            3 => Mode::Auto,
            4 => Mode::Cascade,
            5 => Mode::Track,
            6 => Mode::Hold,
            _ => return None,
        })
    }
}

impl<T: Real> Input<T> {
    /// What the controller reads, `mode` being the one that is asked for.
    pub(crate) fn for_mode(&self, mode: Mode) -> ControllerInput<T> {
        let given = |flag: i32, x: T| (flag != 0).then_some(x);
        ControllerInput {
            r: self.r,
            r_remote: self.r_remote,
            y: self.y,
            quality: match self.quality {
                0 => Quality::Good,
                1 => Quality::Uncertain,
                _ => Quality::Bad,
            },
            mode,
            manual: given(self.has_manual, self.manual),
            track: self.track,
            offset: self.offset,
            u_applied: given(self.has_u_applied, self.u_applied),
            compensate: self.compensator_off == 0,
            inhibit_up: self.inhibit_up != 0,
            inhibit_down: self.inhibit_down != 0,
            acknowledge: self.acknowledge != 0,
        }
    }
}

impl<T: Real> Output<T> {
    /// What a step gave, with the bits `more` in its status.
    pub(crate) fn of(out: &ControllerOutput<T>, more: Status) -> Self {
        Self {
            u: out.u,
            v: out.v,
            i: out.i,
            pd: out.pd,
            u_f: out.u_f,
            d_hat: out.d_hat,
            r: out.r,
            mode: mode::number(out.mode),
            status: (out.status | more).bits(),
            blocked_up: i32::from(out.blocked_up),
            blocked_down: i32::from(out.blocked_down),
        }
    }

    /// What there is to say before the first step.
    pub(crate) fn at_rest(u: T, mode: Mode, started: bool) -> Self {
        let status = Status::UNINITIALISED.when(!started).bits();
        Self { u, v: u, mode: mode::number(mode), status, ..Self::default() }
    }
}

// On this side the layout is asserted for every target that is built; the C side asserts each field (`tests/c/layout.c`).
const _: () = {
    use core::mem::offset_of;
    assert!(size_of::<Input<f32>>() == 60 && size_of::<Input<f64>>() == 88);
    assert!(offset_of!(Input<f32>, mode) == 28 && offset_of!(Input<f64>, mode) == 56);
    assert!(size_of::<Output<f32>>() == 44 && size_of::<Output<f64>>() == 72);
    assert!(offset_of!(Output<f32>, mode) == 28 && offset_of!(Output<f64>, mode) == 56);
};
