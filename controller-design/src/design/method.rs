//! The names of the tuning rules, what each is for, and where it comes from.

/// A way from a plant to a controller.
///
/// ```
/// use controller_design::design::Method;
/// assert_eq!(Method::named("de-momi"), Some(Method::DeMomi));
/// assert_eq!(Method::PiMs.name(), "pi-ms");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// PID with the magnitude optimum by areas (MOMI).
    Momi,
    /// PID with disturbance-rejection magnitude optimum (DRMO).
    Drmo,
    /// MOMI with a disturbance estimator (DE-MOMI).
    DeMomi,
    /// PI of the largest integral gain within a maximum sensitivity.
    PiMs,
    /// The same PI with a disturbance observer (DOB).
    Dob,
    /// PI of the smallest integral of the absolute error after a step load.
    PiIae,
    /// PID by Åström and Hägglund's kappa-tau rules.
    Ah,
    /// Active disturbance rejection control of second order.
    Adrc,
    /// PID by AMIGO.
    Amigo,
    /// PID by SIMC.
    Simc,
}

impl Method {
    /// All of them, in the order of their documentation.
    pub const ALL: [Self; 10] = [
        Self::Momi,
        Self::Drmo,
        Self::DeMomi,
        Self::PiMs,
        Self::Dob,
        Self::PiIae,
        Self::Ah,
        Self::Adrc,
        Self::Amigo,
        Self::Simc,
    ];

    /// The method called `name`, if there is one.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// What it is called on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Momi => "momi",
            Self::Drmo => "drmo",
            Self::DeMomi => "de-momi",
            Self::PiMs => "pi-ms",
            Self::Dob => "dob",
            Self::PiIae => "pi-iae",
            Self::Ah => "ah",
            Self::Adrc => "adrc",
            Self::Amigo => "amigo",
            Self::Simc => "simc",
        }
    }

    /// What it is called in texts and tables.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Momi => "MOMI",
            Self::Drmo => "DRMO",
            Self::DeMomi => "DE-MOMI",
            Self::PiMs => "PI, max Ki",
            Self::Dob => "PI + DOB",
            Self::PiIae => "PI, min IAE",
            Self::Ah => "AH kappa-tau",
            Self::Adrc => "ADRC",
            Self::Amigo => "AMIGO",
            Self::Simc => "SIMC",
        }
    }

    /// The options of a request that it looks at, by their names in files.
    #[must_use]
    pub const fn options(self) -> &'static [&'static str] {
        match self {
            Self::Momi | Self::Drmo => &["tf", "kpidn"],
            Self::DeMomi => &["tf", "kpidn", "tfd", "kden", "ms_max"],
            Self::PiMs => &["ms"],
            Self::Dob => &["ms", "ms_max", "alpha", "noise_ratio", "want"],
            Self::PiIae => &[],
            Self::Ah => &["tf", "kpidn", "ms"],
            Self::Adrc => &["ms", "b0"],
            Self::Amigo => &["tf", "kpidn"],
            Self::Simc => &["tf", "kpidn", "tau_c"],
        }
    }

    /// The methods that look at an option, by its name in files, separated by commas.
    ///
    /// ```
    /// use controller_design::design::Method;
    /// assert_eq!(Method::that_look_at("ms_max"), "de-momi, dob");
    /// ```
    #[must_use]
    pub fn that_look_at(option: &str) -> String {
        let of = Self::ALL.into_iter().filter(|method| method.options().contains(&option));
        of.map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// Whether it puts a disturbance estimator or observer beside the PID.
    #[must_use]
    pub const fn has_block(self) -> bool {
        matches!(self, Self::DeMomi | Self::Dob)
    }

    /// What it gives, in a few words.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Momi => "PID, magnitude optimum by areas: for set-points",
            Self::Drmo => "PID, disturbance-rejection magnitude optimum: for loads",
            Self::DeMomi => "MOMI with a disturbance estimator",
            Self::PiMs => "PI of the largest ki within a maximum sensitivity",
            Self::Dob => "that PI with a disturbance observer",
            Self::PiIae => "PI of the least IAE after a load step",
            Self::Ah => "PID by Åström and Hägglund's kappa-tau rules",
            Self::Adrc => "active disturbance rejection control, second order",
            Self::Amigo => "PID by AMIGO",
            Self::Simc => "PID by SIMC",
        }
    }

    /// Where the rule was published.
    #[must_use]
    pub const fn source(self) -> &'static str {
        match self {
            Self::Momi => "Vrančić & Huba 2021, eq. (6)",
            Self::Drmo => "Vrančić & Huba 2021, eqs (8)-(10), beta corrected",
            Self::DeMomi => "Vrančić & Huba 2021, eqs (13)-(19)",
            Self::PiMs => "Tena et al. 2022, section 4.2",
            Self::Dob => "Tena et al. 2022, sections 3 and 6",
            Self::PiIae => "Airikka 2021, by optimisation",
            Self::Ah => "Åström & Hägglund 1995, kappa-tau rules",
            Self::Adrc => "Vrančić & Huba 2021, table 7",
            Self::Amigo => "Åström & Hägglund 2004",
            Self::Simc => "Skogestad 2003",
        }
    }

    /// One sentence on when to take it.
    #[must_use]
    pub const fn when(self) -> &'static str {
        match self {
            Self::Momi => {
                "set-point changes matter most: fast and without overshoot; loads are rejected slowly when lags dominate"
            }
            Self::Drmo => {
                "loads matter most and no model shall run in the controller; set-point steps want b below 1"
            }
            Self::DeMomi => {
                "loads and set-point both matter and a second-order model of the plant can be trusted"
            }
            Self::PiMs => "a plain PI with a guaranteed distance from instability is wanted",
            Self::Dob => {
                "a PI is there or wanted, loads must vanish without a lasting integral, and the model is good"
            }
            Self::PiIae => {
                "step loads at the input matter most, the plant is well known and does not change: the robustness is low"
            }
            Self::Ah => "a classic to compare with; oscillates on some plants",
            Self::Adrc => {
                "the plant's order is known to be two and little else; noise is low and sampling fast"
            }
            Self::Amigo => "a first-order model is all there is and robustness (Ms about 1.4) comes first",
            Self::Simc => {
                "a first- or second-order model is all there is and one number shall trade speed for robustness"
            }
        }
    }
}
