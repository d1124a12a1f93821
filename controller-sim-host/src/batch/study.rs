//! What is asked for, and the order of its rows.

use super::digest::digest;
use super::list::NamedPlant;
use controller_design::design::Method;
use std::ops::Range;

/// Rules for plants.
#[derive(Debug, Clone)]
pub struct Study {
    /// The plants, in the order of the rows.
    pub plants: Vec<NamedPlant>,
    /// The rules, in the order of the rows of one plant.
    pub methods: Vec<Method>,
    /// Maximum sensitivities, for rules that are given one.
    pub ms: Vec<f64>,
    /// Noise gains with an observer over that of the PI alone; none: the rule chooses.
    pub noise_ratios: Vec<f64>,
    /// Sampling period of every loop \[s\]; `None`: loops are continuous, and each plant has [one of its own](NamedPlant::period)
    /// for the noise gains.
    pub ts: Option<f64>,
}

/// One row of every plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The rule.
    pub method: Method,
    /// The maximum sensitivity, of rules that are given one.
    pub ms: Option<f64>,
    /// The noise ratio, of rules that are given one.
    pub noise_ratio: Option<f64>,
}

/// A part of a study: `index` of `count`, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `count`.
    pub index: usize,
    /// At least 1.
    pub count: usize,
}

impl Shard {
    /// All of a study.
    pub const WHOLE: Self = Self { index: 1, count: 1 };

    /// The rows of this part, from 0; parts differ by one row at most and follow each other.
    #[must_use]
    pub fn rows(self, total: usize) -> Range<usize> {
        let (each, more) = (total / self.count, total % self.count);
        let before = |parts: usize| parts * each + parts.min(more);
        before(self.index - 1)..before(self.index)
    }
}

impl Study {
    /// The rows of each plant: method by method, then `Ms`, then noise ratio.
    #[must_use]
    pub fn points(&self) -> Vec<Point> {
        let mut points = Vec::new();
        for &method in &self.methods {
            let looks_at = |option: &str| method.options().contains(&option);
            let list = |option: &str, values: &[f64]| -> Vec<Option<f64>> {
                match values {
                    values if looks_at(option) && !values.is_empty() => {
                        values.iter().copied().map(Some).collect()
                    }
                    _ => vec![None],
                }
            };
            for ms in list("ms", &self.ms) {
                for noise_ratio in list("noise_ratio", &self.noise_ratios) {
                    points.push(Point { method, ms, noise_ratio });
                }
            }
        }
        points
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.plants.len() * self.points().len()
    }

    /// What its rows carry, so that files of different studies are told apart: a digest of all that they depend on, and their
    /// number.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}/{}", digest(self), self.rows())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_every_row_once() {
        for total in [1, 7, 134, 1206] {
            for count in [1, 2, 3, 7] {
                let mut next = 0;
                for index in 1..=count {
                    let rows = Shard { index, count }.rows(total);
                    assert_eq!(rows.start, next);
                    assert!(rows.len() == total / count || rows.len() == total / count + 1);
                    next = rows.end;
                }
                assert_eq!(next, total);
            }
        }
    }
}
