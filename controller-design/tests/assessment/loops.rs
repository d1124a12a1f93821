//! PI loops on first-order and integrating processes with dead time, simulated independently of the library.
//!
//! The dead time is 1 s and the gain of the process 1; `r` is the dead time over the time constant.

use crate::pcg::Pcg;

/// The controller of least IAE: r, kp, ti, IAE, and dip, t_ratio, r3 of its response (computed in another program by
/// optimisation over continuous simulations).
pub(crate) struct Optimum {
    pub(crate) r: f64,
    pub(crate) kp: f64,
    pub(crate) ti: f64,
    pub(crate) iae: f64,
    pub(crate) features: [f64; 4],
}

const fn row(r: f64, kp: f64, ti: f64, iae: f64, p: [f64; 3], t: [f64; 2]) -> Optimum {
    Optimum { r, kp, ti, iae, features: [p[0], p[1] / p[0], t[1] / t[0], p[2] / p[0]] }
}

/// `r = 0` is the integrator.
pub(crate) const OPTIMA: [Optimum; 9] = [
    row(
        0.05,
        18.2578551,
        3.77501648,
        0.224438502,
        [0.0712690007, -0.00563588018, 0.013369274],
        [2.92651862, 6.03912888],
    ),
    row(
        0.1,
        9.15191429,
        3.49293355,
        0.413809575,
        [0.135113631, -0.0106018437, 0.0245244145],
        [2.87565177, 5.93499265],
    ),
    row(
        0.2,
        4.60573384,
        3.02985027,
        0.711662032,
        [0.24453554, -0.0188762233, 0.0417117134],
        [2.78233373, 5.74784039],
    ),
    row(
        0.41,
        2.28985743,
        2.35448533,
        1.10768594,
        [0.417024114, -0.0310579267, 0.0632399928],
        [2.61836166, 5.42697171],
    ),
    row(
        0.84,
        1.18290376,
        1.61438344,
        1.46008077,
        [0.633375868, -0.0437951334, 0.0787823855],
        [2.38358763, 4.96728366],
    ),
    row(
        1.0,
        1.01937144,
        1.45095657,
        1.51959292,
        [0.687300572, -0.0462799664, 0.0803732223],
        [2.32120313, 4.83991011],
    ),
    row(
        1.7,
        0.681470999,
        1.04002623,
        1.61808049,
        [0.838780739, -0.0512831889, 0.0795922421],
        [2.14646567, 4.43879051],
    ),
    row(
        3.0,
        0.497263255,
        0.760070905,
        1.60888203,
        [0.952590594, -0.0525232762, 0.0729781077],
        [2.0326541, 4.05151831],
    ),
    row(
        0.0,
        0.910983679,
        4.09940896,
        4.8907811,
        [1.50768665, -0.120164942, 0.292589834],
        [2.9804644, 6.15185746],
    ),
];

/// Steps of the continuous simulation in a sample of the record.
const FINER: usize = 5;

/// An experiment that was simulated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Recording {
    pub(crate) t: Vec<f64>,
    pub(crate) sp: Vec<f64>,
    pub(crate) pv: Vec<f64>,
    pub(crate) co: Vec<f64>,
    /// Integral of the size of the true deviation.
    pub(crate) iae: f64,
}

/// How an experiment is made.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    pub(crate) r: f64,
    pub(crate) kp: f64,
    pub(crate) ti: f64,
    /// Samples in the dead time.
    pub(crate) delay: usize,
    /// Dead times before and after the step.
    pub(crate) rest: usize,
    pub(crate) length: usize,
    /// Samples in manual.
    pub(crate) hold: usize,
    /// Standard deviation of the noise.
    pub(crate) noise: f64,
    pub(crate) seed: u64,
}

impl Plan {
    pub(crate) fn of(optimum: &Optimum) -> Self {
        let &Optimum { r, kp, ti, .. } = optimum;
        Self { r, kp, ti, delay: 40, rest: 8, length: 50, hold: 10, noise: 0.0, seed: 1 }
    }

    pub(crate) fn detuned(self, kp: f64, ti: f64) -> Self {
        Self { kp: self.kp * kp, ti: self.ti * ti, ..self }
    }

    /// A sampled PI with a held output on the exact discrete process: what a controller with its own clock records.
    pub(crate) fn sampled(&self) -> Recording {
        let ts = 1.0 / self.delay as f64;
        let (a, b) = self.hold_equivalent(ts);
        let (start, count) = (self.rest * self.delay, (self.rest + self.length) * self.delay);
        let (mut y, mut integral) = (0.0, 0.0);
        let mut noise = Pcg::new(self.seed);
        let mut out = Recording::default();
        for k in 0..count {
            let pv = y + self.noise * noise.gaussian();
            let manual = (start..start + self.hold).contains(&k);
            if manual {
                integral = 1.0 + self.kp * pv;
            } else {
                integral -= self.kp * ts / self.ti * pv;
            }
            out.push(k as f64 * ts, pv, integral - self.kp * pv);
            let late = if k >= self.delay { out.co[k - self.delay] } else { 0.0 };
            let next = a * y + b * late;
            out.iae += 0.5 * ts * (y.abs() + next.abs());
            y = next;
        }
        out
    }

    /// A continuous PI, by the trapezoidal rule with five times the samples; every fifth is recorded. The load is exact
    /// because it is held, what is left is of the second order in the step.
    pub(crate) fn continuous(&self) -> Recording {
        let fine = FINER * self.delay;
        let h = 1.0 / fine as f64;
        let (a, b) = self.hold_equivalent(h);
        let (start, count) = (self.rest * fine, (self.rest + self.length) * fine);
        let (mut y, mut integral) = (0.0_f64, 0.0);
        let (mut u, mut out) = (Vec::with_capacity(count), Recording::default());
        for k in 0..count {
            u.push(integral - self.kp * y);
            let load = |k: usize| if k >= start { 1.0 } else { 0.0 };
            if k % FINER == 0 {
                out.push(k as f64 * h, y, u[k] + load(k));
            }
            let late = |k: usize| k.checked_sub(fine).map_or(0.0, |k| u[k]);
            let held = k.checked_sub(fine).map_or(0.0, load);
            let next = a * y + b * (0.5 * (late(k) + late(k + 1)) + held);
            integral -= self.kp * h / self.ti * 0.5 * (y + next);
            out.iae += 0.5 * h * (y.abs() + next.abs());
            y = next;
        }
        out
    }

    /// `y+ = a y + b u` of the process for an input that is held.
    fn hold_equivalent(&self, ts: f64) -> (f64, f64) {
        if self.r > 0.0 { ((-self.r * ts).exp(), -(-self.r * ts).exp_m1()) } else { (1.0, ts) }
    }
}

impl Recording {
    fn push(&mut self, t: f64, pv: f64, co: f64) {
        self.t.push(t);
        self.sp.push(0.0);
        self.pv.push(pv);
        self.co.push(co);
    }

    pub(crate) fn experiment(&self) -> controller_design::assessment::Experiment<'_> {
        controller_design::assessment::Experiment::new(&self.t, &self.sp, &self.pv, &self.co)
    }
}

/// Factors of gain and integral time off the optimum.
pub(crate) fn grid(kp: usize, ti: usize) -> impl Iterator<Item = (f64, f64)> {
    let part = |k: usize, n: usize| k as f64 / (n - 1) as f64;
    // 0.4 to 1.5 in equal distances, 0.3 to 3 in equal ratios.
    (0..kp * ti).map(move |k| (0.4 + 1.1 * part(k / ti, kp), 0.3 * 10f64.powf(part(k % ti, ti))))
}
