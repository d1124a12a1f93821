//! The two paths of a disturbance compensator in continuous time.

use std::vec::Vec;

use controller_core::compensator::CompensatorConfig;
use controller_core::plant_model::{Factor, PlantModel};

use crate::Refusal;
use crate::frequency::{Features, polynomial, turn};
use crate::model::Complex;

/// `C_u = g*B_n*exp(-s*T)/(1+alpha*s)^d`, `C_y = -g*s^k*A/(K*B_m*(1+alpha*s)^d)` of eqs (26), (27) of Tena et al.
/// 2022 with a gain `g` (eq. (15) of Vrančić & Huba 2021), `B_m` the zeros that moved into the `y` path.
#[derive(Debug, Clone)]
pub(crate) struct Paths {
    gain: f64,
    model_gain: f64,
    integrators: usize,
    poles: Vec<Factor>,
    kept: Vec<Factor>,
    /// Time constants in s.
    moved: Vec<f64>,
    dead_time: f64,
    alpha: f64,
    order: usize,
}

impl Paths {
    pub(crate) fn new(config: &CompensatorConfig) -> Result<Self, Refusal> {
        let model = &config.model;
        let (kept, moved) = split_zeros(model);
        let least = model.order() - moved.len().min(model.order());
        let order = config.order.unwrap_or(least);
        let times = [config.time_constant, model.dead_time];
        let finite = model.poles.iter().chain(&model.zeros).all(|f| f.a1.is_finite() && f.a2.is_finite());
        let stable = model.poles.iter().all(|p| p.a1 > 0.0 && p.a2 >= 0.0);
        if !(finite && stable && model.gain.is_finite() && model.gain != 0.0) {
            return Err(Refusal::NoSolution {
                why: "the compensator's model has a gain of 0, a number that is not finite, or an unstable pole",
                help: "give the compensator a stable or integrating model",
            });
        }
        if !(times.iter().all(|t| t.is_finite() && *t >= 0.0) && config.time_constant > 0.0) {
            return Err(Refusal::NoSolution {
                why: "the compensator's time constant is not above 0, or its dead time is negative",
                help: "choose a positive filter time constant",
            });
        }
        if model.order() == 0 || model.zeros_order() >= model.order() {
            return Err(Refusal::NoSolution {
                why: "the compensator's model has no more poles than zeros",
                help: "a real plant has: add the fast lag that was left out",
            });
        }
        let number = |n: usize| u32::try_from(n).map_or(f64::MAX, f64::from);
        if order < least || order > MAX_ORDER {
            let [value, min, max] = [order, least, MAX_ORDER].map(number);
            return Err(Refusal::OutOfRange { parameter: "order", value, min, max });
        }
        Ok(Self {
            gain: config.gain,
            model_gain: model.gain,
            integrators: model.integrators,
            poles: model.poles.iter().copied().collect(),
            kept,
            moved,
            dead_time: model.dead_time,
            alpha: config.time_constant,
            order,
        })
    }

    /// `(C_u, C_y)` at `s = j*omega`; the latency in s adds to the model's dead time.
    pub(crate) fn at(&self, omega: f64, latency: f64) -> (Complex, Complex) {
        let lag = polynomial(&[1.0, self.alpha], omega);
        let s = Complex::new(0.0, omega);
        let filter = (0..self.order).fold(Complex::real(self.gain), |f, _| f / lag);
        let u = self.kept.iter().fold(filter, |u, z| u * polynomial(&[1.0, z.a1, z.a2], omega));
        // One lag for each pole, so that the partial products stay moderate.
        let mut y = Complex::real(-self.gain / self.model_gain);
        let mut lags = self.order;
        let mut lagged = |y: Complex, degree: usize| {
            let used = degree.min(lags);
            lags -= used;
            (0..used).fold(y, |y, _| y / lag)
        };
        for _ in 0..self.integrators {
            y = lagged(y * s, 1);
        }
        for pole in &self.poles {
            y = lagged(y * polynomial(&[1.0, pole.a1, pole.a2], omega), pole.order());
        }
        y = lagged(y, usize::MAX);
        let y = self.moved.iter().fold(y, |y, &beta| y / polynomial(&[1.0, beta], omega));
        (u * turn(omega * (self.dead_time + latency)), y)
    }

    /// The limit of `-C_y` at high frequency, eq. (36) of Tena et al. 2022 with the factor `1/K` it lacks in print:
    /// `g*prod(tau)/(K*prod(beta)*alpha^d)`; 0 when the filter is of a higher order than needed.
    pub(crate) fn y_gain(&self) -> f64 {
        let order: usize = self.integrators + self.poles.iter().map(Factor::order).sum::<usize>();
        if self.order + self.moved.len() > order {
            return 0.0;
        }
        self.gain * lead(&self.poles, &self.moved) / self.model_gain
            * (0..self.order).fold(1.0, |f, _| f / self.alpha)
    }

    pub(crate) fn features(&self, features: &mut Features, latency: f64) {
        for factor in self.poles.iter().chain(&self.kept) {
            factor_features(*factor, features);
        }
        for &beta in &self.moved {
            features.time(beta);
        }
        features.time(self.alpha);
        features.delay(self.dead_time + latency);
    }
}

/// The largest filter order the design side takes.
const MAX_ORDER: usize = 2 * controller_core::plant_model::MAX_ORDER;

/// `prod(tau)/prod(beta)` over the leading coefficients of the poles and the moved zeros.
pub(crate) fn lead(poles: &[Factor], moved: &[f64]) -> f64 {
    let mut ratio = 1.0;
    let (mut poles, mut moved) = (poles.iter(), moved.iter());
    loop {
        match (poles.next(), moved.next()) {
            (None, None) => return ratio,
            (pole, beta) => {
                ratio *= pole.map_or(1.0, |p| if p.a2 == 0.0 { p.a1 } else { p.a2 });
                ratio /= beta.copied().unwrap_or(1.0);
            }
        }
    }
}

/// The zeros that stay in the `u` path and the time constants of those that move to the `y` path: real ones of the
/// left half-plane. Tena et al. 2022 write `delta` and `beta`; complex pairs stay.
pub(crate) fn split_zeros(model: &PlantModel) -> (Vec<Factor>, Vec<f64>) {
    let (mut kept, mut moved) = (Vec::new(), Vec::new());
    for zero in &model.zeros {
        match zero.real_time_constants() {
            None => kept.push(*zero),
            Some((slow, fast)) => {
                for time in [slow, fast] {
                    if time > 0.0 {
                        moved.push(time);
                    } else if time < 0.0 {
                        kept.push(Factor::first(time));
                    }
                }
            }
        }
    }
    (kept, moved)
}

fn factor_features(factor: Factor, features: &mut Features) {
    match factor.real_time_constants() {
        Some((slow, fast)) => {
            features.time(slow.abs());
            features.time(fast.abs());
        }
        None => {
            let half = -0.5 * factor.a1 / factor.a2;
            let im = libm::sqrt((1.0 / factor.a2 - half * half).max(0.0));
            features.root(Complex::new(half, im));
        }
    }
}
