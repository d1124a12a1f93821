//! What practice says of the figures, and whose practice that is.

use super::costs::Cost;
use super::deployed::Deployed;
use super::frequency::Frequency;
use super::limits::{AtLimits, BAND};
use super::smallest::Smallest;
use super::{Better, Figure, Light, LoopCard};
use crate::output::table::format_number;
use crate::scenario::CompensatorSpec;
use controller_core::Real;
use controller_design::rules::PiMs;

/// Cycles of an instruction that are reckoned with.
const CYCLES: f64 = 2.0;

/// Good from the first bound on, bad beyond the second one.
fn light(value: f64, better: Better, good: f64, bad: f64) -> Light {
    let is = |bound: f64| match better {
        Better::Smaller => value <= bound,
        Better::Larger => value >= bound,
    };
    if is(good) {
        Light::Good
    } else if is(bad) {
        Light::Look
    } else {
        Light::Bad
    }
}

/// Units of the scenario, `u` and `y` where it has none.
fn units<T: Real>(deployed: &Deployed<'_, T>) -> [String; 2] {
    let units = &deployed.scenario.units;
    let named = |unit: &str, symbol: &str| {
        let unit: String = unit.trim().chars().take(20).collect();
        if unit.is_empty() { symbol.to_owned() } else { unit }
    };
    [named(&units.y, "y"), named(&units.u, "u")]
}

pub(super) fn judge_frequency<T: Real>(card: &mut LoopCard, deployed: &Deployed<'_, T>, found: &Frequency) {
    let Frequency { margins: m, jitter, noise, increment } = found;
    let ts = deployed.scenario.ts;
    let [y, u] = units(deployed);
    let mut add = |key, title, unit: &str, value: f64, better, light, practice: &str, note: String| {
        let (unit, practice) = (unit.to_owned(), practice.to_owned());
        card.figures.push(Figure { key, title, unit, value, better, light, practice, note });
    };
    let (small, large) = (Better::Smaller, Better::Larger);

    let judged = if m.ms < 1.2 { Light::Look } else { light(m.ms, small, 2.0, 3.0) };
    let practice = "1.2 to 2.0, above 3 bad (\u{c5}str\u{f6}m & H\u{e4}gglund 2006; at 3 only 19\u{b0} of phase are sure)";
    let note = if m.ms < 1.2 { "cautious: the loop could be faster".to_owned() } else { String::new() };
    add("ms", "Ms, largest sensitivity", "", m.ms, small, judged, practice, note);
    let practice = "at most 1.25, bad above 2 (Skogestad & Postlethwaite 2005: 2 dB)";
    add(
        "mt",
        "Mt, largest complementary sensitivity",
        "",
        m.mt,
        small,
        light(m.mt, small, 1.25, 2.0),
        practice,
        String::new(),
    );
    let practice = "2 to 5, more is no fault; below 1.5 bad (\u{c5}str\u{f6}m & H\u{e4}gglund 2006)";
    add("gm", "gain margin", "", m.gm, large, light(m.gm, large, 2.0, 1.5), practice, String::new());
    if m.gm_low > 0.0 {
        let practice = "at most 1/2, bad above 2/3: the bounds of the gain margin, downwards";
        let note = "the loop is unstable with a smaller gain, too".to_owned();
        add(
            "gm_low",
            "gain margin downwards",
            "",
            m.gm_low,
            small,
            light(m.gm_low, small, 0.5, 2.0 / 3.0),
            practice,
            note,
        );
    }
    let practice =
        "30 to 60\u{b0}, more is no fault; below 20\u{b0} bad (\u{c5}str\u{f6}m & H\u{e4}gglund 2006)";
    add(
        "pm_deg",
        "phase margin",
        "deg",
        m.pm_deg,
        large,
        light(m.pm_deg, large, 30.0, 20.0),
        practice,
        String::new(),
    );
    let samples = |time: f64| {
        if time.is_finite() { format!("{} samples", format_number(time / ts)) } else { String::new() }
    };
    let practice = "at least 10 samples, below 2 bad (this program's; \u{c5}str\u{f6}m & Wittenmark 1997 sample every 0.15 to 0.5 rad of the crossover, with margins of 30 to 60\u{b0} that is 1 to 7 samples)";
    let judged = light(m.delay_margin / ts, large, 10.0, 2.0);
    add(
        "delay_margin",
        "delay margin",
        "s",
        m.delay_margin,
        large,
        judged,
        practice,
        samples(m.delay_margin),
    );
    let practice = "at least 1 sample, below 0.1 bad (Cervin et al. 2004: a task that keeps its deadline is late by up to its period)";
    let judged = light(jitter / ts, large, 1.0, 0.1);
    let note = match samples(*jitter) {
        of if of.is_empty() => of,
        of => format!(
            "{of}; sufficient for any lateness from 0 to this, another one each sample (Kao & Lincoln 2004)"
        ),
    };
    add("jitter_margin", "jitter margin", "s", *jitter, large, judged, practice, note);

    noise_figures(&mut add, deployed, (noise.step, noise.white, *increment), (&y, &u));
    match integral_gain(deployed, m.ms) {
        Some(Integral { ki, own, of_best }) => {
            let practice = "at least half of what a PI can have at the same Ms, below a tenth bad (\u{c5}str\u{f6}m, Panagopoulos & H\u{e4}gglund 1998: the largest ki at a given Ms; the shares are this program's)";
            let (judged, note) = match of_best {
                Some(share) if share.is_finite() => (
                    light(share, large, 0.5, 0.1),
                    format!("{} of the PI with the largest ki at this Ms", format_number(share)),
                ),
                Some(_) => (Light::Good, "no integral of the error is left after a load".to_owned()),
                None => (Light::Good, "no PI of the same plant to compare with".to_owned()),
            };
            let note = if ki == own {
                format!("{note}; 1/K_i is the integral of the error after a unit load")
            } else {
                format!(
                    "{note}; 1/K_i is the integral of the error after a unit load, of which the disturbance block takes its \
                     share; ki of the PID {}",
                    format_number(own)
                )
            };
            add("ki", "K_i, integral gain", &format!("{u}/({y} s)"), ki, large, judged, practice, note);
        }
        None if deployed.spec.adrc.is_some() => {
            card.absent.push(("ki", "an ADRC integrates in its observer".to_owned()));
        }
        None => card.absent.push(("ki", "the law has no integral term".to_owned())),
    }
}

