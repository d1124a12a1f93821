//! A controller of a scenario as the law that is flashed, in either number type.

use crate::scenario::{CompensatorSpec, ControllerSpec};
use controller_core::{
    Adrc, AdrcCoefficients, AdrcState, AnyCompensator, AnyCompensatorState, CompensatorConfig, ConfigError,
    ConfigErrors, Controller, ControllerInput, ControllerNumbers, ControllerOutput, ControllerState, Mode,
    NoCompensator, Param, PidCoefficients, Real, Reason,
};

type Compensated<T> = AnyCompensator<T, Vec<T>>;

/// Law and state of one controller, running in `T`. The steps are those of `controller-core`, nothing is repeated here.
#[derive(Debug, Clone)]
pub struct AnyLaw<T: Real> {
    block: Block<T>,
    ts: f64,
    latency: f64,
    capacity: usize,
}

#[derive(Debug, Clone)]
enum Block<T: Real> {
    Plain {
        law: Controller<T, NoCompensator>,
        state: ControllerState<T, ()>,
    },
    Adrc {
        law: Controller<T, NoCompensator, Adrc<T>>,
        state: ControllerState<T, (), AdrcState<T>>,
    },
    Compensated {
        law: Box<Controller<T, Compensated<T>>>,
        state: Box<ControllerState<T, AnyCompensatorState<T, Vec<T>>>>,
    },
}

impl ControllerSpec {
    /// The compensator's configuration, if there is one; `latency` \[s\].
    #[must_use]
    pub fn compensator_config(&self, latency: f64) -> Option<CompensatorConfig> {
        match &self.compensator {
            CompensatorSpec::None => None,
            CompensatorSpec::Estimator(config) => Some(config.to_compensator(latency)),
            CompensatorSpec::Observer(config) => Some(config.to_compensator(latency)),
        }
    }

    /// Samples of delay memory that the compensator needs.
    #[must_use]
    pub fn needed_capacity(&self, ts: f64, latency: f64) -> usize {
        self.compensator_config(latency)
            // Two more than the exact need: the number type may round the delay up.
            .map_or(1, |config| Compensated::<f64>::needed_capacity(&config, ts).saturating_add(2))
    }
}

impl<T: Real> AnyLaw<T> {
    /// Builds the law of `spec` with delay memory of `capacity` samples and a zeroed state. Every number is rounded to
    /// `T` first, as a front end on the target would.
    ///
    /// # Errors
    /// Every fault of the configuration.
    pub fn new(spec: &ControllerSpec, ts: f64, latency: f64, capacity: usize) -> Result<Self, ConfigErrors> {
        let ts = T::from_f64(ts).to_f64();
        let config = spec.config.rounded::<T>();
        let block = match (&spec.adrc, spec.compensator_config(latency)) {
            (Some(adrc), _) => {
                let law = Controller::with_adrc(&config, &adrc.rounded::<T>(), ts)?;
                Block::Adrc { law, state: law.zeroed() }
            }
            (None, None) => {
                let law = Controller::new(&config, ts)?;
                Block::Plain { law, state: law.zeroed() }
            }
            (None, Some(compensator)) => {
                let compensator = compensator.rounded::<T>();
                // Both parts are built before either fails, so that all faults show at once.
                let built = Compensated::new(&compensator, ts, capacity);
                let plain = Controller::<T, _>::new(&config, ts).err();
                let built = match (built, plain) {
                    (Ok(built), None) => built,
                    (Err(faults), None) | (Ok(_), Some(faults)) => return Err(faults),
                    (Err(first), Some(second)) => return Err(second.and(&first)),
                };
                compensator.check_sign(&config.pid)?;
                let state = ControllerState::over(built.state(vec![T::ZERO; capacity])?);
                let law = Controller::with_compensator(&config, built, ts)?;
                Block::Compensated { law: Box::new(law), state: Box::new(state) }
            }
        };
        Ok(Self { block, ts, latency, capacity })
    }

    /// At rest at the set-point `r0`, the measurement `y0` and the output `u0`, and in `mode` before the first sample, as
    /// far as it is one that starts from the output that is there.
    pub fn settle(&mut self, mode: Mode, r0: f64, y0: f64, u0: f64) {
        let [r0, y0, u0] = [r0, y0, u0].map(T::from_f64);
        match &mut self.block {
            Block::Plain { law, state } => law.settle(state, r0, y0, u0),
            Block::Adrc { law, state } => law.settle(state, r0, y0, u0),
            Block::Compensated { law, state } => law.settle(state, r0, y0, u0),
        }
        if let Some(input) = Self::sample_at_rest(mode, r0, y0) {
            let _ = self.step(&input);
        }
    }

