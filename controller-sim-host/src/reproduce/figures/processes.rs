//! Figures 11 and 12 of the observer's paper: the 134 processes, one after the other.

use super::super::Paper;
use super::super::bench::{Bench, Stop};
use super::super::dob::loops::{Loop, Ratios};
use super::titled;
use crate::report::sheet::{Content, Curve, Panel, Scale, Sheet};
use controller_design::batch134;
use controller_design::rules::ObserverDesign;
use rayon::prelude::*;

/// The sensitivity peak of the PI for which the paper's statement is true.
const MS: f64 = 1.2;

/// A panel: its title, and what it shows.
type Shown = (&'static str, fn(&(Ratios, f64)) -> f64);

pub(super) fn twice(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    all(bench, 11, 2.0)
}

pub(super) fn ten(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    all(bench, 12, 10.0)
}

fn all(bench: &Bench<'_>, number: u8, ratio: f64) -> Result<Sheet, Stop> {
    let processes = batch134::processes();
    let made = processes.par_iter().map(|process| -> Result<(Ratios, f64), Stop> {
        bench.check()?;
        let plant = process.plant().map_err(|_| Stop::Failed(format!("{} is no plant", process.name)))?;
        let one = Loop::of_plant(plant, MS)?;
        let alpha = ObserverDesign::with_noise_ratio(&one.plant, &one.pid, ratio)?.observer.alpha;
        Ok((one.ratios_to(&one.indices(None)?, alpha)?, one.ms(Some(alpha))?))
    });
    let made: Vec<(Ratios, f64)> = made.collect::<Result<_, _>>()?;
    let shown: [Shown; 6] = [
        ("IAE/IAE\u{2080}", |one| one.0.iae),
        ("ISE/ISE\u{2080}", |one| one.0.ise),
        ("ITAE/ITAE\u{2080}", |one| one.0.itae),
        ("e_max/e_max,\u{2080}", |one| one.0.e_max),
        ("TV/TV\u{2080}", |one| one.0.tv),
        ("Ms", |one| one.1),
    ];
    let last = made.len() as f64;
    let panel = |(title, of): Shown| {
        let points = made.iter().enumerate().map(|(i, one)| (i as f64 + 1.0, of(one))).collect();
        let (name, level) = if title == "Ms" { ("Ms of the PI alone", MS) } else { ("as the PI alone", 1.0) };
        Panel {
            title: String::new(),
            x: Scale::linear("number of the process", ""),
            y: Scale::linear(title, ""),
            content: Content::Curves(vec![
                Curve::points("with the observer", 0, points),
                Curve::line(name, 1, vec![(1.0, level), (last, level)]),
            ]),
        }
    };
    let mut families: Vec<(&str, usize, usize)> = Vec::new();
    for (i, process) in processes.iter().enumerate() {
        match families.last_mut() {
            Some((name, _, last)) if *name == process.family.name => *last = i + 1,
            _ => families.push((process.family.name, i + 1, i + 1)),
        }
    }
    let families: Vec<String> =
        families.iter().map(|(name, first, last)| format!("{name}: {first} to {last}")).collect();
    Ok(Sheet {
        title: titled(Paper::Dob, number, &format!("134 processes, A_n/A_n,0 = {ratio}")),
        text: vec![
            format!(
                "Indices after a step of the load with the observer over those of the PI alone, largest ki at Ms0 = {MS}, infinite horizon; Ms is the largest sensitivity itself. Below 1: better."
            ),
            format!("Processes {}.", families.join(", ")),
        ],
        columns: 2,
        panels: shown.map(panel).to_vec(),
    })
}
