//! Skogestad's half rule: from a plant of real lags to a model of first or second order.

use std::vec::Vec;

use super::simple::{Fopdt, Ipdt, Sopdt};
use super::{Complex, TransferFunction};
use crate::Refusal;

/// What the half rule makes of a plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HalfRule {
    /// One lag is kept.
    First(Fopdt),
    /// Two lags are kept.
    Second(Sopdt),
    /// The integrator is kept.
    Integrating(Ipdt),
    /// The integrator and one lag are kept: `gain*exp(-dead_time*s)/(s*(1+tau*s))`.
    IntegratingLag(Ipdt, f64),
}

/// How many lags (an integrator is one of them) a model keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// One: for a PI.
    One,
    /// Two: for a PID.
    Two,
}

/// A lag and a faster zero are close below this ratio; 1.6 itself is not, whatever the rounding.
const CLOSE: f64 = 1.6 - 1e-9;

/// A plant as the rule sees it; times in seconds.
struct Lags {
    gain: f64,
    integrating: bool,
    /// Slowest first.
    taus: Vec<f64>,
    /// Those that a zero has been taken from: another zero takes another lag.
    changed: Vec<f64>,
    /// Dead time and right-half-plane zeros.
    delay: f64,
}

impl Lags {
    /// All lags, slowest first.
    fn all(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.taus.iter().chain(&self.changed).copied().collect();
        all.sort_by(|a, b| b.total_cmp(a));
        all
    }
}

/// Skogestad's half rule (Skogestad 2003, "Simple analytic rules for model reduction and PID controller tuning",
/// eqs (10), (11)): of the lags that are not kept, the slowest goes half to the slowest kept one and half to the dead time,
/// the others go to the dead time, as right-half-plane zeros and half a sampling period `ts` \[s\] do. A
/// left-half-plane zero is first cancelled against a lag near it by the approximations T1 to T3 of that paper.
///
/// # Errors
/// Plants with complex, unstable or repeated integrating poles, zeros at 0 or complex zeros; an integrating plant whose
/// zero is slower than its lags.
///
/// ```
/// use controller_design::model::{HalfRule, Keep, half_rule, parse};
/// // Example E1 of the paper: 1/((s+1)(0.2s+1)) has tau = 1.1, dead_time = 0.1.
/// let plant = parse("1/((1+s)*(1+0.2*s))").expect("a valid plant");
/// let HalfRule::First(model) = half_rule(&plant, Keep::One, 0.0)? else { panic!("first order") };
/// assert!((model.tau - 1.1).abs() < 1e-12 && (model.dead_time - 0.1).abs() < 1e-12);
/// # Ok::<(), controller_design::Refusal>(())
/// ```
pub fn half_rule(plant: &TransferFunction, keep: Keep, ts: f64) -> Result<HalfRule, Refusal> {
    let mut lags = lags(plant, ts)?;
    let kept = match keep {
        Keep::One => 1,
        Keep::Two => 2,
    };
    // The integrator is the slowest lag.
    let kept_taus = kept - usize::from(lags.integrating);
    if lags.taus.len() > kept_taus {
        let dropped = lags.taus.split_off(kept_taus);
        let (next, others) = dropped.split_first().unwrap_or((&0.0, &[]));
        lags.delay += 0.5 * next + others.iter().sum::<f64>();
        // Half of it makes the last kept lag slower; an integrator does not get slower.
        if let Some(last) = lags.taus.last_mut() {
            *last += 0.5 * next;
        } else {
            lags.delay += 0.5 * next;
        }
    }
    let (gain, dead_time) = (lags.gain, lags.delay);
    let model = match (lags.integrating, &*lags.taus) {
        (true, []) => HalfRule::Integrating(Ipdt { gain, dead_time }),
        (true, [tau, ..]) => HalfRule::IntegratingLag(Ipdt { gain, dead_time }, *tau),
        (false, []) => HalfRule::First(Fopdt { gain, tau: 0.0, dead_time }),
        (false, [tau]) => HalfRule::First(Fopdt { gain, tau: *tau, dead_time }),
        (false, [one, two, ..]) => HalfRule::Second(Sopdt { gain, a1: one + two, a2: one * two, dead_time }),
    };
    Ok(model)
}

