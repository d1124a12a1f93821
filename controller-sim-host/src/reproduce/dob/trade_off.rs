//! Figure 10: the trade-off of first order and dead time, `T + tau = 1`.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::loops::{Loop, Ratios};
use rayon::prelude::*;

/// Normalised dead times `L = T/(T + tau)`.
const LAGS: [f64; 13] = [0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98];
/// Sensitivity peaks of the PI.
const PEAKS: [f64; 3] = [1.2, 1.6, 2.0];
/// The number of `alpha/(T + tau)`, equidistant in the logarithm from 0.01 to 100.
const ALPHAS: i32 = 13;

fn alphas() -> impl Iterator<Item = f64> {
    (0..ALPHAS).map(|i| libm::pow(10.0, -2.0 + 4.0 * f64::from(i) / f64::from(ALPHAS - 1)))
}

/// One point of the map.
#[derive(Debug, Clone, Copy)]
struct Point {
    ratios: Ratios,
    noise: f64,
    ms: f64,
}

/// The points of one process and peak, in the order of `alpha`, and `1 + 1/(Ki IAE0)`.
#[derive(Debug, Clone)]
struct Line {
    points: Vec<Point>,
    limit: f64,
    /// The ratios for a very slow filter, and one twice as slow.
    slow: [Ratios; 2],
}

fn line(lag: f64, ms: f64) -> Result<Line, Stop> {
    let one = Loop::optimal(&format!("exp(-{lag}*s)/(1+{}*s)", 1.0 - lag), ms)?;
    let base = one.indices(None)?;
    let point = |alpha: f64| -> Result<Point, Stop> {
        let (ratios, noise) = (one.ratios_to(&base, alpha)?, one.noise_ratio(alpha)?);
        Ok(Point { ratios, noise, ms: one.ms(Some(alpha))? })
    };
    Ok(Line {
        points: alphas().map(point).collect::<Result<_, _>>()?,
        limit: 1.0 + 1.0 / (one.pid.ki * base.iae),
        slow: [one.ratios_to(&base, 1e4)?, one.ratios_to(&base, 2e4)?],
    })
}

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    let pairs: Vec<(f64, f64)> = PEAKS.iter().flat_map(|ms| LAGS.map(|lag| (lag, *ms))).collect();
    let lines: Vec<Line> = pairs
        .par_iter()
        .map(|(lag, ms)| {
            bench.check()?;
            line(*lag, *ms)
        })
        .collect::<Result<_, _>>()?;
    let map: Vec<&[Line]> = lines.chunks(LAGS.len()).collect();
    compare(&map, values);
    robustness(&map, values);
    monotony(&map, values);
    if let Some(one) = map[0].get(1) {
        let row = "Ms0 1.2, L 0.05, alpha to infinity";
        values.put(row, "IAE over its limit", one.slow[1].iae / one.limit);
        values.put(row, "ITAE, alpha doubled", one.slow[1].itae / one.slow[0].itae);
        values.put(row, "ISE", one.slow[1].ise);
        values.put(row, "emax", one.slow[1].e_max);
    }
    Ok(())
}

/// Whether a smaller sensitivity peak of the PI lets the observer do more.
fn compare(map: &[&[Line]], values: &mut Values) {
    let falls = |at: usize, of: &dyn Fn(&Point) -> f64| {
        (0..LAGS.len())
            .all(|l| map.windows(2).all(|two| of(&two[0][l].points[at]) < of(&two[1][l].points[at])))
    };
    let every =
        |range: std::ops::Range<usize>, of: &dyn Fn(&Point) -> f64| range.into_iter().all(|a| falls(a, of));
    let all = 0..ALPHAS as usize;
    // The first six are up to 0.46.
    let (fast, slow) = (0..6, 6..ALPHAS as usize);
    let row = "lower Ms0";
    values.yes(row, "An ratio higher, all points", every(all.clone(), &|p| -p.noise));
    values.yes(row, "ISE ratio better, all points", every(all, &|p| p.ratios.ise));
    values.yes(row, "IAE, ITAE better, alpha <= 0.46", {
        every(fast.clone(), &|p| p.ratios.iae) && every(fast, &|p| p.ratios.itae)
    });
    values.yes(row, "IAE, ITAE better, alpha >= 1", {
        every(slow.clone(), &|p| p.ratios.iae) && every(slow, &|p| p.ratios.itae)
    });
}

/// Whether the peak grows with the dead time.
fn robustness(map: &[&[Line]], values: &mut Values) {
    for (ms, lines) in PEAKS.iter().zip(map) {
        let grows =
            |at: usize| lines.windows(2).all(|two| two[0].points[at].ms <= two[1].points[at].ms + 1e-6);
        let row = format!("Ms0 {ms}");
        values.yes(&row, "Ms grows with L, all alpha", (0..ALPHAS as usize).all(grows));
    }
}

/// Whether every index gets better with a faster filter, and where the ISE is above 1.
fn monotony(map: &[&[Line]], values: &mut Values) {
    for (ms, lines) in PEAKS.iter().zip(map) {
        let rises = |of: &dyn Fn(&Ratios) -> f64, line: &Line| {
            line.points.windows(2).all(|two| of(&two[0].ratios) <= of(&two[1].ratios) + 1e-6)
        };
        let row = format!("Ms0 {ms}");
        let all = |of: &dyn Fn(&Ratios) -> f64| lines.iter().all(|line| rises(of, line));
        values.yes(&row, "IAE, ITAE monotone in alpha", all(&|r| r.iae) && all(&|r| r.itae));
        values.yes(&row, "ISE, emax monotone in alpha", all(&|r| r.ise) && all(&|r| r.e_max));
        let humps = |line: &Line| line.points.iter().any(|point| point.ratios.ise > 1.0 + 1e-4);
        if let Some((lag, _)) = LAGS.iter().zip(*lines).find(|(_, line)| humps(line)) {
            values.put(&row, "ISE above 1 from L", *lag);
        }
    }
}
