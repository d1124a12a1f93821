//! What samples come to, for people and for programs.

use super::json::text;
use super::table::{format_number, rounded_numbers};
use crate::batch::sample::{CONFIDENCE, Cause, Group, Measure, SampleStudy, SampleSummary};
use crate::simulate::{EventKind, Precision};
use serde::Serialize;
use std::fmt::Write;

/// A study of samples that was done, or a part of one.
#[derive(Debug)]
pub struct Sampled<'a> {
    /// What its rows carry.
    pub study: &'a str,
    /// Number of rows, those kept from an earlier run included.
    pub rows: usize,
    /// Rows kept from an earlier run.
    pub kept: usize,
    /// What they come to.
    pub summary: &'a SampleSummary,
    /// What was drawn; `None`: the rows were joined, and the files do not say it.
    pub of: Option<&'a SampleStudy>,
    /// What is probably not meant.
    pub warnings: &'a [String],
    /// The file they are in.
    pub out: Option<&'a str>,
    /// The worst samples as scenarios: number of the sample and the file.
    pub worst: &'a [(usize, String)],
    /// The page.
    pub report: Option<&'a str>,
}

impl<'a> Sampled<'a> {
    /// Rows and what they come to, nothing else.
    #[must_use]
    pub const fn of(study: &'a str, rows: usize, summary: &'a SampleSummary) -> Self {
        Self { study, rows, kept: 0, summary, of: None, warnings: &[], out: None, worst: &[], report: None }
    }

    /// The first line: how many rows there are, and what became of them.
    pub(crate) fn counts(&self) -> String {
        let [stable, unstable, refused, failed] = self.summary.counts();
        format!(
            "{} rows: {stable} stable, {unstable} unstable, {refused} refused, {failed} failed",
            self.rows
        )
    }
}

/// The share of unstable loops in words.
pub(crate) fn share(group: &Group) -> String {
    let [stable, unstable, ..] = group.counts;
    match group.unstable_share() {
        None => "no loop that is known to be stable or not".to_owned(),
        Some([share, lo, hi]) => format!(
            "{unstable} of {} loops unstable: {} %, {:.0} % interval {} to {} % (Clopper-Pearson)",
            stable + unstable,
            format_number(100.0 * share),
            100.0 * CONFIDENCE,
            format_number(100.0 * lo),
            format_number(100.0 * hi)
        ),
    }
}

/// Heads of the columns of [`statistics`].
pub(crate) const HEADS: [&str; 7] = ["min", "5 %", "50 %", "95 %", "max", "mean", "worst"];

/// Least, quantiles, largest and mean of a measure; nothing of one without values.
pub(crate) fn statistics(measure: &Measure) -> Option<[f64; 6]> {
    let sketch = &measure.sketch;
    let [low, middle, high] = [0.05, 0.5, 0.95].map(|share| sketch.quantile(share));
    Some([sketch.min()?, low?, middle?, high?, sketch.max()?, sketch.mean()?])
}

/// What an event is, such as `set-point at 10 s`.
pub(crate) fn events(study: &SampleStudy) -> Vec<String> {
    let windows = study.windows().iter();
    let of = |(at, kind): &(f64, EventKind)| {
        let labels =
            study.scenario.events.iter().filter(|event| event.at == *at).map(|event| event.label.trim());
        let what = labels.filter(|label| !label.is_empty()).map(str::to_owned).next().unwrap_or_else(|| {
            match kind {
                EventKind::Start => "start",
                EventKind::Setpoint => "set-point",
                EventKind::Disturbance => "disturbance",
                EventKind::Other => "event",
            }
            .to_owned()
        });
        format!("{what} at {} s", format_number(*at))
    };
    windows.map(of).collect()
}

