//! The optimum itself.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{Optimum, SHOWN};

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for one in Optimum::of(bench, &SHOWN)? {
        let [kp, ti, iae] = match one.r {
            Some(_) => ["kp k", "ti/tau", "IAE/(k theta)"],
            None => ["kp k theta", "ti/theta", "IAE/(k theta^2)"],
        };
        values.row(&one.row(), [(kp, one.pid.kp), (ti, one.ti()), (iae, one.iae)]);
    }
    Ok(())
}
