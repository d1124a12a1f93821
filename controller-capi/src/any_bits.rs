//! Blocks of any bits behind a header that fits: what the sums would refuse is let through here, as if they had missed it.

use crate::block::{Block, Number};
use crate::calls;
use crate::config::Config;
use crate::fault::{Error, Faults};
use crate::header::Header;
use crate::io::{Input, Output};
use crate::snapshot;
use core::ffi::c_void;

const DELAY: u32 = 9;
const GUARD: usize = 8;
const UNTOUCHED: u32 = 0xC3C3_C3C3;
const FENCE: u64 = 0xA5A5_A5A5_A5A5_A5A5;
/// Words of 8 bytes, enough for both number types.
const WORDS: usize = 256;

struct Chance(u64);

impl Chance {
    fn word(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from(self.0 >> 32).unwrap_or_default()
    }

    /// What is likely to do harm: ends of ranges, numbers that are none, lengths just beyond a list, anything.
    fn odd_word(&mut self) -> u32 {
        match self.word() % 8 {
            0 => 0,
            1 => u32::MAX,
            2 => 0x7FC0_0000,
            3 => 0x7FF0_0000,
            4 => self.word() % 20,
            5 => i32::MIN.cast_unsigned(),
            _ => self.word(),
        }
    }
}

fn config(compensator: i32) -> Config {
    let mut config = Config {
        ts: 0.05,
        kp: 2.0,
        ki: 1.0,
        kd: 0.2,
        tf: 0.1,
        output_lo: -2.0,
        output_hi: 3.0,
        compensator,
        kfd: 0.7,
        tfd: 0.1,
        alpha: 0.2,
        model_gain: 1.0,
        model_dead_time: 0.2,
        model_pole_count: 1,
        hold_samples: 3,
        ..Config::default()
    };
    (config.model_pole_a1[0], config.model_pole_a2[0]) = (1.2, 0.2);
    config
}

/// The codes that a call may come to on such a block.
fn known(done: Result<(), Error>) {
    assert!(matches!(done, Ok(()) | Err(Error::Damaged)), "{done:?}");
}

fn any_bits<T: Number>(compensator: i32, seed: u64) {
    let mut chance = Chance(seed);
    let size = crate::block::size::<T>(DELAY);
    let count = size >> 3;
    let mut memory = [FENCE; WORDS];
    let (good, other) = (config(compensator), config((compensator + 1) % 3));
    let mut faults = Faults::default();
    for round in 0..2000 {
        memory[GUARD..GUARD + count].fill(0);
        let state = memory[GUARD..].as_mut_ptr().cast();
        // SAFETY: so many bytes of this test's, aligned, and structures of its own.
        let mut block = unsafe {
            assert_eq!(calls::init::<T>(state, size, &good, &mut faults), Ok(()));
            // Everything behind the header, whose last word is the sum of the law.
            let words = core::slice::from_raw_parts_mut(state.cast::<u32>(), 2 * count);
            let all = round % 2 == 0;
            for word in &mut words[8..] {
                if all || chance.word().is_multiple_of(16) {
                    *word = chance.odd_word();
                }
            }
            Block::<T>::find(state, size).unwrap()
        };
        block.seal();
        for _ in 0..4 {
            let number = |word: u32| T::from_words([word, word]);
            let input = Input {
                r: number(chance.odd_word()),
                y: T::from_f64(0.5),
                mode: i32::try_from(chance.word() % 8).unwrap(),
                quality: i32::try_from(chance.word() % 3).unwrap(),
                compensator_off: i32::from(chance.word().is_multiple_of(4)),
                ..Input::default()
            };
            let mut output = Output::default();
            let samples = chance.word() % 2000;
            let what = chance.word() % 8;
            let (mut words, mut written) = ([UNTOUCHED; 256], 0);
            // SAFETY: as above.
            unsafe {
                match what {
                    0 => known(calls::advance::<T>(state, size, samples)),
                    1 => known(calls::adopt::<T>(state, size, &other, &mut faults)),
                    2 => known(calls::adopt::<T>(state, size, &good, &mut faults)),
                    3 => {
                        let saved = snapshot::save::<T>(state, size, words.as_mut_ptr(), 256, &mut written);
                        if saved == Ok(()) {
                            // What it has saved may be no state at all.
                            let _ = snapshot::restore::<T>(state, size, words.as_ptr(), written);
                        } else {
                            assert!(written == 0 && words.iter().all(|&word| word == UNTOUCHED));
                        }
                    }
                    4 => known(calls::settle::<T>(state, size, [T::ZERO; 3])),
                    _ => known(calls::step::<T>(state, size, &input, &mut output)),
                }
            }
        }
        let fence = memory[..GUARD].iter().chain(&memory[GUARD + count..]);
        assert!(fence.into_iter().all(|&word| word == FENCE), "round {round}");
    }
}

