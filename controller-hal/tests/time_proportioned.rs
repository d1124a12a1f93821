//! A switch as a proportional output.

use controller_core::Param;
use controller_hal::{
    Actuate, ActuateError, OnInvalid, OutputConfig, TimeProportioned, TimeProportionedConfig,
};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as PinMock, State, Transaction as OnPin};
use proptest::prelude::*;

/// A pin that keeps what it was set to.
#[derive(Default)]
struct Pin {
    level: bool,
    changes: usize,
}

impl embedded_hal::digital::ErrorType for Pin {
    type Error = core::convert::Infallible;
}

impl embedded_hal::digital::OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Self::Error> {
        self.changes += usize::from(self.level);
        self.level = false;
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Self::Error> {
        self.changes += usize::from(!self.level);
        self.level = true;
        Ok(())
    }
}

fn config(window: u16, minimum_on: u16, minimum_off: u16) -> TimeProportionedConfig {
    let output = OutputConfig { lo: 0.0, hi: 1.0, invalid: OnInvalid::Keep };
    TimeProportionedConfig { output, window, minimum_on, minimum_off }
}

/// Lengths of the times on and off, without the first and the last, which are cut.
fn times(levels: &[bool], level: bool) -> Vec<usize> {
    let runs: Vec<&[bool]> = levels.chunk_by(|a, b| a == b).collect();
    let inner = runs.get(1..runs.len().saturating_sub(1)).unwrap_or_default();
    inner.iter().filter(|run| run[0] == level).map(|run| run.len()).collect()
}

proptest! {
    /// Over any number of windows the time on is what was due, up to half of the longer minimum time (or half a tick); no time
    /// on or off is shorter than allowed. The duty changes on the way.
    #[test]
    fn the_mean_is_exact_and_the_switch_is_spared(
        window in 2_u16..400,
        minima in (0.0_f64..1.0, 0.0_f64..1.0),
        duties in proptest::collection::vec((0.0_f64..=1.0, 1_usize..40), 1..8),
    ) {
        let room = f64::from(window);
        let on = (minima.0 * room * 0.5) as u16;
        let off = (minima.1 * room * 0.5) as u16;
        let mut switch = TimeProportioned::<_, f64>::new(Pin::default(), &config(window, on, off)).unwrap();
        let mut levels = Vec::new();
        let mut due = 0.0;
        let mut windows = 0.0;
        let allowed = f64::from(on.max(off).max(1)) * 0.5;
        for (duty, count) in duties {
            switch.apply(duty).unwrap();
            for _ in 0..count {
                for _ in 0..window {
                    levels.push(switch.tick().unwrap());
                }
                due += duty * f64::from(window);
                windows += 1.0;
                let done = levels.iter().filter(|&&level| level).count() as f64;
                // A duty is counted in 2^-16 ticks.
                prop_assert!((due - done).abs() <= allowed + windows * 2.0_f64.powi(-17) + 1e-9, "{due} {done}");
            }
        }
        prop_assert!(times(&levels, true).iter().all(|&n| n >= usize::from(on.max(1))));
        prop_assert!(times(&levels, false).iter().all(|&n| n >= usize::from(off.max(1))));
    }

    /// Every bit pattern as an output: it either counts with a finite mean in range or changes nothing.
    #[test]
    fn nothing_but_a_number_moves_the_duty(bits in any::<u32>()) {
        let mut switch = TimeProportioned::<_, f32>::new(Pin::default(), &config(16_384, 0, 0)).unwrap();
        switch.apply(0.25).unwrap();
        let u = f32::from_bits(bits);
        match switch.apply(u) {
            Ok(mean) => prop_assert!(u.is_finite() && (0.0..=1.0).contains(&mean)),
            Err(error) => {
                prop_assert!(!u.is_finite() && error == ActuateError::NotFinite);
                prop_assert_eq!(switch.applied(), Some(0.25));
                let on = (0..16_384).filter(|_| switch.tick().unwrap()).count();
                prop_assert_eq!(on, 4096);
            }
        }
    }
}

#[test]
fn the_ends_do_not_switch() {
    for (duty, level, changes) in [(0.0, false, 0), (-5.0, false, 0), (1.0, true, 1), (7.0, true, 1)] {
        let mut switch = TimeProportioned::<_, f32>::new(Pin::default(), &config(50, 10, 20)).unwrap();
        // Something is carried over when the end is reached.
        switch.apply(0.13).unwrap();
        for _ in 0..50 {
            switch.tick().unwrap();
        }
        switch.apply(duty).unwrap();
        let on = (0..5000).filter(|_| switch.tick().unwrap()).count();
        assert_eq!(on, if level { 5000 } else { 0 });
        let pin = switch.release();
        assert!(pin.changes <= 2 + changes, "{}", pin.changes);
    }
}

#[test]
fn the_longest_window_in_single_precision_loses_nothing() {
    let mut switch = TimeProportioned::<_, f32>::new(Pin::default(), &config(16_384, 8_192, 8_192)).unwrap();
    // A third, nearest in single precision, of which 2^-16 ticks take 30 bits: the number is exact.
    let duty = 1.0_f32 / 3.0;
    switch.apply(duty).unwrap();
    let windows = 3000_u32;
    let on = (0..16_384 * windows).filter(|_| switch.tick().unwrap()).count();
    let due = f64::from(duty) * 16_384.0 * f64::from(windows);
    assert!((on as f64 - due).abs() <= 4096.0 + 1.0, "{on} {due}");
}

