//! The ladder: rungs in order from cheap to dear, each timed, with a summary at the end.
//!
//! What a rung does stands in [`crate::rungs`]; this module knows only how to run them one after the other and how to
//! report. A rung that cannot run here is skipped by name and with its reason, never silently; one that was not asked
//! for is left out.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::rungs::RUNGS;
use crate::shell::{Outcome, human};

/// One rung of the ladder.
pub(crate) struct Rung {
    /// Name on the command line and in the summary.
    pub(crate) name: &'static str,
    /// What it shows, in one line.
    pub(crate) about: &'static str,
    /// Does it.
    pub(crate) run: fn(&Path) -> Outcome<Done>,
}

/// Minutes that the whole ladder may take on two cores.
const LIMIT_MINUTES: u64 = 40;

/// How a rung ended that found no fault in the sources.
#[derive(Debug)]
pub(crate) enum Done {
    /// It holds; a remark may say what was looked at.
    Passed(String),
    /// It failed because the machine lacks something, said with the command to run. The rungs above it run all the
    /// same: this says nothing about the sources.
    Lacking(String),
    /// It could not run here, for this reason.
    Skipped(String),
}

impl Done {
    /// Passed, and there is nothing to add.
    pub(crate) fn passed() -> Outcome<Self> {
        Ok(Self::Passed(String::new()))
    }
}

/// How `cargo xtask test` was called.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Options {
    /// Run the rungs above a failed one as well.
    pub(crate) keep_going: bool,
    /// Run only these; empty: all.
    pub(crate) only: Vec<String>,
}

impl Options {
    /// Whether a rung was asked for.
    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|asked| asked == name)
    }
}

/// A line of the summary.
struct Line {
    /// Place on the ladder, from 1.
    number: usize,
    name: &'static str,
    end: End,
    time: Duration,
}

/// How a rung ended.
enum End {
    Passed(String),
    Skipped(String),
    Failed(String),
    NotReached,
}

impl End {
    /// The word in the summary and the remark behind it.
    fn parts(&self) -> (&'static str, &str) {
        match self {
            Self::Passed(remark) => ("passed", remark),
            Self::Skipped(reason) => ("skipped", reason),
            Self::Failed(message) => ("FAILED", message),
            Self::NotReached => ("not run", "an earlier rung failed"),
        }
    }
}

/// The names of all rungs.
pub(crate) fn names() -> Vec<&'static str> {
    RUNGS.iter().map(|rung| rung.name).collect()
}

/// The text of `cargo xtask test --list`.
pub(crate) fn list() -> String {
    let width = RUNGS.iter().map(|rung| rung.name.len()).max().unwrap_or(0);
    RUNGS
        .iter()
        .enumerate()
        .map(|(at, rung)| format!("{:>2}  {:width$}  {}\n", at + 1, rung.name, rung.about))
        .collect()
}

/// Runs the rungs and prints the summary; an error when one failed.
pub(crate) fn climb(root: &Path, options: &Options) -> Outcome {
    let start = Instant::now();
    let lines = run(&RUNGS, root, options);
    print!("{}", summary(&lines, start.elapsed()));
    let failed: Vec<&str> =
        lines.iter().filter(|l| matches!(l.end, End::Failed(_))).map(|l| l.name).collect();
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
}

fn run(rungs: &[Rung], root: &Path, options: &Options) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut stop = false;
    for (number, rung) in (1..).zip(rungs).filter(|(_, rung)| options.wants(rung.name)) {
        let start = Instant::now();
        let end = if stop {
            End::NotReached
        } else {
            println!("\nrung {number}/{} {}: {}", rungs.len(), rung.name, rung.about);
            let end = match (rung.run)(root) {
                Ok(Done::Passed(remark)) => End::Passed(remark),
                Ok(Done::Skipped(reason)) => End::Skipped(reason),
                Ok(Done::Lacking(message)) => End::Failed(message),
                Err(message) => {
                    stop = !options.keep_going;
                    End::Failed(message)
                }
            };
            let (word, remark) = end.parts();
            println!("  {word} in {}{}", human(start.elapsed()), after(remark, ": "));
            end
        };
        lines.push(Line { number, name: rung.name, end, time: start.elapsed() });
    }
    lines
}

