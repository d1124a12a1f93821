//! The same bits everywhere: loops that go through everything a loop can meet, and one number for all of their bits.
//!
//! Each loop runs through saturation, rate limits, every mode, bad and lost samples, swaps of its law, saving and
//! restoring, against a small recursive plant. Every bit of every output goes into a hash: equal hashes from two builds
//! mean equal bits. The host and the images call this very code; nothing here asks the platform for a mathematical
//! function, nothing allocates.

mod chance;
mod hash;
mod laws;
mod run;

use controller_core::plant_model::PlantModel;
use controller_core::{
    AnyCompensator, Compensate, Compensator, CompensatorConfig, Controller, NoCompensator, Real,
};
use core::fmt;
use hash::Hash;
use laws::{config, estimator, fifth_order, observer, period, third_order};
pub use run::Met;
use run::{Traced, trace};

/// Delay memory \[samples\].
const CAPACITY: usize = 40;

/// Whether the loops in double precision are there: without a unit for it they fill the flash of a small board.
const DOUBLE: bool = cfg!(not(small_flash));

/// The number types to run the loops in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Types {
    /// Single precision.
    F32,
    /// Double precision.
    F64,
    /// Single, then double precision.
    Both,
}

impl Types {
    /// By its name on a command line: `f32`, `f64` or `both`; `None` where a type is left out.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "f32" => Some(Self::F32),
            "f64" if DOUBLE => Some(Self::F64),
            "both" if DOUBLE => Some(Self::Both),
            _ => None,
        }
    }
}

/// What is asked of a run: `trace [SAMPLES [f32|f64|both]]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// Samples of each loop.
    pub samples: u32,
    /// The number types.
    pub types: Types,
}

impl Default for Request {
    fn default() -> Self {
        Self { samples: 10_000, types: if DOUBLE { Types::Both } else { Types::F32 } }
    }
}

impl Request {
    /// From the words of a command line; `None` if they cannot be understood.
    pub fn from_words<'a>(words: impl IntoIterator<Item = &'a str>) -> Option<Self> {
        let mut words = words.into_iter();
        let mut request = Self::default();
        if let Some(samples) = words.next() {
            request.samples = samples.parse().ok()?;
        }
        if let Some(types) = words.next() {
            request.types = Types::named(types)?;
        }
        words.next().is_none().then_some(request)
    }
}

/// The hash of one loop, or of all loops; prints as one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// The loop, or `all`.
    pub name: &'static str,
    /// Samples of each loop.
    pub samples: u32,
    /// Bits of a number; `None` where both types are in it.
    pub bits: Option<usize>,
    /// Over the bits of everything the loop gave.
    pub hash: u64,
    /// What the loop went through; nothing in the line over all.
    pub met: Option<Met>,
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, samples, bits, hash, .. } = self;
        match bits {
            Some(bits) => write!(f, "{name} f{bits} {samples} {hash:016x}"),
            None => write!(f, "{name} {samples} {hash:016x}"),
        }
    }
}

/// Runs what is asked for: a line for each loop and number type, at the end one over all of them.
pub fn run(request: Request, mut print: impl FnMut(Line)) {
    let mut all = Hash::default();
    let mut each = |line: Line| {
        all.word(line.hash as u32);
        all.word((line.hash >> 32) as u32);
        print(line);
    };
    if request.types != Types::F64 {
        loops::<f32>(request.samples, &mut each);
    }
    if DOUBLE && request.types != Types::F32 {
        loops::<f64>(request.samples, &mut each);
    }
    let (samples, hash) = (request.samples, all.value());
    print(Line { name: "all", samples, bits: None, hash, met: None });
}

/// All loops in one number type.
fn loops<T: Real>(samples: u32, print: &mut impl FnMut(Line)) {
    let bits = Some(32 * T::WORDS);
    let mut line = |name, Traced { hash, met }| print(Line { name, samples, bits, hash, met: Some(met) });
    line("pid", pid::<T>(samples));
    line("adrc", adrc::<T>(samples));
    line("pid-de", pid_de::<T>(samples));
    line("pid-de-first-order", pid_de_first_order::<T>(samples));
    line("pi-dob-order-1", pi_dob::<T>(samples));
    line("dob-order-3-pair-zeros", dob_third_order::<T>(samples));
    line("any-order-5-integrating", any::<T>(samples));
}

// One function for each loop, and for each step of building a law: building takes most of the stack of a small target,
// which then has to hold one of them at a time.

#[inline(never)]
fn pid<T: Real>(samples: u32) -> Traced {
    trace(samples, (), |i| around::<T, _>(i, NoCompensator))
}

#[inline(never)]
fn adrc<T: Real>(samples: u32) -> Traced {
    trace(samples, (), |i| {
        Controller::<T, _, _>::with_adrc(&laws::around_adrc(i), &laws::adrc(i), period(i)).ok()
    })
}

#[inline(never)]
fn pid_de<T: Real>(samples: u32) -> Traced {
    trace(samples, Default::default(), |i| around(i, compensator::<T, 2, 1>(i, &estimator(i, 0.2))?))
}

#[inline(never)]
fn pid_de_first_order<T: Real>(samples: u32) -> Traced {
    trace(samples, Default::default(), |i| around(i, compensator::<T, 1, 2>(i, &estimator(i, 0.0))?))
}

#[inline(never)]
fn pi_dob<T: Real>(samples: u32) -> Traced {
    let model = || PlantModel::first_order(1.0, 1.2, 0.0);
    trace(samples, Default::default(), |i| around(i, compensator::<T, 1, 0>(i, &observer(i, model(), None))?))
}

#[inline(never)]
fn dob_third_order<T: Real>(samples: u32) -> Traced {
    let config = |i| observer(i, third_order(), None);
    trace(samples, Default::default(), |i| around(i, compensator::<T, 3, 0>(i, &config(i))?))
}

#[inline(never)]
fn any<T: Real>(samples: u32) -> Traced {
    let blank = any_compensator::<T>(0).and_then(|law| law.state([T::ZERO; CAPACITY]).ok());
    trace(samples, blank.expect("the delay fits"), |i| around(i, any_compensator::<T>(i)?))
}

#[inline(never)]
fn any_compensator<T: Real>(i: usize) -> Option<AnyCompensator<T, [T; CAPACITY]>> {
    AnyCompensator::new(&observer(i, fifth_order(), Some(7)), period(i), CAPACITY).ok()
}

#[inline(never)]
fn compensator<T: Real, const N: usize, const E: usize>(
    i: usize,
    config: &CompensatorConfig,
) -> Option<Compensator<T, N, E, CAPACITY>> {
    Compensator::new(config, period(i)).ok()
}

#[inline(never)]
fn around<T: Real, C: Compensate<T>>(i: usize, compensator: C) -> Option<Controller<T, C>> {
    Controller::with_compensator(&config(i), compensator, period(i)).ok()
}
