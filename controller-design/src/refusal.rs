//! Why there is no design: never a number that looks valid.

use core::fmt;

/// The reason why a rule has no result for a plant or a wish, and what would help.
///
/// `Display` gives one line without a full stop; [`help`](Self::help) what to change.
///
/// ```
/// use controller_design::Refusal;
/// let refusal = Refusal::Unattainable { what: "the noise gain kpidn", asked: 2.0, least: 2.6 };
/// assert_eq!(refusal.to_string(), "the noise gain kpidn cannot be 2: the least attainable is 2.6");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// The plant is not of a kind the rule is for.
    Plant {
        /// What the rule needs, after "the plant must".
        must: &'static str,
        /// What to do instead.
        help: &'static str,
    },
    /// A parameter of the request is outside its range.
    OutOfRange {
        /// The parameter, by its name in files and on the command line.
        parameter: &'static str,
        /// What was given.
        value: f64,
        /// Least allowed value.
        min: f64,
        /// Largest allowed value.
        max: f64,
    },
    /// A wish that no parameter can fulfil for this plant.
    Unattainable {
        /// What was wished for.
        what: &'static str,
        /// The wish.
        asked: f64,
        /// The least value that can be had.
        least: f64,
    },
    /// The equations of the rule have no solution that controls this plant.
    NoSolution {
        /// Why.
        why: &'static str,
        /// What to do instead.
        help: &'static str,
    },
    /// Recorded data from which nothing can be concluded.
    Data {
        /// Why.
        why: &'static str,
        /// What to do instead.
        help: &'static str,
    },
}

impl Refusal {
    /// What would help.
    #[must_use]
    pub const fn help(&self) -> &'static str {
        match self {
            Self::Plant { help, .. } | Self::NoSolution { help, .. } | Self::Data { help, .. } => help,
            Self::OutOfRange { .. } => "choose a value in the range",
            Self::Unattainable { .. } => "ask for more than the least attainable value",
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plant { must, .. } => write!(f, "the plant must {must}"),
            Self::OutOfRange { parameter, value, min, max } => {
                write!(f, "{parameter} = {value} is outside the range {min} to {max}")
            }
            Self::Unattainable { what, asked, least } => {
                write!(f, "{what} cannot be {}: the least attainable is {}", Short(*asked), Short(*least))
            }
            Self::NoSolution { why, .. } | Self::Data { why, .. } => f.write_str(why),
        }
    }
}

/// A number with as many digits as a message needs.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0;
        let size = if x < 0.0 { -x } else { x };
        // A whole or short number as it was written, a computed one rounded up to four digits behind the point.
        if x == libm::round(x * 1e4) / 1e4 && size < 1e6 {
            write!(f, "{x}")
        } else if (1e-2..1e6).contains(&size) {
            write!(f, "{}", libm::ceil(x * 1e4) / 1e4)
        } else {
            write!(f, "{x:.4e}")
        }
    }
}

impl core::error::Error for Refusal {}
