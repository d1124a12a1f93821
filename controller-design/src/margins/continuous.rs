//! The loop of a continuous design.

use controller_core::compensator::{EstimatorConfig, ObserverConfig};
use controller_core::{AdrcConfig, PidConfig};

use super::adrc::AdrcPaths;
use super::scan::{Point, Scan};
use super::{Margins, Paths};
use crate::Refusal;
use crate::frequency::{Features, Response, turn};
use crate::model::{Complex, TransferFunction};

/// Where a pole counts as one on the imaginary axis, relative to its size: computed roots are no better.
const AXIS: f64 = 1e-9;

/// Plant, PID and compensator in continuous time: `u = C*(r-y) + C_u*u + C_y*y`, so that the loop gain at the plant
/// input is
///
/// ```text
/// L = G*(C - C_y)/(1 - C_u),      C = (ki + kp*s + kd*s^2)/(s*(1 + tf*s))
/// ```
///
/// Eq. (4) of Vrančić & Huba 2021 and eqs (26), (27), (34) of Tena et al. 2022; the model in `C_u`, `C_y` need not be
/// the plant. With a model that is the plant `1 + L = (1 + G*C)/(1 - C_u)`.
///
/// The observer's filter order counts all real zeros of the left half-plane as moved into `C_y`. The law that runs
/// moves only those with a time constant of one sampling period or more: with faster ones its order is higher.
///
/// ```
/// use controller_core::compensator::EstimatorConfig;
/// use controller_core::PidConfig;
/// use controller_design::margins::ContinuousLoop;
/// use controller_design::model::parse;
///
/// let plant = parse("exp(-s)/(1+2*s+s^2)").expect("a valid plant");
/// let pid = PidConfig { kp: 0.8, ki: 0.4, ..PidConfig::default() };
/// let estimator = EstimatorConfig { gain: 1.0, a1: 2.0, a2: 1.0, dead_time: 1.0, kfd: 0.5, tfd: 0.5 };
/// let plain = ContinuousLoop::new(&plant, &pid);
/// let estimated = plain.clone().with_estimator(&estimator).expect("a valid estimator");
/// // A perfect model: S = S0*(1 - C_u), Vrančić & Huba 2021, eq. (16).
/// let c_u = estimated.compensator(0.7).0;
/// let s0 = plain.sensitivity(0.7);
/// let error = estimated.sensitivity(0.7) - (s0 - s0 * c_u);
/// assert!(error.abs() < 1e-14);
/// ```
#[derive(Debug, Clone)]
pub struct ContinuousLoop {
    plant: TransferFunction,
    response: Response,
    /// `kp`, `ki`, `kd` with the sign of the action.
    gains: [f64; 3],
    tf: f64,
    paths: Option<Paths>,
    adrc: Option<AdrcPaths>,
    latency: f64,
    extra_delay: f64,
}

impl ContinuousLoop {
    /// The loop of a plant and a PID; set-point weights, integration rule and sampling play no part.
    #[must_use]
    pub fn new(plant: &TransferFunction, pid: &PidConfig) -> Self {
        Self {
            plant: plant.clone(),
            response: Response::new(plant),
            gains: pid.signed_gains(),
            tf: pid.tf,
            paths: None,
            adrc: None,
            latency: 0.0,
            extra_delay: 0.0,
        }
    }

    /// The same loop with a disturbance estimator; `kfd = 0` switches it off.
    ///
    /// # Errors
    /// A model or filter that is none: see [`EstimatorConfig`].
    pub fn with_estimator(mut self, estimator: &EstimatorConfig) -> Result<Self, Refusal> {
        self.paths =
            if estimator.kfd == 0.0 { None } else { Some(Paths::new(&estimator.to_compensator(0.0))?) };
        Ok(self)
    }

    /// The same loop with a disturbance observer.
    ///
    /// # Errors
    /// A model or filter that is none, an `order` below the least possible one: see [`ObserverConfig`].
    pub fn with_observer(mut self, observer: &ObserverConfig) -> Result<Self, Refusal> {
        self.paths = Some(Paths::new(&observer.to_compensator(0.0))?);
        Ok(self)
    }

