//! The series of a rational function with dead time, by powers of `x = -s`.
//!
//! Factor by factor, in units of time in which no coefficient exceeds 1 (a power of two, so nothing is rounded), and
//! in twice the working precision: eq. (5) of Vrančić & Huba 2021 adds up terms of alternating sign.

use crate::Refusal;
use crate::double::{Double, exponent};

/// The largest number of areas that [`areas_into`] computes.
pub const MAX_AREAS: usize = 64;
/// The largest number of coefficients of a polynomial.
pub const MAX_COEFFICIENTS: usize = 33;

/// Fills `out` with the areas `A_0, A_1, ...` of `gain * num(s)/den(s) * exp(-s*dead_time)`, as many as there is room
/// for, at most [`MAX_AREAS`] (Vrančić & Huba 2021, eq. (5)). Arguments and accuracy as for
/// [`Areas::of_model`](super::Areas::of_model). Cost: of the order of `out.len() * (out.len() + num.len() + den.len())`
/// multiplications.
///
/// ```
/// use controller_design::areas::areas_into;
/// let mut areas = [0.0; 9];
/// areas_into(2.0, &[1.0], &[1.0, 0.5], 0.0, &mut areas).expect("a stable plant");
/// assert_eq!(areas[8], 2.0 * 0.5_f64.powi(8));
/// ```
///
/// # Errors
/// As for [`Areas::of_model`](super::Areas::of_model), and an `out` that is too long.
pub fn areas_into(
    gain: f64,
    num: &[f64],
    den: &[f64],
    dead_time: f64,
    out: &mut [f64],
) -> Result<(), Refusal> {
    check(num, den)?;
    let mut buffer = [Double::default(); MAX_AREAS];
    let count = out.len();
    let Some(room) = buffer.get_mut(..count) else {
        return Err(out_of_range("count", as_f64(count), 0.0, as_f64(MAX_AREAS)));
    };
    areas(gain, &[num], &[den], dead_time, room)?;
    for (value, area) in out.iter_mut().zip(room) {
        *value = area.value();
    }
    Ok(())
}

/// Checks coefficients that a caller wrote.
pub(super) fn check(num: &[f64], den: &[f64]) -> Result<(), Refusal> {
    for (name, list) in [("num[0]", num), ("den[0]", den)] {
        let first = list.first().copied().unwrap_or(f64::NAN);
        if first != 1.0 {
            return Err(out_of_range(name, first, 1.0, 1.0));
        }
        if list.len() > MAX_COEFFICIENTS {
            let what = "the number of coefficients";
            return Err(out_of_range(what, as_f64(list.len()), 1.0, as_f64(MAX_COEFFICIENTS)));
        }
    }
    if is_stable(den) { Ok(()) } else { Err(UNSTABLE) }
}

/// What an unstable plant is told.
pub(super) const UNSTABLE: Refusal = Refusal::Plant {
    must: "be stable: the areas of an unstable plant do not describe its behaviour",
    help: "stabilise it by an inner loop and design for that loop",
};

/// Fills `out` with the areas of `gain * prod(num)/prod(den) * exp(-s*dead_time)`, every polynomial in ascending
/// powers and with a constant term of 1. Stability is the caller's.
pub(super) fn areas<P: AsRef<[f64]>>(
    gain: f64,
    num: &[P],
    den: &[P],
    dead_time: f64,
    out: &mut [Double],
) -> Result<(), Refusal> {
    let all = || num.iter().chain(den).map(AsRef::as_ref);
    if !gain.is_finite() || gain == 0.0 {
        return Err(Refusal::Plant {
            must: "have a finite gain other than 0",
            help: "check the gain of the model or the size of the recorded change",
        });
    }
    if !(dead_time >= 0.0 && dead_time.is_finite()) {
        return Err(out_of_range("dead_time", dead_time, 0.0, f64::INFINITY));
    }
    if let Some(&value) = all().flatten().find(|c| !c.is_finite()) {
        return Err(out_of_range("a coefficient", value, f64::NEG_INFINITY, f64::INFINITY));
    }
    let unit = all().map(time_exponent).chain(exponent_of_time(dead_time)).max().unwrap_or(NO_TIME);
    let unit = if unit == NO_TIME { 0 } else { unit };
    out.fill(Double::default());
    if let Some(first) = out.first_mut() {
        *first = Double::new(1.0);
    }
    for p in den {
        divide(out, p.as_ref(), unit);
    }
    for p in num {
        multiply(out, p.as_ref(), unit);
    }
    delay(out, libm::scalbn(dead_time, -unit));
    for (k, area) in (0..).zip(out.iter_mut()) {
        let scaled = area.times(gain).scaled(unit.saturating_mul(k));
        // A subnormal number has lost digits; 0 is right only where the area is 0.
        if !scaled.hi.is_finite() || (scaled.hi.abs() < f64::MIN_POSITIVE && area.hi != 0.0) {
            return Err(Refusal::Plant {
                must: "have a gain and time constants whose powers fit into double precision",
                help: "write the plant in a unit of time in which its time constants are near 1",
            });
        }
        *area = scaled;
    }
    Ok(())
}

