//! The golden values of `tests/golden/make_design.py`.

#![allow(dead_code)] // not every test uses all of it

use std::collections::BTreeMap;

use controller_design::areas::Areas;
use controller_design::model::{TransferFunction, parse};

const TEXT: &str = include_str!("../data/design.csv");

/// The values of one plant.
pub(crate) struct Row(BTreeMap<&'static str, &'static str>);

impl Row {
    pub(crate) fn name(&self) -> &'static str {
        self.0["name"]
    }

    pub(crate) fn plant(&self) -> TransferFunction {
        parse(self.0["plant"]).expect("a valid plant")
    }

    pub(crate) fn areas(&self) -> Areas {
        self.plant().areas6().expect("a stable plant")
    }

    /// `None` where the field is empty: there is no such value.
    pub(crate) fn get(&self, column: &str) -> Option<f64> {
        let text = self.0[column];
        (!text.is_empty()).then(|| text.parse().expect("a number"))
    }

    pub(crate) fn number(&self, column: &str) -> f64 {
        self.get(column).expect("a value")
    }
}

pub(crate) fn rows() -> Vec<Row> {
    let mut lines = TEXT.lines();
    let names: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    lines.map(|line| Row(names.iter().copied().zip(line.split(',')).collect())).collect()
}

#[track_caller]
pub(crate) fn close(what: &str, ours: f64, expected: f64, tolerance: f64) {
    let error = (ours - expected).abs();
    assert!(error <= tolerance * expected.abs(), "{what}: {ours:e}, expected {expected:e}");
}
