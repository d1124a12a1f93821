//! The functions of the header. What they do and when they fail stands there; here is what a caller must keep.
//!
//! In all of them a pointer may be null or not aligned: the call then fails. Otherwise it points to what its type says, and
//! that memory is used by nobody else during the call. `size` bytes at `state` exist; if they begin like an initialised block,
//! the functions of this library have written them.

use crate::block::{self, ALIGN, Number};
use crate::config::{Config, STRUCT_SIZE};
use crate::fault::{self, Error, Faults};
use crate::io::{Input, Output};
use crate::{ABI_VERSION, calls, snapshot};
use core::ffi::{c_char, c_void};

/// Version of the interface that the archive has; `CTL_ABI_VERSION` is that of the header.
#[unsafe(no_mangle)]
pub extern "C" fn ctl_abi_version() -> u32 {
    ABI_VERSION
}

/// Writes the defaults. `struct_size` is `sizeof(ctl_config)`.
///
/// # Safety
/// `config` points to `struct_size` bytes, see the [module](self).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ctl_config_default(config: *mut Config, struct_size: usize) -> i32 {
    let done = block::check_pointer(config, align_of::<Config>()).and_then(|()| {
        if struct_size != STRUCT_SIZE as usize {
            return Err(Error::StructSize);
        }
        // SAFETY: not null, aligned, the caller's, of this size.
        unsafe { config.write(Config::default()) };
        Ok(())
    });
    calls::code(done)
}

/// What an error code means: text that ends with 0 and lives as long as the program.
#[unsafe(no_mangle)]
pub extern "C" fn ctl_error_text(code: i32) -> *const c_char {
    fault::error_text(code).as_ptr()
}

/// Name of the field that a fault is about.
#[unsafe(no_mangle)]
pub extern "C" fn ctl_param_name(param: i32) -> *const c_char {
    fault::param_name(param).as_ptr()
}

/// What is wrong with the field, as the end of a sentence.
#[unsafe(no_mangle)]
pub extern "C" fn ctl_reason_text(reason: i32) -> *const c_char {
    fault::reason_text(reason).as_ptr()
}

macro_rules! variant {
    ($real:ty;
     $size:ident $size_without:ident $align:ident $delay_samples:ident $check:ident $init:ident $settle:ident $set_mode:ident
     $step:ident $adopt:ident $advance:ident $read:ident $words:ident $save:ident $restore:ident) => {
        /// Bytes of a block for up to `delay` samples of dead time and latency; 0: there is no such block.
        #[unsafe(no_mangle)]
        pub extern "C" fn $size(delay: u32) -> usize {
            block::size::<$real>(delay)
        }

        /// Bytes of a block that never has a compensator.
        #[unsafe(no_mangle)]
        pub extern "C" fn $size_without() -> usize {
            <$real>::SIZE_WITHOUT_COMPENSATOR
        }

        /// Alignment of a block \[bytes\].
        #[unsafe(no_mangle)]
        pub extern "C" fn $align() -> usize {
            ALIGN
        }

        /// The delay that a block needs for this configuration \[samples\]; 0 without a compensator.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $delay_samples(config: *const Config, samples: *mut u32) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::delay_samples::<$real>(config, samples) })
        }

        /// Finds all faults of a configuration; `faults` may be null.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $check(config: *const Config, faults: *mut Faults) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::check::<$real>(config, faults) })
        }

        /// Builds the loop in the block; `faults` may be null.
        ///
        /// # Safety
        /// See the [module](self); what the block holds does not matter.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $init(
            state: *mut c_void,
            size: usize,
            config: *const Config,
            faults: *mut Faults,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::init::<$real>(state, size, config, faults) })
        }

        /// Puts the loop at rest.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $settle(
            state: *mut c_void,
            size: usize,
            r: $real,
            y: $real,
            u: $real,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::settle::<$real>(state, size, [r, y, u]) })
        }

        /// Sets the mode that a step uses when its input asks for none.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set_mode(state: *mut c_void, size: usize, mode: i32) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::set_mode::<$real>(state, size, mode) })
        }

        /// One sample.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $step(
            state: *mut c_void,
            size: usize,
            input: *const Input<$real>,
            output: *mut Output<$real>,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::step(state, size, input, output) })
        }

        /// Replaces all parameters without a bump; `faults` may be null.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $adopt(
            state: *mut c_void,
            size: usize,
            config: *const Config,
            faults: *mut Faults,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::adopt::<$real>(state, size, config, faults) })
        }

        /// Tells the loop that samples were lost.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $advance(state: *mut c_void, size: usize, samples: u32) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::advance::<$real>(state, size, samples) })
        }

        /// Terms and status of the last step.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $read(state: *const c_void, size: usize, output: *mut Output<$real>) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { calls::read(state, size, output) })
        }

        /// Words of a snapshot of this block.
        ///
        /// # Safety
        /// See the [module](self).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $words(state: *mut c_void, size: usize, count: *mut usize) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { snapshot::count::<$real>(state, size, count) })
        }

        /// Saves the state.
        ///
        /// # Safety
        /// See the [module](self); `words` points to `capacity` words.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $save(
            state: *mut c_void,
            size: usize,
            words: *mut u32,
            capacity: usize,
            written: *mut usize,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { snapshot::save::<$real>(state, size, words, capacity, written) })
        }

        /// Restores a state that was saved.
        ///
        /// # Safety
        /// See the [module](self); `words` points to `count` words.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $restore(
            state: *mut c_void,
            size: usize,
            words: *const u32,
            count: usize,
        ) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { snapshot::restore::<$real>(state, size, words, count) })
        }
    };
}

variant! { f32;
    ctl_f32_size ctl_f32_size_without_compensator ctl_f32_align ctl_f32_delay_samples ctl_f32_check ctl_f32_init ctl_f32_settle
    ctl_f32_set_mode ctl_f32_step ctl_f32_adopt ctl_f32_advance ctl_f32_read ctl_f32_snapshot_words ctl_f32_save ctl_f32_restore
}

variant! { f64;
    ctl_f64_size ctl_f64_size_without_compensator ctl_f64_align ctl_f64_delay_samples ctl_f64_check ctl_f64_init ctl_f64_settle
    ctl_f64_set_mode ctl_f64_step ctl_f64_adopt ctl_f64_advance ctl_f64_read ctl_f64_snapshot_words ctl_f64_save ctl_f64_restore
}
