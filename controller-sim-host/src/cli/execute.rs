//! The runs themselves: side by side, or one after the other into files.

use super::Failure;
use super::arguments::Options;
use super::outputs::Targets;
use super::progress;
use super::scenarios::Input;
use crate::output::{Columns, Complete, Problem, SampleFiles};
use crate::pil::Target;
use crate::scenario::{Case, Scenario};
use crate::simulate::{COLUMNS, Control, RunError, RunOptions, RunResult, View, run_with, sample_of};
use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

/// One case of one scenario.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) input: &'a Input,
    pub(super) case: &'a Case,
    /// Where its controllers run besides here.
    pil: Option<&'static Target>,
}

impl<'a> Job<'a> {
    /// Every case of every scenario, in order.
    pub(super) fn all(inputs: &'a [Input], pil: Option<&'static Target>) -> Vec<Self> {
        let cases = |input: &'a Input| input.cases.iter().map(move |case| Self { input, case, pil });
        inputs.iter().flat_map(cases).collect()
    }

    pub(super) fn label(&self) -> Option<&'a str> {
        self.case.label.as_deref()
    }

    pub(super) fn scenario(&self) -> &'a Scenario {
        &self.case.scenario
    }

    /// For messages about it.
    pub(super) fn name(&self) -> String {
        match self.label() {
            Some(label) => format!("{}, {label}", self.input.name),
            None => self.input.name.clone(),
        }
    }

    fn samples(&self) -> u64 {
        let scenario = self.scenario();
        sample_of(scenario.duration, scenario.ts) * scenario.controllers.len() as u64
    }

    /// The part that is drawn.
    fn view(&self, options: &Options) -> View {
        let whole = View::whole(self.scenario().duration);
        View {
            from: options.from.unwrap_or(whole.from),
            to: options.to.map_or(whole.to, |to| to.min(whole.to)),
            ..whole
        }
    }

    /// Whether `--from` and `--to` leave something to be drawn.
    pub(super) fn check_view(&self, options: &Options) -> Result<(), Problem> {
        let view = self.view(options);
        if view.from < view.to {
            return Ok(());
        }
        let (name, duration) = (&self.input.name, self.scenario().duration);
        let message =
            format!("nothing is left of `{name}` to be drawn from {} s to {} s", view.from, view.to);
        Err(Problem::new("usage", message).help(format!("the run lasts from 0 to {duration} s")))
    }

    fn options(&self, options: &Options) -> RunOptions {
        let draws = options.report.is_some() || options.svg.is_some();
        let record = draws.then(|| View { columns: COLUMNS, ..self.view(options) });
        RunOptions { precision: options.precision.into(), record, pil: self.pil, ..RunOptions::default() }
    }

    fn failed(&self, error: &RunError) -> Failure {
        match error {
            RunError::Stopped => Failure::stopped(),
            RunError::Board { .. } => {
                Failure::internal(Problem::new("pil", format!("{}: {error}", self.name())))
            }
            error => Failure::refused(Problem::new("refused", format!("{}: {error}", self.name()))),
        }
    }
}

/// What came out of all runs, and the files of samples.
pub(super) struct Outcome {
    /// One for each job.
    pub(super) results: Vec<RunResult>,
    pub(super) files: Vec<Complete>,
    /// Samples in each of these files.
    pub(super) samples: u64,
}

/// Makes every run.
pub(super) fn execute(
    jobs: &[Job<'_>],
    options: &Options,
    targets: &Targets,
    control: &Control,
) -> Result<Outcome, Failure> {
    let total = jobs.iter().map(Job::samples).sum();
    progress::watch(control, total, options.quiet, || {
        if targets.csv.is_some() || targets.parquet.is_some() {
            into_files(jobs, options, targets, control)
        } else {
            side_by_side(jobs, options, control)
        }
    })
}

/// Nothing that a run computes depends on another one or on who computes it; the results stand in the order of the jobs.
fn side_by_side(jobs: &[Job<'_>], options: &Options, control: &Control) -> Result<Outcome, Failure> {
    let pool = ThreadPoolBuilder::new().num_threads(options.threads.map_or(0, usize::from)).build();
    let pool =
        pool.map_err(|error| Failure::internal(Problem::new("threads", format!("no threads: {error}"))))?;
    let done: Vec<Result<RunResult, RunError>> = pool.install(|| {
        jobs.par_iter().map(|job| run_with(job.scenario(), job.options(options), control, None)).collect()
    });
    let results = jobs.iter().zip(done).map(|(job, result)| result.map_err(|error| job.failed(&error)));
    Ok(Outcome { results: results.collect::<Result<_, _>>()?, files: Vec::new(), samples: 0 })
}

/// One run after the other: a file has one end.
fn into_files(
    jobs: &[Job<'_>],
    options: &Options,
    targets: &Targets,
    control: &Control,
) -> Result<Outcome, Failure> {
    let (csv, parquet) = (targets.csv.as_ref(), targets.parquet.as_ref());
    let cascade = |job: &Job<'_>| job.scenario().controllers.iter().any(|one| one.secondary.is_some());
    let columns = Columns { chapters: jobs.len() > 1, inner: jobs.iter().any(cascade) };
    let mut files = SampleFiles::create(csv, parquet, columns).map_err(Failure::internal)?;
    let mut results = Vec::new();
    for job in jobs {
        files.chapter(&job.input.name, job.label());
        match run_with(job.scenario(), job.options(options), control, Some(&mut files)) {
            Ok(result) => results.push(result),
            Err(error) => {
                return Err(match files.failure() {
                    Some(problem) => Failure::internal(problem.clone()),
                    None => job.failed(&error),
                });
            }
        }
    }
    let samples = files.samples();
    Ok(Outcome { results, files: files.complete().map_err(Failure::internal)?, samples })
}
