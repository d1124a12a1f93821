//! The run, expressions, events.

use super::{Case, EVENT, PLANT};

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    // the run
    (&[("ts = 0.01", "ts = -0.01")], &[("out-of-range", 2, 6, "`ts = -0.01` is out of range; allowed: 1e-9 to 1e9 s", "")]),
    (&[("ts = 0.01", "ts = nan")], &[("out-of-range", 2, 6, "`ts = nan` is not a finite number; allowed: 1e-9 to 1e9 s", "")]),
    (&[("ts = 0.01", "ts = 1e999")], &[("out-of-range", 2, 6, "`ts = 1e999` is too large", "")]),
    (&[("ts = 0.01", "ts = -0.010")], &[("out-of-range", 2, 6, "`ts = -0.010` is out of range", "")]),
    (&[("kp = 2.35", "kp = nan"), ("b = 1.0", "b = inf"), ("tf = 0.119,", "tf = inf,")], &[("out-of-range", 18, 14, "`pid.kp = nan` is not a finite number; allowed: -1e15 to 1e15", ""),
        ("out-of-range", 28, 47, "`pid.tf = inf` is not a finite number; allowed: 0 to 1e12 s", ""), ("out-of-range", 28, 56, "`pid.b = inf` is not a finite number; allowed: 0 to 2", "")]),
    (&[(EVENT, "setpoint = inf"), ("at = 10.0", "at = nan")], &[("out-of-range", 13, 6, "`at = nan` is not a finite number; allowed: 0 to 20 s", ""), ("out-of-range", 14, 12, "`setpoint = inf` is not a finite number; allowed: -1e12 to 1e12", "")]),
    (&[("duration = 20.0", "duration = 0.005")], &[("out-of-range", 3, 12, "shorter than one sample", ""), ("out-of-range", 13, 6, "not before the end", "")]),
    (&[("ts = 0.01", "ts = 1e-8")], &[("too-large", 3, 12, "`duration = 20.0` is 2e9 samples of 1e-8 s; allowed: at most 1e9", "longer `ts`"),
        ("too-large", 6, 6, "dead time and the latency are 2e7 samples", ""), ("too-large", 24, 22, "the model's dead time", ""), ("too-large", 29, 59, "the model's dead time", "")]),
    (&[("duration = 20.0", "duration = 20.0\nsubsteps = 5000")], &[("out-of-range", 4, 12, "`substeps = 5000` is out of range; allowed: 1 to 1000", "")]),
    (&[("duration = 20.0", "duration = 20.0\nlatency = 1e6")], &[("too-large", 4, 11, "`latency = 1e6` is 1e8 samples long; allowed: at most 1e7", "longer `ts`")]),
    (&[("duration = 20.0", "duration = 20.0\nlatency = -1")], &[("out-of-range", 4, 11, "`latency = -1`", "")]),
    (&[("duration = 20.0", "duration = 20.0\nnoise = { std = -1, seed = -3 }")], &[("out-of-range", 4, 17, "`noise.std = -1`", ""), ("out-of-range", 4, 28, "`noise.seed = -3`", "")]),
    (&[("duration = 20.0", "duration = 20.0\nactuator = { lo = 1, hi = 0 }")], &[("conflict", 4, 19, "`actuator.lo = 1` must be below `actuator.hi = 0`", "")]),
    (&[(PLANT, "s/(1+s)^2"), ("duration = 20.0", "duration = 20.0\ninitial = { setpoint = 1.0 }")], &[("conflict", 4, 24, "can only rest at 0", "leave it out")]),
    // expressions
    (&[(PLANT, "exp(-0.2*s)/((1+0,2*s)*(1+S)")], &[("expression", 6, 19, "never closed", "add the `)`"), ("expression", 6, 24, "decimal comma", "`0.2`"), ("expression", 6, 33, "unknown name `S`", "lower-case")]),
    (&[(PLANT, "2s/(1+s)")], &[("expression", 6, 7, "operator is missing between `2` and `s`", "write `2*s`")]),
    (&[(PLANT, "s*s/(1+s)")], &[("expression", 6, 7, "more zeros than poles", "filter")]),
    (&[(PLANT, "")], &[("expression", 6, 6, "no expression", "write a plant")]),
    (&[("tf = \"exp", "tf = \"\"\"\nexp"), ("(1+s))\"", "(1+S))\"\"\"")], &[("expression", 7, 27, "unknown name `S`", "")]),
    (&[("tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"", "tf = \"2\\u002as)\"")], &[("expression", 6, 6, "never opened", "")]),
    (&[("model = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"", "model = \"exp(2*s)/(1+s)\"")], &[("expression", 24, 27, "dead time cannot be negative", "exp(-2*s)")]),
    (&[("model = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"", "model = \"1/(1-s)\"")], &[("expression", 24, 22, "the pole at s = 1 is not stable", "")]),
    (&[(PLANT, "2/(1+10*s)(1+s)")], &[("expression", 6, 16, "operator is missing between `)` and `(`", "write `2/((1+10*s)*(1+s))`")]),
    (&[(PLANT, "2*exp(-s)/1+10*s")], &[("expression", 6, 7, "different dead times", "`2*exp(-s)/(1+10*s)`")]),
    (&[(PLANT, "exp(-s/(1+s)")], &[("expression", 6, 10, "never closed", "")]),
    // events
    (&[("at = 10.0\n", "")], &[("missing-key", 12, 1, "`at` is missing", "at = 10.0")]),
    (&[("at = 0.0", "at = 19.995")], &[("out-of-range", 9, 6, "`at = 19.995` comes after the last of the 2000 samples", "only a disturbance")]),
    (&[("at = 10.0", "at = 30.0")], &[("out-of-range", 13, 6, "`at = 30.0` is not before the end of the run; allowed: 0 s to below `duration`, 20 s", "longer")]),
    (&[("at = 10.0", "at = -1.0")], &[("out-of-range", 13, 6, "`at = -1.0` is before the run begins", "[initial]")]),
    (&[(EVENT, "disturbance = { ramp = 1, pulse = 1, duration = 1 }")], &[("conflict", 14, 15, "`ramp` and `pulse`; one of them", "{ step = 1.0 }")]),
    (&[(EVENT, "disturbance = { pulse = 1.0 }")], &[("missing-key", 14, 15, "a pulse has an end", "duration = 0.5")]),
    (&[(EVENT, "disturbance = { step = 1.0, duration = 1 }")], &[("conflict", 14, 29, "a step has no `duration`", "`pulse`")]),
    (&[(EVENT, "mode = \"automatic\"")], &[("unknown-choice", 14, 8, "allowed: \"off\", \"manual\", \"auto\"", "did you mean \"auto\"?")]),
    (&[(EVENT, "setpoint = 2.0\ncontroller = \"PDI\"")], &[("unknown-name", 15, 14, "no controller `PDI`", "did you mean \"PID\"?")]),
    (&[(EVENT, "bad_samples = 0")], &[("out-of-range", 14, 15, "`bad_samples = 0`", "")]),
    (&[(EVENT, "acknowledge = false")], &[("conflict", 14, 15, "has no meaning", "acknowledge = true")]),
    (&[(EVENT, "observer = { alpha = 0.2 }")], &[("conflict", 14, 1, "controller `PID` has no compensator", "second controller")]),
    (&[(EVENT, "limits = { lo = 20.0 }\ncontroller = \"PID\"")], &[("conflict", 14, 17, "`limits.lo = 20.0` must be below `limits.hi = 10.0`", "")]),
    (&[(EVENT, "pid = { form = \"standard\", ti = 2 }\ncontroller = \"PID\"")], &[("conflict", 14, 16, "cannot change the form", "in the parallel form")]),
    (&[(EVENT, "estimator = { tfd = 0.0 }\ncontroller = \"DE\"")], &[("out-of-range", 14, 21, "`estimator.tfd = 0.0` is out of range; allowed: 1e-5 to 1e7 s", "")]),
];
