//! The usual sample: nothing has happened since the last one.

use super::io::ControllerInput;
use super::law::Controller;
use super::state::ControllerState;
use super::step::Checked;
use crate::compensator::{Compensate, CompensatorOutput};
use crate::real::Real;
use crate::regulator::Regulator;
use crate::status::Status;

/// [`ControllerState::flags`] of a loop that has started and lost nothing, without the compensator's.
const FLAGS_OF_A_LOOP_AT_WORK: u32 = 0x0101_0000;

impl<T: Real, C: Compensate<T>, L: Regulator<T>> Controller<T, C, L> {
    /// Whether this sample is like the last one: the loop is closed, in the same mode, with or without the compensator as
    /// before, the measurement is good and nothing is to be caught up with. Most samples are.
    #[inline(always)]
    pub(super) fn goes_on(
        &self,
        state: &ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> bool {
        self.guard.goes_on(&state.guard, input.y, input.quality)
            && state.mode.is(input.mode)
            && input.mode.is_automatic()
            && state.flags() == FLAGS_OF_A_LOOP_AT_WORK | u32::from(input.compensate)
    }

    /// What [`step_any`](Self::step_any) does in a sample that [goes on](Self::goes_on), without its questions.
    #[inline(always)]
    pub(super) fn go_on(
        &self,
        state: &mut ControllerState<T, C::State, L::State>,
        input: &ControllerInput<T>,
    ) -> (CompensatorOutput<T>, Status) {
        let offset = state.offset;
        let taken = self.take_setpoint_and_offset(state, input);
        let (applied, replaced) = self.applied(state.u.value(), input.u_applied);
        state.y = input.y;
        let estimate = self.compensator.sample(&mut state.compensator, input.y, applied);
        let u_f = if input.compensate { estimate.u_f } else { T::ZERO };
        state.u_f = u_f;
        self.setpoint.ramp(&mut state.r, state.r_asked);
        let mode = input.mode;
        let sample = Checked { y: input.y, u_f, applied, own: applied - offset, was: mode, mode };
        let inhibited = self.automatic(state, input, &sample, None);
        let limited = self.limit.apply(&mut state.u, state.v);
        state.alarms = self.alarms.check(state.alarms, state.r.value(), input.y);
        let compensating = Status::COMPENSATING.when(C::PRESENT && input.compensate);
        (estimate, taken | replaced | inhibited | compensating | self.last_bits(state, limited))
    }
}

#[cfg(test)]
#[allow(
    clippy::cast_possible_truncation,
    clippy::indexing_slicing,
    clippy::modulo_arithmetic,
    clippy::unwrap_used
)]
mod tests {
    use super::super::config::ControllerConfig;
    use super::*;
    use crate::adrc::{Adrc, AdrcConfig};
    use crate::compensator::{Estimator, EstimatorConfig, NoCompensator};
    use crate::limit::LimitConfig;
    use crate::mode::Mode;
    use crate::pid::{Pid, PidConfig};
    use crate::sample::Quality;
    use crate::setpoint::SetpointConfig;

    /// An integer generator (Knuth's 64-bit congruence); its high bits are used.
    struct Chance(u64);

