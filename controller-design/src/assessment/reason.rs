//! Why a verdict is what it is.

use core::fmt;

/// A reason for a verdict. `Display` gives one line without a full stop; [`help`](Self::help) what to do.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// Near-optimal: dip, its time and the third peak are in their ranges.
    WithinRanges,
    /// Aggressive: the dip is too deep.
    DipTooDeep(f64),
    /// Aggressive: the third peak is too high above the set-point, or above the dip.
    Rings(f64),
    /// Aggressive: the dip comes too early.
    DipTooEarly(f64),
    /// Aggressive: the response swings without an end in the record.
    Oscillates,
    /// Sluggish: the measurement creeps back without a dip.
    NoDip,
    /// Sluggish: it turns before it has come back.
    DipTooShallow(f64),
    /// Sluggish: the dip comes too late.
    DipTooLate(f64),
    /// Inconclusive: no step of the output by hand was found.
    NoStep,
    /// Inconclusive: the output of the controller is the same all the time.
    OutputConstant,
    /// Inconclusive: the record is one of a change of the set-point.
    SetpointChange,
    /// Inconclusive: so few samples before the step.
    ShortBefore(usize),
    /// Inconclusive: measurement or output were on the move before the step.
    NotSteady,
    /// Inconclusive: the measurement was away from the set-point by so many first peaks.
    NotAtSetpoint(f64),
    /// Inconclusive: the controller never took over again.
    NeverAuto,
    /// Inconclusive: it took over when the measurement had gone so many first peaks.
    AutoTooLate(f64),
    /// Inconclusive: the set-point was moved before the response had ended.
    SetpointMoved,
    /// Inconclusive: the output was stepped again before the response had ended.
    SteppedAgain,
    /// Inconclusive: the record ends so many peak times after the step.
    RecordShort(f64),
    /// Inconclusive: so few samples until the first peak.
    CoarseSampling(usize),
    /// Inconclusive: a gap in the record of so many peak times.
    Gap(f64),
    /// Inconclusive: four standard deviations of the smoothed noise, in first peaks.
    Noise(f64),
    /// Inconclusive: the resolution of the measurement, in first peaks.
    Resolution(f64),
    /// Inconclusive: the measurement does not answer to the step.
    NoResponse,
    /// Inconclusive: the measurement has settled, but the output stays away by so many steps.
    OutputNotBack(f64),
}