    /// The loop of a plant and an active disturbance rejection controller: all of its feedback counts as
    /// [`compensator`](Self::compensator), the PID is none. Its observer knows of no dead time.
    ///
    /// # Errors
    /// An observer that is not stable, a gain that is not above 0: see [`AdrcConfig`].
    ///
    /// ```
    /// use controller_core::AdrcConfig;
    /// use controller_design::margins::ContinuousLoop;
    /// use controller_design::model::parse;
    /// // On the plant that the law assumes S is (beta2 + kp + kd*beta1)/(beta3*kp) * s^3 at low frequencies.
    /// let plant = parse("5/s^2").expect("a valid plant");
    /// let law = AdrcConfig::from_bandwidths(5.0, 2.0, 8.0);
    /// let made = ContinuousLoop::of_adrc(&plant, &law).expect("a valid law");
    /// let expected = (law.beta2 + law.kp + law.kd * law.beta1) / (law.beta3 * law.kp) * 1e-9;
    /// assert!((made.sensitivity(1e-3).abs() / expected - 1.0).abs() < 1e-3);
    /// ```
    pub fn of_adrc(plant: &TransferFunction, config: &AdrcConfig) -> Result<Self, Refusal> {
        let adrc = AdrcPaths::new(config)?;
        Ok(Self { adrc: Some(adrc), ..Self::new(plant, &PidConfig::default()) })
    }

    /// The same loop with a time \[s\] from reading `y` to acting `u` that the compensator knows of.
    #[must_use]
    pub fn with_latency(mut self, latency: f64) -> Self {
        self.latency = latency;
        self
    }

    /// The same loop with a dead time \[s\] added to the plant that the compensator does not know of.
    #[must_use]
    pub fn with_extra_delay(mut self, extra_delay: f64) -> Self {
        self.extra_delay = extra_delay;
        self
    }

    /// The plant `G` at `s = j*omega`, latency and extra dead time included; `omega` in rad/s, above 0.
    #[must_use]
    pub fn plant(&self, omega: f64) -> Complex {
        let rest = turn(omega * (self.latency + self.extra_delay));
        self.response.at(omega) * rest * self.plant.gain()
    }

    /// The PID `C` at `s = j*omega`.
    #[must_use]
    pub fn controller(&self, omega: f64) -> Complex {
        let [kp, ki, kd] = self.gains;
        Complex::new(kp, kd * omega - ki / omega) / Complex::new(1.0, self.tf * omega)
    }

    /// `(C_u, C_y)` at `s = j*omega`; zeros without a compensator.
    #[must_use]
    pub fn compensator(&self, omega: f64) -> (Complex, Complex) {
        match (&self.adrc, &self.paths) {
            (Some(adrc), _) => adrc.at(omega),
            (None, Some(paths)) => paths.at(omega, self.latency),
            (None, None) => (Complex::ZERO, Complex::ZERO),
        }
    }

    /// All of the feedback, `-u/y = (C - C_y)/(1 - C_u)`.
    #[must_use]
    pub fn feedback(&self, omega: f64) -> Complex {
        let (c_u, c_y) = self.compensator(omega);
        (self.controller(omega) - c_y) / (Complex::ONE - c_u)
    }

    /// The loop gain `L` at the plant input.
    #[must_use]
    pub fn loop_gain(&self, omega: f64) -> Complex {
        let point = self.point(omega);
        point.gain / point.rest
    }

    /// `S = 1/(1+L)`.
    #[must_use]
    pub fn sensitivity(&self, omega: f64) -> Complex {
        let point = self.point(omega);
        point.rest / (point.rest + point.gain)
    }

    /// `T = L/(1+L)`.
    #[must_use]
    pub fn complementary(&self, omega: f64) -> Complex {
        let point = self.point(omega);
        point.gain / (point.rest + point.gain)
    }

    /// From a load at the plant input to the output: `G*S`.
    #[must_use]
    pub fn load_response(&self, omega: f64) -> Complex {
        self.plant(omega) * self.sensitivity(omega)
    }

    /// From measurement noise to the controller's output: `-u/n = (C - C_y)/(1 - C_u)*S`.
    #[must_use]
    pub fn noise_response(&self, omega: f64) -> Complex {
        let (c_u, c_y) = self.compensator(omega);
        let feedback = self.controller(omega) - c_y;
        feedback / (Complex::ONE - c_u + self.plant(omega) * feedback)
    }

    /// `A_n`: the size of [`feedback`](Self::feedback) at high frequency, which fast noise meets. Infinite for a
    /// `kd` without `tf`.
    ///
    /// With PI and observer `|kp + prod(tau)/(K*prod(beta)*alpha^d)|`: eqs (36), (43), (46) of Tena et al. 2022,
    /// which lack `1/K` in print.
    #[must_use]
    pub fn noise_gain(&self) -> f64 {
        let [kp, _, kd] = self.gains;
        let controller = match (kd == 0.0, self.tf == 0.0) {
            (true, true) => kp,
            (false, true) => kd * f64::INFINITY,
            (_, false) => kd / self.tf,
        };
        (controller + self.paths.as_ref().map_or(0.0, Paths::y_gain)).abs()
    }

