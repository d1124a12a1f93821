//! A function block with its memory, called as a runtime does.

use controller_capi::plc::{self, Vars};
use controller_capi::{ctl_f32_fb, ctl_f32_fb_size, ctl_f64_fb, ctl_f64_fb_size};
use controller_core::Real;
use std::ffi::{CStr, c_void};

pub trait Fb: plc::Number {
    unsafe fn call(state: *mut c_void, size: usize, vars: *mut Vars<Self>) -> i32;
    fn bytes(delay: u32) -> usize;
}

impl Fb for f32 {
    unsafe fn call(state: *mut c_void, size: usize, vars: *mut Vars<f32>) -> i32 {
        unsafe { ctl_f32_fb(state, size, vars) }
    }
    fn bytes(delay: u32) -> usize {
        ctl_f32_fb_size(delay)
    }
}

impl Fb for f64 {
    unsafe fn call(state: *mut c_void, size: usize, vars: *mut Vars<f64>) -> i32 {
        unsafe { ctl_f64_fb(state, size, vars) }
    }
    fn bytes(delay: u32) -> usize {
        ctl_f64_fb_size(delay)
    }
}

/// A block, and its variables by their names in Structured Text.
pub struct Rig<T> {
    pub memory: Vec<u8>,
    pub vars: Vars<T>,
}

impl<T: Fb> Rig<T> {
    pub fn new(delay: u32) -> Self {
        Self { memory: vec![0; T::bytes(delay)], vars: Vars::initial() }
    }

    pub fn scan(&mut self) -> i32 {
        unsafe { T::call(self.memory.as_mut_ptr().cast(), self.memory.len(), &mut self.vars) }
    }

    /// A scan that must go well, with this set-point and measurement; gives OP.
    pub fn run(&mut self, sp: f64, pv: f64) -> f64 {
        self.vars.signals.sp = T::from_f64(sp);
        self.vars.signals.pv = T::from_f64(pv);
        let code = self.scan();
        assert_eq!((code, self.vars.reports.error, self.vars.flags.fault), (0, 0, 0), "{}", self.refused());
        self.op()
    }

    pub fn op(&self) -> f64 {
        self.vars.results.op.to_f64()
    }

    pub fn has(&self, bits: u32) -> bool {
        self.vars.reports.status & bits == bits
    }

    /// Name of the parameter that was refused.
    pub fn refused(&self) -> &'static str {
        let name =
            unsafe { CStr::from_ptr(controller_capi::ctl_fb_param_name(self.vars.reports.error_param)) };
        name.to_str().unwrap()
    }
}

/// A PI controller with KP = 2, TN = 10 s, TS = 0.1 s that begins at OP = 30.
pub fn pi<T: Fb>() -> Rig<T> {
    let mut rig = Rig::new(0);
    rig.vars.settings.kp = T::from_f64(2.0);
    rig.vars.settings.op_init = T::from_f64(30.0);
    rig
}

/// The same number but for some units in the last place of its type, of terms up to `size`.
#[track_caller]
pub fn same<T: Real>(x: f64, y: f64, size: f64) {
    assert!((x - y).abs() <= 4.0 * T::EPS * size, "{x} is not {y}");
}
