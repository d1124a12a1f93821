//! The choice between raw areas and fit, and what a person should know about it.

use super::estimate::Estimate;
use super::fit::Fitted;
use super::identified::Chosen;
use super::record::Record;
use super::structures::Fits;
use crate::{Warning, Warnings};

/// Largest spread of `K_P` with which raw areas are used, and the one with which they are whatever the fit says.
const MOST_SPREAD: f64 = 0.1;
const GOOD_SPREAD: f64 = 0.002;

/// Raw areas when they are certain beyond question, the fit when they are not certain enough, and between the two the
/// one with the smaller interval; a fit that does not explain the record only when there is no other way.
pub(super) fn choose(
    raw: &Estimate,
    fitted: Option<&Estimate>,
    explained: bool,
    warnings: &mut Warnings,
) -> Chosen {
    let spread = raw.kp_spread();
    let mut say = |text| {
        let about = "chosen";
        let warning = match spread.is_finite() {
            true => Warning::Value { about: "kp_spread of the raw areas", value: spread, text },
            false => Warning::Text { about, text },
        };
        let _ = warnings.push(warning);
    };
    let good = spread <= MOST_SPREAD;
    if spread <= GOOD_SPREAD || (good && !explained) {
        return Chosen::Areas;
    }
    let Some(fitted) = fitted.filter(|fitted| fitted.kp.is_some()) else {
        if !good {
            say("no model fits the record either; the raw areas are used although they are uncertain");
        }
        return Chosen::Areas;
    };
    if good && raw.kp_interval <= fitted.kp_interval {
        return Chosen::Areas;
    }
    if good {
        say("the areas of the fitted model are less uncertain and are used");
        return Chosen::Fit;
    }
    if spread.is_finite() {
        say("more than 0.1, so the areas of the fitted model are used");
    } else {
        say("no controller follows from the raw areas, so the areas of the fitted model are used");
    }
    Chosen::Fit
}

/// More than 1 when the residuals of a fit are more than noise: larger than it, or going on for long.
pub(super) fn unexplained(record: &Record, fit: &Fitted) -> f64 {
    let noise = record.noise.sigma.max(record.noise.quantisation / 3.4);
    (fit.rms / (2.0 * noise).max(1e-6)).min(fit.colour)
}

pub(super) fn remarks(record: &Record, fits: Option<&Fits>, warnings: &mut Warnings) {
    let mut say = |warning| {
        let _ = warnings.push(warning);
    };
    let Some(fits) = fits else {
        say(Warning::Text { about: "model", text: "no second-order model could be fitted" });
        return;
    };
    let noise = record.noise.sigma.max(record.noise.quantisation / 3.4).max(1e-9);
    if unexplained(record, &fits.best) > 1.0 {
        say(Warning::Value {
            about: "misfit over noise",
            value: fits.best.rms / noise,
            text: "no model of a few lags explains the record; look for a disturbance, friction or a changing gain",
        });
    } else if fits.best.shape.order > 2 || fits.best.shape.zero {
        say(Warning::Value {
            about: "fit_rms over noise",
            value: fits.second_order.rms / noise,
            text: "the record asks for more than two lags with dead time; the areas are those of the richer fit",
        });
    }
    if record.before < 3 {
        say(Warning::Text {
            about: "y0",
            text: "fewer than three rows before the change: the baseline rests on them and on the fit",
        });
    }
    let (t, ..) = record.after();
    let areas = fits.best.areas();
    let rows = t.partition_point(|t| *t < areas[1] / areas[0]);
    if rows < 10 {
        say(Warning::Value {
            about: "rows in A1/A0",
            value: rows as f64,
            text: "sample faster for areas that are right to a per cent",
        });
    }
}
