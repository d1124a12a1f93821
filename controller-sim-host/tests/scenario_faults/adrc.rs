//! The ADRC of a controller.

use super::{Case, EVENT};

const PID: &str = "pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }";
const ADRC: &str = "adrc = { b0 = 5.0, omega_c = 10.0, omega_o = 40.0 }";

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    (&[(PID, "adrc = 3")], &[("wrong-type", 18, 8, "`adrc` is a number; a table is needed", "adrc = {")]),
    (&[(PID, "adrc = { b0 = 0, omega_c = 10.0, omega_o = 40.0 }")], &[("out-of-range", 18, 15, "`adrc.b0` must not be 0 (size 1e-15 to 1e15)", "")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 100.0, omega_o = 40.0 }")], &[("out-of-range", 18, 30, "`kd = 200`, computed from `adrc.omega_c = 100.0`, is out of range; allowed: 1e-15 to 200", "shorter `ts`")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 10.0, omega_o = -4 }")], &[("out-of-range", 18, 46, "`adrc.omega_o = -4` is out of range; allowed: 1e-15 to 1e15 rad/s", "")]),
    (&[(PID, "adrc = { b0 = 5.0 }")], &[("missing-key", 18, 8, "`adrc.omega_c` is missing", "or both `kp` and `kd`"), ("missing-key", 18, 8, "`adrc.omega_o` is missing", "or all of `beta1`, `beta2`, `beta3`")]),
    (&[(PID, "adrc = { b0 = 5.0, kp = 4.0, omega_o = 40.0 }")], &[("missing-key", 18, 8, "`adrc.kd` is missing", "or both `kp` and `kd`")]),
    (&[(PID, "adrc = { omega_c = 10.0, omega_o = 40.0 }")], &[("missing-key", 18, 8, "`adrc.b0` is missing", "`b0 = 5.0`")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 10.0, omega_o = 40.0, kp = 4.0 }")], &[("conflict", 18, 52, "`omega_c` sets `kp`: write one of them", "")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 10.0, beta1 = 1, beta2 = 2, beta3 = 2 }")], &[("out-of-range", 18, 66, "`adrc.beta3 = 2` is out of range; allowed: 1e-45 to 2", "below `beta1*beta2`")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 10.0, wo = 40.0 }")], &[("unknown-key", 18, 36, "unknown key `wo` in `adrc`", "did you mean `omega_o`?")]),
    (&[(PID, "adrc = { b0 = 5.0, omega_c = 10.0, omega_o = 40.0 }\npid = { kp = 1.0 }\ndeadband = 0.1")], &[("conflict", 19, 1, "a controller with `adrc` has no `pid`", "takes the place"), ("conflict", 20, 1, "has no `deadband`", "take the band for the plant")]),
    (&[(EVENT, "adrc = { b0 = 3.0 }\ncontroller = \"PID\"")], &[("conflict", 14, 1, "controller `PID` has a PID; an event cannot give it `adrc`", "second controller")]),
    (&[(PID, ADRC), (EVENT, "pid = { kp = 3.0 }\ncontroller = \"PID\"")], &[("conflict", 14, 1, "controller `PID` has an ADRC; an event cannot give it `pid`", "second controller")]),
    (&[(PID, ADRC), (EVENT, "adrc = { omega_c = 150 }\ncontroller = \"PID\"")], &[("out-of-range", 14, 20, "`kd = 300`, computed from `adrc.omega_c = 150`", "shorter `ts`")]),
];
