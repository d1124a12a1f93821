//! Scenarios from any text, with files and sweeps: never a panic, and every message points at places inside its text.
//!
//! Random bytes are hardly ever TOML or a table of numbers. So most of the inputs are a valid text with one stretch of it
//! replaced: the scenario, the file it includes, or the recording it replays.

#![no_main]

use controller_sim_host::scenario::{Files, override_key, read, read_with};
use controller_sim_host::simulate::Precision;
use libfuzzer_sys::fuzz_target;

const VALID: &str = r#"version = 1
title = "fuzz"
include = "loop.toml"
duration = 20.0
latency = 0.004
[units]
y = "V"
[plant]
tf = "exp(-0.2*s)/((1+0.2*s)*(1+s))"
inner = { sopdt = { gain = 2.0, omega = 9.0, zeta = 0.7, beta = -0.1 } }
[noise]
std = 0.001
seed = 1
[sensor]
lo = -9.0
resolution = 0.01
[actuator]
hi = 9.0
rate = 5.0
deadband = 0.01
[[event]]
at = 0.0
setpoint = { csv = "log.csv", column = "y", between = "line" }
[[event]]
at = 10.0
label = "load"
disturbance = { sine = 1.0, period = 2.0, phase = 0.5 }
measurement = { csv = "log.csv", column = 3, time = 1, scale = 0.1 }
[[event]]
at = 12.0
disturbance = { walk = 0.1, every = 0.5, seed = 3, duration = 5.0 }
measurement = "plant"
[[controller]]
name = "cascade"
pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119, b = 1.0, c = 1.0 }
limits = { lo = -10.0, hi = 10.0, rate = 50.0 }
secondary = { pid = { kp = 1.0, ki = 0.5 }, observer = { model = { fopdt = { gain = 2.0, tau = 0.2 } }, alpha = 0.1 } }
[[controller]]
name = "observer"
pid = { kp = 0.8, ki = 0.7 }
observer = { model = "exp(-0.2*s)/((1+0.2*s)*(1+s))", alpha = 0.1 }
[sweep]
key = "controller.observer.pid.kp"
values = [0.5, 0.8]
"#;

const LOOP: &str = r#"version = 1
ts = 0.01
duration = 10
[plant]
num = [1.0]
den = [2.0, 1.0]
dead_time = 0.1
[[controller]]
name = "estimator"
pid = { kp = 2.35, ki = 1.88 }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.69, tfd = 0.06 }
anti_windup = { rule = "back-calculation" }
"#;

const LOG: &str = "# a log\nt;y;u\ns;V;V\n0;0,5;1\n0,5;0,7;2\n0,5;0,75;2\n20;1;3\n";

/// Two files, and whatever else is asked for is not there.
struct Two<'a> {
    design: &'a str,
    log: &'a str,
}

impl Files for Two<'_> {
    fn load(&self, path: &str) -> Result<String, String> {
        match path {
            "loop.toml" => Ok(self.design.to_owned()),
            "log.csv" => Ok(self.log.to_owned()),
            _ => Err(format!("there is no file `{path}`; did you mean `log.csv`?")),
        }
    }
}

fn check(text: &str, files: &dyn Files) {
    for precision in [Precision::F32, Precision::F64] {
        let faults = match read_with("fuzz.toml", text, precision, files) {
            Ok(all) => {
                assert!(!all.cases.is_empty());
                all.warnings
            }
            Err(faults) => {
                assert!(!faults.is_empty());
                faults
            }
        };
        let alone = read(text, precision).map_or_else(|faults| faults, |read| read.warnings);
        for fault in faults.into_iter().chain(alone) {
            let text = fault.source.as_ref().map_or(text, |source| &source.text);
            assert!(text.get(fault.span.clone()).is_some(), "{fault:?}");
            assert!(!fault.message.is_empty() && !fault.message.contains('\n'), "{fault:?}");
            if let Some(related) = &fault.related {
                assert!(text.get(related.span.clone()).is_some(), "{fault:?}");
            }
        }
    }
}

/// `valid` with a stretch of it replaced.
fn changed(valid: &str, start: u16, length: u8, by: &str) -> String {
    let start = usize::from(start) % valid.len();
    let end = (start + usize::from(length)).min(valid.len());
    format!("{}{by}{}", &valid[..start], &valid[end..])
}

fn valid_is_valid() -> bool {
    read_with("fuzz.toml", VALID, Precision::F32, &Two { design: LOOP, log: LOG }).is_ok()
}

fuzz_target!(init: assert!(valid_is_valid()), |input: (u8, u16, u8, &str)| {
    let (what, start, length, text) = input;
    let files = Two { design: LOOP, log: LOG };
    match what % 6 {
        0 => check(text, &files),
        1 => check(VALID, &Two { design: &changed(LOOP, start, length, text), log: LOG }),
        2 => check(VALID, &Two { design: LOOP, log: &changed(LOG, start, length, text) }),
        3 => {
            // A key from anywhere: the text that comes back is read like any other.
            let (key, value) = text.split_once('=').unwrap_or((text, "1"));
            match override_key(VALID, key, value) {
                Ok(text) => check(&text, &files),
                Err(fault) => assert!(VALID.get(fault.span.clone()).is_some(), "{fault:?}"),
            }
        }
        _ => check(&changed(VALID, start, length, text), &files),
    }
});
