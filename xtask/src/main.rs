//! The one entry for set-up, tests and checks of this workspace.
//!
//! CI calls it (`.ci/run`) and a person calls it (`cargo xtask ...`), so both run the very same commands. It depends
//! on nothing but the standard library: it must build in a second on a machine that has only just cloned the sources.
//!
//! | module | holds |
//! |---|---|
//! | [`setup`] | components and targets of the pinned toolchain, the tools for fuzzing |
//! | [`browser`] | the browser, Node and packages that the checks of the report pages run with |
//! | [`emulator`] | building images for boards, running them on emulated ones |
//! | [`packages`] | packages of the system |
//! | [`python`] | Python with pinned packages |
//! | [`same_bits`], [`no_panic`], [`swap`] | rungs on and for microcontrollers |
//! | [`ladder`] | running the rungs in order, timing them, the summary |
//! | [`rungs`] | what each rung of the ladder does |
//! | [`report`] | the rung that opens the program's pages in a browser |
//! | [`memory`] | the memory of long runs |
//! | [`pil`] | controllers on emulated boards: the same bits, round trips a second |
//! | [`capi`] | what a C program links: archive, object, symbols, sizes |
//! | [`plc`] | the C interface in LinuxCNC's HAL, in Octave, in the examples |
//! | [`mod@bench`] | the speed of the simulation and of the tuning rules, beside Python |
//! | [`long_runs`] | scenarios of any length for these |
//! | [`board_demo`] | the demo of the firmware, whose log is committed |
//! | [`checks`] | pure checks: dependency allow-list, same bits, file hygiene |
//! | [`failing`] | images that fail on purpose: their exit codes, their outputs off |
//! | [`fuzz`] | bounded and long runs of the fuzz targets |
//! | [`manifest`] | a reader for the few TOML files of this workspace |
//! | [`size`] | what the blocks cost on the emulated boards |
//! | [`shell`] | running commands and printing them |
//! | [`usage`] | what a command used |

mod bench;
mod board_demo;
mod browser;
mod capi;
mod checks;
mod emulator;
mod failing;
mod fuzz;
mod ladder;
mod long_runs;
mod manifest;
mod memory;
mod no_panic;
mod packages;
mod pil;
mod plc;
mod program;
mod python;
mod report;
mod rungs;
mod same_bits;
mod setup;
mod shell;
mod size;
mod swap;
mod usage;

use std::path::Path;
use std::process::ExitCode;

use crate::shell::{Cmd, Outcome, workspace_root};

/// Exit code for a failed check, as `cargo` and most tools have it.
const FAILED: u8 = 1;
/// Exit code for a command line that cannot be understood.
const USAGE: u8 = 2;

/// Minutes of fuzzing in `soak` when `--minutes` is not given.
const SOAK_MINUTES: u64 = 30;

/// One command: its name, what it does in one line, and its options with what each does.
struct Command {
    name: &'static str,
    about: &'static str,
    options: &'static [(&'static str, &'static str)],
}

/// All commands in the order of the help.
const COMMANDS: [Command; 9] = [
    Command {
        name: "setup",
        about: "add what the toolchain lacks, the emulator, C compilers, the browser",
        options: &[
            ("--fuzz", "cargo-fuzz as well (needs a C++ compiler)"),
            ("--plc", "LinuxCNC and Octave as well (150 MB)"),
        ],
    },
    Command {
        name: "test",
        about: "set up, then run the whole ladder of checks up to the first failure",
        options: &[
            ("--keep-going", "run every rung, even after a failure"),
            ("--only RUNG,..", "run only these rungs"),
            ("--list", "say what the rungs are"),
        ],
    },
    Command {
        name: "soak",
        about: "the long runs: tests with SOAK=1, images, 1e8 samples, fuzzing",
        options: &[("--minutes N", "fuzz for N minutes in all (default 30; 0: not at all)")],
    },
    Command {
        name: "bench",
        about: "speed of simulation (fails below 100 times numpy) and tuning rules",
        options: &[],
    },
    Command {
        name: "size",
        about: "instructions, code, RAM, stack on every board; compares the tables",
        options: &[("--update", "write the tables"), ("--markdown", "print the table for people")],
    },
    Command {
        name: "capi",
        about: "archives and objects for C in target/capi; compares the table of sizes",
        options: &[("--update", "write the table")],
    },
    Command { name: "docs", about: "build the documentation; warnings are errors", options: &[] },
    Command { name: "fix", about: "format all sources", options: &[] },
    Command { name: "help", about: "this text", options: &[] },
];