#[test]
fn a_failed_pin_is_reported_and_set_again() {
    let failed = MockError::Io(std::io::ErrorKind::Other);
    let high = || OnPin::set(State::High);
    let mut pin = PinMock::new(&[
        OnPin::set(State::Low),
        high().with_error(failed.clone()),
        high(),
        OnPin::set(State::Low),
    ]);
    let mut switch = TimeProportioned::<_, f32>::new(pin.clone(), &config(4, 0, 0)).unwrap();
    assert_eq!(switch.tick(), Ok(false));
    assert!((0..3).all(|_| switch.tick() == Ok(false)));
    switch.apply(0.75).unwrap();
    assert_eq!((switch.tick(), switch.applied()), (Err(failed), None));
    assert_eq!((switch.tick(), switch.applied()), (Ok(true), Some(0.75)));
    switch.switch_off().unwrap();
    assert_eq!(switch.applied(), Some(0.0));
    pin.done();
}

/// A pin that fails in some ticks, and then counts.
struct Unsteady<'a> {
    broken: &'a core::cell::Cell<bool>,
}

impl embedded_hal::digital::Error for Broken {
    fn kind(&self) -> embedded_hal::digital::ErrorKind {
        embedded_hal::digital::ErrorKind::Other
    }
}

#[derive(Debug, PartialEq)]
struct Broken;

impl embedded_hal::digital::ErrorType for Unsteady<'_> {
    type Error = Broken;
}

impl embedded_hal::digital::OutputPin for Unsteady<'_> {
    fn set_low(&mut self) -> Result<(), Broken> {
        if self.broken.get() { Err(Broken) } else { Ok(()) }
    }
    fn set_high(&mut self) -> Result<(), Broken> {
        self.set_low()
    }
}

/// The pin fails from any tick on, for any number of ticks, at any duty: as long as it should have been set and was not,
/// nothing is known of it, and as soon as it is set, all is.
#[test]
fn a_pin_that_failed_is_not_known_at_any_place_of_the_window() {
    let mut failures = [0; 4];
    for duty in [0.25, 0.5, 0.75] {
        for (from, ticks) in (0..12).flat_map(|from| (1..14).map(move |ticks| (from, ticks))) {
            let broken = core::cell::Cell::new(false);
            let mut switch =
                TimeProportioned::<_, f32>::new(Unsteady { broken: &broken }, &config(4, 0, 0)).unwrap();
            switch.apply(duty).unwrap();
            assert_eq!(switch.applied(), Some(duty));
            for k in 0..30_usize {
                broken.set((from..from + ticks).contains(&k));
                let known = match switch.tick() {
                    Ok(_) => Some(duty),
                    Err(Broken) => {
                        failures[k % 4] += 1;
                        None
                    }
                };
                assert_eq!(switch.applied(), known, "duty {duty}, broken from {from} for {ticks}: tick {k}");
                // What is asked of a pin that has failed is no news of the pin.
                switch.apply(duty).unwrap();
                assert_eq!(switch.applied(), known);
            }
            broken.set(true);
            assert_eq!((switch.switch_off(), switch.applied()), (Err(Broken), None));
            assert_eq!((switch.tick(), switch.applied()), (Err(Broken), None));
            broken.set(false);
            assert_eq!((switch.switch_off(), switch.applied()), (Ok(()), Some(0.0)));
        }
    }
    assert!(failures.iter().all(|&count| count > 0), "{failures:?}");
}

#[test]
fn what_is_no_number_goes_to_the_safe_output() {
    let safe = TimeProportionedConfig {
        output: OutputConfig { lo: 0.0, hi: 1.0, invalid: OnInvalid::Safe(0.5) },
        ..config(10, 0, 0)
    };
    let mut switch = TimeProportioned::<_, f32>::new(Pin::default(), &safe).unwrap();
    assert_eq!(switch.apply(f32::NAN), Err(ActuateError::NotFinite));
    assert_eq!(switch.applied(), Some(0.5));
    assert_eq!((0..100).filter(|_| switch.tick().unwrap()).count(), 50);
}

#[test]
fn windows_without_room_are_refused() {
    let refused = |window, on, off| {
        let faults = TimeProportioned::<_, f32>::new(Pin::default(), &config(window, on, off)).err().unwrap();
        faults.iter().map(|fault| fault.param).collect::<Vec<_>>()
    };
    assert_eq!(refused(0, 0, 0), [Param::Window, Param::MinimumOn]);
    assert_eq!(refused(1, 0, 0), [Param::Window, Param::MinimumOn]);
    assert_eq!(refused(16_385, 0, 0), [Param::Window]);
    assert_eq!(refused(10, 10, 0), [Param::MinimumOn]);
    assert_eq!(refused(10, 6, 5), [Param::MinimumOff]);
    assert_eq!(refused(10, u16::MAX, u16::MAX), [Param::MinimumOn]);
    assert!(TimeProportioned::<_, f32>::new(Pin::default(), &config(10, 6, 4)).is_ok());
    let bad = TimeProportionedConfig {
        output: OutputConfig { lo: 1.0, hi: 1.0, ..OutputConfig::default() },
        ..config(0, 1, 1)
    };
    assert_eq!(TimeProportioned::<_, f32>::new(Pin::default(), &bad).err().unwrap().len(), 3);
}
