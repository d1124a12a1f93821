//! The plants of a study.
//!
//! A list of one's own is a CSV file with the columns `name`, `plant` and, if wanted, `family`, or a TOML file:
//!
//! ```
//! use controller_sim_host::batch::list::{Format, read};
//!
//! let csv = "name,plant\nheater,1.98*exp(-3.2*s)/(1+80.3*s)\n";
//! let toml = "[[process]]\nname = \"heater\"\nplant = \"1.98*exp(-3.2*s)/(1+80.3*s)\"\n";
//! let [one, other] = [(csv, Format::Csv), (toml, Format::Toml)].map(|(text, format)| read(text, format));
//! assert_eq!(one, other);
//! let one_is_wrong = format!("{csv}other,1.98/(1+80.3*t)\n");
//! let list = read(&one_is_wrong, Format::Csv).expect("the other can be read");
//! assert!(list.plants[0].plant.is_ok() && list.plants[1].plant.is_err());
//! assert_eq!(&one_is_wrong[list.faults[0].span.clone()], "t");
//! ```

mod csv;
mod toml;

use crate::scenario::{Fault, code};
use controller_design::batch134;
use controller_design::model::{TransferFunction, parse};
use std::collections::HashMap;
use std::ops::Range;

/// Longest name of a process or a family, in characters.
const LONGEST: usize = 200;
/// Most plants of a list.
const MOST: usize = 1_000_000;
/// Samples in the shortest time that matters to a loop, and in the sum of all times of the plant.
const IN_DELAY: f64 = 50.0;
const IN_WHOLE: f64 = 200.0;

/// A plant with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPlant {
    /// Its name; no two of a list have the same.
    pub name: String,
    /// What it belongs to; may be empty.
    pub family: String,
    /// As it was written.
    pub expression: String,
    /// What that means, or why it means nothing: its rows say so, those of the others come all the same.
    pub plant: Result<TransferFunction, String>,
}

/// What a file says.
#[derive(Debug, Clone, PartialEq)]
pub struct List {
    /// Its processes in order.
    pub plants: Vec<NamedPlant>,
    /// What is wrong with plants of them, and where.
    pub faults: Vec<Fault>,
}

impl NamedPlant {
    /// The sampling period of `plant` for the noise gains of rules that limit them \[s\]: at most a fiftieth of the dead time
    /// with all lags but the two slowest and all zeros in the right half-plane, at most a two-hundredth of the sum of all
    /// times, of the series 1, 2, 5.
    #[must_use]
    pub fn period(plant: &TransferFunction) -> f64 {
        let times = |roots: Vec<controller_design::model::Complex>| -> Vec<(f64, bool)> {
            let sizes = roots.iter().map(|root| (root.abs(), root.re > 0.0)).filter(|(size, _)| *size > 0.0);
            sizes.map(|(size, is_right)| (size.recip(), is_right)).collect()
        };
        let mut lags: Vec<f64> = times(plant.poles()).into_iter().map(|(time, _)| time).collect();
        lags.sort_by(|a, b| b.total_cmp(a));
        let right = times(plant.zeros()).into_iter().filter(|(_, is_right)| *is_right);
        let hidden = plant.dead_time() + right.map(|(time, _)| time).sum::<f64>();
        let kept = 2_usize.saturating_sub(plant.integrators());
        let delay = hidden + lags.iter().skip(kept).sum::<f64>();
        let whole = hidden + lags.iter().sum::<f64>();
        let wanted = match (delay > 0.0, whole > 0.0) {
            (true, _) => (delay / IN_DELAY).min(whole / IN_WHOLE),
            (false, true) => whole / IN_WHOLE,
            (false, false) => 0.01,
        };
        crate::design_file::round_down(wanted)
    }
}

/// The 134 processes of Tena et al. 2022.
#[must_use]
pub fn ah134() -> Vec<NamedPlant> {
    let named = |process: batch134::Process| {
        let plant = Ok(process.plant().ok()?);
        let batch134::Process { name, family, expression, .. } = process;
        Some(NamedPlant { name, family: family.name.to_owned(), expression, plant })
    };
    batch134::processes().into_iter().filter_map(named).collect()
}

/// How a list is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Columns `name`, `plant`, `family`.
    Csv,
    /// Tables `[[process]]` with these keys.
    Toml,
}

/// Reads a list.
///
/// # Errors
/// All that is wrong with it, in the order of the text, when that is more than plants that mean nothing, or when no plant means
/// anything; an empty list is wrong, too.
pub fn read(text: &str, format: Format) -> Result<List, Vec<Fault>> {
    let mut faults = Vec::new();
    let entries = match format {
        Format::Csv => csv::entries(text, &mut faults),
        Format::Toml => toml::entries(text, &mut faults),
    };
    if entries.is_empty() && faults.is_empty() {
        let help = "give it a line or a table for each process: name and plant";
        faults.push(Fault::new(code::MISSING_KEY, 0..0, "the list has no process").help(help));
    }
    if entries.len() > MOST {
        let message = format!("the list has {} processes; at most {MOST} are allowed", entries.len());
        faults.push(Fault::new(code::TOO_LARGE, entries[MOST].name.span.clone(), message));
        return Err(faults);
    }
    let List { plants, faults: of_plants } = named(entries, &mut faults);
    if faults.is_empty() && plants.iter().any(|plant| plant.plant.is_ok()) {
        return Ok(List { plants, faults: of_plants });
    }
    faults.extend(of_plants);
    faults.sort_by_key(|fault| fault.span.start);
    Err(faults)
}

