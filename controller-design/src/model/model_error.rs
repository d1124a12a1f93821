//! Why a transfer function, or a plant model made from it, is refused.

use core::fmt;

use super::complex::Complex;
use super::number::rounded;

/// A transfer function that cannot be built, or that the run-time blocks cannot take as a plant model.
///
/// ```
/// use controller_design::model::{ModelError, TransferFunction};
/// let refused = TransferFunction::first_order(1.0, 2.0, -0.5);
/// assert_eq!(refused, Err(ModelError::NegativeDeadTime { dead_time: -0.5 }));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ModelError {
    /// A parameter is NaN or infinite.
    NotFinite {
        /// The parameter's name.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A computed coefficient is too large or too small for double precision.
    OutOfRange,
    /// The function is zero at every `s`.
    ZeroGain,
    /// The denominator is zero at every `s`.
    ZeroDenominator,
    /// The dead time is negative.
    NegativeDeadTime {
        /// The dead time in seconds.
        dead_time: f64,
    },
    /// More zeros than poles.
    Improper {
        /// Number of zeros.
        zeros: usize,
        /// Number of poles.
        poles: usize,
    },
    /// The order is above what is allowed.
    OrderTooHigh {
        /// The order: the larger of the numbers of poles and zeros.
        order: usize,
        /// The largest order allowed here.
        max: usize,
    },
    /// A plant model without any pole.
    StaticGain,
    /// A plant model with zeros at `s = 0`.
    ZeroAtOrigin {
        /// How many there are.
        count: usize,
    },
    /// A plant model with a pole in the closed right half-plane, other than at `s = 0`.
    Unstable {
        /// The pole in rad/s.
        pole: Complex,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { what, value } => write!(f, "{what} is {value}; it must be a finite number"),
            Self::OutOfRange => f.write_str(
                "a coefficient is too large or too small; allowed are sizes from 2.3e-308 to 1.7e308",
            ),
            Self::ZeroGain => f.write_str("the transfer function is zero; its gain must not be 0"),
            Self::ZeroDenominator => {
                f.write_str("the denominator is zero; it must have a coefficient that is not 0")
            }
            Self::NegativeDeadTime { dead_time } => {
                write!(
                    f,
                    "a dead time cannot be negative; it is {} s, allowed is 0 s or more",
                    rounded(dead_time)
                )
            }
            Self::Improper { zeros, poles } => write!(
                f,
                "more zeros than poles: the numerator has order {zeros}, the denominator {poles}; allowed are \
                 at most as many zeros as poles"
            ),
            Self::OrderTooHigh { order, max } => write!(f, "the order is {order}; allowed are at most {max}"),
            Self::StaticGain => {
                f.write_str("a static gain has no dynamics; a plant model needs an order of at least 1")
            }
            Self::ZeroAtOrigin { count } => write!(
                f,
                "{count} at s = 0; a plant model has none, as its gain at s = 0 would be 0",
                count = if count == 1 { String::from("1 zero") } else { format!("{count} zeros") }
            ),
            Self::Unstable { pole } => write!(
                f,
                "the pole at s = {} is not stable; in a plant model every pole has a negative real part or is \
                 at s = 0",
                Complex::new(rounded_value(pole.re), rounded_value(pole.im))
            ),
        }
    }
}

/// The value nearest to what [`rounded`] prints.
fn rounded_value(value: f64) -> f64 {
    rounded(value).parse().unwrap_or(value)
}

impl core::error::Error for ModelError {}