    /// The sample before the first one. A settled state is in Auto: to change to these modes takes a sample of its own,
    /// which would swallow a set-point that steps with the first one, or follow it once more; at rest it moves nothing.
    pub(super) fn sample_at_rest(mode: Mode, r0: T, y0: T) -> Option<ControllerInput<T>> {
        let late = matches!(mode, Mode::Cascade | Mode::Hold);
        late.then(|| ControllerInput { r: r0, r_remote: r0, y: y0, mode, ..ControllerInput::default() })
    }

    /// One sample.
    pub fn step(&mut self, input: &ControllerInput<T>) -> ControllerOutput<T> {
        let mut output = ControllerOutput::default();
        self.step_into(input, &mut output);
        output
    }

    /// One sample, written where the last one was: an output has a dozen numbers.
    pub(super) fn step_into(&mut self, input: &ControllerInput<T>, output: &mut ControllerOutput<T>) {
        match &mut self.block {
            Block::Plain { law, state } => *output = law.step(state, input),
            Block::Adrc { law, state } => *output = law.step(state, input),
            Block::Compensated { law, state } => *output = law.step(state, input),
        }
    }

    /// `n` samples were lost.
    pub fn advance(&mut self, n: u32) {
        match &mut self.block {
            Block::Plain { law, state } => law.advance(state, n),
            Block::Adrc { law, state } => law.advance(state, n),
            Block::Compensated { law, state } => law.advance(state, n),
        }
    }

    /// The numbers of the loop, for an export.
    pub(crate) fn numbers(&self) -> ControllerNumbers<T> {
        match &self.block {
            Block::Plain { law, .. } => law.numbers(),
            Block::Adrc { law, .. } => law.numbers(),
            Block::Compensated { law, .. } => law.numbers(),
        }
    }

    /// The coefficients of the PID; `None` for an ADRC.
    pub(crate) fn pid(&self) -> Option<PidCoefficients<T>> {
        match &self.block {
            Block::Plain { law, .. } => Some(law.pid().coefficients()),
            Block::Adrc { .. } => None,
            Block::Compensated { law, .. } => Some(law.pid().coefficients()),
        }
    }

    /// The coefficients of the ADRC, if it is one.
    pub(crate) fn adrc(&self) -> Option<AdrcCoefficients<T>> {
        match &self.block {
            Block::Plain { .. } | Block::Compensated { .. } => None,
            Block::Adrc { law, .. } => Some(law.adrc().coefficients()),
        }
    }

    /// The compensator, if there is one.
    pub(crate) fn compensator(&self) -> Option<&Compensated<T>> {
        match &self.block {
            Block::Plain { .. } | Block::Adrc { .. } => None,
            Block::Compensated { law, .. } => Some(law.compensator()),
        }
    }

    /// The state as words, checksum last; empty if it has too many for a snapshot.
    pub(crate) fn save(&self) -> Vec<u32> {
        macro_rules! words {
            ($law:expr, $state:expr, $type:ty) => {{
                let mut words = vec![0; <$type>::snapshot_words($state)];
                let used = $law.save($state, &mut words).unwrap_or(0);
                words.truncate(used);
                words
            }};
        }
        match &self.block {
            Block::Plain { law, state } => words!(law, state, Controller<T, NoCompensator>),
            Block::Adrc { law, state } => words!(law, state, Controller<T, NoCompensator, Adrc<T>>),
            Block::Compensated { law, state } => words!(law, state, Controller<T, Compensated<T>>),
        }
    }

    /// Goes over to the parameters of `spec` without a bump.
    ///
    /// # Errors
    /// Every fault of the configuration; the old law then stays. A controller cannot gain or lose its compensator, nor
    /// change between PID and ADRC.
    pub fn adopt(&mut self, spec: &ControllerSpec) -> Result<(), ConfigErrors> {
        let new = Self::new(spec, self.ts, self.latency, self.capacity)?;
        match (&mut self.block, new.block) {
            (Block::Plain { law, state }, Block::Plain { law: new, .. }) => {
                new.adopt(law, state);
                *law = new;
            }
            (Block::Adrc { law, state }, Block::Adrc { law: new, .. }) => {
                new.adopt(law, state);
                *law = new;
            }
            (Block::Compensated { law, state }, Block::Compensated { law: new, .. }) => {
                new.adopt(law, state);
                *law = new;
            }
            // The state of one kind cannot become that of another.
            _ => {
                let kind = ConfigError {
                    param: Param::FilterOrder,
                    reason: Reason::Mismatch,
                    value: 0.0,
                    min: 0.0,
                    max: 0.0,
                };
                return Err(kind.into());
            }
        }
        Ok(())
    }
}
