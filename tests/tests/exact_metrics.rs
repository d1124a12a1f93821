//! The indices of a run against the exact continuous error: closed forms of loops of first order, and
//! `golden/metrics.json`, computed from 50-digit responses by `golden/make_metrics.py`.
//!
//! Between two substeps `h` apart the simulator knows the error exactly and takes the straight line between. The line is
//! off by at most `h^2/8*|e''|`, its integral by `h^3/12*|e''|`, and a size, `||a| - |b|| <= |a - b|`, by no more. With
//! `D = T*h^2/12*max|e''|` for a window of length `T`: IAE is off by at most `D`, ISE by `2*e_max*D`, ITAE by
//! `T*D`, e_max by `h^2/8*max|e''|`. IE and TV are sums over samples: rounding only.

use controller_core::PidConfig;
use controller_sim_host::scenario::{Change, ControllerSpec, Event, Initial, Scenario, Signal};
use controller_sim_host::simulate::{Metrics, RunOptions, Stretch, run};
use controller_tests::cases::from_rest;
use controller_tests::golden_loops::loops;
use controller_tests::oracle::state_space::PlantFactors;
use serde_json::Value;

/// What sums of some hundred terms of size 1 may lose in doubles, and what the table's 13 digits leave.
const ROUNDING: f64 = 2e-12;

fn events_of(scenario: &Scenario, substeps: usize) -> Vec<Stretch> {
    let scenario = Scenario { substeps, ..scenario.clone() };
    run(&scenario, RunOptions::default()).expect("valid").controllers.remove(0).events
}

/// IAE, ISE, ITAE, e_max, IE, TV.
fn list(m: &Metrics) -> [f64; 6] {
    [m.iae, m.ise, m.itae, m.e_max, m.ie, m.tv]
}

const NAMES: [&str; 6] = ["IAE", "ISE", "ITAE", "e_max", "IE", "TV"];

/// How far each may be off; see the head of the file.
fn bounds(exact: &Metrics, length: f64, h: f64, bend: f64) -> [f64; 6] {
    let line = h * h / 8.0 * bend;
    let d = length * h * h / 12.0 * bend;
    let rounding = |x: f64| ROUNDING * (1.0 + x.abs());
    [
        d + rounding(exact.iae),
        // The line itself may be larger than the error.
        (2.0 * exact.e_max + line) * d + rounding(exact.ise),
        length * d + rounding(exact.itae),
        line + rounding(exact.e_max),
        rounding(exact.ie),
        rounding(exact.tv),
    ]
}

/// A piece of `e(t) = a + b*exp(-t/tau)`, or `a + b*t` for an infinite `tau`, `t` from its beginning.
#[derive(Clone, Copy, Debug)]
struct Piece {
    start: f64,
    length: f64,
    a: f64,
    b: f64,
    tau: f64,
}

impl Piece {
    fn at(&self, t: f64) -> f64 {
        if self.tau.is_infinite() { self.a + self.b * t } else { self.a + self.b * (-t / self.tau).exp() }
    }

    fn zero(&self) -> Option<f64> {
        let t = if self.tau.is_infinite() { -self.a / self.b } else { -self.tau * (-self.a / self.b).ln() };
        Some(t).filter(|t| *t > 0.0 && *t < self.length)
    }

    /// Antiderivatives of `e`, `e^2` and `t*e`.
    fn integrals(&self, t: f64) -> [f64; 3] {
        let Self { a, b, tau, .. } = *self;
        if tau.is_infinite() {
            let [t2, t3] = [t * t, t * t * t];
            return [
                a * t + b * t2 / 2.0,
                a * a * t + a * b * t2 + b * b * t3 / 3.0,
                a * t2 / 2.0 + b * t3 / 3.0,
            ];
        }
        let f = (-t / tau).exp();
        [
            a * t - b * tau * f,
            a * a * t - 2.0 * a * b * tau * f - b * b * tau / 2.0 * f * f,
            a * t * t / 2.0 - b * tau * (t + tau) * f,
        ]
    }

    /// Adds the piece to a window whose clock began at `clock`.
    fn add_to(&self, m: &mut Metrics, clock: f64) {
        let mut from = 0.0;
        for to in self.zero().into_iter().chain([self.length]) {
            let sign = self.at(0.5 * (from + to)).signum();
            let [now, before] = [self.integrals(to), self.integrals(from)];
            m.iae += sign * (now[0] - before[0]);
            m.ise += now[1] - before[1];
            m.itae += sign * (now[2] - before[2] + (self.start - clock) * (now[0] - before[0]));
            from = to;
        }
        // Without a turning point inside, an end is the largest.
        m.e_max = m.e_max.max(self.at(0.0).abs()).max(self.at(self.length).abs());
    }
}

