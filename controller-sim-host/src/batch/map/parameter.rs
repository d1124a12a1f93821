//! What a map varies: letters of the plant, and options of the rule.

use controller_design::design::{AdrcGain, EstimatorFilter, Filter, ObserverFilter, Request};
use controller_design::model::TransferFunction;
use std::fmt;

/// Largest size of a value.
const MOST: f64 = 1e15;

/// Something that has one value at each point of a map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parameter {
    /// A letter or word in the expression of the plant.
    Plant(String),
    /// An option of the rule.
    Option(Setting),
}

/// An option of a rule that a map may vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Maximum sensitivity to design for.
    Ms,
    /// Largest maximum sensitivity with a disturbance block.
    MsMax,
    /// Time constant of an observer's filter \[s\].
    Alpha,
    /// The same over the dead time and all lags of the plant.
    AlphaRatio,
    /// Noise gain with an observer over that of the PI alone.
    NoiseRatio,
    /// Time constant of the PID's filter \[s\].
    Tf,
    /// Noise gain of the PID \[u/y\].
    Kpidn,
    /// Time constant of an estimator's filter \[s\].
    Tfd,
    /// Noise gain of an estimator \[u/y\].
    Kden,
    /// Time constant of the closed loop \[s\].
    TauC,
    /// Gain of an ADRC \[y/u/s^2\].
    B0,
}

impl Setting {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::Ms,
        Self::MsMax,
        Self::Alpha,
        Self::AlphaRatio,
        Self::NoiseRatio,
        Self::Tf,
        Self::Kpidn,
        Self::Tfd,
        Self::Kden,
        Self::TauC,
        Self::B0,
    ];

    /// What it is called on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::AlphaRatio => "alpha_ratio",
            other => other.option(),
        }
    }

    /// The option of the rules that it sets: those that look at it name it.
    #[must_use]
    pub const fn option(self) -> &'static str {
        match self {
            Self::Ms => "ms",
            Self::MsMax => "ms_max",
            Self::Alpha | Self::AlphaRatio => "alpha",
            Self::NoiseRatio => "noise_ratio",
            Self::Tf => "tf",
            Self::Kpidn => "kpidn",
            Self::Tfd => "tfd",
            Self::Kden => "kden",
            Self::TauC => "tau_c",
            Self::B0 => "b0",
        }
    }

    /// Beside an axis, and its unit.
    #[must_use]
    pub const fn label(self) -> (&'static str, &'static str) {
        match self {
            Self::Ms => ("Ms asked for", ""),
            Self::MsMax => ("largest Ms allowed", ""),
            Self::Alpha => ("filter of the observer \u{3b1}", "s"),
            Self::AlphaRatio => ("\u{3b1}/(dead time + lags)", ""),
            Self::NoiseRatio => ("noise gain over that of the PI", ""),
            Self::Tf => ("filter of the PID tf", "s"),
            Self::Kpidn => ("noise gain of the PID", "u/y"),
            Self::Tfd => ("filter of the estimator tfd", "s"),
            Self::Kden => ("noise gain of the estimator", "u/y"),
            Self::TauC => ("closed-loop time constant tau_c", "s"),
            Self::B0 => ("gain b0", "y/u/s\u{b2}"),
        }
    }

    /// Whether it and another one set the same thing.
    #[must_use]
    pub fn excludes(self, other: Self) -> bool {
        const TOGETHER: [&[Setting]; 3] = [
            &[Setting::Alpha, Setting::AlphaRatio, Setting::NoiseRatio],
            &[Setting::Tf, Setting::Kpidn],
            &[Setting::Tfd, Setting::Kden],
        ];
        TOGETHER.iter().any(|group| group.contains(&self) && group.contains(&other))
    }

    /// Its range in words, when `value` is out of it.
    fn refuses(self, value: f64) -> Option<&'static str> {
        let (good, range) = match self {
            Self::Ms | Self::MsMax => ((1.001..=100.0).contains(&value), "1.001 to 100"),
            Self::NoiseRatio => ((1.000_001..=1e9).contains(&value), "1.000001 to 1e9"),
            Self::Tf => ((0.0..=1e12).contains(&value), "0 to 1e12"),
            Self::B0 => (value != 0.0 && value.abs() <= MOST, "-1e15 to 1e15, not 0"),
            _ => (value > 0.0 && value <= MOST, "above 0, at most 1e15"),
        };
        (!good).then_some(range)
    }

    /// Puts it into a request for a plant.
    ///
    /// # Errors
    /// Why it means nothing to this plant.
    pub(super) fn apply(
        self,
        value: f64,
        plant: &TransferFunction,
        request: &mut Request,
    ) -> Result<(), String> {
        match self {
            Self::Ms => request.ms = Some(value),
            Self::MsMax => request.ms_max = Some(value),
            Self::Alpha => request.observer_filter = ObserverFilter::Time(value),
            Self::AlphaRatio => {
                let whole = plant.dead_time() + lags(plant);
                if !(whole > 0.0 && whole.is_finite()) {
                    return Err("alpha_ratio means nothing to a plant without dead time and lags".to_owned());
                }
                request.observer_filter = ObserverFilter::Time(value * whole);
            }
            Self::NoiseRatio => request.observer_filter = ObserverFilter::NoiseRatio(value),
            Self::Tf => request.filter = Filter::Time(value),
            Self::Kpidn => request.filter = Filter::NoiseGain(value),
            Self::Tfd => request.estimator_filter = EstimatorFilter::Time(value),
            Self::Kden => request.estimator_filter = EstimatorFilter::NoiseGain(value),
            Self::TauC => request.tau_c = Some(value),
            Self::B0 => request.b0 = AdrcGain::Value(value),
        }
        Ok(())
    }
}

