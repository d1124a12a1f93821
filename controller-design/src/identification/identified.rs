//! The result, and the way to it.

use super::choice::{choose, remarks, unexplained};
use super::estimate;
use super::fit::{Fitted, lags};
use super::gains;
use super::moments::Six;
use super::record::Record;
use super::settling::Settling;
use super::structures;
use super::{IdentifyOptions, Recording};
use crate::areas::Areas;
use crate::rules::reduction::Reduced;
use crate::{Refusal, Warning, Warnings};

/// Spread of `K_P` from which a person should look at the model before using gains.
const WIDE_SPREAD: f64 = 0.3;

/// Which areas were chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chosen {
    /// The raw areas, integrals of the record.
    Areas,
    /// The areas of the fitted model.
    Fit,
}

impl Chosen {
    /// `areas` or `fit`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Areas => "areas",
            Self::Fit => "fit",
        }
    }
}

/// `gain*exp(-dead_time*s)/(1 + a1*s + a2*s^2)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondOrder {
    /// Change of `y` per change of `u`.
    pub gain: f64,
    /// In s.
    pub a1: f64,
    /// In s^2.
    pub a2: f64,
    /// In s.
    pub dead_time: f64,
}

/// The fit that explains the record best: `offset + gain*(1 + b1*s)*exp(-dead_time*s)/(1 + a[0]*s + a[1]*s^2 + ..)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Number of lags, 2 to 4.
    pub order: usize,
    /// The output before the change.
    pub offset: f64,
    /// Change of `y` per change of `u`.
    pub gain: f64,
    /// Time of the zero in s, 0 when there is none.
    pub b1: f64,
    /// Coefficients of `s, s^2, s^3, s^4`.
    pub a: [f64; 4],
    /// Of the two factors `1 + f[0]*s + f[1]*s^2` and `1 + f[2]*s + f[3]*s^2` of the same denominator.
    pub(super) factors: [f64; 4],
    /// In s.
    pub dead_time: f64,
    /// Root mean square of the residuals, in the unit of `y`.
    pub rms: f64,
    /// Its areas.
    pub areas: Areas,
    /// Half widths of the 90 % intervals of its areas.
    pub area_interval: [f64; 6],
    /// Relative standard deviation of the `K_P` that follows from it, like [`Identified::kp_spread`].
    pub kp_spread: f64,
}

/// What a recording says about the process.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// The chosen areas, `A_k` in the unit of `y/u` times s^k.
    pub areas: Areas,
    /// Half widths of their 90 % intervals.
    pub area_interval: [f64; 6],
    /// The areas straight from the record.
    pub raw_areas: Areas,
    /// Half widths of the 90 % intervals of the raw areas.
    pub raw_area_interval: [f64; 6],
    /// Relative standard deviation, like `kp_spread`, of the `K_P` that follows from the raw areas; infinite when none does.
    pub raw_kp_spread: f64,
    /// The second-order model fitted to the record.
    pub model: Option<SecondOrder>,
    /// The output before the change, by the model.
    pub model_offset: f64,
    /// Half widths of the 90 % intervals of `gain, a1, a2, dead_time` of the model, for a process that is such a model.
    pub model_interval: Option<SecondOrder>,
    /// Root mean square of the residuals of the model, in the unit of `y`.
    pub fit_rms: f64,
    /// The fit whose areas compete with the raw ones.
    pub fit: Option<Fit>,
    /// Which areas were chosen.
    pub chosen: Chosen,
    /// Filter time in s for which `kp` is.
    pub tf: f64,
    /// `K_P` of the magnitude optimum, eq. (6), from the chosen areas.
    pub kp: f64,
    /// Half width of its 90 % interval: noise, truncation of the integrals, and the distance to the next richer structure
    /// where the record determines that one.
    pub kp_interval: f64,
    /// The same as a relative standard deviation, `kp_interval/(1.8*|kp|)`.
    pub kp_spread: f64,
    /// Standard deviation of the white noise of `y`, in its unit.
    pub sigma: f64,
    /// Smallest step between values of `y`, 0 when there is none to be seen.
    pub quantisation: f64,
    /// The output before.
    pub y0: f64,
    /// The input before.
    pub u0: f64,
    /// The output after.
    pub y_inf: f64,
    /// The input after.
    pub u_inf: f64,
    /// Time of the change in s.
    pub change_at: f64,
    /// Time in s from which the output stays within 2 % of its change of the final value.
    pub settled_at: f64,
    /// Time in s up to which the raw areas integrate and from which the final values are averaged.
    pub tail_from: f64,
    /// What a person should know.
    pub warnings: Warnings,
}

