//! What the rows of samples come to, in memory that does not grow with them.

use super::binomial::clopper_pearson;
use super::sketch::Sketch;
use super::study::{CONTROLLER, REASON, SAMPLE, STATUS, Status};
use crate::batch::layout::{Cells, Layout};

/// A sample that is the worst in something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Its number, from 1; of equal ones the first.
    pub sample: usize,
    /// Its value.
    pub value: f64,
}

/// A margin or an index over all stable loops of a controller.
#[derive(Debug, Clone)]
pub struct Measure {
    /// The name of its column.
    pub name: String,
    /// How it is distributed.
    pub sketch: Sketch,
    /// The least margin `gm`, `pm_deg` or `delay_margin`, the `ie` of the largest size, the largest of everything else.
    pub worst: Option<Worst>,
}

/// The rows of one controller.
#[derive(Debug, Clone)]
pub struct Group {
    /// Its name.
    pub controller: String,
    /// Rows that are stable, unstable, refused, failed.
    pub counts: [usize; 4],
    /// Its margins and indices, in the order of the columns.
    pub measures: Vec<Measure>,
    /// The unstable loop with the largest IAE of an event.
    pub unstable: Option<Worst>,
}

impl Group {
    /// Share of the loops that are unstable, of those that are known to be stable or not, with the ends of its
    /// [interval](clopper_pearson); `None` without any.
    #[must_use]
    pub fn unstable_share(&self) -> Option<[f64; 3]> {
        let [stable, unstable, ..] = self.counts.map(|count| count as u64);
        let known = stable + unstable;
        let (lo, hi) = clopper_pearson(unstable, known);
        (known > 0).then(|| [unstable as f64 / known as f64, lo, hi])
    }
}

/// Rows without a result for one reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cause {
    /// Name of the controller.
    pub controller: String,
    /// Refused or failed.
    pub status: &'static str,
    /// Why.
    pub reason: String,
    /// The first sample.
    pub sample: usize,
    /// How many rows.
    pub rows: usize,
}

/// Causes that are kept apart; what else there is counts as rows only.
const CAUSES: usize = 20;

/// Which of two values is worse.
#[derive(Debug, Clone, Copy)]
enum Bad {
    Small,
    Large,
    Size,
}

impl Bad {
    fn of(name: &str) -> Self {
        match name {
            "gm" | "pm_deg" | "delay_margin" => Self::Small,
            name if name.ends_with("_ie") => Self::Size,
            _ => Self::Large,
        }
    }

    fn badness(self, x: f64) -> f64 {
        match self {
            Self::Small => -x,
            Self::Large => x,
            Self::Size => x.abs(),
        }
    }
}

/// What a sample is the worst in: controller, measure (or `unstable`) and value.
pub type Reached<'a> = (&'a str, &'a str, f64);

/// Gathers rows in their order.
#[derive(Debug, Clone)]
pub struct SampleSummary {
    /// The first measure, and the names of all.
    first: usize,
    names: Vec<(String, Bad)>,
    /// Measures that are an IAE.
    iae: Vec<usize>,
    groups: Vec<Group>,
    causes: Vec<Cause>,
}

impl SampleSummary {
    /// An empty one of rows with these columns.
    #[must_use]
    pub fn new(layout: &Layout) -> Self {
        let columns = layout.columns();
        // Behind the number of unstable poles.
        let first = layout.place("ms").unwrap_or(columns.len());
        let names: Vec<(String, Bad)> =
            columns[first..].iter().map(|column| (column.name.to_string(), Bad::of(&column.name))).collect();
        let iae = names.iter().enumerate().filter(|(_, (name, _))| name.ends_with("_iae")).map(|(i, _)| i);
        Self { first, iae: iae.collect(), names, groups: Vec::new(), causes: Vec::new() }
    }

    /// Adds the next row.
    pub fn add(&mut self, row: &Cells) {
        let cells = row.all();
        let Some(status) = Status::ALL.into_iter().find(|status| status.name() == cells[STATUS]) else {
            return;
        };
        let (controller, sample) = (&cells[CONTROLLER], cells[SAMPLE].parse().unwrap_or(0));
        let at = self.groups.iter().position(|group| group.controller == *controller).unwrap_or_else(|| {
            let measure = |(name, _): &(String, Bad)| Measure {
                name: name.clone(),
                sketch: Sketch::default(),
                worst: None,
            };
            let measures = self.names.iter().map(measure).collect();
            let controller = controller.clone();
            self.groups.push(Group { controller, counts: [0; 4], measures, unstable: None });
            self.groups.len() - 1
        });
        let group = &mut self.groups[at];
        group.counts[status as usize] += 1;
        let value = |i: usize| cells[self.first + i].parse::<f64>().ok();
        match status {
            Status::Stable => {
                for (i, (measure, (_, bad))) in group.measures.iter_mut().zip(&self.names).enumerate() {
                    let Some(value) = value(i) else { continue };
                    measure.sketch.add(value);
                    if measure.worst.is_none_or(|worst| bad.badness(value) > bad.badness(worst.value)) {
                        measure.worst = Some(Worst { sample, value });
                    }
                }
            }
            Status::Unstable => {
                for value in self.iae.iter().filter_map(|i| value(*i)) {
                    if group.unstable.is_none_or(|worst| value > worst.value) {
                        group.unstable = Some(Worst { sample, value });
                    }
                }
            }
            Status::Refused | Status::Failed => self.note(status, controller, &cells[REASON], sample),
        }
    }

    fn note(&mut self, status: Status, controller: &str, reason: &str, sample: usize) {
        let same = |cause: &&mut Cause| {
            cause.controller == controller && cause.status == status.name() && cause.reason == reason
        };
        if let Some(cause) = self.causes.iter_mut().find(same) {
            cause.rows += 1;
        } else if self.causes.len() < CAUSES {
            let [controller, reason] = [controller, reason].map(str::to_owned);
            self.causes.push(Cause { controller, status: status.name(), reason, sample, rows: 1 });
        }
    }

    /// The controllers, in the order of their first rows.
    #[must_use]
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Rows that are stable, unstable, refused, failed.
    #[must_use]
    pub fn counts(&self) -> [usize; 4] {
        std::array::from_fn(|i| self.groups.iter().map(|group| group.counts[i]).sum())
    }

    /// Why rows have no result, at most 20 causes.
    #[must_use]
    pub fn causes(&self) -> &[Cause] {
        &self.causes
    }

    /// The samples that are the worst in something, ascending, each with what that is.
    #[must_use]
    pub fn worst(&self) -> Vec<(usize, Vec<Reached<'_>>)> {
        let mut list: Vec<(usize, Vec<Reached<'_>>)> = Vec::new();
        for group in &self.groups {
            let measures = group.measures.iter().map(|measure| (measure.name.as_str(), measure.worst));
            for (name, worst) in measures.chain([("unstable", group.unstable)]) {
                let Some(Worst { sample, value }) = worst else { continue };
                let what = (group.controller.as_str(), name, value);
                match list.iter_mut().find(|(other, _)| *other == sample) {
                    Some((_, all)) => all.push(what),
                    None => list.push((sample, vec![what])),
                }
            }
        }
        list.sort_by_key(|(sample, _)| *sample);
        list
    }
}
