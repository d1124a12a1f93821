//! Plants drawn around that of a scenario, with its controllers as they are: how robust are these loops?
//!
//! * [`Spread`]: a range as people write it; [`Quantity`]: what is drawn in it.
//! * [`SampleStudy`]: what is asked for. A sample depends on the seed and its number alone.
//! * [`SampleSummary`]: how the indices are distributed, how many loops are unstable, the worst samples.
//! * [`replay`]: a sample as a scenario file.

mod binomial;
mod draw;
mod evaluate;
mod quantity;
mod replay;
mod sketch;
mod spread;
mod study;
mod summary;

pub use binomial::{CONFIDENCE, clopper_pearson};
pub use evaluate::work;
pub use quantity::{NAMES, Quantity, check_name, quantities};
pub use replay::{replay, verify};
pub use sketch::Sketch;
pub use spread::{Distribution, EXAMPLES, Spread};
pub use study::{Drawn, SampleStudy, Seeded, Status};
pub(super) use study::{STATUSES, columns_named};
pub use summary::{Cause, Group, Measure, Reached, SampleSummary, Worst};
