//! Every design can be run: its file is read back to the bit, and the run gives what the design predicts.

use controller_design::design::{Design, Filter, Method, ObserverFilter, Request, design};
use controller_design::model::parse;
use controller_sim_host::design_file;
use controller_sim_host::scenario::{Scenario, read};
use controller_sim_host::simulate::{Metrics, Precision, RunOptions, run};

/// Plants of every class, with a sampling period for each; none is one of the papers'.
const PLANTS: [(&str, f64); 14] = [
    ("2*exp(-0.3*s)/((1+0.7*s)*(1+1.3*s))", 0.01),
    ("exp(-0.033*s)/(1+s)^3", 0.01),
    ("-40*exp(-5*s)/((1+60*s)*(1+12*s))", 0.5),
    ("1e6*exp(-2e-6*s)/((1+8e-6*s)*(1+3e-6*s))", 5e-8),
    ("1e-4*exp(-900*s)/((1+4000*s)*(1+1500*s))", 20.0),
    ("1/(1+0.5*s)^8", 0.02),
    ("exp(-0.0004*s)/((1+0.2*s)*(1+0.05*s))", 0.001),
    ("(1-0.4*s)/((1+s)^2*(1+0.3*s))", 0.01),
    ("(1+0.6*s)*exp(-0.5*s)/((1+2*s)*(1+s))", 0.02),
    ("1.5*exp(-0.8*s)/(1+1.4*s+s^2)", 0.02),
    ("3*exp(-2*s)/(1+0.5*s)", 0.02),
    ("0.2*exp(-s)/(s*(1+0.5*s))", 0.02),
    ("-5*exp(-0.1*s)/s", 0.005),
    ("exp(-0.2*s)/((1+s)*(1+0.5*s)*(1+0.25*s)*(1+0.1*s))", 0.01),
];

fn made(plant: &str, request: &Request) -> Option<Design> {
    design(&parse(plant).expect("a valid plant"), request).ok()
}

fn scenario(made: &Design) -> Scenario {
    let text = design_file::of(made, None, "a test").text();
    match read(&text, Precision::F64) {
        Ok(read) => read.scenario,
        Err(faults) => panic!("{faults:?} in\n{text}"),
    }
}

fn events(scenario: &Scenario) -> [Metrics; 2] {
    let result = run(scenario, RunOptions::default()).expect("a run");
    let events = &result.controllers[0].events;
    [events[0].metrics, events[1].metrics]
}

/// `exp(-14)`.
const LEFT: f64 = 8.4e-7;

/// Closed forms for `ts*sum(e)`: `(1/K + (1-b)*kp)/ki` for the set-point, `-1/ki`, `-(1-kfd)/ki` or 0 for the load; of an
/// ADRC those of its sampled observer. Only the tail that the window cuts off is missing: the window has 14 of the slowest
/// times, so that a mode with all of the IAE leaves exp(-14) of it, 1e-6; the estimate of the slowest time may be a quarter too
/// short where lags and dead time add up in a loop that swings: exp(-10.8), 2e-5. The load's window begins with what is left
/// of the set-point's response, exp(-14) of that, which is much where the plant's gain is small.
#[test]
fn every_method_gives_the_integrals_of_the_error_that_it_predicts() {
    let mut counts = [0; Method::ALL.len()];
    for (plant, ts) in PLANTS {
        for (index, method) in Method::ALL.into_iter().enumerate() {
            for latency in [0.0, 0.7 * ts] {
                let Some(made) = made(plant, &Request { latency, ..Request::new(method, ts) }) else {
                    continue;
                };
                counts[index] += 1;
                let [setpoint, load] = events(&scenario(&made));
                let predicted = [made.predicted.ie_setpoint, made.predicted.ie_load];
                for (what, expected, found) in
                    [("set-point", predicted[0], &setpoint), ("load", predicted[1], &load)]
                {
                    let expected = expected.expect("a prediction");
                    let before = if what == "load" { LEFT * setpoint.iae } else { 0.0 };
                    let tolerance = 2e-5 * found.iae.max(expected.abs()) + before;
                    assert!(
                        (found.ie - expected).abs() <= tolerance,
                        "{plant}, {}, latency {latency}, {what}: {} instead of {expected}",
                        method.name(),
                        found.ie
                    );
                }
            }
        }
    }
    println!("designs of {:?}: {counts:?}", Method::ALL.map(Method::name));
    assert!(counts.iter().all(|count| *count >= 10), "{counts:?}");
}

