//! Plants that are not linear: against courses by another integrator, and, where they are linear after all, against the
//! exact simulation.

use controller_sim_host::analysis::analyse;
use controller_sim_host::scenario::{Scenario, read};
use controller_sim_host::simulate::{Precision, RunOptions, RunResult, Sample, run};
use serde_json::Value;
use std::fmt::Write as _;

/// Courses by scipy; the generator `golden/make_nonlinear.py` stands beside it.
const GOLDEN: &str = include_str!("../golden/nonlinear.json");

fn scenario(text: &str) -> Scenario {
    read(text, Precision::F64).unwrap_or_else(|faults| panic!("{text}\n{faults:?}")).scenario
}

fn result(text: &str) -> RunResult {
    run(&scenario(text), RunOptions { trace: true, ..RunOptions::default() }).expect("a run")
}

fn trace(text: &str) -> Vec<Sample> {
    result(text).controllers.remove(0).trace
}

/// A step of the integrator errs by 1e-12 of the state and of its scale at most. Errors die out with the longest lag, and no
/// lag here has more than 1000 steps, those at the bends included.
#[test]
fn the_courses_of_another_integrator_are_met() {
    let cases: Vec<Value> = serde_json::from_str(GOLDEN).expect("the golden courses");
    assert_eq!(cases.len(), 3);
    for case in &cases {
        let name = case["name"].as_str().expect("a name");
        let text = case["scenario"].as_str().expect("a scenario");
        let expected: Vec<f64> =
            case["y"].as_array().expect("a list").iter().map(|y| y.as_f64().expect("a number")).collect();
        let largest = expected.iter().fold(0.0_f64, |largest, y| largest.max(y.abs()));
        let samples = trace(text);
        assert_eq!(samples.len(), expected.len(), "{name}");
        let distances = samples.iter().zip(&expected).map(|(sample, y)| (sample.y - y).abs());
        let worst = distances.fold(0.0, f64::max);
        println!("{name}: {worst:.1e}");
        assert!(worst < 2.0 * 1000.0 * 1e-12 * largest, "{name}: {worst:.2e}");
    }
}

/// Everything that happens in a loop, at times on and beside the samples.
fn loop_around(plant: &str, initial: f64, size: f64, surroundings: &str) -> String {
    let mut text =
        format!("version = 1\nts = 0.3\nduration = 240.0\nlatency = 0.13\nsubsteps = 4\n[plant]\n{plant}\n");
    write!(text, "[initial]\nsetpoint = {initial:?}\n{surroundings}").expect("text");
    let mut event =
        |at: f64, change: String| write!(text, "[[event]]\nat = {at:?}\n{change}\n").expect("text");
    event(0.0, format!("setpoint = {:?}", initial + size));
    event(20.17, format!("disturbance = {:?}", 0.4 * size));
    event(50.0, format!("disturbance = {{ ramp = {:?}, duration = 7.7 }}", 0.05 * size));
    event(70.05, format!("disturbance = {{ pulse = {:?}, duration = 0.1 }}", -3.0 * size));
    event(
        90.1,
        format!("disturbance = {{ sine = {:?}, period = 2.9, phase = 0.5, duration = 30.0 }}", 0.3 * size),
    );
    event(130.0, format!("disturbance = {{ walk = {:?}, every = 0.7, duration = 20.0 }}", 0.1 * size));
    event(150.0, "mode = \"manual\"".to_owned());
    event(155.0, "mode = \"auto\"".to_owned());
    event(160.0, "pid = { kp = 0.8, ki = 0.05 }".to_owned());
    event(170.0, "lost_samples = 3".to_owned());
    event(180.0, "bad_samples = 4".to_owned());
    text + "[[controller]]\nname = \"PI\"\npid = { kp = 1.2, ki = 0.09 }\nlimits = { lo = -1e3, hi = 1e3 }\n"
        + "[[controller]]\nname = \"DOB\"\npid = { kp = 1.2, ki = 0.09 }\nlimits = { lo = -1e3, hi = 1e3 }\n"
        + "observer = { model = \"1.5*exp(-1.37*s)/((1+20*s)*(1+2*s))\", alpha = 2.0 }\n"
}

