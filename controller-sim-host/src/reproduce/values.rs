//! What this library gives for the cells of a table.

use std::collections::BTreeMap;

/// Numbers by row and quantity.
#[derive(Debug, Default)]
pub(super) struct Values {
    found: BTreeMap<(String, String), f64>,
}

impl Values {
    /// The number of a cell.
    pub(super) fn put(&mut self, row: &str, quantity: &str, value: f64) {
        self.found.insert((row.to_owned(), quantity.to_owned()), value);
    }

    /// Several numbers of one row.
    pub(super) fn row<const N: usize>(&mut self, row: &str, cells: [(&str, f64); N]) {
        for (quantity, value) in cells {
            self.put(row, quantity, value);
        }
    }

    /// Whether something is true, as 1 or 0.
    pub(super) fn yes(&mut self, row: &str, quantity: &str, value: bool) {
        self.put(row, quantity, if value { 1.0 } else { 0.0 });
    }

    /// Takes the number of a cell out.
    pub(super) fn take(&mut self, row: &str, quantity: &str) -> Option<f64> {
        self.found.remove(&(row.to_owned(), quantity.to_owned()))
    }

    /// What belongs to no cell.
    #[cfg(test)]
    pub(super) fn left(&self) -> impl Iterator<Item = &(String, String)> {
        self.found.keys()
    }
}
