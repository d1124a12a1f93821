//! Many plants by many rules: each loop designed, its responses computed, a row for each.
//!
//! * [`list`]: the plants, built in or from a file.
//! * [`Study`]: what is asked for; its rows stand in one order, whoever computes them.
//! * [`Row`]: what comes of one rule on one plant.
//! * [`store`]: rows in files: streamed, resumed, merged.
//! * [`Summary`]: what the rows come to.

mod digest;
mod evaluate;
pub mod list;
mod reader;
mod responses;
mod row;
pub mod store;
mod study;
mod summary;
mod work;

pub use reader::RowReader;
pub use row::{COLUMNS, Column, Kind, Row, Status};
pub use study::{Point, Shard, Study};
pub use summary::{Cause, Group, Ratio, Summary};
pub use work::{Stopped, work};
