//! A figure of a card.

/// The keys of all figures, in the order of the card.
pub const KEYS: [&str; 16] = [
    "ms",
    "mt",
    "gm",
    "gm_low",
    "pm_deg",
    "delay_margin",
    "jitter_margin",
    "ki",
    "noise_gain",
    "noise_std",
    "noise_tv",
    "smallest_error",
    "limit_recovery",
    "limit_overshoot",
    "ram",
    "instructions",
];

/// Which way a figure gets better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// A smaller one is better: a card holds it from above.
    Smaller,
    /// A larger one is better: a card holds it from below.
    Larger,
}

/// What practice says of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Light {
    /// As practice has it.
    Good,
    /// Outside of it: look at why, and whether that is meant.
    Look,
    /// Far outside of it.
    Bad,
}

impl Light {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Look => "look",
            Self::Bad => "bad",
        }
    }
}

/// A figure, what practice says of it, and whose practice that is.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its name in JSON and in card files, one of [`KEYS`].
    pub key: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Its unit; empty: none.
    pub unit: String,
    /// Its value; infinite where nothing limits it.
    pub value: f64,
    /// Which way it gets better.
    pub better: Better,
    /// What practice says of it.
    pub light: Light,
    /// What is practice, and its source.
    pub practice: String,
    /// How this value is to be read; may be empty.
    pub note: String,
}
