//! What the rows of a map come to: values on its grid.

use super::{MapStudy, Metric};
use crate::batch::row::{Row, Status};
use crate::batch::summary::{Cause, Causes};

/// Gathers the rows of a map.
#[derive(Debug, Clone)]
pub struct MapValues<'a> {
    study: &'a MapStudy,
    metrics: Vec<Metric>,
    /// By metric, rule and place; what there is not is NaN.
    values: Vec<f64>,
    counts: [usize; 3],
    causes: Causes,
}

/// One picture: a metric, for one value of the third parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What is shown; over that of the other rule when there is one.
    pub metric: Metric,
    /// The value of the third parameter, when there is one.
    pub each: Option<f64>,
    /// The values of the first y, in the order of x, then those of the second; NaN: a hole.
    pub values: Vec<f64>,
}

impl Panel {
    /// Points without a value.
    #[must_use]
    pub fn holes(&self) -> usize {
        self.values.iter().filter(|value| !value.is_finite()).count()
    }

    /// The least and the largest value; `None` without any.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let finite = self.values.iter().copied().filter(|value| value.is_finite());
        finite.fold(None, |range: Option<(f64, f64)>, x| {
            Some(range.map_or((x, x), |(lo, hi)| (lo.min(x), hi.max(x))))
        })
    }
}

impl<'a> MapValues<'a> {
    /// Nothing yet.
    #[must_use]
    pub fn new(study: &'a MapStudy, metrics: &[Metric]) -> Self {
        Self {
            study,
            metrics: metrics.to_vec(),
            values: vec![f64::NAN; metrics.len() * study.rows()],
            counts: [0; 3],
            causes: Causes::default(),
        }
    }

    /// Adds a row.
    pub fn add(&mut self, row: &Row) {
        self.counts[row.status() as usize] += 1;
        self.causes.add(row);
        let rows = self.study.rows();
        if row.status() != Status::Ok || row.number() == 0 || row.number() > rows {
            return;
        }
        let (place, method) = self.study.place(row.number() - 1);
        let at = self.index(place) + if method == self.study.method { 0 } else { self.study.points() };
        for (i, metric) in self.metrics.iter().enumerate() {
            if let Ok(value) = row.cells()[metric.column()].parse() {
                self.values[i * rows + at] = value;
            }
        }
    }

    fn index(&self, [x, y, each]: [usize; 3]) -> usize {
        let (width, height) = (self.study.x.values.len(), self.study.y.values.len());
        (each * height + y) * width + x
    }

    /// Rows that are ok, refused, failed.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// Why rows have no result, at most 20 causes.
    #[must_use]
    pub fn causes(&self) -> &[Cause] {
        self.causes.list()
    }

    /// The pictures: metric by metric, for each value of the third parameter.
    #[must_use]
    pub fn panels(&self) -> Vec<Panel> {
        let (points, rows) = (self.study.points(), self.study.rows());
        let size = self.study.x.values.len() * self.study.y.values.len();
        let each: Vec<Option<f64>> = match &self.study.each {
            Some(axis) => axis.values.iter().copied().map(Some).collect(),
            None => vec![None],
        };
        let mut panels = Vec::new();
        for (i, metric) in self.metrics.iter().enumerate() {
            for (k, value) in each.iter().enumerate() {
                let own = &self.values[i * rows + k * size..][..size];
                let values = match self.study.over {
                    None => own.to_vec(),
                    Some(_) => {
                        let base = &self.values[i * rows + points + k * size..][..size];
                        own.iter().zip(base).map(|(x, base)| x / base).collect()
                    }
                };
                panels.push(Panel { metric: *metric, each: *value, values });
            }
        }
        panels
    }
}
