//! Whether a loop still keeps its card.

use super::{CardFile, KEYS, LoopCard};

/// A figure beside its bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// One of [`KEYS`].
    pub key: &'static str,
    /// What it was when the card was saved.
    pub was: Option<f64>,
    /// What it is; none when the loop does not have it any more.
    pub is: Option<f64>,
    /// The least that it may be.
    pub min: Option<f64>,
    /// The most that it may be.
    pub max: Option<f64>,
    /// Whether the bounds are kept. A figure that is missing keeps none.
    pub holds: bool,
    /// Why it is missing; empty when it is not.
    pub why: String,
}

/// What a check found.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Every figure of the file, in the order of [`KEYS`].
    pub verdicts: Vec<Verdict>,
    /// Figures of the loop that the file does not hold.
    pub unchecked: Vec<&'static str>,
}

impl Check {
    /// Whether every figure keeps its bounds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.verdicts.iter().all(|verdict| verdict.holds)
    }
}

/// Holds `card` against the bounds of `file`. The bounds themselves are kept; a figure without bounds must be there.
#[must_use]
pub fn check(file: &CardFile, card: &LoopCard) -> Check {
    let verdict = |bounds: &super::Bounds| {
        let is = card.value(bounds.key);
        let holds = is.is_some_and(|is| {
            // Not a number keeps nothing.
            bounds.min.is_none_or(|least| is >= least)
                && bounds.max.is_none_or(|most| is <= most)
                && !is.is_nan()
        });
        let absent = card.absent.iter().find(|(key, _)| *key == bounds.key);
        let why = match (is, absent) {
            (Some(_), _) => String::new(),
            (None, Some((_, why))) => why.clone(),
            (None, None) => "the loop does not have it".to_owned(),
        };
        Verdict { key: bounds.key, was: bounds.was, is, min: bounds.min, max: bounds.max, holds, why }
    };
    let is_held = |key: &&str| file.bounds.iter().any(|bounds| bounds.key == *key);
    Check {
        verdicts: file.bounds.iter().map(verdict).collect(),
        unchecked: KEYS.into_iter().filter(|key| card.value(key).is_some() && !is_held(key)).collect(),
    }
}
