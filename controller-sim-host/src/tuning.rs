//! From a recorded step to a tuned loop.

use crate::design_file;
use crate::quiet;
use crate::scenario::{DesignFile, Units};
use controller_design::design::{Design, Law, Request, design_with_areas};
use controller_design::identification::{
    Chosen, Fit, Identified, IdentifyOptions, Recording, SecondOrder, identify,
};
use controller_design::model::{Polynomial, Sopdt, TransferFunction};
use controller_design::{Refusal, Warning};

/// A lag below this share of the sampling period counts as dead time.
const FAST_LAG: f64 = 0.05;
/// Shares of the output's change that a model may be off by, beyond the noise: at all, and where no model of any order
/// comes nearer to the record than ten times the noise.
const GROSS: f64 = 0.2;
const GROSS_UNEXPLAINED: f64 = 0.05;
const UNEXPLAINED: f64 = 10.0;
/// Standard deviations that noise is rarely beyond in two rows of three.
const NOISE: f64 = 4.0;
/// Share of the recorded change of the input that the load of the design file steps by.
const LOAD: f64 = 0.2;

/// What a person knows besides the record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Known {
    /// Range of the controller's output \[u\].
    pub limits: Option<(f64, f64)>,
    /// What the signals are measured in.
    pub units: Units,
    /// What the process is called.
    pub name: String,
    /// What the controller is called; `None`: the method.
    pub controller: Option<String>,
    /// What was typed.
    pub command: String,
}

/// A process that was identified, and a controller for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The process.
    pub found: Identified,
    /// The controller.
    pub made: Design,
    /// The file that is run, analysed, exported and flashed: around the operating point of the record.
    pub file: DesignFile,
    /// Whether the loop works on the fit that explains the record best; else on the model of second order.
    pub on_fit: bool,
    /// What a person should know of the two together.
    pub warnings: Vec<String>,
}

impl Tuned {
    /// Largest distance of the response of the model in the loop from the record \[y\].
    #[must_use]
    pub fn worst_residual(&self, recording: &Recording<'_>) -> f64 {
        residuals(recording, &self.found, self.on_fit).into_iter().fold(0.0, f64::max)
    }
}

/// Distances of the response of the model in the loop from the record.
fn residuals(recording: &Recording<'_>, found: &Identified, on_fit: bool) -> Vec<f64> {
    let simulated = if on_fit { found.simulate_fit(recording) } else { found.simulate(recording) };
    let simulated = simulated.unwrap_or_default();
    simulated.iter().zip(recording.y).map(|(model, y)| (model - y).abs()).collect()
}

/// Refuses a model that has nothing to do with its record: a loop on it would be made for another process. A single row that
/// is off, as sensors have them, does not count.
fn explained(recording: &Recording<'_>, found: &Identified, on_fit: bool) -> Result<(), Refusal> {
    let residuals = residuals(recording, found, on_fit);
    let lasting = residuals.windows(3).map(|three| {
        let (low, high) = (three[0].min(three[1]), three[0].max(three[1]));
        low.max(high.min(three[2]))
    });
    let off = lasting.fold(0.0, f64::max) - NOISE * found.sigma.max(found.quantisation);
    let change = (found.y_inf - found.y0).abs();
    let is_unexplained = found.warnings.iter().any(|warning| {
        matches!(warning, Warning::Value { about: "misfit over noise", value, .. } if *value > UNEXPLAINED)
    });
    if off > GROSS * change || is_unexplained && off > GROSS_UNEXPLAINED * change {
        return Err(Refusal::Data {
            why: "no model explains the record: the best one misses it by a large share of the output's change",
            help: "look at both by `identify --report`: wrong columns, numbers that were read wrong, a disturbance, \
                   friction, or a process that is far from linear; then record one change between two states of rest",
        });
    }
    Ok(())
}

/// Identifies the process of `recording` and designs a controller by `request`.
///
/// The filter of the controller decides how sure its gains are: the process is identified a second time for the filter
/// that the first design has.
///
/// # Errors
/// What the identification or the rule refuses.
pub fn tune(recording: &Recording<'_>, request: &Request, known: &Known) -> Result<Tuned, Refusal> {
    let first = identify(recording, &IdentifyOptions::default())?;
    let (found, made) = match designed(&first, request) {
        Ok(made) => {
            let tf = match &made.law {
                Law::Pid { pid, .. } if made.areas.is_some() && pid.tf > 0.0 => Some(pid.tf),
                _ => None,
            };
            let again = tf.and_then(|tf| {
                let found =
                    identify(recording, &IdentifyOptions { tf: Some(tf), ..IdentifyOptions::default() })
                        .ok()?;
                let made = designed(&found, request).ok()?;
                Some((found, made))
            });
            again.unwrap_or((first, made))
        }
        Err(refusal) => return Err(refusal),
    };
    let on_fit = rich(&found, request.ts).is_some();
    explained(recording, &found, on_fit)?;
    let warnings = warnings(recording, &found, &made, known);
    let file = file(&found, &made, known);
    Ok(Tuned { found, made, file, on_fit, warnings })
}

fn designed(found: &Identified, request: &Request) -> Result<Design, Refusal> {
    let plant = plant(found, request.ts)?;
    let measured = (found.chosen == Chosen::Areas).then_some(&found.areas);
    design_with_areas(&plant, measured, request)
}

