//! Error codes, faults of a configuration, their texts.

use controller_core::{ConfigError, ConfigErrors, Param, Reason, SnapshotError};
use core::ffi::CStr;

/// Most faults that [`Faults`] lists.
pub const MAX_FAULTS: usize = 12;

/// One fault of a configuration: `ctl_fault`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fault {
    /// Which field; the numbers of [`Param`], and those of [`choice`].
    pub param: i32,
    /// What is wrong with it; the numbers of [`Reason`].
    pub reason: i32,
    /// Its value, rounded to the number type.
    pub value: f64,
    /// Smallest allowed value; not below `max` when there is no range to name.
    pub min: f64,
    /// Largest allowed value.
    pub max: f64,
}

/// All faults of a configuration: `ctl_faults`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Faults {
    /// Entries of `list` that are in use.
    pub count: u32,
    /// Faults found; those beyond the list's end are counted only.
    pub total: u32,
    /// The faults, in the order they were found.
    pub list: [Fault; MAX_FAULTS],
}

impl Default for Faults {
    fn default() -> Self {
        let nothing = Fault { param: 0, reason: 0, value: 0.0, min: 0.0, max: 0.0 };
        Self { count: 0, total: 0, list: [nothing; MAX_FAULTS] }
    }
}

impl Faults {
    pub(crate) fn add(&mut self, fault: Fault) {
        let slot = usize::try_from(self.count).ok().and_then(|at| self.list.get_mut(at));
        if let Some(slot) = slot {
            *slot = fault;
            self.count += 1;
        }
        self.total = self.total.saturating_add(1);
    }

    pub(crate) fn add_all(&mut self, errors: &ConfigErrors) {
        for &ConfigError { param, reason, value, min, max } in errors.as_slice() {
            self.add(Fault { param: param as i32, reason: reason as i32, value, min, max });
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.total == 0
    }
}

/// Why a call did nothing. The numbers are stable; 0 is success.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Error {
    /// A pointer is null.
    Null = 1,
    /// The block is smaller than it was at `init`, or than this configuration needs.
    Size = 2,
    /// An address is no multiple of the alignment.
    Align = 3,
    /// The block has not been initialised, or something has written over its beginning.
    NotInitialised = 4,
    /// The block was initialised by another build of the library.
    Version = 5,
    /// `struct_size` is not one this library knows.
    StructSize = 6,
    /// The configuration has faults.
    Config = 7,
    /// An argument is out of its range.
    Argument = 8,
    /// The buffer is too short.
    Buffer = 9,
    /// Not a snapshot, or one of another version.
    SnapshotVersion = 10,
    /// A snapshot of a block of another shape.
    SnapshotShape = 11,
    /// A damaged snapshot.
    SnapshotChecksum = 12,
    /// An intact snapshot that holds no state this configuration can go on from.
    SnapshotInvalid = 13,
    /// Something has written over the law in the block, or its state has a number that is not finite.
    Damaged = 14,
}

impl From<SnapshotError> for Error {
    fn from(error: SnapshotError) -> Self {
        match error {
            SnapshotError::TooShort => Self::Buffer,
            SnapshotError::Version => Self::SnapshotVersion,
            SnapshotError::Shape => Self::SnapshotShape,
            SnapshotError::Checksum => Self::SnapshotChecksum,
            _ => Self::SnapshotInvalid,
        }
    }
}

/// Numbers of the fields that have none in [`Param`]: choices and counts, which Rust's types keep in their ranges.
pub mod choice {
    /// `action`.
    pub const ACTION: i32 = 128;
    /// `integral_rule`.
    pub const INTEGRAL_RULE: i32 = 129;
    /// `anti_windup`.
    pub const ANTI_WINDUP: i32 = 130;
    /// `fallback_action`.
    pub const FALLBACK_ACTION: i32 = 131;
    /// `fallback_return`.
    pub const FALLBACK_RETURN: i32 = 132;
    /// `hold_samples`.
    pub const HOLD_SAMPLES: i32 = 133;
    /// `compensator`.
    pub const COMPENSATOR: i32 = 134;
    /// `model_integrators`.
    pub const MODEL_INTEGRATORS: i32 = 135;
    /// `model_pole_count`.
    pub const MODEL_POLE_COUNT: i32 = 136;
    /// `model_zero_count`.
    pub const MODEL_ZERO_COUNT: i32 = 137;
}

