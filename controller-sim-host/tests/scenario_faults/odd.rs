//! What can be run but is probably not meant.

use super::{Case, EVENT, LIMITS, PLANT};

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    (&[("tf = 0.119", "tf = 0.006")], &[("fast-filter", 18, 47, "shorter than a sample, 0.01 s", "")]),
    (&[("kp = 2.35, ki = 1.88", "kp = 2.35, action = \"direct\", ki = 1.88")], &[("sign", 18, 44, "opposite signs (-1.88 and 1)", "`action`")]),
    (&[(PLANT, "-2/(1+s)")], &[("sign", 18, 25, "opposite signs", ""), ("sign", 24, 22, "the model's gain is 1, the plant's -2", "same sign"), ("sign", 29, 22, "the model's gain", "")]),
    (&[(LIMITS, "limits = { lo = 0.5, hi = 0.6 }")], &[("clamped", 19, 17, "the output 0 that holds the initial state", "")]),
    (&[(LIMITS, "setpoint = { hi = 0.5 }")], &[("clamped", 10, 12, "the set-point 1 is outside `setpoint` of `PID`, -1e6 to 0.5", "")]),
    // Signs: an unstable plant says nothing, opposite gains do.
    (&[(PLANT, "2/(s-1)")], &[]),
    (&[(PLANT, "1/((s+1)*(s^2-0.2*s+1))"), ("kp = 2.35, ki = 1.88", "kp = -2.35, ki = -1.88")], &[]),
    (&[(PLANT, "(1-0.3*s)/(s*(1+s))"), ("kp = 2.35, ki = 1.88", "kp = -2.35, ki = -1.88")], &[("sign", 18, 26, "opposite signs (-1.88 and 1)", "")]),
    (&[("ki = 1.88", "ki = -1.88")], &[("sign", 18, 25, "`kp` and `ki` have opposite signs (2.35 and -1.88)", "same sign")]),
    (&[(EVENT, "pid = { ki = -1.88 }\ncontroller = \"PID\"")], &[("sign", 14, 14, "`kp` and `ki` have opposite signs", "")]),
    // Ranges: those in force at the time.
    (&[(LIMITS, "setpoint = { hi = 0.5 }"), ("setpoint = 1.0", "setpoint = 0.1"), (EVENT, "setpoint = 1.0\nsetpoint_limits = { hi = 2.0 }")], &[]),
    (&[(LIMITS, "setpoint = { hi = 0.5 }"), ("setpoint = 1.0", "setpoint_limits = { hi = 2.0 }"), (EVENT, "setpoint = 1.0")], &[]),
    (&[(EVENT, "setpoint_limits = { hi = 0.5 }\ncontroller = \"PID\"")], &[("clamped", 14, 1, "the set-point 1 is outside `setpoint` of `PID`, -1e6 to 0.5", "")]),
    (&[(EVENT, "remote_setpoint = 3.0"), (LIMITS, "setpoint = { hi = 2.0 }")], &[("clamped", 14, 19, "the remote set-point 3 is outside `setpoint` of `PID`", "")]),
    (&[(EVENT, "manual = 11.0")], &[("clamped", 14, 10, "the manual output 11 is outside `limits` of `PID`, -10 to 10", "")]),
    (&[(EVENT, "manual = 11.0\nlimits = { hi = 12.0 }\ncontroller = \"PID\"")], &[]),
    (&[(EVENT, "track = 11.0\noffset = 2.0"), (LIMITS, "limits = { hi = 10.0 }\noffset = { hi = 1.0 }")], &[("clamped", 14, 9, "the track output 11", ""), ("clamped", 15, 10, "the offset 2 is outside `offset` of `PID`", "")]),
    (&[(LIMITS, "initial_output = 20.0\nlimits = { lo = -10.0, hi = 10.0 }")], &[("clamped", 19, 18, "the initial output 20 is outside `limits` of `PID`, -10 to 10", "")]),
    (&[(LIMITS, "measurement = { lo = -1, hi = 0.5 }")], &[("out-of-measurement", 10, 12, "the set-point 1 is outside `measurement` of `PID`, -1 to 0.5: a measurement there is bad", "")]),
    (&[(LIMITS, "measurement = { lo = 0.5, hi = 5 }")], &[("out-of-measurement", 19, 22, "the initial measurement 0 is outside", "[initial]")]),
    // Switches without anything to switch.
    (&[(EVENT, "compensator = false\ncontroller = \"PID\"")], &[("no-effect", 14, 15, "controller `PID` has no compensator", "observer")]),
    (&[(EVENT, "compensator = false")], &[]),
    // Signals that reach further than they begin.
    (&[(LIMITS, "setpoint = { hi = 2.0 }"), (EVENT, "setpoint = { sine = 1.5, period = 3 }")], &[("clamped", 14, 12, "the set-point, which reaches 2.5, is outside `setpoint` of `PID`, -1e6 to 2", "")]),
    (&[(LIMITS, "setpoint = { hi = 2.0 }"), (EVENT, "setpoint = { ramp = -0.25 }")], &[]),
    (&[(LIMITS, "setpoint = { lo = -1.0 }"), (EVENT, "setpoint = { ramp = -0.25 }")], &[("clamped", 14, 12, "the set-point, which reaches -1.5, is outside", "")]),
    (&[(LIMITS, "setpoint = { hi = 2.0 }"), (EVENT, "setpoint = { walk = 9.0 }")], &[]),
    (&[(EVENT, "setpoint = { sine = 0.5, period = 0.015 }")], &[("aliasing", 14, 35, "`setpoint.period = 0.015` is less than two samples of 0.01 s", "shorter `ts`")]),
    (&[(EVENT, "setpoint = { pulse = 0.5, duration = 0.005 }")], &[("aliasing", 14, 12, "a pulse of 0.005 s is shorter than a sample, 0.01 s", "")]),
    (&[(EVENT, "disturbance = { pulse = 0.5, duration = 0.005 }")], &[]),
    // Sensor and actuator.
    (&[(EVENT, "setpoint = 5.0\n[sensor]\nlo = 0\nhi = 4")], &[("out-of-measurement", 14, 12, "the set-point 5 is outside the range of the sensor, 0 to 4: the loop never gets there", "")]),
    (&[(EVENT, "disturbance = 1.0\n[sensor]\nlo = 1\nhi = 4")], &[("out-of-measurement", 15, 1, "the initial set-point 0 is outside the range of the sensor", "")]),
    (&[(EVENT, "disturbance = 1.0\n[actuator]\nlo = -5")], &[("wind-up", 15, 1, "`PID` goes from -10 to 10, the actuator from -5 to inf only: the integral term winds up", "read_back = true")]),
    (&[(EVENT, "disturbance = 1.0\n[actuator]\nlo = -5\nread_back = true")], &[]),
    // Recordings.
    (&[(EVENT, "measurement = { csv = \"log.csv\", column = \"y\" }")], &[("recording", 14, 15, "`log.csv: y` ends at 12 s, the run at 20 s: its last value holds from there", "`duration`")]),
    (&[(EVENT, "measurement = { csv = \"log.csv\", column = \"y\" }\n[[event]]\nat = 12.0\nmeasurement = \"plant\"")], &[]),
    (&[(EVENT, "disturbance = { csv = \"log.csv\", column = \"y\" }"), ("duration = 20.0", "duration = 10.5"), ("at = 10.0", "at = 10.4")], &[]),
    (&[(EVENT, "disturbance = { csv = \"long.csv\" }")], &[("recording", 14, 15, "`long.csv` goes on to 110 s, the run ends at 20 s: the rest is not used", "")]),
];