impl Reason {
    /// A stable name for programs.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::WithinRanges => "within-ranges",
            Self::DipTooDeep(_) => "dip-too-deep",
            Self::Rings(_) => "rings",
            Self::DipTooEarly(_) => "dip-too-early",
            Self::Oscillates => "oscillates",
            Self::NoDip => "no-dip",
            Self::DipTooShallow(_) => "dip-too-shallow",
            Self::DipTooLate(_) => "dip-too-late",
            Self::NoStep => "no-step",
            Self::OutputConstant => "output-constant",
            Self::SetpointChange => "setpoint-change",
            Self::ShortBefore(_) => "short-before",
            Self::NotSteady => "not-steady",
            Self::NotAtSetpoint(_) => "not-at-setpoint",
            Self::NeverAuto => "never-auto",
            Self::AutoTooLate(_) => "auto-too-late",
            Self::SetpointMoved => "setpoint-moved",
            Self::SteppedAgain => "stepped-again",
            Self::RecordShort(_) => "record-short",
            Self::CoarseSampling(_) => "coarse-sampling",
            Self::Gap(_) => "gap",
            Self::Noise(_) => "noise",
            Self::Resolution(_) => "resolution",
            Self::NoResponse => "no-response",
            Self::OutputNotBack(_) => "output-not-back",
        }
    }

    /// What to do.
    #[must_use]
    pub const fn help(&self) -> &'static str {
        match self {
            Self::WithinRanges => "leave the controller as it is",
            Self::DipTooDeep(_) => "make the integral time longer",
            Self::Rings(_) | Self::DipTooEarly(_) => "lower the gain",
            Self::Oscillates => "lower the gain, and make the integral time longer",
            Self::NoDip => {
                "raise the gain; if the response stays without a dip, make the integral time shorter"
            }
            Self::DipTooShallow(_) => "make the integral time shorter",
            Self::DipTooLate(_) => "raise the gain",
            Self::NoStep => {
                "step the output by hand by far more than it moves by itself, or say where the step is"
            }
            Self::OutputConstant => {
                "check the column of the output; else switch to manual, step the output and switch back while recording"
            }
            Self::SetpointChange => {
                "leave the set-point alone: switch to manual, step the output and switch back while recording"
            }
            Self::ShortBefore(_) => "record at least 10 samples of rest before the step",
            Self::NotSteady => "wait until the loop has settled before the step",
            Self::NotAtSetpoint(_) => {
                "let the controller bring the measurement to the set-point before the step"
            }
            Self::NeverAuto => "switch back to automatic as soon as the output is stepped",
            Self::AutoTooLate(_) => {
                "switch back to automatic before the measurement moves, within the dead time"
            }
            Self::SetpointMoved => "leave the set-point alone until the loop has settled",
            Self::SteppedAgain => "leave the output alone until the loop has settled",
            Self::RecordShort(_) => {
                "record until the loop has settled, at least four times the time of the first peak"
            }
            Self::CoarseSampling(_) => "record at least 10 samples until the first peak, better 50",
            Self::Gap(_) => "repeat the experiment with a record without gaps",
            Self::Noise(_) | Self::Resolution(_) => "repeat the experiment with a larger step",
            Self::NoResponse => {
                "check the actuator and the columns; else repeat the experiment with a larger step"
            }
            Self::OutputNotBack(_) => {
                "repeat the experiment: another load came in between, or the actuator sticks"
            }
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WithinRanges => f.write_str("the dip, its time and the third peak are in their ranges"),
            Self::DipTooDeep(dip) => {
                write!(f, "the dip of {dip:.3} first peaks goes too far beyond the baseline: the integral time is too short")
            }
            Self::Rings(r) => {
                write!(f, "the third peak of {r:.3} first peaks is too large: the gain is too high")
            }
            Self::DipTooEarly(r) => {
                write!(f, "the dip comes early, at {r:.2} times the time of the first peak: the gain is too high")
            }
            Self::Oscillates => f.write_str("the response swings to and fro: the loop is near instability"),
            Self::NoDip => f.write_str(
                "the measurement creeps back without a dip: the gain is too low or the integral time too long",
            ),
            Self::DipTooShallow(dip) => write!(
                f,
                "the measurement turns at {dip:.3} first peaks, before it is back: the integral time is too long"
            ),
            Self::DipTooLate(r) => {
                write!(f, "the dip comes late, at {r:.2} times the time of the first peak: the gain is too low")
            }
            Self::NoStep => f.write_str("no step of the output by hand was found"),
            Self::OutputConstant => f.write_str("the output of the controller is the same in the whole record"),
            Self::SetpointChange => f.write_str(
                "the record shows the answer to a change of the set-point, no step of the output by hand",
            ),
            Self::ShortBefore(n) => write!(f, "the record has {n} samples before the step, too few for a baseline"),
            Self::NotSteady => f.write_str("the loop was not steady before the step"),
            Self::NotAtSetpoint(x) => {
                write!(f, "before the step the measurement was {x:.2} first peaks away from the set-point")
            }
            Self::NeverAuto => f.write_str("the output stays where the step left it: the loop never was in automatic"),
            Self::AutoTooLate(x) => {
                write!(f, "back to automatic too late: the measurement had gone {x:.2} first peaks by then")
            }
            Self::SetpointMoved => f.write_str("the set-point was moved before the response had ended"),
            Self::SteppedAgain => f.write_str("the output was stepped again before the response had ended"),
            Self::RecordShort(x) => {
                write!(f, "the record ends {x:.1} times the time of the first peak after the step, too early")
            }
            Self::CoarseSampling(n) => write!(f, "the record has {n} samples until the first peak, too few"),
            Self::Gap(x) => write!(f, "the record has a gap of {x:.2} times the time of the first peak"),
            Self::Noise(x) => write!(f, "the noise is too high: {x:.3} first peaks after smoothing, allowed 0.06"),
            Self::Resolution(x) => {
                write!(f, "the resolution of the measurement is too coarse: {x:.3} first peaks, allowed 0.06")
            }
            Self::NoResponse => f.write_str("the measurement does not answer to the step of the output"),
            Self::OutputNotBack(x) => write!(
                f,
                "the measurement has settled, but the output ends {x:.2} steps away from where it was"
            ),
        }
    }
}
