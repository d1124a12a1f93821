//! Figures 3 and 10 of the observer's paper: maps over the normalised dead time and the filter.

use super::super::Paper;
use super::super::bench::{Bench, Stop};
use super::titled;
use crate::batch::Stopped;
use crate::batch::map::{Axis, MapStudy, MapValues, Metric, Parameter, Setting, Template};
use crate::report::sheet::{Content, Map, Mark, Panel, Scale, Sheet, Sign};
use crate::report::{MapLook, map_sheet};
use controller_design::design::Method;
use std::sync::atomic::AtomicU64;

/// Normalised dead times, and filters over the sum of dead time and lag.
const DEAD_TIMES: &str = "L=0.02:0.98:25";
const FILTERS: &str = "alpha_ratio=0.01:100:25:log";
const X: &str = "normalised dead time T/(T+\u{3c4})";
const Y: &str = "\u{3b1}/(T+\u{3c4})";

fn axis(text: &str) -> Result<Axis, Stop> {
    Axis::read(text).map_err(Stop::Failed)
}

/// Figure 3: how much the observer alone may raise the sensitivity, and what it adds to the noise gain.
pub(super) fn bounds(_: &Bench<'_>) -> Result<Sheet, Stop> {
    let (x, y) = (axis("L=0.01:0.99:99")?.values, axis("alpha_ratio=0.01:100:81:log")?.values);
    let panel = |title: &str, of: &dyn Fn(f64, f64) -> f64| Panel {
        title: title.to_owned(),
        x: Scale::linear(X, ""),
        y: Scale::log(Y, ""),
        content: Content::Map(Map {
            x: x.clone(),
            y: y.clone(),
            values: y.iter().flat_map(|&a| x.iter().map(move |&l| (l, a))).map(|(l, a)| of(l, a)).collect(),
            levels: Vec::new(),
            is_ratio: false,
            marks: Vec::new(),
        }),
    };
    Ok(Sheet {
        title: titled(Paper::Dob, 3, "bounds for a first-order plant with dead time"),
        text: vec!["The largest |1 - C_u| over all frequencies bounds Ms/Ms0, eq. (35); \u{3c4}/\u{3b1} is what the observer adds to the noise gain of a plant of gain 1, eq. (36).".to_owned()],
        columns: 2,
        panels: vec![
            panel("largest |1 \u{2212} C_u|", &|l, alpha| largest(alpha / l)),
            panel("\u{3c4}/\u{3b1}", &|l, alpha| (1.0 - l) / alpha),
        ],
    })
}

/// The largest `|1 - exp(-j*b)/(1 + j*b*ratio)|` over b, the frequency times the dead time; `ratio`: filter over dead time.
fn largest(ratio: f64) -> f64 {
    let size = |b: f64| {
        let c = b * ratio;
        let (re, im) = (libm::cos(b), -libm::sin(b));
        // (re + j*im)*(1 - j*c)/(1 + c*c)
        let down = 1.0 + c * c;
        libm::hypot(1.0 - (re + im * c) / down, (im - re * c) / down)
    };
    // The arrow of C_u shrinks with every turn: the first one decides.
    let step = core::f64::consts::TAU / 400.0;
    let best = (1..400).map(|k| step * f64::from(k)).max_by(|a, b| size(*a).total_cmp(&size(*b)));
    let middle = best.unwrap_or(core::f64::consts::PI);
    let (mut lo, mut hi) = (middle - step, middle + step);
    for _ in 0..80 {
        let third = (hi - lo) / 3.0;
        if size(lo + third) < size(hi - third) { lo += third } else { hi -= third }
    }
    // At the highest frequencies C_u is 0.
    size(0.5 * (lo + hi)).max(1.0)
}

/// Figure 10, for three sensitivity peaks of the PI.
pub(super) fn maps(bench: &Bench<'_>) -> Result<Sheet, Stop> {
    let study = MapStudy {
        plant: Template::new("exp(-L*s)/(1+(1-L)*s)"),
        method: Method::Dob,
        over: Some(Method::PiMs),
        x: axis(DEAD_TIMES)?,
        y: axis(FILTERS)?,
        each: Some(Axis {
            parameter: Parameter::Option(Setting::Ms),
            values: vec![1.2, 1.6, 2.0],
            log: false,
        }),
        at: Vec::new(),
        ts: None,
        horizon: None,
    };
    let names = ["load_iae", "load_ise", "load_itae", "load_e_max", "ms", "a_n"];
    let metrics: Vec<Metric> = names.iter().filter_map(|name| Metric::named(name)).collect();
    let mut values = MapValues::new(&study, &metrics);
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let done = AtomicU64::new(0);
    let result = study.work(0..study.rows(), jobs, bench.control(), &done, |rows| -> Result<(), Stopped> {
        rows.iter().for_each(|row| values.add(row));
        Ok(())
    });
    result.map_err(|Stopped| Stop::Stopped)?;
    let look = MapLook {
        title: Some(titled(Paper::Dob, 10, "trade-off of a PI with disturbance observer")),
        x_label: Some(X.to_owned()),
        y_label: Some(Y.to_owned()),
        marks: marks(),
        ..MapLook::default()
    };
    let mut sheet = map_sheet(&study, &values, &look);
    // The examples of the paper have the other two peaks.
    for (panel, values) in sheet.panels.iter_mut().zip(values.panels()) {
        if let (Content::Map(map), Some(1.6)) = (&mut panel.content, values.each) {
            map.marks.clear();
        }
    }
    sheet.text.push("Triangles, squares, discs: plants 1, 2, 3 of section 4 with \u{3b1} of 100, 10 and 1 s; rings: the tank of section 7.".to_owned());
    Ok(sheet)
}

fn marks() -> Vec<Mark> {
    let of = |l: f64, sign: Sign, name: &str| {
        [1.0, 0.1, 0.01].map(|alpha| Mark {
            at: (l, alpha),
            sign,
            name: format!("{name}, \u{3b1}/(T+\u{3c4}) = {alpha}"),
        })
    };
    let all = [
        of(3.2 / 83.5, Sign::Ring, "tank"),
        of(0.05, Sign::Triangle, "plant 1"),
        of(0.2, Sign::Square, "plant 2"),
        of(0.9, Sign::Disc, "plant 3"),
    ];
    all.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without filter the arrow of `C_u` turns at full length: 2 at half a turn; a slow filter is gone before the dead time
    /// matters: `|c/(1+j*c)|` with c = b*ratio rises to 1, with `exp(-j*b)` near 1 up to there a little above it.
    #[test]
    fn the_bound_has_its_limits() {
        assert!((largest(1e-9) - 2.0).abs() < 1e-9);
        assert!((1.0..1.01).contains(&largest(1e4)));
        let list: Vec<f64> = (-30..=30).map(|k| largest(libm::pow(10.0, f64::from(k) / 10.0))).collect();
        assert!(list.windows(2).all(|pair| pair[0] >= pair[1] - 1e-12), "{list:?}");
    }
}
