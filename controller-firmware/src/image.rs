//! Begin and end of an image on an emulated board.
//!
//! Every way out ends the emulator with an exit code: a run never hangs, and a script sees what happened.

use core::cell::Cell;
use cortex_m_rt::{ExceptionFrame, exception};
use critical_section::Mutex;
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
pub fn on_fault(make_safe: fn()) {
    critical_section::with(|cs| MAKE_SAFE.borrow(cs).set(make_safe));
}

fn make_safe() {
    let act = critical_section::with(|cs| MAKE_SAFE.borrow(cs).get());
    act();
}

/// Ends the image.
pub fn exit(code: i32) -> ! {
    semihosting::process::exit(code)
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    make_safe();
    println!("{info}");
    exit(PANICKED)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    make_safe();
    println!("hard fault at {:#010x}, called from {:#010x}", frame.pc(), frame.lr());
    exit(FAULTED)
}

#[exception]
unsafe fn DefaultHandler(number: i16) {
    make_safe();
    println!("interrupt {number} without a handler");
    exit(FAULTED)
}
