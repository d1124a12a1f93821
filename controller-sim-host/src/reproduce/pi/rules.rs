//! The fitted rules: their coefficients from our optimum, and what they lose.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{Optimum, RANGE, SHOWN};
use controller_core::PidConfig;
use controller_design::rules::fits::AirikkaPi;

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    coefficients(&Optimum::of(bench, &RANGE.map(Some))?, values);
    let other = AirikkaPi::linear(2.0, 10.0, 5.0)?.pid;
    values.put("(8a) for k = 2, tau = 10, theta = 5", "kp", other.kp);
    for one in Optimum::of(bench, &SHOWN)? {
        let fits = match one.r {
            Some(r) => vec![
                ("(7)", AirikkaPi::power(1.0, 1.0 / r, 1.0)?),
                ("(8)", AirikkaPi::linear(1.0, 1.0 / r, 1.0)?),
            ],
            None => vec![("(9)", AirikkaPi::integrating(1.0, 1.0)?)],
        };
        for (name, AirikkaPi { pid, .. }) in fits {
            let row = one.row();
            values.put(&row, &format!("{name} kp error"), pid.kp / one.pid.kp - 1.0);
            let ti = |pid: &PidConfig| pid.kp / pid.ki;
            values.put(&row, &format!("{name} ti error"), ti(&pid) / ti(&one.pid) - 1.0);
            values.put(&row, &format!("{name} IAE loss"), one.iae_of(&pid)? / one.iae - 1.0);
        }
    }
    Ok(())
}

/// The forms of the paper, fitted to the optimum by least squares: a power law in the logarithm, `kp` of (8) by its relative
/// error, `ti` of (8) as it is.
fn coefficients(optima: &[Optimum], values: &mut Values) {
    let points: Vec<(f64, f64, f64)> =
        optima.iter().filter_map(|one| Some((one.r?, one.pid.kp, one.ti()))).collect();
    let row = "fit of 0.1 <= r <= 3";
    for (name, of) in [("kp", 0), ("ti", 1)] {
        let value = |&(_, kp, ti): &(f64, f64, f64)| if of == 0 { kp } else { ti };
        let (factor, exponent) = power_law(points.iter().map(|point| (point.0, value(point))));
        values.put(row, &format!("(7) {name}: factor"), factor);
        values.put(row, &format!("(7) {name}: exponent"), exponent);
    }
    // kp = c1 + c2/r: both columns and the ones divided by kp.
    let (mut xx, mut xy, mut yy, mut x1, mut y1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    // ti = c*sqrt(r).
    let (mut ss, mut s1) = (0.0, 0.0);
    for &(r, kp, ti) in &points {
        let (x, y) = (1.0 / kp, 1.0 / (r * kp));
        xx += x * x;
        xy += x * y;
        yy += y * y;
        x1 += x;
        y1 += y;
        ss += r;
        s1 += ti * libm::sqrt(r);
    }
    let determinant = xx * yy - xy * xy;
    values.row(
        row,
        [
            ("(8a) kp k: constant", (x1 * yy - y1 * xy) / determinant),
            ("(8a) kp k: factor of 1/r", (y1 * xx - x1 * xy) / determinant),
            ("(8b) ti: factor", s1 / ss),
        ],
    );
}

/// Factor and exponent of `y = factor*x^exponent`.
fn power_law(points: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let (mut n, mut x1, mut y1, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in points.map(|(x, y)| (libm::log(x), libm::log(y))) {
        n += 1.0;
        x1 += x;
        y1 += y;
        xx += x * x;
        xy += x * y;
    }
    let exponent = (n * xy - x1 * y1) / (n * xx - x1 * x1);
    (libm::exp((y1 - exponent * x1) / n), exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found() {
        let (factor, exponent) = power_law([0.1, 0.5, 2.0].into_iter().map(|x: f64| (x, 3.0 * x.powf(-0.7))));
        assert!((factor - 3.0).abs() < 1e-12 && (exponent + 0.7).abs() < 1e-12);
    }
}
