//! The table of a run, for people: one block per stretch of time, one line per controller.

use super::{Chapter, precision_name};
use crate::pil::{Compared, Difference};
use crate::scenario::Scenario;
use crate::simulate::{EventKind, Metrics, RunResult};

pub(crate) const COLUMNS: [&str; 6] = ["IAE", "ISE", "ITAE", "IE", "e_max", "TV"];
/// Width of a number with its mark.
const CELL: usize = 12;
/// Widest column of names: the table is at most 100 columns wide.
const WIDEST_NAME: usize = 100 - 2 - COLUMNS.len() * CELL;

/// A block of the table.
pub(crate) struct Block<'a> {
    pub(crate) title: String,
    pub(crate) lines: Vec<(&'a str, &'a Metrics)>,
    /// IE adds up errors of both signs: over several events a small one is no merit.
    compares_ie: bool,
}

/// The indices of every controller in every stretch and over the whole run, at most 100 columns wide. Of two
/// or more controllers the best value of each column is marked `*`.
#[must_use]
pub fn run_table(chapter: &Chapter<'_>) -> String {
    let Chapter { scenario, result, .. } = chapter;
    let mut text = String::new();
    if !scenario.title.is_empty() {
        text.push_str(&format!("{}\n", scenario.title));
    }
    text.push_str(&format!(
        "plant {}\nts = {} s, {} s, {}\n",
        plant_text(scenario),
        scenario.ts,
        scenario.duration,
        precision_name(chapter.precision)
    ));
    let names = result.controllers.iter().map(|c| c.name.chars().count()).max().unwrap_or(0);
    let width = names.clamp("controller".len(), WIDEST_NAME);
    for block in blocks(result) {
        text.push_str(&format!("\n{}\n", block.title));
        push_line(&mut text, "controller", width, COLUMNS.map(|column| format!("{column} ")));
        let cells: Vec<[String; 6]> = block.lines.iter().map(|(_, m)| values(m).map(format_number)).collect();
        let best = best(&block);
        for ((name, _), cells) in block.lines.iter().zip(&cells) {
            let mut column = 0;
            let marked = cells.each_ref().map(|cell| {
                let mark = if best[column].as_ref() == Some(cell) { '*' } else { ' ' };
                column += 1;
                format!("{cell}{mark}")
            });
            push_line(&mut text, name, width, marked);
        }
    }
    text.push_str("\nIAE, IE [y s], ISE [y^2 s], ITAE [y s^2], e_max [y], TV [u]");
    text.push_str(if result.controllers.len() > 1 { "; * is the best of its column\n" } else { "\n" });
    text.push_str("IE is the sum over the samples, the others are of the error between the samples, too\n");
    text.push_str(&board(result));
    let remarks: Vec<String> = remarks(result).map(|(name, text)| format!("  {name}: {text}\n")).collect();
    if !remarks.is_empty() {
        text.push_str("\nremarks:\n");
        text.extend(remarks);
    }
    text
}

/// How the controllers compare with those on the board; empty when there was none.
fn board(result: &RunResult) -> String {
    let Some((all, name)) = Compared::all(result) else { return String::new() };
    let Compared { on, samples, differing, first, host_hash, board_hash } = all;
    let head = format!("\non {} ({}, emulated): {samples} samples, ", on.name, on.core);
    let hashes = format!("  hash of all outputs: here {host_hash:016x}, on the board {board_hash:016x}\n");
    let Some(first) = first else { return format!("{head}no bit differs\n{hashes}") };
    let Difference { k, field, host, board } = first;
    let name = name.unwrap_or_default();
    format!(
        "{head}{differing} differ\n{hashes}  first: controller `{name}`, sample {k}, {field}: here {host:#x}, on the board {board:#x}\n"
    )
}

/// Every remark on the run with the name of its controller.
pub(crate) fn remarks(result: &RunResult) -> impl Iterator<Item = (&str, &str)> {
    result.controllers.iter().flat_map(|c| c.remarks.iter().map(|remark| (&*c.name, &*remark.text)))
}

/// A line, without spaces at its end.
fn push_line(text: &mut String, name: &str, width: usize, cells: [String; 6]) {
    let shown: String = if name.chars().count() > width {
        name.chars().take(width - 1).chain(['~']).collect()
    } else {
        name.to_owned()
    };
    let mut line = format!("  {shown:<width$}");
    for cell in cells {
        line.push_str(&format!("{cell:>CELL$}"));
    }
    text.push_str(line.trim_end());
    text.push('\n');
}

/// The stretches in the order of time, those of all controllers together, then the whole run.
pub(crate) fn blocks(result: &RunResult) -> Vec<Block<'_>> {
    let mut starts: Vec<(f64, EventKind)> = Vec::new();
    for stretch in result.controllers.iter().flat_map(|c| &c.events) {
        if !starts.contains(&(stretch.at, stretch.kind)) {
            starts.push((stretch.at, stretch.kind));
        }
    }
    starts.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut blocks: Vec<Block<'_>> = Vec::new();
    for (at, kind) in starts {
        let own = |c: &'_ crate::simulate::ControllerResult| {
            c.events.iter().position(|stretch| stretch.at == at && stretch.kind == kind)
        };
        let lines =
            result.controllers.iter().filter_map(|c| own(c).map(|i| (&*c.name, &c.events[i].metrics)));
        blocks.push(Block { title: title(at, kind), lines: lines.collect(), compares_ie: true });
    }
    if blocks.len() > 1 {
        let lines = result.controllers.iter().map(|c| (&*c.name, &c.total));
        blocks.push(Block { title: "whole run".to_owned(), lines: lines.collect(), compares_ie: false });
    }
    blocks
}

