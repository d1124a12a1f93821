//! The memory of a block: first scan, moving, damage, errors.

use crate::rig::{Fb, Rig, pi};
use controller_capi::plc::{Vars, status};
use std::ffi::c_void;

/// A block with an estimator and some dead time.
fn estimating<T: Fb>() -> Rig<T> {
    let mut rig = Rig::new(12);
    let n = T::from_f64;
    let s = &mut rig.vars.settings;
    (s.kp, s.tn, s.tv, s.tf) = (n(2.35), n(1.25), n(0.2), n(0.12));
    (s.kfd, s.tfd, s.m_gain, s.m_a1, s.m_a2, s.m_dead) = (n(0.69), n(0.3), n(1.0), n(1.2), n(0.2), n(1.15));
    rig.vars.choices.comp = 1;
    rig
}

/// A measurement without a pattern, within 40 to 60.
fn noise(k: u32) -> f64 {
    40.0 + f64::from(k.wrapping_mul(2_654_435_761) >> 20) / 204.8
}

fn bits<T: Fb>(vars: &Vars<T>) -> Vec<[u32; 2]> {
    let results = vars.results.list().map(T::to_words);
    let reports = &vars.reports;
    let more = [reports.op_raw, reports.mode, reports.error].map(|x| [x.cast_unsigned(), reports.status]);
    results.chain(more).collect()
}

/// Every call at another address, of every alignment, the old memory poisoned.
fn moves<T: Fb>() {
    let mut still = estimating::<T>();
    let mut moved = estimating::<T>();
    let size = moved.memory.len();
    let mut here = vec![0_u8; size];
    for k in 0..400 {
        let offset = (k as usize * 5) % 16;
        let mut there = vec![0xA5_u8; size + 16];
        there[offset..offset + size].copy_from_slice(&here);
        here.fill(0xFF);
        for rig in [&mut still, &mut moved] {
            rig.vars.signals.sp = T::from_f64(50.0);
            rig.vars.signals.pv = T::from_f64(noise(k));
        }
        let start: *mut c_void = there[offset..].as_mut_ptr().cast();
        assert_eq!(unsafe { T::call(start, size, &mut moved.vars) }, 0);
        assert_eq!(still.scan(), 0);
        assert_eq!(bits(&still.vars), bits(&moved.vars), "sample {k}");
        here = there[offset..offset + size].to_vec();
        // Nothing beyond its memory was touched.
        assert!(there[..offset].iter().chain(&there[offset + size..]).all(|&byte| byte == 0xA5));
    }
    assert!(still.vars.results.uf.to_f64() != 0.0);
}

#[test]
fn may_be_moved_to_any_address() {
    moves::<f32>();
    moves::<f64>();
}

#[test]
fn two_blocks_do_not_disturb_each_other() {
    let (mut alone, mut first, mut second) = (estimating::<f32>(), estimating::<f32>(), pi::<f32>());
    for k in 0..300 {
        second.run(20.0, noise(k + 1000));
        first.run(50.0, noise(k));
        assert_eq!(alone.run(50.0, noise(k)), first.op());
    }
}

