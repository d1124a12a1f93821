//! A trace through everything a program may do with two instances, and what the block gives when Rust calls it.

use controller_capi::plc::{self, Kind, Vars, status};
use controller_capi::{ctl_f32_fb, ctl_f64_fb};
use std::fmt::Write;

pub(crate) trait Fb: plc::Number {
    fn call(memory: &mut [u64], vars: &mut Vars<Self>) -> i32;
    /// Words of the memory in Structured Text.
    const ST_WORDS: usize;
}

impl Fb for f32 {
    fn call(memory: &mut [u64], vars: &mut Vars<f32>) -> i32 {
        // SAFETY: the memory is as long as it says, and only this block uses it.
        unsafe { ctl_f32_fb(memory.as_mut_ptr().cast(), size_of_val(memory), vars) }
    }
    const ST_WORDS: usize = 256;
}

impl Fb for f64 {
    fn call(memory: &mut [u64], vars: &mut Vars<f64>) -> i32 {
        // SAFETY: as above.
        unsafe { ctl_f64_fb(memory.as_mut_ptr().cast(), size_of_val(memory), vars) }
    }
    const ST_WORDS: usize = 512;
}

/// An instance, and the plant it controls.
struct Instance<T> {
    memory: Vec<u64>,
    vars: Vars<T>,
    y: f64,
}

pub(crate) struct Trace<T> {
    pub(crate) script: String,
    pub(crate) expected: String,
    /// Calls that had a loop.
    pub(crate) running: u32,
    /// Status bits and modes that came.
    pub(crate) seen: (u32, u32),
    instances: [Instance<T>; 2],
    fields: Vec<(&'static str, Kind, usize)>,
    seed: u64,
}

impl<T: Fb> Trace<T> {
    /// So many calls: mostly a loop at work, now and then a change of one variable.
    pub(crate) fn random(seed: u64, calls: u32) -> Self {
        let instance = || Instance { memory: vec![0; T::ST_WORDS], vars: Vars::initial(), y: 40.0 };
        let mut trace = Self {
            script: String::new(),
            expected: String::new(),
            running: 0,
            seen: (0, 0),
            instances: [instance(), instance()],
            fields: Vars::<T>::fields().collect(),
            seed: seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03,
        };
        for i in 0..2 {
            trace.print(i, false);
            trace.prepare(i);
        }
        for call in 0..calls {
            let i = (trace.next() % 2) as usize;
            trace.change(i);
            let u = trace.instances[i].vars.results.op.to_f64();
            let load = if call % 700 < 350 { 5.0 } else { -5.0 };
            let y = &mut trace.instances[i].y;
            *y += 0.02 * (20.0 + 0.8 * (u + load) - *y);
            let y = *y;
            trace.set(i, "pv", y);
            trace.call(i);
        }
        trace
    }

    fn next(&mut self) -> u64 {
        self.seed ^= self.seed << 13;
        self.seed ^= self.seed >> 7;
        self.seed ^= self.seed << 17;
        self.seed >> 11
    }

    /// A number from `lo` to `hi`.
    fn number(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * (self.next() % 100_001) as f64 / 100_000.0
    }

    /// The first instance has an estimator, the other one an observer.
    fn prepare(&mut self, i: usize) {
        let parameters = [("m_gain", 0.8), ("m_t1", 4.0), ("m_t2", 0.7), ("m_dead", 0.37), ("latency", 0.05)];
        for (name, x) in parameters {
            self.set(i, name, x);
        }
        for (name, x) in
            [("kfd", 0.7), ("tfd", 0.6), ("alpha", 1.5), ("kp", 3.0), ("tn", 4.0), ("dev_lim", 10.0)]
        {
            self.set(i, name, x);
        }
        self.set(i, "comp", (i + 1) as f64);
        self.set(i, "pv_quality", 2.0 * (1 - i) as f64);
        self.set(i, "tcyc", 0.1);
        self.set(i, "sp", 50.0);
    }

