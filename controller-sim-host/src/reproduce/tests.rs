use super::*;
use crate::simulate::Control;

fn all_cells() -> impl Iterator<Item = (&'static Definition, Cell)> {
    definitions().flat_map(|one| data::cells(one.cells).into_iter().map(move |cell| (one, cell)))
}

/// A line that is not one would be left out without a word.
#[test]
fn every_line_of_the_data_is_a_cell() {
    for one in definitions() {
        let lines = csv::ReaderBuilder::new().from_reader(one.cells.as_bytes()).into_records().count();
        assert_eq!(data::cells(one.cells).len(), lines, "{} {}", one.paper.name(), one.name);
        assert!(lines > 0);
    }
}

#[test]
fn no_cell_is_there_twice() {
    for one in definitions() {
        let cells = data::cells(one.cells);
        for (i, cell) in cells.iter().enumerate() {
            let same = |other: &Cell| other.row == cell.row && other.quantity == cell.quantity;
            assert!(
                !cells[..i].iter().any(same),
                "{} {}: {} {}",
                one.paper.name(),
                one.name,
                cell.row,
                cell.quantity
            );
        }
    }
}

/// Half a unit of the last printed digit, and a little for numbers that lie just between two.
fn rounds_to(truth: f64, printed: &str) -> Option<bool> {
    let number: f64 = printed.parse().ok()?;
    let digits = printed.split_once('.').map_or(0, |(_, after)| after.len());
    let unit = 10.0_f64.powi(-i32::try_from(digits).ok()?);
    Some((truth - number).abs() <= 0.501 * unit)
}

/// `as printed` says that every digit is right, the other verdicts that it is not so or not by itself.
#[test]
fn verdicts_agree_with_the_digits() {
    for (one, cell) in all_cells() {
        let (Some(printed), Some(truth)) = (&cell.printed, cell.truth) else { continue };
        let Some(rounds) = rounds_to(truth, printed) else { continue };
        let name = format!("{} {}: {cell:?}", one.paper.name(), one.name);
        match cell.verdict {
            Verdict::AsPrinted => assert!(rounds, "{name}"),
            Verdict::Rounding | Verdict::Misprint => assert!(!rounds, "{name}"),
            _ => {}
        }
        assert!(cell.verdict != Verdict::NotPrinted, "{name}");
    }
}

#[test]
fn what_differs_from_print_has_a_reason() {
    for (one, cell) in all_cells() {
        if matches!(cell.verdict, Verdict::AsPrinted | Verdict::NotPrinted) {
            continue;
        }
        assert!(!cell.reason.is_empty(), "{} {}: {cell:?}", one.paper.name(), one.name);
    }
}

/// Ours is true in every cell of a paper, each number has its cell, and each cell its number. Gives the verdicts.
fn check(paper: Paper) -> Vec<(usize, &'static str)> {
    let control = Control::new();
    let bench = Bench::new(&control);
    let mut tables = Vec::new();
    for one in definitions().filter(|one| one.paper == paper) {
        let (table, values) = one.computed(&bench).expect("not stopped");
        let name = format!("{} {}", paper.name(), one.name);
        assert_eq!(table.trouble, None, "{name}");
        assert_eq!(values.left().next(), None, "{name}");
        let differing: Vec<&Cell> = table.cells.iter().filter(|cell| cell.differs()).collect();
        assert!(differing.is_empty(), "{name}: {differing:#?}");
        tables.push(table);
    }
    let report = Report { tables };
    assert_eq!(report.differing(), 0);
    Verdict::ALL
        .iter()
        .map(|verdict| (report.count(*verdict), verdict.words()))
        .filter(|(n, _)| *n > 0)
        .collect()
}

#[test]
fn ours_is_true_in_the_chapter_of_the_estimator() {
    let expected = [
        (206, "as printed"),
        (9, "rounding"),
        (13, "misprint"),
        (15, "not converged"),
        (8, "other settings"),
        (4, "false claim"),
        (1, "not reproducible"),
        (18, "not printed"),
    ];
    assert_eq!(check(Paper::De), expected);
}

#[test]
fn ours_is_true_in_the_paper_of_the_observer() {
    let expected = [
        (182, "as printed"),
        (27, "rounding"),
        (5, "misprint"),
        (24, "not the optimum"),
        (59, "other settings"),
        (24, "false claim"),
        (45, "not reproducible"),
        (64, "not printed"),
    ];
    assert_eq!(check(Paper::Dob), expected);
}

#[test]
fn ours_is_true_in_the_paper_of_the_pi() {
    let expected = [
        (25, "as printed"),
        (9, "rounding"),
        (4, "misprint"),
        (5, "other settings"),
        (4, "false claim"),
        (2, "not reproducible"),
        (121, "not printed"),
    ];
    assert_eq!(check(Paper::Pi), expected);
}

#[test]
fn a_wrong_truth_is_found() {
    let selection = Selection { paper: Some(Paper::De), table: Some("1".to_owned()) };
    let mut report = reproduce(&selection, &Control::new()).expect("not stopped");
    assert_eq!(report.differing(), 0);
    let truth = &mut report.tables[0].cells[3].truth;
    *truth = truth.map(|x| x * (1.0 + 1e-9));
    assert_eq!(report.differing(), 1);
    report.tables[0].cells[0].ours = None;
    assert_eq!(report.differing(), 2);
}

#[test]
fn selections() {
    let count_of = |paper, table: Option<&str>| count(&Selection { paper, table: table.map(str::to_owned) });
    assert_eq!(count_of(None, None), 24);
    assert_eq!(count_of(None, Some("5")), 2);
    assert_eq!(count_of(Some(Paper::Pi), Some("RATIOS")), 1);
    let none = Selection { paper: Some(Paper::Pi), table: Some("5".to_owned()) };
    assert_eq!(reproduce(&none, &Control::new()), Err(ReproduceError::NoTable));
    let control = Control::new();
    control.stop();
    let one = Selection { paper: Some(Paper::De), table: Some("8".to_owned()) };
    assert_eq!(reproduce(&one, &control), Err(ReproduceError::Stopped));
}