    /// The margins, peaks and crossings to rounding. About 1000 to 3000 evaluations of the loop gain, many more
    /// only if a dead time is hundreds of times longer than the fastest time constant that matters.
    ///
    /// Stability is decided by the argument principle for `1 - C_u + G*(C - C_y)`, unstable poles of the plant
    /// counted.
    ///
    /// # Errors
    /// A parameter that is not finite or a negative time; an undamped pole of the plant; an integral action that the
    /// plant cannot pass; a closed loop that is not stable.
    pub fn margins(&self) -> Result<Margins, Refusal> {
        self.stable()?.margins(&|omega| self.point(omega))
    }

    /// The largest sensitivity, and the number of points it took; cheaper than all margins.
    ///
    /// # Errors
    /// As for [`margins`](Self::margins).
    pub(crate) fn ms(&self) -> Result<(f64, usize), Refusal> {
        let scan = self.stable()?;
        Ok((scan.ms(&|omega| self.point(omega))?, scan.points.len()))
    }

    fn stable(&self) -> Result<Scan, Refusal> {
        self.check()?;
        let mut unstable = 0;
        for pole in self.plant.poles() {
            let size = pole.abs();
            if size > 0.0 && pole.re.abs() <= AXIS * size {
                return Err(Refusal::Plant {
                    must: "have no undamped pair of poles",
                    help: "give the resonance the damping it has",
                });
            }
            unstable += i32::from(pole.re > 0.0);
        }
        let scan = Scan::new(&|omega| self.point(omega), &self.features(), self.poles_at_origin())?;
        if scan.unstable_poles(unstable)? != 0 {
            return Err(UNSTABLE);
        }
        Ok(scan)
    }

    pub(super) fn point(&self, omega: f64) -> Point {
        let (c_u, c_y) = self.compensator(omega);
        Point {
            omega,
            rest: Complex::ONE - c_u,
            gain: self.plant(omega) * (self.controller(omega) - c_y),
            inner: c_u.abs(),
        }
    }

    fn check(&self) -> Result<(), Refusal> {
        let [kp, ki, kd] = self.gains;
        for (parameter, value) in [("kp", kp), ("ki", ki), ("kd", kd)] {
            if !value.is_finite() {
                return Err(Refusal::OutOfRange { parameter, value, min: -1e15, max: 1e15 });
            }
        }
        let times = [("tf", self.tf), ("latency", self.latency), ("extra_delay", self.extra_delay)];
        for (parameter, value) in times {
            if !(value.is_finite() && value >= 0.0) {
                return Err(Refusal::OutOfRange { parameter, value, min: 0.0, max: 1e12 });
            }
        }
        if kd != 0.0 && self.tf == 0.0 && self.plant.relative_degree() < 2 {
            return Err(Refusal::NoSolution {
                why: "without the filter time constant tf the loop gain does not fall at high frequency",
                help: "give tf a value",
            });
        }
        if ki != 0.0 && self.plant.differentiators() > 0 {
            return Err(Refusal::Plant {
                must: "have no zero at s = 0 when the controller integrates",
                help: "set ki to 0: a constant input has no lasting effect on this plant",
            });
        }
        Ok(())
    }

    fn poles_at_origin(&self) -> usize {
        let integrating = usize::from(self.gains[1] != 0.0);
        (self.plant.integrators() + integrating).saturating_sub(self.plant.differentiators())
    }

    fn features(&self) -> Features {
        let mut features = Features::of(&self.plant);
        features.delay(self.plant.dead_time() + self.latency + self.extra_delay);
        let [kp, ki, kd] = self.gains.map(f64::abs);
        features.time(self.tf);
        features.time(kp / ki);
        features.time(kd / kp);
        features.time(libm::sqrt(kd / ki));
        // Where the asymptotes of the loop gain cross 1.
        let gain = self.plant.gain().abs();
        let root = |x: f64, n: usize| libm::pow(x, 1.0 / u32::try_from(n).map_or(1.0, f64::from));
        let integrators = self.plant.integrators();
        features.time(root(1.0 / (gain * ki), integrators + 1));
        if integrators > 0 {
            features.time(root(1.0 / (gain * kp), integrators));
        }
        if let Some(adrc) = &self.adrc {
            adrc.features(&mut features);
        }
        if let Some(paths) = &self.paths {
            paths.features(&mut features, self.latency);
        }
        features
    }
}

/// The refusal of a closed loop with unstable poles.
pub(super) const UNSTABLE: Refusal = Refusal::NoSolution {
    why: "the closed loop is not stable, so it has no margins",
    help: "lower the gains, and check their signs and the model",
};