    /// Now and then a variable changes.
    fn change(&mut self, i: usize) {
        let x = match self.next() % 60 {
            0 => ("sp", self.number(20.0, 110.0)),
            1 => ("sp_remote", self.number(20.0, 80.0)),
            2 => ("op_man", self.number(-10.0, 110.0)),
            3 => ("trk_value", self.number(0.0, 100.0)),
            4 => ("ff", self.number(-5.0, 5.0)),
            5 => ("kp", self.number(-5.0, 5.0)),
            6 => ("tn", self.number(-1.0, 8.0)),
            7 => ("tv", self.number(0.0, 1.0)),
            8 => ("tf", self.number(0.0, 0.5)),
            9 => ("tcyc", [0.1, 0.1, 0.105, 0.115, 0.2, 0.0, 0.5][(self.next() % 7) as usize]),
            10 => ("scan_div", [1.0, 1.0, 2.0, 0.0][(self.next() % 4) as usize]),
            11 => ("pv_quality", [2.0, 2.0, 2.0, 1.0, 0.0][(self.next() % 5) as usize]),
            12 => ("comp", self.number(0.0, 2.99).trunc()),
            13 => ("op_rate_up", self.number(0.0, 90.0)),
            14 => ("h_lim", self.number(40.0, 60.0)),
            15 => ("op_readback", self.number(0.0, 100.0)),
            16 => ("m_dead", self.number(0.0, 3.0)),
            17 => ("fail_act", self.number(0.0, 1.99).trunc()),
            18 => ("aw", self.number(0.0, 2.99).trunc()),
            19 => ("ff", f64::NAN),
            20 => ("sp", f64::INFINITY),
            21 => ("pv_hi", [100.0, 120.0, 0.0][(self.next() % 3) as usize]),
            22 => ("sp_rate_up", self.number(-0.5, 9.0)),
            23..=35 => {
                let switch = [
                    "man",
                    "trk",
                    "off",
                    "hold",
                    "cas",
                    "rb_use",
                    "inhibit_up",
                    "restart",
                    "h_en",
                    "fail_ack",
                    "ack",
                    "trapezoid",
                ];
                let others = ["compensate", "auto_", "sp_track"];
                let at = (self.next() % 26) as usize;
                // Mostly off, the last ones mostly on.
                let on = self.next().is_multiple_of(4);
                match (switch.get(at), others.get(at % 3)) {
                    (Some(name), _) => (*name, f64::from(u8::from(on))),
                    (None, name) => (*name.unwrap_or(&"auto_"), f64::from(u8::from(!on))),
                }
            }
            _ => return,
        };
        self.set(i, x.0, x.1);
        // Nothing stays unusable for long.
        if !x.1.is_finite() {
            self.call(i);
            self.set(i, x.0, 45.0);
        }
    }

    /// Sets a variable of an instance, here and in the script.
    fn set(&mut self, i: usize, name: &str, x: f64) {
        let (number, &(_, kind, at)) = self
            .fields
            .iter()
            .enumerate()
            .find(|(_, field)| field.0 == name)
            .expect("a variable of this name");
        let bytes = match kind {
            Kind::Real => {
                let [low, high] = T::from_f64(x).to_words();
                u64::from(low) | u64::from(high) << 32
            }
            Kind::Whole | Kind::Bits => u64::from((x as i32).cast_unsigned()),
            Kind::Flag => u64::from(x != 0.0),
        };
        let size = self.size(kind);
        let vars: *mut Vars<T> = &mut self.instances[i].vars;
        // SAFETY: a field of the structure, any bits of which are a value.
        unsafe { bytes.to_le_bytes().as_slice().as_ptr().copy_to(vars.cast::<u8>().wrapping_add(at), size) };
        writeln!(self.script, "S {i} {number} {bytes:x}").expect("memory");
    }

    fn size(&self, kind: Kind) -> usize {
        match kind {
            Kind::Real => size_of::<T>(),
            Kind::Whole | Kind::Bits => 4,
            Kind::Flag => 1,
        }
    }

    fn call(&mut self, i: usize) {
        let Instance { memory, vars, .. } = &mut self.instances[i];
        let code = T::call(memory, vars);
        assert_eq!(code, vars.reports.error);
        if vars.reports.status & status::NOT_RUNNING == 0 {
            self.running += 1;
        }
        self.seen.0 |= vars.reports.status;
        self.seen.1 |= 1 << vars.reports.mode;
        writeln!(self.script, "C {i}").expect("memory");
        self.print(i, true);
    }

    /// All variables of an instance, or its outputs only, as bits.
    fn print(&mut self, i: usize, outputs: bool) {
        use controller_capi::plc::vars::{Flags, Reports, Results};
        write!(self.expected, "{i}").expect("memory");
        for &(name, kind, at) in &self.fields {
            let output = Results::<T>::NAMES.contains(&name)
                || Reports::NAMES.contains(&name)
                || Flags::NAMES.contains(&name);
            if outputs && !output {
                continue;
            }
            let mut bytes = [0; 8];
            let vars: *const Vars<T> = &self.instances[i].vars;
            // SAFETY: a field of the structure.
            unsafe { vars.cast::<u8>().wrapping_add(at).copy_to(bytes.as_mut_ptr(), self.size(kind)) };
            write!(self.expected, " {:x}", u64::from_le_bytes(bytes)).expect("memory");
        }
        self.expected.push('\n');
    }
}
