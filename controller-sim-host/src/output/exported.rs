//! An exported loop as JSON.

use super::json::text as json;
use super::precision_name;
use crate::export::{Export, Format};
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
    saved: Option<&'a str>,
}

/// What `export` prints with `--json`.
#[must_use]
pub fn exported_json(export: &Export<'_>, format: Format, text: &str, saved: Option<&str>) -> String {
    json(&Exported {
        version: env!("CARGO_PKG_VERSION"),
        controller: export.name(),
        format: format.name(),
        precision: precision_name(export.precision()),
        ts: export.ts(),
        capacity: export.capacity(),
        text,
        saved,
    })
}
