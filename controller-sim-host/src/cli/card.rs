//! Loop cards on the command line: saved, and held against a loop.

use super::Failure;
use super::arguments::Number;
use super::export::chosen;
use super::input;
use crate::card::{CardFile, LoopCard, Request, check, loop_card};
use crate::output::{Analysed, Checked, Problem, Trouble, precision_name};
use crate::scenario::{SourceText, closest};
use controller_pil::board::named;
use std::path::Path;

/// A card that a loop is held against.
pub(super) struct Held {
    path: String,
    file: CardFile,
}

/// Reads the card at `path`.
pub(super) fn read_card(path: &Path) -> Result<Held, Trouble> {
    if path.as_os_str() == "-" {
        let problem = Problem::new("file", "`--check -` is not possible: a card is a file beside the loop's");
        return Err(problem.help("give a file: `--check card.toml`").into());
    }
    let (path, text) = input::read_card(path)?;
    match CardFile::read(&text) {
        Ok(file) => Ok(Held { path, file }),
        Err(faults) => Err(Trouble::Scenario(SourceText { name: path, text }, faults)),
    }
}

/// What cards are made for: what was asked for, else what the card says.
pub(super) fn request(
    precision: Option<Number>,
    board: Option<&str>,
    held: Option<&Held>,
) -> Result<Request, Problem> {
    let usual = Request::default();
    let asked = Request {
        precision: precision.map_or(usual.precision, Into::into),
        board: board.and_then(named).unwrap_or(usual.board),
    };
    let Some(Held { path, file }) = held else { return Ok(asked) };
    let differs = |option: &str, asked: &str, saved: &str| {
        let message = format!("`{option} {asked}` is not what `{path}` was saved with, {saved}");
        Problem::new("usage", message).help(format!("leave `{option}` out, or save another card with it"))
    };
    if precision.is_some() && asked.precision != file.precision {
        let names = [asked.precision, file.precision].map(precision_name);
        return Err(differs("--precision", names[0], names[1]));
    }
    if board.is_some() && asked.board != file.board {
        return Err(differs("--board", asked.board.name, file.board.name));
    }
    Ok(Request { precision: file.precision, board: file.board })
}

/// That a card is of one loop.
fn several() -> Problem {
    Problem::new("usage", "a file with a sweep is many loops, and a card is of one")
        .help("take `[sweep]` out and set its value by `--set`")
}

/// The card of the controller `index`, made if it is not there yet.
fn made(one: &Analysed<'_>, index: usize, request: Request) -> Result<LoopCard, Failure> {
    let card = one.cards.get(index).cloned().unwrap_or_else(|| loop_card(one.scenario, index, request));
    card.map_err(|why| {
        let name = one.scenario.controllers.get(index).map_or("", |spec| spec.name.trim());
        Failure::refused(Problem::new("refused", format!("no loop card of {name}: {why}")))
    })
}

/// The text of the card of the only controller, or of the one that is called `name`.
pub(super) fn save(
    analysed: &[Analysed<'_>],
    name: Option<&str>,
    request: Request,
    command: &str,
) -> Result<String, Failure> {
    let [one] = analysed else { return Err(several().into()) };
    let list = &one.scenario.controllers;
    let spec = chosen(list, name)?;
    let index = list.iter().position(|other| std::ptr::eq(other, spec)).unwrap_or(0);
    Ok(CardFile::text(&made(one, index, request)?, command))
}

impl Held {
    /// Holds the loop against the card.
    pub(super) fn hold(&self, analysed: &mut [Analysed<'_>], request: Request) -> Result<(), Failure> {
        let [one] = analysed else { return Err(several().into()) };
        let names: Vec<&str> = one.scenario.controllers.iter().map(|spec| spec.name.trim()).collect();
        let Some(index) = names.iter().position(|name| *name == self.file.controller) else {
            let message = format!(
                "`{}` is the card of `{}`, which is not in the file",
                self.path, self.file.controller
            );
            let help = match closest(&self.file.controller, &names) {
                Some(near) => {
                    format!("if it is now called `{near}`, write that after `controller =` in the card")
                }
                None => format!("there are {}", names.join(", ")),
            };
            return Err(Problem::new("usage", message).help(help).into());
        };
        let card = made(one, index, request)?;
        one.checked = Some(Checked { path: self.path.clone(), check: check(&self.file, &card) });
        Ok(())
    }
}