#[test]
fn bad_memory_is_an_error_and_nothing_is_written() {
    let mut rig = pi::<f64>();
    rig.run(55.0, 50.0);
    let before = (rig.memory.clone(), rig.vars);
    let null = std::ptr::null_mut();
    let size = rig.memory.len();
    assert_eq!(unsafe { f64::call(rig.memory.as_mut_ptr().cast(), size, std::ptr::null_mut()) }, 1);
    let odd = (&raw mut rig.vars).cast::<u8>().wrapping_add(1).cast();
    assert_eq!(unsafe { f64::call(rig.memory.as_mut_ptr().cast(), size, odd) }, 3);
    assert_eq!((&before.0, before.1), (&rig.memory, rig.vars));
    for (state, size, code) in
        [(null, size, 1), (rig.memory.as_mut_ptr().cast(), 100, 2), (rig.memory.as_mut_ptr().cast(), 0, 2)]
    {
        assert_eq!(unsafe { f64::call(state, size, &mut rig.vars) }, code);
        assert_eq!((rig.vars.reports.error, rig.vars.flags.fault), (code, 1));
        assert_eq!(rig.vars.reports.status, status::NOT_RUNNING);
        assert_eq!(rig.vars.results, before.1.results);
        assert_eq!(rig.memory, before.0);
    }
    // Smaller than it was.
    let mut rig = estimating::<f64>();
    rig.run(50.0, 50.0);
    let size = rig.memory.len();
    assert_eq!(unsafe { f64::call(rig.memory.as_mut_ptr().cast(), size - 8, &mut rig.vars) }, 2);
    assert_eq!(rig.scan(), 0);
}

#[test]
fn a_dead_time_that_does_not_fit_is_named() {
    let mut rig = estimating::<f32>();
    // 12 samples of 0.1 s: 1.2 s and a fraction fit, 1.4 s do not.
    rig.vars.settings.m_dead = 1.4;
    assert_eq!((rig.scan(), rig.refused()), (2, "state"));
    assert!(rig.has(status::NOT_RUNNING));
    rig.vars.settings.m_dead = 1.2;
    rig.run(50.0, 50.0);
    rig.vars.settings.m_dead = 1.4;
    assert_eq!((rig.scan(), rig.refused()), (2, "state"));
    assert!(rig.has(status::REFUSED) && !rig.has(status::NOT_RUNNING));
}

#[test]
fn memory_that_is_not_a_block_begins_anew_and_says_so() {
    let mut rig = pi::<f64>();
    rig.memory.fill(0x5A);
    assert_eq!(rig.run(50.0, 50.0), 30.0);
    assert!(rig.has(status::STATE_LOST));
    rig.run(50.0, 50.0);
    assert!(rig.has(status::STATE_LOST));
    rig.vars.commands.ack = 1;
    rig.run(50.0, 50.0);
    assert!(!rig.has(status::STATE_LOST));
    // The loop inside is damaged: its first words, at the first aligned address and behind 640 bytes.
    rig.vars.commands.ack = 0;
    let aligned = rig.memory.as_ptr().align_offset(8);
    rig.memory[aligned + 640] ^= 1;
    rig.run(50.0, 50.0);
    assert!(rig.has(status::STATE_LOST));
}

#[test]
fn a_loop_whose_memory_is_lost_goes_on_from_its_output() {
    let mut rig = pi::<f64>();
    rig.vars.settings.op_rate_up = 1.0;
    rig.vars.settings.op_rate_dn = 1.0;
    let mut op = 0.0;
    for _ in 0..300 {
        op = rig.run(60.0, 50.0);
    }
    assert!(op > 40.0);
    let aligned = rig.memory.as_ptr().align_offset(8);
    rig.memory[aligned + 640] ^= 1;
    let next = rig.run(60.0, 50.0);
    assert!(rig.has(status::STATE_LOST));
    let step = 1.0 * rig.vars.settings.ts;
    assert!((next - op).abs() <= step + 1e-9, "{op} {next}");
}

