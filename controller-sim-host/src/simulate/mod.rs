//! The sampled loop: the controller's own code against an exactly simulated plant.

mod closed_loop;
mod law;
mod metrics;
mod noise;
mod run;

pub use closed_loop::{ClosedLoop, SubStep};
pub use law::AnyLaw;
pub use metrics::Metrics;
pub use noise::Gaussian;
pub use run::{
    ControllerResult, EventKind, Precision, RunError, RunOptions, RunResult, Sample, Stretch, run,
};