/// The IAE of the optimum is that of the continuous loop to 1e-4; the sampled one adds half a sample to the dead time, with
/// the square of which the IAE grows at most (it does for an integrator): `ts/dead_time`, of which Richardson's extrapolation
/// leaves the square.
#[test]
fn the_least_iae_is_found_in_the_run() {
    for (plant, dead_time) in
        [("2*exp(-0.3*s)/(1+0.9*s)", 0.3), ("-0.5*exp(-s)/s", 1.0), ("exp(-0.4*s)/(1+s)^3", 0.4)]
    {
        let of = |ts: f64| {
            let made = made(plant, &Request::new(Method::PiIae, ts)).expect("a design");
            let expected = made.predicted.iae_load.expect("its IAE");
            (events(&scenario(&made))[1].iae, expected)
        };
        let ((coarse, expected), (fine, _)) = (of(0.004), of(0.002));
        let limit = 2.0 * fine - coarse;
        let (half, square) = (0.002 / dead_time, (0.004 / dead_time) * (0.004 / dead_time));
        assert!((limit / expected - 1.0).abs() < square + 1e-4, "{plant}: {limit} instead of {expected}");
        assert!(
            (fine / expected - 1.0).abs() < half * (1.0 + half) + 1e-4,
            "{plant}: {fine} instead of {expected}"
        );
    }
}

/// With limits the file's steps are as large as these allow, and the predicted integrals come out per unit: nothing is
/// limited on the way.
#[test]
fn steps_of_a_limited_loop_stay_inside() {
    for plant in
        ["2*exp(-3*s)/((1+40*s)*(1+8*s))", "-0.4*exp(-2*s)/((1+12*s)*(1+3*s))", "0.02*exp(-2*s)/(s*(1+s))"]
    {
        for method in Method::ALL {
            let Some(made) = made(plant, &Request::new(method, 0.2)) else { continue };
            for limits in [(0.0, 100.0), (-10.0, 30.0)] {
                let file = design_file::of(&made, Some(limits), "a test");
                let read = read(&file.text(), Precision::F64).expect("a scenario").scenario;
                let [setpoint, load] = events(&read);
                let what = format!("{plant}, {}, {limits:?}", method.name());
                let expected = made.predicted.ie_setpoint.expect("a prediction") * file.setpoint_step;
                assert!(
                    (setpoint.ie - expected).abs() <= 1e-3 * setpoint.iae,
                    "{what}: {} {expected}",
                    setpoint.ie
                );
                let expected = made.predicted.ie_load.expect("a prediction") * file.load_step;
                assert!((load.ie - expected).abs() <= 1e-3 * load.iae, "{what}: {} {expected}", load.ie);
            }
        }
    }
}

#[test]
fn a_design_file_gives_back_every_number() {
    let plant = "-1.98000000000001*exp(-33.2*s)/((1+80.3*s)*(1+7*s))";
    for method in Method::ALL {
        let request = Request { latency: 0.1, ..Request::new(method, 0.3) };
        let Some(made) = made(plant, &request) else { panic!("{}", method.name()) };
        let file = design_file::of(&made, Some((-12.5, 80.0)), "a \"test\" with\nlines");
        let read = scenario(&made);
        assert_eq!(read.controllers[0].config.pid, file.controller.config.pid, "{}", method.name());
        assert_eq!(read.controllers[0].adrc, file.controller.adrc);
        assert_eq!(read.controllers[0].compensator, file.controller.compensator, "{}", method.name());
        assert_eq!((read.plant, read.ts, read.latency), (made.plant.clone(), 0.3, 0.1));
    }
}

