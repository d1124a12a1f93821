//! What a run and its mistakes look like: tables for people, JSON for programs, CSV files, messages with
//! carets.

mod csv;
mod faults;
mod file;
mod json;
pub(crate) mod table;

pub use csv::write_csv;
pub use faults::{Problem, Severity, render};
pub use file::{FileError, FileTarget, is_same_file};
pub use json::{error_json, run_json};
pub use table::run_table;

use crate::scenario::Fault;
use crate::simulate::Precision;

/// A scenario's text with the name it goes by in messages.
#[derive(Debug, Clone, Copy)]
pub struct Source<'a> {
    /// File name, or what else to call it.
    pub name: &'a str,
    /// The text.
    pub text: &'a str,
}

/// How a precision is written: `f32` or `f64`.
#[must_use]
pub fn precision_name(precision: Precision) -> &'static str {
    match precision {
        Precision::F32 => "f32",
        Precision::F64 => "f64",
    }
}

/// The number of faults in words.
fn count(faults: &[Fault]) -> String {
    match faults.len() {
        1 => "1 fault".to_owned(),
        n => format!("{n} faults"),
    }
}
