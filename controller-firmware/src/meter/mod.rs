//! The instruction meter: see [`clock`] for how it counts, [`report`] for what it prints.

mod blocks;
mod clock;
mod laws;
mod loops;
mod range;
mod report;
mod signals;

use blocks::{LINE, Limiting, LimitingState, TS, compensate};
use clock::Clock;
use controller_core::{
    Adrc, AdrcInput, AdrcState, Compensate, Compensator, CompensatorConfig, CompensatorInput, Estimator, Law,
    NoCompensator, Observer, Pid, PidInput, PidState, Real,
};
use laws::Bare;

/// The board this was built for.
fn board() -> &'static str {
    controller_firmware::BOARD
}

/// Measures everything; `None` when the timer does not count instructions or a block could not be built.
pub(crate) fn run<T: Real>(timer: cortex_m::peripheral::SYST) -> Option<()> {
    let clock = &Clock::start(timer)?;
    pids::<T>(clock)?;
    compensator::<T, 2, 1>(clock, "de-2", blocks::second_order)?;
    compensator::<T, 1, 2>(clock, "de-1", blocks::first_order)?;
    compensator::<T, 1, 0>(clock, "dob-1", blocks::observer)?;
    compensator::<T, 3, 0>(clock, "dob-3", blocks::third_order)?;
    adrc::<T>(clock)?;
    loops::measure(clock, "loop-pid", blocks::pid_loop::<T, _>, Some(NoCompensator))?;
    loops::measure(clock, "loop-pid-de", blocks::pid_loop::<T, _>, estimator())?;
    loops::measure(clock, "loop-pi-dob", blocks::pi_loop::<T, _>, observer())?;
    loops::measure(clock, "loop-adrc", blocks::adrc_loop::<T>, Some(NoCompensator))
}

#[inline(never)]
fn estimator<T: Real>() -> Option<Estimator<T, LINE>> {
    Estimator::new(&blocks::second_order(false), TS).ok()
}

#[inline(never)]
fn observer<T: Real>() -> Option<Observer<T, 1, LINE>> {
    Observer::new(&blocks::observer(false), TS).ok()
}

#[inline(never)]
fn pids<T: Real>(clock: &Clock) -> Option<()> {
    let pid = Bare {
        name: "pid",
        config: blocks::pid,
        new: |config| Pid::<T>::new(config, TS),
        rest: |_| PidState::default(),
        step: Pid::run,
        adopt: |law, state, old| law.adopt(old, state),
    };
    pid.measure(clock, |r, y, _| PidInput { r, y })?;
    let limiting = Bare {
        name: "pid-limit",
        config: |retuned| retuned,
        new: |retuned| Limiting::<T>::new(*retuned),
        rest: |_| LimitingState::new(),
        step: Limiting::run,
        adopt: |law, state, old| law.take_over(old, state),
    };
    limiting.measure(clock, |r, y, _| PidInput { r, y })
}

#[inline(never)]
fn compensator<T: Real, const N: usize, const E: usize>(
    clock: &Clock,
    name: &'static str,
    config: fn(bool) -> CompensatorConfig,
) -> Option<()> {
    let block = Bare {
        name,
        config,
        new: |config| Compensator::<T, N, E, LINE>::new(config, TS),
        rest: |law| law.settled(T::ZERO, T::ZERO),
        step: compensate,
        adopt: |law, state, old| {
            let _ = Compensate::adopt(law, old, state, T::ZERO, T::ZERO);
        },
    };
    block.measure(clock, |_, y, u_applied| CompensatorInput { y, u_applied })
}

#[inline(never)]
fn adrc<T: Real>(clock: &Clock) -> Option<()> {
    let block = Bare {
        name: "adrc",
        config: blocks::adrc,
        new: |config| Adrc::<T>::new(config, TS),
        rest: |_| AdrcState::default(),
        step: Adrc::run,
        adopt: |law, state, old| law.adopt(old, state),
    };
    block.measure(clock, |r, y, u| AdrcInput { r, y, u })
}
