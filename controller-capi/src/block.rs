//! The caller's memory: layout, checks, where the delay memory is.
//!
//! ```text
//! Header | last output | law and state (without or with a compensator) | room | delay memory
//! ```
//! The delay memory begins at [`Number::SIZE_WITH_COMPENSATOR`]. What stands in a block between two calls is no address: the law's state
//! gets that of the delay memory at the beginning of a call and loses it at the end.
//!
//! Between two calls anything may happen to the memory. So no type in it has bytes that are no value of it, and the core has
//! no operation that some number makes dangerous: whatever is found, a call reads and writes the block alone. The header
//! carries sums over itself and over the law, which each call compares; in the state a call finds numbers that are not finite.

use crate::fault::Error;
use crate::header::{self, Header, Kind};
use crate::io::Output;
use controller_core::{AnyCompensator, Compensate, Controller, ControllerState, NoCompensator, Real};
use core::ffi::c_void;

/// Alignment of every block \[bytes\].
pub(crate) const ALIGN: usize = 8;

/// Longest delay of a block in samples.
pub const MAX_DELAY: u32 = (1 << 24) - 1;

/// The number types, with what the header says of their blocks.
pub trait Number: Real {
    /// First word of an initialised block.
    const MAGIC: u32;
    /// The exponent in the last word of a number: all of it is set when the number is not finite.
    const EXPONENT: u32;
    /// Size of a block without a compensator \[bytes\].
    const SIZE_WITHOUT_COMPENSATOR: usize;
    /// Size of a block with a compensator but for its delay memory \[bytes\].
    const SIZE_WITH_COMPENSATOR: usize;
}

impl Number for f32 {
    const MAGIC: u32 = 0x4654_4C43;
    const EXPONENT: u32 = 0x7F80_0000;
    const SIZE_WITHOUT_COMPENSATOR: usize = 352;
    const SIZE_WITH_COMPENSATOR: usize = 832;
}

impl Number for f64 {
    const MAGIC: u32 = 0x4454_4C43;
    const EXPONENT: u32 = 0x7FF0_0000;
    const SIZE_WITHOUT_COMPENSATOR: usize = 640;
    const SIZE_WITH_COMPENSATOR: usize = 1472;
}

const _: () = assert!(fits::<f32>() && fits::<f64>());
const _: () = assert!(any_bits::<f32>() && any_bits::<f64>());

/// Whether every bit pattern of a block is a value of its types: else `None` would be one that is not, and take no room.
const fn any_bits<T: Number>() -> bool {
    size_of::<Option<Fixed<T, NoCompensator>>>() > size_of::<Fixed<T, NoCompensator>>()
        && size_of::<Option<Fixed<T, Delayed<T>>>>() > size_of::<Fixed<T, Delayed<T>>>()
}

const fn fits<T: Number>() -> bool {
    size_of::<Fixed<T, NoCompensator>>() <= T::SIZE_WITHOUT_COMPENSATOR
        && size_of::<Fixed<T, Delayed<T>>>() <= T::SIZE_WITH_COMPENSATOR
        && align_of::<Fixed<T, NoCompensator>>() <= ALIGN
        && align_of::<Fixed<T, Delayed<T>>>() <= ALIGN
        && T::SIZE_WITHOUT_COMPENSATOR < T::SIZE_WITH_COMPENSATOR
        && T::SIZE_WITH_COMPENSATOR.is_multiple_of(ALIGN)
}

/// Size of a block for up to `delay` samples of dead time and latency \[bytes\]; 0 when there is no such block.
pub(crate) const fn size<T: Number>(delay: u32) -> usize {
    if delay > MAX_DELAY {
        return 0;
    }
    let cells = (delay as usize + 1) * size_of::<T>();
    T::SIZE_WITH_COMPENSATOR + cells.next_multiple_of(ALIGN)
}

/// Cells of delay memory in a block of `size` bytes; at most those of [`MAX_DELAY`].
pub(crate) fn cells_in<T: Number>(size: usize) -> u32 {
    let bytes = size.saturating_sub(T::SIZE_WITH_COMPENSATOR);
    let cells = bytes.checked_div(size_of::<T>()).unwrap_or(0);
    u32::try_from(cells).map_or(MAX_DELAY + 1, |cells| cells.min(MAX_DELAY + 1))
}

/// Delay memory somewhere else.
#[derive(Debug, Clone)]
pub(crate) struct Cells<T> {
    start: *mut T,
    count: usize,
}

impl<T> Cells<T> {
    /// No cells, no address.
    const NONE: Self = Self { start: core::ptr::null_mut(), count: 0 };

    /// # Safety
    /// As long as this value, or a clone of it, is used as a slice, `count` initialised cells must begin at `start`, and nothing
    /// else may read or write them meanwhile.
    const unsafe fn new(start: *mut T, count: usize) -> Self {
        Self { start, count }
    }
}

impl<T> AsRef<[T]> for Cells<T> {
    fn as_ref(&self) -> &[T] {
        if self.count == 0 {
            return &[];
        }
        // SAFETY: by the contract of `new`.
        unsafe { core::slice::from_raw_parts(self.start, self.count) }
    }
}

