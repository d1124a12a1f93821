//! Table 7: the tanks.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::designs::TABLE_6;
use super::loops::{Loop, TANK, pi};

/// The printed `alpha` \[s\].
const ALPHAS: [f64; 3] = [83.5, 8.35, 0.835];

pub(super) fn all(_: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for (name, ms, kp, ti) in TABLE_6 {
        let (printed, optimal) = (Loop::new(TANK, pi(kp, ti))?, Loop::optimal(TANK, ms)?);
        for alpha in ALPHAS {
            put(&format!("{name}, alpha {alpha}"), &printed, alpha, values)?;
            put(&format!("{name}, alpha {alpha}, optimal PI"), &optimal, alpha, values)?;
        }
    }
    // What 6.6 may have been before it was printed.
    let (_, _, _, ti) = TABLE_6[1];
    let other = Loop::new(TANK, pi(6.65, ti))?;
    for alpha in ALPHAS.into_iter().take(2) {
        let r = other.ratios(alpha)?;
        let row = format!("C2, alpha {alpha}, Kp = 6.65");
        values.row(&row, [("IAE", r.iae), ("ISE", r.ise), ("ITAE", r.itae)]);
    }
    Ok(())
}

fn put(row: &str, one: &Loop, alpha: f64, values: &mut Values) -> Result<(), Stop> {
    let r = one.ratios(alpha)?;
    values.row(row, [("IAE", r.iae), ("ISE", r.ise), ("ITAE", r.itae), ("emax", r.e_max)]);
    Ok(())
}
