//! The options that say which controller is wanted, common to `design` and `tune`.

use crate::output::Problem;
use clap::Args;
use controller_design::design::{AdrcGain, EstimatorFilter, Filter, Method, ObserverFilter, Request};
use controller_design::model::TransferFunction;

/// What is asked of a design.
#[derive(Debug, Default, Args)]
pub(super) struct Wish {
    /// Time constant of the PID's filter [s]
    #[arg(long, value_name = "S", value_parser = time, conflicts_with = "kpidn")]
    tf: Option<f64>,
    /// Noise gain of the PID at a quarter of the sampling frequency [u/y]; default 4/|K|, or what is attainable (momi,
    /// drmo, de-momi), or what a filter of a tenth of the derivative time leaves (ah, amigo, simc)
    #[arg(long, value_name = "G", value_parser = positive)]
    kpidn: Option<f64>,
    /// Time constant of the disturbance estimator's filter [s] (de-momi)
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "kden")]
    tfd: Option<f64>,
    /// Noise gain of the disturbance estimator [u/y] (de-momi); default: that of the PID
    #[arg(long, value_name = "G", value_parser = positive)]
    kden: Option<f64>,
    /// Maximum sensitivity to design for (pi-ms, dob: default 1.4; ah: 1.4 or 2; adrc: default 1.6)
    #[arg(long, value_name = "M", value_parser = sensitivity)]
    ms: Option<f64>,
    /// Largest maximum sensitivity with a disturbance block: slows its filter, then cuts its gain (de-momi, dob)
    #[arg(long, value_name = "M", value_parser = sensitivity)]
    ms_max: Option<f64>,
    /// Noise gain with the observer over that of the PI alone, above 1 (dob)
    #[arg(long, value_name = "B", value_parser = positive, conflicts_with_all = ["alpha", "want"])]
    noise_ratio: Option<f64>,
    /// Time constant of the observer's filter [s] (dob)
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with = "want")]
    alpha: Option<f64>,
    /// Index after a unit load to choose the observer's filter for (dob): iae, ise, itae, e_max, or ramp_ie for a ramp
    #[arg(long, value_name = "INDEX=VALUE", value_parser = index)]
    want: Option<Index>,
    /// Gain at high frequencies that the controller is given (adrc): `model` takes it from the plant's second-order model,
    /// `search` the one with the most integral gain within --ms; default: model, in a comparison search
    #[arg(long, value_name = "model|search|G", value_parser = gain, allow_negative_numbers = true)]
    b0: Option<Gain>,
    /// Time constant of the closed loop [s] (simc); default: the dead time
    #[arg(long, value_name = "S", value_parser = positive)]
    tau_c: Option<f64>,
    /// From reading the measurement to acting with the output [s]
    #[arg(long, value_name = "S", value_parser = time, default_value_t = 0.0)]
    pub(super) latency: f64,
    /// What the controller is called in the design file; default: the method
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub(super) name: Option<String>,
    /// Range of the output, for the design file
    #[arg(long, value_name = "LO:HI", value_parser = range, allow_hyphen_values = true)]
    pub(super) limits: Option<(f64, f64)>,
}

impl Wish {
    /// The request for `method`; `ms_max` when it is not given.
    pub(super) fn request(&self, method: Method, ts: f64, ms_max: Option<f64>) -> Request {
        let mut request = Request { latency: self.latency, ..Request::new(method, ts) };
        let filter = self.tf.map(Filter::Time).or(self.kpidn.map(Filter::NoiseGain));
        request.filter = filter.unwrap_or(request.filter);
        let filter = self.tfd.map(EstimatorFilter::Time).or(self.kden.map(EstimatorFilter::NoiseGain));
        request.estimator_filter = filter.unwrap_or(request.estimator_filter);
        let filter =
            self.alpha.map(ObserverFilter::Time).or(self.noise_ratio.map(ObserverFilter::NoiseRatio));
        let filter = filter.or(self.want.map(|Index(wish)| ObserverFilter::Wanted(wish)));
        request.observer_filter = filter.unwrap_or(request.observer_filter);
        request.ms = self.ms;
        request.b0 = self.b0.map_or(request.b0, |Gain(b0)| b0);
        request.tau_c = self.tau_c;
        request.ms_max = self.ms_max.or(ms_max);
        request
    }

    /// The request for `method` among all others: an ADRC whose gain is not given has it searched for, since that of the
    /// model, the rule's own, compares badly on plants with dead time.
    pub(super) fn compared(&self, method: Method, ts: f64, ms_max: Option<f64>) -> Request {
        let request = self.request(method, ts, ms_max);
        Request { b0: self.b0.map_or(AdrcGain::Search, |Gain(b0)| b0), ..request }
    }

