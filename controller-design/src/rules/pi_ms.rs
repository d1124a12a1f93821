//! The PI with the largest integral gain at a given sensitivity peak.

mod region;
mod search;

use controller_core::PidConfig;

use crate::frequency::{Features, Response};
use crate::margins::{ContinuousLoop, Margins};
use crate::model::TransferFunction;
use crate::{Refusal, Warning, Warnings};
use region::Region;

/// Least and largest sensitivity peak that can be asked for.
const MS_RANGE: (f64, f64) = (1.01, 5.0);
/// Where a pole counts as undamped, relative to its size.
const AXIS: f64 = 1e-9;
/// Share of the largest proportional gain below which the optimum is taken for pure integral control.
const NO_GAIN: f64 = 1e-5;
/// Share of the largest proportional gain from which the optimum lies at that limit.
const AT_LIMIT: f64 = 0.98;
/// `kp*gain` above which the result rests on how well the model's fast dynamics are known.
const HIGH_GAIN: f64 = 50.0;

/// The PI controller with the largest `ki` whose sensitivity peak `max|S|` is `ms`: the design of Tena et al. 2022,
/// section 4.2 and step 2 of section 6 (after Åström, Panagopoulos and Hägglund, MIGO). `1/ki` is the integral of the error after a unit step
/// of the load, so for a well damped loop this is also the least IAE.
///
/// For each frequency the gains that would bring the Nyquist curve nearer to -1 than `1/ms` fill an ellipse in the
/// plane of `kp` and `ki`. With `P + jQ = 1/G(j*omega)` and `R = |1/G|/ms`
///
/// ```text
/// ki_max(kp) = min over omega of  omega*(Q - sqrt(R^2 - (kp + P)^2)),    ellipses with an upper edge above 0,
/// kp         = argmax ki_max on 0 .. kp_hi,   kp_hi the first gain at which proportional control violates ms.
/// ```
///
/// Between `kp = 0` and `kp_hi` the allowed gains hang together with `ki` to 0, where a stable or integrating plant
/// is controlled stably; beyond `kp_hi` lie islands without meaning, which are not searched. The tables 1, 2 and 6 of
/// the paper are not this optimum (`kp` is off by 2 to 29 %).
///
/// Cost: about a millisecond, the check by [`ContinuousLoop::margins`] included. `max|S|` meets `ms` to 1e-8; `ki` is exact to the same, `kp` to about 1e-4, for the
/// optimum is flat in it. A negative gain of the plant makes both gains negative.
///
/// ```
/// use controller_design::model::parse;
/// use controller_design::rules::PiMs;
///
/// // Published for 1/(1+s)^3 and ms = 2.
/// let design = PiMs::new(&parse("1/(1+s)^3").expect("a valid plant"), 2.0).expect("a design");
/// assert!((design.pid.kp - 1.22).abs() < 0.005);
/// assert!((design.pid.kp / design.pid.ki - 1.78).abs() < 0.01);
/// assert!((design.ms - 2.0).abs() < 1e-8);
///
/// let refused = PiMs::new(&parse("1/(1+s)").expect("a valid plant"), 2.0).expect_err("unbounded");
/// assert!(refused.to_string().contains("without bound"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PiMs {
    /// The gains; `b = 1`.
    pub pid: PidConfig,
    /// The sensitivity peak of the loop with these gains.
    pub ms: f64,
    /// Where it is \[rad/s\].
    pub omega: f64,
    /// Margins of the loop.
    pub margins: Margins,
    /// What to know about the design.
    pub warnings: Warnings,
}

impl PiMs {
    /// The design for a plant and a sensitivity peak `ms`, 1.01 to 5 (usual are 1.2 to 2).
    ///
    /// # Errors
    /// * A plant that is unstable or undamped, has two integrators or a zero at `s = 0`, or neither more poles than
    ///   zeros nor dead time.
    /// * A gain without bound: of first order or integrating, without dead time.
    /// * A best proportional gain of 0 or less: lightly damped plants.
    pub fn new(plant: &TransferFunction, ms: f64) -> Result<Self, Refusal> {
        let (min, max) = MS_RANGE;
        if !(ms >= min && ms <= max) {
            return Err(Refusal::OutOfRange { parameter: "ms", value: ms, min, max });
        }
        check(plant)?;
        let response = Response::new(plant);
        let features = Features::of(plant);
        let circle = plant.relative_degree() == 0;
        let mut region = Region::new(&response, &features, ms, circle).ok_or(UNBOUNDED)?;
        let found = search::search(&mut region)?;
        if found.kp <= NO_GAIN * region.kp_hi() {
            return Err(Refusal::NoSolution {
                why: "the largest integral gain goes with a proportional gain of 0 or less",
                help: "the plant is lightly damped: damp it first by an inner loop, or use a PID",
            });
        }
        let gain = plant.gain();
        let pid = PidConfig { kp: found.kp / gain, ki: found.ki / gain, b: 1.0, ..PidConfig::default() };
        let usable = |x: f64| x.is_finite() && x.abs() >= f64::MIN_POSITIVE;
        if !(usable(pid.kp) && usable(pid.ki)) {
            return Err(Refusal::NoSolution {
                why: "the gains leave the range of numbers",
                help: "use units in which gains and times are moderate",
            });
        }
        // The encirclements, and the peak on a grid that the design knows nothing of.
        let margins = ContinuousLoop::new(plant, &pid).margins()?;
        let error = (margins.ms / ms - 1.0).abs();
        if error.is_nan() || error > 1e-6 {
            return Err(search::NONE);
        }
        let mut warnings = Warnings::new();
        if plant.integrators() == 0 && found.kp > HIGH_GAIN {
            let text = "the gain rests on the model's fastest times; a lag or dead time left out would lower it much";
            let _ = warnings.push(Warning::Value { about: "kp*gain", value: found.kp, text });
        }
        if found.kp >= AT_LIMIT * region.kp_hi() {
            let text = "the limit of proportional control; a resonance holds the gains down, more damping would help";
            let _ = warnings.push(Warning::Value { about: "kp", value: pid.kp, text });
        }
        Ok(Self { pid, ms: found.ms, omega: found.omega, margins, warnings })
    }
}

const UNBOUNDED: Refusal = Refusal::NoSolution {
    why: "the gains can grow without bound at this ms",
    help: "give the plant the dead time or the fast lags that were left out",
};

fn check(plant: &TransferFunction) -> Result<(), Refusal> {
    if plant.differentiators() > 0 {
        return Err(Refusal::Plant {
            must: "have no zero at s = 0: no integral action can hold its output",
            help: "control another output",
        });
    }
    if plant.integrators() > 1 {
        return Err(Refusal::Plant {
            must: "have at most one integrator for a PI controller",
            help: "close an inner loop around one of them and design for that loop",
        });
    }
    for pole in plant.poles() {
        let size = pole.abs();
        if size > 0.0 && pole.re > AXIS * size {
            return Err(Refusal::Plant {
                must: "be stable or integrating",
                help: "stabilise it with an inner loop first",
            });
        }
        if size > 0.0 && pole.re >= -AXIS * size {
            return Err(Refusal::Plant {
                must: "have no undamped pair of poles",
                help: "give the resonance the damping that it has",
            });
        }
    }
    if plant.relative_degree() == 0 && plant.dead_time() == 0.0 {
        return Err(Refusal::Plant {
            must: "have more poles than zeros, or dead time",
            help: "add the fast lag or the dead time that was left out",
        });
    }
    Ok(())
}
