//! Start-up and interrupts.

use crate::heater::{self, Heater};
use crate::oven::{self, Oven};
use crate::{heater_law, oven_law, rig, watch};
use controller_core::ConfigErrors;
use controller_firmware::image;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_m::peripheral::SCB;
use cortex_m::peripheral::scb::SystemHandler;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::{entry, exception};
use critical_section::Mutex;
use defmt_semihosting as _;

/// Sampling period of the fast loop, and tick of the relay \[ms\].
const PERIOD_MS: u32 = (1e3 * heater_law::TS + 0.5) as u32;
/// Clocks of the system timer in it, from the period that the law was designed for.
const CLOCKS: u32 = (heater_law::TS * controller_firmware::CLOCK as f64 + 0.5) as u32;
const _: () = assert!(CLOCKS >= 1 && CLOCKS <= 1 << 24, "the system timer cannot count the sampling period");

/// Periods of the fast loop in one of the slow loop.
const SLOWER: u32 = (oven_law::TS / heater_law::TS + 0.5) as u32;
const _: () = {
    let difference = oven_law::TS - heater_law::TS * SLOWER as f64;
    assert!(difference < 1e-9 && difference > -1e-9, "the slow period is not a multiple of the fast one");
};

/// Periods since the start. Only the timer interrupt writes it.
static PERIODS: AtomicU32 = AtomicU32::new(0);
/// The loops, on their way from `main` to the control interrupt.
static LOOPS: Mutex<RefCell<Option<Loops>>> = Mutex::new(RefCell::new(None));

defmt::timestamp!("{=u32:tms}", PERIOD_MS.wrapping_mul(periods()));

/// Periods since the start.
pub(crate) fn periods() -> u32 {
    PERIODS.load(Ordering::Relaxed)
}

#[entry]
fn main() -> ! {
    image::on_fault(rig::off);
    match start() {
        Ok(()) => watch::run(),
        Err(faults) => {
            defmt::error!("a loop cannot be built: {}", faults);
            image::exit(1)
        }
    }
}

#[inline(never)]
fn start() -> Result<(), ConfigErrors> {
    assemble(&heater::law()?, &oven::law()?)?;
    // The peripherals of the processor are all that the demo uses of the board.
    let mut peripherals = cortex_m::Peripherals::take().expect("nobody else has taken them");
    // SAFETY: no critical section here goes by priorities: it turns all interrupts off.
    unsafe { peripherals.SCB.set_priority(SystemHandler::PendSV, u8::MAX) };
    let mut timer = peripherals.SYST;
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(CLOCKS - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
    defmt::info!(
        "the heater's loop runs every {=u32} ms, the oven's every {=u32}",
        PERIOD_MS,
        SLOWER * PERIOD_MS
    );
    Ok(())
}

/// Brings laws and drivers together and leaves them where the control interrupt finds them.
#[inline(never)]
fn assemble(heater: &heater_law::Law, oven: &oven_law::Law) -> Result<(), ConfigErrors> {
    let loops = Loops { heater: Heater::new(heater)?, oven: Oven::new(oven)?, now: 0, oven_at: 0 };
    critical_section::with(|cs| LOOPS.borrow_ref_mut(cs).replace(loops));
    Ok(())
}

/// The timer: short, and above the control tasks, so that it counts every period whatever they do.
#[exception]
fn SysTick() {
    PERIODS.store(periods().wrapping_add(1), Ordering::Relaxed);
    rig::pass_10_ms();
    oven::tick();
    SCB::set_pendsv();
}

/// The control interrupt: below the timer, above `main`.
#[exception]
fn PendSV() {
    static mut OWN: Option<Loops> = None;
    if OWN.is_none() {
        fetch(OWN);
    }
    if let Some(loops) = OWN {
        loops.sample(periods());
    }
}

/// With the first interrupt the loops become its own: from then on nobody has to ask for them.
#[inline(never)]
fn fetch(own: &mut Option<Loops>) {
    *own = critical_section::with(|cs| LOOPS.borrow(cs).try_borrow_mut().ok()?.take());
}

struct Loops {
    heater: Heater,
    oven: Oven,
    /// Periods up to the last sample of each.
    now: u32,
    oven_at: u32,
}

impl Loops {
    /// What is due in period `now`. Requests for this interrupt that came while it ran are one: the count tells how many.
    fn sample(&mut self, now: u32) {
        let passed = now.wrapping_sub(self.now);
        if passed == 0 {
            return;
        }
        self.now = now;
        self.heater.sample(now, passed - 1);
        let due = now.wrapping_sub(self.oven_at) / SLOWER;
        if due > 0 {
            self.oven_at = self.oven_at.wrapping_add(due * SLOWER);
            self.oven.sample(now, due - 1);
        }
    }
}
