//! Maps: one rule on a grid of two parameters, of the plant or of the rule, and what comes of it at each point.
//!
//! * [`Template`]: the plant, with letters for numbers.
//! * [`Axis`]: a [`Parameter`] and its values.
//! * [`MapStudy`]: what is asked for; its rows are those of any study, kept by [`store`](super::store).
//! * [`Metric`]: a column that is drawn, perhaps over that of another rule at the same point.
//! * [`MapValues`]: what the rows come to.

mod axis;
mod digest;
mod metric;
mod parameter;
mod study;
mod template;
mod values;

pub use axis::Axis;
pub use metric::Metric;
pub use parameter::{Parameter, Setting};
pub use study::{MapFault, MapStudy};
pub use template::Template;
pub use values::{MapValues, Panel};
