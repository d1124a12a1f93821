//! The keys of the run that stand above the first table.

use super::fault::{Fault, code};
use super::include::Roots;
use super::number::{Allowed, show_short};
use super::read::VERSION;
use super::table::{Located, Table};
use super::trial::{LONGEST_DELAY, delay_fault};

/// Most samples of a run.
const MOST_SAMPLES: f64 = 1e9;

/// What the run is measured by.
#[derive(Debug)]
pub(super) struct Run {
    pub(super) ts: Option<Located<f64>>,
    pub(super) duration: Option<f64>,
    pub(super) latency: Option<Located<f64>>,
    /// The latency alone is too long, and that was reported.
    pub(super) latency_is_long: bool,
    pub(super) substeps: usize,
}

/// Reads them.
pub(super) fn read(roots: &Roots<'_>) -> Run {
    roots.all().for_each(version);
    let example = "the sampling period in seconds: `ts = 0.01`";
    let ts = required(roots.of("ts"), "ts", Allowed::new(1e-9, 1e9, "s"), example);
    let example = "the length of the run in seconds: `duration = 20.0`";
    let duration = required(roots.of("duration"), "duration", Allowed::TIME, example);
    let latency = roots.of("latency").number_in("latency", Allowed::new(0.0, 1e12, "s"));
    let substeps = roots.of("substeps").integer_in("substeps", 1, 1000).map_or(10, |n| n.value);
    check_length(&roots.own, ts.as_ref(), duration.as_ref());
    let latency_is_long = check_latency(&roots.own, ts.as_ref(), latency.as_ref());
    Run {
        ts,
        duration: duration.map(|duration| duration.value),
        latency,
        latency_is_long,
        substeps: usize::try_from(substeps).unwrap_or(1),
    }
}

/// The first thing a reader of a text must know.
fn version(root: &Table<'_>) {
    if root.span("version").is_none() {
        root.missing("version", "`version = 1` on the first line");
        return;
    }
    let Some(version) = root.integer_in("version", 0, u64::MAX) else { return };
    if version.value != VERSION {
        let message = format!(
            "`version = {}` is not known; this program reads version {VERSION}",
            root.log.slice(&version.span)
        );
        root.log.fault(
            Fault::new(code::NOT_SUPPORTED, version.span, message)
                .help(format!("write `version = {VERSION}`")),
        );
    }
}

fn required(root: &Table<'_>, key: &'static str, allowed: Allowed, example: &str) -> Option<Located<f64>> {
    if root.span(key).is_none() {
        root.missing(key, example);
    }
    root.number_in(key, allowed)
}

/// The run must have a sample, and not more than anyone waits for.
fn check_length(root: &Table<'_>, ts: Option<&Located<f64>>, duration: Option<&Located<f64>>) {
    let (Some(ts), Some(duration)) = (ts, duration) else { return };
    let samples = duration.value / ts.value;
    let [length, period] = [&duration.span, &ts.span].map(|span| root.log.slice(span));
    let fault = if samples > MOST_SAMPLES {
        let message = format!(
            "`duration = {length}` is {} samples of {period} s; allowed: at most {MOST_SAMPLES:e}",
            show_short(samples)
        );
        Fault::new(code::TOO_LARGE, duration.span.clone(), message)
            .help("choose a longer `ts` or a shorter run")
    } else if samples < 1.0 - 1e-9 {
        let message =
            format!("`duration = {length}` is shorter than one sample; allowed: `ts`, {period} s, or more");
        Fault::new(code::OUT_OF_RANGE, duration.span.clone(), message)
    } else {
        return;
    };
    root.log.fault(fault.related(ts.span.clone(), "the sampling period"));
}

/// The latency alone must not be too long; whether it is.
fn check_latency(root: &Table<'_>, ts: Option<&Located<f64>>, latency: Option<&Located<f64>>) -> bool {
    let (Some(ts), Some(latency)) = (ts, latency) else { return false };
    let samples = latency.value / ts.value;
    if samples <= LONGEST_DELAY {
        return false;
    }
    let what = format!("`latency = {}` is", root.log.slice(&latency.span));
    root.log.fault(delay_fault(&what, samples, latency.span.clone()));
    true
}