    /// The options for a rule that were given, by their names in files.
    pub(super) fn given(&self) -> Vec<&'static str> {
        let all = [
            ("tf", self.tf.is_some()),
            ("kpidn", self.kpidn.is_some()),
            ("tfd", self.tfd.is_some()),
            ("kden", self.kden.is_some()),
            ("ms", self.ms.is_some()),
            ("ms_max", self.ms_max.is_some()),
            ("b0", self.b0.is_some()),
            ("tau_c", self.tau_c.is_some()),
            ("noise_ratio", self.noise_ratio.is_some()),
            ("alpha", self.alpha.is_some()),
            ("want", self.want.is_some()),
        ];
        all.into_iter().filter_map(|(option, is_given)| is_given.then_some(option)).collect()
    }

    /// Options that mean nothing to `method`.
    pub(super) fn idle(&self, method: Method) -> Vec<Problem> {
        let idle = self.given().into_iter().filter(|option| !method.options().contains(option));
        idle.map(|option| {
            let message = format!("`{}` means nothing to the method {}", flag(option), method.name());
            Problem::new("usage", message).help(format!("it belongs to {}", Method::that_look_at(option)))
        })
        .collect()
    }
}

/// An option as it is typed.
pub(super) fn flag(option: &str) -> String {
    format!("--{}", option.replace('_', "-"))
}

/// The gain of an ADRC, as it is read.
#[derive(Debug, Clone, Copy)]
struct Gain(AdrcGain);

fn gain(text: &str) -> Result<Gain, String> {
    match (text.trim(), number(text)) {
        ("model", _) => Ok(Gain(AdrcGain::Model)),
        ("search", _) => Ok(Gain(AdrcGain::Search)),
        (_, Ok(b0)) if b0 != 0.0 => Ok(Gain(AdrcGain::Value(b0))),
        _ => Err("write `model`, `search` or a number other than 0".to_owned()),
    }
}

/// A wish for an index, as it is read.
#[derive(Debug, Clone, Copy)]
struct Index(controller_design::rules::Wish);

fn index(text: &str) -> Result<Index, String> {
    use controller_design::rules::Wish::{EMax, Iae, Ise, Itae, RampIe};
    let (name, value) = text.split_once('=').ok_or("write INDEX=VALUE, for example `iae=0.5`")?;
    let value = positive(value)?;
    match name.trim() {
        "iae" => Ok(Index(Iae(value))),
        "ise" => Ok(Index(Ise(value))),
        "itae" => Ok(Index(Itae(value))),
        "e_max" => Ok(Index(EMax(value))),
        "ramp_ie" => Ok(Index(RampIe(value))),
        _ => Err("the index is one of iae, ise, itae, e_max, ramp_ie".to_owned()),
    }
}

/// A sampling period for a plant whose user has none yet: about a two-hundredth of what the plant needs to respond, of
/// the series 1, 2, 5.
pub(super) fn usual_period(plant: &TransferFunction) -> f64 {
    let span = |roots: Vec<controller_design::model::Complex>| -> f64 {
        let rates = roots.iter().map(|root| root.abs()).filter(|rate| *rate > 0.0);
        rates.map(f64::recip).sum()
    };
    let whole = plant.dead_time() + span(plant.poles());
    let wanted = if whole > 0.0 && whole.is_finite() { whole / 200.0 } else { 0.01 };
    crate::design_file::round_down(wanted)
}

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err("write a number, for example `2.5`".to_owned()),
    }
}

fn bounded(text: &str, is_allowed: impl Fn(f64) -> bool, allowed: &str) -> Result<f64, String> {
    let x = number(text)?;
    if is_allowed(x) { Ok(x) } else { Err(format!("allowed: {allowed}")) }
}

fn time(text: &str) -> Result<f64, String> {
    bounded(text, |x| (0.0..=1e12).contains(&x), "0 to 1e12 s")
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    bounded(text, |x| x > 0.0 && x <= 1e15, "above 0, at most 1e15")
}

pub(super) fn sensitivity(text: &str) -> Result<f64, String> {
    bounded(text, |x| (1.001..=100.0).contains(&x), "1.001 to 100")
}

fn name(text: &str) -> Result<String, String> {
    let is_good = (1..=60).contains(&text.chars().count()) && !text.contains(char::is_control);
    if is_good && !text.trim().is_empty() {
        Ok(text.to_owned())
    } else {
        Err("write 1 to 60 characters on one line".to_owned())
    }
}

fn range(text: &str) -> Result<(f64, f64), String> {
    let parts = text.split_once(':').map(|(lo, hi)| (number(lo), number(hi)));
    match parts {
        Some((Ok(lo), Ok(hi))) if lo < hi => Ok((lo, hi)),
        _ => Err("write the lower and the upper limit, for example `0:100`".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_design::model::parse;

    #[test]
    fn the_usual_period_is_round_and_scales_with_the_plant() {
        let of = |plant: &str| usual_period(&parse(plant).expect("a valid plant"));
        let periods = [
            "exp(-0.2*s)/((1+0.2*s)*(1+s))",
            "1/(1+2e-6*s)",
            "1e-3/(1+1e6*s)",
            "exp(-s)/s",
            "1/(1+0.2*s+s^2)",
        ];
        assert_eq!(periods.map(of), [0.005, 1e-8, 5000.0, 0.005, 0.01]);
    }

    #[test]
    fn limits_are_in_order() {
        assert_eq!(range("-1:2.5"), Ok((-1.0, 2.5)));
        for wrong in ["1", "2:1", "1:1", "a:b", "1:inf"] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }
}