/// A heater that is the same both ways is a plant of second order: everything that can happen to one happens to the other.
/// Errors as above, for signals up to 60 and gains up to 3: a noisy limit is met by both in the same sample.
#[test]
fn a_heater_the_same_both_ways_is_linear() {
    let heater =
        "heater = { gain = 1.5, tau_heat = 20.0, tau_cool = 20.0, sensor_lag = 2.0, dead_time = 1.37 }";
    let linear = "sopdt = { gain = 1.5, tau1 = 20.0, tau2 = 2.0, dead_time = 1.37 }";
    let around = "[noise]\nstd = 0.05\n[actuator]\nlo = -40.0\nhi = 60.0\nrate = 9.0\nread_back = true\n";
    let [ours, exact] = [heater, linear].map(|plant| result(&loop_around(plant, 12.0, 8.0, around)));
    for (one, other) in ours.controllers.iter().zip(&exact.controllers) {
        for (a, b) in one.trace.iter().zip(&other.trace) {
            // A lost or bad sample has no measurement.
            let is_near = (a.y - b.y).abs() < 1e-8 || (a.y.is_nan() && b.y.is_nan());
            assert!(is_near && (a.u - b.u).abs() < 1e-8, "{}: {a:?} {b:?}", one.name);
            assert_eq!((a.mode, a.status), (b.mode, b.status), "{}: {}", one.name, a.t);
        }
        let (a, b) = (one.total, other.total);
        for (a, b) in [(a.iae, b.iae), (a.ise, b.ise), (a.itae, b.itae), (a.e_max, b.e_max), (a.tv, b.tv)] {
            assert!((a / b - 1.0).abs() < 1e-8, "{}: {a} {b}", one.name);
        }
    }
}

/// Small moves of the tank are those of its linear model. What is left is the curvature of the root: a move `m` changes
/// gain and lag by `m/(2*(h + drop))` of themselves; the responses differ by a few times that.
#[test]
fn small_moves_of_the_tank_are_those_of_its_linear_model() {
    let linear = "fopdt = { gain = 1.98, tau = 80.3, dead_time = 3.2 }";
    let mut errors = Vec::new();
    for size in [1e-2, 1e-3] {
        let tank = "two_tank = { disturbance = \"input\" }";
        let [ours, exact] = [(tank, 25.0), (linear, 0.0)]
            .map(|(plant, initial)| result(&loop_around(plant, initial, size, "")).controllers);
        let mut worst = 0.0_f64;
        for (one, other) in ours.iter().zip(&exact) {
            for (a, b) in one.trace.iter().zip(&other.trace).filter(|(a, _)| a.y.is_finite()) {
                worst = worst.max(((a.y - 25.0) - b.y).abs() / size);
            }
        }
        assert!(worst < 10.0 * size / (2.0 * 49.5), "{size}: {worst:.2e}");
        errors.push(worst);
    }
    // The curvature, and nothing else: a tenth of the size, a tenth of the difference.
    assert!((5.0..20.0).contains(&(errors[0] / errors[1])), "{errors:?}");
}

/// The same bits at each run, in each order of threads.
#[test]
fn a_run_gives_the_same_bits_again() {
    let text =
        loop_around("two_tank = {}", 25.0, 4.0, "[noise]\nstd = 0.01\n[actuator]\nlo = 0.0\nhi = 100.0\n");
    let bits = || {
        let result = result(&text);
        let outputs = result.controllers.iter().flat_map(|c| c.trace.iter().flat_map(|s| [s.y, s.u]));
        outputs.map(f64::to_bits).collect::<Vec<_>>()
    };
    let first = bits();
    assert!(first.len() > 3000);
    let others: Vec<_> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..3).map(|_| scope.spawn(bits)).collect();
        running.into_iter().map(|thread| thread.join().expect("a run")).collect()
    });
    assert!(others.iter().all(|other| *other == first));
}