/// A loop of first order with P control: `1/(1+s*tau)` or, with an infinite `tau`, `1/s`, both without dead time.
struct FirstOrder {
    tau: f64,
    kp: f64,
    ts: f64,
    samples: usize,
    latency: f64,
    /// When and by how much the disturbance steps.
    load: (f64, f64),
}

impl FirstOrder {
    /// From rest at 2 to the set-point 3 at `t = 0`.
    fn scenario(&self) -> Scenario {
        let plant = if self.tau.is_infinite() {
            PlantFactors { integrators: 1, ..PlantFactors::UNITY }
        } else {
            PlantFactors { lags: &[self.tau], ..PlantFactors::UNITY }
        };
        let spec = ControllerSpec::pid("P", PidConfig { kp: self.kp, ..PidConfig::default() });
        let setpoint = Change::Setpoint(Signal::Step(3.0));
        let mut scenario = from_rest(&plant, self.ts, self.samples as f64 * self.ts, setpoint, vec![spec]);
        scenario.initial = Initial { setpoint: 2.0, disturbance: 0.0 };
        scenario.latency = self.latency;
        scenario.events.push(Event {
            at: self.load.0,
            label: String::new(),
            changes: vec![Change::Disturbance(Signal::Step(self.load.1))],
            controller: None,
        });
        scenario
    }

    /// The two windows with the largest second derivative of their errors.
    fn exact(&self) -> [(Metrics, f64); 2] {
        let mut windows = [(Metrics::default(), 0.0_f64); 2];
        let clocks = [0.0, self.load.0];
        let (mut y, r) = (2.0, 3.0);
        let rest = if self.tau.is_infinite() { 0.0 } else { 2.0 };
        let (mut held, mut before) = (rest, rest);
        let mut coming = (0.0, rest);
        for k in 0..self.samples {
            let t0 = k as f64 * self.ts;
            let u = rest + self.kp * (r - y);
            // With a whole sample of latency the last output arrives now.
            if coming.0 <= t0 + 1e-9 * self.ts {
                held = coming.1;
            }
            coming = (t0 + self.latency, u);
            let mut cuts = vec![t0, t0 + self.latency, t0 + self.ts];
            if self.load.0 > t0 && self.load.0 < t0 + self.ts {
                cuts.push(self.load.0);
            }
            cuts.sort_by(f64::total_cmp);
            let sample = &mut windows[usize::from(t0 >= self.load.0)].0;
            sample.ie += self.ts * (r - y);
            sample.tv += (u - before).abs();
            before = u;
            for ends in cuts.windows(2).filter(|ends| ends[1] > ends[0] + 1e-9 * self.ts) {
                if ends[0] >= coming.0 {
                    held = coming.1;
                }
                let index = usize::from(ends[0] >= self.load.0);
                let w = held + if index == 1 { self.load.1 } else { 0.0 };
                let (start, length) = (ends[0], ends[1] - ends[0]);
                // y goes to w, or rises by w per second.
                let (a, b) = if self.tau.is_infinite() { (r - y, -w) } else { (r - w, w - y) };
                let piece = Piece { start, length, a, b, tau: self.tau };
                piece.add_to(&mut windows[index].0, clocks[index]);
                let bend = if self.tau.is_infinite() { 0.0 } else { b.abs() / (self.tau * self.tau) };
                windows[index].1 = windows[index].1.max(bend);
                y = r - piece.at(length);
            }
        }
        windows
    }
}

/// The errors of the indices of each window at 1, 10 and 100 substeps; each within its bound.
fn check(name: &str, scenario: &Scenario, exact: &[(Metrics, f64)]) -> Vec<[[f64; 6]; 3]> {
    let mut errors = vec![[[0.0; 6]; 3]; exact.len()];
    for (place, substeps) in [1, 10, 100].into_iter().enumerate() {
        let found = events_of(scenario, substeps);
        assert_eq!(found.len(), exact.len(), "{name}");
        for (index, (stretch, (window, bend))) in found.iter().zip(exact).enumerate() {
            let end = found.get(index + 1).map_or(scenario.duration, |next| next.at);
            // A window begins and ends up to a sample after its events.
            let length = end - stretch.at + scenario.ts;
            let allowed = bounds(window, length, scenario.ts / substeps as f64, *bend);
            let (values, exact) = (list(&stretch.metrics), list(window));
            for i in 0..6 {
                let error = values[i] - exact[i];
                errors[index][place][i] = error;
                assert!(
                    error.abs() <= allowed[i],
                    "{name}, window {index}, {substeps} substeps: {} {} instead of {}, allowed {:.1e}",
                    NAMES[i],
                    values[i],
                    exact[i],
                    allowed[i]
                );
            }
        }
    }
    errors
}

