//! Areas with their uncertainty, from either way.

use super::gains;
use super::moments::{self, COUNT, Six};
use super::noise::jitter;
use super::record::{Record, mean};
use super::solve::root;
use super::structures::Fits;

/// Half width of a 90 % interval in standard deviations, a tenth more than for a deviation that is known exactly: size
/// and colour of the noise are estimates.
pub(super) const NINETY: f64 = 1.8;

/// A richer structure is determined by the record when its interval is at most so many times that of the simpler one.
const DETERMINED: f64 = 3.0;

/// Areas and `K_P` in the scale of the record.
#[derive(Debug, Clone, Copy)]
pub(super) struct Estimate {
    pub(super) areas: Six,
    /// Half widths of the 90 % intervals.
    pub(super) interval: Six,
    /// `K_P`, where the areas give one.
    pub(super) kp: Option<f64>,
    /// Half width of its 90 % interval; infinite without a `K_P`.
    pub(super) kp_interval: f64,
}

impl Estimate {
    /// From a covariance and errors of known size.
    fn new(areas: Six, covariance: &[Six; COUNT], known: &Six, tf: f64) -> Self {
        let interval = core::array::from_fn(|k| NINETY * root(covariance[k][k]) + known[k].abs());
        let mut kp_interval = f64::INFINITY;
        let kp = gains::kp(&areas, tf).ok();
        if let Some(slopes) = kp.and_then(|_| gains::slopes(&areas, tf)) {
            let deviation = root(gains::quadratic(&slopes, covariance));
            let bias = slopes.iter().zip(known).map(|(s, e)| s * e).sum::<f64>().abs();
            kp_interval = NINETY * deviation + bias;
        }
        Self { areas, interval, kp, kp_interval }
    }

    /// The interval of `K_P` as the standard deviation that it is of, over `K_P`; infinite without a `K_P`.
    pub(super) fn kp_spread(&self) -> f64 {
        self.kp.map_or(f64::INFINITY, |kp| self.kp_interval / (NINETY * kp.abs()))
    }
}

/// The raw areas, and how far they were integrated.
pub(super) struct Raw {
    pub(super) estimate: Estimate,
    /// First row of the tail, among all rows.
    pub(super) tail: usize,
    /// The final values, in the scale of the record.
    pub(super) last_input: f64,
    pub(super) last_output: f64,
}

/// A window as a choice: its last row, among those after the change.
struct Window {
    row: usize,
    last_input: f64,
    last_output: f64,
    rows: usize,
}

impl Window {
    fn at(record: &Record, row: usize) -> Self {
        let (_, u, y) = record.after();
        Self { row, last_input: mean(&u[row..]), last_output: mean(&y[row..]), rows: y.len() - row }
    }

    /// Errors of `y_0..y_5` that are known: what comes after the window, and what the tail still moves.
    fn truncation(&self, record: &Record, fits: Option<&Fits>) -> Six {
        let (t, ..) = record.after();
        let w = t[self.row];
        let Some(best) = fits.map(|fits| &fits.best) else { return [0.0; COUNT] };
        let tau = best.slowest();
        let tail = &t[self.row..];
        let mut instants: std::vec::Vec<f64> = tail.iter().copied().step_by(1 + tail.len() / 64).collect();
        // Where the model comes to rest, with the input as it is then.
        instants.push(w + 60.0 * tau + best.times[0]);
        let simulated = best.simulate(record, &instants);
        let end = simulated[simulated.len() - 1];
        let away: std::vec::Vec<f64> = simulated.iter().map(|y| (end - y).abs()).collect();
        let begin = away[0];
        let average = mean(&away[..away.len() - 1]);
        let (rest, growth) = (moments::remainder(w, tau), moments::growth(w));
        core::array::from_fn(|k| (begin * rest[k] + average * growth[k]) / self.last_input)
    }

    fn final_value_variance(&self, record: &Record) -> f64 {
        record.noise.of_mean(self.rows) / (self.last_input * self.last_input)
    }
}

