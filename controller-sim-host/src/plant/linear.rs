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

/// A sine in the input at one instant, with its quadrature: `sin` is what it adds \[u\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wave {
    /// `amplitude * sin(angle)` \[u\].
    pub sin: f64,
    /// `amplitude * cos(angle)` \[u\].
    pub cos: f64,
}

/// The rational part of a plant with its state. The dead time is the caller's business: it hands in the delayed input.
///
/// Exact for inputs that are linear over a step, and sines of known frequencies: `x <- Phi*x + G0*w + G1*w'` (and
/// `+ Gs*sin + Gc*cos`), from one matrix exponential per length of step.
#[derive(Debug, Clone)]
pub struct LinearPlant {
    system: StateSpace,
    /// Angular frequencies of the sines \[rad/s\].
    frequencies: Vec<f64>,
    /// Number of states.
    order: usize,
    /// The states, and zeros up to [`SMALL`] of them.
    x: Vec<f64>,
    /// The weights of the states in the output, as long as `x`.
    c: Vec<f64>,
    next: Vec<f64>,
    /// `c*x`: the output without feed-through.
    inside: f64,
    steps: Vec<Step>,
}

/// How the state moves over a step of one length.
#[derive(Debug, Clone)]
struct Step {
    h: f64,
    /// A column for each state, the input, its slope, sine and quadrature of each frequency; as long as there are states.
    columns: Vec<f64>,
    /// The same of a small plant without sines, for loops of known length.
    small: [f64; SMALL * (SMALL + 2)],
}

/// Most states of a plant whose steps have a length that the compiler knows.
const SMALL: usize = 6;

/// Lengths of steps whose matrices are kept, besides those that were prepared.
const KEPT: usize = 64;

impl LinearPlant {
    /// A plant with the state `x`.
    #[must_use]
    pub fn new(system: StateSpace, x: Vec<f64>) -> Self {
        Self::with_waves(system, x, Vec::new())
    }

    /// A plant with the state `x`, whose input has sines of these angular frequencies \[rad/s\].
    #[must_use]
    pub fn with_waves(system: StateSpace, x: Vec<f64>, frequencies: Vec<f64>) -> Self {
        let inside = dot(&system.c, &x);
        let order = x.len();
        let (mut x, mut c) = (x, system.c.clone());
        x.resize(order.max(SMALL), 0.0);
        c.resize(order.max(SMALL), 0.0);
        let next = vec![0.0; order];
        Self { system, frequencies, order, x, c, next, inside, steps: Vec::new() }
    }

    /// The output for the input `w` just before the present instant \[y\].
    #[must_use]
    #[inline]
    pub fn output(&self, w: f64) -> f64 {
        self.inside + self.system.d * w
    }

    /// Prepares steps of `h` seconds; the number that [`advance_by`](Self::advance_by) knows them by.
    pub fn prepare(&mut self, h: f64) -> usize {
        if let Some(index) = self.steps.iter().position(|step| step.h == h) {
            return index;
        }
        let columns = self.columns(h);
        let mut small = [0.0; SMALL * (SMALL + 2)];
        small.iter_mut().zip(&columns).for_each(|(to, from)| *to = *from);
        self.steps.push(Step { h, columns, small });
        self.steps.len() - 1
    }

    /// Moves through `h` seconds; `waves` has one entry for each frequency.
    pub fn advance(&mut self, h: f64, input: Input, waves: &[Wave]) {
        match self.steps.iter().position(|step| step.h == h) {
            Some(index) => self.advance_by(index, input, waves),
            None => {
                let index = self.prepare(h);
                self.advance_by(index, input, waves);
                if index >= KEPT {
                    self.steps.pop();
                }
            }
        }
    }

    /// Moves through a prepared step; an unknown number moves nothing.
    #[inline]
    pub fn advance_by(&mut self, index: usize, input: Input, waves: &[Wave]) {
        if !waves.is_empty() {
            return self.advance_large(index, input, waves);
        }
        // Most plants are small: loops of known length cost a third. The order of the sums is the same for all.
        match self.order {
            0 => {}
            1 => self.advance_small::<1>(index, input),
            2 => self.advance_small::<2>(index, input),
            3 => self.advance_small::<3>(index, input),
            4 => self.advance_small::<4>(index, input),
            5 => self.advance_small::<5>(index, input),
            6 => self.advance_small::<6>(index, input),
            _ => self.advance_large(index, input, &[]),
        }
    }

