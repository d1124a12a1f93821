//! Exported Rust modules: they are what the program writes today, they compile, and their laws step with the bits of the
//! simulation's.
//!
//! To renew the modules: `RENEW_EXPORTS=1 cargo test -p controller-tests --test export`.

use controller_core::{ConfigErrors, Controller, ControllerInput, ControllerOutput, Mode, Quality, Real};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::scenario::{NoFiles, Scenario, read_with};
use controller_sim_host::simulate::{AnyLaw, Precision};
use std::path::{Path, PathBuf};

#[path = "../exported/adrc_f32.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod adrc_f32;
#[path = "../exported/estimator_f64.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod estimator_f64;
#[path = "../exported/first_order_f32.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod first_order_f32;
#[path = "../../controller-firmware/src/bin/demo/heater_law.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod heater_law;
#[path = "../exported/observer_f32.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod observer_f32;
#[path = "../exported/pid_f32.rs"]
#[rustfmt::skip]
#[allow(dead_code, unreachable_pub)]
mod pid_f32;

/// One controller of each kind; everything that is not a default somewhere.
const LOOPS: &str = r#"
version = 1
ts = 0.01
duration = 1.0
latency = 0.003
[plant]
tf = "exp(-0.2*s)/((1+0.2*s)*(1+s))"
[[controller]]
name = "pid"
pid = { kp = 2.0, ki = 1.5, kd = 0.3, tf = 0.1, b = 0.7, c = 0.2, integral_rule = "trapezoid" }
limits = { lo = -3.0, hi = 5.0, rate_up = 40.0, rate_down = 70.0 }
anti_windup = { rule = "conditional" }
deadband = 0.01
[[controller]]
name = "estimator"
pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119, b = 1.0, c = 1.0 }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.69, tfd = 0.06 }
limits = { lo = -10.0, hi = 10.0 }
fallback = { hold_samples = 3, action = "ramp", output = 0.5, rate = 2.0, return = "acknowledged" }
[[controller]]
name = "first order"
pid = { kp = 0.8, ki = 0.7 }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.0, dead_time = 0.1, kfd = 1.0, tfd = 0.2 }
anti_windup = { rule = "back-calculation", tt = 0.5 }
alarms = { hi = 1.5, lo = -1.5, deviation = 0.7, hysteresis = 0.1 }
[[controller]]
name = "observer"
pid = { kp = 0.8, ki = 0.7 }
observer = { model = "exp(-0.2*s)*(1+0.1*s)/((1+0.2*s)*(1+s)*(1+0.5*s))", alpha = 0.1, order = 3 }
setpoint = { lo = -3.0, hi = 3.0, rate_up = 1.7, track = true }
[[controller]]
name = "adrc"
adrc = { b0 = 5.0, kp = 4.0, kd = 4.0, beta1 = 24.0, beta2 = 192.0, beta3 = 512.0 }
"#;

fn scenario(text: &str) -> Scenario {
    let read = read_with("loops.toml", text, Precision::F64, &NoFiles);
    let read = read.unwrap_or_else(|faults| panic!("{faults:?}"));
    read.cases.into_iter().next().expect("one case").scenario
}

fn text_of(scenario: &Scenario, name: &str, precision: Precision, origin: &str) -> String {
    let spec = scenario.controllers.iter().find(|spec| spec.name == name).expect("a controller of this name");
    Export::new(scenario, spec, precision, None)
        .expect("it can be exported")
        .text(Format::Rust, origin)
        .expect("Rust has every loop")
}

/// Compares the committed file with what the program writes today.
fn same_as(file: &Path, text: &str) {
    if std::env::var_os("RENEW_EXPORTS").is_some() {
        std::fs::write(file, text).expect("the file can be written");
    }
    let committed = std::fs::read_to_string(file).expect("the file is committed");
    assert!(committed == text, "{} is not what is exported today: RENEW_EXPORTS=1", file.display());
}

