//! Telemetry from an interrupt to the main context.

use crate::controller::{ControllerInput, ControllerOutput};
use crate::mode::Mode;
use crate::real::Real;
use crate::status::Status;
use core::cell::{Cell, RefCell};
use critical_section::Mutex;
use heapless::Deque;

/// A bounded queue of `N` records that the control task writes and the main context empties.
///
/// Writing never waits: a record that finds the queue full is dropped and counted, the older ones stay, so that what is
/// read is contiguous up to the gap (a sample number in the record shows where it is). Any number of writers and readers,
/// of any priority; it can be a `static` and needs no compare-and-swap, only loads and stores under a critical section.
/// Memory: `N` records and 5 words. Cost: one critical section around one copy of a record, whether the queue is full or
/// not; for a [`TraceSample`] of `f32`, 36 bytes, that is the time for which the reader can delay the control task.
///
/// ```
/// use controller_core::Trace;
/// static TRACE: Trace<(u32, f32), 2> = Trace::new();
/// // in the interrupt
/// assert!(TRACE.push((0, 1.5)));
/// assert!(TRACE.push((1, 1.6)));
/// assert!(!TRACE.push((2, 1.7))); // full: dropped, not overwritten
/// // in the main context
/// assert_eq!(TRACE.pop(), Some((0, 1.5)));
/// assert_eq!(TRACE.pop(), Some((1, 1.6)));
/// assert_eq!((TRACE.pop(), TRACE.dropped()), (None, 1));
/// ```
pub struct Trace<R, const N: usize> {
    place: Mutex<Place<R, N>>,
}

struct Place<R, const N: usize> {
    records: RefCell<Deque<R, N>>,
    dropped: Cell<u32>,
}

impl<R: Copy, const N: usize> Trace<R, N> {
    /// An empty queue.
    #[must_use]
    pub const fn new() -> Self {
        Self { place: Mutex::new(Place { records: RefCell::new(Deque::new()), dropped: Cell::new(0) }) }
    }

    /// Appends a record; `false`: the queue was full, the record is dropped and counted.
    pub fn push(&self, record: R) -> bool {
        critical_section::with(|cs| {
            let place = self.place.borrow(cs);
            // Nobody else has it: every borrow begins and ends within a critical section.
            let kept =
                place.records.try_borrow_mut().is_ok_and(|mut records| records.push_back(record).is_ok());
            if !kept {
                place.dropped.set(place.dropped.get().saturating_add(1));
            }
            kept
        })
    }

    /// Takes the oldest record.
    pub fn pop(&self) -> Option<R> {
        critical_section::with(|cs| self.place.borrow(cs).records.try_borrow_mut().ok()?.pop_front())
    }

    /// How many records were dropped so far; stays at `u32::MAX` once there.
    #[must_use]
    pub fn dropped(&self) -> u32 {
        critical_section::with(|cs| self.place.borrow(cs).dropped.get())
    }

    /// How many records wait.
    #[must_use]
    pub fn len(&self) -> usize {
        critical_section::with(|cs| {
            self.place.borrow(cs).records.try_borrow().map_or(0, |records| records.len())
        })
    }

    /// Whether none waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

impl<R: Copy, const N: usize> Default for Trace<R, N> {
    fn default() -> Self {
        Self::new()
    }
}

/// One sample of a [`Controller`](crate::Controller) as a record for a [`Trace`]: what one plots to see a loop work.
///
/// `y` is as it came in, which may be unusable; the other numbers are finite.
///
/// ```
/// use controller_core::{Controller, ControllerConfig, ControllerInput, Trace, TraceSample};
/// static TRACE: Trace<TraceSample<f32>, 32> = Trace::new();
/// let law = Controller::<f32>::new(&ControllerConfig::default(), 0.1).unwrap();
/// let mut state = law.zeroed();
/// let input = ControllerInput { r: 2.0, y: 1.0, ..ControllerInput::default() };
/// let output = law.step(&mut state, &input);
/// TRACE.push(TraceSample::new(7, &input, &output));
/// let sample = TRACE.pop().unwrap();
/// assert_eq!((sample.k, sample.r, sample.y, sample.u), (7, 2.0, 1.0, output.u));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TraceSample<T> {
    /// Number of the sample, as the control task counts; wraps.
    pub k: u32,
    /// Working set-point \[y\].
    pub r: T,
    /// Measurement \[y\].
    pub y: T,
    /// Output, limited \[u\].
    pub u: T,
    /// Output before the limits \[u\].
    pub v: T,
    /// Output of the compensator \[u\].
    pub u_f: T,
    /// Estimated disturbance at the plant input \[u\].
    pub d_hat: T,
    /// Status bits.
    pub status: Status,
    /// Mode in force.
    pub mode: Mode,
}

impl<T: Real> TraceSample<T> {
    /// The record of sample `k`.
    #[must_use]
    pub fn new(k: u32, input: &ControllerInput<T>, output: &ControllerOutput<T>) -> Self {
        let ControllerOutput { u, v, u_f, d_hat, r, mode, status, .. } = *output;
        Self { k, r, y: input.y, u, v, u_f, d_hat, status, mode }
    }
}
