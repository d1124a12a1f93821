//! The ADRC in three other forms, from the observer's poles alone. None shares a coefficient with the runtime.
//!
//! Notation: `h` the sampling period, `q` the sampled observer poles, `Q(z)` their polynomial, `a` the applied output.
//! The model `y'' = b0*(a + d)` sampled is `y = G (a + d)`, `G = g (z+1)/(2 (z-1)^2)`, `g = b0 h^2`.

use controller_core::AdrcConfig;
use controller_tests::oracle::complex::{self, Complex};

type Row = [f64; 3];
type Matrix = [Row; 3];

/// Parameters of a case, the observer by its poles [1/s].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) b0: f64,
    pub(crate) kp: f64,
    pub(crate) kd: f64,
    pub(crate) poles: [Complex; 3],
    pub(crate) h: f64,
}

impl Case {
    /// What a person would write: the gains are the coefficients of the expanded polynomial.
    pub(crate) fn config(&self) -> AdrcConfig {
        let [one, two, three] = self.poles;
        let sum = |x: Complex, y: Complex| (x.0 + y.0, x.1 + y.1);
        let pairs = [(one, two), (two, three), (one, three)].map(|(x, y)| complex::mul(x, y));
        AdrcConfig {
            b0: self.b0,
            kp: self.kp,
            kd: self.kd,
            beta1: -sum(sum(one, two), three).0,
            beta2: sum(sum(pairs[0], pairs[1]), pairs[2]).0,
            beta3: -complex::mul(pairs[0], three).0,
        }
    }

    /// `Q(z)`, highest power first.
    fn q(&self) -> [f64; 4] {
        let mut poly = vec![(1.0, 0.0)];
        for (re, im) in self.poles {
            let size = (re * self.h).exp();
            let q = (size * (im * self.h).cos(), size * (im * self.h).sin());
            poly.push((0.0, 0.0));
            for i in (1..poly.len()).rev() {
                let moved = complex::mul(q, poly[i - 1]);
                poly[i] = (poly[i].0 - moved.0, poly[i].1 - moved.1);
            }
        }
        [poly[0].0, poly[1].0, poly[2].0, poly[3].0]
    }

    fn transition(&self) -> Matrix {
        let h = self.h;
        [[1.0, h, 0.5 * h * h], [0.0, 1.0, h], [0.0, 0.0, 1.0]]
    }

    /// Gains of the current observer for the states `y`, `y'`, `b0 d`: Ackermann's formula for the row `C Phi`.
    fn gains(&self) -> Row {
        let phi = self.transition();
        let [_, q2, q1, q0] = self.q();
        let square = product(&phi, &phi);
        let cube = product(&square, &phi);
        let mut of_phi = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let unit = f64::from(u8::from(i == j));
                of_phi[i][j] = cube[i][j] + q2 * square[i][j] + q1 * phi[i][j] + q0 * unit;
            }
        }
        let last = solve(&[phi[0], square[0], cube[0]], [0.0, 0.0, 1.0]);
        times(&of_phi, last)
    }
}

fn product(x: &Matrix, y: &Matrix) -> Matrix {
    let mut out = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] = (0..3).map(|k| x[i][k] * y[k][j]).sum();
        }
    }
    out
}

fn times(m: &Matrix, v: Row) -> Row {
    m.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
}

/// Cramer's rule.
fn solve(m: &Matrix, right: Row) -> Row {
    let det = |m: &Matrix| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(m);
    [0, 1, 2].map(|column| {
        let mut changed = *m;
        for (row, x) in changed.iter_mut().zip(right) {
            row[column] = x;
        }
        det(&changed) / whole
    })
}

/// A form of the law: gives the output before the limits from `r`, `y` and the output applied since the last sample.
pub(crate) trait Form {
    fn step(&mut self, r: f64, y: f64, a: f64) -> f64;
}

/// The state space of the literature: one matrix for the estimates `y`, `y'`, `b0 d`.
pub(crate) struct StateSpace {
    a: Matrix,
    b: Row,
    l: Row,
    x: Row,
    case: Case,
}

impl StateSpace {
    pub(crate) fn new(case: Case) -> Self {
        let (phi, l) = (case.transition(), case.gains());
        let gamma = [0.5 * case.b0 * case.h * case.h, case.b0 * case.h, 0.0];
        let (mut a, mut b) = (phi, gamma);
        for i in 0..3 {
            for j in 0..3 {
                a[i][j] -= l[i] * phi[0][j];
            }
            b[i] -= l[i] * gamma[0];
        }
        Self { a, b, l, x: [0.0; 3], case }
    }
}

impl Form for StateSpace {
    fn step(&mut self, r: f64, y: f64, a: f64) -> f64 {
        let moved = times(&self.a, self.x);
        for i in 0..3 {
            self.x[i] = moved[i] + self.b[i] * a + self.l[i] * y;
        }
        let [z1, z2, z3] = self.x;
        (self.case.kp * (r - z1) - self.case.kd * z2 - z3) / self.case.b0
    }
}

