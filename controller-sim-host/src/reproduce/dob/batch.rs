//! Figures 11 and 12: the 134 processes.

use super::super::bench::{Bench, Stop, plant};
use super::super::values::Values;
use super::loops::{Loop, Ratios};
use controller_design::batch134::{self, Process};
use controller_design::model::{Complex, TransferFunction};
use controller_design::rules::ObserverDesign;
use rayon::prelude::*;

/// What a process gives at one sensitivity peak.
#[derive(Debug, Clone)]
struct Outcome {
    group: String,
    /// `IAE*Ki` of the PI alone: 1 when the response keeps one sign.
    iae_ki: f64,
    /// Noise ratios 2 and 10.
    with: [(Ratios, f64); 2],
}

/// An index with its name.
type Index = (&'static str, fn(&Ratios) -> f64);

const RATIOS: [f64; 2] = [2.0, 10.0];
/// Between the 82nd and the 83rd process at `Ms` of 1.2.
const ONE_SIGN: f64 = 1.2e-3;

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    let processes = processes()?;
    values.put("P7, tau1 = 1, 2, 10, T = 1", "processes that are P1, too", twice(&processes));
    for ms in [1.2, 1.4, 2.0] {
        let outcomes: Vec<Outcome> = processes
            .par_iter()
            .map(|(group, plant)| {
                bench.check()?;
                outcome(group, plant, ms)
            })
            .collect::<Result<_, _>>()?;
        put(ms, &outcomes, values);
    }
    Ok(())
}

fn outcome(group: &str, plant: &TransferFunction, ms: f64) -> Result<Outcome, Stop> {
    let one = Loop::of_plant(plant.clone(), ms)?;
    let base = one.indices(None)?;
    let with = |ratio: f64| -> Result<(Ratios, f64), Stop> {
        let alpha = ObserverDesign::with_noise_ratio(&one.plant, &one.pid, ratio)?.observer.alpha;
        Ok((one.ratios_to(&base, alpha)?, one.ms(Some(alpha))?))
    };
    Ok(Outcome {
        group: group.to_owned(),
        iae_ki: base.iae * one.pid.ki,
        with: [with(RATIOS[0])?, with(RATIOS[1])?],
    })
}

fn put(ms: f64, outcomes: &[Outcome], values: &mut Values) {
    let count = |of: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|one| of(one)).count() as f64;
    let indices: [Index; 3] = [("IAE", |r| r.iae), ("ISE", |r| r.ise), ("ITAE", |r| r.itae)];
    for (i, ratio) in RATIOS.iter().enumerate() {
        let row = format!("Ms0 {ms}, An ratio {ratio}");
        for (name, of) in indices {
            let largest = outcomes.iter().map(|one| of(&one.with[i].0)).fold(0.0, f64::max);
            values.put(&row, &format!("{name} largest"), largest);
            values.put(&row, &format!("{name} above 1"), count(&|one| of(&one.with[i].0) > 1.0));
        }
        let peaks = || outcomes.iter().map(|one| one.with[i].1);
        values.put(&row, "Ms least", peaks().fold(f64::INFINITY, f64::min));
        values.put(&row, "Ms largest", peaks().fold(0.0, f64::max));
    }
    if ms == 1.2 {
        for group in ["P1", "P2", "P7", "P9"] {
            let here = count(&|one| one.group == group && one.with[0].0.itae > 1.0);
            values.put("Ms0 1.2, An ratio 2", &format!("ITAE above 1 in {group}"), here);
        }
    }
    let row = format!("Ms0 {ms}");
    let better = count(&|one| indices.iter().all(|(_, of)| of(&one.with[1].0) < of(&one.with[0].0)));
    values.put(&row, "IAE, ISE, ITAE better at ratio 10", better);
    values.put(&row, "Ms at ratio 10 below that at 2", count(&|one| one.with[1].1 < one.with[0].1));
    if ms > 1.2 {
        values.put(&row, "Ms with the observer below Ms0", count(&|one| one.with[1].1 < ms));
    }
    let one_sign = count(&|one| (one.iae_ki - 1.0).abs() < ONE_SIGN);
    values.put(&row, "processes with IAE0 Ki = 1", one_sign);
}

/// The processes of P7 that are one of P1.
fn twice(processes: &[(String, TransferFunction)]) -> f64 {
    // Two different ones of these families differ at this frequency.
    let at = |plant: &TransferFunction| plant.at(Complex::new(0.0, 0.3));
    let of = |wanted: &'static str| processes.iter().filter(move |(group, _)| group == wanted);
    let same = |plant: &TransferFunction| of("P1").any(|(_, other)| (at(plant) - at(other)).abs() < 1e-12);
    of("P7").filter(|(_, plant)| same(plant)).count() as f64
}

/// Their families and plants.
fn processes() -> Result<Vec<(String, TransferFunction)>, Stop> {
    let one = |process: &Process| {
        let group = process.name.split(' ').next().unwrap_or_default().to_owned();
        Ok((group, plant(&process.expression)?))
    };
    batch134::processes().iter().map(one).collect()
}
