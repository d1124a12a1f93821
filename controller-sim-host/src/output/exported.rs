//! An exported loop as JSON.

use super::json::{Place, places, text as json};
use super::{Problem, Source, precision_name};
use crate::export::{Export, Format};
use crate::scenario::Fault;
use serde::Serialize;

#[derive(Serialize)]
struct Exported<'a> {
    version: &'static str,
    controller: &'a str,
    format: &'static str,
    precision: &'static str,
    ts: f64,
    capacity: usize,
    text: &'a str,
    warnings: Vec<Place<'a>>,
    saved: Option<&'a str>,
}

/// What there is to know about an exported loop.
#[derive(Debug, Clone, Copy)]
pub struct ExportWarnings<'a> {
    /// The text of the scenario.
    pub source: Source<'a>,
    /// The warnings of the scenario that are about this loop or about all.
    pub remarks: &'a [Fault],
    /// Those of the export itself.
    pub own: &'a [Problem],
}

/// What `export` prints with `--json`.
#[must_use]
pub fn exported_json(
    export: &Export<'_>,
    format: Format,
    text: &str,
    saved: Option<&str>,
    warnings: &ExportWarnings<'_>,
) -> String {
    let own = warnings.own.iter().map(|p| Place::nowhere(p.code, &*p.message, p.help.as_deref()));
    let warnings = places(warnings.source.name, warnings.source.text, warnings.remarks).chain(own).collect();
    json(&Exported {
        version: env!("CARGO_PKG_VERSION"),
        controller: export.name(),
        format: format.name(),
        precision: precision_name(export.precision()),
        ts: export.ts(),
        capacity: export.capacity(),
        text,
        warnings,
        saved,
    })
}
