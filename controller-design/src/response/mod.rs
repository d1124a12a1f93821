//! Load responses of a continuous loop with dead time, and their indices over an infinite horizon.
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
mod map;
mod march;
mod measure;
mod mesh;
mod nodes;
mod realisation;

use core::ops::ControlFlow;
use std::vec::Vec;

use controller_core::PidConfig;

use crate::Refusal;
use crate::model::TransferFunction;
use march::{March, Outcome};
use measure::{Element, Sums};
use realisation::Realisation;

/// A load at the plant input that begins at `t = 0`, the loop at rest before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load {
    /// `d = 1`.
    Step,
    /// `d = t`, t in seconds.
    Ramp,
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

/// Indices of the error `e = r - y` with `r = 0`, from the load at `t = 0` to infinity. Units: those of y for a
/// load of 1 (or a slope of 1 per second), and seconds.
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
/// zero at `s = 0`. The controller: `ki/s + ((kp - ki*tf) + kd*s)/(1 + tf*s)`, `ki != 0`, its set-point weights
/// without effect here. The observer's model is the plant.
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
        within("accuracy", accuracy, 1e-9, 1e-2)?;
        check(plant, pid, observer)?;
        let march = March::new(Realisation::new(plant, pid, observer)?, accuracy)?;
        Ok(Self { march, accuracy })
    }

    /// The indices over an infinite horizon. Cost: some ten microseconds for an ordinary loop.
    ///
    /// # Errors
    /// The loop is unstable or does not settle; a ramp without observer, under which the error does not end.
    pub fn indices(&self, load: Load) -> Result<Indices, Refusal> {
        let (sums, z) = self.settled(load, f64::INFINITY)?;
        let r = &self.march.realisation;
        let slope = if load == Load::Ramp { r.time } else { 1.0 };
        let y = r.gain.abs() * slope;
        let indices = Indices {
            ie: -r.gain * slope * r.time * r.integral(load, &z),
            iae: sums.iae * y * r.time,
            ise: sums.ise * y * y * r.time,
            itae: sums.itae * y * r.time * r.time,
            e_max: sums.y_max * y,
            t_max: sums.t_max * r.time,
            tv: if load == Load::Ramp { f64::INFINITY } else { sums.tv },
        };
        let numbers = [indices.ie, indices.iae, indices.ise, indices.itae, indices.e_max];
        if numbers.iter().all(|x| x.is_finite()) { Ok(indices) } else { Err(unstable()) }
    }

    /// The IAE of a step, or infinity as soon as it is known to be above `limit` or the loop is unstable; and the number of
    /// elements it took.
    pub(crate) fn iae_below(&self, limit: f64) -> (f64, usize) {
        let r = &self.march.realisation;
        let unit = r.gain.abs() * r.time;
        let mut settling = Settling::new(self.accuracy, limit / unit);
        let mut elements = 0;
        let (outcome, _) = self.march.run(Load::Step, false, &mut |e| {
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
        self.ends(load)?;
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
        let (outcome, _) = self.march.run(load, false, &mut visit);
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
        self.march.run(load, false, &mut visit);
        Ok(samples)
    }

    fn ends(&self, load: Load) -> Result<(), Refusal> {
        self.march.realisation.end(load).map(|_| ()).ok_or(Refusal::NoSolution {
            why: "under a ramp the error of a loop without observer stays at 1/ki for ever",
            help: "add a disturbance observer, or ask for a step",
        })
    }

    fn settled(&self, load: Load, limit: f64) -> Result<(Sums, Vec<f64>), Refusal> {
        self.ends(load)?;
        let mut settling = Settling::new(self.accuracy, limit);
        let (outcome, z) = self.march.run(load, false, &mut |e| settling.visit(e));
        verdict(outcome)?;
        if settling.sums.iae > limit { Err(unstable()) } else { Ok((settling.sums, z)) }
    }
}

/// Gathers the indices until what is left is negligible.
struct Settling {
    sums: Sums,
    accuracy: f64,
    limit: f64,
    /// Time and ITAE at the last look, and the largest y and v since.
    since: (f64, f64),
    y_max: f64,
    v_max: f64,
    v_ever: f64,
}

impl Settling {
    fn new(accuracy: f64, limit: f64) -> Self {
        let sums = Sums::default();
        Self { sums, accuracy, limit, since: (0.0, 0.0), y_max: 0.0, v_max: 0.0, v_ever: 0.0 }
    }

    fn visit(&mut self, e: &Element<'_>) -> ControlFlow<()> {
        self.sums.add(e);
        self.y_max = self.y_max.max(nodes::size(e.y));
        self.v_max = self.v_max.max(nodes::size(e.v));
        if self.sums.iae > self.limit {
            return ControlFlow::Break(());
        }
        let time = e.start + e.length;
        // A mode that dies out leaves less behind than it gave over the last quarter of the time, once it has
        // fallen to a millionth.
        if time < 1.25 * self.since.0 {
            return ControlFlow::Continue(());
        }
        self.v_ever = self.v_ever.max(self.v_max);
        let small = 0.1 * self.accuracy;
        let over = self.sums.y_max > 0.0
            && self.sums.itae - self.since.1 <= small * self.sums.itae
            && self.y_max <= small * self.sums.y_max
            && self.v_max <= small * self.v_ever;
        self.since = (time, self.sums.itae);
        (self.y_max, self.v_max) = (0.0, 0.0);
        if over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// The sign of `ki` without which no loop of this plant is stable.
pub(crate) fn sign_of_ki(plant: &TransferFunction) -> f64 {
    realisation::sign_of_ki(plant).signum()
}

fn unstable() -> Refusal {
    Refusal::NoSolution {
        why: "the loop of this plant and controller is unstable",
        help: "lower kp and ki, or check the sign of the gain",
    }
}

fn verdict(outcome: Outcome) -> Result<(), Refusal> {
    match outcome {
        Outcome::Stopped | Outcome::Unresolved => Ok(()),
        Outcome::Unstable => Err(unstable()),
        Outcome::Endless => Err(Refusal::NoSolution {
            why: "the response of this loop does not settle in any reasonable time",
            help: "lower kp, or raise ki if the tail is slow",
        }),
    }
}

fn within(parameter: &'static str, value: f64, min: f64, max: f64) -> Result<(), Refusal> {
    if value >= min && value <= max {
        Ok(())
    } else {
        Err(Refusal::OutOfRange { parameter, value, min, max })
    }
}

fn check(plant: &TransferFunction, pid: &PidConfig, observer: Option<Observer>) -> Result<(), Refusal> {
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
    if let Some(observer) = observer {
        within("alpha", observer.alpha, f64::MIN_POSITIVE, f64::MAX)?;
        let least = realisation::filter_order(plant);
        within("order", observer.order as f64, least as f64, 30.0)?;
    }
    Ok(())
}
