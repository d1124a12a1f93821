//! The runtime's own loop against an oracle's plant, sample by sample.

use crate::oracle::sampled_plant::SampledPlant;
use controller_core::{
    AnyCompensator, AnyCompensatorState, CompensatorConfig, ConfigErrors, Controller, ControllerConfig,
    ControllerInput, ControllerOutput, ControllerState, Real,
};

/// The compensator of a rig: any shape, memory on the heap.
pub type Block<T> = AnyCompensator<T, Vec<T>>;
/// The loop of a rig.
pub type Law<T> = Controller<T, Block<T>>;
/// Its state.
pub type State<T> = ControllerState<T, AnyCompensatorState<T, Vec<T>>>;

/// Delay memory of every rig \[samples\].
pub const CAPACITY: usize = 2048;

/// Builds the loop of a rig.
///
/// # Errors
/// Every fault of the configuration.
pub fn law<T: Real>(
    config: &ControllerConfig,
    compensator: &CompensatorConfig,
    ts: f64,
) -> Result<Law<T>, ConfigErrors> {
    Controller::with_compensator(config, Block::new(compensator, ts, CAPACITY)?, ts)
}

/// A loop and a plant, both at rest at 0.
#[derive(Clone)]
pub struct Rig<T: Real> {
    /// The loop.
    pub law: Law<T>,
    /// Its state.
    pub state: State<T>,
    /// The plant, held output, disturbance at its input.
    pub plant: SampledPlant,
    /// The inputs; `y` is filled in by the rig.
    pub input: ControllerInput<T>,
    /// Disturbance \[u\].
    pub d: f64,
}

impl<T: Real> Rig<T> {
    /// A rig at rest at 0.
    ///
    /// # Panics
    /// When the compensator's delay does not fit [`CAPACITY`].
    #[must_use]
    pub fn new(law: Law<T>, plant: SampledPlant) -> Self {
        let memory = vec![T::ZERO; CAPACITY];
        let compensator = law.compensator().state(memory).expect("the delay fits");
        let mut state = ControllerState::over(compensator);
        law.settle(&mut state, T::ZERO, T::ZERO, T::ZERO);
        Self { law, state, plant, input: ControllerInput::default(), d: 0.0 }
    }

    /// One sample: measurement, step, plant.
    pub fn step(&mut self) -> ControllerOutput<T> {
        self.input.y = T::from_f64(self.plant.output());
        let out = self.law.step(&mut self.state, &self.input);
        let _ = self.plant.step(out.u.to_f64(), self.d);
        out
    }

    /// The measurement that the next step will see \[y\].
    #[must_use]
    pub fn y(&self) -> f64 {
        self.plant.output()
    }
}
