//! The row of one rule on one plant.

use super::layout::{Cells, Column, Kind};
use super::study::Point;
use controller_design::design::Law;
use controller_design::margins::Margins;

const fn text(name: &'static str) -> Column {
    Column::fixed(name, Kind::Text)
}

const fn number(name: &'static str) -> Column {
    Column::fixed(name, Kind::Number)
}

/// The columns, in order.
pub static COLUMNS: [Column; 39] = [
    text("study"),
    Column::fixed("row", Kind::Count),
    text("process"),
    text("family"),
    text("method"),
    number("ms0"),
    number("noise_ratio"),
    text("status"),
    text("reason"),
    text("loop"),
    number("ts"),
    number("kp"),
    number("ki"),
    number("kd"),
    number("tf"),
    number("b"),
    number("c"),
    number("alpha"),
    number("kfd"),
    number("tfd"),
    number("b0"),
    number("ms"),
    number("mt"),
    number("gm"),
    number("pm_deg"),
    number("delay_margin"),
    number("a_n"),
    number("setpoint_ie"),
    number("setpoint_iae"),
    number("setpoint_ise"),
    number("setpoint_itae"),
    number("setpoint_e_max"),
    number("setpoint_tv"),
    number("load_ie"),
    number("load_iae"),
    number("load_ise"),
    number("load_itae"),
    number("load_e_max"),
    number("load_tv"),
];

/// What the rows of a map have besides.
pub(super) static POINT: [Column; 7] = [
    text("x_name"),
    number("x"),
    text("y_name"),
    number("y"),
    text("each_name"),
    number("each"),
    number("horizon"),
];

const PROCESS: usize = 2;
const METHOD: usize = 4;
const MS0: usize = 5;
const STATUS: usize = 7;
const LOOP: usize = 9;
const LAW: usize = 11;
const MARGINS: usize = 21;
const A_N: usize = 26;
const SETPOINT: usize = 27;
const LOAD: usize = 33;

/// What became of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Designed, and its responses computed.
    Ok,
    /// The rule has no design for the plant.
    Refused,
    /// Its plant means nothing, or it is designed but its responses could not be computed.
    Failed,
}

impl Status {
    /// As it stands in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }

    fn named(name: &str) -> Option<Self> {
        [Self::Ok, Self::Refused, Self::Failed].into_iter().find(|status| status.name() == name)
    }
}

/// As they stand in files.
pub(super) const STATUSES: [&str; 3] = [Status::Ok.name(), Status::Refused.name(), Status::Failed.name()];

/// Indices of one response in the order of the columns: IE, IAE, ISE, ITAE, largest error, TV.
pub(super) type Numbers = [f64; 6];

/// The row of one rule on one plant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    cells: Cells,
}

impl AsRef<Cells> for Row {
    fn as_ref(&self) -> &Cells {
        &self.cells
    }
}

impl From<Cells> for Row {
    fn from(cells: Cells) -> Self {
        Self { cells }
    }
}

impl Row {
    /// The row `number` (from 1) of the study, with nothing in it yet.
    pub(super) fn new(study: &str, number: usize, process: (&str, &str), point: Point) -> Self {
        let mut cells = Cells::new(study, number, COLUMNS.len());
        for (i, cell) in [process.0, process.1, point.method.name()].into_iter().enumerate() {
            cell.clone_into(&mut cells.0[PROCESS + i]);
        }
        cells.put(MS0, [point.ms, point.noise_ratio]);
        cells.0[STATUS] = Status::Ok.name().to_owned();
        Self { cells }
    }

    /// All cells, in the order of the columns.
    #[must_use]
    pub fn cells(&self) -> &[String] {
        self.cells.all()
    }

    /// Its number, from 1.
    #[must_use]
    pub fn number(&self) -> usize {
        self.cells.number()
    }

    /// The name of the process.
    #[must_use]
    pub fn process(&self) -> &str {
        &self.cells.0[PROCESS]
    }

    /// Method, maximum sensitivity and noise ratio as texts.
    #[must_use]
    pub fn point(&self) -> [&str; 3] {
        [METHOD, MS0, MS0 + 1].map(|i| &*self.cells.0[i])
    }

    /// What became of it.
    #[must_use]
    pub fn status(&self) -> Status {
        Status::named(&self.cells.0[STATUS]).unwrap_or(Status::Failed)
    }