/// The study as text: what was drawn, and for each controller the share of unstable loops and how its indices are distributed.
#[must_use]
pub fn sample_table(made: &Sampled<'_>) -> String {
    let mut out = made.counts() + "\n";
    let mut line = |content: &str| {
        // Writing to a text cannot fail.
        let _ = writeln!(out, "{}", content.trim_end());
    };
    if let Some(study) = made.of {
        line("");
        let drawn = &study.drawn;
        let plant = rounded_numbers(&study.scenario.plant.to_string());
        line(&format!("{} samples from the seed {} around {plant}", drawn.samples, drawn.seed));
        for quantity in &drawn.quantities {
            let (from, to) = quantity.ends;
            line(&format!(
                "  {:<20} {:>9}  from {:>9} to {:>9}  {}",
                quantity.name,
                if quantity.nominal.is_finite() { format_number(quantity.nominal) } else { "-".to_owned() },
                format_number(from),
                format_number(to),
                quantity.spread.distribution.name()
            ));
        }
        if study.has_noise() {
            line("  noise: its own seed in each sample");
        }
        for (i, event) in events(study).iter().enumerate() {
            line(&format!("  e{}: {event}", i + 1));
        }
    }
    for warning in made.warnings {
        line(&format!("warning: {warning}"));
    }
    for group in made.summary.groups() {
        line("");
        line(&format!("{}: {}", group.controller, share(group)));
        let head: String = HEADS.iter().map(|head| format!("{head:>11}")).collect();
        line(&format!("  {:<14}{head}", "stable loops"));
        for measure in &group.measures {
            let Some(numbers) = statistics(measure) else { continue };
            let numbers: String = numbers.iter().map(|x| format!("{:>11}", format_number(*x))).collect();
            let worst = measure.worst.map_or(String::new(), |worst| format!("#{}", worst.sample));
            line(&format!("  {:<14}{numbers}{worst:>11}", measure.name));
        }
        if let Some(worst) = group.unstable {
            line(&format!("  of the unstable loops #{} has the largest IAE", worst.sample));
        }
    }
    let causes = made.summary.causes();
    if !causes.is_empty() {
        line("");
    }
    let mut told = 0;
    for Cause { controller, status, reason, sample, rows } in causes {
        let more = if *rows > 1 { format!(" and {} more", rows - 1) } else { String::new() };
        line(&format!("{status} {controller}, sample {sample}{more}: {reason}"));
        told += rows;
    }
    let [.., refused, failed] = made.summary.counts();
    let left = refused + failed - told.min(refused + failed);
    if left > 0 {
        line(&format!("{left} more rows without a result, each with its reason"));
    }
    if made.out.is_some() || made.report.is_some() || !made.worst.is_empty() {
        line("");
    }
    if let Some(path) = made.out {
        let kept = if made.kept > 0 { format!(", {} of them kept", made.kept) } else { String::new() };
        line(&format!("wrote {path}: {} rows{kept}", made.rows));
    }
    for (_, path) in made.worst {
        line(&format!("wrote {path}"));
    }
    if let Some(path) = made.report {
        line(&format!("wrote {path}"));
    }
    out
}

#[derive(Serialize)]
struct Whole<'a> {
    version: &'static str,
    study: &'a str,
    rows: usize,
    kept: usize,
    counts: Counts,
    drawn: Option<Drawn<'a>>,
    controllers: Vec<One<'a>>,
    causes: Vec<Because<'a>>,
    warnings: &'a [String],
    out: Option<&'a str>,
    worst: Vec<Replayable<'a>>,
    report: Option<&'a str>,
}

#[derive(Serialize)]
struct Counts {
    stable: usize,
    unstable: usize,
    refused: usize,
    failed: usize,
}

#[derive(Serialize)]
struct Drawn<'a> {
    samples: usize,
    seed: u64,
    precision: &'static str,
    plant: String,
    quantities: Vec<Varied<'a>>,
    noise_seeds: bool,
    events: Vec<String>,
}

#[derive(Serialize)]
struct Varied<'a> {
    name: &'a str,
    nominal: Option<f64>,
    from: f64,
    to: f64,
    distribution: &'static str,
}

#[derive(Serialize)]
struct One<'a> {
    name: &'a str,
    counts: Counts,
    unstable: Option<Unstable>,
    metrics: Vec<Metric<'a>>,
}

