//! A row as a line.

use crate::batch::layout::Cells;

/// Adds the line of a row, with its end. A cell with a separator, a quote, or a space at an end stands in quotes.
pub(super) fn push_line(to: &mut String, row: &Cells) {
    for (i, cell) in row.all().iter().enumerate() {
        if i > 0 {
            to.push(',');
        }
        if cell.contains([',', '"', ';', '\n', '\r']) || cell.trim() != cell {
            to.push('"');
            to.push_str(&cell.replace('"', "\"\""));
            to.push('"');
        } else {
            to.push_str(cell);
        }
    }
    to.push('\n');
}
