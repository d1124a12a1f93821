//! Tables 1, 2 and 6: the PI controllers.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::loops::{Loop, PARTS, PLANTS, SUM, TANK, pi};
use controller_core::PidConfig;

/// `Kp` and `Ti` of table 1 as printed.
pub(super) const TABLE_1: [(f64, f64); 3] = [(3.3, 35.2), (0.71, 57.9), (0.13, 48.9)];
/// Those of table 2.
pub(super) const TABLE_2: [(f64, f64); 3] = [(11.0, 19.9), (2.16, 41.0), (0.31, 36.1)];
/// Those of table 6: name, `Ms`, `Kp`, `Ti`.
pub(super) const TABLE_6: [(&str, f64, f64, f64); 2] = [("C1", 1.2, 2.2, 24.6), ("C2", 2.0, 6.6, 10.9)];

pub(super) fn first(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    plants(1.2, TABLE_1, values)
}

pub(super) fn second(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    plants(2.0, TABLE_2, values)
}

pub(super) fn tank(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for (row, ms, kp, ti) in TABLE_6 {
        put(row, TANK, ms, pi(kp, ti), values)?;
        for (part, label) in PARTS.iter().zip(["83.5", "8.35", "0.835"]) {
            values.put(row, &format!("alpha {label}"), part * (80.3 + 3.2));
        }
    }
    Ok(())
}

fn plants(ms: f64, printed: [(f64, f64); 3], values: &mut Values) -> Result<(), Stop> {
    for (i, ((_, text), (kp, ti))) in PLANTS.iter().zip(printed).enumerate() {
        let row = format!("plant {}", i + 1);
        put(&row, text, ms, pi(kp, ti), values)?;
        for (part, label) in PARTS.iter().zip(["100", "10", "1"]) {
            values.put(&row, &format!("alpha {label}"), part * SUM);
        }
    }
    Ok(())
}

fn put(row: &str, text: &str, ms: f64, printed: PidConfig, values: &mut Values) -> Result<(), Stop> {
    let optimal = Loop::optimal(text, ms)?;
    let PidConfig { kp, ki, .. } = optimal.pid;
    values.row(row, [("Kp", kp), ("Ti", kp / ki), ("Ki", ki), ("Ms", optimal.ms(None)?)]);
    values.put(&format!("{row}, printed PI"), "Ms", Loop::new(text, printed)?.ms(None)?);
    Ok(())
}