    /// Why it is not ok; empty when it is.
    #[must_use]
    pub fn reason(&self) -> &str {
        &self.cells.0[STATUS + 1]
    }

    /// IAE, ISE and ITAE after a load, when it has them.
    #[must_use]
    pub fn load(&self) -> Option<[f64; 3]> {
        let at = |i: usize| self.cells.0[i].parse().ok();
        Some([at(LOAD + 1)?, at(LOAD + 2)?, at(LOAD + 3)?])
    }

    /// Its maximum sensitivity, when it has one.
    #[must_use]
    pub fn ms(&self) -> Option<f64> {
        self.cells.0[MARGINS].parse().ok()
    }

    /// Makes it a row of a map: names and values of its parameters, and the horizon.
    pub(super) fn put_point(&mut self, parameters: [(&str, Option<f64>); 3], horizon: Option<f64>) {
        let from = COLUMNS.len();
        self.cells.0.resize(from + POINT.len(), String::new());
        for (i, (name, value)) in parameters.into_iter().enumerate() {
            name.clone_into(&mut self.cells.0[from + 2 * i]);
            self.cells.put(from + 2 * i + 1, [value]);
        }
        self.cells.put(from + POINT.len() - 1, [horizon]);
    }

    pub(super) fn end(&mut self, status: Status, reason: &str) {
        status.name().clone_into(&mut self.cells.0[STATUS]);
        self.cells.put_reason(STATUS + 1, reason);
    }

    pub(super) fn put_loop(&mut self, name: &str, ts: f64) {
        name.clone_into(&mut self.cells.0[LOOP]);
        self.cells.put(LOOP + 1, [Some(ts)]);
    }

    pub(super) fn put_law(&mut self, law: &Law) {
        let mut numbers = [None; 10];
        match law {
            Law::Pid { pid, estimator, observer } => {
                let gains = [pid.kp, pid.ki, pid.kd, pid.tf, pid.b, pid.c].map(Some);
                numbers[..6].copy_from_slice(&gains);
                numbers[6] = observer.as_ref().map(|observer| observer.alpha);
                numbers[7] = estimator.map(|estimator| estimator.kfd);
                numbers[8] = estimator.map(|estimator| estimator.tfd);
            }
            Law::Adrc(adrc) => {
                (numbers[0], numbers[2], numbers[9]) = (Some(adrc.kp), Some(adrc.kd), Some(adrc.b0));
            }
        }
        self.cells.put(LAW, numbers);
    }

    pub(super) fn put_margins(&mut self, margins: &Margins, a_n: Option<f64>) {
        let Margins { ms, mt, gm, pm_deg, delay_margin, .. } = *margins;
        self.cells.put(MARGINS, [ms, mt, gm, pm_deg, delay_margin].map(Some));
        self.cells.put(A_N, [a_n]);
    }

    pub(super) fn put_responses(&mut self, setpoint: Numbers, load: Numbers) {
        self.cells.put(SETPOINT, setpoint.map(Some));
        self.cells.put(LOAD, load.map(Some));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::batch::layout::Layout;
    use controller_design::design::Method;

    #[test]
    fn columns_are_where_they_are_written() {
        let at = |i: usize| COLUMNS[i].name.to_string();
        let places =
            [Cells::NUMBER, PROCESS, METHOD, MS0, STATUS, LOOP, LAW, MARGINS, A_N, SETPOINT, LOAD].map(at);
        let names = [
            "row",
            "process",
            "method",
            "ms0",
            "status",
            "loop",
            "kp",
            "ms",
            "a_n",
            "setpoint_ie",
            "load_ie",
        ];
        assert_eq!(places, names);
    }

    #[test]
    fn half_a_row_is_none() {
        let point = Point { method: Method::PiMs, ms: Some(1.2), noise_ratio: None };
        let row = Row::new("s/1", 1, ("p", ""), point);
        assert_eq!(Layout::rules().read(row.cells().to_vec()), Some(row.cells.clone()));
        let mut cells = row.cells().to_vec();
        cells.pop();
        assert_eq!(Layout::rules().read(cells), None);
        let mut cells = row.cells().to_vec();
        cells[MS0] = "1.2x".to_owned();
        assert_eq!(Layout::rules().read(cells), None);
    }
}
