//! Operating modes: what was asked for, what is in force, and what each mode does.

/// Operating mode of a loop. The numbers are stable.
///
/// | mode | output | integral term | working set-point | compensator |
/// |---|---|---|---|---|
/// | Off | the configured off value, or held | follows | the measurement if it tracks, else ramps to `r` | runs |
/// | Manual | the manual value, or held | follows | as Off | runs |
/// | Auto | PID + offset + compensator | integrates | ramps to `r` | runs |
/// | Cascade | PID + offset + compensator | integrates | ramps to the remote set-point | runs |
/// | Track | the track value | follows | as Off | runs |
/// | Hold | held where the sample of the change puts it | follows | ramps to `r` | runs |
/// | Fallback | hold, substitute or ramp, as configured | follows | ramps to `r` | runs |
///
/// "Follows": `I = u - pd - u_f - offset`, so that leaving the mode moves nothing. Range and rate limits hold in
/// every mode. Under an ADRC the "integral term" is minus the estimated disturbance: it is observed in every mode, and set
/// where the loop is closed. Fallback cannot be asked for: it is what a loop does without a good measurement.
/// Priority: Off, Track, Fallback, Manual, Hold, then Auto and Cascade.
///
/// ```
/// use controller_core::Mode;
/// assert_eq!(Mode::Auto.in_force(true), Mode::Fallback);
/// assert_eq!(Mode::Track.in_force(true), Mode::Track);
/// assert!(Mode::Cascade.is_automatic());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Mode {
    /// Out of service.
    Off = 0,
    /// The operator gives the output.
    Manual = 1,
    /// The loop is closed on the local set-point.
    #[default]
    Auto = 2,
    /// The loop is closed on the remote set-point.
    Cascade = 3,
    /// Another block gives the output.
    Track = 4,
    /// The output stays where it is.
    Hold = 5,
    /// No good measurement: the configured fallback. Requesting it means [`Mode::Hold`].
    Fallback = 6,
}

impl Mode {
    /// All modes that can be asked for.
    pub const REQUESTS: [Self; 6] =
        [Self::Off, Self::Manual, Self::Auto, Self::Cascade, Self::Track, Self::Hold];

    /// The mode in force when this one is asked for and a fallback is due or not.
    #[must_use]
    pub const fn in_force(self, fallback: bool) -> Self {
        match self {
            Self::Off => Self::Off,
            Self::Track => Self::Track,
            _ if fallback => Self::Fallback,
            Self::Fallback => Self::Hold,
            other => other,
        }
    }

    /// The loop is closed.
    #[must_use]
    pub const fn is_automatic(self) -> bool {
        matches!(self, Self::Auto | Self::Cascade)
    }

    /// The working set-point may follow the measurement (with `sp_track`).
    #[must_use]
    pub const fn releases_setpoint(self) -> bool {
        matches!(self, Self::Off | Self::Manual | Self::Track)
    }

    /// The mode with this number.
    #[must_use]
    pub const fn from_number(n: u8) -> Option<Self> {
        Some(match n {
            0 => Self::Off,
            1 => Self::Manual,
            2 => Self::Auto,
            3 => Self::Cascade,
            4 => Self::Track,
            5 => Self::Hold,
            6 => Self::Fallback,
            _ => return None,
        })
    }

    /// The mode's name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Manual => "manual",
            Self::Auto => "auto",
            Self::Cascade => "cascade",
            Self::Track => "track",
            Self::Hold => "hold",
            Self::Fallback => "fallback",
        }
    }
}