type Add<'a> = dyn FnMut(&'static str, &'static str, &str, f64, Better, Light, &str, String) + 'a;

fn noise_figures<T: Real>(
    add: &mut Add<'_>,
    deployed: &Deployed<'_, T>,
    (step, white, increment): (f64, f64, f64),
    (y, u): (&str, &str),
) {
    let small = Better::Smaller;
    let ts = deployed.scenario.ts;
    let unit = format!("{u}/{y}");
    // What the output would do without derivative action and filter.
    let plain = plain_gain(deployed);
    let practice = "at most 10 times the proportional gain, above 20 bad (\u{c5}str\u{f6}m & H\u{e4}gglund 1995: derivative filters with N of 8 to 20)";
    let times = |x: f64| format!("{} times the proportional gain", format_number(x / plain));
    let judged = light(step / plain, small, 10.0, 20.0);
    add("noise_gain", "A_n, jump of u for a jump of y", &unit, step, small, judged, practice, times(step));
    let (range, said) = deployed.range();
    let std = deployed.scenario.noise.map_or(0.0, |noise| noise.std);
    let moved = white * std;
    if said && std > 0.0 {
        let share = moved / (range.1 - range.0);
        let practice = "noise moves the output by at most 5 % of its range, above 20 % bad (the bound that tuning by this program has)";
        let note = format!(
            "{} {u}, {} % of the range, of the file's noise",
            format_number(moved),
            format_number(100.0 * share)
        );
        add(
            "noise_std",
            "std(u)/std(n), white noise",
            &unit,
            white,
            small,
            light(share, small, 0.05, 0.2),
            practice,
            note,
        );
    } else {
        let judged = light(white / plain, small, 10.0, 20.0);
        add("noise_std", "std(u)/std(n), white noise", &unit, white, small, judged, practice, times(white));
    }
    // Of Gaussian noise: E|x| = sqrt(2/pi)*std(x); of a plain gain std(u[k] - u[k-1]) = sqrt(2)*gain.
    let each = libm::sqrt(2.0 / core::f64::consts::PI) * increment;
    let of_plain = 2.0 / libm::sqrt(core::f64::consts::PI) * plain;
    let judged = light(each / of_plain, small, 10.0, 20.0);
    let practice = "at most 10 times that of the proportional gain alone, above 20 bad (as for A_n)";
    let note = format!(
        "{} {unit} a sample, {} times that of the proportional gain",
        format_number(each),
        format_number(each / of_plain)
    );
    add(
        "noise_tv",
        "TV of u by noise, per second and std(n)",
        &format!("{unit}/s"),
        each / ts,
        small,
        judged,
        practice,
        note,
    );
}

