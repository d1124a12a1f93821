//! Loops built from cases, with every kind of compensator, and random inputs for them.

use super::configs::{CAPACITY, Case};
use super::draw::Draw;
use controller_core::{
    AnyCompensator, Compensate, Compensator, CompensatorState, ConfigErrors, Controller, ControllerInput,
    ControllerState, Mode, NoCompensator, Quality, Real,
};

/// Bytes that one operation reads at most.
pub(crate) const OPERATION_BYTES: usize = 80;

/// What a check found; text, because a panic would be printed for every case that a shrinking run tries.
pub(crate) type Checked<V = ()> = Result<V, String>;

/// A compensator that can be built from a case.
pub(crate) trait Block<T: Real>: Compensate<T> + Clone {
    fn build(case: &Case) -> Result<Self, Box<ConfigErrors>>;
    /// A zeroed state; for shapes known at run time with all the memory there may be.
    fn blank(&self) -> Self::State;
}

impl<T: Real> Block<T> for NoCompensator {
    fn build(_: &Case) -> Result<Self, Box<ConfigErrors>> {
        Ok(Self)
    }
    fn blank(&self) {}
}

/// A compensator of any shape.
pub(crate) type AnyBlock<T> = AnyCompensator<T, Vec<T>>;

impl<T: Real> Block<T> for AnyBlock<T> {
    fn build(case: &Case) -> Result<Self, Box<ConfigErrors>> {
        Ok(Self::new(&case.block, case.ts, CAPACITY)?)
    }
    fn blank(&self) -> Self::State {
        self.state(vec![T::ZERO; CAPACITY]).expect("validated for this capacity")
    }
}

impl<T: Real, const N: usize, const E: usize> Block<T> for Compensator<T, N, E, CAPACITY> {
    fn build(case: &Case) -> Result<Self, Box<ConfigErrors>> {
        Ok(Self::new(&case.block, case.ts)?)
    }
    fn blank(&self) -> CompensatorState<T, N, E, CAPACITY> {
        CompensatorState::default()
    }
}

/// A loop and what it was built from.
#[derive(Clone)]
pub(crate) struct Built<T, C> {
    pub(crate) case: Case,
    pub(crate) law: Controller<T, C>,
}

impl<T: Real, C: Block<T>> Built<T, C> {
    /// Builds the loop of a case, unless it is refused.
    pub(crate) fn new(case: &Case) -> Result<Self, Box<ConfigErrors>> {
        let law = Controller::with_compensator(&case.config, C::build(case)?, case.ts)?;
        Ok(Self { case: case.clone(), law })
    }

    /// The range of the measurement as the loop sees it.
    pub(crate) fn measurement(&self) -> (T, T) {
        (T::from_f64(self.case.config.measurement_lo), T::from_f64(self.case.config.measurement_hi))
    }

    /// Any input.
    pub(crate) fn input(&self, draw: &mut Draw<'_>) -> ControllerInput<T> {
        let (y_lo, y_hi) = self.measurement();
        let (u_lo, u_hi) = self.law.output_range();
        let config = &self.case.config;
        let (r_lo, r_hi) = (T::from_f64(config.setpoint.lo), T::from_f64(config.setpoint.hi));
        let flags = draw.byte();
        let flag = |i: u8| flags >> i & 1 == 1;
        ControllerInput {
            y: draw.signal(y_lo, y_hi),
            quality: draw.pick(&[Quality::Good, Quality::Good, Quality::Uncertain, Quality::Bad]),
            mode: Mode::from_number((draw.byte() % 7 + 2) % 7).expect("a number of a mode"),
            r: draw.signal(r_lo, r_hi),
            u_applied: flag(0).then(|| draw.signal(u_lo, u_hi)),
            offset: draw.signal(T::from_f64(config.offset_lo), T::from_f64(config.offset_hi)),
            manual: flag(1).then(|| draw.signal(u_lo, u_hi)),
            track: draw.signal(u_lo, u_hi),
            r_remote: draw.signal(r_lo, r_hi),
            compensate: !flag(2),
            inhibit_up: flag(3),
            inhibit_down: flag(4),
            acknowledge: flag(5),
        }
    }
}

/// The words of a state.
pub(crate) fn saved<T: Real, C: Block<T>>(
    law: &Controller<T, C>,
    state: &ControllerState<T, C::State>,
) -> Vec<u32> {
    let mut words = vec![0; Controller::<T, C>::snapshot_words(state)];
    let used = law.save(state, &mut words).expect("room for all words");
    assert_eq!(used, words.len());
    words
}

/// Builds what can be built.
pub(crate) fn accepted<T: Real, C: Block<T>>(cases: &[Case]) -> Vec<Built<T, C>> {
    cases.iter().filter_map(|case| Built::new(case).ok()).collect()
}
