//! The memory of a run does not grow with its length.

use std::path::Path;

use crate::long_runs::LongRun;
use crate::shell::{Cmd, Outcome};
use crate::usage::{Usage, measured};

/// Samples of the run that the others are compared with.
const SHORT: u64 = 100_000;
/// Samples in the ladder.
const LADDER: u64 = 10_000_000;
/// Samples in the soak.
const SOAK: u64 = 100_000_000;

/// Events in every run, however long: each gives a line in the results.
const EVENTS: u64 = 20;

/// Most memory of a run \[kB\].
const MOST: u64 = 64 << 10;
/// How far the memory of a long run may exceed that of the short one \[%\] ..
const MORE: u64 = 10;
/// .. and besides: the system counts pages in lumps, for each processor its own. One byte kept of each sample of the
/// ladder's run would be five times as much \[kB\].
const LUMPS: u64 = 2 << 10;

// One byte kept of each sample would be found.
const _: () = assert!(LADDER / 1024 > 4 * LUMPS && SOAK > LADDER);

/// What the program is asked for.
struct Form {
    name: &'static str,
    args: &'static [&'static str],
}

/// Figures alone, and figures with a page.
const FORMS: [Form; 2] = [
    Form { name: "figures", args: &["--json", "--quiet", "--substeps", "1"] },
    Form {
        name: "report",
        args: &["--json", "--quiet", "--substeps", "1", "--force", "--report", "memory.html"],
    },
];

/// The share of the ladder; a remark for the summary. `None` where memory cannot be measured.
pub(crate) fn ladder(program: &Path, folder: &Path) -> Outcome<Option<String>> {
    if cfg!(all(target_os = "linux", target_pointer_width = "64")) {
        bounded(program, folder, LADDER).map(Some)
    } else {
        println!("memory is measured on 64-bit Linux only");
        Ok(None)
    }
}

/// The long run.
pub(crate) fn soak(program: &Path, folder: &Path) -> Outcome<String> {
    bounded(program, folder, SOAK)
}

/// Runs a short scenario and one of `samples` samples in every form and compares their memory.
fn bounded(program: &Path, folder: &Path, samples: u64) -> Outcome<String> {
    let mut remarks = Vec::new();
    for form in &FORMS {
        let short = run(program, folder, form, SHORT)?;
        let long = run(program, folder, form, samples)?;
        #[allow(clippy::cast_precision_loss)] // for people
        let rate = samples as f64 / long.cpu.as_secs_f64() / 1e6;
        let remark = format!(
            "{}: {} kB with {SHORT} samples, {} kB with {samples} ({rate:.1} million samples/s)",
            form.name, short.peak, long.peak
        );
        println!("  {remark}");
        judge(short, long).map_err(|fault| format!("{fault}\n{remark}"))?;
        remarks.push(remark);
    }
    Ok(remarks.join("; "))
}

fn run(program: &Path, folder: &Path, form: &Form, samples: u64) -> Outcome<Usage> {
    let name = format!("memory-{samples}.toml");
    let path = folder.join(&name);
    let text = LongRun { samples, every: samples / EVENTS, noise: false }.text();
    std::fs::write(&path, text).map_err(|e| format!("cannot write {}: {e}", path.display()))?;
    // The limit keeps a run that does grow from taking all the memory of the machine.
    let limited = format!("ulimit -d {} && exec \"$@\"", 2 * MOST);
    let shell = Cmd::new("sh", folder).args(["-c", &limited, "sh"]);
    measured(&shell.arg(program).args(["run", &name]).args(form.args))
}

/// Compares a long run with a short one.
fn judge(short: Usage, long: Usage) -> Outcome {
    if long.peak > MOST {
        Err(format!("a long run takes {} kB; allowed: {MOST} kB", long.peak))
    } else if long.peak > short.peak + short.peak * MORE / 100 + LUMPS {
        Err(format!("memory grows with the length: {} kB, then {} kB", short.peak, long.peak))
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn growth_and_excess_are_faults() {
        let usage = |peak| Usage { cpu: Duration::ZERO, peak };
        assert!(judge(usage(10_000), usage(11_000 + LUMPS)).is_ok());
        assert!(judge(usage(10_000), usage(9_000)).is_ok());
        assert!(judge(usage(10_000), usage(11_001 + LUMPS)).unwrap_err().contains("grows"));
        assert!(judge(usage(60_000), usage(MOST + 1)).unwrap_err().contains("allowed"));
    }
}
