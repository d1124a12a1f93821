//! The memory of the function block: what it remembers itself, then the block of its loop.
//!
//! It may be at any address, aligned or not, and at another one in each call: an array of words in a runtime is moved, and
//! not every runtime aligns it. The contents begin at the first aligned address; where they are found elsewhere, they are
//! moved there first.
//!
//! Memory that is kept over a power failure may be half old and half new. So a sum over everything that the block remembers,
//! law and delay memory included, is taken at the end of each call and compared at the beginning of the next one.

use super::Number;
use super::parameters::Refusal;
use super::period::Watch;
use super::vars::{Choices, Flags, Parameters, Reports, Results, Settings, Switches};
use crate::block::{ALIGN, Block};
use crate::fault::Error;
use controller_core::Checksum;
use controller_core::snapshot::Words;
use core::ffi::c_void;

/// What the last sample gave; the calls without one give it again.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Given<T> {
    pub(crate) results: Results<T>,
    pub(crate) reports: Reports,
    pub(crate) flags: Flags,
}

/// A set of parameters that was refused: it is not tried again until it changes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Refused {
    /// Of its numbers; 0: the parameters are those in force.
    pub(crate) digest: u64,
    pub(crate) error: i32,
    pub(crate) refusal: Refusal,
}

/// What the block remembers between two calls, but for its loop.
#[repr(C, align(8))]
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Instance<T> {
    magic: u32,
    /// Its complement.
    seal: u32,
    /// Over everything else and over the loop, when the last call ended.
    sum: u32,
    /// So that a header may be read wherever it begins in the first 16 bytes: none of them is padding.
    spare: u32,
    /// The parameters in force.
    pub(crate) parameters: Parameters<T>,
    pub(crate) refused: Refused,
    pub(crate) watch: Watch,
    /// Calls since the law ran.
    pub(crate) since: u32,
    /// 1: the law has run.
    pub(crate) ran: u8,
    /// Not 0: seen since the law ran.
    pub(crate) ack: u8,
    pub(crate) restart: u8,
    /// 1: what was there before could not be used, and nobody has acknowledged it.
    pub(crate) lost: u8,
    pub(crate) given: Given<T>,
}

impl<T: Number> Instance<T> {
    pub(crate) fn new(parameters: Parameters<T>, lost: bool) -> Self {
        Self {
            magic: T::FB_MAGIC,
            seal: !T::FB_MAGIC,
            sum: 0,
            spare: 0,
            parameters,
            refused: Refused::default(),
            watch: Watch::default(),
            since: 0,
            ran: 0,
            ack: 0,
            restart: 0,
            lost: u8::from(lost),
            given: Given::default(),
        }
    }
}

impl<T: Number> Instance<T> {
    /// As zero bytes.
    fn nothing() -> Self {
        let parameters = Parameters {
            settings: Settings::default(),
            choices: Choices::default(),
            switches: Switches::default(),
        };
        Self { magic: 0, seal: 0, ..Self::new(parameters, false) }
    }

    /// A sum over what is remembered here and over the sums of the loop.
    fn checksum(&self, looped: [u32; 2]) -> u32 {
        let mut sum = Checksum::new();
        looped.iter().for_each(|&word| sum.word(word));
        let Parameters { settings, choices, switches } = &self.parameters;
        sum.numbers(settings.as_slice());
        choices.as_slice().iter().for_each(|n| sum.word(n.cast_unsigned()));
        switches.as_slice().iter().for_each(|&flag| sum.word(flag.into()));
        let Refused { digest, error, refusal } = self.refused;
        let half = |part: u64| u32::try_from(part & u64::from(u32::MAX)).unwrap_or_default();
        [half(digest), half(digest >> 32)].iter().for_each(|&word| sum.word(word));
        [error, refusal.param, refusal.reason].iter().for_each(|n| sum.word(n.cast_unsigned()));
        self.watch.write(&mut sum);
        sum.word(self.since);
        sum.word(u32::from_le_bytes([self.ran, self.ack, self.restart, self.lost]));
        let Given { results, reports, flags } = &self.given;
        sum.numbers(results.as_slice());
        reports.list().for_each(|n| sum.word(n));
        flags.as_slice().iter().for_each(|&flag| sum.word(flag.into()));
        sum.value()
    }

    /// At the end of a call; `looped` are the sums of the loop.
    pub(crate) fn close(&mut self, looped: [u32; 2]) {
        self.sum = self.checksum(looped);
    }
}