/// The sum of the lags \[s\]: of the poles in the left half-plane, a complex pair by its `2*zeta/omega`.
fn lags(plant: &TransferFunction) -> f64 {
    let left = plant.poles().into_iter().filter(|pole| pole.re < 0.0);
    left.map(|pole| -pole.re / (pole.re * pole.re + pole.im * pole.im)).sum()
}

impl Parameter {
    /// The parameter called `name`: an option of the rules, else a letter of the plant.
    ///
    /// # Errors
    /// A name that nothing can have.
    pub fn named(name: &str) -> Result<Self, String> {
        if let Some(setting) = Setting::ALL.into_iter().find(|setting| setting.name() == name) {
            return Ok(Self::Option(setting));
        }
        let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_word = begins && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_word || matches!(name, "s" | "exp") || name.len() > 40 {
            let options = Setting::ALL.map(Setting::name).join(", ");
            return Err(format!("`{name}` is no parameter: write a letter of the plant or one of {options}"));
        }
        Ok(Self::Plant(name.to_owned()))
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Plant(name) => name,
            Self::Option(setting) => setting.name(),
        }
    }

    /// Whether the plant has it, not the rule.
    #[must_use]
    pub const fn is_of_plant(&self) -> bool {
        matches!(self, Self::Plant(_))
    }

    /// Checks a value.
    ///
    /// # Errors
    /// What is allowed instead.
    pub fn check(&self, value: f64) -> Result<(), String> {
        let range = match self {
            Self::Plant(_) => (value.is_nan() || value.abs() > MOST).then_some("-1e15 to 1e15"),
            Self::Option(setting) => setting.refuses(value),
        };
        let message =
            |range| format!("{} = {} is out of range: {range}", self.name(), crate::scenario::show(value));
        range.map_or(Ok(()), |range| Err(message(range)))
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_design::model::parse;

    #[test]
    fn names_are_options_or_letters() {
        assert_eq!(Parameter::named("ms"), Ok(Parameter::Option(Setting::Ms)));
        assert_eq!(Parameter::named("tau_2"), Ok(Parameter::Plant("tau_2".to_owned())));
        for wrong in ["", "s", "exp", "2x", "a b", "\u{3c4}", "a-b"] {
            assert!(Parameter::named(wrong).is_err(), "{wrong}");
        }
        for setting in Setting::ALL {
            assert_eq!(Parameter::named(setting.name()), Ok(Parameter::Option(setting)));
            assert!(setting.refuses(f64::NAN).is_some() && setting.refuses(f64::INFINITY).is_some());
            assert!(setting.refuses(-1.0).is_some() || setting == Setting::B0);
        }
        assert!(Parameter::Plant("a".to_owned()).check(f64::NAN).is_err());
    }

    #[test]
    fn lags_add_up() {
        let of = |text: &str| lags(&parse(text).expect("a plant"));
        for (text, sum) in [
            ("exp(-s)/(1+2*s)", 2.0),
            ("1/((1+2*s)*(1+s))", 3.0),
            ("1/(1+0.6*s+s^2)", 0.6),
            ("exp(-s)/s", 0.0),
            ("1/(s*(1+4*s))", 4.0),
        ] {
            assert!((of(text) - sum).abs() < 1e-9, "{text}: {}", of(text));
        }
    }
}
