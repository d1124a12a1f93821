//! Peaks of the optimal load response.

use super::super::bench::{Bench, Stop};
use super::super::values::Values;
use super::process::{Optimum, SHOWN};
use controller_design::response::{ContinuousResponse, Load};

pub(super) fn all(bench: &Bench<'_>, values: &mut Values) -> Result<(), Stop> {
    for one in Optimum::of(bench, &SHOWN)? {
        let response = ContinuousResponse::new(&one.plant, &one.pid, None)?;
        let peaks = response.peaks(Load::Step, 3)?;
        let [first, second, third] = &*peaks else { continue };
        let (down, up) = (first.e / second.e, third.e / second.e);
        values.row(
            &one.row(),
            [
                ("P1/P2", down),
                ("P3/P2", up),
                ("product", down * up),
                ("tmin/tmax", second.t / first.t),
                ("t3/tmax", third.t / first.t),
            ],
        );
    }
    Ok(())
}