/// The error of an integrator between the samples is a straight line: nothing is lost, not even with one substep, with the
/// output and the disturbance arriving between samples and the error changing its sign there.
#[test]
fn an_integrator_has_exact_indices() {
    for (kp, ts, latency) in [(0.7, 0.5, 0.0), (1.9, 1.0, 0.0), (0.9, 0.5, 0.2), (1.1, 0.4, 0.4)] {
        let case = FirstOrder { tau: f64::INFINITY, kp, ts, samples: 60, latency, load: (11.37, -0.63) };
        let name = format!("integrator, kp {kp}, latency {latency}");
        let errors = check(&name, &case.scenario(), &case.exact());
        let worst = errors.iter().flatten().flatten().fold(0.0_f64, |m, e| m.max(e.abs()));
        println!("{name}: worst {worst:.1e}");
    }
}

/// A lag under P control: exponentials between the samples, the error swinging about the offset that P control leaves.
/// The straight lines cost what the bound says, a hundredth of it with ten times the substeps.
#[test]
fn a_lag_has_the_indices_of_its_exponentials() {
    for (tau, kp, ts, latency, size) in [
        (1.0, 3.8, 0.5, 0.0, -1.5),
        (2.0, 1.3, 0.3, 0.0, 0.8),
        (0.7, 1.8, 0.4, 0.13, -2.5),
        (1.0, -0.4, 0.25, 0.25, 3.0),
    ] {
        let case = FirstOrder { tau, kp, ts, samples: 60, latency, load: (30.4 * ts, size) };
        let name = format!("lag {tau}, kp {kp}, latency {latency}");
        let errors = check(&name, &case.scenario(), &case.exact());
        for (window, [one, ten, hundred]) in errors.iter().enumerate() {
            for i in 0..3 {
                println!(
                    "{name}, window {window}: {} {:.1e} {:.1e} {:.1e}",
                    NAMES[i], one[i], ten[i], hundred[i]
                );
                // Second order: h^2 up to terms of h^3, where a piece is shorter than a step.
                let ratio = ten[i] / hundred[i];
                assert!(ratio > 80.0 && ratio < 125.0, "{name}, window {window}: {} by {ratio}", NAMES[i]);
            }
        }
    }
}

/// IE and TV of P control are geometric sums: `e[k] = e_inf + (e[0] - e_inf)*q^k`, `q = a - (1-a)*kp`, `a = exp(-ts/tau)`.
#[test]
fn sums_over_samples_are_geometric() {
    let (tau, kp, ts, n) = (1.0_f64, 3.8, 0.5, 40);
    let spec = ControllerSpec::pid("P", PidConfig { kp, ..PidConfig::default() });
    let plant = PlantFactors { lags: &[1.0], ..PlantFactors::UNITY };
    let change = Change::Setpoint(Signal::Step(1.0));
    let scenario = from_rest(&plant, ts, f64::from(n) * ts, change, vec![spec]);
    let a = (-ts / tau).exp();
    let q = a - (1.0 - a) * kp;
    let rest = 1.0 / (1.0 + kp);
    let found = events_of(&scenario, 1)[0].metrics;
    let ie = ts * (f64::from(n) * rest + (1.0 - rest) * (1.0 - q.powi(n)) / (1.0 - q));
    // The first step is kp, each later one kp*|1-q|*(1-rest)*|q|^k.
    let tv = kp * (1.0 + (1.0 - q) * (1.0 - rest) * (1.0 - q.abs().powi(n - 1)) / (1.0 - q.abs()));
    assert!((found.ie - ie).abs() <= 1e-13 * ie, "{} {ie}", found.ie);
    assert!((found.tv - tv).abs() <= 1e-13 * tv, "{} {tv}", found.tv);
}

/// Loops of order 1 to 6 with dead time, latency, signals of every kind and windows that begin between samples.
#[test]
fn loops_have_the_indices_of_their_exact_errors() {
    let table: Value = serde_json::from_str(include_str!("../golden/metrics.json")).expect("valid JSON");
    let loops = loops();
    for case in table.as_array().expect("a list") {
        let name = case["name"].as_str().expect("a name");
        let scenario = &loops.iter().find(|one| one.name == name).expect("in both files").scenario;
        let read = |window: &Value| {
            let of = |key: &str| window[key].as_f64().expect("a number");
            let [ie, iae, ise, itae, e_max, tv] = ["ie", "iae", "ise", "itae", "e_max", "tv"].map(of);
            (Metrics { ie, iae, ise, itae, e_max, tv }, of("bend"))
        };
        let exact: Vec<_> = case["windows"].as_array().expect("a list").iter().map(read).collect();
        for errors in check(name, scenario, &exact) {
            let text = |e: [f64; 6]| format!("{:8.1e} {:8.1e} {:8.1e} {:8.1e}", e[0], e[1], e[2], e[3]);
            println!("{name}\n  {}\n  {}\n  {}", text(errors[0]), text(errors[1]), text(errors[2]));
        }
    }
}
