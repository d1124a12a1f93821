//! A delay line over memory that the caller chooses.

use crate::real::Real;

/// Memory of a delay line: an array in firmware, a borrowed slice behind a C interface, a vector on a host.
///
/// Implemented for everything that can be seen as a slice of numbers.
pub trait Memory<T>: AsRef<[T]> + AsMut<[T]> {}

impl<T, M: AsRef<[T]> + AsMut<[T]>> Memory<T> for M {}

/// The last samples of a signal, newest first: one write and one read per sample.
///
/// Law: `tap(n)` after `push(x[k])` is `x[k-n]`. The length in use and the capacity are two numbers: any
/// `n < capacity` may be read, so a dead time can change while the line keeps its history.
/// Source: own. Cost: one write to push, one read to tap, a few compares, whatever the capacity; no division, no panic
/// path.
///
/// ```
/// use controller_core::DelayLine;
/// let mut line = DelayLine::new([0.0_f32; 4]);
/// for x in [1.0, 2.0, 3.0] {
///     line.push(x);
/// }
/// assert_eq!((line.tap(0), line.tap(2), line.tap(3)), (3.0, 1.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DelayLine<M> {
    memory: M,
    newest: usize,
}

impl<M> DelayLine<M> {
    /// A line over `memory`, whose contents are its history.
    #[must_use]
    pub const fn new(memory: M) -> Self {
        Self { memory, newest: 0 }
    }

    /// Adds the sample `x`; the oldest one is forgotten.
    #[inline(always)]
    pub fn push<T: Real>(&mut self, x: T)
    where
        M: Memory<T>,
    {
        let cells = self.memory.as_mut();
        // Wraps and adds so that no place, however it came about, does harm.
        let next = self.newest.wrapping_add(1);
        self.newest = if next >= cells.len() { 0 } else { next };
        if let Some(cell) = cells.get_mut(self.newest) {
            *cell = x;
        }
    }

    /// The sample pushed `n` pushes before the newest; beyond the capacity, the oldest one.
    #[must_use]
    #[inline(always)]
    pub fn tap<T: Real>(&self, n: usize) -> T
    where
        M: Memory<T>,
    {
        let cells = self.memory.as_ref();
        // Selects, no branches: the same cost on every call.
        let oldest = cells.len().wrapping_sub(1);
        let n = if n < oldest { n } else { oldest };
        let from = if n <= self.newest { self.newest } else { self.newest.wrapping_add(cells.len()) };
        let index = from.wrapping_sub(n);
        cells.get(index).copied().unwrap_or_default()
    }

    /// Makes the whole history equal to `x`. Cost: one write per cell.
    pub fn fill<T: Real>(&mut self, x: T)
    where
        M: Memory<T>,
    {
        for cell in self.memory.as_mut() {
            *cell = x;
        }
    }

    /// Number of samples the line can hold.
    #[must_use]
    pub fn capacity<T: Real>(&self) -> usize
    where
        M: Memory<T>,
    {
        self.memory.as_ref().len()
    }

    /// The cells and the place of the newest sample, for a snapshot.
    pub(crate) fn parts(&self) -> (&M, usize) {
        (&self.memory, self.newest)
    }

    /// Mutable access for restoring a snapshot; `newest` must be below the capacity.
    pub(crate) fn parts_mut(&mut self) -> (&mut M, &mut usize) {
        (&mut self.memory, &mut self.newest)
    }
}
