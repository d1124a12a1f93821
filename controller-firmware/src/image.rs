//! Begin and end of an image on an emulated board.
//!
//! Every way out ends the emulator with an exit code: a run never hangs, and a script sees what happened.

use core::cell::Cell;
use cortex_m_rt::{ExceptionFrame, exception};
use critical_section::Mutex;
use semihosting::eprintln;
pub use semihosting::{print, println};

/// Exit code after a panic, as programs on a host have it.
pub const PANICKED: i32 = 101;
/// Exit code after a fault or an interrupt that nobody handles.
pub const FAULTED: i32 = 102;

// The emulator is told which board to be by the image itself. Not loaded; the linker keeps such a section.
core::arch::global_asm!(
    ".pushsection .controller.board, \"\", %progbits",
    concat!(".ascii \"", env!("CONTROLLER_BOARD"), "\""),
    ".popsection"
);

static MAKE_SAFE: Mutex<Cell<fn()>> = Mutex::new(Cell::new(|| ()));

/// What to do after a fault or a panic before anything else: the outputs go to where they do no harm.
///
/// It runs with interrupts off, wherever the fault found the program, so it must not ask for anything that somebody may have
/// borrowed: write the register, or an atomic.
pub fn on_fault(make_safe: fn()) {
    critical_section::with(|cs| MAKE_SAFE.borrow(cs).set(make_safe));
}

/// Interrupts stay off: the next one would act on its own again. What is done is done once, even if it fails itself.
fn make_safe() {
    cortex_m::interrupt::disable();
    let act = critical_section::with(|cs| MAKE_SAFE.borrow(cs).replace(|| ()));
    act();
}

/// Ends the image.
pub fn exit(code: i32) -> ! {
    semihosting::process::exit(code)
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    make_safe();
    // Not where the log goes: a decoder would take it for a part of a frame.
    eprintln!("{info}");
    exit(PANICKED)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    make_safe();
    eprintln!("hard fault at {:#010x}, called from {:#010x}", frame.pc(), frame.lr());
    exit(FAULTED)
}

#[exception]
unsafe fn DefaultHandler(number: i16) {
    make_safe();
    eprintln!("interrupt {number} without a handler");
    exit(FAULTED)
}