fn summary(lines: &[Line], total: Duration) -> String {
    let width = lines.iter().map(|line| line.name.len()).max().unwrap_or(0);
    let mut text = String::from("\nSummary\n");
    for line in lines {
        let (word, remark) = line.end.parts();
        let time = match line.end {
            End::Passed(_) | End::Failed(_) => human(line.time),
            End::Skipped(_) | End::NotReached => "-".into(),
        };
        // The whole message stands where the rung failed; one line of it is enough here.
        let remark = after(remark.lines().next().unwrap_or_default(), "  ");
        text.push_str(&format!("  {:>2}  {:width$}  {word:7}  {time:>12}{remark}\n", line.number, line.name));
    }
    let count = |wanted: &str| lines.iter().filter(|line| line.end.parts().0 == wanted).count();
    text.push_str(&format!(
        "{} passed, {} failed, {} skipped, {} not run\ntotal time {} (at most {LIMIT_MINUTES} min on two cores)\n",
        count("passed"),
        count("FAILED"),
        count("skipped"),
        count("not run"),
        human(total)
    ));
    text
}

/// The text behind a separator, or nothing when there is no text.
fn after(text: &str, separator: &str) -> String {
    if text.is_empty() { String::new() } else { format!("{separator}{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> [Rung; 4] {
        [
            Rung { name: "good", about: "", run: |_| Done::passed() },
            Rung { name: "absent", about: "", run: |_| Ok(Done::Skipped("no tool".into())) },
            Rung { name: "bad", about: "", run: |_| Err("broke\nat length".into()) },
            Rung { name: "late", about: "", run: |_| Ok(Done::Passed("7 lines".into())) },
        ]
    }

    fn words(lines: &[Line]) -> Vec<&'static str> {
        lines.iter().map(|line| line.end.parts().0).collect()
    }

    #[test]
    fn stops_at_the_first_failure() {
        let lines = run(&sample(), Path::new("."), &Options::default());
        assert_eq!(words(&lines), ["passed", "skipped", "FAILED", "not run"]);
    }

    #[test]
    fn keeps_going_when_told() {
        let options = Options { keep_going: true, only: Vec::new() };
        let lines = run(&sample(), Path::new("."), &options);
        assert_eq!(words(&lines), ["passed", "skipped", "FAILED", "passed"]);
    }

    #[test]
    fn runs_only_what_is_asked_for() {
        let options = Options { keep_going: false, only: vec!["late".into()] };
        let lines = run(&sample(), Path::new("."), &options);
        assert_eq!(words(&lines), ["passed"]);
        assert_eq!((lines[0].number, lines[0].name), (4, "late"));
    }

    #[test]
    fn what_the_machine_lacks_fails_one_rung_only() {
        let [good, .., late] = sample();
        let lacking = Rung { name: "lacking", about: "", run: |_| Ok(Done::Lacking("run: this".into())) };
        let lines = run(&[good, lacking, late], Path::new("."), &Options::default());
        assert_eq!(words(&lines), ["passed", "FAILED", "passed"]);
    }

    #[test]
    fn summary_lines_up_and_names_the_reasons() {
        let line = |number, name, end, ms| Line { number, name, end, time: Duration::from_millis(ms) };
        let lines = [
            line(1, "good", End::Passed(String::new()), 1_234),
            line(2, "absent", End::Skipped("no tool".into()), 1),
            line(3, "bad", End::Failed("broke\nat length".into()), 245_000),
            line(7, "late", End::NotReached, 0),
        ];
        let expected = "\nSummary
   1  good    passed          1.2 s
   2  absent  skipped             -  no tool
   3  bad     FAILED     4 min 05 s  broke
   7  late    not run             -  an earlier rung failed
1 passed, 1 failed, 1 skipped, 1 not run
total time 4 min 06 s (at most 40 min on two cores)
";
        assert_eq!(summary(&lines, Duration::from_secs(246)), expected);
    }

    #[test]
    fn names_are_unique_and_listed() {
        let mut all = names();
        let list = list();
        assert!(all.iter().all(|name| list.contains(name)));
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), RUNGS.len());
    }
}
