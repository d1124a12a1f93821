//! Plant and model expressions inside the TOML text.

use super::fault::{Fault, code};
use super::log::Log;
use super::table::{Located, Table};
use controller_design::model::{TransferFunction, parse};
use std::ops::Range;

/// Reads the expression `key`; its mistakes are reported at their places inside the quotes.
pub(super) fn read(table: &Table<'_>, key: &'static str) -> Option<Located<TransferFunction>> {
    let text = table.text(key)?;
    match parse(text.value) {
        Ok(value) => Some(Located { value, span: text.span }),
        Err(errors) => {
            for error in errors {
                let span = inside(table.log, &text, error.span);
                let mut fault = Fault::new(code::EXPRESSION, span, error.message);
                fault.help = error.help;
                table.log.fault(fault);
            }
            None
        }
    }
}

/// The place in the document of the bytes `inner` of a text value. A value with escapes or folded lines does
/// not stand in the document as it is: then the whole value.
fn inside(log: &Log<'_>, text: &Located<&str>, inner: Range<usize>) -> Range<usize> {
    let raw = log.slice(&text.span);
    let quotes = if raw.starts_with("\"\"\"") || raw.starts_with("'''") { 3 } else { 1 };
    let newline = match raw.get(quotes..) {
        Some(rest) if quotes == 3 && rest.starts_with("\r\n") => 2,
        Some(rest) if quotes == 3 && rest.starts_with('\n') => 1,
        _ => 0,
    };
    let start = quotes + newline;
    let content = raw.len().checked_sub(quotes).and_then(|end| raw.get(start..end));
    if content == Some(text.value) && !inner.is_empty() {
        let offset = text.span.start + start;
        offset + inner.start..offset + inner.end
    } else {
        text.span.clone()
    }
}
