//! A controller over fixed memory, whichever kind it is.

use crate::parameters::{Kind, Parameters};
use controller_core::{
    Adrc, AdrcConfig, AdrcState, AnyCompensator, AnyCompensatorState, CompensatorConfig, ConfigError,
    ConfigErrors, Controller, ControllerConfig, ControllerInput, ControllerOutput, ControllerState,
    NoCompensator, Param, PidConfig, Real, Reason, SnapshotError,
};

/// Delay memory of up to `N` samples, of which `length` are in use: a law runs over as many as the host gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cells<T, const N: usize> {
    cells: [T; N],
    length: usize,
}

impl<T: Real, const N: usize> Cells<T, N> {
    /// `length` zeros, at most `N`.
    #[must_use]
    pub fn new(length: usize) -> Self {
        Self { cells: [T::ZERO; N], length: length.min(N) }
    }
}

impl<T, const N: usize> AsRef<[T]> for Cells<T, N> {
    fn as_ref(&self) -> &[T] {
        self.cells.get(..self.length).unwrap_or(&self.cells)
    }
}

impl<T, const N: usize> AsMut<[T]> for Cells<T, N> {
    fn as_mut(&mut self) -> &mut [T] {
        self.cells.get_mut(..self.length).unwrap_or_default()
    }
}

type Compensated<T, const N: usize> = AnyCompensator<T, Cells<T, N>>;
type CompensatedState<T, const N: usize> = AnyCompensatorState<T, Cells<T, N>>;

/// Why there is no law.
#[derive(Debug, Clone, PartialEq)]
pub enum Refused {
    /// The configuration has so many faults, of which this is the first. The whole list is large, and stack is scarce.
    Faults(usize, ConfigError),
    /// It asks for more than `N` samples of delay memory.
    Memory,
    /// The new law cannot take over the state of the old one.
    Mismatch,
}

impl From<ConfigErrors> for Refused {
    fn from(faults: ConfigErrors) -> Self {
        let none =
            ConfigError { param: Param::Ts, reason: Reason::OutOfRange, value: 0.0, min: 0.0, max: 0.0 };
        Self::Faults(faults.len(), faults.first().copied().unwrap_or(none))
    }
}

/// Law and state of one controller, with delay memory of up to `N` samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Law<T, const N: usize> {
    /// A PID.
    Pid {
        /// Its law.
        law: Controller<T, NoCompensator>,
        /// Its state.
        state: ControllerState<T, ()>,
    },
    /// A PID with a compensator.
    Compensated {
        /// Its law.
        law: Controller<T, Compensated<T, N>>,
        /// Its state.
        state: ControllerState<T, CompensatedState<T, N>>,
    },
    /// An ADRC.
    Adrc {
        /// Its law.
        law: Controller<T, NoCompensator, Adrc<T>>,
        /// Its state.
        state: ControllerState<T, (), AdrcState<T>>,
    },
}

/// The same words for every kind.
macro_rules! each {
    ($self:expr, $law:ident, $state:ident => $body:expr) => {
        match $self {
            Law::Pid { law: $law, state: $state } => $body,
            Law::Compensated { law: $law, state: $state } => $body,
            Law::Adrc { law: $law, state: $state } => $body,
        }
    };
}

impl<T: Real, const N: usize> Law<T, N> {
    /// Builds the law, every number rounded to `T` first, and a zeroed state.
    ///
    /// # Errors
    /// Faults of the configuration; more delay memory than there is.
    #[inline(never)]
    pub fn new(parameters: &Parameters) -> Result<Self, Refused> {
        let ts = T::from_f64(parameters.ts).to_f64();
        let config = parameters.config.rounded::<T>();
        match &parameters.kind {
            Kind::Pid => Self::pid(&config, ts),
            Kind::Adrc(adrc) => Self::adrc(&config, adrc, ts),
            Kind::Compensated(compensator) => {
                let capacity = usize::try_from(parameters.capacity).unwrap_or(usize::MAX);
                Self::compensated(&config, &compensator.rounded::<T>(), ts, capacity)
            }
        }
    }

