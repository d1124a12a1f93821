//! Exact response of a chain of lags with dead time to a held input, at any instants.

/// Most states of a chain.
pub(super) const MOST_STATES: usize = 4;

type Matrix = [[f64; MOST_STATES]; MOST_STATES];
type State = [f64; MOST_STATES];

/// Lags below this share of the time scale of the record act as none.
const NO_LAG: f64 = 1e-9;
/// Step lengths whose transition is remembered.
const REMEMBERED: usize = 6;

/// One factor `1/(1 + a1*s + a2*s^2)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lag {
    pub(super) a1: f64,
    pub(super) a2: f64,
}

/// The instants at which the input changes and by how much.
#[derive(Debug, Clone, Default)]
pub(super) struct Moves {
    pub(super) at: Vec<f64>,
    pub(super) by: Vec<f64>,
}

/// How a state hangs together with the others, for the slope of the output.
#[derive(Debug, Clone, Copy)]
enum Output {
    /// No lag at all: the output is the input.
    None,
    /// The last state is the output of a lag of first order.
    First { state: usize, before: Option<usize>, a1: f64 },
    /// The last two states are the output and its slope times `root`.
    Second { state: usize, root: f64 },
}

/// A chain of lags with unit gain, prepared for propagation.
///
/// The state holds deviations from the held input, so that a settled chain is all zeros and a step of the input
/// is one subtraction.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    order: usize,
    matrix: Matrix,
    /// Which states follow the input.
    follows: [bool; MOST_STATES],
    output: Output,
    norm: f64,
    known: Vec<(f64, Matrix)>,
    oldest: usize,
}

impl Chain {
    /// The lags in the order the signal passes them.
    pub(super) fn new(lags: &[Lag]) -> Self {
        let mut chain = Self {
            order: 0,
            matrix: [[0.0; MOST_STATES]; MOST_STATES],
            follows: [false; MOST_STATES],
            output: Output::None,
            norm: 0.0,
            known: Vec::new(),
            oldest: 0,
        };
        let mut before: Option<usize> = None;
        for lag in lags {
            before = chain.push(*lag, before).or(before);
        }
        let row = |row: &[f64; MOST_STATES]| row.iter().map(|x| x.abs()).sum::<f64>();
        chain.norm = chain.matrix.iter().map(row).fold(0.0, f64::max);
        chain
    }

    /// Adds a lag; the index of its output, if it has a state.
    fn push(&mut self, lag: Lag, before: Option<usize>) -> Option<usize> {
        let n = self.order;
        let (a1, a2) = (lag.a1.max(0.0), lag.a2.max(0.0));
        if a2 <= NO_LAG * NO_LAG || a2 <= 1e-8 * a1 * a1 {
            if a1 <= NO_LAG || n >= MOST_STATES {
                return None;
            }
            self.matrix[n][n] = -1.0 / a1;
            if let Some(input) = before {
                self.matrix[n][input] = 1.0 / a1;
            }
            self.output = Output::First { state: n, before, a1 };
            self.follows[n] = true;
            self.order = n + 1;
            return Some(n);
        }
        if n + 2 > MOST_STATES {
            return None;
        }
        let root = libm::sqrt(a2);
        self.matrix[n][n + 1] = 1.0 / root;
        self.matrix[n + 1][n] = -1.0 / root;
        self.matrix[n + 1][n + 1] = -a1 / a2;
        if let Some(input) = before {
            self.matrix[n + 1][input] = 1.0 / root;
        }
        self.output = Output::Second { state: n, root };
        self.follows[n] = true;
        self.order = n + 2;
        Some(n)
    }

