//! The figures of the paper on load responses: the PI of the least IAE.

use super::super::Paper;
use super::super::bench::{Bench, Stop};
use super::super::pi::process::Optimum;
use super::titled;
use crate::report::sheet::{Content, Curve, Panel, Scale, Sheet};
use controller_core::PidConfig;
use controller_design::margins::ContinuousLoop;
use controller_design::model::TransferFunction;
use controller_design::response::{ContinuousResponse, Load, Peak};
use controller_design::rules::PiIae;
use controller_design::rules::fits::AirikkaPi;
use rayon::prelude::*;

/// `theta/tau` of the curves.
const RANGE: [f64; 25] = [
    0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.41, 0.5, 0.6, 0.7, 0.84, 1.0, 1.15, 1.3, 1.5, 1.7, 1.85,
    2.0, 2.2, 2.4, 2.6, 2.8, 3.0,
];
/// Those whose responses figure 5 shows.
const SHOWN: [f64; 5] = [0.1, 0.2, 0.41, 0.84, 1.7];
/// The process of figures whose process the paper does not tell, and how far off its loops are tuned.
const EXAMPLE: f64 = 0.41;
/// Points of a response.
const POINTS: usize = 600;

const RATIO: &str = "normalised dead time \u{3b8}/\u{3c4}";

type Points = Vec<(f64, f64)>;

fn sheet(number: u8, title: &str, text: &[&str], columns: usize, panels: Vec<Panel>) -> Sheet {
    let text = text.iter().map(|&sentence| sentence.to_owned()).collect();
    Sheet { title: titled(Paper::Pi, number, title), text, columns, panels }
}

fn panel(y: &str, unit: &str, x: &Scale, curves: Vec<Curve>) -> Panel {
    Panel { title: String::new(), x: x.clone(), y: Scale::linear(y, unit), content: Content::Curves(curves) }
}

fn optima(bench: &Bench<'_>) -> Result<Vec<Optimum>, Stop> {
    Optimum::of(bench, &RANGE.map(Some))
}

/// The deviation of the output after a unit step of the load.
fn response(plant: &TransferFunction, pid: &PidConfig, duration: f64) -> Result<Points, Stop> {
    let trace = ContinuousResponse::new(plant, pid, None)?.trace(Load::Step, duration, POINTS)?;
    Ok(trace.iter().map(|sample| (sample.t, sample.y)).collect())
}

fn first_three(plant: &TransferFunction, pid: &PidConfig) -> Result<[Peak; 3], Stop> {
    let peaks = ContinuousResponse::new(plant, pid, None)?.peaks(Load::Step, 3)?;
    <[Peak; 3]>::try_from(peaks).map_err(|_| Stop::Failed("a response has less than three peaks".to_owned()))
}

/// Figure 1.
pub(super) fn example(_: &Bench<'_>) -> Result<Sheet, Stop> {
    let one = Optimum::new(Some(EXAMPLE))?;
    let peaks = first_three(&one.plant, &one.pid)?;
    let mut curves = vec![Curve::line("deviation of the output", 0, response(&one.plant, &one.pid, 14.0)?)];
    for (i, peak) in peaks.iter().enumerate() {
        let name = format!("P{} = {:.4} at t/\u{3b8} = {:.3}", i + 1, -peak.e, peak.t);
        curves.push(Curve::points(&name.replace('-', "\u{2212}"), i + 1, vec![(peak.t, -peak.e)]));
    }
    let text = format!(
        "A unit step of the load at t = 0; the PI of the least IAE for \u{3b8}/\u{3c4} = {EXAMPLE}, an example of our own: the paper does not tell its process. IAE = {:.4} k \u{3b8} is the area between the curve and the axis.",
        one.iae
    );
    let time = Scale::linear("time t/\u{3b8}", "");
    Ok(sheet(1, "load response and its peaks", &[&text], 1, vec![panel("y/k", "", &time, curves)]))
}

/// Figure 2.
pub(super) fn gain(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    fits(bench, 2, "proportional gain of least IAE", "kp k", |pid, _| pid.kp)
}

/// Figure 3.
pub(super) fn time(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    fits(bench, 3, "integral time of least IAE", "ti/\u{3c4}", |pid, r| pid.kp / pid.ki * r)
}

