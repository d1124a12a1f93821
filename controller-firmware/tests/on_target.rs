//! Tests that run on the microcontroller; on a laptop an empty program.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("on_target: runs on a microcontroller; in the folder controller-firmware: cargo test");
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use controller_firmware::image::{exit, println};
    println!("board {}", controller_firmware::BOARD);
    exit(0)
}
