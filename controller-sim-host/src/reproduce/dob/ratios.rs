//! Tables 3 and 4: what an observer changes.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::designs::{TABLE_1, TABLE_2};
use super::loops::{Loop, PARTS, PLANTS, SUM, pi};

/// A table: the sensitivity peak, the printed PI, and the one that the column of the noise tells: plant and `kp`.
struct Task {
    ms: f64,
    printed: [(f64, f64); 3],
    other: (usize, f64),
}

pub(super) fn third(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    all(&Task { ms: 1.2, printed: TABLE_1, other: (1, 0.7048) }, values)
}

pub(super) fn fourth(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    all(&Task { ms: 2.0, printed: TABLE_2, other: (2, 0.304) }, values)
}

fn all(task: &Task, values: &mut Values) -> Result<(), Stop> {
    for (i, ((lag, text), (kp, ti))) in PLANTS.iter().zip(task.printed).enumerate() {
        let optimal = Loop::optimal(text, task.ms)?;
        let printed = Loop::new(text, pi(kp, ti))?;
        for part in PARTS {
            let alpha = part * SUM;
            let row = format!("L {lag}, alpha {alpha}");
            put(&row, &optimal, alpha, values)?;
            values.put(&row, "TV", optimal.ratios(alpha)?.tv);
            values.put(&row, "Ms", optimal.ms(Some(alpha))?);
            let ratios = printed.ratios(alpha)?;
            let row = format!("{row}, printed PI");
            values.put(&row, "TV", ratios.tv);
            // The one figure that the optimum does not explain.
            if task.ms == 2.0 && i == 1 && part == 1.0 {
                values.put(&row, "IAE", ratios.iae);
            }
        }
        if i == task.other.0 {
            let other = Loop::on_curve(text, task.other.1, task.ms)?;
            for part in PARTS {
                let alpha = part * SUM;
                put(&format!("L {lag}, alpha {alpha}, Kp = {}", task.other.1), &other, alpha, values)?;
            }
        }
    }
    Ok(())
}

/// All but TV.
fn put(row: &str, one: &Loop, alpha: f64, values: &mut Values) -> Result<(), Stop> {
    let r = one.ratios(alpha)?;
    values.row(row, [("IAE", r.iae), ("ISE", r.ise), ("ITAE", r.itae), ("emax", r.e_max)]);
    values.put(row, "An", one.noise_ratio(alpha)?);
    Ok(())
}
