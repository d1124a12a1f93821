//! A designed loop as a file for the target.
//!
//! What is exported has passed every check of the law that will run: it is built here, in the number type of the target,
//! before a line of it is written.

pub mod block;
mod c_header;
mod function_block;
mod head;
mod open_range;
mod rust;
pub mod st;
mod st_test;

use crate::scenario::{ControllerSpec, Scenario};
use crate::simulate::{AnyLaw, Precision};
use block::Block;
use controller_core::{AnyCompensator, CompensatorConfig, ConfigErrors};
pub use open_range::OpenRange;

/// In what the loop is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// A Rust module of constants for `controller-core`.
    Rust,
    /// A function block in Structured Text of IEC 61131-3.
    StructuredText,
    /// A program in Structured Text that replays a trace through that block.
    StructuredTextTest,
    /// A header of constants for the C interface.
    C,
}

impl Format {
    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::StructuredText => "st",
            Self::StructuredTextTest => "st-test",
            Self::C => "c",
        }
    }
}

/// What the target's file is made of.
#[derive(Debug, Clone, Copy)]
pub struct Export<'a> {
    scenario: &'a Scenario,
    spec: &'a ControllerSpec,
    precision: Precision,
    capacity: usize,
}

/// Why a loop cannot be exported.
#[derive(Debug, Clone, PartialEq)]
pub enum Refused {
    /// Two loops, one inside the other: each is a file of its own.
    Cascade,
    /// A loop with an ADRC: this format has none.
    Adrc,
    /// The target's number type cannot hold the law, or the delay memory is too small.
    Faults(Box<ConfigErrors>),
}

impl<'a> Export<'a> {
    /// The loop of `spec`, which is of `scenario`, in the target's number type; `capacity` samples of delay memory, as
    /// many as it needs if `None`.
    ///
    /// # Errors
    /// When the loop is a cascade; every fault of the law.
    pub fn new(
        scenario: &'a Scenario,
        spec: &'a ControllerSpec,
        precision: Precision,
        capacity: Option<usize>,
    ) -> Result<Self, Refused> {
        if spec.secondary.is_some() {
            return Err(Refused::Cascade);
        }
        let (ts, latency) = (scenario.ts, scenario.latency);
        let needed = spec
            .compensator_config(latency)
            .map_or(0, |config| AnyCompensator::<f64, Vec<f64>>::needed_capacity(&config, ts).max(2));
        let capacity = capacity.unwrap_or(needed);
        let built = match precision {
            Precision::F32 => AnyLaw::<f32>::new(spec, ts, latency, capacity).err(),
            Precision::F64 => AnyLaw::<f64>::new(spec, ts, latency, capacity).err(),
        };
        match built {
            Some(faults) => Err(Refused::Faults(Box::new(faults))),
            None => Ok(Self { scenario, spec, precision, capacity }),
        }
    }

    /// The file; `origin` is the file it comes from, for its head.
    ///
    /// # Errors
    /// A loop that `format` has no words for.
    pub fn text(&self, format: Format, origin: &str) -> Result<String, Refused> {
        if self.spec.adrc.is_some() && format != Format::Rust {
            return Err(Refused::Adrc);
        }
        Ok(match format {
            Format::Rust => rust::text(self, origin),
            Format::StructuredText => st::function_block(&self.block(origin)?, self.precision),
            Format::StructuredTextTest => st_test::text(self, origin),
            Format::C => c_header::text(self, origin),
        })
    }

    /// The loop as a function block, before it is printed in a language; `origin` as in [`text`](Self::text).
    ///
    /// # Errors
    /// A loop with an ADRC.
    pub fn block(&self, origin: &str) -> Result<Block, Refused> {
        let head = |tunable, design| head::lines(self, origin, tunable, design);
        function_block::block(self, &head::name(self), head).ok_or(Refused::Adrc)
    }

    /// The controller's name.
    #[must_use]
    pub fn name(&self) -> &str {
        self.spec.name.trim()
    }

    /// The target's number type.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// Sampling period \[s\].
    #[must_use]
    pub fn ts(&self) -> f64 {
        self.scenario.ts
    }

    /// Samples of delay memory; 0 without a compensator.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// The ranges that nobody has given.
    #[must_use]
    pub fn open_ranges(&self) -> Vec<OpenRange> {
        OpenRange::of(&self.spec.config)
    }

    fn compensator(&self) -> Option<CompensatorConfig> {
        self.spec.compensator_config(self.scenario.latency)
    }
}