/// The raw areas over the window with the least uncertain `A_5` that starts at `settled` (a row after the change) or
/// later.
pub(super) fn raw(record: &Record, fits: Option<&Fits>, settled: usize, tf: f64) -> Raw {
    let (t, u, y) = record.after();
    let rows = t.len();
    let spare = (rows / 20).max(3);
    let latest = rows - spare;
    let earliest = settled.clamp(1, latest);
    let mut best: Option<(f64, Window)> = None;
    for step in 0..=24 {
        let share = f64::from(step) / 24.0;
        let row = earliest + (share * (latest - earliest) as f64) as usize;
        let window = Window::at(record, row.min(latest));
        let known = window.truncation(record, fits);
        let noise = NINETY * root(window.final_value_variance(record)) * moments::growth(t[window.row])[5];
        let error = noise + known[5];
        // A longer window only for a gain that shows, so that it stays as short as truncation allows.
        if best.as_ref().is_none_or(|(least, _)| error < *least) {
            best = Some((error, window));
        }
    }
    let window = best.map_or_else(|| Window::at(record, latest), |(_, window)| window);
    let inputs = moments::of_input(t, u, window.row + 1, window.last_input);
    let weights = moments::weights(t, u, window.row + 1);
    let outputs = |u_end: f64, y_end: f64| {
        let sums = moments::of_output(&weights, y, y_end, y_end);
        sums.map(|y| y / u_end)
    };
    let areas = moments::areas(&outputs(window.last_input, window.last_output), &inputs);
    let known = moments::areas(&window.truncation(record, fits), &inputs);
    // What the final value, the first value, and each sample do to y_0..y_5.
    let growth = moments::growth(t[window.row]);
    let unit = 1.0 / (window.last_input * window.last_input);
    let end = window.final_value_variance(record);
    let begin = record.noise.of_mean(record.before) * unit;
    let white = record.noise.sigma * record.noise.sigma * record.noise.colour * unit;
    let mut covariance: [Six; COUNT] = core::array::from_fn(|k| {
        core::array::from_fn(|l| {
            let products = weights.of[k].iter().zip(&weights.of[l]).take(weights.rows).map(|(a, b)| a * b);
            end * growth[k] * growth[l] + white * products.sum::<f64>()
        })
    });
    covariance[0][0] += begin;
    let mut covariance = moments::through(&covariance, &inputs);
    // The final input, when a controller keeps moving it.
    let restless = jitter(&u[window.row..]);
    if restless > 0.0 {
        let step = 1e-4;
        let moved = window.last_input * (1.0 + step);
        let other = moments::areas(
            &outputs(moved, window.last_output),
            &moments::of_input(t, u, window.row + 1, moved),
        );
        let slope: Six = core::array::from_fn(|k| (other[k] - areas[k]) / (step * window.last_input));
        let variance = restless * restless / window.rows as f64;
        for k in 0..COUNT {
            for l in 0..COUNT {
                covariance[k][l] += variance * slope[k] * slope[l];
            }
        }
    }
    Raw {
        estimate: Estimate::new(areas, &covariance, &known, tf),
        tail: record.start + window.row,
        last_input: window.last_input,
        last_output: window.last_output,
    }
}

/// The areas of the fit. Its intervals reach over those of the next richer structure, as [`reach`] says: what the record
/// cannot tell apart is not known.
pub(super) fn fitted(record: &Record, fits: &Fits, tf: f64) -> Estimate {
    // What a converter's steps do to the first steady state changes the gain and with it all areas alike; the last one is
    // in the covariance of the fit.
    let steady = record.noise.steady_quantisation() / record.moves.by.iter().sum::<f64>();
    let of = |fit: &super::fit::Fitted| {
        let (areas, mut covariance) = (fit.areas(), fit.area_covariance());
        for (k, row) in covariance.iter_mut().enumerate() {
            for (l, place) in row.iter_mut().enumerate() {
                *place += steady * steady * (areas[k] / areas[0]) * (areas[l] / areas[0]);
            }
        }
        Estimate::new(areas, &covariance, &[0.0; COUNT], tf)
    };
    let mut estimate = of(&fits.best);
    if let Some(richer) = fits.richer.as_ref().map(of) {
        for k in 0..COUNT {
            let apart = (richer.areas[k] - estimate.areas[k]).abs();
            estimate.interval[k] = reach(estimate.interval[k], apart, richer.interval[k]);
        }
        if let (Some(a), Some(b)) = (estimate.kp, richer.kp) {
            estimate.kp_interval = reach(estimate.kp_interval, (a - b).abs(), richer.kp_interval);
        }
    }
    estimate
}

/// The half width `own` of the simplest structure that explains the record, with a richer one `apart` from it. One that
/// the record determines is a possible truth and counts in full. One that it does not could be anywhere, and that says
/// nothing about the process: it widens the interval by no more than the worst that a determined one might have.
fn reach(own: f64, apart: f64, richer: f64) -> f64 {
    let whole = apart + richer;
    own.max(if richer <= DETERMINED * own { whole } else { whole.min(DETERMINED * own) })
}

#[cfg(test)]
mod tests {
    use super::reach;

    #[test]
    fn only_a_determined_richer_structure_counts_in_full() {
        assert_eq!(reach(1.0, 8.0, 2.0), 10.0);
        assert_eq!(reach(1.0, 8.0, 1000.0), 3.0);
        assert_eq!(reach(1.0, 0.5, 3.5), 3.0);
        // A richer structure never makes anything more certain.
        assert_eq!(reach(1.0, 0.1, 0.2), 1.0);
        assert_eq!(reach(1.0, f64::INFINITY, f64::INFINITY), 3.0);
    }
}
