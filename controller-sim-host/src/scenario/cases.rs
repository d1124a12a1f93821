//! All cases of a scenario.

use super::fault::Fault;
use super::files::Files;
use super::library::Library;
use super::read::{Input, read_one};
use super::{Read, Scenario};
use crate::simulate::Precision;

/// What a text says: the scenario, or one for each value of a sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadAll {
    /// At least one, in the order of the values.
    pub cases: Vec<Case>,
    /// What can be run but is probably not meant, in the order of the text.
    pub warnings: Vec<Fault>,
}

/// One case of a sweep, or the only one.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The key that is swept and its value, such as `latency = 0.1`; none without a sweep.
    pub label: Option<String>,
    /// What is run.
    pub scenario: Scenario,
}

/// Reads the scenario `text` for runs in `precision`, with all files it names, and all of its cases. `name` is what
/// messages call it.
///
/// # Errors
/// As for [`read`](super::read); those inside an included file have its text as their [source](Fault::source).
pub fn read_with(
    name: &str,
    text: &str,
    precision: Precision,
    files: &dyn Files,
) -> Result<ReadAll, Vec<Fault>> {
    let _ = name;
    let library = Library::new(files);
    let input = Input { text, replaced: None, precision, library: &library, takes_sweep: false };
    let Read { scenario, warnings } = read_one(&input)?;
    Ok(ReadAll { cases: vec![Case { label: None, scenario }], warnings })
}