/// What is in the memory.
pub(crate) enum Contents {
    /// Zero bytes.
    Nothing,
    /// Something that this library has not written, or that has been damaged.
    Unknown,
    /// An instance and its loop.
    Running,
}

/// The caller's memory in one call.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// The first aligned address.
    start: *mut u8,
    /// Bytes of the loop's block.
    pub(crate) loop_size: usize,
}

impl Place {
    /// Finds the contents and brings them to their place.
    ///
    /// # Errors
    /// Null; too small for a loop without a compensator, or for the loop that is there.
    ///
    /// # Safety
    /// `size` bytes at `state` are the caller's to read and write and are not used by anybody else meanwhile.
    pub(crate) unsafe fn find<T: Number>(state: *mut c_void, size: usize) -> Result<(Self, Contents), Error> {
        if state.is_null() {
            return Err(Error::Null);
        }
        // What is left at every address.
        let usable = size.saturating_sub(ALIGN - 1) & !(ALIGN - 1);
        let loop_size = usable.saturating_sub(T::FB_FIXED);
        if loop_size < T::SIZE_WITHOUT_COMPENSATOR {
            return Err(Error::Size);
        }
        let memory: *mut u8 = state.cast();
        let offset = memory.addr().wrapping_neg() & (ALIGN - 1);
        let place = Self { start: memory.wrapping_add(offset), loop_size };
        // SAFETY: the offsets are less than what `usable` leaves, and a header is smaller than it. Any bits are two words. Where an
        // instance is, the search ends at its beginning and has read no more than 8 bytes of an address up to 7 behind it: none
        // of its padding, see `spare`. Everything else is bytes that came over the interface from a caller, who keeps
        // and copies them as bytes: whatever they are, they have values.
        let header = |at: usize| unsafe { memory.wrapping_add(at).cast::<[u32; 2]>().read_unaligned() };
        let Some(found) =
            core::iter::once(offset).chain(0..ALIGN).find(|&at| header(at) == [T::FB_MAGIC, !T::FB_MAGIC])
        else {
            // SAFETY: there is room for an instance and the beginning of a block; any bits are these. A comparison reads fields,
            // not what is between them, and the first word of a block is its header's.
            let nothing = unsafe {
                *place.instance::<T>() == Instance::nothing()
                    && place.loop_memory::<T>().cast::<u64>().read() == 0
            };
            return Ok((place, if nothing { Contents::Nothing } else { Contents::Unknown }));
        };
        if found != offset {
            // SAFETY: both are `usable` bytes within the `size` bytes of the caller; a copy of bytes takes padding as it is. What
            // the move leaves over is cleared, so that it is not found again.
            unsafe {
                memory.wrapping_add(found).copy_to(place.start, usable);
                let (rest, count) = if found < offset {
                    (memory.wrapping_add(found), offset - found)
                } else {
                    (place.start.wrapping_add(usable), found - offset)
                };
                rest.write_bytes(0, count);
            }
        }
        // SAFETY: by the caller, with the sizes checked above; any bits are an instance.
        let (block, instance) =
            unsafe { (Block::<T>::open(place.loop_memory::<T>(), loop_size), place.instance::<T>()) };
        match block.map(|mut block| block.sums()) {
            Ok(looped) if instance.sum == instance.checksum(looped) => Ok((place, Contents::Running)),
            Err(Error::Size) => Err(Error::Size),
            _ => Ok((place, Contents::Unknown)),
        }
    }

    /// The block of the loop.
    pub(crate) fn loop_memory<T: Number>(&self) -> *mut c_void {
        self.start.wrapping_add(T::FB_FIXED).cast()
    }

    /// # Safety
    /// As for [`find`](Self::find). One reference at a time.
    pub(crate) unsafe fn instance<'a, T: Number>(&self) -> &'a mut Instance<T> {
        // SAFETY: aligned, any bits are an instance, the rest by the caller.
        unsafe { &mut *self.start.cast::<Instance<T>>() }
    }

    /// # Safety
    /// As for [`find`](Self::find).
    pub(crate) unsafe fn write<T: Number>(&self, instance: Instance<T>) {
        // SAFETY: aligned, and there is room for it.
        unsafe { self.start.cast::<Instance<T>>().write(instance) }
    }
}

const _: () = assert!(core::mem::offset_of!(Instance<f32>, parameters) == 16);
const _: () = assert!(core::mem::offset_of!(Instance<f64>, parameters) == 16);
