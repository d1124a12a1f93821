//! The time that each rule takes for one design, over the 134 test processes and a few others.
//!
//! Prints one line for each rule, with tabulators between the fields: name, number of plants that the rule has a result for,
//! and the median, shortest and longest time in ns. Of each plant the shortest of several measurements counts: whatever else
//! the machine does can only make them longer. `cargo xtask bench` runs this and puts it beside the same in Python; by hand:
//! `cargo bench -p controller-design`, with words to take only the rules that have one of them in their names. With the word
//! `plants` it prints those that Python gets, with the gains found for them.

use std::hint::black_box;
use std::time::{Duration, Instant};

use controller_core::PidConfig;
use controller_design::areas::Areas;
use controller_design::assessment::{AssessOptions, Experiment, assess};
use controller_design::batch134::processes;
use controller_design::design::{Method, Request, design};
use controller_design::identification::{IdentifyOptions, Recording, identify};
use controller_design::margins::{ContinuousLoop, DiscreteLaw, DiscreteLoop};
use controller_design::model::{Fopdt, Keep, TransferFunction, half_rule, parse};
use controller_design::response::{ContinuousResponse, Load};
use controller_design::rules::adrc::AdrcDesign;
use controller_design::rules::ah::{AhMs, AhPid};
use controller_design::rules::amigo::Amigo;
use controller_design::rules::de_momi::DeMomi;
use controller_design::rules::drmo::Drmo;
use controller_design::rules::fits::AirikkaPi;
use controller_design::rules::momi::Momi;
use controller_design::rules::observer::ObserverDesign;
use controller_design::rules::reduction::Reduced;
use controller_design::rules::simc::Simc;
use controller_design::rules::{PiIae, PiMs, Wish, alpha_for};

/// Plants of kinds that the 134 processes do not have.
const OTHERS: [&str; 10] = [
    "1.98*exp(-3.2*s)/(1+80.3*s)",
    "-250*exp(-40*s)/((1+300*s)*(1+20*s)^2)",
    "exp(-0.2*s)/((1+0.2*s)*(1+s))",
    "3*(1+4*s)*exp(-s)/((1+2*s)*(1+s)^2)",
    "0.02*(1-1.5*s)*exp(-0.5*s)/((1+3*s)*(1+s))",
    "1e6/(1+1e-6*s)^5",
    "exp(-1e5*s)/(1+2e5*s)",
    "2*exp(-0.3*s)/(1+0.8*s+s^2)",
    "-0.3*exp(-2*s)/s",
    "5*exp(-s)/((1+12*s)*(1+4*s+6*s^2))",
];

/// The sampling period, as a share of the sum of the plant's times.
const SAMPLING: f64 = 0.005;
/// The sensitivity peak designed for.
const MS: f64 = 1.4;

/// A plant and what rules start from.
struct Case {
    plant: TransferFunction,
    ts: f64,
    areas: Option<Areas>,
    model: Option<Reduced>,
    lag: Option<Fopdt>,
    /// The PI with the sensitivity peak [`MS`].
    pi: Option<PidConfig>,
    /// Its IAE after a step of the load.
    iae: Option<f64>,
}

impl Case {
    fn new(expression: &str) -> Self {
        let plant = parse(expression).expect("a valid plant");
        let roots = plant.poles().into_iter().chain(plant.zeros()).map(|root| root.abs());
        let times = roots.filter(|size| *size > 0.0).map(f64::recip).sum::<f64>() + plant.dead_time();
        let areas = plant.areas6().ok();
        let pi = PiMs::new(&plant, MS).ok().map(|design| design.pid);
        let response = pi.and_then(|pid| ContinuousResponse::new(&plant, &pid, None).ok());
        Self {
            ts: SAMPLING * times,
            model: areas.as_ref().and_then(|areas| Reduced::new(areas).ok()),
            lag: Fopdt::from_areas(&plant).ok().filter(|lag| lag.tau > 0.0 && lag.dead_time > 0.0),
            iae: response.and_then(|response| response.indices(Load::Step).ok()).map(|indices| indices.iae),
            plant,
            areas,
            pi,
        }
    }

    /// A noise gain that most plants can have.
    fn noise_gain(&self) -> f64 {
        10.0 / self.plant.gain().abs()
    }
}

/// Something that takes time; `None`: it has no result for this plant.
type Work = fn(&Case) -> Option<()>;

fn done<T>(result: T) -> Option<()> {
    let _ = black_box(result);
    Some(())
}