pub(super) fn identify(recording: &Recording<'_>, options: &IdentifyOptions) -> Result<Identified, Refusal> {
    if let Some(tf) = options.tf.filter(|tf| !(*tf >= 0.0 && *tf <= 1e150)) {
        return Err(Refusal::OutOfRange { parameter: "tf", value: tf, min: 0.0, max: 1e150 });
    }
    let mut record = Record::new(recording, options)?;
    let mut warnings = Warnings::new();
    let mut fits = structures::fits(&record);
    if let Some(best) = fits.as_ref().map(|fits| &fits.best) {
        record.noise.confirm(best.rms, best.colour);
    }
    let settling = Settling::new(&record, fits.as_ref());
    settling.check(&mut warnings)?;
    // The filter follows the slowness of the process, known well enough from either way.
    let mean_time = fits.as_ref().map(|fits| fits.best.areas()).map_or(0.05, |areas| areas[1] / areas[0]);
    let tf = options.tf.map_or(mean_time.clamp(0.0, 1.0) / 25.0, |tf| tf / record.time);
    let raw = estimate::raw(&record, fits.as_ref(), settling.row, tf);
    let mut fitted = fits.as_ref().map(|fits| estimate::fitted(&record, fits, tf));
    if let (Some(fits), Some(of)) = (&mut fits, &mut fitted)
        && of.kp.is_none()
    {
        // Two lags and dead time always have a controller; a richer fit need not.
        (fits.best, fits.richer) = (fits.second_order.clone(), None);
        *of = estimate::fitted(&record, fits, tf);
    }
    let explained = fits.as_ref().is_some_and(|fits| unexplained(&record, &fits.best) <= 1.0);
    let chosen = choose(&raw.estimate, fitted.as_ref(), explained, &mut warnings);
    let best = match (chosen, &fitted) {
        (Chosen::Fit, Some(fitted)) => fitted,
        _ => &raw.estimate,
    };
    let kp = gains::kp(&best.areas, tf)?;
    if !best.kp_spread().is_finite() {
        return Err(Refusal::Data {
            why: "noise hides how the output moves: no controller gain can be told",
            help: "make a larger change of the input, record a longer steady state after it, or filter less noise in",
        });
    }
    remarks(&record, fits.as_ref(), &mut warnings);
    if best.kp_spread() > WIDE_SPREAD {
        let text = "gains that follow from the areas are uncertain: use a longer filter or a larger change of the input";
        let _ = warnings.push(Warning::Value { about: "kp_spread", value: best.kp_spread(), text });
    }
    let unfit = match Reduced::new(&Areas::new(best.areas)) {
        Ok(reduced) => reduced.fallback,
        Err(_) => true,
    };
    if unfit {
        let text =
            "the areas are not those of two lags with dead time: rules that need such a model do not apply";
        let _ = warnings.push(Warning::Text { about: "areas", text });
    }
    let scale = Scale { gain: record.output / record.input, time: record.time };
    let y_of = |y: f64| record.y0 + y * record.output;
    let second = fits.as_ref().map(|fits| &fits.second_order);
    let found = Identified {
        areas: scale.areas(&best.areas),
        area_interval: scale.sizes(&best.interval),
        raw_areas: scale.areas(&raw.estimate.areas),
        raw_area_interval: scale.sizes(&raw.estimate.interval),
        raw_kp_spread: raw.estimate.kp_spread(),
        model: second.map(|fit| scale.second_order(fit)),
        model_offset: second.map_or(record.y0, |fit| y_of(fit.linear[0])),
        model_interval: second.map(|fit| scale.second_order_interval(fit)),
        fit_rms: second.map_or(0.0, |fit| fit.rms * record.output.abs()),
        fit: fits.as_ref().zip(fitted.as_ref()).map(|(fits, of)| Fit {
            order: fits.best.shape.order,
            offset: y_of(fits.best.linear[0]),
            gain: fits.best.linear[1] * scale.gain,
            b1: if fits.best.shape.zero {
                fits.best.linear[2] / fits.best.linear[1] * scale.time
            } else {
                0.0
            },
            a: scale.denominator(fits.best.denominator()),
            factors: scale.factors(&fits.best),
            dead_time: fits.best.times[0] * scale.time,
            rms: fits.best.rms * record.output.abs(),
            areas: scale.areas(&of.areas),
            area_interval: scale.sizes(&of.interval),
            kp_spread: of.kp_spread(),
        }),
        chosen,
        tf: tf * scale.time,
        kp: kp / scale.gain,
        kp_interval: best.kp_interval / scale.gain.abs(),
        kp_spread: best.kp_spread(),
        sigma: record.noise.sigma * record.output.abs(),
        quantisation: record.noise.quantisation * record.output.abs(),
        y0: record.y0,
        u0: record.u0,
        y_inf: y_of(raw.last_output),
        u_inf: record.u0 + raw.last_input * record.input,
        change_at: record.change_at,
        settled_at: record.change_at + settling.at * record.time,
        tail_from: record.change_at + record.t[raw.tail] * record.time,
        warnings,
    };
    if found.numbers_are_finite() {
        return Ok(found);
    }
    Err(Refusal::Data {
        why: "the numbers of the record are too large or too small to compute with",
        help: "choose other units",
    })
}

