//! The indices of a loop after unit steps of the set-point and of the load.

use super::row::Numbers;
use crate::design_run::run_design;
use crate::simulate::Metrics;
use controller_core::PidConfig;
use controller_design::Refusal;
use controller_design::design::{Design, Law};
use controller_design::model::TransferFunction;
use controller_design::response::{ContinuousResponse, Indices, Load};

/// Longest window of a sampled loop, in samples.
const LONGEST: f64 = 2e5;
/// How near an estimator's model must be to the plant to be the plant.
const SAME: f64 = 1e-9;

/// The set-point first.
pub(super) type Both = [Numbers; 2];

/// Whether the continuous loop has exact responses: a PID, with a block whose model is the plant.
pub(super) fn is_exact(plant: &TransferFunction, law: &Law) -> bool {
    match law {
        Law::Pid { estimator: None, .. } => true,
        Law::Pid { estimator: Some(model), .. } => {
            let den = plant.den_polynomial();
            let near = |x: f64, y: f64| (x - y).abs() <= SAME * y.abs();
            let has_zeros = plant.relative_degree() != plant.order();
            plant.integrators() == 0
                && plant.order() <= 2
                && !has_zeros
                && near(model.gain, plant.gain())
                && near(model.a1, den.coefficient(1))
                && near(model.a2, den.coefficient(2))
                && near(model.dead_time, plant.dead_time())
        }
        Law::Adrc(_) => false,
    }
}

/// The responses of the continuous loop; those to the set-point are the same for every loop of one PID.
#[derive(Debug, Default)]
pub(super) struct Continuous {
    setpoints: Vec<(PidConfig, Result<Numbers, Refusal>)>,
}

impl Continuous {
    /// Up to `horizon` \[s\], the same in every call, or to the end.
    pub(super) fn responses(
        &mut self,
        plant: &TransferFunction,
        law: &Law,
        horizon: Option<f64>,
    ) -> Result<Both, Refusal> {
        let Law::Pid { pid, estimator, observer } = law else {
            return Err(Refusal::NoSolution {
                why: "this law has no exact responses",
                help: "give ts, and the sampled loop is simulated",
            });
        };
        let response = match (estimator, observer) {
            (Some(e), _) => ContinuousResponse::with_estimator(plant, pid, e.kfd, e.tfd)?,
            (None, Some(observer)) => ContinuousResponse::with_alpha(plant, pid, observer.alpha)?,
            (None, None) => ContinuousResponse::new(plant, pid, None)?,
        };
        let load = match horizon {
            None => response.indices(Load::Step),
            Some(end) => response.indices_until(Load::Step, end),
        };
        let load = numbers(load?);
        let known = self.setpoints.iter().find(|(other, _)| other == pid).map(|(_, known)| *known);
        let setpoint = known.unwrap_or_else(|| {
            let alone = ContinuousResponse::new(plant, pid, None);
            let found = alone.and_then(|alone| match horizon {
                None => alone.setpoint_indices(),
                Some(end) => alone.setpoint_indices_until(end),
            });
            let found = found.map(numbers);
            self.setpoints.push((*pid, found));
            found
        })?;
        Ok([setpoint, load])
    }
}

fn numbers(i: Indices) -> Numbers {
    [i.ie, i.iae, i.ise, i.itae, i.e_max, i.tv]
}

/// Those of the sampled loop, simulated as it runs.
pub(super) fn sampled(made: &Design) -> Result<Both, String> {
    let run = run_design(made, LONGEST).ok_or("the sampled loop cannot be run")?;
    if let Some(trouble) = run.cut.or_else(|| run.troubles.into_iter().next()) {
        return Err(trouble);
    }
    let numbers = |m: Metrics| [m.ie, m.iae, m.ise, m.itae, m.e_max, m.tv];
    Ok([numbers(run.setpoint), numbers(run.load)])
}

/// Those to which the sampled loop tends as its period goes to 0, the law kept: what sampling does to the indices is
/// proportional to the period, so two of them tell it.
pub(super) fn extrapolated(made: &Design) -> Result<Both, String> {
    let coarse = sampled(made)?;
    let fine = sampled(&Design { ts: 0.5 * made.ts, ..made.clone() })?;
    Ok(std::array::from_fn(|i| std::array::from_fn(|j| 2.0 * fine[i][j] - coarse[i][j])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_design::design::{Method, ObserverFilter, Request, design};
    use controller_design::model::parse;

    /// The two ways share nothing: one simulates the laws that run, the other solves the continuous equations.
    #[test]
    fn extrapolated_indices_are_the_exact_ones_within_a_thousandth() {
        for (text, ts) in [("exp(-s)/(1+2*s)", 0.01), ("2*exp(-0.5*s)/((1+s)*(1+0.4*s))", 0.01)] {
            let plant = parse(text).expect("a plant");
            for method in [Method::PiMs, Method::Dob, Method::Simc, Method::DeMomi] {
                let filter = ObserverFilter::NoiseRatio(2.0);
                let request = Request { observer_filter: filter, ..Request::new(method, ts) };
                let made = design(&plant, &request).expect("a design");
                assert!(is_exact(&plant, &made.law), "{text} {method:?}");
                let exact = Continuous::default().responses(&plant, &made.law, None).expect("a stable loop");
                let near = extrapolated(&made).expect("a stable loop");
                for (i, (exact, near)) in exact.iter().zip(&near).enumerate() {
                    for (j, (x, y)) in exact.iter().zip(near).enumerate() {
                        // IE of an observer is 0.
                        let scale = if j == 0 { exact[1] } else { x.abs() };
                        assert!((x - y).abs() <= 1e-3 * scale, "{text} {method:?} {i} {j}: {x} {y}");
                    }
                }
            }
        }
    }
}
