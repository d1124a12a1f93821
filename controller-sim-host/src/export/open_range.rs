//! Ranges that a design has left at their defaults, which no actuator and no transmitter has.

use controller_core::ControllerConfig;

/// A range of a loop with a default bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OpenRange {
    /// That of the output \[u\].
    Output(f64, f64),
    /// That of valid measurements \[y\].
    Measurement(f64, f64),
}

impl OpenRange {
    /// The ranges of `config` of which at least one bound is the default.
    pub(super) fn of(config: &ControllerConfig) -> Vec<Self> {
        let default = ControllerConfig::default();
        let mut open = Vec::new();
        let (limits, none) = (config.limits, default.limits);
        if limits.lo == none.lo || limits.hi == none.hi {
            open.push(Self::Output(limits.lo, limits.hi));
        }
        let (lo, hi) = (config.measurement_lo, config.measurement_hi);
        if lo == default.measurement_lo || hi == default.measurement_hi {
            open.push(Self::Measurement(lo, hi));
        }
        open
    }

    /// The key of the controller that gives the range.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::Output(..) => "limits",
            Self::Measurement(..) => "measurement",
        }
    }

    /// What it means for the block; one line without a full stop.
    #[must_use]
    pub fn meaning(&self) -> String {
        match self {
            Self::Output(lo, hi) => format!("OP may be anything from {lo:?} to {hi:?}"),
            Self::Measurement(lo, hi) => {
                format!("a PV from {lo:?} to {hi:?} counts as good, also that of a broken sensor")
            }
        }
    }

    /// What to write; one line without a full stop.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::Output(..) => {
                "write the range of the actuator in its `[[controller]]`: `limits = { lo = 0.0, hi = 100.0 }`"
            }
            Self::Measurement(..) => {
                "write the range of the transmitter in its `[[controller]]`: `measurement = { lo = 0.0, hi = 100.0 }`"
            }
        }
    }

    /// Lines for the head of a file.
    pub(super) fn warning(&self) -> [String; 2] {
        let what = match self {
            Self::Output(..) => "actuator",
            Self::Measurement(..) => "transmitter",
        };
        [
            format!("WARNING: {}.", self.meaning()),
            format!(
                "  Write the range of the {what} in the design file, key {} with lo and hi; export again.",
                self.key()
            ),
        ]
    }
}