    // One function for each kind: building takes most of the stack of a small target, which then has to hold one at a time.

    #[inline(never)]
    fn pid(config: &ControllerConfig, ts: f64) -> Result<Self, Refused> {
        let law = Controller::new(config, ts)?;
        Ok(Self::Pid { law, state: law.zeroed() })
    }

    #[inline(never)]
    fn adrc(config: &ControllerConfig, adrc: &AdrcConfig, ts: f64) -> Result<Self, Refused> {
        let law = Controller::with_adrc(config, &adrc.rounded::<T>(), ts)?;
        Ok(Self::Adrc { law, state: law.zeroed() })
    }

    #[inline(never)]
    fn compensated(
        config: &ControllerConfig,
        compensator: &CompensatorConfig,
        ts: f64,
        capacity: usize,
    ) -> Result<Self, Refused> {
        if capacity > N {
            return Err(Refused::Memory);
        }
        let built = Self::compensator(compensator, &config.pid, ts, capacity)?;
        let state = Self::blank(&built, capacity)?;
        let law = Self::around(config, built, ts)?;
        Ok(Self::Compensated { law, state })
    }

    #[inline(never)]
    fn compensator(
        config: &CompensatorConfig,
        pid: &PidConfig,
        ts: f64,
        capacity: usize,
    ) -> Result<Compensated<T, N>, Refused> {
        config.check_sign(pid)?;
        Ok(Compensated::<T, N>::new(config, ts, capacity)?)
    }

    #[inline(never)]
    fn blank(
        law: &Compensated<T, N>,
        capacity: usize,
    ) -> Result<ControllerState<T, CompensatedState<T, N>>, Refused> {
        Ok(ControllerState::over(law.state(Cells::new(capacity))?))
    }

    #[inline(never)]
    fn around(
        config: &ControllerConfig,
        compensator: Compensated<T, N>,
        ts: f64,
    ) -> Result<Controller<T, Compensated<T, N>>, Refused> {
        Ok(Controller::with_compensator(config, compensator, ts)?)
    }

    /// As [`Controller::settle`].
    pub fn settle(&mut self, r0: T, y0: T, u0: T) {
        each!(self, law, state => law.settle(state, r0, y0, u0));
    }

    /// As [`Controller::step`].
    pub fn step(&mut self, input: &ControllerInput<T>) -> ControllerOutput<T> {
        each!(self, law, state => law.step(state, input))
    }

    /// As [`Controller::advance`].
    pub fn advance(&mut self, n: u32) {
        each!(self, law, state => law.advance(state, n));
    }

    /// As [`Controller::adopt`], with a law built here; the old one stays when it cannot be built.
    ///
    /// # Errors
    /// As [`new`](Self::new); another kind, or longer than the memory of the state.
    #[inline(never)]
    pub fn adopt(&mut self, parameters: &Parameters) -> Result<(), Refused> {
        match (self, Self::new(parameters)?) {
            (Self::Pid { law, state }, Self::Pid { law: new, .. }) => {
                new.adopt(law, state);
                *law = new;
            }
            (Self::Compensated { law, state }, Self::Compensated { law: new, .. }) => {
                if !new.compensator().fits(state.compensator()) {
                    return Err(Refused::Mismatch);
                }
                new.adopt(law, state);
                *law = new;
            }
            (Self::Adrc { law, state }, Self::Adrc { law: new, .. }) => {
                new.adopt(law, state);
                *law = new;
            }
            _ => return Err(Refused::Mismatch),
        }
        Ok(())
    }

    /// As [`Controller::save`].
    ///
    /// # Errors
    /// A buffer that is too short.
    pub fn save(&self, words: &mut [u32]) -> Result<usize, SnapshotError> {
        each!(self, law, state => law.save(state, words))
    }

    /// As [`Controller::restore`].
    ///
    /// # Errors
    /// Words that are no state of this controller.
    pub fn restore(&mut self, words: &[u32]) -> Result<(), SnapshotError> {
        each!(self, law, state => law.restore(state, words))
    }
}