    /// A step of a plant of `N` states without sines.
    #[inline]
    fn advance_small<const N: usize>(&mut self, index: usize, input: Input) {
        let (Some(step), Some(x), Some(c)) =
            (self.steps.get(index), self.x.first_chunk_mut::<N>(), self.c.first_chunk::<N>())
        else {
            return;
        };
        let inputs = [input.value, input.slope * self.system.scale];
        let (columns, _) = step.small.as_chunks::<N>();
        let mut next = [0.0; N];
        for j in 0..2 {
            for i in 0..N {
                next[i] += columns[N + j][i] * inputs[j];
            }
        }
        for j in 0..N {
            for i in 0..N {
                next[i] += columns[j][i] * x[j];
            }
        }
        *x = next;
        self.inside = dot(c, &next);
    }

    #[inline(never)]
    fn advance_large(&mut self, index: usize, input: Input, waves: &[Wave]) {
        let n = self.order;
        let (Some(step), false) = (self.steps.get(index), n == 0) else { return };
        let inputs = [input.value, input.slope * self.system.scale];
        self.next.fill(0.0);
        let of_waves = waves.iter().flat_map(|wave| [wave.sin, wave.cos]);
        let (of_states, of_inputs) = step.columns.split_at(n * n);
        let factors = inputs.into_iter().chain(of_waves);
        for (column, factor) in of_inputs.chunks_exact(n).zip(factors) {
            self.next.iter_mut().zip(column).for_each(|(next, a)| *next += a * factor);
        }
        for (column, factor) in of_states.chunks_exact(n).zip(&self.x) {
            self.next.iter_mut().zip(column).for_each(|(next, a)| *next += a * factor);
        }
        self.x[..n].copy_from_slice(&self.next);
        self.inside = dot(&self.system.c, &self.next);
    }

    /// `exp` of the system with the input, its slope and the sines as more states.
    fn columns(&self, h: f64) -> Vec<f64> {
        let n = self.order;
        let scale = self.system.scale;
        let size = n + 2 + 2 * self.frequencies.len();
        let mut m = Matrix::zero(size);
        for i in 0..n {
            for j in 0..n {
                *m.at_mut(i, j) = self.system.a.at(i, j);
            }
            *m.at_mut(i, n) = self.system.b[i];
            for wave in 0..self.frequencies.len() {
                *m.at_mut(i, n + 2 + 2 * wave) = self.system.b[i];
            }
        }
        *m.at_mut(n, n + 1) = 1.0;
        for (wave, omega) in self.frequencies.iter().enumerate() {
            let sine = n + 2 + 2 * wave;
            *m.at_mut(sine, sine + 1) = omega * scale;
            *m.at_mut(sine + 1, sine) = -omega * scale;
        }
        let exp = m.exp(h / scale);
        (0..size).flat_map(|j| (0..n).map(move |i| (i, j))).map(|(i, j)| exp.at(i, j)).collect()
    }
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
                plant.advance(h, Input { value: value + slope * t, slope }, &[]);
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

    /// Through a lag, `sin(w*t)` becomes `(sin(w*t) - w*tau*cos(w*t) + w*tau*exp(-t/tau))/(1 + (w*tau)^2)`.
    #[test]
    fn a_sine_is_followed_exactly() {
        let (tau, omega) = (2.0, 3.0);
        let system = StateSpace::new(&parse("1/(1+2*s)").expect("a plant"), 0.7);
        let mut plant = LinearPlant::with_waves(system, vec![0.0], vec![omega]);
        let mut t = 0.0;
        for h in [0.5, 0.25, 1.5, 0.75] {
            let wave = Wave { sin: libm::sin(omega * t), cos: libm::cos(omega * t) };
            plant.advance(h, Input::default(), &[wave]);
            t += h;
        }
        let (w, at) = (omega * tau, omega * t);
        let exact = (libm::sin(at) - w * libm::cos(at) + w * libm::exp(-t / tau)) / (1.0 + w * w);
        assert!((plant.output(0.0) - exact).abs() < 1e-14, "{} {exact}", plant.output(0.0));
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
                plant.advance(0.3, Input { value: w, slope: 0.0 }, &[]);
            }
            assert!((plant.output(w) - 7.0).abs() < 1e-9, "{expression}: {}", plant.output(w));
        }
    }
}