/// The gain from the error to the output that the law would have without any dynamics [u/y].
fn plain_gain<T: Real>(deployed: &Deployed<'_, T>) -> f64 {
    let config = &deployed.spec.config.pid;
    let gain = match &deployed.spec.adrc {
        Some(adrc) => adrc.kp / adrc.b0,
        None => config.kp,
    };
    let gain = if gain == 0.0 { config.ki * deployed.scenario.ts } else { gain };
    // Without any gain nothing is amplified.
    if gain == 0.0 { f64::INFINITY } else { gain.abs() }
}

/// What integrates.
struct Integral {
    /// The inverse of the integral of the error after a unit load \[u/(y s)\]: what integrates takes over what the disturbance
    /// block leaves to it, `1 - kfd` with an estimator and nothing with an observer, whatever their models are.
    ki: f64,
    /// `ki` of the PID \[u/(y s)\].
    own: f64,
    /// `ki` over the largest one of a PI at the same Ms.
    of_best: Option<f64>,
}

fn integral_gain<T: Real>(deployed: &Deployed<'_, T>, ms: f64) -> Option<Integral> {
    let pid = deployed.law.pid()?;
    let ts = deployed.scenario.ts;
    let own = ((pid.ki_now.to_f64() + pid.ki_before.to_f64()) / ts).abs();
    if own == 0.0 {
        return None;
    }
    let left = match &deployed.spec.compensator {
        CompensatorSpec::None => 1.0,
        CompensatorSpec::Estimator(estimator) => 1.0 - estimator.kfd,
        CompensatorSpec::Observer(_) => 0.0,
    };
    let ki = own / left;
    let plant = &deployed.scenario.plant;
    // The hold takes half a sample.
    let late = plant.with_dead_time(plant.dead_time() + deployed.scenario.latency + 0.5 * ts).ok();
    let best = late.and_then(|late| PiMs::new(&late, ms.clamp(1.2, 2.0)).ok());
    Some(Integral { ki, own, of_best: best.map(|best| ki / best.pid.ki.abs()) })
}

pub(super) fn judge_smallest<T: Real>(
    card: &mut LoopCard,
    deployed: &Deployed<'_, T>,
    found: Option<Smallest>,
) {
    let Some(found) = found else {
        card.absent.push(("smallest_error", "no constant error moves the output".to_owned()));
        return;
    };
    let [y, _] = units(deployed);
    let scenario = deployed.scenario;
    let noise = scenario.noise.map_or(0.0, |noise| noise.std);
    let (seen, whose) = match (scenario.sensor.resolution, noise) {
        (step, _) if step > 0.0 => (step, "the step of the sensor"),
        (_, std) if std > 0.0 => (std, "the noise of the file"),
        _ => (1e-3 * deployed.point.setpoint.abs(), "a thousandth of the set-point's step"),
    };
    let when = match found.seen {
        Some(1) => "it moves the output of the real step".to_owned(),
        Some(n) => format!("the real step still moves the output with it after {n} samples"),
        None => "derived, a trial would take more than a million samples".to_owned(),
    };
    let number = |x: f64| format_number(x);
    let note = format!(
        "at {} {y}: {when}; the measurement steps by {}{}",
        number(found.level),
        number(found.spacing),
        if found.sum.is_finite() {
            format!(", the compensated sum takes {}, a plain one {}", number(found.sum), number(found.plain))
        } else {
            String::new()
        }
    );
    card.figures.push(Figure {
        key: "smallest_error",
        title: "smallest error that moves u",
        unit: y,
        value: found.error,
        better: Better::Smaller,
        light: light(found.error, Better::Smaller, seen, 10.0 * seen),
        practice: format!("at most {whose}, above 10 times that bad (what is measured must count; the bounds are this program's)"),
        note,
    });
}