/// Examples below the list of commands.
const EXAMPLES: &str = "\
Examples:
  cargo xtask setup                      once after cloning
  cargo xtask test                       what CI runs
  cargo xtask test --only clippy,demo    two rungs of the ladder
  cargo xtask test --keep-going          every rung, even after a failure
  cargo xtask soak --minutes 120         over lunch

Exit codes: 0 all well, 1 something failed, 2 wrong command line.
";

/// What the command line asks for.
#[derive(Debug, PartialEq, Eq)]
enum Request {
    Help,
    Setup { fuzz: bool, plc: bool },
    Test(ladder::Options),
    ListRungs,
    Soak { minutes: u64 },
    Bench,
    Size(size::Then),
    Capi(capi::Then),
    Docs,
    Fix,
}

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let request = match parse(&args) {
        Ok(request) => request,
        Err(message) => {
            eprintln!("error: {message}\n\nFor the list of commands: cargo xtask --help");
            return ExitCode::from(USAGE);
        }
    };
    match workspace_root().and_then(|root| perform(request, &root)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(FAILED)
        }
    }
}

/// Carries out a request that has been understood.
fn perform(request: Request, root: &Path) -> Outcome {
    match request {
        Request::Help => {
            print!("{}", help());
            Ok(())
        }
        Request::Setup { fuzz, plc } => {
            let mut lacking = setup::toolchain(root)?;
            lacking.extend(emulator::ready(root));
            lacking.extend(capi::ready(root));
            lacking.extend(browser::ready(root)?.err());
            lacking.extend(python::structured_text(root));
            if fuzz {
                lacking.extend(setup::fuzzing(root).err());
            }
            if plc {
                lacking.extend(plc::ready(root));
            }
            if !lacking.is_empty() {
                return Err(format!("set-up is not complete\n{}", lacking.join("\n")));
            }
            println!("set-up complete");
            Ok(())
        }
        Request::Test(options) => ladder::climb(root, &options),
        Request::ListRungs => {
            print!("{}", ladder::list());
            Ok(())
        }
        Request::Soak { minutes } => soak(root, minutes),
        Request::Bench => bench::run(root).and(pil::bench(root)),
        Request::Size(then) => size::run(root, then).map(|remark| println!("{remark}")),
        Request::Capi(then) => capi::run(root, then).map(|remark| println!("{remark}")),
        Request::Docs => rungs::docs(root),
        Request::Fix => Cmd::cargo(root).args(["fmt", "--all"]).run(),
    }
}

/// The long runs, of which the ladder does a bounded share.
fn soak(root: &Path, minutes: u64) -> Outcome {
    // Tests that have a long form read SOAK; without it they do their bounded share.
    Cmd::cargo(root).env("SOAK", "1").args(["test", "--release", "-p", "controller-tests"]).run()?;
    same_bits::soak(root)?;
    swap::soak(root)?;
    pil::soak(root)?;
    let program = program::shipped(root)?;
    memory::soak(&program, &rungs::TempFolder::new("soak")?.0)?;
    if minutes == 0 {
        println!("no fuzzing: --minutes 0");
        return Ok(());
    }
    let targets = fuzz::targets(root)?;
    if let Some(message) = setup::lacking_for_fuzzing(root) {
        return Err(format!("{message} (or leave fuzzing out by --minutes 0)"));
    }
    fuzz::run_all(root, &targets, minutes * 60)
}

/// The text of `cargo xtask` and `cargo xtask --help`.
fn help() -> String {
    let mut text = String::from(
        "Set-up, tests and checks of this workspace.\n\nUsage: cargo xtask COMMAND\n\nCommands:\n",
    );
    for command in &COMMANDS {
        text.push_str(&format!("  {:6} {}\n", command.name, command.about));
        for (option, about) in command.options {
            text.push_str(&format!("           {option:15} {about}\n"));
        }
    }
    text.push('\n');
    text.push_str(EXAMPLES);
    text
}