    impl Chance {
        fn below(&mut self, n: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 40) % n
        }
        fn one_in(&mut self, n: u64) -> bool {
            self.below(n) == 0
        }
        fn pick<X: Copy>(&mut self, list: &[X]) -> X {
            list[self.below(list.len() as u64) as usize]
        }
    }

    /// Mostly what a loop at work gets, sometimes something else.
    fn input<T: Real>(chance: &mut Chance, before: &ControllerInput<T>, y: f64) -> ControllerInput<T> {
        const ODD: [f64; 5] = [f64::NAN, f64::INFINITY, 1e30, -1e30, -0.0];
        let mut next = ControllerInput { y: T::from_f64(y), u_applied: None, ..*before };
        if chance.one_in(20) {
            next.r = T::from_f64(chance.pick(&[0.0, -0.0, 0.5, 1.0, 2.0, 3.0, f64::NAN]));
            next.r_remote = T::from_f64(chance.pick(&[0.25, 2.0, f64::NAN]));
            next.offset = T::from_f64(chance.pick(&[0.0, 0.1, -0.1, 9.0, f64::NAN]));
            next.inhibit_up = chance.one_in(2);
            next.inhibit_down = chance.one_in(3);
        }
        if chance.one_in(30) {
            next.mode = chance.pick(&[Mode::Auto, Mode::Auto, Mode::Cascade, Mode::Manual, Mode::Off]);
            next.compensate = !chance.one_in(3);
        }
        if chance.one_in(3) {
            next.u_applied = Some(T::from_f64(chance.pick(&[0.3, -0.3, 5.0, f64::NAN])));
        }
        if chance.one_in(25) {
            next.y = T::from_f64(chance.pick(&ODD));
        }
        next.quality = if chance.one_in(40) { Quality::Uncertain } else { Quality::Good };
        next
    }

    /// Steps two states, one as it comes and one with all questions; they must never differ.
    fn both_ways<T: Real, C: Compensate<T>, L: Regulator<T>>(
        law: &Controller<T, C, L>,
        state: ControllerState<T, C::State, L::State>,
    ) {
        let mut chance = Chance(7);
        let mut next = ControllerInput::default();
        let (mut one, mut other) = (state.clone(), state);
        let (mut y, mut usual) = (0.0, 0);
        for k in 0..20_000 {
            next = input(&mut chance, &next, y);
            usual += u32::from(law.goes_on(&one, &next));
            let given = law.step(&mut one, &next);
            let (estimate, status) = law.step_any(&mut other, &next);
            assert_eq!(given, law.output(&other, estimate, status), "sample {k}: {next:?}");
            // All bits: `==` takes zeros of both signs for one.
            let [mut ours, mut theirs] = [[0; 400]; 2];
            let (n, m) = (law.save(&one, &mut ours).unwrap(), law.save(&other, &mut theirs).unwrap());
            assert!(n == m && ours == theirs, "sample {k}: {next:?}");
            y += 0.1 * (given.u.to_f64() - y);
            if chance.one_in(200) {
                law.advance(&mut one, 1);
                law.advance(&mut other, 1);
            }
        }
        assert!((5_000..19_000).contains(&usual), "{usual} usual samples");
    }

    fn in_number_type<T: Real>() {
        let pid = PidConfig { kp: 2.0, ki: 1.5, kd: 0.4, tf: 0.1, b: 1.0, c: 1.0, ..PidConfig::default() };
        let config = ControllerConfig {
            pid,
            limits: LimitConfig { lo: -1.0, hi: 1.5, rate_up: Some(40.0), rate_down: None },
            setpoint: SetpointConfig { lo: 0.0, hi: 2.0, rate_up: None, rate_down: Some(5.0), track: false },
            offset_lo: -1.0,
            offset_hi: 1.0,
            ..ControllerConfig::default()
        };
        let estimator = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
        let estimator = Estimator::<T, 32>::estimator(&estimator, 0.0, 0.01).unwrap();
        let law: Controller<T, _, Pid<T>> = Controller::with_compensator(&config, estimator, 0.01).unwrap();
        both_ways(&law, law.zeroed());
        let law = Controller::<T>::new(&config, 0.01).unwrap();
        both_ways(&law, law.zeroed());
        let config = ControllerConfig { pid: PidConfig::default(), ..config };
        let law: Controller<T, NoCompensator, Adrc<T>> =
            Controller::with_adrc(&config, &AdrcConfig::from_bandwidths(2.0, 3.0, 9.0), 0.01).unwrap();
        both_ways(&law, law.zeroed());
    }

    #[test]
    fn fewer_questions_give_the_same_bits() {
        in_number_type::<f32>();
        in_number_type::<f64>();
    }
}
