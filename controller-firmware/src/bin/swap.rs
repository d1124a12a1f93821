//! Swaps laws under a running control task: `swap [SWAPS [whole|torn|bare]]`; see [`controller_firmware::swap`].
//!
//! A timer interrupt at 1 kHz runs the loop; the main context publishes one of the known laws again and again, at any
//! place of the period. `torn` and `bare` do it wrongly, to show that the checks would notice.
//!
//! ```text
//! cargo run --release -p controller-firmware --bin swap --no-default-features --features timed-lock \
//!     --target thumbv7em-none-eabihf -- 10000
//! ```
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("swap: runs on a microcontroller");
}

#[cfg(target_os = "none")]
mod on_board {
    use controller_core::ParamCell;
    use controller_firmware::image::{exit, println};
    use controller_firmware::swap::{self, Cell, LAWS, Law, Order, Report, TS, Task, Way};
    use controller_firmware::{BOARD, timed_lock};
    use controller_pil::board;
    use core::cell::UnsafeCell;
    use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering::Relaxed};
    use cortex_m::peripheral::{Peripherals, syst::SystClkSource};
    use cortex_m_rt::{entry, exception};

    /// Swaps if nobody says otherwise.
    const SWAPS: u32 = 10_000;
    /// Longest time between two publications \[cycles\].
    const LONGEST_PAUSE: u32 = 1500;
    /// Nanoseconds of one instruction under the emulator's clock.
    const INSTRUCTION: u64 = 128;

    /// All laws, from the main context to the task, once.
    static KNOWN: ParamCell<[Law; LAWS]> = ParamCell::new();
    /// The next law, again and again.
    static NEXT: Cell = Cell::new();
    /// What the task saw, in the end.
    static REPORT: ParamCell<Report> = ParamCell::new();
    static DONE: AtomicBool = AtomicBool::new(false);
    static WANTED: AtomicU32 = AtomicU32::new(SWAPS);
    static WAY: AtomicU8 = AtomicU8::new(Way::Whole as u8);
    /// The longest time with interrupts off, when the task ended \[ticks\].
    static LONGEST: AtomicU32 = AtomicU32::new(0);

    /// A law without a lock: what must not be done.
    struct Plain(UnsafeCell<Option<Law>>);
    // SAFETY: none; it is there to be torn. A mixture of two laws is a valid value of the type, byte by byte.
    unsafe impl Sync for Plain {}
    static PLAIN: Plain = Plain(UnsafeCell::new(None));

    #[exception]
    fn SysTick() {
        static mut TASK: Option<Task> = None;
        static mut SEEN: u32 = 0;
        if TASK.is_none() {
            *TASK = KNOWN.take_newer(&mut 0).map(Task::new);
            // All laws at once take longer than one.
            timed_lock::forget();
        }
        let (Some(task), false) = (TASK, DONE.load(Relaxed)) else {
            return;
        };
        let way = [Way::Whole, Way::Torn, Way::Bare][usize::from(WAY.load(Relaxed))];
        let news = if way == Way::Torn {
            // SAFETY: see `Plain`.
            unsafe { PLAIN.0.get().read_volatile() }
        } else {
            NEXT.take_newer(SEEN)
        };
        let report = task.sample(news, way);
        if report.swaps >= WANTED.load(Relaxed) {
            LONGEST.store(timed_lock::longest(), Relaxed);
            REPORT.publish(report);
            DONE.store(true, Relaxed);
        }
    }

    /// Reads the words of the command line.
    fn understand() -> Option<()> {
        let words = semihosting::experimental::env::args::<128>().ok()?;
        let mut words = (&words).skip(1);
        if let Some(swaps) = words.next() {
            WANTED.store(swaps.ok()?.parse().ok()?, Relaxed);
        }
        if let Some(way) = words.next() {
            let way = match way.ok()? {
                "whole" => Way::Whole,
                "torn" => Way::Torn,
                "bare" => Way::Bare,
                _ => return None,
            };
            WAY.store(way as u8, Relaxed);
        }
        words.next().is_none().then_some(())
    }

    #[entry]
    fn main() -> ! {
        let board = board::named(BOARD);
        let (Some(()), Some(laws), Some(mut peripherals), Some(board)) =
            (understand(), swap::laws(), Peripherals::take(), board)
        else {
            println!("usage: swap [SWAPS [whole|torn|bare]]");
            exit(2)
        };
        KNOWN.publish(laws);
        let timer = &mut peripherals.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload((f64::from(board.clock) * TS) as u32 - 1);
        timer.clear_current();
        timer.enable_counter();
        timer.enable_interrupt();

        let mut order = Order::new();
        let mut published = 0_u32;
        while !DONE.load(Relaxed) {
            cortex_m::asm::delay(1 + order.below(LONGEST_PAUSE));
            let law = laws[order.below(LAWS as u32) as usize];
            if WAY.load(Relaxed) == Way::Torn as u8 {
                // SAFETY: see `Plain`.
                unsafe { PLAIN.0.get().write_volatile(Some(law)) };
            } else {
                NEXT.publish(law);
            }
            published += 1;
        }
        peripherals.SYST.disable_interrupt();

        let report = REPORT.take_newer(&mut 0).unwrap_or_default();
        let per_second = u64::from(board.clock) * INSTRUCTION;
        let off = (u64::from(LONGEST.load(Relaxed)) * 1_000_000_000 + per_second / 2) / per_second;
        println!("laws of {} bytes, {published} published", size_of::<Law>());
        println!("{} swaps in {} samples", report.swaps, report.samples);
        println!("{} torn laws", report.torn);
        println!(
            "{} bumps; the largest {} u, at most {} of its bound",
            report.bumps, report.difference, report.worst
        );
        println!("interrupts off for at most {off} instructions");
        exit(i32::from(report.torn > 0 || report.bumps > 0 || report.swaps == 0))
    }
}