impl Identified {
    fn numbers_are_finite(&self) -> bool {
        let model = self.model.map_or([0.0; 4], |m| [m.gain, m.a1, m.a2, m.dead_time]);
        let lists = [self.areas.values(), self.area_interval];
        lists
            .iter()
            .flatten()
            .chain(&model)
            .chain(&[self.kp, self.kp_interval, self.tf])
            .all(|x| x.is_finite())
    }
}

/// From the scale of the record to units.
struct Scale {
    gain: f64,
    time: f64,
}

impl Scale {
    fn sizes(&self, areas: &Six) -> Six {
        let mut unit = self.gain.abs();
        core::array::from_fn(|k| {
            unit *= if k > 0 { self.time } else { 1.0 };
            areas[k] * unit
        })
    }

    fn areas(&self, areas: &Six) -> Areas {
        Areas::new(self.sizes(areas).map(|a| a * self.gain.signum()))
    }

    fn denominator(&self, mut a: [f64; 4]) -> [f64; 4] {
        let mut unit = 1.0;
        for a in &mut a {
            unit *= self.time;
            *a *= unit;
        }
        a
    }

    fn factors(&self, fit: &Fitted) -> [f64; 4] {
        let [one, other] = lags(fit.shape, &fit.times);
        let (first, second) = (self.time, self.time * self.time);
        [one.a1 * first, one.a2 * second, other.a1 * first, other.a2 * second]
    }

    fn second_order(&self, fit: &Fitted) -> SecondOrder {
        let [dead_time, a1, a2, ..] = fit.times;
        SecondOrder {
            gain: fit.linear[1] * self.gain,
            a1: a1 * self.time,
            a2: a2 * self.time * self.time,
            dead_time: dead_time * self.time,
        }
    }

    fn second_order_interval(&self, fit: &Fitted) -> SecondOrder {
        let half = |i: usize| estimate::NINETY * libm::sqrt(fit.covariance[i][i].max(0.0));
        SecondOrder {
            gain: half(1) * self.gain.abs(),
            dead_time: half(2) * self.time,
            a1: half(3) * self.time,
            a2: half(4) * self.time * self.time,
        }
    }
}
