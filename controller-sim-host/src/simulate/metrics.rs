//! The indices of a response.

/// Indices over one stretch of time. `e = r - y` is the continuous error, except in `ie`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Metrics {
    /// Integral of the error, `ts*sum(e[k])` over the samples \[y*s\]: the form for which the identities are exact.
    pub ie: f64,
    /// Integral of the absolute error \[y*s\].
    pub iae: f64,
    /// Integral of the squared error \[y^2*s\].
    pub ise: f64,
    /// Integral of time times absolute error \[y*s^2\]; the clock starts with the stretch.
    pub itae: f64,
    /// Largest absolute error \[y\].
    pub e_max: f64,
    /// Total variation of the output, `sum |u[k]-u[k-1]|` \[u\].
    pub tv: f64,
}

impl Metrics {
    /// Adds the step from `(t0, e0)` to `(t1, e1)`, times since the start of the stretch. The error is taken as
    /// linear in between; with a change of sign its zero is found, so that `|e|` is integrated exactly.
    #[inline]
    pub fn add_step(&mut self, (t0, e0): (f64, f64), (t1, e1): (f64, f64)) {
        let h = t1 - t0;
        if h <= 0.0 {
            return;
        }
        if e0 * e1 < 0.0 {
            let middle = t0 + h * (e0 / (e0 - e1));
            self.add_one_sign((t0, e0), (middle, 0.0));
            self.add_one_sign((middle, 0.0), (t1, e1));
        } else {
            self.add_one_sign((t0, e0), (t1, e1));
        }
        self.ise += h * (1.0 / 3.0) * (e0 * e0 + e0 * e1 + e1 * e1);
        for e in [e0, e1] {
            if e.abs() > self.e_max {
                self.e_max = e.abs();
            }
        }
    }

    #[inline]
    fn add_one_sign(&mut self, (t0, e0): (f64, f64), (t1, e1): (f64, f64)) {
        let h = t1 - t0;
        let (a, b) = (e0.abs(), e1.abs());
        self.iae += 0.5 * h * (a + b);
        // Integral of t*|e| for |e| linear: Simpson's rule is exact.
        self.itae += h * (1.0 / 6.0) * (t0 * a + (t0 + t1) * (a + b) + t1 * b);
    }

    /// Adds a sample: error `e`, output `u` after `u_before`.
    #[inline]
    pub fn add_sample(&mut self, ts: f64, e: f64, u_before: f64, u: f64) {
        self.ie += ts * e;
        self.tv += (u - u_before).abs();
    }

    /// The two stretches as one; the second one's ITAE keeps its own clock.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            ie: self.ie + other.ie,
            iae: self.iae + other.iae,
            ise: self.ise + other.ise,
            itae: self.itae + other.itae,
            e_max: if other.e_max > self.e_max { other.e_max } else { self.e_max },
            tv: self.tv + other.tv,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_zero_is_integrated_exactly() {
        let mut m = Metrics::default();
        m.add_step((0.0, 1.0), (2.0, -1.0));
        assert_eq!((m.iae, m.e_max), (1.0, 1.0));
        assert!((m.ise - 2.0 / 3.0).abs() < 1e-15);
        // Integral of t*|1-t| over 0..2 is 1.
        assert!((m.itae - 1.0).abs() < 1e-15);
    }
}