fn fits(
    bench: &Bench<'_>,
    number: u8,
    title: &str,
    name: &str,
    of: fn(&PidConfig, f64) -> f64,
) -> Result<Sheet, Stop> {
    let optima = optima(bench)?;
    let all: Vec<(f64, f64)> = optima.iter().filter_map(|one| one.r.map(|r| (r, of(&one.pid, r)))).collect();
    let (mut power, mut linear) = (Points::new(), Points::new());
    for &(r, _) in &all {
        power.push((r, of(&AirikkaPi::power(1.0, 1.0 / r, 1.0)?.pid, r)));
        linear.push((r, of(&AirikkaPi::linear(1.0, 1.0 / r, 1.0)?.pid, r)));
    }
    let error = |fit: &Points| -> Points {
        fit.iter().zip(&all).map(|(fit, optimum)| (fit.0, 100.0 * (fit.1 / optimum.1 - 1.0))).collect()
    };
    let x = Scale::linear(RATIO, "");
    let against: Vec<Curve> = [("fit (7)", 1, &power), ("fit (8), corrected", 2, &linear)]
        .into_iter()
        .map(|(name, index, fit)| {
            let points = fit.iter().zip(&all).map(|(fit, optimum)| (optimum.1, fit.1)).collect();
            Curve::line(name, index, points)
        })
        .collect();
    let panels = vec![
        panel(
            name,
            "",
            &x,
            vec![
                Curve::points("optimum", 0, all.clone()),
                Curve::line("fit (7)", 1, power.clone()),
                Curve::line("fit (8), corrected", 2, linear.clone()),
            ],
        ),
        Panel {
            x: Scale::linear(&format!("{name}, optimum"), ""),
            ..panel(&format!("{name}, fit"), "", &x, against)
        },
        panel(
            "relative error of the fit",
            "%",
            &x,
            vec![
                Curve::line("fit (7)", 1, error(&power)),
                Curve::line("fit (8), corrected", 2, error(&linear)),
            ],
        ),
    ];
    let text = "First order with dead time, exp(-\u{3b8} s) k/(1 + \u{3c4} s), step load. Equation (8a) is printed with \u{3c4} for \u{3b8}/\u{3c4}; it is corrected here.";
    Ok(sheet(number, title, &[text], 2, panels))
}

/// Three tunings of one process: too slow, optimal, too fast.
fn three(number: u8, one: &Optimum, fast: f64, duration: f64, x: &Scale, y: &str) -> Result<Sheet, Stop> {
    let mut curves = Vec::new();
    for (index, (factor, name)) in
        [(1.0, "least IAE"), (0.5, "half the gain"), (fast, "more gain")].into_iter().enumerate()
    {
        let pid = PidConfig { kp: factor * one.pid.kp, ki: factor * one.pid.ki, ..one.pid };
        let label = if index == 0 { name.to_owned() } else { format!("{name}, {factor} kp and {factor} ki") };
        curves.push(Curve::line(&label, index, response(&one.plant, &pid, duration)?));
    }
    let text = "The paper does not tell its three tunings: those that are too slow and too fast are ours.";
    let title = if one.r.is_some() {
        "three tunings, first order with dead time"
    } else {
        "three tunings, integrator with dead time"
    };
    Ok(sheet(number, title, &[text], 1, vec![panel(y, "", x, curves)]))
}

/// Figure 4.
pub(super) fn three_of_lag(_: &Bench<'_>) -> Result<Sheet, Stop> {
    let one = Optimum::new(Some(EXAMPLE))?;
    let x = Scale::linear(&format!("time t/\u{3b8} (\u{3b8}/\u{3c4} = {EXAMPLE})"), "");
    three(4, &one, 1.3, 25.0, &x, "y/k")
}

/// Figure 9.
pub(super) fn three_of_integrator(_: &Bench<'_>) -> Result<Sheet, Stop> {
    let one = Optimum::new(None)?;
    three(9, &one, 1.25, 40.0, &Scale::linear("time t/\u{3b8}", ""), "y/(k \u{3b8})")
}

/// Figure 5: for a time constant of 1.
pub(super) fn responses(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    let optima = Optimum::of(bench, &SHOWN.map(Some))?;
    let mut curves = Vec::new();
    for (index, one) in optima.iter().enumerate() {
        let r = one.r.unwrap_or(1.0);
        let points = response(&one.plant, &one.pid, 12.0 / r)?;
        let points = points.into_iter().map(|(t, y)| (t * r, y)).collect();
        curves.push(Curve::line(&format!("\u{3b8}/\u{3c4} = {r}"), index, points));
    }
    let x = Scale::linear("time t/\u{3c4}", "");
    let text = "Unit step of the load at t = 0, gain 1.";
    Ok(sheet(5, "load responses with the least IAE", &[text], 1, vec![panel("y/k", "", &x, curves)]))
}

/// A quantity of every optimum over `theta/tau`.
fn over(optima: &[Optimum], of: impl Fn(&Optimum, f64, &[Peak; 3]) -> f64 + Sync) -> Result<Points, Stop> {
    let point = |one: &Optimum| -> Result<(f64, f64), Stop> {
        let r = one.r.unwrap_or(1.0);
        Ok((r, of(one, r, &first_three(&one.plant, &one.pid)?)))
    };
    optima.par_iter().map(point).collect()
}

