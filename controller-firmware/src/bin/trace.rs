//! Prints the hash of every loop of [`controller_firmware::trace`], on the host as on a board.
//!
//! ```text
//! cargo run --release -p controller-firmware --bin trace -- 100000 both
//! cargo run --release -p controller-firmware --bin trace --target thumbv7em-none-eabihf -- 10000 f32
//! ```
#![cfg_attr(target_os = "none", no_std, no_main)]

use controller_firmware::trace::{self, Request};

/// What to say to words that make no sense.
const USAGE: &str = "usage: trace [SAMPLES [f32|f64|both]]";
/// Exit code for them.
const MISUSED: i32 = 2;
/// Samples in which every loop meets everything ..
#[cfg(not(target_os = "none"))]
const ENOUGH: u32 = 20_000;
/// .. and the exit code when one has not: its hash would then say less than it seems to.
#[cfg(not(target_os = "none"))]
const BLIND: i32 = 1;

#[cfg(not(target_os = "none"))]
fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some(request) = Request::from_words(words.iter().map(String::as_str)) else {
        eprintln!("{USAGE}");
        std::process::exit(MISUSED);
    };
    let mut blind = 0;
    trace::run(request, |line| {
        println!("{line}");
        let met = line.met.filter(|met| request.samples >= ENOUGH && !met.everything());
        if let Some(met) = met {
            eprintln!("{line}: the loop has not met everything: {met:x?}");
            blind = BLIND;
        }
    });
    std::process::exit(blind);
}

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use controller_firmware::image::{exit, println};
    let words = semihosting::experimental::env::args::<256>();
    let request = words.ok().and_then(|words| {
        // The first word is the image's own name; one that is no text is no request either.
        Request::from_words((&words).skip(1).map(|word| word.unwrap_or("?")))
    });
    let Some(request) = request else {
        println!("{USAGE}");
        exit(MISUSED)
    };
    trace::run(request, |line| println!("{line}"));
    exit(0)
}
