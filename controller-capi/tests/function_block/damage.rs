//! Memory that is damaged between two scans: it is found, or what was damaged has no meaning.

use crate::rig::{Fb, Rig};
use controller_capi::plc::{Vars, status};

const SP: f64 = 50.0;
const SCANS: u32 = 25;
const DELAY: u32 = 6;
/// Scans in which damage that was not found must have shown, the longest way being through the delay memory.
const AFTER: u32 = 10;

fn pv(k: u32) -> f64 {
    44.0 + f64::from(k.wrapping_mul(2_654_435_761) >> 20) / 2048.0
}

/// A PI controller alone, with a derivative and an estimator, or with an observer.
fn rig<T: Fb>(comp: i32) -> Rig<T> {
    let mut rig = Rig::<T>::new(DELAY);
    let n = T::from_f64;
    let s = &mut rig.vars.settings;
    (s.kp, s.tn, s.op_init) = (n(1.5), n(4.0), n(30.0));
    (s.m_gain, s.m_a1, s.m_a2, s.m_dead) = (n(1.0), n(1.2), n(0.2), n(0.55));
    (s.tv, s.tf) = if comp == 1 { (n(0.2), n(0.12)) } else { (n(0.0), n(0.0)) };
    (s.kfd, s.tfd, s.alpha) = (n(0.69), n(0.3), n(0.4));
    rig.vars.choices.comp = comp;
    rig.vars.signals.tcyc = n(0.1);
    rig.vars.commands.rb_use = 0;
    rig
}

/// What a scan shows, bit for bit.
fn shown<T: Fb>(vars: &Vars<T>) -> Vec<[u32; 2]> {
    let reports = vars.reports.list().map(|word| [word, 0]);
    let flags = vars.flags.list().map(|flag| [flag.into(), 0]);
    vars.results.list().map(T::to_words).chain(reports).chain(flags).collect()
}

/// Which of the memories an undisturbed block would have, and what it shows from then on.
struct Twin<T> {
    memory: Vec<u8>,
    vars: Vars<T>,
    shows: Vec<Vec<[u32; 2]>>,
}

/// A block after so many scans; `rig` goes on to where its future is known.
fn twin<T: Fb>(rig: &mut Rig<T>, from: u32) -> Twin<T> {
    let (memory, vars) = (rig.memory.clone(), rig.vars);
    let shows = (from..from + AFTER).map(|k| {
        rig.run(SP, pv(k));
        shown(&rig.vars)
    });
    let shows = shows.collect();
    rig.memory.copy_from_slice(&memory);
    rig.vars = vars;
    Twin { memory, vars, shows }
}

/// Whether damage was found; if it was not, it made no difference to one of `twins`.
fn found<T: Fb>(rig: &mut Rig<T>, damaged: &[u8], twins: &[&Twin<T>], what: &str) -> bool {
    let Twin { vars, .. } = twins[0];
    rig.memory.copy_from_slice(damaged);
    rig.vars = *vars;
    let before = rig.op();
    let first = rig.run(SP, pv(SCANS));
    if rig.has(status::STATE_LOST) {
        // Anew from OP: what a first sample at rest adds is the integral of its error.
        let s = &rig.vars.settings;
        let step = (s.kp * s.ts / s.tn).to_f64() * (SP - pv(SCANS)).abs();
        assert!((first - before).abs() <= step + 1e-3, "{what}: {before} to {first}");
        rig.vars.commands.ack = 1;
        rig.run(SP, pv(SCANS + 1));
        assert!(!rig.has(status::STATE_LOST), "{what}");
        return true;
    }
    let mut shows = vec![shown(&rig.vars)];
    shows.extend((SCANS + 1..SCANS + AFTER).map(|k| {
        rig.run(SP, pv(k));
        shown(&rig.vars)
    }));
    assert!(twins.iter().any(|twin| twin.shows == shows), "{what}: not found, and not without effect");
    false
}

fn each<T: Fb>(check: impl Fn(Rig<T>, i32)) {
    for comp in 0..3 {
        let mut rig = rig::<T>(comp);
        for k in 0..SCANS {
            rig.run(SP, pv(k));
        }
        check(rig, comp);
    }
}