/// OP that the variables hold counts, whatever has come between the damage and the first good call.
#[test]
fn a_loop_whose_memory_is_lost_goes_on_from_its_output_after_an_error() {
    type Wrong = fn(&mut Rig<f64>);
    let refused: Wrong = |rig| rig.vars.settings.tn = -1.0;
    let nothing: Wrong = |_| ();
    for (wrong, size_too_small, calls) in
        [(refused, false, 1), (refused, false, 3), (nothing, true, 1), (refused, true, 2)]
    {
        for limits in [(0.0, 100.0), (-50.0, 50.0)] {
            let mut rig = pi::<f64>();
            (rig.vars.settings.op_lo, rig.vars.settings.op_hi) = limits;
            for _ in 0..300 {
                rig.run(50.0, if limits.0 < 0.0 { 52.0 } else { 48.0 });
            }
            let op = rig.op();
            assert!((op - 30.0).abs() > 10.0, "{op}");
            let parameters = rig.vars.settings;
            for call in 0..calls {
                // Another byte in each call.
                rig.memory[300 + call] ^= 0x10;
                wrong(&mut rig);
                let all = rig.memory.len();
                let size = if size_too_small { 64 } else { all };
                let state = rig.memory.as_mut_ptr().cast();
                assert_ne!(unsafe { f64::call(state, size, &mut rig.vars) }, 0);
                assert_eq!((rig.op(), rig.vars.reports.mode), (op, 0));
            }
            rig.vars.settings = parameters;
            let next = rig.run(50.0, 50.0);
            assert!(rig.has(status::STATE_LOST));
            assert!((next - op).abs() < 1e-9, "{op} {next}");
        }
    }
    // A program that keeps OP alone, as one that makes the variables anew in each call.
    let mut rig = pi::<f64>();
    rig.memory.fill(0x5A);
    rig.vars.results.op = 61.0;
    assert_eq!(rig.run(50.0, 50.0), 61.0);
}

#[test]
fn without_a_loop_nobody_is_in_automatic() {
    let mut rig = pi::<f64>();
    rig.run(50.0, 50.0);
    assert_eq!(rig.vars.flags.in_auto, 1);
    rig.memory.fill(0x5A);
    rig.vars.settings.tn = -1.0;
    assert_ne!(rig.scan(), 0);
    assert!(rig.has(status::NOT_RUNNING));
    let flags = &rig.vars.flags;
    assert_eq!((rig.vars.reports.mode, flags.in_auto, flags.blocked_up, flags.blocked_dn), (0, 0, 1, 1));
}

#[test]
fn the_memory_of_one_type_is_not_that_of_the_other() {
    let mut single = pi::<f32>();
    single.run(50.0, 50.0);
    let mut double = pi::<f64>();
    let size = single.memory.len();
    double.memory[..size].copy_from_slice(&single.memory);
    double.run(50.0, 50.0);
    assert!(double.has(status::STATE_LOST));
}

/// Any bits in any variable: a code that the header knows, finite outputs inside their limits, no crash.
#[test]
fn any_variables() {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 32) as u32
    };
    let mut ran = 0;
    for round in 0..300 {
        let mut rig = estimating::<f32>();
        for _ in 0..60 {
            let size = size_of::<Vars<f32>>();
            let hits = next() % 4;
            for _ in 0..hits {
                // Every second round spares the parameters.
                let fields: Vec<_> = Vars::<f32>::fields().collect();
                let (name, kind, at) = fields[next() as usize % fields.len()];
                let parameter = controller_capi::plc::vars::Settings::<f32>::NAMES.contains(&name);
                if parameter && round % 2 == 0 {
                    continue;
                }
                let value = match next() % 6 {
                    0 => f32::NAN.to_bits(),
                    1 => f32::INFINITY.to_bits(),
                    2 => next(),
                    3 => 0,
                    4 => f32::MAX.to_bits(),
                    _ => (next() as f32 / 4e7).to_bits(),
                };
                let width = if kind == controller_capi::plc::Kind::Flag { 1 } else { 4 };
                let start = (&raw mut rig.vars).cast::<u8>();
                assert!(at + width <= size);
                let bytes = value.to_le_bytes();
                unsafe { bytes.as_ptr().copy_to(start.wrapping_add(at), width) };
            }
            let code = rig.scan();
            assert!(matches!(code, 0 | 2 | 7), "{code}");
            if !rig.has(status::NOT_RUNNING) {
                ran += 1;
                assert!(rig.vars.results.list().all(f32::is_finite), "{:?}", rig.vars);
            }
        }
    }
    assert!(ran > 5000, "{ran}");
}
