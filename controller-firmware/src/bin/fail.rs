//! Fails on purpose, in the way that its first word names: `panic`, `fault`, `twice` or `spin`.
//!
//! An interrupt keeps an output on all the time. After a failure it must be off and stay off, whoever held what when it
//! happened; the checks of the workspace look for the last line and the exit code.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("fail: runs on a microcontroller, and fails there on purpose");
}

#[cfg(target_os = "none")]
mod target {
    use controller_firmware::image;
    use core::sync::atomic::{AtomicU32, Ordering};
    use cortex_m::peripheral::syst::SystClkSource;
    use cortex_m_rt::{entry, exception};
    use semihosting::eprintln;

    /// The output, such as the duty of a heater.
    static OUTPUT: AtomicU32 = AtomicU32::new(0);
    /// What the interrupt sets it to.
    const ON: u32 = 1000;
    /// Ticks between two interrupts, and far more than that.
    const TICKS: u32 = 2000;
    const LONG: u32 = 20 * TICKS;

    #[exception]
    fn SysTick() {
        OUTPUT.store(ON, Ordering::Relaxed);
    }

    fn off() {
        OUTPUT.store(0, Ordering::Relaxed);
        // Time for interrupts, if there were any.
        cortex_m::asm::delay(LONG);
        eprintln!("the output is {}", OUTPUT.load(Ordering::Relaxed));
    }

    /// What makes safe fails itself, after it has done the most urgent.
    fn off_and_fail() {
        off();
        panic!("while making safe");
    }

    #[entry]
    fn main() -> ! {
        let words = semihosting::experimental::env::args::<64>();
        let word = words.as_ref().ok().and_then(|mut words| words.nth(1)).and_then(Result::ok);
        image::on_fault(if word == Some("twice") { off_and_fail } else { off });
        if let Some(peripherals) = cortex_m::Peripherals::take() {
            let mut timer = peripherals.SYST;
            timer.set_clock_source(SystClkSource::Core);
            timer.set_reload(TICKS);
            timer.clear_current();
            timer.enable_counter();
            timer.enable_interrupt();
        }
        while OUTPUT.load(Ordering::Relaxed) != ON {}
        match word {
            Some("panic" | "twice") => panic!("on purpose"),
            Some("fault") => cortex_m::asm::udf(),
            Some("spin") => loop {
                cortex_m::asm::nop();
            },
            _ => image::exit(2),
        }
    }
}
