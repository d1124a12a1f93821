//! What a person should know about a loop before it runs.

use super::Analysis;
use controller_core::PidConfig;

/// Fewest samples of delay margin that leave room for a late task.
const LEAST_SAMPLES: f64 = 10.0;
/// Largest sensitivity peak that is usual.
const USUAL_MS: f64 = 2.0;
/// Share by which sampling may change the sensitivity peak before it is worth saying.
const CHANGED: f64 = 0.1;

pub(super) fn of(analysis: &Analysis, pid: &PidConfig) -> Vec<String> {
    let mut list = Vec::new();
    let ts = analysis.sampled.ts();
    if !analysis.is_stable() {
        let poles = match analysis.unstable_poles {
            1 => "1 pole is".to_owned(),
            n => format!("{n} poles are"),
        };
        list.push(format!("the sampled loop is unstable: {poles} outside the unit circle or on it"));
    }
    if let Err(refusal) = &analysis.continuous.margins {
        list.push(format!("continuous design: {refusal}"));
    }
    if let Ok(margins) = &analysis.discrete.margins {
        let samples = margins.delay_margin / ts;
        if samples < LEAST_SAMPLES {
            list.push(format!(
                "the delay margin is {samples:.1} samples, below 10: ts is too long for this loop"
            ));
        }
        if margins.ms > USUAL_MS {
            list.push(format!(
                "Ms is {:.2}, above 2: the loop tolerates little change of the plant",
                margins.ms
            ));
        }
        if let Ok(continuous) = &analysis.continuous.margins
            && margins.ms > (1.0 + CHANGED) * continuous.ms
        {
            let share = 100.0 * (margins.ms / continuous.ms - 1.0);
            list.push(format!(
                "sampling raises Ms by {share:.0} %: the continuous design does not hold at this ts"
            ));
        }
    }
    if pid.tf > 0.0 && pid.tf < ts {
        list.push("tf is shorter than ts and filters little".to_owned());
    }
    list
}
