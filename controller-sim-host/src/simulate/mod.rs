//! The sampled loop: the controller's own code against an exactly simulated plant.

mod closed_loop;
mod disturbance;
mod law;
mod metrics;
mod noise;
mod remarks;
mod run;
mod stretches;

pub use closed_loop::{ClosedLoop, SubStep};
pub use law::AnyLaw;
pub use metrics::Metrics;
pub use noise::Gaussian;
pub use remarks::Remark;
pub use run::{ControllerResult, Precision, RunError, RunOptions, RunResult, Sample, run};
pub use stretches::{EventKind, Stretch, sample_of};
