//! What a person should know about a design that was made all the same.

use core::fmt;

/// Room for everything one design can be warned about.
pub const MAX_WARNINGS: usize = 16;

/// The warnings of a design, in the order they were found.
pub type Warnings = heapless::Vec<Warning, MAX_WARNINGS>;

/// Something a person should know about a design. `Display` gives one line without a full stop.
///
/// ```
/// use controller_design::Warning;
/// let warning = Warning::Text { about: "kfd", text: "the estimator is off" };
/// assert_eq!(warning.to_string(), "kfd: the estimator is off");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A fixed text.
    Text {
        /// The parameter or quantity it is about, by its name in files.
        about: &'static str,
        /// What about it.
        text: &'static str,
    },
    /// A value that is worth saying.
    Value {
        /// The parameter or quantity it is about, by its name in files.
        about: &'static str,
        /// Its value.
        value: f64,
        /// What about it.
        text: &'static str,
    },
    /// A value beyond what the rule was made for.
    OutsideValidity {
        /// The quantity, such as `dead_time/tau`.
        about: &'static str,
        /// Its value.
        value: f64,
        /// Least value the rule is good for.
        min: f64,
        /// Largest value the rule is good for.
        max: f64,
        /// What happens outside.
        text: &'static str,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text { about, text } => write!(f, "{about}: {text}"),
            Self::Value { about, value, text } => write!(f, "{about} = {value:.4}: {text}"),
            Self::OutsideValidity { about, value, min, max, text } => {
                write!(f, "{about} = {value:.4} is outside {min} to {max}: {text}")
            }
        }
    }
}

/// Adds a warning; beyond [`MAX_WARNINGS`] it is dropped.
pub(crate) fn warn(warnings: &mut Warnings, warning: Warning) {
    let _ = warnings.push(warning);
}
