//! Responses of a continuous loop with dead time to loads and set-points, and their indices over an infinite horizon.
//!
//! Between two multiples of the dead time the delayed signals are known, so the loop is a set of linear differential
//! equations with a known input: the method of steps. Here every signal is a polynomial of degree 8 per element, the
//! equations are solved exactly for such inputs, and elements grow as the response gets smoother, so that the number
//! of elements hardly depends on how far apart the time constants are. Nothing is approximated but the polynomials:
//! no Padé, no sampling.
//!
//! With an exact model the loop with a disturbance observer is the loop without, driven by the load filtered with
//! `1 - C_u` (Tena et al. 2022, eq. (34)); that is how an observer is computed here.

mod block;
mod chain;
mod horizon;
mod map;
mod march;
mod measure;
mod mesh;
mod nodes;
mod realisation;
mod rest;
mod settling;

use core::ops::ControlFlow;
use std::vec::Vec;

use controller_core::PidConfig;

use crate::Refusal;
use crate::model::TransferFunction;
use horizon::Horizon;
use march::March;
use measure::{Element, Sums};
use realisation::Realisation;
use settling::{Settling, unstable, verdict};

/// A load at the plant input that begins at `t = 0`, the loop at rest before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// `d = 1`.
    Step,
    /// `d = t`, t in seconds.
    Ramp,
}

/// What moves the loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Drive {
    Step,
    Ramp,
    /// A step of the set-point to an output of 1.
    Setpoint,
}

impl From<Load> for Drive {
    fn from(load: Load) -> Self {
        match load {
            Load::Step => Self::Step,
            Load::Ramp => Self::Ramp,
        }
    }
}

/// `C_u` of a block whose model is the plant: `gain*prod(1-delta*s)*exp(-T*s)/(1+alpha*s)^order`.
#[derive(Debug, Clone, Copy)]
struct Shape {
    alpha: f64,
    order: usize,
    gain: f64,
}

/// A disturbance observer for the plant itself: `C_u = prod(1-delta*s)*exp(-T*s)/(1+alpha*s)^order`, `delta` for the
/// zeros in the right half-plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// Time constant of its filter \[s\], positive.
    pub alpha: f64,
    /// Order of its filter: at least number of poles less number of zeros in the left half-plane.
    pub order: usize,
}

impl Observer {
    /// The observer of least order: poles less zeros in the left half-plane (Tena et al. 2022, section 3).
    ///
    /// ```
    /// use controller_design::{model::parse, response::Observer};
    /// let g = parse("(1-0.3*s)*exp(-s)/((1+s)*(1+2*s))").expect("a plant");
    /// assert_eq!(Observer::new(&g, 0.5).order, 2);
    /// ```
    #[must_use]
    pub fn new(plant: &TransferFunction, alpha: f64) -> Self {
        Self { alpha, order: realisation::filter_order(plant) }
    }

    /// Integral of the error under a unit ramp of the load, as a size:
    /// `(order*alpha + dead_time + sum delta)/|ki|`, Tena et al. 2022 eq. (33), and the part of it that no `alpha`
    /// takes away.
    pub(crate) fn ramp_ie(&self, plant: &TransferFunction, pid: &PidConfig) -> (f64, f64) {
        let least = realisation::unavoidable(plant);
        let ki = pid.ki.abs();
        ((self.order as f64 * self.alpha + least) / ki, least / ki)
    }
}

/// Indices of the error `e = r - y` from the load or the step of the set-point at `t = 0` to infinity. Units: those of y for
/// a load of 1 (or a slope of 1 per second) or for a set-point of 1, and seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// Integral of e.
    pub ie: f64,
    /// Integral of |e|.
    pub iae: f64,
    /// Integral of e^2.
    pub ise: f64,
    /// Integral of t*|e|, t counted from the load at the plant input.
    pub itae: f64,
    /// Largest |e|.
    pub e_max: f64,
    /// Time of the largest |e| after the load \[s\].
    pub t_max: f64,
    /// Total variation of the controller output u, observer included; infinite under a ramp, which u must follow.
    pub tv: f64,
}

impl Indices {
    fn finite(self) -> Result<Self, Refusal> {
        let numbers = [self.ie, self.iae, self.ise, self.itae, self.e_max];
        if numbers.iter().all(|x| x.is_finite()) { Ok(self) } else { Err(unstable()) }
    }
}

/// A point of a response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time after the load \[s\].
    pub t: f64,
    /// Plant output.
    pub y: f64,
    /// Controller output, observer included, load not.
    pub u: f64,
}

