//! Records of processes whose step response is known in closed form, and what the areas of those processes are.

#![allow(dead_code, reason = "each test takes what it needs")]

/// `gain*exp(-s*dead_time)*(1+zero*s)/..` with the denominator of `Kind`.
pub(crate) struct Process {
    pub(crate) kind: Kind,
    pub(crate) gain: f64,
    pub(crate) dead_time: f64,
    pub(crate) zero: f64,
}

pub(crate) enum Kind {
    /// `(1+tau*s)^n`
    Equal { n: usize, tau: f64 },
    /// `prod(1+tau*s)`, all different.
    Distinct(Vec<f64>),
    /// `1 + 2*zeta*s/w + s^2/w^2`, `zeta < 1`.
    Pair { w: f64, zeta: f64 },
}

impl Process {
    pub(crate) fn equal(n: usize, tau: f64, dead_time: f64) -> Self {
        Self { kind: Kind::Equal { n, tau }, gain: 1.0, dead_time, zero: 0.0 }
    }

    pub(crate) fn distinct(taus: &[f64], dead_time: f64) -> Self {
        Self { kind: Kind::Distinct(taus.to_vec()), gain: 1.0, dead_time, zero: 0.0 }
    }

    pub(crate) fn pair(w: f64, zeta: f64, dead_time: f64) -> Self {
        Self { kind: Kind::Pair { w, zeta }, gain: 1.0, dead_time, zero: 0.0 }
    }

    pub(crate) fn gain(self, gain: f64) -> Self {
        Self { gain, ..self }
    }

    pub(crate) fn zero(self, zero: f64) -> Self {
        Self { zero, ..self }
    }

    /// Step response and its slope, without gain, dead time and zero, at `t >= 0`.
    fn step(&self, t: f64) -> (f64, f64) {
        match &self.kind {
            Kind::Equal { n, tau } => {
                let x = t / tau;
                let (mut term, mut sum) = (1.0, 0.0);
                for k in 0..*n {
                    if k > 0 {
                        term *= x / k as f64;
                    }
                    sum += term;
                }
                (1.0 - (-x).exp() * sum, term * (-x).exp() / tau)
            }
            Kind::Distinct(taus) => {
                let (mut y, mut slope) = (1.0, 0.0);
                for (i, a) in taus.iter().enumerate() {
                    let others = taus.iter().enumerate().filter(|(j, _)| *j != i);
                    let part = others.map(|(_, b)| a / (a - b)).product::<f64>() * (-t / a).exp();
                    y -= part;
                    slope += part / a;
                }
                (y, slope)
            }
            Kind::Pair { w, zeta } => {
                let (root, e) = ((1.0 - zeta * zeta).sqrt(), (-zeta * w * t).exp());
                let (sin, cos) = (w * root * t).sin_cos();
                (1.0 - e * (cos + zeta / root * sin), e * w / root * sin)
            }
        }
    }

    pub(crate) fn response(&self, since: f64) -> f64 {
        let t = since - self.dead_time;
        if t <= 0.0 {
            return 0.0;
        }
        let (y, slope) = self.step(t);
        self.gain * (y + self.zero * slope)
    }

    /// The output for the held input `u`, from rest at `u[0]`.
    pub(crate) fn output(&self, t: &[f64], u: &[f64]) -> Vec<f64> {
        let moves: Vec<(f64, f64)> =
            (1..u.len()).filter(|&i| u[i] != u[i - 1]).map(|i| (t[i], u[i] - u[i - 1])).collect();
        let at =
            |t: f64| moves.iter().take_while(|m| m.0 <= t).map(|m| m.1 * self.response(t - m.0)).sum::<f64>();
        t.iter().map(|t| self.gain * u[0] + at(*t)).collect()
    }

    /// The areas, from the power series of `G(-s)`, factor by factor.
    pub(crate) fn areas(&self) -> [f64; 6] {
        let mut g = [0.0; 6];
        g[0] = self.gain;
        let quadratics: Vec<(f64, f64)> = match &self.kind {
            Kind::Equal { n, tau } => vec![(*tau, 0.0); *n],
            Kind::Distinct(taus) => taus.iter().map(|tau| (*tau, 0.0)).collect(),
            Kind::Pair { w, zeta } => vec![(2.0 * zeta / w, 1.0 / (w * w))],
        };
        for (a1, a2) in quadratics {
            for k in 1..6 {
                g[k] += a1 * g[k - 1] - if k > 1 { a2 * g[k - 2] } else { 0.0 };
            }
        }
        for k in (1..6).rev() {
            g[k] -= self.zero * g[k - 1];
        }
        let mut delayed = [0.0; 6];
        for k in 0..6 {
            let mut term = 1.0;
            for i in 0..=k {
                delayed[k] += term * g[k - i];
                term *= self.dead_time / (i + 1) as f64;
            }
        }
        delayed
    }

    pub(crate) fn mean_time(&self) -> f64 {
        let a = self.areas();
        a[1] / a[0]
    }
}

/// The chapter's processes (20) and (32).
pub(crate) fn chapter(number: usize) -> Process {
    match number {
        1 => Process::equal(2, 1.0, 0.5),
        2 => Process::equal(3, 1.0, 0.2),
        3 => Process::distinct(&[1.0, 0.2], 0.2),
        4 => Process::equal(4, 1.0, 1.0),
        5 => Process::distinct(&[1.0, 0.2, 0.04, 0.008], 0.0),
        _ => Process::equal(3, 1.0, 5.0),
    }
}

/// `K_P` of eq. (6) by elimination.
pub(crate) fn momi_kp(areas: &[f64; 6], tf: f64) -> f64 {
    let mut a = *areas;
    for k in 1..6 {
        a[k] += tf * a[k - 1];
    }
    let mut m = [[-a[1], a[0], 0.0, -0.5], [-a[3], a[2], -a[1], 0.0], [-a[5], a[4], -a[3], 0.0]];
    for i in 0..3 {
        let pivot = (i..3).max_by(|&p, &q| m[p][i].abs().total_cmp(&m[q][i].abs())).unwrap_or(i);
        m.swap(i, pivot);
        for j in 0..3 {
            if j != i {
                let f = m[j][i] / m[i][i];
                for k in 0..4 {
                    m[j][k] -= f * m[i][k];
                }
            }
        }
    }
    m[1][3] / m[1][1]
}

/// A step of `size` at 0, `before` seconds of rest, sampled every `h`.
pub(crate) fn step(
    process: &Process,
    h: f64,
    before: f64,
    until: f64,
    size: f64,
) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let first = -(before / h).round() as i64;
    let last = (until / h).round() as i64;
    let t: Vec<f64> = (first..=last).map(|i| i as f64 * h).collect();
    let u: Vec<f64> = (first..=last).map(|i| if i < 0 { 0.0 } else { size }).collect();
    let y = process.output(&t, &u);
    (t, u, y)
}

/// Numbers that look random, the same everywhere.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x1234_5678_9ABC_DEF0)
    }

    /// Between 0 and 1 (splitmix64).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Normal, variance 1.
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (core::f64::consts::TAU * self.uniform()).cos()
    }
}
