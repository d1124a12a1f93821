//! One sample as bytes: what a controller reads and what it gives.

use crate::frame::{Reader, Writer};
use controller_core::{ControllerInput, ControllerOutput, Mode, Quality, Real, Status};

/// Most bytes of an output.
pub const OUTPUT: usize = 7 * 8 + 6;

/// Bits of the flags of an input, in the order of [`flags`].
const INPUT_FLAGS: usize = 6;

/// The output's parts in the order of the bytes, with the name of each.
pub const FIELDS: [&str; 10] = ["u", "v", "i", "pd", "u_f", "d_hat", "r", "blocked", "mode", "status"];

/// One number.
pub fn write_number<T: Real>(x: T, to: &mut Writer<'_>) {
    for word in x.to_words().iter().take(T::WORDS) {
        to.u32(*word);
    }
}

/// One number.
pub fn read_number<T: Real>(from: &mut Reader<'_>) -> Option<T> {
    let low = from.u32()?;
    let high = if T::WORDS == 2 { from.u32()? } else { 0 };
    Some(T::from_words([low, high]))
}

/// `N` numbers.
pub fn read_numbers<T: Real, const N: usize>(from: &mut Reader<'_>) -> Option<[T; N]> {
    let mut list = [T::ZERO; N];
    for x in &mut list {
        *x = read_number(from)?;
    }
    Some(list)
}

fn flags<T>(input: &ControllerInput<T>) -> [bool; INPUT_FLAGS] {
    [
        input.manual.is_some(),
        input.u_applied.is_some(),
        input.compensate,
        input.inhibit_up,
        input.inhibit_down,
        input.acknowledge,
    ]
}

/// An input: seven numbers, flags, quality, mode.
pub fn write_input<T: Real>(input: &ControllerInput<T>, to: &mut Writer<'_>) {
    let absent = |x: Option<T>| x.unwrap_or(T::ZERO);
    let i = input;
    for x in [i.r, i.r_remote, i.y, absent(i.manual), i.track, i.offset, absent(i.u_applied)] {
        write_number(x, to);
    }
    to.u8(flags(input).iter().enumerate().fold(0, |bits, (i, &flag)| bits | u8::from(flag) << i));
    to.u8(input.quality as u8);
    to.u8(input.mode as u8);
}

/// An input; `None`: too short, or a number that stands for nothing.
pub fn read_input<T: Real>(from: &mut Reader<'_>) -> Option<ControllerInput<T>> {
    let [r, r_remote, y, manual, track, offset, u_applied] = read_numbers(from)?;
    let bits = from.u8()?;
    if bits >> INPUT_FLAGS != 0 {
        return None;
    }
    let flag = |i: u8| bits >> i & 1 == 1;
    let quality = match from.u8()? {
        0 => Quality::Good,
        1 => Quality::Uncertain,
        2 => Quality::Bad,
        _ => return None,
    };
    Some(ControllerInput {
        r,
        r_remote,
        y,
        quality,
        mode: Mode::from_number(from.u8()?)?,
        manual: flag(0).then_some(manual),
        track,
        offset,
        u_applied: flag(1).then_some(u_applied),
        compensate: flag(2),
        inhibit_up: flag(3),
        inhibit_down: flag(4),
        acknowledge: flag(5),
    })
}

/// An output: seven numbers, where it is blocked, mode, status.
pub fn write_output<T: Real>(output: &ControllerOutput<T>, to: &mut Writer<'_>) {
    let o = output;
    for x in [o.u, o.v, o.i, o.pd, o.u_f, o.d_hat, o.r] {
        write_number(x, to);
    }
    to.u8(u8::from(o.blocked_up) | u8::from(o.blocked_down) << 1);
    to.u8(o.mode as u8);
    to.u32(o.status.bits());
}

/// An output; `None`: too short, or a number that stands for nothing.
pub fn read_output<T: Real>(from: &mut Reader<'_>) -> Option<ControllerOutput<T>> {
    let [u, v, i, pd, u_f, d_hat, r] = read_numbers(from)?;
    let blocked = from.u8()?;
    if blocked > 3 {
        return None;
    }
    let (blocked_up, blocked_down) = (blocked & 1 == 1, blocked & 2 == 2);
    let mode = Mode::from_number(from.u8()?)?;
    let status = Status::from_bits(from.u32()?);
    Some(ControllerOutput { u, v, i, pd, u_f, d_hat, r, blocked_up, blocked_down, mode, status })
}

/// The first part in which two outputs differ, and the bits of both; `size` is that of a number. Outputs as bytes.
///
/// ```
/// use controller_core::ControllerOutput;
/// use controller_pil::frame::Writer;
/// use controller_pil::sample::{OUTPUT, difference, write_output};
/// let bytes = |u: f32| {
///     let mut bytes = [0; OUTPUT];
///     write_output(&ControllerOutput { u, ..ControllerOutput::default() }, &mut Writer::new(&mut bytes));
///     bytes
/// };
/// assert_eq!(difference(&bytes(1.0), &bytes(1.0), 4), None);
/// assert_eq!(difference(&bytes(0.0), &bytes(-0.0), 4), Some(("u", 0, 0x8000_0000)));
/// ```
#[must_use]
pub fn difference(a: &[u8], b: &[u8], size: usize) -> Option<(&'static str, u64, u64)> {
    let sizes = [size, size, size, size, size, size, size, 1, 1, 4];
    let mut at = 0;
    for (name, size) in FIELDS.into_iter().zip(sizes) {
        let bits = |bytes: &[u8]| {
            let part = bytes.get(at..at + size).unwrap_or_default();
            part.iter().rev().fold(0_u64, |bits, &byte| bits << 8 | u64::from(byte))
        };
        let pair = (bits(a), bits(b));
        if pair.0 != pair.1 {
            return Some((name, pair.0, pair.1));
        }
        at += size;
    }
    None
}
