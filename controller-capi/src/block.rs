//! The caller's memory: layout, checks, where the delay memory is.
//!
//! ```text
//! Header | last output | law and state (without or with a compensator) | room | delay memory
//! ```
//! The delay memory begins at [`Number::SIZE_WITH_COMPENSATOR`]. What stands in a block between two calls is no address: the law's state
//! gets that of the delay memory at the beginning of a call and loses it at the end.

use crate::fault::Error;
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
    /// Size of a block without a compensator \[bytes\].
    const SIZE_WITHOUT_COMPENSATOR: usize;
    /// Size of a block with a compensator but for its delay memory \[bytes\].
    const SIZE_WITH_COMPENSATOR: usize;
}

impl Number for f32 {
    const MAGIC: u32 = 0x4654_4C43;
    const SIZE_WITHOUT_COMPENSATOR: usize = 352;
    const SIZE_WITH_COMPENSATOR: usize = 832;
}

impl Number for f64 {
    const MAGIC: u32 = 0x4454_4C43;
    const SIZE_WITHOUT_COMPENSATOR: usize = 640;
    const SIZE_WITH_COMPENSATOR: usize = 1472;
}

const _: () = assert!(fits::<f32>() && fits::<f64>());

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

/// Whether a block's loop has a compensator; the numbers stand in blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Kind {
    Plain = 1,
    Compensated = 2,
}

/// The beginning of a block.
#[repr(C, align(8))]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Header {
    magic: u32,
    /// Which library wrote the block: layout and meaning may differ in another one.
    build: u32,
    kind: u32,
    /// Cells of delay memory.
    cells: u32,
    /// Over the words before it.
    check: u32,
    /// The mode of `set_mode`.
    pub(crate) set: i32,
    /// The last mode that was asked for and known.
    pub(crate) asked: i32,
    reserved: i32,
}

/// The part of a block that has one size.
#[repr(C)]
struct Fixed<T: Real, C: Compensate<T>> {
    header: Header,
    last: Output<T>,
    looped: Loop<T, C>,
}

/// FNV-1a, 32 bits.
const fn hash(bytes: &[u8], mut hash: u32) -> u32 {
    let mut rest = bytes;
    while let [byte, others @ ..] = rest {
        hash = (hash ^ *byte as u32).wrapping_mul(0x0100_0193);
        rest = others;
    }
    hash
}

/// Stands for the library and the compiler that built it.
const fn build<T: Number>() -> u32 {
    let version = concat!(env!("CARGO_PKG_VERSION"), " ", env!("CTL_COMPILER"));
    let sizes = [size_of::<Fixed<T, NoCompensator>>(), size_of::<Fixed<T, Delayed<T>>>()];
    let [plain, compensated] = sizes;
    let seed = hash(version.as_bytes(), 0x811C_9DC5 ^ crate::ABI_VERSION);
    hash(&(compensated as u64).to_le_bytes(), hash(&(plain as u64).to_le_bytes(), seed))
}

impl Header {
    pub(crate) fn new<T: Number>(kind: Kind, cells: u32, mode: i32) -> Self {
        let header = Self {
            magic: T::MAGIC,
            build: build::<T>(),
            kind: kind as u32,
            cells,
            check: 0,
            set: mode,
            asked: mode,
            reserved: 0,
        };
        Self { check: header.sum(), ..header }
    }

    /// The same for a loop of this kind.
    pub(crate) fn of_kind(self, kind: Kind) -> Self {
        let header = Self { kind: kind as u32, ..self };
        Self { check: header.sum(), ..header }
    }

    fn sum(&self) -> u32 {
        let words = [self.magic, self.build, self.kind, self.cells];
        words.iter().fold(0x811C_9DC5, |sum, word| hash(&word.to_le_bytes(), sum))
    }
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
        header: Header,
        last: Output<T>,
        looped: Loop<T, C>,
    ) {
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
    /// Null, alignment, size, not initialised, another version.
    ///
    /// # Safety
    /// `size` bytes at `state` are the caller's to read and write and are not used by anybody else meanwhile. If they begin
    /// like an initialised block, they are one.
    pub(crate) unsafe fn open(state: *mut c_void, size: usize) -> Result<Self, Error> {
        let memory = Memory::new(state)?;
        if size < T::SIZE_WITHOUT_COMPENSATOR {
            return Err(Error::Size);
        }
        // SAFETY: aligned, and large enough for a header; any bytes are a header.
        let header = unsafe { memory.at::<Header>(0).read() };
        if header.magic != T::MAGIC || header.check != header.sum() {
            return Err(Error::NotInitialised);
        }
        if header.build != build::<T>() {
            return Err(Error::Version);
        }
        let kind = match header.kind {
            1 => Kind::Plain,
            2 => Kind::Compensated,
            _ => return Err(Error::NotInitialised),
        };
        // A block without a compensator may get one, in the room it had at `init`.
        if cells_in::<T>(size) < header.cells {
            return Err(Error::Size);
        }
        Ok(Self { memory, kind, cells: header.cells, number: core::marker::PhantomData })
    }

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
        // SAFETY: by the contract of `open`; the header is at the beginning of either kind.
        unsafe { &mut *self.memory.at::<Header>(0) }
    }

    /// What the last step gave; its place is that of either kind, as the header alone is before it.
    fn place_of_last(&self) -> *mut Output<T> {
        self.memory.at(core::mem::offset_of!(Fixed<T, NoCompensator>, last))
    }

    pub(crate) fn last(&self) -> Output<T> {
        // SAFETY: by the contract of `open`.
        unsafe { self.place_of_last().read() }
    }

    pub(crate) fn set_last(&mut self, last: Output<T>) {
        // SAFETY: by the contract of `open`.
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
                // SAFETY: by the contract of `open`, an initialised block of this kind.
                plain(unsafe { &mut *self.memory.at(offset) })
            }
            Kind::Compensated => {
                let offset = core::mem::offset_of!(Fixed<T, Delayed<T>>, looped);
                let cells: *mut T = self.memory.at(T::SIZE_WITH_COMPENSATOR);
                // SAFETY: by the contract of `open`; the cells, which `init` has written, are behind the loop and used only
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
                // SAFETY: by the contract of `open`; the loop owns nothing, so a copy of its bytes is one more loop.
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