const WORK: &[(&str, Work)] = &[
    ("areas A0..A5", |c| c.plant.areas6().ok().and_then(done)),
    ("MOMI", |c| Momi::new(c.areas.as_ref()?, 0.0).ok().and_then(done)),
    ("MOMI, noise limit", |c| {
        Momi::with_noise_limit(c.areas.as_ref()?, c.noise_gain(), c.ts).ok().and_then(done)
    }),
    ("DRMO", |c| Drmo::new(c.areas.as_ref()?, 0.0).ok().and_then(done)),
    ("DRMO, noise limit", |c| {
        Drmo::with_noise_limit(c.areas.as_ref()?, c.noise_gain(), c.ts).ok().and_then(done)
    }),
    ("model reduction", |c| Reduced::new(c.areas.as_ref()?).ok().and_then(done)),
    ("DE-MOMI, filters given", |c| DeMomi::new(c.areas.as_ref()?, c.ts, 4.0 * c.ts).ok().and_then(done)),
    ("DE-MOMI, noise limits", |c| {
        let gain = c.noise_gain();
        DeMomi::with_noise_limits(c.areas.as_ref()?, gain, gain, c.ts).ok().and_then(done)
    }),
    ("half rule", |c| half_rule(&c.plant, Keep::Two, c.ts).ok().and_then(done)),
    ("AH", |c| {
        let lag = c.lag?;
        AhPid::new(lag.gain, lag.tau, lag.dead_time, AhMs::Ms14).ok().and_then(done)
    }),
    ("AH, inflexion of the step", |c| AhPid::of_plant(&c.plant, AhMs::Ms14).ok().and_then(done)),
    ("AMIGO", |c| {
        let lag = c.lag?;
        Amigo::pid(lag.gain, lag.tau, lag.dead_time).ok().and_then(done)
    }),
    ("SIMC", |c| Simc::of_model(c.model.as_ref()?, None).ok().and_then(done)),
    ("ADRC parameters", |c| {
        let model = c.model.as_ref()?;
        AdrcDesign::for_model(model, 10.0 * (model.a1 + model.dead_time)).ok().and_then(done)
    }),
    ("Airikka, power fit", |c| {
        let lag = c.lag?;
        AirikkaPi::power(lag.gain, lag.tau, lag.dead_time).ok().and_then(done)
    }),
    ("Airikka, linear fit", |c| {
        let lag = c.lag?;
        AirikkaPi::linear(lag.gain, lag.tau, lag.dead_time).ok().and_then(done)
    }),
    ("PiMs, Ms 1.2", |c| PiMs::new(&c.plant, 1.2).ok().and_then(done)),
    ("PiMs, Ms 1.4", |c| PiMs::new(&c.plant, 1.4).ok().and_then(done)),
    ("PiMs, Ms 2.0", |c| PiMs::new(&c.plant, 2.0).ok().and_then(done)),
    ("PiIae", |c| PiIae::new(&c.plant).ok().and_then(done)),
    ("observer, noise ratio", |c| {
        ObserverDesign::with_noise_ratio(&c.plant, &c.pi?, 4.0).ok().and_then(done)
    }),
    ("observer, Ms limit", |c| ObserverDesign::within_ms(&c.plant, &c.pi?, 10.0, 1.7).ok().and_then(done)),
    ("observer, IAE halved", |c| alpha_for(&c.plant, &c.pi?, Wish::Iae(0.5 * c.iae?)).ok().and_then(done)),
    ("load response, PI", |c| {
        ContinuousResponse::new(&c.plant, &c.pi?, None).ok()?.indices(Load::Step).ok().and_then(done)
    }),
    ("margins, continuous", |c| ContinuousLoop::new(&c.plant, &c.pi?).margins().ok().and_then(done)),
    ("margins, sampled", |c| {
        let law = DiscreteLaw::new(&c.pi?, c.ts).ok()?;
        DiscreteLoop::new(&c.plant, law, 0.0).ok()?.margins().ok().and_then(done)
    }),
    ("design, momi", |c| whole(c, Method::Momi)),
    ("design, drmo", |c| whole(c, Method::Drmo)),
    ("design, de-momi", |c| whole(c, Method::DeMomi)),
    ("design, pi-ms", |c| whole(c, Method::PiMs)),
    ("design, dob", |c| whole(c, Method::Dob)),
    ("design, pi-iae", |c| whole(c, Method::PiIae)),
    ("design, ah", |c| whole(c, Method::Ah)),
    ("design, adrc", |c| whole(c, Method::Adrc)),
    ("design, amigo", |c| whole(c, Method::Amigo)),
    ("design, simc", |c| whole(c, Method::Simc)),
];

/// The design with all that is said of it: margins of both loops and noise gains.
fn whole(case: &Case, method: Method) -> Option<()> {
    design(&case.plant, &Request::new(method, case.ts)).ok().and_then(done)
}

