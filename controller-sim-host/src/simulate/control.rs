//! Following a run from outside, and stopping it.

use super::run::Sample;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How far runs have come, and whether they shall stop; shared between threads.
#[derive(Debug, Default)]
pub struct Control {
    done: AtomicU64,
    stop: AtomicBool,
}

impl Control {
    /// A control that can stand in a `static`.
    #[must_use]
    pub const fn new() -> Self {
        Self { done: AtomicU64::new(0), stop: AtomicBool::new(false) }
    }

    /// Samples that were simulated so far, of all controllers.
    #[must_use]
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Lets every run end with [`RunError::Stopped`](super::RunError::Stopped) soon.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether runs shall stop.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    pub(super) fn add(&self, samples: u64) {
        self.done.fetch_add(samples, Ordering::Relaxed);
    }
}

/// Takes every sample of a run as it is made, so that a long run needs no memory.
pub trait Sink {
    /// The samples of this controller follow.
    fn begin(&mut self, index: usize, name: &str) -> ControlFlow<()>;

    /// One sample. To break off ends the run with [`RunError::Stopped`](super::RunError::Stopped); a sink keeps its
    /// own error.
    fn sample(&mut self, sample: &Sample) -> ControlFlow<()>;
}