    /// The output and its slope at the rising instants `times`, for an input that is 0 before `moves`, all of it
    /// later by `dead_time`.
    pub(super) fn response(&mut self, times: &[f64], moves: &Moves, dead_time: f64) -> (Vec<f64>, Vec<f64>) {
        let mut state = [0.0; MOST_STATES];
        let mut values = Vec::with_capacity(times.len());
        let mut slopes = Vec::with_capacity(times.len());
        let (mut input, mut now, mut next) = (0.0, f64::NEG_INFINITY, 0);
        for &t in times {
            while let (Some(&at), Some(&by)) = (moves.at.get(next), moves.by.get(next)) {
                let at = at + dead_time;
                if at > t {
                    break;
                }
                self.propagate(&mut state, at - now);
                now = at;
                input += by;
                for (x, follows) in state.iter_mut().zip(self.follows) {
                    *x -= if follows { by } else { 0.0 };
                }
                next += 1;
            }
            self.propagate(&mut state, t - now);
            now = t;
            let (value, slope) = self.read(&state, input);
            values.push(value);
            slopes.push(slope);
        }
        (values, slopes)
    }

    fn read(&self, state: &State, input: f64) -> (f64, f64) {
        match self.output {
            Output::None => (input, 0.0),
            Output::First { state: n, before, a1 } => {
                let driven = before.map_or(0.0, |before| state[before]);
                (input + state[n], (driven - state[n]) / a1)
            }
            Output::Second { state: n, root } => (input + state[n], state[n + 1] / root),
        }
    }

    fn propagate(&mut self, state: &mut State, span: f64) {
        // Nothing has moved before the first change.
        if span <= 0.0 || !span.is_finite() || state.iter().all(|x| *x == 0.0) {
            return;
        }
        let near = |known: f64| (known - span).abs() <= 1e-15 + 1e-12 * span;
        if let Some((_, matrix)) = self.known.iter().find(|(known, _)| near(*known)) {
            *state = times_vector(matrix, state, self.order);
            return;
        }
        if self.known.len() == REMEMBERED && self.norm * span <= 2.0 {
            *state = self.series(state, span);
            return;
        }
        let matrix = self.transition(span);
        if self.known.len() < REMEMBERED {
            self.known.push((span, matrix));
        } else if let Some(place) = self.known.get_mut(self.oldest) {
            *place = (span, matrix);
            self.oldest = (self.oldest + 1) % REMEMBERED;
        }
        *state = times_vector(&matrix, state, self.order);
    }

    /// `exp(matrix*span)*state` by its series, for short spans.
    fn series(&self, state: &State, span: f64) -> State {
        let (mut sum, mut term) = (*state, *state);
        for k in 1..=24 {
            term = times_vector(&self.matrix, &term, self.order);
            let factor = span / f64::from(k);
            let mut size = 0.0_f64;
            for i in 0..self.order {
                term[i] *= factor;
                sum[i] += term[i];
                size = size.max(term[i].abs());
            }
            if size < 1e-18 {
                break;
            }
        }
        sum
    }

    /// `exp(matrix*span)` by scaling and squaring.
    fn transition(&self, span: f64) -> Matrix {
        let mut halvings = 0;
        let mut scale = span;
        while self.norm * scale > 0.5 && halvings < 200 {
            scale *= 0.5;
            halvings += 1;
        }
        let mut sum = identity();
        let mut term = identity();
        for k in 1..=14 {
            term = product(&term, &self.matrix, self.order);
            for (row, add) in sum.iter_mut().zip(&mut term) {
                for (x, a) in row.iter_mut().zip(add) {
                    *a *= scale / f64::from(k);
                    *x += *a;
                }
            }
        }
        for _ in 0..halvings {
            sum = product(&sum, &sum, self.order);
        }
        sum
    }
}

fn identity() -> Matrix {
    let mut matrix = [[0.0; MOST_STATES]; MOST_STATES];
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    matrix
}

