//! Handing a law, whole, from one context to an interrupt.

use core::cell::Cell;
use critical_section::Mutex;

/// A place for one value that the main context writes and an interrupt reads, always whole, never half changed.
///
/// A new law is built and checked where there is time, published, and adopted by the control task at the start of a
/// sample. Each publication has a generation number, so that the reader copies only what it has not seen.
/// Cost: a critical section around one copy of `L`; [`take_newer`](Self::take_newer) without news costs one compare in
/// it.
///
/// ```
/// use controller_core::{ParamCell, Pid, PidConfig};
/// let law = |kp| Pid::<f32>::new(&PidConfig { kp, ..PidConfig::default() }, 0.01).unwrap();
/// static CELL: ParamCell<Pid<f32>> = ParamCell::new();
/// CELL.publish(law(1.0));
/// let mut seen = 0;
/// assert_eq!(CELL.take_newer(&mut seen), Some(law(1.0)));
/// assert_eq!(CELL.take_newer(&mut seen), None);
/// CELL.publish(law(2.0));
/// assert_eq!(CELL.take_newer(&mut seen), Some(law(2.0)));
/// ```
pub struct ParamCell<L> {
    place: Mutex<Place<L>>,
}

struct Place<L> {
    law: Cell<Option<L>>,
    generation: Cell<u32>,
}

impl<L: Copy> ParamCell<L> {
    /// An empty cell: generation 0.
    #[must_use]
    pub const fn new() -> Self {
        Self { place: Mutex::new(Place { law: Cell::new(None), generation: Cell::new(0) }) }
    }

    /// Replaces the value; returns its generation, which is never 0.
    pub fn publish(&self, law: L) -> u32 {
        critical_section::with(|cs| {
            let place = self.place.borrow(cs);
            let generation = place.generation.get().wrapping_add(1).max(1);
            place.law.set(Some(law));
            place.generation.set(generation);
            generation
        })
    }

    /// The value, if its generation is not `seen`; `seen` becomes its generation. Start with `seen = 0`.
    pub fn take_newer(&self, seen: &mut u32) -> Option<L> {
        critical_section::with(|cs| {
            let place = self.place.borrow(cs);
            let generation = place.generation.get();
            if generation == *seen {
                return None;
            }
            *seen = generation;
            place.law.get()
        })
    }
}

impl<L: Copy> Default for ParamCell<L> {
    fn default() -> Self {
        Self::new()
    }
}
