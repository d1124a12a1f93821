//! Saving and restoring a block: the modes that were asked for, then the core's snapshot of the state.
//!
//! Word 0: the format. Word 1: kind of loop and modes. Word 2: the complement of word 1. Then the core's words, which carry
//! their own version, shape and checksum.

use crate::block::{Block, Loop, MAX_DELAY, Number, check_pointer};
use crate::fault::Error;
use crate::header::Kind;
use crate::io::{Output, mode};
use controller_core::{Compensate, Controller, Real, SnapshotError};
use core::cell::Cell;
use core::ffi::c_void;

/// `CT`, `L`, version 1.
const FORMAT: u32 = 0x4354_4C01;
/// Words before those of the core.
const FRAME: usize = 3;

// The core numbers the words of a snapshot with 28 bits. Two for each cell, and more than those of every other number.
const _: () = assert!(2 * (MAX_DELAY as usize + 1) + 1024 < 1 << 28);

type Done = Result<(), Error>;

impl<T: Real, C: Compensate<T>> Loop<T, C> {
    fn words(&self) -> usize {
        Controller::<T, C>::snapshot_words(&self.state)
    }

    fn save(&self, words: &mut [u32]) -> Result<(), SnapshotError> {
        self.law.save(&self.state, words).map(|_| ())
    }

    fn restore(&mut self, words: &[u32]) -> Result<Output<T>, SnapshotError> {
        self.law.restore(&mut self.state, words).map(|()| self.at_rest())
    }
}

fn words<T: Number>(block: &mut Block<T>) -> usize {
    FRAME + block.with(|l| l.words(), |l| l.words())
}

/// # Safety
/// As for [`Block::open`]; `count` is null or the caller's to write.
pub(crate) unsafe fn count<T: Number>(state: *mut c_void, size: usize, count: *mut usize) -> Done {
    check_pointer(count, align_of::<usize>())?;
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    // SAFETY: not null, aligned, the caller's.
    unsafe { count.write(words(&mut block)) };
    Ok(())
}

/// # Safety
/// As for [`Block::open`]; `to` is null or `capacity` words of the caller's to write, and so is `written`.
pub(crate) unsafe fn save<T: Number>(
    state: *mut c_void,
    size: usize,
    to: *mut u32,
    capacity: usize,
    written: *mut usize,
) -> Done {
    check_pointer(to, align_of::<u32>())?;
    check_pointer(written, align_of::<usize>())?;
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    let total = words(&mut block);
    if capacity < total {
        return Err(Error::Buffer);
    }
    // From here nothing fails, as an error must leave the words alone: the core refuses a list that is shorter than what it has
    // counted above, and more words than any block has.
    // SAFETY: so many words are the caller's; they are written before they are looked at.
    let list = unsafe {
        to.write_bytes(0, total);
        core::slice::from_raw_parts_mut(to, total)
    };
    let (set, asked) = (block.header().set, block.header().asked);
    let modes = (block.kind() as u32) << 16 | byte(asked) << 8 | byte(set);
    if let Some((frame, state)) = list.split_first_chunk_mut::<FRAME>() {
        *frame = [FORMAT, modes, !modes];
        // One of the two takes it.
        let room = Cell::new(state);
        block.with(|l| l.save(room.take()), |l| l.save(room.take()))?;
    }
    // SAFETY: not null, aligned, the caller's.
    unsafe { written.write(total) };
    Ok(())
}

fn byte(number: i32) -> u32 {
    u32::from(number.to_le_bytes()[0])
}

/// # Safety
/// As for [`Block::open`]; `from` is null or `count` words.
pub(crate) unsafe fn restore<T: Number>(
    state: *mut c_void,
    size: usize,
    from: *const u32,
    count: usize,
) -> Done {
    check_pointer(from, align_of::<u32>())?;
    // SAFETY: by the caller.
    let mut block = unsafe { Block::<T>::open(state, size) }?;
    let total = words(&mut block);
    // SAFETY: so many words are the caller's to read.
    let list = unsafe { core::slice::from_raw_parts(from, count.min(total)) };
    let (&[format, modes, complement], state) = list.split_first_chunk::<FRAME>().ok_or(Error::Buffer)?;
    if format != FORMAT {
        return Err(Error::SnapshotVersion);
    }
    if modes != !complement {
        return Err(Error::SnapshotChecksum);
    }
    let [set, asked, kind, rest] = modes.to_le_bytes();
    if u32::from(kind) != block.kind() as u32 || rest != 0 {
        return Err(Error::SnapshotShape);
    }
    // The core reads its version and shape from two words.
    if state.len() < 2 {
        return Err(Error::Buffer);
    }
    let known = |number: u8| mode::requested(number.into()).map(mode::number).ok_or(Error::SnapshotInvalid);
    let (set, asked) = (known(set)?, known(asked)?);
    let last = block.with(|l| l.restore(state), |l| l.restore(state))?;
    block.set_last(last);
    let header = block.header();
    (header.set, header.asked) = (set, asked);
    Ok(())
}

const _: () = assert!(Kind::Plain as u32 != 0 && (Kind::Compensated as u32) < 256);
