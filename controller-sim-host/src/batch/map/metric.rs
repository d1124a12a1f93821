//! What can be drawn over a map.

use crate::batch::{COLUMNS, Kind};

/// A column of numbers that a map can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Metric {
    /// Its name, in files and on the command line.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// Its unit, of `u`, `y` and s.
    pub unit: &'static str,
}

const fn metric(name: &'static str, title: &'static str, unit: &'static str) -> Metric {
    Metric { name, title, unit }
}

impl Metric {
    /// All of them, in the order of the columns.
    pub const ALL: [Self; 28] = [
        metric("kp", "proportional gain kp", "u/y"),
        metric("ki", "integral gain ki", "u/y/s"),
        metric("kd", "derivative gain kd", "u/y s"),
        metric("tf", "filter of the PID tf", "s"),
        metric("b", "set-point weight b", ""),
        metric("c", "set-point weight c", ""),
        metric("alpha", "filter of the observer \u{3b1}", "s"),
        metric("kfd", "gain of the estimator kfd", ""),
        metric("tfd", "filter of the estimator tfd", "s"),
        metric("b0", "gain b0", "y/u/s\u{b2}"),
        metric("ms", "Ms, largest sensitivity", ""),
        metric("mt", "Mt, largest compl. sensitivity", ""),
        metric("gm", "gain margin", ""),
        metric("pm_deg", "phase margin", "\u{b0}"),
        metric("delay_margin", "delay margin", "s"),
        metric("a_n", "noise gain A_n", "u/y"),
        metric("setpoint_ie", "IE, set-point step", "y s"),
        metric("setpoint_iae", "IAE, set-point step", "y s"),
        metric("setpoint_ise", "ISE, set-point step", "y\u{b2} s"),
        metric("setpoint_itae", "ITAE, set-point step", "y s\u{b2}"),
        metric("setpoint_e_max", "e_max, set-point step", "y"),
        metric("setpoint_tv", "TV, set-point step", "u"),
        metric("load_ie", "IE, load step", "y s"),
        metric("load_iae", "IAE, load step", "y s"),
        metric("load_ise", "ISE, load step", "y\u{b2} s"),
        metric("load_itae", "ITAE, load step", "y s\u{b2}"),
        metric("load_e_max", "e_max, load step", "y"),
        metric("load_tv", "TV, load step", "u"),
    ];

    /// The metric called `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|metric| metric.name == name)
    }

    /// Its column.
    pub(super) fn column(self) -> usize {
        let is_it = |column: &crate::batch::Column| column.name == self.name && column.kind == Kind::Number;
        COLUMNS.iter().position(is_it).unwrap_or(COLUMNS.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_is_a_column_of_its_own() {
        let columns: Vec<usize> = Metric::ALL.iter().map(|metric| metric.column()).collect();
        assert!(columns.windows(2).all(|pair| pair[1] == pair[0] + 1), "{columns:?}");
        for (metric, column) in Metric::ALL.iter().zip(columns) {
            assert_eq!(metric.name, COLUMNS[column].name);
            assert_eq!(Metric::named(metric.name), Some(*metric));
        }
        assert_eq!(Metric::named("study"), None);
    }
}