fn lags(plant: &TransferFunction, ts: f64) -> Result<Lags, Refusal> {
    const HELP: &str = "use a rule that takes the plant as it is";
    let refuse = |must| Err(Refusal::Plant { must, help: HELP });
    if plant.integrators() > 1 {
        return Err(Refusal::Plant {
            must: "have at most one integrator",
            help: "close an inner loop around one of them and design for that loop",
        });
    }
    if plant.differentiators() > 0 {
        return Err(Refusal::Plant {
            must: "have no zero at s = 0: no integral action can hold its output",
            help: "control another output",
        });
    }
    // A root p is a time constant -1/p.
    let times = |roots: Vec<Complex>| -> Option<Vec<f64>> {
        let finite = roots.into_iter().filter(|root| root.abs() > 0.0);
        let times: Vec<f64> = finite
            .map(|root| if root.im.abs() <= 1e-6 * root.abs() { -1.0 / root.re } else { f64::NAN })
            .collect();
        times.iter().all(|t| t.is_finite()).then_some(times)
    };
    let Some(mut taus) = times(plant.poles()) else {
        return refuse("have real poles");
    };
    if taus.iter().any(|tau| *tau < 0.0) {
        return Err(Refusal::Plant {
            must: "be stable or integrating",
            help: "stabilise it by an inner loop and design for that loop",
        });
    }
    let Some(zeros) = times(plant.zeros()) else { return refuse("have real zeros") };
    taus.sort_by(|a, b| b.total_cmp(a));
    let inverse: f64 = zeros.iter().filter(|t| **t < 0.0).map(|t| -t).sum();
    let mut lags = Lags {
        gain: plant.gain(),
        integrating: plant.integrators() == 1,
        taus,
        changed: Vec::new(),
        delay: plant.dead_time() + inverse + 0.5 * ts,
    };
    let mut leads: Vec<f64> = zeros.into_iter().filter(|t| *t > 0.0).collect();
    leads.sort_by(|a, b| b.total_cmp(a));
    for lead in leads {
        cancel(&mut lags, lead)?;
    }
    lags.taus = lags.all();
    if lags.gain.is_finite() && lags.delay.is_finite() {
        Ok(lags)
    } else {
        refuse("have time constants of a like order of size")
    }
}

/// Takes a left-half-plane zero `1 + lead*s` away together with a lag near it.
fn cancel(lags: &mut Lags, lead: f64) -> Result<(), Refusal> {
    // About the dead time that a model of one lag will have.
    let theta = match &*lags.all() {
        all if lags.integrating => lags.delay + all.iter().sum::<f64>(),
        [_, second, others @ ..] => lags.delay + 0.5 * second + others.iter().sum::<f64>(),
        _ => lags.delay,
    };
    let larger = lags.taus.iter().rposition(|tau| *tau >= lead);
    let smaller = lags.taus.iter().position(|tau| *tau < lead);
    let near = |i: usize| {
        let ratio = lead / lags.taus[i];
        ratio < CLOSE && larger.is_none_or(|l| ratio < lags.taus[l] / lead)
    };
    match (larger, smaller) {
        (Some(larger), small) if !small.is_some_and(near) => {
            let tau = lags.taus[larger];
            if lead >= 5.0 * theta {
                // T2
                lags.gain *= lead / tau;
                lags.taus.remove(larger);
            } else {
                // T3
                let short = tau.min(5.0 * theta).max(lead);
                lags.gain *= short / tau;
                lags.taus.remove(larger);
                if short > lead {
                    lags.changed.push(short - lead);
                }
            }
            Ok(())
        }
        (_, Some(smaller)) if !lags.integrating || near(smaller) => {
            let tau = lags.taus.remove(smaller);
            // T1, T1a, T1b
            lags.gain *= if tau >= theta {
                lead / tau
            } else if lead >= theta && theta > 0.0 {
                lead / theta
            } else {
                1.0
            };
            Ok(())
        }
        _ => Err(Refusal::Plant {
            must: "have a lag for every zero in the left half plane",
            help: "use a rule that takes the plant as it is",
        }),
    }
}
