//! Links only if nothing that is kept in it can panic.
//!
//! Its panic handler is a call of a function that does not exist: a single path to a panic that the optimiser could not
//! rule out, and the linker refuses (so it links in release alone). What is kept are addresses of functions: the
//! optimiser knows nothing of their arguments, so that "cannot panic" means "whatever comes in". Nobody runs it.
//!
//! ```text
//! cargo build --release -p controller-no-panic --target thumbv7em-none-eabihf
//! cargo build --release -p controller-no-panic --target thumbv7em-none-eabihf --features unchecked-index   # must fail
//! ```
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("controller-no-panic: is linked for a microcontroller, and runs nowhere");
}

#[cfg(target_os = "none")]
mod blocks;
#[cfg(target_os = "none")]
mod hardware;
#[cfg(target_os = "none")]
mod laws;
#[cfg(target_os = "none")]
mod loops;

/// Keeps the code of a function, for any arguments.
#[cfg(target_os = "none")]
macro_rules! keep {
    ($($function:expr => $signature:ty),* $(,)?) => {
        $(core::hint::black_box($function as $signature);)*
    };
}
#[cfg(target_os = "none")]
use keep;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    // The handler of panics; the critical section comes with the other crate.
    use panic_never as _;
    blocks::keep_all::<f32>();
    blocks::keep_all::<f64>();
    laws::keep_all::<f32>();
    laws::keep_all::<f64>();
    loops::keep_all::<f32>();
    loops::keep_all::<f64>();
    hardware::keep_all::<f32>();
    hardware::keep_all::<f64>();
    hardware::keep_single();
    #[cfg(feature = "unchecked-index")]
    keep!(unchecked => fn(&_, _) -> _);
    loop {
        cortex_m::asm::wfi();
    }
}

/// What the laws must not do.
#[cfg(all(target_os = "none", feature = "unchecked-index"))]
fn unchecked(ring: &[f32; 8], newest: usize) -> f32 {
    ring[newest]
}