/// Understands the command line, or says what is wrong with it.
fn parse(args: &[String]) -> Result<Request, String> {
    let Some((command, rest)) = args.split_first() else {
        return Ok(Request::Help);
    };
    if rest.iter().any(|a| a == "--help" || a == "-h") {
        return Ok(Request::Help);
    }
    let mut rest = Words { command, rest: rest.iter() };
    match command.as_str() {
        "help" | "--help" | "-h" => Ok(Request::Help),
        "setup" => {
            let (mut fuzz, mut plc) = (false, false);
            while let Some((option, _)) = rest.option(&["--fuzz", "--plc"])? {
                fuzz |= option == "--fuzz";
                plc |= option == "--plc";
            }
            Ok(Request::Setup { fuzz, plc })
        }
        "test" => parse_test(&mut rest),
        "soak" => {
            let mut minutes = SOAK_MINUTES;
            while let Some((option, value)) = rest.option(&["--minutes"])? {
                let value = rest.value(&option, value)?;
                minutes = value
                    .parse()
                    .ok()
                    // A week is far beyond any use and far below an overflow when turned into seconds.
                    .filter(|&m| m <= 7 * 24 * 60)
                    .ok_or_else(|| {
                        format!("--minutes takes a whole number from 0 to 10080, not `{value}`")
                    })?;
            }
            Ok(Request::Soak { minutes })
        }
        "bench" => rest.option(&[]).map(|_| Request::Bench),
        "size" => {
            let mut then = size::Then::Check;
            while let Some((option, _)) = rest.option(&["--update", "--markdown"])? {
                then = if option == "--update" { size::Then::Update } else { size::Then::Markdown };
            }
            Ok(Request::Size(then))
        }
        "capi" => {
            let update = rest.option(&["--update"])?.is_some();
            while rest.option(&["--update"])?.is_some() {}
            Ok(Request::Capi(if update { capi::Then::Update } else { capi::Then::Check }))
        }
        "docs" => rest.option(&[]).map(|_| Request::Docs),
        "fix" => rest.option(&[]).map(|_| Request::Fix),
        other => Err(unknown("command", other, &COMMANDS.map(|c| c.name))),
    }
}

/// The options of `test`.
fn parse_test(rest: &mut Words<'_>) -> Result<Request, String> {
    let mut options = ladder::Options::default();
    let mut list = false;
    while let Some((option, value)) = rest.option(&["--keep-going", "--only", "--list"])? {
        match option.as_str() {
            "--only" => {
                for name in rest.value(&option, value)?.split(',') {
                    let names = ladder::names();
                    if !names.contains(&name) {
                        return Err(unknown("rung", name, &names));
                    }
                    options.only.push(name.to_string());
                }
            }
            "--keep-going" => options.keep_going = true,
            _ => list = true,
        }
    }
    Ok(if list { Request::ListRungs } else { Request::Test(options) })
}

/// The words after the command, read one option at a time.
struct Words<'a> {
    command: &'a str,
    rest: std::slice::Iter<'a, String>,
}

impl Words<'_> {
    /// The next option and the value glued to it by `=`; an error when it is not one of `known`.
    fn option(&mut self, known: &[&str]) -> Result<Option<(String, Option<String>)>, String> {
        let Some(word) = self.rest.next() else {
            return Ok(None);
        };
        let (option, value) = match word.split_once('=') {
            Some((option, value)) => (option, Some(value.to_string())),
            None => (word.as_str(), None),
        };
        if !known.contains(&option) {
            return Err(unknown(&format!("argument of `{}`", self.command), option, known));
        }
        // Only these two take a value.
        if value.is_some() && !["--only", "--minutes"].contains(&option) {
            return Err(format!("{option} takes no value"));
        }
        Ok(Some((option.to_string(), value)))
    }

    /// The value of an option: glued by `=`, or the next word.
    fn value(&mut self, option: &str, glued: Option<String>) -> Result<String, String> {
        glued.or_else(|| self.rest.next().cloned()).ok_or_else(|| format!("{option} needs a value"))
    }
}

