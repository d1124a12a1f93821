//! Tests that run on the microcontroller; on a laptop an empty program.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("on_target: runs on a microcontroller; in the folder controller-firmware: cargo test");
}

#[cfg(target_os = "none")]
mod laws;
#[cfg(target_os = "none")]
mod machine;
#[cfg(target_os = "none")]
mod signals;
#[cfg(target_os = "none")]
mod telemetry;

/// Runs all tests; the first one that panics ends the image, with the exit code of a panic.
#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use controller_firmware::image::{exit, print, println};
    println!("board {}", controller_firmware::BOARD);
    let mut passed = 0;
    for tests in [machine::FIRST, laws::TESTS, signals::TESTS, telemetry::TESTS, machine::LAST] {
        for (name, test) in tests {
            print!("test {name} ... ");
            test();
            // Beyond the end of the stack lie the statics of other tests.
            assert!(!controller_firmware::stack::is_exhausted(), "the stack was too small");
            println!("ok");
            passed += 1;
        }
    }
    println!("{passed} passed, 0 failed");
    exit(0)
}
