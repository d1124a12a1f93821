//! A sampled controller on a finely sampled plant: unit steps from rest and the usual integral measures.

use super::sampled_plant::SampledPlant;

/// What is stepped by one, from rest, at the sample 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitStep {
    /// The reference r (tracking).
    Reference,
    /// The disturbance d at the plant input (disturbance rejection).
    InputDisturbance,
}

/// Record and measures of one experiment; `e = r - y`, the time t counts from the step.
#[derive(Clone, Debug)]
pub struct LoopResponse {
    /// `int |e| dt` over the horizon, between the samples too \[y s\].
    pub iae: f64,
    /// `int e^2 dt`, between the samples too \[y^2 s\].
    pub ise: f64,
    /// `int t |e| dt`, between the samples too \[y s^2\].
    pub itae: f64,
    /// Largest `|e|`, between the samples too.
    pub e_max: f64,
    /// `ts sum e[k]` over the samples \[y s\].
    pub ie: f64,
    /// Total variation `sum |u[k] - u[k-1]|` from `u[-1] = 0`.
    pub tv: f64,
    /// Plant output at the samples.
    pub y: Vec<f64>,
    /// Controller output at the samples.
    pub u: Vec<f64>,
}

/// Runs a loop from rest over `horizon` \[s\] with a unit step at the time 0; `controller` maps
/// `(r[k], y[k])` to the output held over `[k ts, (k+1) ts)`.
///
/// `plant` must be at rest and sampled at a whole fraction of the controller's `ts` \[s\]; the integrals of
/// `e` are trapezoids on the plant's grid. A twentieth of `ts` makes them good to better than 1e-5.
pub fn run_unit_step(
    ts: f64,
    mut plant: SampledPlant,
    step: UnitStep,
    horizon: f64,
    mut controller: impl FnMut(f64, f64) -> f64,
) -> LoopResponse {
    let fine = plant.ts();
    let substeps = (ts / fine).round();
    assert!(substeps >= 1.0 && (substeps * fine / ts - 1.0).abs() < 1e-12, "the grids do not match");
    let (r, d) = match step {
        UnitStep::Reference => (1.0, 0.0),
        UnitStep::InputDisturbance => (0.0, 1.0),
    };
    let (mut iae, mut ise, mut itae, mut e_max, mut ie, mut tv) = (0.0, 0.0, 0.0, 0.0_f64, 0.0, 0.0);
    let (mut y, mut u) = (vec![], vec![]);
    let samples = (horizon / ts).round() as usize;
    for k in 0..samples {
        let measured = plant.output();
        let output = controller(r, measured);
        ie += ts * (r - measured);
        tv += (output - u.last().copied().unwrap_or(0.0)).abs();
        y.push(measured);
        u.push(output);
        for i in 0..substeps as usize {
            let time = k as f64 * ts + i as f64 * fine;
            let before = r - plant.step(output, d);
            let after = r - plant.output();
            iae += 0.5 * fine * (before.abs() + after.abs());
            ise += 0.5 * fine * (before * before + after * after);
            itae += 0.5 * fine * (time * before.abs() + (time + fine) * after.abs());
            e_max = e_max.max(before.abs());
        }
    }
    LoopResponse { iae, ise, itae, e_max, ie, tv, y, u }
}

#[cfg(test)]
mod tests {
    use super::super::state_space::PlantFactors;
    use super::*;

    /// A lag of 1 s behind a dead time of 0.2 s, a constant output of 1 after a reference step: everything is
    /// known.
    #[test]
    fn measures_of_an_exponential() {
        let plant = PlantFactors { lags: &[1.0], dead_time: 0.2, ..PlantFactors::UNITY };
        let response = run_unit_step(0.1, plant.sampled(0.002), UnitStep::Reference, 40.0, |r, _| r);
        // e = 1 up to 0.2, then e^{-(t - 0.2)}.
        assert!((response.iae - 1.2).abs() < 1e-6);
        assert!((response.ise - 0.7).abs() < 1e-6);
        assert!((response.itae - (0.02 + 1.2)).abs() < 1e-6);
        assert!((response.ie - (0.2 + 0.1 / -(-0.1_f64).exp_m1())).abs() < 1e-12);
        assert_eq!((response.e_max, response.tv, response.u.len()), (1.0, 1.0, 400));
    }

    #[test]
    fn a_disturbance_enters_with_the_controller_output() {
        let plant = PlantFactors { gain: 2.0, lags: &[1.0], ..PlantFactors::UNITY };
        let response = run_unit_step(0.5, plant.sampled(0.5), UnitStep::InputDisturbance, 30.0, |_, _| 0.25);
        assert!((response.y[59] - 2.5).abs() < 1e-12);
        assert_eq!(response.y[0], 0.0);
    }
}
