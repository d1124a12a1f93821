//! How unevenly a sampled loop's output may come.

use core::f64::consts::PI;

use super::sampled::DiscreteLoop;
use super::sweep::Sweep;
use crate::model::{Complex, TransferFunction};

/// Images of the plant's response on either side that are added one by one; the rest is integrated.
const IMAGES: u32 = 12;
/// Points in each decade of that integral, and decades.
const PER_DECADE: u32 = 40;
const DECADES: u32 = 8;

/// The jitter margin in s.
///
/// Late by `d[k]` in `0..J` samples, the output adds to the plant's input what is left of the increments
/// `w = (1 - 1/z) u` that have not arrived. With `n = floor(J)`, `g = J - n` the energy of that is at most
/// `ts*(n^2 + 2*n*g + g)` times that of `w`: for the share `g` of a sample `n+1` increments are missing, else `n`. Back to
/// `w` it is `|1 - 1/z|*A*|u/n|`, `A^2` the sum of `|G(j*w)|^2` over `w` and all its images, by the inequality of Cauchy and
/// Schwarz. A product below 1 is stable by the small-gain theorem.
pub(super) fn jitter_margin(held: &DiscreteLoop, sweep: &Sweep) -> f64 {
    let images = Images::new(held.plant(), held.ts());
    let (_, gain) = sweep.peak(held, |p| {
        let increment = 2.0 * libm::sin(0.5 * p.theta);
        increment * images.at(p.theta) * p.noise().abs()
    });
    let power = 1.0 / (gain * gain);
    let whole = libm::floor(libm::sqrt(power));
    if !whole.is_finite() {
        return f64::INFINITY;
    }
    (whole + (power - whole * whole) / (2.0 * whole + 1.0)) * held.ts()
}

/// The size of a plant's response with all its images.
struct Images<'a> {
    plant: &'a TransferFunction,
    ts: f64,
    /// Of the images that are not added one by one.
    rest: f64,
}

impl<'a> Images<'a> {
    fn new(plant: &'a TransferFunction, ts: f64) -> Self {
        let power = |w: f64| size(plant, w);
        // Both sides: the sum over k > IMAGES is the integral from IMAGES + 1/2 to within the curvature of what falls by
        // then at least as 1/w^2, a thousandth of a part that is itself a hundredth.
        let from = (f64::from(IMAGES) + 0.5) * 2.0 * PI / ts;
        let ratio = libm::exp(core::f64::consts::LN_10 / f64::from(PER_DECADE));
        let (mut w, mut sum, mut before) = (from, 0.0, from * power(from));
        for _ in 0..PER_DECADE * DECADES {
            w *= ratio;
            let here = w * power(w);
            sum += 0.5 * (before + here) * libm::log(ratio);
            before = here;
        }
        Self { plant, ts, rest: 2.0 * sum * ts / (2.0 * PI) }
    }

    fn at(&self, theta: f64) -> f64 {
        let one = |k: f64| size(self.plant, (theta + 2.0 * PI * k) / self.ts);
        let near: f64 = (1..=IMAGES).map(|k| one(f64::from(k)) + one(-f64::from(k))).sum();
        libm::sqrt(one(0.0) + near + self.rest)
    }
}

/// `|G(j*w)|^2`; the dead time has no part in it.
fn size(plant: &TransferFunction, w: f64) -> f64 {
    let size = plant.at(Complex::new(0.0, w)).abs();
    size * size
}
