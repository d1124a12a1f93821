//! The instruction meter for `f32`; on a laptop an empty program. An image for each type: the smallest board holds one.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("meter-f32: runs on an emulated microcontroller: cargo xtask size");
}

#[cfg(target_os = "none")]
#[path = "../meter/mod.rs"]
mod meter;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use controller_firmware::image::{exit, println};
    let Some(peripherals) = cortex_m::Peripherals::take() else { exit(1) };
    match meter::run::<f32>(peripherals.SYST) {
        Some(()) => exit(0),
        None => println!("the timer does not count instructions, or a block could not be built"),
    }
    exit(1)
}
