//! A lower noise gain where the usual one gives no stable loop.

use super::{ContinuousDesign, Design, Filter, Method, Request};
use crate::margins::{TOO_LONG, TOO_MANY_TURNS};
use crate::{Refusal, Warning, Warnings};

/// From one noise gain to the next.
const STEP: f64 = 0.8;
const STEPS: usize = 24;

impl Design {
    /// The larger `Ms` of the continuous and the sampled loop.
    #[must_use]
    pub const fn ms(&self) -> f64 {
        self.robustness.ms.max(self.sampled.margins.ms)
    }
}

/// What tells whether a design is robust, and takes the note on its noise gain.
pub(super) trait Judged {
    fn peak(&self) -> f64;
    fn kpidn(&self) -> Option<f64>;
    fn warnings(&mut self) -> &mut Warnings;

    /// Whether `Ms` is at most 2.
    fn is_robust(&self) -> bool {
        self.peak() <= super::finish::ROBUST
    }
}

impl Judged for Design {
    fn peak(&self) -> f64 {
        self.ms()
    }

    fn kpidn(&self) -> Option<f64> {
        self.noise.kpidn
    }

    fn warnings(&mut self) -> &mut Warnings {
        &mut self.warnings
    }
}

impl Judged for ContinuousDesign {
    fn peak(&self) -> f64 {
        self.robustness.ms
    }

    fn kpidn(&self) -> Option<f64> {
        self.noise.kpidn
    }

    fn warnings(&mut self) -> &mut Warnings {
        &mut self.warnings
    }
}

/// The design with the largest noise gain below the usual one whose loop is robust; if there is none, the most robust one.
/// `None`: where `refusal` has nothing to do with the noise gain, or nothing helps.
///
/// On plants that are nearly pure dead time the PID of the magnitude optimum leaves more than a loop gain of 1 beyond the
/// dead time, unless its filter is slow.
pub(super) fn calmer<T: Judged>(
    request: &Request,
    usual: f64,
    refusal: &Refusal,
    design: impl Fn(&Request) -> Result<T, Refusal>,
) -> Option<T> {
    let has_noise_gain = matches!(request.method, Method::Momi | Method::Drmo | Method::DeMomi);
    let is_hopeless = *refusal == TOO_LONG || *refusal == TOO_MANY_TURNS;
    let is_loop = matches!(refusal, Refusal::NoSolution { .. });
    if !has_noise_gain || !is_loop || is_hopeless || request.filter != Filter::Default {
        return None;
    }
    let mut best: Option<T> = None;
    let mut kpidn = usual;
    for _ in 0..STEPS {
        kpidn *= STEP;
        match design(&Request { filter: Filter::NoiseGain(kpidn), ..*request }) {
            Ok(made) => {
                let is_better = best.as_ref().is_none_or(|best| made.peak() < best.peak());
                let is_robust = made.is_robust();
                best = if is_better { Some(made) } else { best };
                if is_robust {
                    break;
                }
            }
            Err(Refusal::NoSolution { .. }) => {}
            Err(_) => break,
        }
    }
    let mut made = best?;
    let text = "lowered from 4/|K|, with which the loop is not stable";
    let warning = Warning::Value { about: "kpidn", value: made.kpidn()?, text };
    crate::warning::warn(made.warnings(), warning);
    Some(made)
}