#[test]
fn no_bits_stop_a_call_or_lead_it_astray() {
    for compensator in 0..3 {
        any_bits::<f32>(compensator, 1);
        any_bits::<f64>(compensator, 2);
    }
}

/// Numbers of the state that are near the largest ones: once a step has found damage every call does, until `init`.
fn huge<T: Number>(compensator: i32) {
    let size = crate::block::size::<T>(DELAY);
    let config = config(compensator);
    let mut memory = [0_u64; WORDS];
    let state: *mut c_void = memory.as_mut_ptr().cast();
    let mut faults = Faults::default();
    let (mut chance, mut found) = (Chance(3), 0);
    let bytes = size_of::<T>();
    // SAFETY: so many bytes of this test's, aligned, and structures of its own.
    let step = |r: f64, y: f64| unsafe {
        let input = Input { r: T::from_f64(r), y: T::from_f64(y), ..Input::default() };
        let mut output = Output::default();
        calls::step::<T>(state, size, &input, &mut output)
    };
    for _ in 0..4000 {
        // SAFETY: as above.
        assert_eq!(unsafe { calls::init::<T>(state, size, &config, &mut faults) }, Ok(()));
        (0..5_u32).for_each(|k| assert_eq!(step(0.5, 0.1 * f64::from(k)), Ok(())));
        for _ in 0..1 + chance.word() % 3 {
            // A number behind the header.
            let at = size_of::<Header>() + chance.word() as usize * bytes % (size - size_of::<Header>());
            let large = T::from_f64(if chance.word().is_multiple_of(2) { 0.9 } else { -0.9 } * T::LARGEST);
            // SAFETY: inside the block.
            unsafe { state.byte_add(at).cast::<T>().write(large) };
        }
        // SAFETY: as above.
        if unsafe { Block::<T>::open(state, size) }.is_err() {
            continue;
        }
        if (0..100).all(|_| step(0.5, 0.2) == Ok(())) {
            continue;
        }
        found += 1;
        (0..100).for_each(|k| assert_eq!(step(0.5, 0.2), Err(Error::Damaged), "{k} later"));
        let mut output = Output::default();
        // SAFETY: as above.
        unsafe {
            assert_eq!(calls::read::<T>(state, size, &mut output), Err(Error::Damaged));
            assert_eq!(calls::settle::<T>(state, size, [T::ZERO; 3]), Err(Error::Damaged));
            assert_eq!(calls::adopt::<T>(state, size, &config, &mut faults), Err(Error::Damaged));
            assert_eq!(calls::init::<T>(state, size, &config, &mut faults), Ok(()));
        }
        assert_eq!(step(0.5, 0.2), Ok(()));
    }
    assert!(found > 20, "{found}");
}

#[test]
fn damage_that_a_step_has_found_stays_until_init() {
    for compensator in 0..3 {
        huge::<f32>(compensator);
        huge::<f64>(compensator);
    }
}