/// Wishes change what they are about.
#[test]
fn wishes_are_heard() {
    let plant = "exp(-0.2*s)/((1+0.2*s)*(1+s))";
    let ask = |request: Request| made(plant, &request).expect("a design");
    let base = Request::new(Method::DeMomi, 0.01);
    let (plain, robust) = (ask(base), ask(Request { ms_max: Some(1.7), ..base }));
    assert!(
        plain.sampled.margins.ms > 2.0 && robust.sampled.margins.ms <= 1.7,
        "{:?}",
        robust.sampled.margins
    );
    assert!(robust.warnings.iter().any(|warning| warning.to_string().contains("ms_max")));
    let quiet = ask(Request { filter: Filter::NoiseGain(3.0), ..base });
    assert!((quiet.noise.kpidn.expect("a gain") - 3.0).abs() < 1e-5);
    let dob = Request::new(Method::Dob, 0.01);
    let ratio = ask(Request { observer_filter: ObserverFilter::NoiseRatio(2.0), ..dob });
    let pi = ask(Request::new(Method::PiMs, 0.01));
    let controller_design::design::Law::Pid { pid, .. } = pi.law else { panic!("a PI") };
    assert!((ratio.noise.an.expect("a gain") / pid.kp - 2.0).abs() < 1e-9);
    assert!(made(plant, &Request { ts: f64::NAN, ..dob }).is_none());
    assert!(made(plant, &Request { ms: Some(0.5), ..dob }).is_none());
}

/// Signals beyond the default ranges of 1e6: the file has wider ones, and unit steps as long as they fit into 1e12.
#[test]
fn large_signals_are_neither_limited_nor_bad() {
    for (gain, is_unit) in [("1e9", true), ("-1e-9", true), ("1e12", false), ("-1e-12", false)] {
        for method in Method::ALL {
            let plant = format!("{gain}*exp(-0.3*s)/((1+0.7*s)*(1+1.3*s))");
            let Some(made) = made(&plant, &Request::new(method, 0.02)) else { continue };
            let file = design_file::of(&made, None, "a test");
            let what = format!("{plant}, {}", method.name());
            assert_eq!((file.setpoint_step, file.load_step) == (1.0, 1.0), is_unit, "{what}");
            let scenario = read(&file.text(), Precision::F64).expect("a scenario").scenario;
            let result = run(&scenario, RunOptions::default()).expect("a run");
            assert!(result.controllers[0].remarks.is_empty(), "{what}: {:?}", result.controllers[0].remarks);
            let [setpoint, load] = events(&scenario);
            for (metrics, step, unit) in [
                (&setpoint, file.setpoint_step, made.predicted.ie_setpoint),
                (&load, file.load_step, made.predicted.ie_load),
            ] {
                let expected = unit.expect("a prediction") * step;
                // What is left of the set-point's response is much beside a load's of a small gain.
                let before = LEFT * setpoint.iae;
                assert!(
                    (metrics.ie - expected).abs() <= 2e-5 * metrics.iae.max(expected.abs()) + before,
                    "{what}: {} instead of {expected}",
                    metrics.ie
                );
            }
        }
    }
    let plain = made("exp(-0.033*s)/(1+s)^3", &Request::new(Method::Momi, 0.01)).expect("a design");
    let text = design_file::of(&plain, None, "a test").text();
    assert!(!text.contains("limits = ") && !text.contains("measurement = "), "{text}");
}

/// A pair of poles with a damping of 0.1 decays ten times slower than it swings.
#[test]
fn a_lightly_damped_plant_is_run_until_it_rests() {
    for plant in ["1/(1+0.2*s+s^2)", "-3/(1+0.05*s+s^2)", "exp(-0.1*s)/((1+0.02*s+s^2)*(1+0.5*s))"] {
        let Some(made) = made(plant, &Request::new(Method::Momi, 0.02)) else { continue };
        let [setpoint, load] = events(&scenario(&made));
        for (metrics, unit) in [(setpoint, made.predicted.ie_setpoint), (load, made.predicted.ie_load)] {
            let expected = unit.expect("a prediction");
            assert!(
                (metrics.ie - expected).abs() <= 1e-4 * metrics.iae.max(expected.abs()),
                "{plant}: {} instead of {expected}",
                metrics.ie
            );
        }
    }
    assert!(made("1/(1+0.2*s+s^2)", &Request::new(Method::Momi, 0.02)).is_some());
}

/// A window of 2e6 samples is the longest; a shorter one than the response needs is said.
#[test]
fn a_window_that_is_cut_is_said() {
    let of = |ts| made("exp(-0.1*s)/((1+s)*(1+0.5*s))", &Request::new(Method::Momi, ts)).expect("a design");
    assert_eq!(design_file::cut(&of(1e-3)), None);
    let long = of(1e-6);
    let said = design_file::cut(&long).expect("a warning");
    assert!(said.contains("2e6") || said.contains("2000000"), "{said}");
    assert!(design_file::of(&long, None, "").text().contains(&format!("# note: {said}")));
}
