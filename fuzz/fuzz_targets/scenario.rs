//! Scenarios from any text: never a panic, and every message points at places inside the text.
//!
//! Random bytes are hardly ever TOML. So half of the inputs are a valid scenario with one stretch of it replaced.

#![no_main]

use controller_sim_host::scenario::read;
use controller_sim_host::simulate::Precision;
use libfuzzer_sys::fuzz_target;

const VALID: &str = r#"version = 1
ts = 0.01
duration = 20.0
latency = 0.004
[plant]
tf = "exp(-0.2*s)/((1+0.2*s)*(1+s))"
[noise]
std = 0.001
seed = 1
[[event]]
at = 0.0
setpoint = 1.0
[[event]]
at = 10.0
disturbance = 1.0
[[controller]]
name = "estimator"
pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119, b = 1.0, c = 1.0 }
estimator = { gain = 1.0, a1 = 1.2, a2 = 0.2, dead_time = 0.2, kfd = 0.69, tfd = 0.06 }
limits = { lo = -10.0, hi = 10.0, rate = 50.0 }
anti_windup = { rule = "back-calculation" }
[[controller]]
name = "observer"
pid = { kp = 0.8, ki = 0.7 }
observer = { model = "exp(-0.2*s)/((1+0.2*s)*(1+s))", alpha = 0.1 }
"#;

fn check(text: &str) {
    for precision in [Precision::F32, Precision::F64] {
        let faults = match read(text, precision) {
            Ok(read) => read.warnings,
            Err(faults) => {
                assert!(!faults.is_empty());
                faults
            }
        };
        for fault in faults {
            assert!(text.get(fault.span.clone()).is_some(), "{fault:?}");
            assert!(!fault.message.is_empty(), "{fault:?}");
            if let Some(related) = &fault.related {
                assert!(text.get(related.span.clone()).is_some(), "{fault:?}");
            }
        }
    }
}

fuzz_target!(init: assert!(read(VALID, Precision::F32).is_ok()), |input: (u16, u8, &str)| {
    let (start, length, text) = input;
    if start & 1 == 0 {
        check(text);
        return;
    }
    let start = usize::from(start >> 1) % VALID.len();
    let end = (start + usize::from(length)).min(VALID.len());
    check(&format!("{}{text}{}", &VALID[..start], &VALID[end..]));
});