fn here() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_committed_modules_are_what_is_exported() {
    let scenario = scenario(LOOPS);
    let modules = [
        ("pid", Precision::F32, "pid_f32"),
        ("estimator", Precision::F64, "estimator_f64"),
        ("first order", Precision::F32, "first_order_f32"),
        ("observer", Precision::F32, "observer_f32"),
        ("adrc", Precision::F32, "adrc_f32"),
    ];
    for (name, precision, file) in modules {
        let text = text_of(&scenario, name, precision, "loops.toml");
        same_as(&here().join("exported").join(file).with_extension("rs"), &text);
    }
}

#[test]
fn the_loop_of_the_firmwares_demo_is_that_of_its_design_file() {
    let firmware = here().join("../controller-firmware");
    let text = std::fs::read_to_string(firmware.join("demo/loop.toml")).expect("the design file");
    let exported = text_of(&scenario(&text), "heater", Precision::F32, "loop.toml");
    same_as(&firmware.join("src/bin/demo/heater_law.rs"), &exported);
}

/// The bits of everything a sample gives.
fn bits<T: Real>(out: &ControllerOutput<T>) -> Vec<u32> {
    let numbers = [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r];
    let words = numbers.iter().flat_map(|x| x.to_words().into_iter().take(T::WORDS));
    words.chain([out.status.bits(), out.mode as u32]).collect()
}

/// Steps both beside each other through set-points, loads, bad samples, modes.
fn beside<T: Real>(name: &str, mut exported: impl FnMut(&ControllerInput<T>) -> ControllerOutput<T>) {
    let scenario = scenario(LOOPS);
    let spec = scenario.controllers.iter().find(|spec| spec.name == name).expect("a controller of this name");
    let capacity = spec.needed_capacity(scenario.ts, scenario.latency);
    let mut law = AnyLaw::<T>::new(spec, scenario.ts, scenario.latency, capacity).expect("a valid law");
    let (mut y, mut moved) = (0.0, 0);
    for k in 0..4000_u32 {
        let input = ControllerInput {
            r: T::from_f64(f64::from(k / 700 % 3) - 0.5),
            y: T::from_f64(y + f64::from(k.wrapping_mul(0x9E37_79B9) >> 20) / 4.0e5),
            mode: if k % 900 > 850 { Mode::Manual } else { Mode::Auto },
            manual: Some(T::from_f64(0.3)),
            quality: if k % 500 > 490 { Quality::Bad } else { Quality::Good },
            acknowledge: k % 50 == 0,
            ..ControllerInput::default()
        };
        let (one, two) = (exported(&input), law.step(&input));
        assert_eq!(bits(&one), bits(&two), "{name}, sample {k}");
        moved += u32::from(one.u.to_f64() != 0.0);
        y += 0.01 * (one.u.to_f64() + 0.2 - y);
    }
    assert!(moved > 3000, "{name} hardly moved");
}

/// A closure that steps the law of a module.
macro_rules! stepper {
    ($module:ident) => {{
        let law = $module::law().expect("an exported law can be built");
        let mut state: $module::State = law.zeroed();
        move |input: &ControllerInput<_>| law.step(&mut state, input)
    }};
}

#[test]
fn exported_laws_step_with_the_same_bits() {
    beside::<f32>("pid", stepper!(pid_f32));
    beside::<f64>("estimator", stepper!(estimator_f64));
    beside::<f32>("first order", stepper!(first_order_f32));
    beside::<f32>("observer", stepper!(observer_f32));
    beside::<f32>("adrc", stepper!(adrc_f32));
}

#[test]
fn other_parameters_build_another_law_or_say_why_not() {
    let faster = |kp| {
        let pid = controller_core::PidConfig { kp, ..pid_f32::CONTROLLER.pid };
        pid_f32::law_of(&controller_core::ControllerConfig { pid, ..pid_f32::CONTROLLER })
    };
    let built: Result<Controller<f32>, ConfigErrors> = faster(3.0);
    assert!(built.is_ok_and(|law| law != pid_f32::law().expect("the exported one")));
    assert!(faster(f64::NAN).is_err());
}

#[test]
fn what_the_target_cannot_run_is_refused() {
    let scenario = scenario(LOOPS);
    let spec = &scenario.controllers[1];
    assert!(Export::new(&scenario, spec, Precision::F32, Some(10)).is_err(), "the delay does not fit");
    assert!(Export::new(&scenario, spec, Precision::F32, Some(40)).is_ok());
}
