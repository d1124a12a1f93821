//! One number of a paper, and what is to be said of it.

/// A number of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its row, such as `GP5 MOMI`.
    pub row: String,
    /// What it is.
    pub quantity: String,
    /// What the paper prints, digit for digit; `None`: nothing.
    pub printed: Option<String>,
    /// What is true; `None`: it cannot be known, or is no number.
    pub truth: Option<f64>,
    /// By how much ours may differ from what is true.
    pub tolerance: Option<Tolerance>,
    /// What this library gives.
    pub ours: Option<f64>,
    /// What is to be said of the printed number.
    pub verdict: Verdict,
    /// Why; may be empty.
    pub reason: String,
}

impl Cell {
    /// Whether ours is not what is true. Without a true number there is nothing to differ from.
    #[must_use]
    pub fn differs(&self) -> bool {
        let Some(truth) = self.truth else { return false };
        let allowed = self.allowed().unwrap_or(0.0);
        // Also when ours is missing or not a number.
        !self.ours.is_some_and(|ours| (ours - truth).abs() <= allowed)
    }

    /// The largest difference between ours and true that is allowed.
    #[must_use]
    pub fn allowed(&self) -> Option<f64> {
        match (self.tolerance?, self.truth?) {
            (Tolerance::Relative(part), truth) => Some(part * truth.abs()),
            (Tolerance::Absolute(size), _) => Some(size),
        }
    }
}

/// How near ours must be to what is true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// A part of what is true.
    Relative(f64),
    /// A size.
    Absolute(f64),
}

/// What is to be said of a printed number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Every printed digit is right.
    AsPrinted,
    /// Right but for the last digits.
    Rounding,
    /// Not what the paper's own computation gives.
    Misprint,
    /// An iterate that has not converged.
    NotConverged,
    /// Not the optimum it is said to be.
    NotOptimum,
    /// Right for other settings than the paper says.
    OtherSettings,
    /// A claim that does not hold.
    FalseClaim,
    /// Cannot be computed from what the paper says.
    NotReproducible,
    /// Not in the paper: a true value beside it.
    NotPrinted,
}

impl Verdict {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::AsPrinted,
        Self::Rounding,
        Self::Misprint,
        Self::NotConverged,
        Self::NotOptimum,
        Self::OtherSettings,
        Self::FalseClaim,
        Self::NotReproducible,
        Self::NotPrinted,
    ];

    /// In words: `as printed`, `misprint`, ...
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::AsPrinted => "as printed",
            Self::Rounding => "rounding",
            Self::Misprint => "misprint",
            Self::NotConverged => "not converged",
            Self::NotOptimum => "not the optimum",
            Self::OtherSettings => "other settings",
            Self::FalseClaim => "false claim",
            Self::NotReproducible => "not reproducible",
            Self::NotPrinted => "not printed",
        }
    }

    /// From its words.
    #[must_use]
    pub fn from_words(words: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.words() == words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(truth: Option<f64>, tolerance: Option<Tolerance>, ours: Option<f64>) -> Cell {
        Cell {
            row: String::new(),
            quantity: String::new(),
            printed: None,
            truth,
            tolerance,
            ours,
            verdict: Verdict::AsPrinted,
            reason: String::new(),
        }
    }

    #[test]
    fn ours_may_differ_by_the_tolerance_and_no_more() {
        let relative = Some(Tolerance::Relative(0.01));
        for (ours, differs) in [
            (Some(-2.0), false),
            (Some(-2.0199), false),
            (Some(-1.9801), false),
            (Some(-2.021), true),
            (Some(2.0), true),
            (Some(f64::NAN), true),
            (Some(f64::INFINITY), true),
            (None, true),
        ] {
            assert_eq!(cell(Some(-2.0), relative, ours).differs(), differs, "{ours:?}");
        }
        let absolute = Some(Tolerance::Absolute(0.5));
        assert!(!cell(Some(0.0), absolute, Some(0.5)).differs());
        assert!(cell(Some(0.0), absolute, Some(-0.6)).differs());
        // A count must be met.
        assert!(!cell(Some(7.0), Some(Tolerance::Absolute(0.0)), Some(7.0)).differs());
        // A truth without a tolerance must be met, too.
        assert!(cell(Some(7.0), None, Some(7.1)).differs());
        assert!(!cell(None, None, None).differs());
    }

    #[test]
    fn every_verdict_has_words_of_its_own() {
        for verdict in Verdict::ALL {
            assert_eq!(Verdict::from_words(verdict.words()), Some(verdict));
        }
        assert_eq!(Verdict::from_words("fine"), None);
    }
}
