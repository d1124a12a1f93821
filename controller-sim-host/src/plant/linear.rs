//! A linear plant that moves exactly through time.

use super::dense::Matrix;
use super::state_space::StateSpace;

/// The plant's input over one step: `value` at its beginning, rising by `slope` per second.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Input {
    /// At the beginning of the step \[u\].
    pub value: f64,
    /// \[u/s\].
    pub slope: f64,
}

/// The rational part of a plant with its state. The dead time is the caller's business: it hands in the delayed input.
///
/// Exact for inputs that are linear over a step: `x <- Phi*x + G0*w + G1*w'`, from one matrix exponential per length of
/// step.
#[derive(Debug, Clone)]
pub struct LinearPlant {
    system: StateSpace,
    x: Vec<f64>,
    next: Vec<f64>,
    lengths: Vec<(f64, Matrix)>,
}

/// Lengths of steps whose exponentials are kept.
const KEPT: usize = 64;

impl LinearPlant {
    /// A plant with the state `x`.
    #[must_use]
    pub fn new(system: StateSpace, x: Vec<f64>) -> Self {
        let next = x.clone();
        Self { system, x, next, lengths: Vec::new() }
    }

    /// The output for the input `w` just before the present instant \[y\].
    #[must_use]
    pub fn output(&self, w: f64) -> f64 {
        self.system.c.iter().zip(&self.x).map(|(c, x)| c * x).sum::<f64>() + self.system.d * w
    }

    /// Moves through `h` seconds.
    pub fn advance(&mut self, h: f64, input: Input) {
        let n = self.x.len();
        if n == 0 {
            return;
        }
        let index = match self.lengths.iter().position(|(length, _)| *length == h) {
            Some(index) => index,
            None => {
                if self.lengths.len() == KEPT {
                    self.lengths.pop();
                }
                self.lengths.push((h, self.propagator(h)));
                self.lengths.len() - 1
            }
        };
        let propagator = &self.lengths[index].1;
        let slope = input.slope * self.system.scale;
        for (i, next) in self.next.iter_mut().enumerate() {
            let row = propagator.row(i);
            let mut sum = row[n] * input.value + row[n + 1] * slope;
            for (a, x) in row.iter().zip(&self.x) {
                sum += a * x;
            }
            *next = sum;
        }
        std::mem::swap(&mut self.x, &mut self.next);
    }

    /// `exp` of the system with the input and its slope as two more states.
    fn propagator(&self, h: f64) -> Matrix {
        let n = self.x.len();
        let mut m = Matrix::zero(n + 2);
        for i in 0..n {
            for j in 0..n {
                *m.at_mut(i, j) = self.system.a.at(i, j);
            }
            *m.at_mut(i, n) = self.system.b[i];
        }
        *m.at_mut(n, n + 1) = 1.0;
        m.exp(h / self.system.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_design::model::parse;

    /// Response at `t = 3` to a unit step and to a unit ramp, through steps of odd lengths.
    fn at_three(expression: &str) -> (f64, f64) {
        let plant = parse(expression).expect("a plant");
        let respond = |value: f64, slope: f64| {
            let system = StateSpace::new(&plant, 0.7);
            let order = system.order();
            let mut plant = LinearPlant::new(system, vec![0.0; order]);
            let mut t = 0.0;
            for h in [0.5, 0.25, 1.5, 0.75] {
                plant.advance(h, Input { value: value + slope * t, slope });
                t += h;
            }
            plant.output(value + slope * t)
        };
        (respond(1.0, 0.0), respond(0.0, 1.0))
    }

    #[test]
    fn closed_forms_are_met() {
        let e = |x: f64| libm::exp(-x);
        // 2/(1+2s): step 2(1-e^-t/2), ramp 2(t - 2 + 2e^-t/2).
        let (step, ramp) = at_three("2/(1+2*s)");
        assert!((step - 2.0 * (1.0 - e(1.5))).abs() < 1e-14, "{step}");
        assert!((ramp - 2.0 * (1.0 + 2.0 * e(1.5))).abs() < 1e-14, "{ramp}");
        // 1/(1+s)^3: 1 - e^-t (1 + t + t^2/2).
        let (step, _) = at_three("1/(1+s)^3");
        assert!((step - (1.0 - e(3.0) * 8.5)).abs() < 1e-14, "{step}");
        // (1-s)/(s(1+s)): t - 2(1-e^-t) for a step.
        let (step, _) = at_three("(1-s)/(s*(1+s))");
        assert!((step - (3.0 - 2.0 * (1.0 - e(3.0)))).abs() < 1e-14, "{step}");
        // 1/(1+s^2): 1 - cos t; double integrator: t^2/2 and t^3/6.
        let (step, _) = at_three("1/(1+s^2)");
        assert!((step - (1.0 - libm::cos(3.0))).abs() < 1e-14, "{step}");
        let (step, ramp) = at_three("1/s^2");
        assert!((step - 4.5).abs() < 1e-14 && (ramp - 4.5).abs() < 1e-14, "{step} {ramp}");
        // Not strictly proper: (2+3s)/(1+s) = 3 - 1/(1+s).
        let (step, _) = at_three("(2+3*s)/(1+s)");
        assert!((step - (3.0 - (1.0 - e(3.0)))).abs() < 1e-14, "{step}");
    }

    #[test]
    fn plants_rest_where_they_are_put() {
        for expression in
            ["2/(1+2*s)", "1/(s*(1+3*s)^2)", "(1-s)/(s*(1+s))", "0.5*(1+4*s)/(1+s+s^2)", "3/s^2"]
        {
            let plant = parse(expression).expect("a plant");
            let system = StateSpace::new(&plant, 0.1);
            let (x, w) = system.rest(7.0).expect("a rest");
            let mut plant = LinearPlant::new(system, x);
            assert!((plant.output(w) - 7.0).abs() < 1e-12, "{expression}");
            for _ in 0..50 {
                plant.advance(0.3, Input { value: w, slope: 0.0 });
            }
            assert!((plant.output(w) - 7.0).abs() < 1e-9, "{expression}: {}", plant.output(w));
        }
    }
}