/// Feedback transfer functions `u = kp/b0 r - (P_y y + P_a a)/Q`, by matching each estimate's response: valid with any
/// limits, since `a` is what was applied.
///
/// The innovation is `e = S (y - G a)` with the sensitivity `S = (z-1)^3/Q` of the observer; then `z3 = b0 d` is the sum of
/// `l3 e`, `z2` that of `l2 e + h (z3 + b0 a)`, and `z1 = y - (1 - l1) e`.
pub(crate) struct Feedback {
    q: [f64; 4],
    p_y: [f64; 4],
    p_a: [f64; 4],
    gain: f64,
    y: [f64; 4],
    a: [f64; 4],
    /// The last values of the filtered part, newest first.
    f: [f64; 3],
}

impl Feedback {
    pub(crate) fn new(case: Case) -> Self {
        let q = case.q();
        let [l1, l2, l3] = case.gains();
        let Case { b0, kp, kd, h, .. } = case;
        let half_g = 0.5 * b0 * h * h;
        // Q times the responses from y and from a, highest power of z first; delta = z - 1.
        let e_y = [1.0, -3.0, 3.0, -1.0];
        let e_a = [0.0, -half_g, 0.0, half_g];
        let d_y = [1.0, -2.0, 1.0, 0.0].map(|x| l3 * x);
        let d_a = [0.0, -1.0, -1.0, 0.0].map(|x| l3 * half_g * x);
        // z2 = (l2 z e + h (z3 + b0 a))/delta.
        let slope_y = add(&[1.0, -2.0, 1.0, 0.0].map(|x| l2 * x), &[0.0, 1.0, -1.0, 0.0].map(|x| h * l3 * x));
        // Of a: -l2 half_g z (z+1) - h l3 half_g z (z+1)/delta + h b0 Q/delta. The last two have no pole at 1 together.
        let rest = add(&q.map(|x| h * b0 * x), &[0.0, -1.0, -1.0, 0.0].map(|x| h * l3 * half_g * x));
        let divided = divide_by_delta(&rest);
        let slope_a = add(&[0.0, -1.0, -1.0, 0.0].map(|x| l2 * half_g * x), &divided);
        // z1 = y - (1 - l1) e.
        let z1_y = add(&q, &e_y.map(|x| (l1 - 1.0) * x));
        let z1_a = e_a.map(|x| (l1 - 1.0) * x);
        let sum = |z1: &[f64; 4], z2: &[f64; 4], z3: &[f64; 4]| {
            [0, 1, 2, 3].map(|i| (kp * z1[i] + kd * z2[i] + z3[i]) / b0)
        };
        let (p_y, p_a) = (sum(&z1_y, &slope_y, &d_y), sum(&z1_a, &slope_a, &d_a));
        Self { q, p_y, p_a, gain: kp / b0, y: [0.0; 4], a: [0.0; 4], f: [0.0; 3] }
    }
}

fn add(x: &[f64; 4], y: &[f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| x[i] + y[i])
}

/// The quotient by `z - 1`, of a polynomial that has the root 1 but for rounding.
fn divide_by_delta(p: &[f64; 4]) -> [f64; 4] {
    let [a, b, c, _] = *p;
    [0.0, a, a + b, a + b + c]
}

/// `x[k]`, `x[k-1]`, .. with the newest put in front.
fn push<const N: usize>(line: &mut [f64; N], x: f64) {
    line.rotate_right(1);
    line[0] = x;
}

fn dot<const N: usize>(x: &[f64; N], y: &[f64; N]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

impl Form for Feedback {
    fn step(&mut self, r: f64, y: f64, a: f64) -> f64 {
        push(&mut self.y, y);
        // The highest power of p_a is one below that of Q: it belongs to the output of the last sample.
        push(&mut self.a, a);
        let [_, q2, q1, q0] = self.q;
        let [_, a2, a1, a0] = self.p_a;
        let from_a = dot(&[a2, a1, a0, 0.0], &self.a);
        let f = dot(&self.p_y, &self.y) + from_a - dot(&[q2, q1, q0], &self.f);
        push(&mut self.f, f);
        self.gain * r - f
    }
}

/// The law closed over its own output, `A u = B_r r - B_y y`: two degrees of freedom, no observer left. Written by the
/// error and in increments, `A' du = B_r (r - y) - C dy`, since `A` and `B_y - B_r` have the root 1. Valid as long as
/// nothing limits.
pub(crate) struct ErrorBased {
    a: [f64; 2],
    b_r: [f64; 4],
    c: [f64; 3],
    e: [f64; 4],
    dy: [f64; 3],
    du: [f64; 2],
    y: f64,
    u: f64,
}

impl ErrorBased {
    pub(crate) fn new(case: Case) -> Self {
        let open = Feedback::new(case);
        let [_, _, a1, a2] = divide_by_delta(&add(&open.q, &open.p_a));
        let b_r = open.q.map(|x| open.gain * x);
        let [_, c0, c1, c2] = divide_by_delta(&add(&open.p_y, &b_r.map(|x| -x)));
        let (e, dy, du) = ([0.0; 4], [0.0; 3], [0.0; 2]);
        Self { a: [a1, a2], b_r, c: [c0, c1, c2], e, dy, du, y: 0.0, u: 0.0 }
    }
}

impl Form for ErrorBased {
    fn step(&mut self, r: f64, y: f64, _: f64) -> f64 {
        push(&mut self.e, r - y);
        push(&mut self.dy, y - self.y);
        self.y = y;
        let du = dot(&self.b_r, &self.e) - dot(&self.c, &self.dy) - dot(&self.a, &self.du);
        push(&mut self.du, du);
        self.u += du;
        self.u
    }
}
