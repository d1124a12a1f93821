//! The cells of the tables as they are kept: one line each, with what is printed, what is true, and the verdict.

use super::cell::{Cell, Tolerance, Verdict};
use csv::ReaderBuilder;

/// Reads the cells of a table: row, quantity, printed, true, tolerance (`rel 1e-6` or `abs 0.01`), verdict, reason.
///
/// A line that is not one is left out; a test shows that there is none.
pub(super) fn cells(text: &str) -> Vec<Cell> {
    ReaderBuilder::new().from_reader(text.as_bytes()).records().filter_map(|line| cell(&line.ok()?)).collect()
}

fn cell(line: &csv::StringRecord) -> Option<Cell> {
    let [row, quantity, printed, truth, tolerance, verdict, reason] =
        [0, 1, 2, 3, 4, 5, 6].map(|i| line.get(i).unwrap_or_default());
    let truth = optional(truth, |text| text.parse().ok())?;
    let tolerance = optional(tolerance, self::tolerance)?;
    if truth.is_some() != tolerance.is_some() {
        return None;
    }
    Some(Cell {
        row: row.to_owned(),
        quantity: quantity.to_owned(),
        printed: (!printed.is_empty()).then(|| printed.to_owned()),
        truth,
        tolerance,
        ours: None,
        verdict: Verdict::from_words(verdict)?,
        reason: reason.to_owned(),
    })
}

/// Nothing for an empty text; `None` for one that is wrong.
fn optional<T>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<Option<T>> {
    if text.is_empty() { Some(None) } else { read(text).map(Some) }
}

fn tolerance(text: &str) -> Option<Tolerance> {
    match text.split_once(' ')? {
        ("rel", part) => part.parse().ok().map(Tolerance::Relative),
        ("abs", size) => size.parse().ok().map(Tolerance::Absolute),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "row,quantity,printed,true,tolerance,verdict,reason\n";

    #[test]
    fn a_line_is_a_cell() {
        let all = cells(&format!("{HEAD}GP1,A2,4.13,4.125,rel 1e-12,as printed,\"half, up\"\n"));
        let [one] = &*all else { panic!("{all:?}") };
        assert_eq!((&*one.row, &*one.quantity, one.printed.as_deref()), ("GP1", "A2", Some("4.13")));
        assert_eq!((one.truth, one.tolerance), (Some(4.125), Some(Tolerance::Relative(1e-12))));
        assert_eq!((one.verdict, &*one.reason, one.ours), (Verdict::AsPrinted, "half, up", None));
    }

    #[test]
    fn what_is_no_cell_is_left_out() {
        for line in [
            "GP1,A2,4.13,4.125x,rel 1,as printed,",
            "GP1,A2,4.13,4.125,1e-12,as printed,",
            "GP1,A2,4.13,4.125,,as printed,",
            "GP1,A2,4.13,,rel 1,as printed,",
            "GP1,A2,4.13,4.125,rel 1,good,",
        ] {
            assert_eq!(cells(&format!("{HEAD}{line}\n")), [], "{line}");
        }
    }
}