/// What a response takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cost {
    /// Elements of time; each is one update of the states and of nine points of both signals.
    pub elements: usize,
    /// Multiplications in these updates, those of the matrices themselves not counted.
    pub multiplications: usize,
}

/// An extremum of the error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Time after the load \[s\].
    pub t: f64,
    /// The error `e = r - y` there.
    pub e: f64,
}

/// The continuous loop of a plant, a PI or PID controller and perhaps a disturbance observer.
///
/// The plant: strictly proper, any order, zeros, integrators, complex or unstable poles, any dead time or none; no
/// zero at `s = 0`. The controller: `ki/s + ((kp - ki*tf) + kd*s)/(1 + tf*s)`, `ki != 0`, with the weights `b` and `c` for
/// the set-point. The observer's model is the plant.
///
/// ```
/// use controller_core::PidConfig;
/// use controller_design::model::parse;
/// use controller_design::response::{ContinuousResponse, Load};
///
/// let plant = parse("exp(-20*s)/(1+80*s)").expect("a plant");
/// let pid = PidConfig { kp: 0.696075276, ki: 0.011533633, ..PidConfig::default() };
/// let alone = ContinuousResponse::new(&plant, &pid, None)?.indices(Load::Step)?;
/// let observed = ContinuousResponse::with_alpha(&plant, &pid, 100.0)?.indices(Load::Step)?;
/// assert!((alone.ie * pid.ki + 1.0).abs() < 1e-9);
/// // Tena et al. 2022, table 3, as recomputed.
/// assert!((observed.iae / alone.iae - 0.8572).abs() < 1e-4);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
#[derive(Debug, Clone)]
pub struct ContinuousResponse {
    march: March,
    accuracy: f64,
}

impl ContinuousResponse {
    /// Default relative accuracy of the indices.
    pub const ACCURACY: f64 = 1e-6;

    /// The loop, at the default accuracy. Cost: some ten microseconds.
    ///
    /// # Errors
    /// A plant or controller outside what the type describes, numbers that are not finite, time constants more than
    /// about 15 decades from the dead time.
    pub fn new(
        plant: &TransferFunction,
        pid: &PidConfig,
        observer: Option<Observer>,
    ) -> Result<Self, Refusal> {
        Self::with_accuracy(plant, pid, observer, Self::ACCURACY)
    }

    /// The loop with the observer of least order and this `alpha` \[s\].
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_alpha(plant: &TransferFunction, pid: &PidConfig, alpha: f64) -> Result<Self, Refusal> {
        Self::new(plant, pid, Some(Observer::new(plant, alpha)))
    }

    /// The loop; `accuracy` is about the relative error of the indices, 1e-9 to 1e-2. The error of an element goes
    /// with the ninth power of its length, so a better accuracy costs little.
    ///
    /// # Errors
    /// As for [`new`](Self::new), and an accuracy out of range.
    pub fn with_accuracy(
        plant: &TransferFunction,
        pid: &PidConfig,
        observer: Option<Observer>,
        accuracy: f64,
    ) -> Result<Self, Refusal> {
        check(plant, pid)?;
        if let Some(observer) = observer {
            within("alpha", observer.alpha, f64::MIN_POSITIVE, f64::MAX)?;
            let least = realisation::filter_order(plant);
            within("order", observer.order as f64, least as f64, 30.0)?;
        }
        let shape = observer.map(|Observer { alpha, order }| Shape { alpha, order, gain: 1.0 });
        Self::with_shape(plant, pid, shape, accuracy)
    }

    /// The loop with a disturbance estimator whose model is the plant: self-regulating, of first or second order, without
    /// zeros. Then the plant input sees `1 - kfd*exp(-T*s)/(1+tfd*s)^3` of the load (Vrančić & Huba 2021, eq. (15)).
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// use controller_design::model::parse;
    /// use controller_design::response::{ContinuousResponse, Load};
    ///
    /// let plant = parse("exp(-0.2*s)/((1+0.2*s)*(1+s))").expect("a plant");
    /// let pid = PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, ..PidConfig::default() };
    /// let i = ContinuousResponse::with_estimator(&plant, &pid, 0.69, 0.06)?.indices(Load::Step)?;
    /// // IE = -(1 - kfd)/ki.
    /// assert!((i.ie + 0.31 / 1.88).abs() < 1e-6);
    /// # Ok::<(), controller_design::Refusal>(())
    /// ```
    ///
    /// # Errors
    /// As for [`new`](Self::new); a plant of another kind; `kfd` not from 0 to 1, `tfd` not positive.
    pub fn with_estimator(
        plant: &TransferFunction,
        pid: &PidConfig,
        kfd: f64,
        tfd: f64,
    ) -> Result<Self, Refusal> {
        check(plant, pid)?;
        within("kfd", kfd, 0.0, 1.0)?;
        within("tfd", tfd, f64::MIN_POSITIVE, f64::MAX)?;
        let has_zeros = plant.relative_degree() != plant.order();
        if plant.integrators() > 0 || plant.order() > 2 || has_zeros {
            return Err(Refusal::Plant {
                must: "be self-regulating, of order 1 or 2 and without zeros, as the estimator's model is",
                help: "simulate the sampled loop instead",
            });
        }
        Self::with_shape(plant, pid, Some(Shape { alpha: tfd, order: 3, gain: kfd }), Self::ACCURACY)
    }

