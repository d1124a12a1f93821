//! Many plants: by many rules, each loop designed and its responses computed; or around one, with a loop that stays. A row for
//! each.
//!
//! * [`list`]: the plants, built in or from a file.
//! * [`Study`]: what is asked for; its rows stand in one order, whoever computes them.
//! * [`Row`]: what comes of one rule on one plant.
//! * [`map`]: a rule on a grid of two parameters.
//! * [`sample`]: the plants around that of a scenario, drawn by chance.
//! * [`store`]: rows in files: streamed, resumed, merged.
//! * [`Summary`]: what the rows come to.

mod digest;
mod evaluate;
mod layout;
pub mod list;
pub mod map;
mod reader;
mod responses;
mod row;
pub mod sample;
pub mod store;
mod study;
mod summary;
mod work;

pub(crate) use layout::show;
pub use layout::{About, Cells, Column, Kind, Layout};
pub use reader::RowReader;
pub use row::{COLUMNS, Row, Status};
pub use study::{Point, Shard, Study};
pub use summary::{Cause, Group, Ratio, Summary};
pub use work::{Stopped, work};