/// Of a polynomial without any time constant.
const NO_TIME: i32 = i32::MIN;

/// The exponent of the least power of two that is a longer time than every `|c_i|^(1/i)`.
fn time_exponent(p: &[f64]) -> i32 {
    let coefficients = (1..).zip(p.iter().skip(1)).filter(|(_, c)| **c != 0.0);
    coefficients.map(|(i, &c)| ceil_div(exponent(c), i)).max().unwrap_or(NO_TIME)
}

fn exponent_of_time(time: f64) -> Option<i32> {
    (time != 0.0).then(|| exponent(time))
}

fn ceil_div(a: i32, b: i32) -> i32 {
    a.div_euclid(b) + i32::from(a.rem_euclid(b) != 0)
}

/// The coefficient of `x^i`, `x = -s` in the chosen unit of time.
fn coefficient(p: &[f64], i: usize, unit: i32) -> f64 {
    let c = p.get(i).copied().unwrap_or(0.0);
    let power = i32::try_from(i).unwrap_or(i32::MAX);
    libm::scalbn(if i.is_multiple_of(2) { c } else { -c }, unit.saturating_mul(power).saturating_neg())
}

fn multiply(g: &mut [Double], p: &[f64], unit: i32) {
    for k in (0..g.len()).rev() {
        for i in 1..p.len().min(k + 1) {
            g[k] = g[k].add(g[k - i].times(coefficient(p, i, unit)));
        }
    }
}

fn divide(g: &mut [Double], p: &[f64], unit: i32) {
    for k in 0..g.len() {
        for i in 1..p.len().min(k + 1) {
            g[k] = g[k].sub(g[k - i].times(coefficient(p, i, unit)));
        }
    }
}

/// Multiplies by `exp(x*dead_time)`.
fn delay(g: &mut [Double], dead_time: f64) {
    if dead_time == 0.0 {
        return;
    }
    for k in (0..g.len()).rev() {
        let mut term = Double::new(1.0);
        for i in 1..=k {
            term = term.times(dead_time).div(Double::new(as_f64(i)));
            g[k] = g[k].add(term.mul(g[k - i]));
        }
    }
}

/// Whether every root of the polynomial is in the open left half-plane, by Routh's scheme. A root on the imaginary
/// axis is not.
pub(super) fn is_stable(p: &[f64]) -> bool {
    let unit = match time_exponent(p) {
        NO_TIME => return true,
        unit => unit,
    };
    let mut c = [Double::default(); MAX_COEFFICIENTS];
    if p.len() > c.len() || p.iter().any(|c| !c.is_finite()) {
        return false;
    }
    let mut length = 0;
    for i in 0..p.len() {
        let given = p[i];
        let scaled = coefficient(p, i, unit);
        c[i] = Double::new(if i.is_multiple_of(2) { scaled } else { -scaled });
        if given < 0.0 || (given == 0.0 && p[i..].iter().any(|c| *c != 0.0)) {
            return false;
        }
        // A pole too fast for this unit of time is dropped: it cannot be the one that is unstable.
        if c[i].hi > 0.0 {
            length = i + 1;
        }
    }
    // The polynomial in 1/s has its roots in the same half-plane; its scheme starts from the constant term.
    let c = &mut c[..length];
    // `c[first]`, `c[first + 2]`, ... is one row, `c[first + 1]`, `c[first + 3]`, ... the next; the row after is
    // written over the first.
    for first in 0..length.saturating_sub(2) {
        let (top, pivot) = (c[first], c[first + 1]);
        if pivot.hi.is_nan() || pivot.hi <= 0.0 {
            return false;
        }
        let ratio = top.div(pivot);
        let mut i = first + 2;
        while i < length {
            let below = c.get(i + 1).copied().unwrap_or_default();
            let product = ratio.mul(below);
            let rest = c[i].sub(product);
            // What rounding leaves of an exact 0: a root on the imaginary axis.
            c[i] = if rest.hi.abs() <= 1e-28 * product.hi.abs() { Double::default() } else { rest };
            i += 2;
        }
    }
    c.iter().all(|c| c.hi > 0.0)
}

fn out_of_range(parameter: &'static str, value: f64, min: f64, max: f64) -> Refusal {
    Refusal::OutOfRange { parameter, value, min, max }
}

#[allow(clippy::cast_precision_loss)] // counts are far below 2^52
const fn as_f64(n: usize) -> f64 {
    n as f64
}