/// Settled at any level the loop does not move; nor does it when the mode changes.
#[test]
fn a_loop_at_rest_stays_there() {
    for (plant, at, load) in [
        ("two_tank = {}", 40.0, 5.0),
        ("two_tank = { drop = 0.0, pump_start = 3.0, disturbance = \"input\" }", 9.0, -4.0),
        (
            "heater = { gain = 0.6, gain_cool = 0.2, tau_heat = 30.0, tau_cool = 90.0, ambient = 20.0 }",
            14.0,
            2.0,
        ),
    ] {
        let text = format!(
            "version = 1\nts = 0.5\nduration = 60.0\n[plant]\n{plant}\n[initial]\nsetpoint = {at:?}\ndisturbance = {load:?}\n\
             [[event]]\nat = 10.0\nmode = \"manual\"\n[[event]]\nat = 20.0\nmode = \"auto\"\n\
             [[event]]\nat = 30.0\npid = {{ kp = 3.0, ki = 0.02 }}\n\
             [[controller]]\nname = \"PI\"\npid = {{ kp = 1.0, ki = 0.05 }}\nlimits = {{ lo = -100.0, hi = 100.0 }}\n"
        );
        let samples = trace(&text);
        let u0 = samples[0].u;
        for s in &samples {
            assert!((s.y - at).abs() < 1e-9 && (s.u - u0).abs() < 1e-9, "{plant}: {s:?}");
        }
    }
}