/// Figure 6: for a time constant and a gain of 1.
pub(super) fn metrics(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    let optima = optima(bench)?;
    let x = Scale::linear(RATIO, "");
    let one = |y: &str, points: Points| panel(y, "", &x, vec![Curve::line("", 0, points)]);
    let panels = vec![
        one("IAE/(k \u{3c4})", over(&optima, |one, r, _| one.iae * r)?),
        one("largest error P1/k", over(&optima, |_, _, peaks| peaks[0].e.abs())?),
        one("its time t_max/\u{3c4}", over(&optima, |_, r, peaks| peaks[0].t * r)?),
        one("time of the third peak t3/\u{3c4}", over(&optima, |_, r, peaks| peaks[2].t * r)?),
    ];
    let text = "The settling time of the paper is that of the third peak: no settling band gives its ratio of 2.9 to t_max.";
    Ok(sheet(6, "metrics of the optimal load response", &[text], 2, panels))
}

fn ratios(peaks: &[Peak; 3]) -> [f64; 5] {
    let [one, two, three] = peaks;
    let (down, up) = (one.e / two.e, three.e / two.e);
    [down, up, down * up, two.t / one.t, three.t / one.t]
}

const DAMPING: [(&str, usize); 3] = [("P1/P2", 0), ("P3/P2", 1), ("P1/P2 \u{b7} P3/P2", 2)];
const TIMES: [(&str, usize); 2] = [("t_min/t_max", 3), ("t3/t_max", 4)];

fn of_lags(bench: &Bench<'_>, number: u8, title: &str, list: &[(&str, usize)]) -> Result<Sheet, Stop> {
    let optima = optima(bench)?;
    let x = Scale::linear(RATIO, "");
    let mut panels = Vec::new();
    for (name, i) in list {
        let points = over(&optima, |_, _, peaks| ratios(peaks)[*i])?;
        panels.push(panel(name, "", &x, vec![Curve::line("", 0, points)]));
    }
    let text = "The PI of the least IAE, first order with dead time; t3 is the time of the third peak.";
    Ok(sheet(number, title, &[text], list.len(), panels))
}

/// Figure 7.
pub(super) fn damping(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    of_lags(bench, 7, "damping ratios", &DAMPING)
}

/// Figure 8.
pub(super) fn times(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    of_lags(bench, 8, "time ratios", &TIMES)
}

fn of_integrators(number: u8, title: &str, list: &[(&str, usize)]) -> Result<Sheet, Stop> {
    let one = |dead_time: &f64| -> Result<(f64, [f64; 5]), Stop> {
        let plant = TransferFunction::integrating(1.0, *dead_time)?;
        let pid = PiIae::new(&plant)?.pid;
        Ok((*dead_time, ratios(&first_three(&plant, &pid)?)))
    };
    let dead_times = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
    let all: Vec<(f64, [f64; 5])> = dead_times.par_iter().map(one).collect::<Result<_, Stop>>()?;
    let x = Scale::linear("dead time \u{3b8}", "s");
    let curves: Vec<Curve> = list
        .iter()
        .enumerate()
        .map(|(index, (name, i))| Curve::line(name, index, all.iter().map(|(t, r)| (*t, r[*i])).collect()))
        .collect();
    let text = "The PI of the least IAE for an integrator with dead time. A dead time twice as long makes everything twice as slow: the ratios are constants.";
    Ok(sheet(number, title, &[text], 1, vec![panel("ratio", "", &x, curves)]))
}

/// Figure 10.
pub(super) fn damping_of_integrator(_: &Bench<'_>) -> Result<Sheet, Stop> {
    of_integrators(10, "damping ratios, integrator with dead time", &DAMPING)
}

/// Figure 11.
pub(super) fn times_of_integrator(_: &Bench<'_>) -> Result<Sheet, Stop> {
    of_integrators(11, "time ratios, integrator with dead time", &TIMES)
}

/// Figure 12.
pub(super) fn margins(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    let optima = optima(bench)?;
    let mut all = Vec::new();
    for one in &optima {
        all.push((one.r.unwrap_or(1.0), ContinuousLoop::new(&one.plant, &one.pid).margins()?));
    }
    let x = Scale::linear(RATIO, "");
    let panels = vec![
        panel("Ms", "", &x, vec![Curve::line("", 0, all.iter().map(|(r, m)| (*r, m.ms)).collect())]),
        panel(
            "gain margin",
            "",
            &x,
            vec![
                Curve::line("true", 0, all.iter().map(|(r, m)| (*r, m.gm)).collect()),
                Curve::line(
                    "bound Ms/(Ms\u{2212}1)",
                    1,
                    all.iter().map(|(r, m)| (*r, m.ms / (m.ms - 1.0))).collect(),
                ),
            ],
        ),
        panel(
            "phase margin",
            "\u{b0}",
            &x,
            vec![
                Curve::line("true", 0, all.iter().map(|(r, m)| (*r, m.pm_deg)).collect()),
                Curve::line(
                    "bound 2 asin(1/(2 Ms))",
                    1,
                    all.iter().map(|(r, m)| (*r, 2.0 * libm::asin(0.5 / m.ms).to_degrees())).collect(),
                ),
            ],
        ),
    ];
    let text = "The PI of the least IAE. The ranges that the paper prints for both margins are those of the bounds that Ms sets.";
    Ok(sheet(12, "robustness of the optimum", &[text], 3, panels))
}
