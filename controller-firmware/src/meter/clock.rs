//! Counts the instructions of one call, exactly.
//!
//! The emulator runs with `-icount shift=7`: every instruction takes 2^7 ns of the board's time. The system timer, which
//! counts that time, then moves by two to three ticks an instruction; rounded to whole instructions its reading is exact.
//!
//! The call goes through a few instructions of assembly that leave every argument and every result where they are, so
//! that they serve for a function of any signature, as long as it has no argument on the stack.

use controller_pil::board::{self, Board};
use core::arch::naked_asm;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use cortex_m::peripheral::{SYST, syst::SystClkSource};

/// Nanoseconds of the board's time for one instruction.
const INSTRUCTION: u64 = 1 << 7;
/// The timer counts down from here.
const FULL: u32 = 0x00FF_FFFF;
/// Instructions of [`SysTick`].
const HANDLER: u32 = 5;

/// What the trampoline calls.
static CALLEE: AtomicUsize = AtomicUsize::new(0);
/// The timer before and after the last call.
static READINGS: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];
/// How often the timer has come round.
static ROUNDS: AtomicU32 = AtomicU32::new(0);

/// The timer has come round. Always the same few instructions, in registers that the processor has put away.
#[unsafe(naked)]
#[unsafe(no_mangle)]
extern "C" fn SysTick() {
    naked_asm!(
        "ldr r0, 1f",
        "ldr r1, [r0]",
        "adds r1, #1",
        "str r1, [r0]",
        "bx lr",
        ".p2align 2",
        "1: .word {rounds}",
        rounds = sym ROUNDS,
    )
}

/// Reads the timer, calls [`CALLEE`], reads the timer, stores both readings.
#[unsafe(naked)]
extern "C" fn trampoline() {
    naked_asm!(
        "push {{r4, r5, r6, lr}}",
        "ldr r4, 1f",
        "ldr r6, [r4]",
        "ldr r4, 2f",
        "ldr r5, [r4]",
        "blx r6",
        "ldr r6, [r4]",
        "ldr r4, 3f",
        "str r5, [r4]",
        "str r6, [r4, #4]",
        "pop {{r4, r5, r6, pc}}",
        ".p2align 2",
        "1: .word {callee}",
        // SYST_CVR, the timer's current value.
        "2: .word 0xE000E018",
        "3: .word {readings}",
        callee = sym CALLEE,
        readings = sym READINGS,
    )
}

/// One instruction: the return.
#[unsafe(naked)]
extern "C" fn returns() {
    naked_asm!("bx lr")
}

/// 1001 instructions.
#[unsafe(naked)]
extern "C" fn thousand() {
    naked_asm!(".rept 1000", "nop", ".endr", "bx lr")
}

/// 12 000 002 instructions: the timer comes round at least once.
#[unsafe(naked)]
extern "C" fn turns() {
    naked_asm!("ldr r0, 2f", "1: subs r0, #1", "nop", "bne 1b", "bx lr", ".p2align 2", "2: .word 4000000")
}

/// The timer of this board.
pub(super) struct Clock {
    timer: RefCell<SYST>,
    board: &'static Board,
    /// Instructions between the two readings that are not the callee's.
    around: u32,
}

impl Clock {
    /// Starts the timer and checks that it counts instructions; `None` when it does not, as on real silicon or in an
    /// emulator that counts another time.
    pub(super) fn start(mut timer: SYST) -> Option<Self> {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(FULL);
        timer.enable_interrupt();
        timer.enable_counter();
        let board = board::named(super::board())?;
        let mut clock = Self { timer: RefCell::new(timer), board, around: 0 };
        clock.around = clock.of(returns as extern "C" fn() as usize, || trampoline()) - 1;
        let exact = clock.of(returns as extern "C" fn() as usize, || trampoline()) == 1
            && clock.of(thousand as extern "C" fn() as usize, || trampoline()) == 1001
            && clock.of(turns as extern "C" fn() as usize, || trampoline()) == 12_000_002;
        exact.then_some(clock)
    }

    /// The instructions of `function`, from its first to its return, which `call` calls through [`trampoline`].
    fn of(&self, function: usize, call: impl FnOnce()) -> u32 {
        CALLEE.store(function, Ordering::Relaxed);
        // From here on the timer comes round for the first time when it has counted all the way down.
        self.timer.borrow_mut().clear_current();
        ROUNDS.store(0, Ordering::Relaxed);
        call();
        let rounds = ROUNDS.load(Ordering::Relaxed);
        let [before, after] = READINGS.each_ref().map(|x| u64::from(x.load(Ordering::Relaxed)));
        let ticks = u64::from(rounds) * (u64::from(FULL) + 1) + before - after;
        let second = 1_000_000_000;
        let tick = u64::from(self.board.clock) * INSTRUCTION;
        let instructions = (ticks * second + tick / 2) / tick;
        u32::try_from(instructions).unwrap_or(u32::MAX) - self.around - rounds * HANDLER
    }

    /// Calls `function`; gives what it gives and the number of its instructions.
    #[inline(never)]
    pub(super) fn count<A, B, C, R>(
        &self,
        function: fn(&A, &mut B, &C) -> R,
        a: &A,
        b: &mut B,
        c: &C,
    ) -> (R, u32) {
        // SAFETY: the trampoline keeps arguments and result in the registers where the call has put them, three addresses
        // and that of a large result: none is on the stack. It calls `function`, whose signature this is.
        let through = unsafe {
            core::mem::transmute::<extern "C" fn(), fn(&A, &mut B, &C) -> R>(trampoline as extern "C" fn())
        };
        let mut result = None;
        let count = self.of(function as usize, || result = Some(core::hint::black_box(through)(a, b, c)));
        match result {
            Some(result) => (result, count),
            None => unreachable!("the call has been made"),
        }
    }
}