/// A text and where it stands.
#[derive(Debug, Clone)]
struct Cell {
    value: String,
    span: Range<usize>,
    /// Where its first character stands, when it stands in the text as it is.
    inside: Option<usize>,
}

/// A process that may still be wrong.
struct Entry {
    name: Cell,
    plant: Cell,
    family: Option<Cell>,
}

fn named(entries: Vec<Entry>, faults: &mut Vec<Fault>) -> List {
    let mut known: HashMap<String, Range<usize>> = HashMap::new();
    let mut plants = Vec::with_capacity(entries.len());
    let mut of_plants = Vec::new();
    for Entry { name, plant, family } in entries {
        for (what, cell) in [("name", Some(&name)), ("family", family.as_ref())] {
            let Some(cell) = cell else { continue };
            let is_short = cell.value.chars().count() <= LONGEST && !cell.value.contains(char::is_control);
            let is_there = what != "name" || !cell.value.is_empty();
            if !(is_short && is_there) {
                let message = format!("`{what}` must be 1 to {LONGEST} characters on one line");
                faults.push(Fault::new(code::OUT_OF_RANGE, cell.span.clone(), message));
            }
        }
        if let Some(first) = known.get(&name.value) {
            let message = format!("the name `{}` is there twice", name.value);
            let fault =
                Fault::new(code::DUPLICATE, name.span.clone(), message).help("give one of them another name");
            faults.push(fault.related(first.clone(), "the first one"));
        } else {
            known.insert(name.value.clone(), name.span.clone());
        }
        let found = parse(&plant.value).map_err(|errors| {
            let why: Vec<&str> = errors.iter().map(|error| &*error.message).collect();
            let why = format!("the plant means nothing: {}", why.join("; "));
            of_plants.extend(errors.iter().map(|error| {
                let at = |from: usize| from + error.span.start..from + error.span.end;
                let span = plant.inside.map_or(plant.span.clone(), at);
                Fault {
                    help: error.help.clone(),
                    ..Fault::new(code::EXPRESSION, span, error.message.clone())
                }
            }));
            why
        });
        let family = family.map_or_else(String::new, |cell| cell.value);
        plants.push(NamedPlant { name: name.value, family, expression: plant.value, plant: found });
    }
    List { plants, faults: of_plants }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_period_follows_what_a_loop_cannot_hasten() {
        let of = |text: &str| {
            let plant = parse(text).expect("a plant");
            NamedPlant::period(&plant)
        };
        // A fiftieth of the dead time; of the two lags that are left; a two-hundredth of the whole.
        let texts =
            ["exp(-s)/(1+1000*s)", "1/((1+s)*(1+0.005*s)^2)", "exp(-s)/(1+0.02*s)", "1/((1+s)*(1+0.2*s))"];
        assert_eq!(texts.map(of), [0.02, 1e-4, 0.005, 0.005]);
        assert_eq!(["exp(-s)/s", "2/s", "1e-3/(1+1e6*s)"].map(of), [0.005, 0.01, 5000.0]);
    }

    #[test]
    fn every_fault_is_told_at_its_place() {
        let text = "name;plant;family\na;1/(1+s;x\n\na;1/(1+s)^2;x\n;1/s;y\nb\n\"c\";\"exp(-s)*q\"\n";
        let faults = read(text, Format::Csv).expect_err("faults");
        let lines: Vec<usize> =
            faults.iter().map(|fault| 1 + text[..fault.span.start].matches('\n').count()).collect();
        assert_eq!(lines, [2, 4, 5, 6, 7], "{faults:?}");
        let text =
            "[[process]]\nname = \"a\"\n[[process]]\nname = \"b\"\nplant = \"1/(1+t)\"\nplan = 1\n[more]\n";
        let faults = read(text, Format::Toml).expect_err("faults");
        let lines: Vec<usize> =
            faults.iter().map(|fault| 1 + text[..fault.span.start].matches('\n').count()).collect();
        assert_eq!(lines, [1, 5, 6, 7], "{faults:?}");
        for (text, format) in
            [("", Format::Csv), ("name,plant\n", Format::Csv), ("", Format::Toml), ("# no\n", Format::Toml)]
        {
            assert_eq!(read(text, format).expect_err("empty").len(), 1, "{text:?}");
        }
        assert!(read("plant\n1/s\n", Format::Csv).expect_err("no name")[0].message.contains("`name`"));
    }
}
