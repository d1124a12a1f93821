//! A critical section that measures itself.
//!
//! It does what the usual one of a single core does, and reads the system timer right after interrupts go off and right
//! before they come back: under the emulator's clock these are instructions. Keeping the record takes a few more with
//! interrupts off, which are not counted, as the usual critical section has not got them.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use cortex_m::peripheral::SYST;
use cortex_m::{interrupt, register::primask};
use critical_section::{Impl, RawRestoreState, set_impl};

/// The timer when the outermost section began.
static BEGAN: AtomicU32 = AtomicU32::new(0);
/// The longest section \[ticks\].
static LONGEST: AtomicU32 = AtomicU32::new(0);

/// Ticks of the longest section since the last call of [`forget`].
pub fn longest() -> u32 {
    LONGEST.load(Relaxed)
}

/// Begins anew.
pub fn forget() {
    LONGEST.store(0, Relaxed);
}

/// Ticks from one reading of the system timer, which counts down, to a later one less than a period away.
fn between(before: u32, after: u32) -> u32 {
    if after <= before { before - after } else { before + SYST::get_reload() + 1 - after }
}

struct TimedLock;
set_impl!(TimedLock);

// SAFETY: interrupts are off from `acquire` to the matching `release`, which restores what was before; there is one core.
unsafe impl Impl for TimedLock {
    unsafe fn acquire() -> RawRestoreState {
        let before = primask::read_raw();
        interrupt::disable();
        if before & 1 == 0 {
            BEGAN.store(SYST::get_current(), Relaxed);
        }
        before
    }

    unsafe fn release(before: RawRestoreState) {
        if before & 1 == 0 {
            let time = between(BEGAN.load(Relaxed), SYST::get_current());
            if time > LONGEST.load(Relaxed) {
                LONGEST.store(time, Relaxed);
            }
        }
        // SAFETY: the state that `acquire` found.
        unsafe { primask::write_raw(before) };
    }
}
