//! Which structures explain a record: two lags first, more only when the record asks for them.

use super::fit::{Fitted, MOST_TIMES, Shape, Times, fit};
use super::moments;
use super::record::{Record, mean, tail_rows};
use std::vec::Vec;

/// A richer structure is taken when it is this much better by Schwarz's criterion: odds of about 150 to 1.
const CLEARLY: f64 = 10.0;
/// Misfit, in units of the change, that arithmetic alone leaves.
const ARITHMETIC: f64 = 1e-9;

/// The fits of a record.
pub(super) struct Fits {
    /// Two lags, no zero.
    pub(super) second_order: Fitted,
    /// The simplest structure that explains the record.
    pub(super) best: Fitted,
    /// One lag more than the best: what the best would have to be told apart from.
    pub(super) richer: Option<Fitted>,
}

pub(super) fn fits(record: &Record) -> Option<Fits> {
    let n1 = mean_time(record);
    let until = 25.0 * n1;
    let with = |shape: Shape, starts: &[Times]| fit(record, shape, starts, until);
    let second_order = with(Shape { order: 2, zero: false }, &starts(n1))?;
    let mut best = second_order.clone();
    let mut richer = None;
    for order in 3..=4 {
        let Some(next) = with(Shape { order, zero: false }, &extended(&best)) else { break };
        if !explains_more(&next, &best) {
            richer = Some(next);
            break;
        }
        best = next;
    }
    // A zero is asked for only where lags leave something to explain.
    let floor = 10.0 * ARITHMETIC;
    if best.rms > floor
        && (best.colour > 1.1 || best.rms > 1.5 * record.noise.sigma.max(record.noise.quantisation / 3.5))
    {
        for order in 2..=3 {
            let shape = Shape { order, zero: true };
            let mut from = starts(n1);
            from.truncate(4);
            from.push(second_order.times);
            if order == 3 {
                from.iter_mut().for_each(|times| times[3] = 0.3 * times[1]);
                from.extend(extended(&second_order));
            }
            if let Some(next) = with(shape, &from).filter(|next| explains_more(next, &best)) {
                richer = Some(core::mem::replace(&mut best, next));
            }
        }
    }
    Some(Fits { second_order, best, richer })
}

/// Whether a richer fit is clearly better by Schwarz's criterion, in which correlated residuals count as fewer, and has no
/// lag that is longer than the record.
fn explains_more(richer: &Fitted, simpler: &Fitted) -> bool {
    let rows = (richer.rows as f64 / richer.colour).max(2.0);
    let criterion = |fit: &Fitted| {
        let misfit = (fit.squares / fit.rows as f64).max(ARITHMETIC * ARITHMETIC);
        rows * libm::log(misfit) + fit.shape.parameters() as f64 * libm::log(rows)
    };
    richer.slowest() <= 1.0 && criterion(richer) + CLEARLY < criterion(simpler)
}

/// `A_1/A_0` of the whole record, roughly: lags and dead time together.
fn mean_time(record: &Record) -> f64 {
    let (t, u, y) = record.after();
    let tail = tail_rows(t, 0.1);
    let (last, end) = (mean(&u[u.len() - tail..]), mean(&y[y.len() - tail..]));
    let inputs = moments::of_input(t, u, t.len(), last);
    let area: f64 =
        t.windows(2).zip(y.windows(2)).map(|(t, y)| (end - 0.5 * (y[0] + y[1])) * (t[1] - t[0])).sum();
    let time = area / end - inputs[1];
    if time.is_finite() { time.clamp(2e-4, 0.5) } else { 0.1 }
}

/// Slow and fast, with and without dead time, swinging and not.
fn starts(n1: f64) -> Vec<Times> {
    let start = |dead: f64, a1: f64, a2: f64| -> Times {
        let mut times = [0.0; MOST_TIMES];
        times[..3].copy_from_slice(&[dead * n1, a1 * n1, a2 * n1 * n1]);
        times
    };
    vec![
        start(0.3, 0.7, 0.1),
        start(0.05, 0.95, 0.15),
        start(0.7, 0.3, 0.02),
        start(0.0, 1.0, 1.0),
        start(0.0, 1.0, 5.0),
        start(0.0, 1.0, 25.0),
    ]
}

/// Starts for one lag more: taken from the dead time, or split off.
fn extended(fit: &Fitted) -> Vec<Times> {
    let place = fit.shape.times();
    [0.6, 0.2]
        .into_iter()
        .flat_map(|share| {
            let mut from_dead = fit.times;
            let lag = (share * fit.times[0]).max(0.05 * fit.times[1]);
            let mut from_lag = fit.times;
            from_lag[1] *= 1.0 - 0.4 * share;
            let split = 0.4 * share * fit.times[1];
            if place == 4 {
                // Two lags `a`, `b` have `a1 = a + b`, `a2 = a*b`.
                from_dead[4] = lag * fit.times[3].max(0.1 * lag);
                from_dead[3] = fit.times[3].max(0.1 * lag) + lag;
                from_lag[4] = split * fit.times[3].max(0.1 * split);
                from_lag[3] = fit.times[3].max(0.1 * split) + split;
            } else {
                from_dead[3] = lag;
                from_lag[3] = split;
                from_lag[2] *= (1.0 - 0.4 * share) * (1.0 - 0.4 * share);
            }
            from_dead[0] = (fit.times[0] - lag).max(0.0);
            [from_dead, from_lag]
        })
        .collect()
}
