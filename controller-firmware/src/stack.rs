//! How much stack was used, by the paint that start-up covers it with.

use core::arch::asm;
use cortex_m_rt::STACK_PAINT_VALUE;

/// How far below its caller [`used_by`] looks \[bytes\].
const DEPTH: usize = 12 * 1024;

/// The most stack that was in use since the start \[bytes\]: what is no longer painted. (A piece that [`used_by`] has
/// painted again does not count.)
#[must_use]
pub fn high_water() -> usize {
    let (end, start) = bounds();
    start - unpainted(end, start)
}

/// Whether the stack has been used to its last word, and perhaps beyond.
#[must_use]
pub fn is_exhausted() -> bool {
    let (end, _) = bounds();
    unpainted(end, end + 4) == end
}

/// The size of the stack \[bytes\].
#[must_use]
pub fn size() -> usize {
    let (end, start) = bounds();
    start - end
}

/// The stack that `work` uses, its return address included \[bytes\]; at most 12 KiB can be told. Interrupts wait.
#[inline(never)]
pub fn used_by(work: impl FnOnce()) -> usize {
    cortex_m::interrupt::free(|_| {
        let pointer: usize;
        // SAFETY: reads a register.
        unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags)) };
        let (end, _) = bounds();
        let floor = end.max(pointer - DEPTH);
        // SAFETY: what lies below the stack pointer belongs to nobody: there is no red zone on this architecture, nothing is
        // called in between and interrupts wait. `floor` is within the stack.
        unsafe {
            asm!(
                "2:",
                "str {paint}, [{at}]",
                "adds {at}, {at}, #4",
                "cmp {at}, {pointer}",
                "blo 2b",
                at = inout(reg) floor => _,
                paint = in(reg) STACK_PAINT_VALUE,
                pointer = in(reg) pointer,
                options(nostack),
            );
        }
        call(work);
        pointer - unpainted(floor, pointer)
    })
}

#[inline(never)]
fn call(work: impl FnOnce()) {
    work();
}

/// The first word in `from..to` that is not painted; `to` if all are.
fn unpainted(from: usize, to: usize) -> usize {
    let mut at = from;
    // SAFETY: the words lie within the stack; they are only looked at, by a volatile read, whatever they are.
    while at < to
        && unsafe { core::ptr::with_exposed_provenance::<u32>(at).read_volatile() } == STACK_PAINT_VALUE
    {
        at += 4;
    }
    at
}

/// The lowest and the highest address of the stack, by the linker.
fn bounds() -> (usize, usize) {
    unsafe extern "C" {
        static _stack_end: u32;
        static _stack_start: u32;
    }
    // Only their addresses mean anything.
    ((&raw const _stack_end).addr(), (&raw const _stack_start).addr())
}