/// The process of a recording as a plant, for the comparison of all rules.
///
/// # Errors
/// What the identification refuses; a record that no model explains.
pub fn plant_of(recording: &Recording<'_>, found: &Identified, ts: f64) -> Result<TransferFunction, Refusal> {
    let plant = plant(found, ts)?;
    explained(recording, found, rich(found, ts).is_some())?;
    Ok(plant)
}

/// The model in whose place the controller works: the fit that was chosen, else the model of second order.
fn plant(found: &Identified, ts: f64) -> Result<TransferFunction, Refusal> {
    rich(found, ts).or_else(|| second_order(found, ts)).ok_or(Refusal::Data {
        why: "no model describes the record",
        help: "record a larger step, and until the output is at rest",
    })
}

/// The fit, where its areas were chosen and it has no lag so much faster than the sampling that it was not seen by it.
fn rich(found: &Identified, ts: f64) -> Option<TransferFunction> {
    let Fit { gain, b1, a: [a1, a2, a3, a4], dead_time, .. } =
        found.fit.filter(|_| found.chosen == Chosen::Fit)?;
    let num = Polynomial::new([gain, gain * b1]);
    let den = Polynomial::new([1.0, a1, a2, a3, a4]);
    let model = TransferFunction::from_polynomials(&num, &den, dead_time).ok()?;
    model.poles().iter().all(|pole| pole.abs() * FAST_LAG * ts < 1.0).then_some(model)
}

/// The model of second order.
fn second_order(found: &Identified, ts: f64) -> Option<TransferFunction> {
    let SecondOrder { gain, a1, a2, dead_time } = found.model?;
    Sopdt { gain, a1, a2, dead_time }.without_fast_lag(ts).transfer_function().ok()
}

/// The loop around the recorded operating point: the same change of the set-point, and a load of a fifth of the recorded
/// change of the input, with the noise and the resolution of the record.
fn file(found: &Identified, made: &Design, known: &Known) -> DesignFile {
    let mut file = design_file::of(made, known.limits, &known.command);
    file.title = format!("{} for the process of {}", made.method.title(), known.name);
    if let Some(name) = &known.controller {
        file.controller.name.clone_from(name);
    }
    file.units = known.units.clone();
    file.initial_setpoint = rounded(found.y0);
    // Exactly: the loop rests at the recorded input, which may be a limit.
    file.initial_load = file.initial_setpoint / made.plant.gain() - found.u0;
    file.setpoint_step = rounded(found.y_inf - found.y0);
    file.load_step = rounded(LOAD * (found.u_inf - found.u0));
    // What a converter rounds away is no noise of its own.
    file.noise = if found.sigma > 0.5 * found.quantisation { rounded(found.sigma) } else { 0.0 };
    file.resolution = rounded(found.quantisation);
    design_file::widen(&mut file, made, known.limits);
    file
}

/// Four digits: an operating point is no exact number.
fn rounded(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn warnings(recording: &Recording<'_>, found: &Identified, made: &Design, known: &Known) -> Vec<String> {
    let mut list = Vec::new();
    let (lo, hi) = known.limits.unwrap_or_else(|| {
        recording.u.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), u| (lo.min(*u), hi.max(*u)))
    });
    let of = if known.limits.is_some() { "its range" } else { "the range it was recorded in" };
    let gains = &made.sampled.noise;
    let [step, sigma] = [found.quantisation, found.sigma];
    for (what, size, moved) in [
        ("one step of the measurement", step, quiet::by_step(gains, step)),
        ("its noise (one sigma)", sigma, quiet::by_noise(gains.white, sigma)),
    ] {
        if let Some(share) = quiet::share(moved, (lo, hi)).filter(|share| *share > quiet::QUIET) {
            list.push(format!(
                "{what}, {}, times the noise gain {} of the whole controller moves the output by {:.0} % of {of}: {}",
                crate::scenario::show_short(size),
                crate::scenario::show_short(moved / size),
                100.0 * share,
                calmer(made)
            ));
        }
    }
    if found.kp_spread > 0.3 && made.areas.is_some() && made.noise.kpidn.is_some() {
        list.push(format!(
            "kp follows from the record to {:.0} % only: record a larger step, or ask for a longer filter (a lower --kpidn)",
            100.0 * found.kp_spread.min(9.99)
        ));
    }
    list.extend(design_file::cut(made));
    let recorded =
        recording.u.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), u| (lo.min(*u), hi.max(*u)));
    if let Some((lo, hi)) = known.limits
        && (recorded.0 < lo || recorded.1 > hi)
    {
        list.push(format!(
            "the input was recorded from {} to {}, beyond the limits {lo} to {hi}",
            recorded.0, recorded.1
        ));
    }
    if known.limits.is_none() {
        list.push(
            "no limits given: the simulated output is not limited; `--limits LO:HI` limits it, also in the design file"
                .to_owned(),
        );
    }
    list
}

/// What makes the output calmer, by the options of the method.
fn calmer(made: &Design) -> &'static str {
    let options = made.method.options();
    if options.contains(&"kden") {
        "ask for a lower noise gain (--kpidn, --kden) or filter the measurement"
    } else if options.contains(&"kpidn") {
        "ask for a lower noise gain (--kpidn) or filter the measurement"
    } else if options.contains(&"noise_ratio") {
        "ask for a lower --noise-ratio or filter the measurement"
    } else if options.contains(&"tf") {
        "ask for a longer filter (--tf) or filter the measurement"
    } else if options.contains(&"ms") {
        "ask for a lower --ms or filter the measurement"
    } else {
        "filter the measurement"
    }
}
