//! What the blocks cost on the emulated boards: instructions, code, RAM, stack; the committed tables and their check.
//!
//! | module | holds |
//! |---|---|
//! | [`measure`] | building and running the meter's images, reading what they print |
//! | [`budget`] | what a step may cost |
//! | [`table`] | the committed table |
//! | [`markdown`] | the table for people |
//! | [`peers`] | other controllers beside ours, in that table and in the README |

mod budget;
mod markdown;
mod measure;
mod peers;
mod table;

use std::path::{Path, PathBuf};

use crate::emulator;
use crate::ladder::Done;
use crate::shell::{Cmd, Outcome};

/// The table for people.
const PAGE: &str = "controller-firmware/COSTS.md";

/// The part of the table that is built into the program `controller-sim`, for loop cards.
const CARD: &str = "controller-sim-host/src/card/costs.csv";

/// Where the comparison with other controllers is shown, and the lines that begin and end it there.
const README: &str = "README.md";
const BEGIN: &str = "<!-- costs: written by cargo xtask size --update -->\n";
const END: &str = "<!-- end of costs -->\n";

/// What to do with what is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Then {
    /// Print it and compare it with the committed tables.
    Check,
    /// Write the tables.
    Update,
    /// Print the table for people, and nothing else.
    Markdown,
}

/// Measures, then does what is asked for.
pub(crate) fn run(root: &Path, then: Then) -> Outcome<String> {
    let version = Cmd::new("rustc", root).arg("--version").capture()?;
    let version = version.trim();
    let number = version.split_whitespace().nth(1).ok_or_else(|| format!("what version is `{version}`?"))?;
    let rows = measure::all(root)?;
    let (text, page) = (table::text(&rows, version), markdown::page(&rows, version));
    let readme = readme(root, &peers::table(&rows))?;
    let card = table::csv(&rows);
    let tables: [(PathBuf, &str); 4] = [
        (Path::new("tests/target").join(format!("size-{number}.txt")), &text),
        (PAGE.into(), &page),
        (README.into(), &readme),
        (CARD.into(), &card),
    ];
    match then {
        Then::Markdown => print!("{page}"),
        Then::Update => {
            for (path, text) in &tables {
                let full = root.join(path);
                full.parent()
                    .map_or(Ok(()), std::fs::create_dir_all)
                    .map_err(|e| format!("{}: {e}", path.display()))?;
                std::fs::write(full, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
                println!("{} written", path.display());
            }
        }
        Then::Check => {
            print!("{text}");
            if !root.join(&tables[0].0).is_file() {
                return Err(format!("there is no table for {version}: cargo xtask size --update writes one"));
            }
            for (path, text) in &tables {
                let committed = std::fs::read_to_string(root.join(path)).unwrap_or_default();
                if committed != *text {
                    let difference = table::difference(&committed, text);
                    return Err(format!(
                        "{difference}{} says something else; if that is meant: cargo xtask size --update",
                        path.display()
                    ));
                }
            }
        }
    }
    budget::check(&rows)?;
    Ok(format!("{} blocks as in the table", rows.len()))
}

/// The README with `table` in its place.
fn readme(root: &Path, table: &str) -> Outcome<String> {
    let now = std::fs::read_to_string(root.join(README)).map_err(|e| format!("{README}: {e}"))?;
    let parts = now.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1)));
    let (before, after) = parts.ok_or_else(|| format!("{README} has no place for the costs: {BEGIN}"))?;
    Ok(format!("{before}{BEGIN}\n{table}\n{END}{after}"))
}

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    if let Some(end) = emulator::lacking(root)? {
        return Ok(end);
    }
    run(root, Then::Check).map(Done::Passed)
}