    fn with_shape(
        plant: &TransferFunction,
        pid: &PidConfig,
        shape: Option<Shape>,
        accuracy: f64,
    ) -> Result<Self, Refusal> {
        within("accuracy", accuracy, 1e-9, 1e-2)?;
        let march = March::new(Realisation::new(plant, pid, shape)?, accuracy)?;
        Ok(Self { march, accuracy })
    }

    /// The indices over an infinite horizon. Cost: some ten microseconds for an ordinary loop.
    ///
    /// # Errors
    /// The loop is unstable or does not settle; a ramp without observer, under which the error does not end.
    pub fn indices(&self, load: Load) -> Result<Indices, Refusal> {
        let (sums, z) = self.settled(load.into(), f64::INFINITY)?;
        let r = &self.march.realisation;
        let slope = if load == Load::Ramp { r.time } else { 1.0 };
        let y = r.gain.abs() * slope;
        let indices = Indices {
            ie: -r.gain * slope * r.time * r.integral(load.into(), &z),
            iae: sums.iae * y * r.time,
            ise: sums.ise * y * y * r.time,
            itae: sums.itae * y * r.time * r.time,
            e_max: sums.y_max * y,
            t_max: sums.t_max * r.time,
            tv: if load == Load::Ramp { f64::INFINITY } else { sums.tv },
        };
        indices.finite()
    }

    /// The indices after a unit step of the set-point, `e = r - y`, with the weights `b` and `c` of the controller; TV counts
    /// the jump of the output at the step. A block whose model is the plant does not show. Cost: as that of
    /// [`indices`](Self::indices).
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// use controller_design::model::parse;
    /// use controller_design::response::ContinuousResponse;
    ///
    /// let plant = parse("2*exp(-s)/(1+4*s)").expect("a plant");
    /// let pid = PidConfig { kp: 0.8, ki: 0.2, b: 0.5, ..PidConfig::default() };
    /// let i = ContinuousResponse::new(&plant, &pid, None)?.setpoint_indices()?;
    /// // Steady state before and after: IE = (1/K + (1-b)*kp)/ki.
    /// assert!((i.ie - (0.5 + 0.5 * 0.8) / 0.2).abs() < 1e-5);
    /// # Ok::<(), controller_design::Refusal>(())
    /// ```
    ///
    /// # Errors
    /// The loop is unstable or does not settle.
    pub fn setpoint_indices(&self) -> Result<Indices, Refusal> {
        let (sums, z) = self.settled(Drive::Setpoint, f64::INFINITY)?;
        let r = &self.march.realisation;
        let indices = Indices {
            ie: -r.time * r.integral(Drive::Setpoint, &z),
            iae: sums.iae * r.time,
            ise: sums.ise * r.time,
            itae: sums.itae * r.time * r.time,
            e_max: sums.y_max,
            t_max: sums.t_max * r.time,
            tv: (sums.tv + r.kick().abs()) / r.gain.abs(),
        };
        indices.finite()
    }