/// What an error code means, in a sentence.
#[must_use]
pub const fn error_text(code: i32) -> &'static CStr {
    match code {
        0 => c"done",
        1 => c"a pointer is null",
        2 => c"the block is too small",
        3 => c"an address is not aligned",
        4 => c"the block is not initialised",
        5 => c"the block was initialised by another build of the library",
        6 => c"struct_size is not that of this library's configuration",
        7 => c"the configuration has faults",
        8 => c"an argument is out of its range",
        9 => c"the buffer is too short",
        10 => c"not a snapshot of this version",
        11 => c"the snapshot belongs to a block of another shape",
        12 => c"the snapshot is damaged",
        13 => c"the snapshot holds no state that this configuration can go on from",
        14 => c"the memory of the block is damaged",
        _ => c"unknown error code",
    }
}

/// Name of the configuration's field that a fault is about.
#[must_use]
pub fn param_name(param: i32) -> &'static CStr {
    if let Some((_, name)) = NAMES.iter().find(|(this, _)| *this as i32 == param) {
        return name;
    }
    match param {
        choice::ACTION => c"action",
        choice::INTEGRAL_RULE => c"integral_rule",
        choice::ANTI_WINDUP => c"anti_windup",
        choice::FALLBACK_ACTION => c"fallback_action",
        choice::FALLBACK_RETURN => c"fallback_return",
        choice::HOLD_SAMPLES => c"hold_samples",
        choice::COMPENSATOR => c"compensator",
        choice::MODEL_INTEGRATORS => c"model_integrators",
        choice::MODEL_POLE_COUNT => c"model_pole_count",
        choice::MODEL_ZERO_COUNT => c"model_zero_count",
        _ => c"unknown parameter",
    }
}

/// The core's parameters under the names of the C structure.
const NAMES: &[(Param, &CStr)] = &[
    (Param::Ts, c"ts"),
    (Param::Kp, c"kp"),
    (Param::Ki, c"ki"),
    (Param::Kd, c"kd"),
    (Param::Tf, c"tf"),
    (Param::B, c"b"),
    (Param::C, c"c"),
    (Param::Tt, c"tt"),
    (Param::OutputLo, c"output_lo"),
    (Param::OutputHi, c"output_hi"),
    (Param::OutputRateUp, c"output_rate_up"),
    (Param::OutputRateDown, c"output_rate_down"),
    (Param::SetpointLo, c"setpoint_lo"),
    (Param::SetpointHi, c"setpoint_hi"),
    (Param::SetpointRateUp, c"setpoint_rate_up"),
    (Param::SetpointRateDown, c"setpoint_rate_down"),
    (Param::Deadband, c"deadband"),
    (Param::MeasurementLo, c"measurement_lo"),
    (Param::MeasurementHi, c"measurement_hi"),
    (Param::OffsetLo, c"offset_lo"),
    (Param::OffsetHi, c"offset_hi"),
    (Param::FallbackOutput, c"fallback_output"),
    (Param::FallbackRate, c"fallback_rate"),
    (Param::OffOutput, c"off_output"),
    (Param::InitialOutput, c"initial_output"),
    (Param::AlarmHiHi, c"alarm_hi_hi"),
    (Param::AlarmHi, c"alarm_hi"),
    (Param::AlarmLo, c"alarm_lo"),
    (Param::AlarmLoLo, c"alarm_lo_lo"),
    (Param::AlarmDeviation, c"alarm_deviation"),
    (Param::AlarmHysteresis, c"alarm_hysteresis"),
    (Param::ModelGain, c"model_gain"),
    (Param::ModelPoles, c"model_pole_a1, model_pole_a2"),
    (Param::ModelZeros, c"model_zero_a1, model_zero_a2"),
    (Param::ModelOrder, c"order of the model"),
    (Param::DeadTime, c"model_dead_time"),
    (Param::Latency, c"latency"),
    (Param::Kfd, c"kfd"),
    (Param::Tfd, c"tfd"),
    (Param::Alpha, c"alpha"),
    (Param::FilterOrder, c"filter_order"),
    (Param::Capacity, c"delay memory of the block"),
    (Param::Overflow, c"gain times range"),
];

/// What is wrong with a value, as the end of a sentence.
#[must_use]
pub const fn reason_text(reason: i32) -> &'static CStr {
    match reason {
        1 => c"is not a finite number",
        2 => c"is out of range",
        3 => c"leaves no room between the lower and the upper bound",
        4 => c"has the wrong sign: ki * model_gain must be positive",
        5 => c"needs a filter: set tf, or kd = 0",
        6 => c"is not a stable factor",
        7 => c"is too large for this block",
        8 => c"makes a transfer function with no more poles than zeros",
        9 => c"differs from what another block was built for",
        _ => c"unknown reason",
    }
}

/// The number of a reason.
pub(crate) const fn number(reason: Reason) -> i32 {
    reason as i32
}

const _: () = {
    use core::mem::offset_of;
    assert!(size_of::<Fault>() == 32 && offset_of!(Fault, value) == 8 && offset_of!(Fault, max) == 24);
    assert!(size_of::<Faults>() == 392 && offset_of!(Faults, list) == 8);
};
