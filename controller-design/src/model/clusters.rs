//! Multiple roots: clusters of computed roots that one root explains as well.
//!
//! Rounding splits an `m`-fold root into `m` roots around it, a distance of about `eps^(1/m)` away. Their mean is
//! nearly as accurate as a simple root. When one root in its place, corrected with the others, leaves every
//! coefficient of the polynomial within rounding, it is as good an answer as the cluster and a plainer one.

use std::vec::Vec;

use controller_core::plant_model::Factor;

use super::complex::Complex;
use super::correction::{Part, correct, explains};

/// Relative distances within which roots are taken as one, widest first.
const RADII: [f64; 7] = [0.3, 0.1, 3e-2, 1e-2, 1e-3, 1e-5, 1e-7];

/// Factors with multiple roots in place of clusters whose product is still `b` within rounding, if there are any.
pub(crate) fn merge_clusters(factors: &[Factor], b: &[f64]) -> Option<Vec<Factor>> {
    let roots: Vec<Root> = factors.iter().map(Root::of).collect();
    RADII.iter().find_map(|&radius| {
        let mut parts = merged(&roots, radius)?;
        correct(&mut parts, b);
        let factors = || parts.iter().flat_map(|p| (0..p.count).map(|_| p.factor)).collect();
        explains(&parts, b).then(factors)
    })
}

/// The inverse `u` of a root or of the upper of two conjugate roots: factors are `1 - u*x`.
#[derive(Clone, Copy)]
struct Root {
    u: Complex,
    count: usize,
}

impl Root {
    fn of(factor: &Factor) -> Self {
        let re = -0.5 * factor.a1;
        if factor.a2 == 0.0 {
            Self { u: Complex::real(-factor.a1), count: 1 }
        } else {
            let r = libm::sqrt(factor.a2.abs());
            let im = libm::sqrt((r - re.abs()).max(0.0)) * libm::sqrt(r + re.abs());
            Self { u: Complex::new(re, im), count: 2 }
        }
    }

    fn near(&self, other: &Self, radius: f64) -> bool {
        (self.u - other.u).abs() <= radius * self.u.abs().max(other.u.abs())
    }

    /// Within `radius` of its own conjugate, or real.
    fn near_real(&self, radius: f64) -> bool {
        self.u.im <= radius * self.u.abs()
    }
}

/// The factors after replacing each cluster by its mean; nothing when there is no cluster.
fn merged(roots: &[Root], radius: f64) -> Option<Vec<Part>> {
    let mut open = roots.to_vec();
    let mut parts = Vec::new();
    let mut any = false;
    while let Some(seed) = open.pop() {
        let mut cluster = Vec::from([seed]);
        // A root joins when it is near to any that has joined before.
        while let Some(k) = open.iter().position(|root| cluster.iter().any(|c| c.near(root, radius))) {
            cluster.push(open.swap_remove(k));
        }
        let count: usize = cluster.iter().map(|r| r.count).sum();
        let sum = cluster.iter().fold(Complex::ZERO, |sum, r| sum + r.u * r.count as f64);
        let mean = sum * (1.0 / count as f64);
        if cluster.iter().any(|r| r.near_real(radius)) {
            any |= count > 1;
            parts.push(Part::single(mean.re).times(count));
        } else {
            any |= cluster.len() > 1;
            parts.push(Part::pair(mean, mean.conj()).times(cluster.len()));
        }
    }
    any.then_some(parts)
}