fn title(at: f64, kind: EventKind) -> String {
    let what = match kind {
        EventKind::Start => "start",
        EventKind::Setpoint => "set-point",
        EventKind::Disturbance => "disturbance",
        EventKind::Other => "event",
    };
    format!("{what} at {} s", crate::scenario::show_short(at))
}

pub(crate) fn values(m: &Metrics) -> [f64; 6] {
    [m.iae, m.ise, m.itae, m.ie, m.e_max, m.tv]
}

/// The best number of each column as it is printed, so that equal-looking numbers are marked alike; none for
/// a column with nothing to compare.
pub(crate) fn best(block: &Block<'_>) -> [Option<String>; 6] {
    let mut columns = [const { None }; 6];
    for (column, best) in columns.iter_mut().enumerate() {
        if COLUMNS[column] == "IE" && !block.compares_ie {
            continue;
        }
        let numbers =
            || block.lines.iter().map(|(_, metrics)| values(metrics)[column]).filter(|x| x.is_finite());
        // IE has a sign; the others are sizes already.
        let least = numbers().min_by(|a, b| a.abs().total_cmp(&b.abs())).map(format_number);
        let all_equal = numbers().all(|x| Some(format_number(x)) == least);
        *best = least.filter(|_| !all_equal);
    }
    columns
}

/// The plant of a scenario: its expression, or what it is and its linear model where the run starts.
pub(crate) fn plant_text(scenario: &Scenario) -> String {
    let Some(plant) = &scenario.nonlinear else { return scenario.plant.to_string() };
    let at = crate::scenario::show_short(scenario.initial.setpoint);
    let model = rounded_numbers(&scenario.plant.to_string());
    format!("{}; linear model at {at}: {model}", plant.name())
}

/// An expression with its numbers rounded to six digits: a fitted one has more than anybody reads.
pub(crate) fn rounded_numbers(expression: &str) -> String {
    let mut text = String::new();
    let mut rest = expression;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(start);
        let is_part = |(i, c): (usize, char)| {
            let after_e = i > 0 && number.as_bytes().get(i - 1) == Some(&b'e');
            !(c.is_ascii_digit() || c == '.' || c == 'e' || (after_e && matches!(c, '-' | '+')))
        };
        let end = number.char_indices().find(|&at| is_part(at)).map_or(number.len(), |(i, _)| i);
        // A point at the end is that of the sentence.
        let end = number[..end].trim_end_matches(['.', 'e', '+', '-']).len();
        let (number, after) = number.split_at(end);
        text.push_str(before);
        text.push_str(&number.parse().map_or_else(|_| number.to_owned(), crate::scenario::show_short));
        rest = after;
    }
    text + rest
}

/// Four significant digits.
pub(crate) fn format_number(x: f64) -> String {
    format_digits(x, 4)
}

/// As many significant digits, 1 or more.
pub(crate) fn format_digits(x: f64, digits: u8) -> String {
    if !x.is_finite() {
        return "-".to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    // The exponent after the rounding, which may carry into the next power of ten.
    let most = usize::from(digits.max(1)) - 1;
    let rounded = format!("{x:.most$e}");
    let exponent: i32 = rounded.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    match exponent {
        -4..6 => {
            let after = i32::from(digits.max(1)) - 1 - exponent;
            format!("{x:.after$}", after = usize::try_from(after).unwrap_or(0))
        }
        -99..100 => rounded,
        // An exponent of three digits takes the place of one.
        _ => format!("{x:.less$e}", less = most.saturating_sub(1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_an_expression_are_rounded() {
        let long = "1.39999943690*exp(-5.97606503799*s)/(1+123.006674633*s+3.16461740206e-7*s^2)";
        assert_eq!(rounded_numbers(long), "1.4*exp(-5.97607*s)/(1+123.007*s+3.16462e-7*s^2)");
        let plain = "exp(-0.2*s)/((1+0.2*s)*(1+s)^4)";
        assert_eq!(rounded_numbers(plain), plain);
        assert_eq!(rounded_numbers("from 1.23456789e-5 to 2."), "from 1.23457e-5 to 2.");
    }

    #[test]
    fn numbers_have_four_digits_and_fit_their_cells() {
        let numbers = [0.53204, 12345.6, 1.0, 0.00012346, -2.5, 1e-9, 0.0, f64::NAN];
        let shown = numbers.map(format_number);
        assert_eq!(shown, ["0.5320", "12346", "1.000", "0.0001235", "-2.500", "1.000e-9", "0", "-"]);
        let carried = [0.99996, 9.9996, 99.996, 0.000_099_999, 999_999.9, -0.099_999_9].map(format_number);
        assert_eq!(carried, ["1.000", "10.00", "100.0", "0.0001000", "1.000e6", "-0.1000"]);
        for x in [-1e300, -1.2345e-300, 999_999.9, -0.000_999_99] {
            assert!(format_number(x).len() + 1 < CELL, "{x}");
        }
    }
}
