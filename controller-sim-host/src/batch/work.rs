//! The rows of many items, plants mostly, on several threads, in their order.

use super::evaluate::Evaluator;
use super::row::Row;
use super::study::Study;
use crate::simulate::Control;
use std::collections::BTreeMap;
use std::ops::{Range, RangeInclusive};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread;

/// Items that may be done before the first one that is not: rows are held back in memory until their turn.
const AHEAD: usize = 64;

/// It was stopped before the last row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

/// What the threads share.
struct Queue<R> {
    /// The next item to be taken.
    next: usize,
    /// The next one to be given out.
    due: usize,
    /// Those that are done before their turn.
    done: BTreeMap<usize, Vec<R>>,
    ended: bool,
}

/// Ends the work when a thread panics: nobody waits for its rows.
struct Guard<'a, R> {
    queue: &'a Mutex<Queue<R>>,
    changed: &'a Condvar,
}

impl<R> Drop for Guard<'_, R> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.queue.lock().unwrap_or_else(PoisonError::into_inner).ended = true;
            self.changed.notify_all();
        }
    }
}

/// Makes the rows in `range`, from 0, on `jobs` threads and gives them to `take` in their order, those of a plant together;
/// `done` counts them. What is computed depends neither on the threads nor on the range.
///
/// # Errors
/// [`Stopped`] by `control`, the rows up to then given; whatever `take` reports ends it as well.
pub fn work<E: From<Stopped>>(
    study: &Study,
    range: Range<usize>,
    jobs: usize,
    control: &Control,
    done: &AtomicU64,
    take: impl FnMut(Vec<Row>) -> Result<(), E>,
) -> Result<(), E> {
    let (points, name) = (study.points(), study.name());
    in_order(range, points.len(), jobs, control, done, take, |index| {
        let mut evaluator = Evaluator::new(study, &name, &study.plants[index]);
        let points = &points;
        move |i: usize| Some(evaluator.row(index * points.len() + i + 1, points[i]))
    })
}

/// Makes the rows in `range`, from 0, of items that have `each` of them: `begin` takes the index of an item, what it gives
/// makes the rows of it by their places, in their order, none when it was stopped. Otherwise as [`work`].
pub(super) fn in_order<R: Send, E: From<Stopped>, F: FnMut(usize) -> Option<R>>(
    range: Range<usize>,
    each: usize,
    jobs: usize,
    control: &Control,
    done: &AtomicU64,
    take: impl FnMut(Vec<R>) -> Result<(), E>,
    begin: impl Fn(usize) -> F + Sync,
) -> Result<(), E> {
    if range.is_empty() || each == 0 {
        return Ok(());
    }
    let rows_of = |index: usize| {
        let mut row = begin(index);
        let mut rows = Vec::new();
        for i in 0..each {
            if !range.contains(&(index * each + i)) {
                continue;
            }
            if control.is_stopped() {
                break;
            }
            let Some(made) = row(i) else { break };
            rows.push(made);
            done.fetch_add(1, Ordering::Relaxed);
        }
        rows
    };
    items_in_order(range.start / each..=(range.end - 1) / each, jobs, control, take, rows_of)
}

/// Makes the rows of every item on `jobs` threads and gives them to `take` in the order of the items.
///
/// # Errors
/// As those of [`work`].
pub(super) fn items_in_order<R: Send, E: From<Stopped>>(
    items: RangeInclusive<usize>,
    jobs: usize,
    control: &Control,
    mut take: impl FnMut(Vec<R>) -> Result<(), E>,
    rows_of: impl Fn(usize) -> Vec<R> + Sync,
) -> Result<(), E> {
    let (first, last) = (*items.start(), *items.end());
    let queue = Mutex::new(Queue { next: first, due: first, done: BTreeMap::new(), ended: false });
    let changed = Condvar::new();
    let lock = || queue.lock().unwrap_or_else(PoisonError::into_inner);
    let worker = || {
        let _guard = Guard { queue: &queue, changed: &changed };
        loop {
            let index = {
                let mut queue = lock();
                while !queue.ended && queue.next <= last && queue.next > queue.due + AHEAD {
                    queue = changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
                }
                if queue.ended || queue.next > last {
                    return;
                }
                queue.next += 1;
                queue.next - 1
            };
            let rows = rows_of(index);
            lock().done.insert(index, rows);
            changed.notify_all();
        }
    };
    thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, last - first + 1) {
            scope.spawn(worker);
        }
        let result = (first..=last).try_for_each(|index| {
            let rows = {
                let mut queue = lock();
                loop {
                    if let Some(rows) = queue.done.remove(&index) {
                        queue.due = index + 1;
                        break rows;
                    }
                    if queue.ended {
                        // The panic of the thread goes on when the scope ends.
                        return Err(E::from(Stopped));
                    }
                    queue = changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
                }
            };
            changed.notify_all();
            // Those that were finished count, also of a plant that was not.
            take(rows)?;
            if control.is_stopped() { Err(E::from(Stopped)) } else { Ok(()) }
        });
        lock().ended = true;
        changed.notify_all();
        result
    })
}