pub(super) fn judge_costs<T: Real>(card: &mut LoopCard, deployed: &Deployed<'_, T>, cost: Option<Cost>) {
    let board = card.board;
    let Some(cost) = cost else {
        let why = format!("nothing is published for {}", board.name);
        card.absent.extend([("ram", why.clone()), ("instructions", why)]);
        return;
    };
    let (small, bytes) = (Better::Smaller, cost.ram as f64);
    card.figures.push(Figure {
        key: "ram",
        title: "RAM, law and state",
        unit: "bytes".to_owned(),
        value: bytes,
        better: small,
        light: light(bytes, small, 1024.0, 4096.0),
        practice: "at most 1 kB, above 4 kB bad (a quarter of the RAM of the smallest Cortex-M0 parts, and all of it)".to_owned(),
        note: format!("{} ({})", board.core, board.name),
    });
    let Some(most) = cost.most.or(cost.usual) else {
        let why = "nothing is published for a compensator of this size".to_owned();
        card.absent.push(("instructions", why));
        return;
    };
    let share = CYCLES * most as f64 / f64::from(board.clock) / deployed.scenario.ts;
    let usual = match (cost.most, cost.usual) {
        (Some(_), Some(usual)) => format!("at most {usual} in a usual sample; "),
        _ => "a usual sample, the sum of its blocks; ".to_owned(),
    };
    card.figures.push(Figure {
        key: "instructions",
        title: if cost.most.is_some() { "instructions of a step, at most" } else { "instructions of a step, about" },
        unit: String::new(),
        value: most as f64,
        better: small,
        light: light(share, small, 0.1, 0.69),
        practice: "at most 10 % of ts, above 69 % bad (Liu & Layland 1973: beyond ln 2 periodic tasks may miss deadlines)".to_owned(),
        note: format!(
            "{usual}{} ({}): {} % of ts at {} MHz and {CYCLES} cycles each",
            board.core,
            board.name,
            format_number(100.0 * share),
            f64::from(board.clock) / 1e6
        ),
    });
}

pub(super) fn judge_limits(card: &mut LoopCard, tried: Result<AtLimits, String>) {
    let tried = match tried {
        Ok(tried) => tried,
        Err(why) => {
            card.absent.extend([("limit_recovery", why.clone()), ("limit_overshoot", why)]);
            return;
        }
    };
    let small = Better::Smaller;
    let (recovery, overshoot) = tried.free;
    let range = format!(
        "{} {} to {}",
        if tried.said { "limits" } else { "no limits in the file, assumed" },
        format_number(tried.range.0),
        format_number(tried.range.1)
    );
    card.figures.push(Figure {
        key: "limit_recovery",
        title: "recovery from a limit",
        unit: "s".to_owned(),
        value: tried.recovery,
        better: small,
        light: light(tried.recovery, small, 1.5 * recovery, 3.0 * recovery),
        practice: "at most 1.5 times the same step without limits, above 3 times bad (after \u{c5}str\u{f6}m & H\u{e4}gglund 2006 a saturated loop should come back as if it had not wound up)".to_owned(),
        note: format!("to within {} % of the step; without limits {} s; {range}", 100.0 * BAND, shown(recovery)),
    });
    card.figures.push(Figure {
        key: "limit_overshoot",
        title: "overshoot after a limit",
        unit: "%".to_owned(),
        value: tried.overshoot,
        better: small,
        light: light(tried.overshoot, small, overshoot + 10.0, overshoot + 30.0),
        practice: "at most 10 % more than the same step without limits, above 30 % bad (as for the recovery)"
            .to_owned(),
        note: format!("of the step; without limits {} %", shown(overshoot)),
    });
    card.trials.push(tried.trial);
}

/// A number, the word where there is none.
fn shown(x: f64) -> String {
    if x == f64::INFINITY { "inf".to_owned() } else { format_number(x) }
}
