//! What a person writes for a disturbance estimator or observer.

use crate::error::{Checker, ConfigErrors, Param, Reason};
use crate::pid::PidConfig;
use crate::plant_model::{Factor, MAX_ORDER, PlantModel};
use crate::real::Real;

/// The disturbance estimator (DE) of Vrančić & Huba 2021, eq. (13): model `gain*exp(-s*dead_time)/(1+a1*s+a2*s^2)`,
/// filter `kfd/(1+s*tfd)^3`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EstimatorConfig {
    /// Static gain `K_PRM` of the model [y/u], not 0.
    pub gain: f64,
    /// Coefficient `a_1m` \[s\], above 0.
    pub a1: f64,
    /// Coefficient `a_2m` [s^2], 0 (a first-order model) or more.
    pub a2: f64,
    /// Dead time of the model \[s\], 0 or more.
    pub dead_time: f64,
    /// Gain `K_FD`, 0 to 1.
    pub kfd: f64,
    /// Filter time constant `T_FD` \[s\], above 0.
    pub tfd: f64,
}

impl EstimatorConfig {
    /// The same block as a member of the common family.
    #[must_use]
    pub fn to_compensator(&self, latency: f64) -> CompensatorConfig {
        CompensatorConfig {
            model: PlantModel::second_order(self.gain, self.a1, self.a2, self.dead_time),
            gain: self.kfd,
            time_constant: self.tfd,
            order: Some(3),
            latency,
            names: FilterNames::Estimator,
        }
    }
}

/// The disturbance observer (DOB) of Tena et al. 2022, eqs (26), (27): the plant's model and one time constant.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ObserverConfig {
    /// Model of the plant.
    pub model: PlantModel,
    /// Filter time constant `alpha` \[s\], above 0.
    pub alpha: f64,
    /// Filter order `d`; `None`: the smallest possible.
    pub order: Option<usize>,
}

impl ObserverConfig {
    /// The same block as a member of the common family.
    #[must_use]
    pub fn to_compensator(&self, latency: f64) -> CompensatorConfig {
        CompensatorConfig {
            model: self.model.clone(),
            gain: 1.0,
            time_constant: self.alpha,
            order: self.order,
            latency,
            names: FilterNames::Observer,
        }
    }
}

/// Under which names the filter's parameters were written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum FilterNames {
    /// `kfd`, `tfd`.
    Estimator,
    /// `alpha`.
    #[default]
    Observer,
}

/// Parameters of any member of the compensator family, SI units.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CompensatorConfig {
    /// Model of the plant: order 1 to 8, stable or integrating, more poles than zeros.
    pub model: PlantModel,
    /// Share of the estimated disturbance that is fed back, 0 to 1 (1: DOB, `K_FD`: DE).
    pub gain: f64,
    /// Filter time constant \[s\], above 0.
    pub time_constant: f64,
    /// Filter order `d`; `None`: the smallest possible, which is also the least that may be asked for.
    pub order: Option<usize>,
    /// Time from reading `y` to acting `u` \[s\], 0 or more; it is added to the model's dead time.
    pub latency: f64,
    /// Names for error messages.
    pub names: FilterNames,
}

impl CompensatorConfig {
    /// All faults of this configuration for the sampling period `ts` \[s\] and a delay line of `capacity` samples.
    ///
    /// # Errors
    /// A model without gain, with an unstable or too fast pole (time constant below `ts/1000`), of order 0 or above
    /// 8, with no more poles than zeros; a dead time that the line cannot hold; a filter outside its range.
    pub fn validate(&self, ts: f64, capacity: usize) -> Result<(), ConfigErrors> {
        let mut check = Checker::default();
        let ts_ok =
            check.range(Param::Ts, ts, crate::pid::config::TS_RANGE.0, crate::pid::config::TS_RANGE.1);
        let ts = if ts_ok { ts } else { 1.0 };
        self.check_model(&mut check, ts);
        let (gain, filter) = match self.names {
            FilterNames::Estimator => (Param::Kfd, Param::Tfd),
            FilterNames::Observer => (Param::Kfd, Param::Alpha),
        };
        check.range(gain, self.gain, 0.0, 1.0);
        check.range(filter, self.time_constant, ts * 1e-3, ts * 1e9);
        // One cell is the newest sample; a fraction of a sample is the section's business, not the line's.
        let longest = index_to_f64(capacity) * ts;
        let dead_time_ok = check.range(Param::DeadTime, self.model.dead_time, 0.0, longest);
        let latency_ok = check.range(Param::Latency, self.latency, 0.0, longest);
        let total = self.model.dead_time + self.latency;
        // The number type with the coarser rounding decides.
        let (whole, _) = super::shape::whole_samples(total, ts, super::shape::nearness::<f32>());
        if dead_time_ok && latency_ok && whole >= capacity {
            check.fault(Param::DeadTime, Reason::TooLarge, total, 0.0, longest);
        }
        if check.is_clean() {
            let least = super::shape::least_order(&self.model, ts);
            let most = least + super::MAX_EXCESS;
            if let Some(order) = self.order
                && (order < least || order > most)
            {
                let [value, min, max] = [order, least, most].map(index_to_f64);
                check.fault(Param::FilterOrder, Reason::OutOfRange, value, min, max);
            }
        }
        check.into_result()
    }