/// Where a linear plant is needed, the linear model takes its place: margins and a design are those of the printed model,
/// and it is said whose they are.
#[test]
fn an_analysis_and_a_design_take_the_linear_model() {
    let text = |plant: &str, initial: f64| {
        format!(
            "version = 1\nts = 0.2\nduration = 60.0\n[plant]\n{plant}\n[initial]\nsetpoint = {initial:?}\n\
             [[controller]]\nname = \"designed\"\ndesign = {{ method = \"dob\", ms = 1.4 }}\n"
        )
    };
    let tank = read(&text("two_tank = {}", 25.0), Precision::F64).expect("a tank");
    let linear = scenario(&text("tf = \"1.98*exp(-3.2*s)/(1+80.3*s)\"", 0.0));
    let [ours, printed] = [&tank.scenario, &linear].map(|s| analyse(s, 0).expect("an analysis"));
    let [a, b] = [&ours, &printed].map(|one| one.discrete.margins.expect("stable"));
    for (a, b) in [(a.ms, b.ms), (a.gm, b.gm), (a.pm_deg, b.pm_deg), (a.delay_margin, b.delay_margin)] {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
    let [a, b] = [&tank.scenario, &linear].map(|s| s.controllers[0].config.pid);
    assert!((a.kp / b.kp - 1.0).abs() < 1e-9 && (a.ki / b.ki - 1.0).abs() < 1e-9, "{a:?} {b:?}");
    assert!(ours.warnings[0].starts_with("the two-tank rig is not linear"), "{:?}", ours.warnings);
    assert!(
        tank.warnings.iter().any(|w| w.message.contains("linear model at the start")),
        "{:?}",
        tank.warnings
    );
}

/// What happens at an end of a tank is said.
#[test]
fn a_tank_at_its_end_says_so() {
    let at = |plant: &str, manual: f64, valve: f64| {
        let text = format!(
            "version = 1\nts = 1.0\nduration = 400.0\n[plant]\ntwo_tank = {plant}\n[initial]\nsetpoint = 25.0\n\
             [[event]]\nat = 0.0\nmanual = {manual:?}\ndisturbance = {valve:?}\n\
             [[controller]]\nname = \"manual\"\nmode = \"manual\"\npid = {{ kp = 0.0, ki = 0.1 }}\n"
        );
        let remarks = result(&text).controllers.remove(0).remarks;
        remarks.into_iter().map(|remark| remark.text).collect::<Vec<_>>()
    };
    for (plant, manual, valve, expected) in [
        ("{}", 50.0, 0.0, None),
        ("{}", 100.0, 0.0, Some("the upper tank ran over its rim for ")),
        ("{ feed_level = 15.0 }", 100.0, 0.0, Some("the feed tank was empty for ")),
        ("{}", 0.0, 0.0, Some("the upper tank was empty for ")),
        ("{}", 100.5, -0.1, Some("the pump was told a duty outside 0 to 100 % for 39")),
        ("{}", 50.0, 60.0, Some("the valve was told an opening outside 0 to 100 % for 400 s, from 0 s on")),
    ] {
        let remarks = at(plant, manual, valve);
        let found = expected.is_none_or(|expected| remarks.iter().any(|text| text.starts_with(expected)));
        assert!(found && (expected.is_some() || remarks.is_empty()), "{plant} {manual} {valve}: {remarks:?}");
    }
}

/// Parameters from all over their ranges: the reader refuses, or the run ends, with numbers and in bounded time.
#[test]
fn any_parameters_are_refused_or_run() {
    let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |lo: f64, hi: f64| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        let share = (seed >> 11) as f64 / (1_u64 << 53) as f64;
        (lo.ln() + share * (hi / lo).ln()).exp()
    };
    let (mut refused, mut run_through) = (0, 0);
    for round in 0..400 {
        // Every fourth far from anything that exists.
        let wide = if round % 4 == 0 { 1e5 } else { 30.0 };
        let mut around = |middle: f64| random(middle / wide, middle * wide);
        let plant = if round % 2 == 0 {
            format!(
                "two_tank = {{ area = {:e}, height = {:e}, drop = {:e}, drain = {:e}, valve = {}, pump = {:e}, feed_level = {:e}, disturbance = \"{}\" }}",
                around(80.0),
                around(50.0),
                if round % 3 == 0 { 0.0 } else { around(25.0) },
                around(28.0),
                around(50.0).min(100.0),
                around(13.0),
                around(40.0),
                if round % 5 == 0 { "input" } else { "valve" },
            )
        } else {
            format!(
                "heater = {{ gain = {:e}, gain_cool = {:e}, tau_heat = {:e}, tau_cool = {:e}, sensor_lag = {:e}, dead_time = {:e} }}",
                around(1.0),
                around(0.3),
                around(50.0),
                around(150.0),
                if round % 3 == 0 { 0.0 } else { around(5.0) },
                around(2.0).min(100.0),
            )
        };
        let (ts, level) = (random(0.05, 20.0), random(0.1, 50.0));
        let text = format!(
            "version = 1\nts = {ts:e}\nduration = {:e}\nsubsteps = 2\n[plant]\n{plant}\n[initial]\nsetpoint = {level:e}\n\
             [[event]]\nat = 0.0\nsetpoint = {:e}\n[[event]]\nat = {:e}\ndisturbance = {:e}\n\
             [[controller]]\nname = \"P\"\npid = {{ kp = {:e}, ki = {:e} }}\nlimits = {{ lo = 0.0, hi = 100.0 }}\n",
            60.0 * ts,
            random(0.1, 90.0),
            20.3 * ts,
            random(0.1, 120.0),
            random(0.01, 100.0),
            random(1e-4, 10.0),
        );
        let Ok(read) = read(&text, Precision::F64) else {
            refused += 1;
            continue;
        };
        match run(&read.scenario, RunOptions { trace: true, ..RunOptions::default() }) {
            Ok(result) => {
                run_through += 1;
                assert!(result.controllers[0].trace.iter().all(|s| s.y.is_finite()), "{text}");
            }
            Err(error) => panic!("{error}\n{text}"),
        }
    }
    println!("{refused} refused, {run_through} run");
    assert!(refused > 40 && run_through > 150, "{refused} {run_through}");
}