/// The message for a word that is not one of `known`, with the nearest known word if one is near.
fn unknown(kind: &str, word: &str, known: &[&str]) -> String {
    match nearest(word, known) {
        Some(near) => format!("unknown {kind} `{word}`: did you mean `{near}`?"),
        None => format!("unknown {kind} `{word}`"),
    }
}

/// The known word nearest to `word`, if it is near enough to be a slip of the fingers.
fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    known
        .iter()
        .map(|&k| (distance(word, k), k))
        .filter(|&(d, k)| d <= 1 + k.len() / 3)
        .min_by_key(|&(d, _)| d)
        .map(|(_, k)| k)
}

/// Edit distance (insertions, deletions, substitutions).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Result<Request, String> {
        let args: Vec<String> = line.split_whitespace().map(String::from).collect();
        parse(&args)
    }

    #[test]
    fn edit_distance_counts_single_edits() {
        assert_eq!(distance("", ""), 0);
        assert_eq!(distance("test", "test"), 0);
        assert_eq!(distance("tset", "test"), 2);
        assert_eq!(distance("", "soak"), 4);
        assert_eq!(distance("stup", "setup"), 1);
        assert_eq!(distance("kitten", "sitting"), 3);
    }

    #[test]
    fn unknown_words_get_the_nearest_known_word_or_none() {
        assert_eq!(words("tets").unwrap_err(), "unknown command `tets`: did you mean `test`?");
        assert_eq!(words("set-up").unwrap_err(), "unknown command `set-up`: did you mean `setup`?");
        assert_eq!(words("deploy-to-mars").unwrap_err(), "unknown command `deploy-to-mars`");
        assert_eq!(
            words("test --keepgoing").unwrap_err(),
            "unknown argument of `test` `--keepgoing`: did you mean `--keep-going`?"
        );
        assert_eq!(words("test --only clipy").unwrap_err(), "unknown rung `clipy`: did you mean `clippy`?");
    }

    #[test]
    fn command_lines_are_understood() {
        assert_eq!(words(""), Ok(Request::Help));
        assert_eq!(words("--help"), Ok(Request::Help));
        assert_eq!(words("test -h"), Ok(Request::Help));
        assert_eq!(words("setup"), Ok(Request::Setup { fuzz: false, plc: false }));
        assert_eq!(words("setup --fuzz"), Ok(Request::Setup { fuzz: true, plc: false }));
        assert_eq!(words("setup --plc"), Ok(Request::Setup { fuzz: false, plc: true }));
        assert_eq!(words("soak"), Ok(Request::Soak { minutes: SOAK_MINUTES }));
        assert_eq!(words("soak --minutes 5"), Ok(Request::Soak { minutes: 5 }));
        assert_eq!(words("soak --minutes=0"), Ok(Request::Soak { minutes: 0 }));
        assert_eq!(words("bench"), Ok(Request::Bench));
        assert_eq!(words("size"), Ok(Request::Size(size::Then::Check)));
        assert_eq!(words("capi"), Ok(Request::Capi(capi::Then::Check)));
        assert_eq!(words("capi --update"), Ok(Request::Capi(capi::Then::Update)));
        assert_eq!(words("size --update"), Ok(Request::Size(size::Then::Update)));
        let only = vec!["clippy".to_string(), "demo".to_string()];
        let options = ladder::Options { keep_going: true, only };
        assert_eq!(words("test --only clippy,demo --keep-going"), Ok(Request::Test(options)));
        assert_eq!(words("test --list"), Ok(Request::ListRungs));
    }

    #[test]
    fn bad_values_are_refused() {
        assert!(words("soak --minutes").unwrap_err().contains("needs a value"));
        assert!(words("soak --minutes ten").unwrap_err().contains("not `ten`"));
        assert!(words("soak --minutes 99999999999").unwrap_err().contains("10080"));
        assert!(words("setup --fuzz=yes").unwrap_err().contains("takes no value"));
        assert!(words("docs now").unwrap_err().contains("unknown argument of `docs` `now`"));
    }

    #[test]
    fn help_names_every_command() {
        let help = help();
        for command in &COMMANDS {
            assert!(help.contains(command.name) && help.contains(command.about));
        }
        assert!(help.contains(&format!("default {SOAK_MINUTES};")));
        assert!(help.lines().all(|line| line.len() <= 80), "fits a terminal");
    }
}
