//! Figures 6, 7, 8 of the observer's paper: three plants, two PI controllers, four loops each, over frequency.

use super::super::Paper;
use super::super::bench::{Bench, Stop};
use super::super::dob::loops::{Loop, PARTS, PLANTS, SUM};
use super::titled;
use crate::report::sheet::{Content, Curve, Panel, Scale, Sheet};
use controller_design::margins::ContinuousLoop;
use rayon::prelude::*;

/// Points of a curve.
const POINTS: i32 = 800;
/// The frequencies that are shown \[rad/s\]; `T + tau` is 100 s.
const RANGE: (f64, f64) = (1e-4, 2.0);

/// What is drawn of a loop.
#[derive(Debug, Clone, Copy)]
struct Quantity {
    number: u8,
    title: &'static str,
    y: &'static str,
    of: fn(&ContinuousLoop, f64) -> f64,
    with_peak: bool,
}

pub(super) fn load(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    all(
        bench,
        Quantity {
            number: 6,
            title: "load to error",
            y: "|e/d|",
            of: |l, w| l.load_response(w).abs(),
            with_peak: false,
        },
    )
}

pub(super) fn sensitivity(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    all(
        bench,
        Quantity {
            number: 7,
            title: "sensitivity",
            y: "|S|",
            of: |l, w| l.sensitivity(w).abs(),
            with_peak: true,
        },
    )
}

pub(super) fn noise(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    all(
        bench,
        Quantity {
            number: 8,
            title: "noise to control action",
            y: "|u/n|",
            of: |l, w| l.noise_response(w).abs(),
            with_peak: false,
        },
    )
}

fn all(bench: &Bench<'_>, what: Quantity) -> Result<Sheet, Stop> {
    let cases: Vec<(f64, &str, &str)> =
        [1.2, 2.0].into_iter().flat_map(|ms| PLANTS.map(|(name, plant)| (ms, name, plant))).collect();
    let panels = cases.par_iter().map(|(ms, name, plant)| {
        bench.check()?;
        let one = Loop::optimal(plant, *ms)?;
        let mut curves = Vec::new();
        let mut peaks = Vec::new();
        let alphas = core::iter::once(None).chain(PARTS.map(Some));
        for (index, part) in alphas.enumerate() {
            let design = one.frequency(part.map(|part| part * SUM))?;
            let omega = |k: i32| RANGE.0 * libm::pow(RANGE.1 / RANGE.0, f64::from(k) / f64::from(POINTS));
            let points = (0..=POINTS).map(|k| (omega(k), (what.of)(&design, omega(k)))).collect();
            let label = part.map_or("PI alone".to_owned(), |part| format!("\u{3b1} = {} s", part * SUM));
            curves.push(Curve::line(&label, index, points));
            let margins = design.margins()?;
            peaks.push(Curve::points("", index, vec![(margins.omega_ms, margins.ms)]));
        }
        if what.with_peak {
            curves.extend(peaks);
        }
        Ok(Panel {
            title: format!("L = {name}, Ms0 = {ms}"),
            x: Scale::log("frequency", "rad/s"),
            y: Scale::log(what.y, ""),
            content: Content::Curves(curves),
        })
    });
    let mut text = vec![
        "Plants exp(-T s)/(1 + \u{3c4} s) with T + \u{3c4} = 100 s, L = T/(T+\u{3c4}), under the PI of the largest ki at Ms0, alone and with an observer; the gains of tables 1 and 2 are not this optimum.".to_owned(),
    ];
    if what.with_peak {
        text.push("Points: Ms, the largest sensitivity.".to_owned());
    }
    Ok(Sheet {
        title: titled(Paper::Dob, what.number, what.title),
        text,
        columns: 3,
        panels: panels.collect::<Result<_, Stop>>()?,
    })
}