    /// The indices of the time from 0 to `horizon` \[s\] only: those of an experiment that ends there. Cost: at most that of
    /// [`indices`](Self::indices), but for a horizon far beyond the end of the response.
    ///
    /// ```
    /// use controller_core::PidConfig;
    /// use controller_design::model::parse;
    /// use controller_design::response::{ContinuousResponse, Load};
    ///
    /// let plant = parse("exp(-s)/(1+2*s)").expect("a plant");
    /// let pid = PidConfig { kp: 0.5, ki: 0.2, ..PidConfig::default() };
    /// let i = ContinuousResponse::new(&plant, &pid, None)?.indices_until(Load::Step, 1.5)?;
    /// // Up to two dead times the controller has no effect on the output: e = -(1 - exp(-(t-1)/2)).
    /// let exact = 0.5 - 2.0 * (1.0 - (-0.25_f64).exp());
    /// assert!((i.iae - exact).abs() < 1e-6 && (i.ie + exact).abs() < 1e-6);
    /// # Ok::<(), controller_design::Refusal>(())
    /// ```
    ///
    /// # Errors
    /// A horizon that is not positive and finite; a loop that is unstable so fast that its signals are beyond 1e12 times the
    /// load before, or that moves too fast to be followed that long. A loop need not have settled, nor settle ever.
    pub fn indices_until(&self, load: Load, horizon: f64) -> Result<Indices, Refusal> {
        let found = self.cut(load.into(), horizon)?;
        let r = &self.march.realisation;
        let y = r.gain.abs() * if load == Load::Ramp { r.time } else { 1.0 };
        let sums = found.sums;
        let indices = Indices {
            ie: -r.gain.signum() * y * r.time * found.area,
            iae: sums.iae * y * r.time,
            ise: sums.ise * y * y * r.time,
            itae: sums.itae * y * r.time * r.time,
            e_max: sums.y_max * y,
            t_max: sums.t_max * r.time,
            tv: if load == Load::Ramp { f64::INFINITY } else { sums.tv },
        };
        indices.finite()
    }

    /// [`setpoint_indices`](Self::setpoint_indices) of the time from 0 to `horizon` \[s\] only.
    ///
    /// # Errors
    /// As for [`indices_until`](Self::indices_until).
    pub fn setpoint_indices_until(&self, horizon: f64) -> Result<Indices, Refusal> {
        let found = self.cut(Drive::Setpoint, horizon)?;
        let r = &self.march.realisation;
        let sums = found.sums;
        let indices = Indices {
            ie: -r.time * found.area,
            iae: sums.iae * r.time,
            ise: sums.ise * r.time,
            itae: sums.itae * r.time * r.time,
            e_max: sums.y_max,
            t_max: sums.t_max * r.time,
            tv: (sums.tv + r.kick().abs()) / r.gain.abs(),
        };
        indices.finite()
    }

    fn cut(&self, drive: Drive, horizon: f64) -> Result<Horizon, Refusal> {
        within("horizon", horizon, f64::MIN_POSITIVE, f64::MAX)?;
        let mut found = Horizon::new(horizon / self.march.realisation.time);
        let (outcome, _) = self.march.run(drive, false, &mut |e| found.visit(e));
        verdict(outcome).map(|()| found)
    }

    /// How much one response takes: for benchmarks.
    ///
    /// # Errors
    /// As for [`indices`](Self::indices).
    pub fn cost(&self, load: Load) -> Result<Cost, Refusal> {
        self.ends(load.into())?;
        let mut settling = Settling::new(self.accuracy, f64::INFINITY);
        let mut elements = 0;
        let (outcome, z) = self.march.run(load.into(), false, &mut |e| {
            elements += 1;
            settling.visit(e)
        });
        verdict(outcome)?;
        let states = z.len();
        Ok(Cost {
            elements,
            multiplications: elements * (states + nodes::NODES) * (states + 2 * nodes::NODES),
        })
    }

    /// The IAE of a step, or infinity as soon as it is known to be above `limit` or the loop is unstable; and the number of
    /// elements it took.
    pub(crate) fn iae_below(&self, limit: f64) -> (f64, usize) {
        let r = &self.march.realisation;
        let unit = r.gain.abs() * r.time;
        let mut settling = Settling::new(self.accuracy, limit / unit);
        let mut elements = 0;
        let (outcome, _) = self.march.run(Drive::Step, false, &mut |e| {
            elements += 1;
            settling.visit(e)
        });
        let iae = settling.sums.iae;
        let counts = verdict(outcome).is_ok() && iae <= limit / unit;
        (if counts { iae * unit } else { f64::INFINITY }, elements)
    }

