//! Frequency responses: where to look, and how to find peaks and crossings exactly.

mod features;
mod peaks;
mod response;

pub(crate) use features::{Features, MAX_POINTS, ascending};
pub(crate) use peaks::{crossing, maximum};
pub(crate) use response::{Response, polynomial, turn};