    /// As [`validate`](Self::validate), for a law with so many poles and so many excess filter poles. A function of its
    /// own for the sake of the stack: lists of faults are large, and what follows is deep.
    #[inline(never)]
    pub(super) fn validate_for(
        &self,
        ts: f64,
        capacity: usize,
        (poles, excess): (usize, usize),
    ) -> Result<(), ConfigErrors> {
        self.validate(ts, capacity)?;
        let mut check = Checker::default();
        let needs = super::discretise::shape(self, ts);
        for (param, needs, has) in
            [(Param::ModelOrder, needs.0, poles), (Param::FilterOrder, needs.1, excess)]
        {
            if needs != has {
                let [needs, has] = [needs, has].map(index_to_f64);
                check.fault(param, Reason::Mismatch, needs, has, has);
            }
        }
        check.into_result()
    }

    fn check_model(&self, check: &mut Checker, ts: f64) {
        let model = &self.model;
        if check.range(Param::ModelGain, model.gain, -1e15, 1e15) && model.gain.abs() < 1e-15 {
            check.fault(Param::ModelGain, Reason::OutOfRange, model.gain, 1e-15, 1e15);
        }
        for pole in &model.poles {
            check_pole(check, *pole, ts);
        }
        for zero in &model.zeros {
            check.range(Param::ModelZeros, zero.a1, -1e12, 1e12);
            check.range(Param::ModelZeros, zero.a2, -1e24, 1e24);
            if zero.a1 == 0.0 && zero.a2 == 0.0 {
                check.fault(Param::ModelZeros, Reason::OutOfRange, 0.0, 0.0, 0.0);
            }
        }
        let order = model.order();
        if order == 0 || order > MAX_ORDER {
            check.fault(
                Param::ModelOrder,
                Reason::OutOfRange,
                index_to_f64(order),
                1.0,
                index_to_f64(MAX_ORDER),
            );
        } else if model.zeros_order() >= order {
            let zeros = index_to_f64(model.zeros_order());
            check.fault(Param::ModelZeros, Reason::NotProper, zeros, 0.0, index_to_f64(order) - 1.0);
        }
    }

    /// The same configuration with every number rounded to `T`.
    #[must_use]
    pub fn rounded<T: Real>(&self) -> Self {
        let round = |x: f64| T::from_f64(x).to_f64();
        let mut config = self.clone();
        config.model.gain = round(config.model.gain);
        config.model.dead_time = round(config.model.dead_time);
        for factor in config.model.poles.iter_mut().chain(config.model.zeros.iter_mut()) {
            *factor = Factor { a1: round(factor.a1), a2: round(factor.a2) };
        }
        config.gain = round(config.gain);
        config.time_constant = round(config.time_constant);
        config.latency = round(config.latency);
        config
    }

    /// Checks that the controller's integral action and the model's gain have the same sign.
    ///
    /// # Errors
    /// `ki * model.gain < 0`, the sign of `ki` taken as [`crate::Action`] makes it.
    pub fn check_sign(&self, pid: &PidConfig) -> Result<(), ConfigErrors> {
        let mut check = Checker::default();
        let [_, ki, _] = pid.signed_gains();
        if ki * self.model.gain < 0.0 {
            check.fault(Param::ModelGain, Reason::SignMismatch, self.model.gain, 0.0, 0.0);
        }
        check.into_result()
    }
}

/// A denominator factor must be stable and neither much faster than one sample nor oscillating above the Nyquist
/// frequency.
fn check_pole(check: &mut Checker, pole: Factor, ts: f64) {
    let (fastest, slowest) = (ts * 1e-3, ts * 1e9);
    if !pole.a1.is_finite() || !pole.a2.is_finite() {
        check.fault(Param::ModelPoles, Reason::NotFinite, pole.a1 + pole.a2, 0.0, 0.0);
    } else if pole.a1 <= 0.0 || pole.a2 < 0.0 {
        let value = if pole.a1 <= 0.0 { pole.a1 } else { pole.a2 };
        check.fault(Param::ModelPoles, Reason::Unstable, value, fastest, slowest);
    } else {
        match pole.real_time_constants() {
            Some((slow, fast)) => {
                check.range(Param::ModelPoles, slow, fastest, slowest);
                if pole.order() == 2 {
                    check.range(Param::ModelPoles, fast, fastest, slowest);
                }
            }
            None => {
                // Longest natural period is free; the shortest damped one must cover two samples.
                let square = 4.0 * pole.a2 - pole.a1 * pole.a1;
                let damped = if square > 0.0 { libm::sqrt(square) / (2.0 * pole.a2) } else { 0.0 };
                if damped * ts >= core::f64::consts::PI {
                    let nyquist = core::f64::consts::PI / ts;
                    check.fault(Param::ModelPoles, Reason::OutOfRange, damped, 0.0, nyquist);
                }
            }
        }
    }
}

#[allow(clippy::cast_precision_loss)] // orders and sample counts are far below 2^52
pub(super) fn index_to_f64(n: usize) -> f64 {
    n as f64
}
