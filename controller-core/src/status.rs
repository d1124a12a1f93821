//! One word that says what a loop did in its last sample.

use core::ops::{BitOr, BitOrAssign};

/// A set of status bits with stable numbers, the same in Rust, C and Structured Text.
///
/// ```
/// use controller_core::Status;
/// let status = Status::LIMITED_HIGH | Status::RATE_LIMITED;
/// assert!(status.has(Status::LIMITED_HIGH));
/// assert_eq!(status.bits(), 0b101);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Status(u32);

macro_rules! bits {
    ($($(#[$doc:meta])* $name:ident = $bit:literal, $text:literal;)*) => {
        impl Status {
            $($(#[$doc])* pub const $name: Self = Self(1 << $bit);)*

            /// Every bit with its name.
            pub const NAMES: &'static [(Self, &'static str)] = &[$((Self::$name, $text)),*];
        }

        /// The names of the bits that are set, in brackets.
        #[cfg(feature = "defmt")]
        impl defmt::Format for Status {
            fn format(&self, f: defmt::Formatter<'_>) {
                let mut first = true;
                defmt::write!(f, "[");
                $(if self.has(Self::$name) {
                    if !core::mem::replace(&mut first, false) {
                        defmt::write!(f, ", ");
                    }
                    defmt::write!(f, $text);
                })*
                defmt::write!(f, "]");
            }
        }
    };
}

bits! {
    /// The output is at its upper limit.
    LIMITED_HIGH = 0, "limited high";
    /// The output is at its lower limit.
    LIMITED_LOW = 1, "limited low";
    /// The output is slower than the loop wants.
    RATE_LIMITED = 2, "rate limited";
    /// The set-point was outside its range and was clamped.
    SETPOINT_LIMITED = 3, "set-point limited";
    /// The working set-point is still on its way.
    SETPOINT_RAMPING = 4, "set-point ramping";
    /// The measurement is bad: not finite, out of range or marked so.
    BAD_INPUT = 5, "bad input";
    /// The measurement is used but uncertain.
    UNCERTAIN = 6, "uncertain";
    /// Output and terms are held for a few bad samples.
    HELD = 7, "held";
    /// The fallback is in force.
    FALLBACK = 8, "fallback";
    /// The measurement is good again, but the fallback waits for an acknowledgement.
    AWAITING_ACKNOWLEDGEMENT = 9, "awaiting acknowledgement";
    /// Another input (set-point, offset, manual, track, read-back) was not usable and was replaced.
    REJECTED = 10, "input rejected";
    /// No good measurement since the state was zeroed.
    UNINITIALISED = 11, "uninitialised";
    /// Samples were lost.
    OVERRUN = 12, "overrun";
    /// The compensator's output is in use.
    COMPENSATING = 13, "compensating";
    /// A secondary loop stops the integral term from moving one way.
    INHIBITED = 14, "inhibited";
    /// Alarm: measurement very high.
    ALARM_HI_HI = 16, "alarm hi hi";
    /// Alarm: measurement high.
    ALARM_HI = 17, "alarm hi";
    /// Alarm: measurement low.
    ALARM_LO = 18, "alarm lo";
    /// Alarm: measurement very low.
    ALARM_LO_LO = 19, "alarm lo lo";
    /// Alarm: deviation from the working set-point.
    ALARM_DEVIATION = 20, "alarm deviation";
}

impl Status {
    /// No bit set.
    pub const NONE: Self = Self(0);

    /// All bits of `other` are set.
    #[must_use]
    #[inline(always)]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Some bit of `other` is set.
    #[inline(always)]
    pub(crate) const fn has_any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The bits as a number.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// The set with these bits.
    #[must_use]
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// This set, or none when `condition` is false.
    #[must_use]
    #[inline(always)]
    pub const fn when(self, condition: bool) -> Self {
        if condition { self } else { Self::NONE }
    }
}

impl BitOr for Status {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Status {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}
