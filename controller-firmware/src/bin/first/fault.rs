//! What happens after a panic, a fault or an interrupt that nobody handles.

use core::panic::PanicInfo;
use cortex_m_rt::{ExceptionFrame, exception};

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    stop()
}

#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop()
}

#[exception]
unsafe fn DefaultHandler(_: i16) -> ! {
    stop()
}

/// Writes the register: whoever has the driver may just be using it.
fn stop() -> ! {
    cortex_m::interrupt::disable();
    crate::board::heater_off();
    loop {
        cortex_m::asm::wfi();
    }
}