    /// The first extrema of the error, at most `count`, in the order of time.
    ///
    /// # Errors
    /// As for [`indices`](Self::indices).
    pub fn peaks(&self, load: Load, count: usize) -> Result<Vec<Peak>, Refusal> {
        self.ends(load.into())?;
        let r = &self.march.realisation;
        let scale = -r.gain * if load == Load::Ramp { r.time } else { 1.0 };
        let mut settling = Settling::new(self.accuracy, f64::INFINITY);
        let mut peaks = Vec::new();
        let mut visit = |e: &Element<'_>| {
            measure::turns(e.y, |x, y| {
                let t = r.time * (e.start + 0.5 * e.length * (1.0 + x));
                peaks.push(Peak { t, e: scale * y });
            });
            if peaks.len() >= count { ControlFlow::Break(()) } else { settling.visit(e) }
        };
        let (outcome, _) = self.march.run(load.into(), false, &mut visit);
        verdict(outcome)?;
        peaks.truncate(count);
        Ok(peaks)
    }

    /// The response at `points` equidistant times from 0 to `duration` \[s\], both included. An unstable loop is shown
    /// as long as its numbers are moderate; less than `points` samples come back then.
    ///
    /// # Errors
    /// A duration that is not positive and finite, `points` below 2 or above 10 million.
    pub fn trace(&self, load: Load, duration: f64, points: usize) -> Result<Vec<Sample>, Refusal> {
        within("duration", duration, f64::MIN_POSITIVE, f64::MAX)?;
        within("points", points as f64, 2.0, 1e7)?;
        let r = &self.march.realisation;
        let slope = if load == Load::Ramp { r.time } else { 1.0 };
        let time = |i: usize| duration * i as f64 / (points - 1) as f64;
        let mut samples = Vec::with_capacity(points);
        let mut visit = |e: &Element<'_>| {
            while samples.len() < points {
                let t = time(samples.len());
                let x = (t / r.time - e.start) / e.length;
                if x > 1.0 {
                    return ControlFlow::Continue(());
                }
                let d = if load == Load::Ramp { t } else { 1.0 };
                let (y, v) = (measure::interpolated(e.y, x), measure::interpolated(e.v, x));
                samples.push(Sample { t, y: r.gain * slope * y, u: slope * v - d });
            }
            ControlFlow::Break(())
        };
        self.march.run(load.into(), false, &mut visit);
        Ok(samples)
    }

    fn ends(&self, drive: Drive) -> Result<(), Refusal> {
        self.march.realisation.end(drive).map(|_| ()).ok_or(Refusal::NoSolution {
            why: "under a ramp the error of a loop without observer stays at 1/ki for ever",
            help: "add a disturbance observer, or ask for a step",
        })
    }

    fn settled(&self, drive: Drive, limit: f64) -> Result<(Sums, Vec<f64>), Refusal> {
        self.ends(drive)?;
        let mut settling = Settling::new(self.accuracy, limit);
        let (outcome, z) = self.march.run(drive, false, &mut |e| settling.visit(e));
        verdict(outcome)?;
        if settling.sums.iae > limit { Err(unstable()) } else { Ok((settling.sums, z)) }
    }
}

/// The sign of `ki` without which no loop of this plant is stable.
pub(crate) fn sign_of_ki(plant: &TransferFunction) -> f64 {
    realisation::sign_of_ki(plant).signum()
}

fn within(parameter: &'static str, value: f64, min: f64, max: f64) -> Result<(), Refusal> {
    if value >= min && value <= max {
        Ok(())
    } else {
        Err(Refusal::OutOfRange { parameter, value, min, max })
    }
}

fn check(plant: &TransferFunction, pid: &PidConfig) -> Result<(), Refusal> {
    if !plant.is_strictly_proper() {
        return Err(Refusal::Plant {
            must: "have more poles than zeros",
            help: "add the lag of the actuator or of the sensor to the plant",
        });
    }
    if plant.differentiators() > 0 {
        return Err(Refusal::Plant {
            must: "pass a constant input on: it has a zero at s = 0",
            help: "leave out the zero at s = 0",
        });
    }
    let gains = [("kp", pid.kp), ("ki", pid.ki), ("kd", pid.kd), ("tf", pid.tf)];
    for (parameter, value) in gains {
        within(parameter, value, -f64::MAX, f64::MAX)?;
    }
    within("tf", pid.tf, 0.0, f64::MAX)?;
    if pid.kd != 0.0 && pid.tf == 0.0 {
        return Err(Refusal::OutOfRange {
            parameter: "tf",
            value: 0.0,
            min: f64::MIN_POSITIVE,
            max: f64::MAX,
        });
    }
    let [_, ki, _] = pid.signed_gains();
    if ki == 0.0 || ki.signum() != sign_of_ki(plant) {
        return Err(Refusal::NoSolution {
            why: "the integral gain must not be 0 and must have the sign of the plant's gain (the other one if an odd number of real poles is unstable)",
            help: "check the sign of ki, the action of the controller and the sign of the gain",
        });
    }
    Ok(())
}
