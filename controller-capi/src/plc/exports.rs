//! The functions of `ctl_fb.h`, where they are explained. What a caller must keep is said in [`crate::exports`]; but the memory
//! of a function block needs no alignment.

use super::{Vars, parameters, scan, size, size_without_compensator};
use crate::block::check_pointer;
use crate::calls;
use crate::fault::Error;
use core::ffi::{c_char, c_void};

/// Name of the parameter that ERROR_PARAM is about.
#[unsafe(no_mangle)]
pub extern "C" fn ctl_fb_param_name(param: i32) -> *const c_char {
    parameters::param_name(param).as_ptr()
}

macro_rules! variant {
    ($real:ty; $size:ident $size_without:ident $align:ident $initial:ident $fb:ident) => {
        /// Bytes of a function block for up to `delay` samples of dead time and latency; 0: there is no such block.
        #[unsafe(no_mangle)]
        pub extern "C" fn $size(delay: u32) -> usize {
            size::<$real>(delay)
        }

        /// Bytes of a function block that never has a compensator.
        #[unsafe(no_mangle)]
        pub extern "C" fn $size_without() -> usize {
            size_without_compensator::<$real>()
        }

        /// Alignment of a function block \[bytes\]: any address will do.
        #[unsafe(no_mangle)]
        pub extern "C" fn $align() -> usize {
            1
        }

        /// Writes the values that the variables begin with. `vars_size` is `sizeof *vars`.
        ///
        /// # Safety
        /// `vars` points to `vars_size` bytes, see the [module](crate::exports).
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $initial(vars: *mut Vars<$real>, vars_size: usize) -> i32 {
            let done = check_pointer(vars, align_of::<Vars<$real>>()).and_then(|()| {
                if vars_size != size_of::<Vars<$real>>() {
                    return Err(Error::StructSize);
                }
                // SAFETY: not null, aligned, the caller's, of this size.
                unsafe { vars.write(Vars::initial()) };
                Ok(())
            });
            calls::code(done)
        }

        /// One scan of the function block.
        ///
        /// # Safety
        /// See the [module](crate::exports); the memory is zero bytes, or what the last call with it has left.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $fb(state: *mut c_void, size: usize, vars: *mut Vars<$real>) -> i32 {
            // SAFETY: by the caller.
            calls::code(unsafe { scan::scan(state, size, vars) })
        }
    };
}

variant! { f32; ctl_f32_fb_size ctl_f32_fb_size_without_compensator ctl_f32_fb_align ctl_f32_fb_initial ctl_f32_fb }
variant! { f64; ctl_f64_fb_size ctl_f64_fb_size_without_compensator ctl_f64_fb_align ctl_f64_fb_initial ctl_f64_fb }
