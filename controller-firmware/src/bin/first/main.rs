//! The guide's first loop. `README.md` shows `control.rs`, `fault.rs` and `main` below as they stand here; a check compares
//! them. The image takes nothing from this package's library, which would bring handlers of its own.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[cfg(target_os = "none")]
mod control;
#[cfg(target_os = "none")]
mod fault;
#[cfg(target_os = "none")]
#[path = "../demo/heater_law.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub, reason = "exported: what it offers is not all used here")]
mod loop_law;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    const RELOAD: f64 = board::CLOCK as f64 * loop_law::TS - 1.0;
    const { assert!(RELOAD >= 1.0 && RELOAD < 16_777_215.0, "not a period for the system timer") };
    let heater = board::Heater::new();
    let (spi, pwm) = (board::Adc(&heater), board::Channel); // drivers of your board's crate
    let mut control = control::Control::new(spi, pwm).expect("the laws of this image are valid");

    let mut timer = cortex_m::Peripherals::take().expect("nobody else has taken them").SYST;
    timer.set_clock_source(cortex_m::peripheral::syst::SystClkSource::Core);
    timer.set_reload((RELOAD + 0.5) as u32);
    timer.clear_current();
    timer.enable_counter();
    loop {
        while !timer.has_wrapped() {}
        control.sample(60.0);
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    println!(
        "first: runs on a microcontroller; in the folder controller-firmware: cargo run --release --bin first"
    );
}