impl<T> AsMut<[T]> for Cells<T> {
    fn as_mut(&mut self) -> &mut [T] {
        if self.count == 0 {
            return &mut [];
        }
        // SAFETY: by the contract of `new`. A clone exists only within a call of the core, which never holds slices of both.
        unsafe { core::slice::from_raw_parts_mut(self.start, self.count) }
    }
}

/// The compensator of a block that has one.
pub(crate) type Delayed<T> = AnyCompensator<T, Cells<T>>;

/// A law and its state.
pub(crate) struct Loop<T: Real, C: Compensate<T>> {
    pub(crate) law: Controller<T, C>,
    pub(crate) state: ControllerState<T, C::State>,
}

/// The part of a block that has one size.
#[repr(C)]
struct Fixed<T: Real, C: Compensate<T>> {
    header: Header,
    last: Output<T>,
    looped: Loop<T, C>,
}

/// Stands for the library that writes blocks, and for the sizes of their parts.
const fn build<T: Number>() -> u32 {
    header::build([size_of::<Fixed<T, NoCompensator>>(), size_of::<Fixed<T, Delayed<T>>>()])
}

/// Which block a call is about: an address that is aligned and not null.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Memory {
    start: *mut u8,
}

impl Memory {
    /// # Errors
    /// A null pointer, an address that is not aligned.
    pub(crate) fn new(state: *mut c_void) -> Result<Self, Error> {
        check_pointer(state, ALIGN)?;
        Ok(Self { start: state.cast() })
    }

    fn at<V>(&self, offset: usize) -> *mut V {
        self.start.wrapping_add(offset).cast()
    }

    /// Writes a whole block.
    ///
    /// # Safety
    /// The memory is the caller's to write, and large enough for the kind of loop; its cells have been cleared.
    pub(crate) unsafe fn write<T: Number, C: Compensate<T>>(
        self,
        mut header: Header,
        last: Output<T>,
        looped: Loop<T, C>,
    ) {
        header.law = looped.law.checksum().value();
        // SAFETY: aligned by `new`, large enough by the caller.
        unsafe { self.at::<Fixed<T, C>>(0).write(Fixed { header, last, looped }) };
    }

    /// The cells of delay memory, all zero.
    ///
    /// # Safety
    /// The memory is the caller's to write and has room for so many cells. The cells must not be used after this call.
    pub(crate) unsafe fn clear_cells<T: Number>(self, count: u32) -> Cells<T> {
        let start: *mut T = self.at(T::SIZE_WITH_COMPENSATOR);
        let count = count as usize;
        // SAFETY: room by the caller, aligned since the offset is a multiple of the block's alignment; zero bytes are 0.0.
        unsafe {
            start.write_bytes(0, count);
            Cells::new(start, count)
        }
    }
}

/// # Errors
/// A null pointer, an address that is no multiple of `align`.
pub(crate) fn check_pointer<V>(pointer: *const V, align: usize) -> Result<(), Error> {
    if pointer.is_null() {
        Err(Error::Null)
    } else if pointer.addr() & (align - 1) != 0 {
        Err(Error::Align)
    } else {
        Ok(())
    }
}

/// An initialised block in the hands of one call.
pub(crate) struct Block<T> {
    memory: Memory,
    kind: Kind,
    cells: u32,
    number: core::marker::PhantomData<T>,
}

/// The loop of a block, whichever it is.
pub(crate) enum Either<P, C> {
    Plain(P),
    Compensated(C),
}

impl<T: Number> Block<T> {
    /// # Errors
    /// Those of [`find`](Self::find), and a damaged law.
    ///
    /// # Safety
    /// As for [`find`](Self::find).
    pub(crate) unsafe fn open(state: *mut c_void, size: usize) -> Result<Self, Error> {
        // SAFETY: by the caller.
        let mut block = unsafe { Self::find(state, size) }?;
        if block.law_sum() != block.header().law {
            return Err(Error::Damaged);
        }
        Ok(block)
    }

    /// Null, alignment, size, not initialised, another version.
    ///
    /// # Safety
    /// `size` bytes at `state` are the caller's to read and write and are not used by anybody else meanwhile.
    pub(crate) unsafe fn find(state: *mut c_void, size: usize) -> Result<Self, Error> {
        let memory = Memory::new(state)?;
        if size < T::SIZE_WITHOUT_COMPENSATOR {
            return Err(Error::Size);
        }
        // SAFETY: aligned, and large enough for a header; any bytes are a header.
        let header = unsafe { memory.at::<Header>(0).read() };
        if header.magic != T::MAGIC || !header.is_intact() {
            return Err(Error::NotInitialised);
        }
        if header.build != build::<T>() {
            return Err(Error::Version);
        }
        let kind = match header.kind {
            1 => Kind::Plain,
            2 if header.cells > 0 => Kind::Compensated,
            _ => return Err(Error::NotInitialised),
        };
        // A block without a compensator may get one, in the room it had at `init`.
        if cells_in::<T>(size) < header.cells {
            return Err(Error::Size);
        }
        Ok(Self { memory, kind, cells: header.cells, number: core::marker::PhantomData })
    }