/// The shortest time of one call in ns.
fn shortest(mut work: impl FnMut() -> Option<()>) -> Option<f64> {
    const LEAST: Duration = Duration::from_micros(50);
    const LONG: Duration = Duration::from_millis(2);
    let mut calls = 1_u32;
    let mut best = f64::INFINITY;
    // Also warms the caches.
    work()?;
    let batch = |calls: u32, work: &mut dyn FnMut() -> Option<()>| {
        let start = Instant::now();
        for _ in 0..calls {
            work();
        }
        start.elapsed()
    };
    while batch(calls, &mut work) < LEAST && calls < 1 << 20 {
        calls *= 2;
    }
    for k in 0..5 {
        let time = batch(calls, &mut work);
        best = best.min(time.as_nanos() as f64 / f64::from(calls));
        // What takes long is disturbed less in proportion.
        if k > 0 && time > LONG {
            break;
        }
    }
    Some(best)
}

/// Prints the line of one rule.
fn line(name: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    if let [first, .., last] | [first @ last] = times[..] {
        println!("{name}\t{}\t{:.0}\t{first:.0}\t{last:.0}", times.len(), times[times.len() / 2]);
    }
}

/// A step of the plant `exp(-s)/((1+5*s)*(1+s))` in a thousand rows, and what a log adds to it.
fn step() -> [Vec<f64>; 3] {
    let t: Vec<f64> = (0..1000).map(|k| 0.06 * f64::from(k)).collect();
    let u = t.iter().map(|t| f64::from(u8::from(*t >= 6.0))).collect();
    let after = |t: f64| (t - 7.0).max(0.0);
    let clean = |t: f64| 1.0 - 1.25 * libm::exp(-after(t) / 5.0) + 0.25 * libm::exp(-after(t));
    let y = t.iter().enumerate().map(|(k, t)| clean(*t) + 0.002 * ripple(k)).collect();
    [t, u, y]
}

/// Something like noise of size 1.
fn ripple(k: usize) -> f64 {
    let x = libm::sin(k as f64 * 12.9898) * 43_758.545_3;
    2.0 * (x - libm::floor(x)) - 1.0
}

/// The load-response experiment in two thousand samples: `exp(-s)/(1+s)` with the PI of least IAE.
fn load_step() -> [Vec<f64>; 4] {
    let (kp, ti, ts) = (1.0194, 1.451, 0.02);
    let (mut y, mut i) = (0.0, 0.0);
    let mut inputs = vec![0.0; 50];
    let [mut t, mut pv, mut co] = [const { Vec::new() }; 3];
    for k in 0..2000 {
        let manual = (250..260).contains(&k);
        i = if manual { 1.0 + kp * y } else { i - kp * ts / ti * y };
        t.push(ts * k as f64);
        pv.push(y + 0.002 * ripple(k));
        co.push(i - kp * y);
        inputs.push(i - kp * y);
        y += (inputs[k] - y) * ts;
    }
    [t, vec![0.0; 2000], pv, co]
}

/// The published plants with the gains of [`PiMs`], for the program that does the same in Python.
fn plants() {
    for process in processes() {
        let case = Case::new(&process.expression);
        let Some(PidConfig { kp, ki, .. }) = case.pi else { continue };
        let roots = case.plant.poles().into_iter().chain(case.plant.zeros()).map(|root| root.abs());
        let times = roots.filter(|size| *size > 0.0).map(f64::recip);
        let dead_time = case.plant.dead_time();
        let shortest = times.chain(Some(dead_time).filter(|t| *t > 0.0)).fold(f64::INFINITY, f64::min);
        let total = case.ts / SAMPLING;
        println!("{}\t{total}\t{shortest}\t{dead_time}\t{kp}\t{ki}", process.expression);
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    if words.first().is_some_and(|word| word == "plants") {
        return plants();
    }
    let wanted = |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    let published = processes().into_iter().map(|process| process.expression);
    let cases: Vec<Case> =
        published.chain(OTHERS.map(String::from)).map(|expression| Case::new(&expression)).collect();
    for (name, work) in WORK.iter().filter(|(name, _)| wanted(name)) {
        line(name, cases.iter().filter_map(|case| shortest(|| work(black_box(case)))).collect());
    }
    if wanted("PiIae, exp(-s)/(1+s)") {
        // The one that Python is asked for.
        let time = shortest(|| PiIae::fopdt(black_box(1.0), 1.0, 1.0).ok().and_then(done));
        line("PiIae, exp(-s)/(1+s)", time.into_iter().collect());
    }
    if wanted("identify, 1000 rows") {
        let [t, u, y] = step();
        let recording = Recording { t: &t, u: &u, y: &y };
        let time =
            shortest(|| identify(black_box(&recording), &IdentifyOptions::default()).ok().and_then(done));
        line("identify, 1000 rows", time.into_iter().collect());
    }
    if wanted("assess, 2000 rows") {
        let [t, r, y, u] = load_step();
        let experiment = Experiment::new(&t, &r, &y, &u);
        let time = shortest(|| assess(black_box(&experiment), &AssessOptions::default()).ok().and_then(done));
        line("assess, 2000 rows", time.into_iter().collect());
    }
}
