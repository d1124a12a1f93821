//! What a run and its mistakes look like: tables for people, JSON for programs, CSV files, messages with
//! carets.

#![doc = include_str!("json.md")]

mod advice;
pub(crate) mod analysis;
mod assessment;
mod batched;
pub(crate) mod card;
mod csv;
mod design;
mod design_json;
mod draft;
mod exported;
mod faults;
mod figures;
mod file;
mod identification;
mod json;
mod mapped;
mod parquet;
mod reproduced;
pub(crate) mod sampled;
mod samples;
pub(crate) mod table;
mod tuning;

pub use self::parquet::ParquetWriter;
pub use advice::{advice_json, advice_table};
pub use analysis::{Analysed, analysis_json, analysis_table};
pub use assessment::{assessment_json, assessment_table};
pub use batched::{Batched, batch_json, batch_table};
pub use card::{Checked, card_table, check_table};
pub use csv::CsvWriter;
pub use design::design_table;
pub use design_json::design_json;
pub use draft::{Complete, Draft, publish, remove_drafts};
pub use exported::{ExportWarnings, exported_json};
pub use faults::{Problem, Severity, Trouble, render, render_all};
pub use figures::{drawn_json, figures_json, figures_table, sheet_csv};
pub use file::{FileError, FileTarget, is_same_file};
pub use identification::{Identification, identify_json, identify_table};
pub use json::{SCHEMA, Written, error_json, list_json, run_json, saved_json, text_json, written_json};
pub use mapped::{Mapped, map_json, map_table};
pub use reproduced::{reproduced_json, reproduced_table};
pub use sampled::{Sampled, sample_json, sample_table};
pub use samples::{Columns, SampleFiles};
pub use table::run_table;
pub use tuning::{Tuning, tune_json, tune_table};

use crate::report::Chapter;
use crate::scenario::{Fault, SourceText};
use crate::simulate::Precision;

/// A scenario's text with the name it goes by in messages.
#[derive(Debug, Clone, Copy)]
pub struct Source<'a> {
    /// File name, or what else to call it.
    pub name: &'a str,
    /// The text.
    pub text: &'a str,
}

impl<'a> From<&'a SourceText> for Source<'a> {
    fn from(source: &'a SourceText) -> Self {
        Self { name: &source.name, text: &source.text }
    }
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