fn every_bit<T: Fb>() {
    each::<T>(|mut rig, comp| {
        let twin = twin(&mut rig, SCANS);
        let mut lost = 0;
        for bit in 0..8 * twin.memory.len() {
            let mut damaged = twin.memory.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            let what = format!("COMP {comp}, byte {}, bit {}", bit / 8, bit % 8);
            lost += usize::from(found(&mut rig, &damaged, &[&twin], &what));
        }
        // The parameters, the results and the numbers of the loop are most of the memory that is in use.
        let least = 8 * size_of::<T>() * if comp == 0 { 120 } else { 150 };
        assert!(lost > least, "COMP {comp}: {lost} bits of {}", 8 * twin.memory.len());
    });
}

#[test]
fn one_bit_is_found_or_has_no_meaning() {
    every_bit::<f32>();
    every_bit::<f64>();
}

struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 24
    }
}

fn some_words<T: Fb>() {
    each::<T>(|mut rig, comp| {
        let twin = twin(&mut rig, SCANS);
        let mut chance = Chance(comp as u64 + 5);
        for round in 0..3000 {
            let mut damaged = twin.memory.clone();
            for _ in 0..2 + chance.next() % 30 {
                let at = (4 * chance.next()) as usize % (damaged.len() - 3);
                let word = match chance.next() % 4 {
                    0 => 0,
                    1 => u32::MAX,
                    2 => 0x7FC0_0000,
                    _ => chance.next() as u32,
                };
                damaged[at..at + 4].copy_from_slice(&word.to_le_bytes());
            }
            found(&mut rig, &damaged, &[&twin], &format!("COMP {comp}, round {round}"));
        }
    });
}

#[test]
fn some_words_are_found_or_have_no_meaning() {
    some_words::<f32>();
    some_words::<f64>();
}

/// Memory of which a power failure has left one part as it was `scans` ago.
fn torn<T: Fb>(scans: u32) {
    each::<T>(|mut rig, comp| {
        let new = twin(&mut rig, SCANS);
        let mut earlier = self::rig::<T>(comp);
        // The same place, so that nothing moves.
        std::mem::swap(&mut earlier.memory, &mut rig.memory);
        earlier.memory.fill(0);
        for k in 0..SCANS - scans {
            earlier.run(SP, pv(k));
        }
        std::mem::swap(&mut earlier.memory, &mut rig.memory);
        let (memory, vars) = (rig.memory.clone(), rig.vars);
        // Taken as a whole, the old one is good.
        let old = twin(&mut rig, SCANS);
        assert!(memory == old.memory && vars.results == old.vars.results);
        let mut lost = 0;
        for split in (0..=new.memory.len()).step_by(4) {
            for (first, second) in [(&old, &new), (&new, &old)] {
                let damaged = [&first.memory[..split], &second.memory[split..]].concat();
                let what = format!("COMP {comp}, {scans} scans old, split at {split}");
                lost += u32::from(found(&mut rig, &damaged, &[&new, &old], &what));
            }
        }
        assert!(lost > 100, "{lost}");
    });
}

#[test]
fn halves_of_two_scans_are_found() {
    for scans in [1, 2, 17] {
        torn::<f32>(scans);
        torn::<f64>(scans);
    }
}

/// A first call that a power failure has cut off: one part is still zero.
#[test]
fn a_part_that_is_still_zero_is_found() {
    each::<f32>(|mut rig, comp| {
        let twin = twin(&mut rig, SCANS);
        let nothing = vec![0; twin.memory.len()];
        let aligned = rig.memory.as_ptr().align_offset(8);
        for split in (0..twin.memory.len()).step_by(4) {
            for (first, second) in [(&twin.memory, &nothing), (&nothing, &twin.memory)] {
                let damaged = [&first[..split], &second[split..]].concat();
                // What the block itself remembers and the beginning of its loop are zero: cleared.
                let beginning = aligned..aligned + <f32 as controller_capi::plc::Number>::FB_FIXED + 8;
                if damaged[beginning].iter().all(|&byte| byte == 0) {
                    continue;
                }
                rig.memory.copy_from_slice(&damaged);
                rig.vars = twin.vars;
                rig.run(SP, pv(SCANS));
                let same = shown(&rig.vars) == twin.shows[0];
                let cold = !rig.has(status::STATE_LOST) && !same;
                assert!(!cold, "COMP {comp}, split at {split}: a cold start without a word");
            }
        }
    });
}
