//! The sampled loop: the controller's own code against an exactly simulated plant.

mod actuator;
mod closed_loop;
mod control;
mod curve;
mod delay;
mod law;
mod metrics;
mod noise;
mod nonlinear_loop;
mod plant_side;
mod record;
mod remarks;
mod run;
mod secondary;
mod sensor;
mod shadowed;
mod single;
mod stretches;

pub use closed_loop::{ClosedLoop, SubStep};
pub use control::{Control, Sink};
pub use law::AnyLaw;
pub use metrics::Metrics;
pub use noise::Gaussian;
pub use record::{Band, COLUMNS, Envelope, Record, View};
pub use remarks::Remark;
pub use run::{
    ControllerResult, InnerSample, Precision, RunError, RunOptions, RunResult, Sample, run, run_controller,
    run_with,
};
pub use stretches::{EventKind, Stretch, sample_of, windows};
