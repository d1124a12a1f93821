//! Plant models: expressions in `s`, polynomials, transfer functions with dead time.
//!
//! [`parse`] reads a plant the way people write it. The result, a [`TransferFunction`], keeps the factors that
//! were written: `(1+s)^4` is four factors `1+s`, not a polynomial whose roots have to be found again with the
//! loss of accuracy that multiple roots bring. Only a polynomial of degree above 2 that was written out in full
//! is factored numerically, and only when its poles or a `PlantModel` are asked for.
//!
//! ```
//! use controller_design::model::parse;
//!
//! let plant = parse("exp(-s)/((1+s)*(1+0.5*s)^2)").expect("a valid plant");
//! assert_eq!(plant.order(), 3);
//! assert_eq!(plant.dead_time(), 1.0);
//! assert_eq!(plant.poles()[1].re, -2.0);
//!
//! let errors = parse("2s/(1+s").expect_err("two mistakes");
//! assert_eq!(errors.len(), 2);
//! assert_eq!(errors[0].span, 0..2);
//! assert_eq!(errors[0].help.as_deref(), Some("write `2*s`"));
//! ```

mod clusters;
mod complex;
mod correction;
mod double_double;
mod error;
mod expression;
mod factored;
mod factorise;
mod half_rule;
mod model_error;
mod number;
mod polynomial;
mod quadratic;
mod roots;
mod simple;
mod transfer_function;

pub use complex::Complex;
pub use error::ExpressionError;
pub use expression::{MAX_ERRORS, MAX_EXPONENT, MAX_LENGTH, MAX_NESTING, parse};
pub use factored::MAX_DEGREE;
pub use half_rule::{HalfRule, Keep, half_rule};
pub use model_error::ModelError;
pub use polynomial::Polynomial;
pub use simple::{Fopdt, Ipdt, Sopdt};
pub use transfer_function::TransferFunction;
