//! What the rows of a study come to.

use super::row::{Row, Status};
use std::collections::BTreeMap;

/// An index over that of the first method on the same process: IAE, ISE or ITAE after a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// Its median over the processes.
    pub median: f64,
    /// The largest.
    pub largest: f64,
    /// Processes on which it is above 1.
    pub above_one: usize,
}

/// The rows of one method, maximum sensitivity and noise ratio.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Name of the method.
    pub method: String,
    /// The maximum sensitivity that was asked for, as it stands in the rows; empty: none.
    pub ms0: String,
    /// The noise ratio, likewise.
    pub noise_ratio: String,
    /// Rows that are ok, refused, failed.
    pub counts: [usize; 3],
    /// Least and largest maximum sensitivity of the loops; `None` without any.
    pub ms: Option<[f64; 2]>,
    /// IAE, ISE, ITAE over those of the first method, where both are ok; `None`: nowhere, or this is it.
    pub ratios: Option<[Ratio; 3]>,
}

/// Rows without a result for one reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cause {
    /// Name of the method.
    pub method: String,
    /// Refused or failed.
    pub status: Status,
    /// Why.
    pub reason: String,
    /// The first process.
    pub process: String,
    /// How many rows.
    pub rows: usize,
}

/// Causes that are kept apart; what else there is counts as rows only.
const CAUSES: usize = 20;

/// Gathers why rows have no result.
#[derive(Debug, Clone, Default)]
pub(super) struct Causes(Vec<Cause>);

impl Causes {
    /// Adds the next row; nothing of one that is ok.
    pub(super) fn add(&mut self, row: &Row) {
        let ([method, ..], status, reason) = (row.point(), row.status(), row.reason());
        if status == Status::Ok {
            return;
        }
        let same =
            |cause: &&mut Cause| cause.method == method && cause.status == status && cause.reason == reason;
        if let Some(cause) = self.0.iter_mut().find(same) {
            cause.rows += 1;
        } else if self.0.len() < CAUSES {
            let [method, reason, process] = [method, reason, row.process()].map(str::to_owned);
            self.0.push(Cause { method, status, reason, process, rows: 1 });
        }
    }

    pub(super) fn list(&self) -> &[Cause] {
        &self.0
    }
}

/// Gathers rows in their order.
#[derive(Debug, Clone, Default)]
pub struct Summary {
    groups: Vec<(Group, [Vec<f64>; 3])>,
    /// By method, `Ms`, noise ratio.
    places: BTreeMap<[String; 3], usize>,
    process: String,
    first_method: String,
    /// IAE, ISE, ITAE of the first method on this process, by `Ms`.
    base: BTreeMap<String, [f64; 3]>,
    causes: Causes,
}

impl Summary {
    /// An empty one; rows are compared with those of `first_method`, at the same `Ms` where it is given one.
    #[must_use]
    pub fn new(first_method: &str) -> Self {
        Self { first_method: first_method.to_owned(), ..Self::default() }
    }

    /// Adds the next row.
    pub fn add(&mut self, row: &Row) {
        let [method, ms0, noise_ratio] = row.point();
        if self.process != row.process() {
            row.process().clone_into(&mut self.process);
            self.base.clear();
        }
        let load = row.load().filter(|_| row.status() == Status::Ok);
        let is_first = method == self.first_method;
        if let Some(load) = load
            && is_first
        {
            self.base.entry(ms0.to_owned()).or_insert(load);
        }
        let key = [method, ms0, noise_ratio].map(str::to_owned);
        let at = *self.places.entry(key).or_insert_with(|| {
            let [method, ms0, noise_ratio] = row.point().map(str::to_owned);
            let group = Group { method, ms0, noise_ratio, counts: [0; 3], ms: None, ratios: None };
            self.groups.push((group, [const { Vec::new() }; 3]));
            self.groups.len() - 1
        });
        self.causes.add(row);
        let (group, ratios) = &mut self.groups[at];
        group.counts[row.status() as usize] += 1;
        if let Some(ms) = row.ms() {
            let [least, largest] = group.ms.unwrap_or([f64::INFINITY, 0.0]);
            group.ms = Some([least.min(ms), largest.max(ms)]);
        }
        // A method without Ms is compared with the first one's first; one with, with the first one's at that Ms.
        let base = self.base.get(ms0).or_else(|| match (ms0.is_empty(), self.base.get("")) {
            (true, _) => self.base.values().next(),
            (false, base) => base,
        });
        if let (Some(load), Some(base), false) = (load, base, is_first) {
            for ((list, x), base) in ratios.iter_mut().zip(load).zip(base) {
                list.push(x / base);
            }
        }
    }

    /// Rows that are ok, refused, failed.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        std::array::from_fn(|i| self.groups.iter().map(|(group, _)| group.counts[i]).sum())
    }

    /// Why rows have no result, at most 20 causes.
    #[must_use]
    pub fn causes(&self) -> &[Cause] {
        self.causes.list()
    }

    /// The groups, in the order of their first rows.
    #[must_use]
    pub fn groups(&self) -> Vec<Group> {
        let of = |(group, ratios): &(Group, [Vec<f64>; 3])| {
            let some = !ratios[0].is_empty();
            Group { ratios: some.then(|| ratios.each_ref().map(|list| ratio(list))), ..group.clone() }
        };
        self.groups.iter().map(of).collect()
    }
}

fn ratio(list: &[f64]) -> Ratio {
    let mut sorted = list.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median =
        if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) };
    let above_one = list.iter().filter(|ratio| **ratio > 1.0).count();
    Ratio { median, largest: sorted[sorted.len() - 1], above_one }
}