#[derive(Serialize)]
struct Unstable {
    share: f64,
    lo: f64,
    hi: f64,
    confidence: f64,
    interval: &'static str,
    worst_sample: Option<usize>,
}

#[derive(Serialize)]
struct Metric<'a> {
    name: &'a str,
    count: u64,
    min: Option<f64>,
    p5: Option<f64>,
    p50: Option<f64>,
    p95: Option<f64>,
    max: Option<f64>,
    mean: Option<f64>,
    worst: Option<f64>,
    worst_sample: Option<usize>,
}

#[derive(Serialize)]
struct Because<'a> {
    controller: &'a str,
    status: &'a str,
    reason: &'a str,
    sample: usize,
    rows: usize,
}

#[derive(Serialize)]
struct Replayable<'a> {
    sample: usize,
    file: &'a str,
    of: Vec<Reached<'a>>,
}

#[derive(Serialize)]
struct Reached<'a> {
    controller: &'a str,
    metric: &'a str,
    value: Option<f64>,
}

const fn counts([stable, unstable, refused, failed]: [usize; 4]) -> Counts {
    Counts { stable, unstable, refused, failed }
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

fn drawn(study: &SampleStudy) -> Drawn<'_> {
    let varied = study.drawn.quantities.iter().map(|quantity| Varied {
        name: &quantity.name,
        nominal: finite(quantity.nominal),
        from: quantity.ends.0,
        to: quantity.ends.1,
        distribution: quantity.spread.distribution.name(),
    });
    Drawn {
        samples: study.drawn.samples,
        seed: study.drawn.seed,
        precision: match study.drawn.precision {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        },
        plant: study.scenario.plant.to_string(),
        quantities: varied.collect(),
        noise_seeds: study.has_noise(),
        events: events(study),
    }
}

fn one(group: &Group) -> One<'_> {
    let metrics = group.measures.iter().map(|measure| {
        let numbers = statistics(measure);
        let [min, p5, p50, p95, max, mean] =
            std::array::from_fn(|i| numbers.and_then(|numbers| finite(numbers[i])));
        Metric {
            name: &measure.name,
            count: measure.sketch.count(),
            min,
            p5,
            p50,
            p95,
            max,
            mean,
            worst: measure.worst.and_then(|worst| finite(worst.value)),
            worst_sample: measure.worst.map(|worst| worst.sample),
        }
    });
    One {
        name: &group.controller,
        counts: counts(group.counts),
        unstable: group.unstable_share().map(|[share, lo, hi]| Unstable {
            share,
            lo,
            hi,
            confidence: CONFIDENCE,
            interval: "clopper-pearson",
            worst_sample: group.unstable.map(|worst| worst.sample),
        }),
        metrics: metrics.collect(),
    }
}

/// The study as JSON.
#[must_use]
pub fn sample_json(made: &Sampled<'_>) -> String {
    let of_worst = made.summary.worst();
    let reached = |sample: usize| {
        let found = of_worst.iter().find(|(other, _)| *other == sample);
        let all = found.map(|(_, all)| all.as_slice()).unwrap_or_default();
        all.iter()
            .map(|&(controller, metric, value)| Reached { controller, metric, value: finite(value) })
            .collect()
    };
    let causes = made.summary.causes().iter().map(|cause| Because {
        controller: &cause.controller,
        status: cause.status,
        reason: &cause.reason,
        sample: cause.sample,
        rows: cause.rows,
    });
    text(&Whole {
        version: env!("CARGO_PKG_VERSION"),
        study: made.study,
        rows: made.rows,
        kept: made.kept,
        counts: counts(made.summary.counts()),
        drawn: made.of.map(drawn),
        controllers: made.summary.groups().iter().map(one).collect(),
        causes: causes.collect(),
        warnings: made.warnings,
        out: made.out,
        worst: made
            .worst
            .iter()
            .map(|(sample, file)| Replayable { sample: *sample, file, of: reached(*sample) })
            .collect(),
        report: made.report,
    })
}