    #[inline(never)]
    fn law_sum(&self) -> u32 {
        match self.kind {
            Kind::Plain => {
                let offset = core::mem::offset_of!(Fixed<T, NoCompensator>, looped);
                // SAFETY: within the size that `find` has checked; any bits are a loop.
                unsafe { (*self.memory.at::<Loop<T, NoCompensator>>(offset)).law.checksum() }
            }
            Kind::Compensated => {
                let offset = core::mem::offset_of!(Fixed<T, Delayed<T>>, looped);
                // SAFETY: as above.
                unsafe { (*self.memory.at::<Loop<T, Delayed<T>>>(offset)).law.checksum() }
            }
        }
        .value()
    }

    /// After a swap of the law.
    pub(crate) fn seal(&mut self) {
        let law = self.law_sum();
        self.header().law = law;
    }

    /// Makes the sum of the law one that no call accepts, until the block is initialised again.
    pub(crate) fn condemn(&mut self) {
        let law = self.law_sum();
        self.header().law = !law;
    }

    /// A sum over state and delay memory, and the law's.
    pub(crate) fn sums(&mut self) -> [u32; 2] {
        [self.with(|l| l.state_sum(), |l| l.state_sum()), self.header().law]
    }

    /// Whose block it is, for a header.
    pub(crate) const MARKS: [u32; 2] = [T::MAGIC, build::<T>()];

    pub(crate) fn memory(&self) -> Memory {
        self.memory
    }

    pub(crate) fn kind(&self) -> Kind {
        self.kind
    }

    /// Cells of delay memory.
    pub(crate) fn cells(&self) -> u32 {
        self.cells
    }

    pub(crate) fn header(&mut self) -> &mut Header {
        // SAFETY: by the contract of `find`; the header is at the beginning of either kind.
        unsafe { &mut *self.memory.at::<Header>(0) }
    }

    /// What the last step gave; its place is that of either kind, as the header alone is before it.
    fn place_of_last(&self) -> *mut Output<T> {
        self.memory.at(core::mem::offset_of!(Fixed<T, NoCompensator>, last))
    }

    pub(crate) fn last(&self) -> Output<T> {
        // SAFETY: by the contract of `find`.
        unsafe { self.place_of_last().read() }
    }

    pub(crate) fn set_last(&mut self, last: Output<T>) {
        // SAFETY: by the contract of `find`.
        unsafe { self.place_of_last().write(last) };
    }

    /// Runs one of the two functions on the block's loop, with its delay memory in place.
    pub(crate) fn with<V>(
        &mut self,
        plain: impl FnOnce(&mut Loop<T, NoCompensator>) -> V,
        compensated: impl FnOnce(&mut Loop<T, Delayed<T>>) -> V,
    ) -> V {
        match self.kind {
            Kind::Plain => {
                let offset = core::mem::offset_of!(Fixed<T, NoCompensator>, looped);
                // SAFETY: within the size that `find` has checked; any bits are a loop.
                plain(unsafe { &mut *self.memory.at(offset) })
            }
            Kind::Compensated => {
                let offset = core::mem::offset_of!(Fixed<T, Delayed<T>>, looped);
                let cells: *mut T = self.memory.at(T::SIZE_WITH_COMPENSATOR);
                // SAFETY: as above; the cells, which are numbers whatever their bits, are behind the loop and used only
                // through it, in this call.
                let (looped, cells): (&mut Loop<T, Delayed<T>>, _) =
                    unsafe { (&mut *self.memory.at(offset), Cells::new(cells, self.cells as usize)) };
                let _ = looped.state.compensator_mut().replace_memory(cells);
                let result = compensated(looped);
                let _ = looped.state.compensator_mut().replace_memory(Cells::NONE);
                result
            }
        }
    }

    /// Takes the loop out of the block, which must be written anew.
    pub(crate) fn take(&mut self) -> Either<Loop<T, NoCompensator>, Loop<T, Delayed<T>>> {
        match self.kind {
            Kind::Plain => {
                let offset = core::mem::offset_of!(Fixed<T, NoCompensator>, looped);
                // SAFETY: as in `with`; the loop owns nothing, so a copy of its bytes is one more loop.
                Either::Plain(unsafe { self.memory.at::<Loop<T, NoCompensator>>(offset).read() })
            }
            Kind::Compensated => {
                let offset = core::mem::offset_of!(Fixed<T, Delayed<T>>, looped);
                // SAFETY: as above.
                Either::Compensated(unsafe { self.memory.at::<Loop<T, Delayed<T>>>(offset).read() })
            }
        }
    }
}

/// A cleared memory for a state that is stored.
pub(crate) fn without_address<T: Number>(looped: &mut Loop<T, Delayed<T>>) {
    let _ = looped.state.compensator_mut().replace_memory(Cells::NONE);
}