fn product(a: &Matrix, b: &Matrix, order: usize) -> Matrix {
    let mut c = [[0.0; MOST_STATES]; MOST_STATES];
    for i in 0..order {
        for k in 0..order {
            for j in 0..order {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    c
}

fn times_vector(a: &Matrix, x: &State, order: usize) -> State {
    let mut y = [0.0; MOST_STATES];
    for i in 0..order {
        for j in 0..order {
            y[i] += a[i][j] * x[j];
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::{Chain, Lag, Moves};

    #[test]
    fn a_step_and_its_reversal_follow_the_closed_form() {
        // 1/(1+s)(1+0.2s), dead time 0.37; up at 0, down to -0.5 at 1.3.
        let mut chain = Chain::new(&[Lag { a1: 1.2, a2: 0.2 }]);
        let moves = Moves { at: vec![0.0, 1.3], by: vec![1.0, -1.5] };
        let times: Vec<f64> = (0..200).map(|i| 0.013 * f64::from(i * i) / 40.0).collect();
        let (y, slope) = chain.response(&times, &moves, 0.37);
        let step = |t: f64| if t <= 0.0 { 0.0 } else { 1.0 - 1.25 * (-t).exp() + 0.25 * (-5.0 * t).exp() };
        let rise = |t: f64| if t <= 0.0 { 0.0 } else { 1.25 * ((-t).exp() - (-5.0 * t).exp()) };
        for ((t, y), d) in times.iter().zip(y).zip(slope) {
            let (a, b) = (t - 0.37, t - 1.67);
            assert!((y - (step(a) - 1.5 * step(b))).abs() < 1e-13, "{t}: {y}");
            assert!((d - (rise(a) - 1.5 * rise(b))).abs() < 1e-12, "{t}: {d}");
        }
    }

    #[test]
    fn four_lags_of_which_two_turn_follow_the_closed_form() {
        // (1+s)^2 in front of a quadratic with poles at -0.2 +- j: against a series of small Euler steps is too
        // coarse, so against four equal lags, 1 - exp(-t)(1 + t + t^2/2 + t^3/6), and the pair alone.
        let times: Vec<f64> = (0..300).map(|i| 0.05 * f64::from(i) + 1e-3 * f64::from(i % 7)).collect();
        let moves = Moves { at: vec![0.0], by: vec![1.0] };
        let mut chain = Chain::new(&[Lag { a1: 2.0, a2: 1.0 }, Lag { a1: 2.0, a2: 1.0 }]);
        let (y, _) = chain.response(&times, &moves, 0.0);
        for (t, y) in times.iter().zip(y) {
            let exact = 1.0 - (-t).exp() * (1.0 + t + t * t / 2.0 + t * t * t / 6.0);
            assert!((y - exact).abs() < 1e-13, "{t}: {y} {exact}");
        }
        let a2 = 1.0 / 1.04;
        let mut pair = Chain::new(&[Lag { a1: 0.4 * a2, a2 }]);
        let (y, _) = pair.response(&times, &moves, 0.0);
        for (t, y) in times.iter().zip(y) {
            let exact = 1.0 - (-0.2 * t).exp() * (t.cos() + 0.2 * t.sin());
            assert!((y - exact).abs() < 1e-13, "{t}: {y} {exact}");
        }
    }

    #[test]
    fn stiff_and_vanishing_lags_do_not_matter() {
        let times: Vec<f64> = (0..50).map(|i| 0.1 * f64::from(i)).collect();
        let moves = Moves { at: vec![0.0], by: vec![1.0] };
        let mut plain = Chain::new(&[Lag { a1: 1.0, a2: 0.0 }]);
        let (plain, _) = plain.response(&times, &moves, 0.25);
        for tiny in [1e-300, 1e-12, 1e-7] {
            let mut stiff = Chain::new(&[Lag { a1: tiny, a2: 0.0 }, Lag { a1: 1.0 + tiny, a2: tiny }]);
            let (y, _) = stiff.response(&times, &moves, 0.25);
            for (a, b) in plain.iter().zip(y) {
                assert!((a - b).abs() <= 4.0 * tiny + 1e-14, "{tiny}: {a} {b}");
            }
        }
    }
}
