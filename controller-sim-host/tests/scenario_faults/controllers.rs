//! Controllers, and mistakes that must not hide each other.

use super::{Case, EVENT, GAINS, LIMITS, PLANT};

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    // controllers
    (&[("name = \"PID\"\n", "")], &[("missing-key", 16, 1, "`name` is missing", "name =")]),
    (&[("name = \"PID\"", "name = \"DE\"")], &[("duplicate", 27, 8, "two controllers named `DE`", "name of its own")]),
    (&[("name = \"PID\"", "name = \" \"")], &[("out-of-range", 17, 8, "is empty; allowed: 1 to 60 characters", "")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }\n", "")], &[("missing-key", 16, 1, "`pid` is missing", "pid = {")]),
    (&[(GAINS, "")], &[("missing-key", 18, 7, "`pid` has no gain", "`kp`")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }", "design = { method = \"drmo\", kpidn = 0.001 }")], &[("design", 18, 10, "`design` by drmo: the noise gain kpidn cannot be 0.001: the least attainable is", "more than the least")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }", "design = { method = \"simc\", ms = 1.4 }")], &[("conflict", 18, 29, "`design.ms` means nothing to the method simc", "belongs to pi-ms")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }", "design = { method = \"momy\" }")], &[("unknown-choice", 18, 21, "momy", "momi")]),
    (&[("kp = 2.35", "Kp = 2.35")], &[("unknown-key", 18, 9, "unknown key `Kp` in `pid`", "did you mean `kp`?")]),
    (&[("kd = 0.48, tf = 0.119", "kd = 0.48")], &[("conflict", 18, 36, "`pid.kd = 0.48` needs a filter, and `tf` is 0", "at least 0.005 s")]),
    (&[("tf = 0.119", "tf = 0.001")], &[("out-of-range", 18, 47, "`pid.tf = 0.001` is out of range; allowed: 0.005 to 1e12 s", "half a sample")]),
    (&[("ki = 1.88", "ti = 1.88")], &[("conflict", 18, 20, "`ti` belongs to the standard and series forms", "form = \"standard\"")]),
    (&[(GAINS, "form = \"ideal\", k = 1.0")], &[("unknown-choice", 18, 16, "`pid.form = \"ideal\"` is not known", "did you mean \"standard\"?")]),
    (&[(GAINS, "form = \"standard\", kp = 1.0, ti = 2.0")], &[("conflict", 18, 28, "`kp` belongs to the parallel form; this PID is in the standard form", "take `form` away")]),
    (&[(GAINS, "form = \"series\", k = 1.0, ti = 0, td = -1")], &[("out-of-range", 18, 40, "`pid.ti = 0` is out of range; allowed: above 0", ""), ("out-of-range", 18, 48, "`pid.td = -1`", "")]),
    (&[(GAINS, "form = \"standard\", k = 1e14, ti = 1e-3")], &[("out-of-range", 18, 43, "`ki = 1e17`, computed from `pid.ti = 1e-3`", "")]),
    (&[("tf = 0.119", "tf = 0.119, b = 3, action = \"revers\"")], &[("out-of-range", 18, 58, "`pid.b = 3` is out of range; allowed: 0 to 2", ""), ("unknown-choice", 18, 70, "`pid.action = \"revers\"`", "\"reverse\"")]),
    (&[(LIMITS, "limits = { lo = 10.0, hi = -10.0 }")], &[("conflict", 19, 17, "`limits.lo = 10.0` must be below `limits.hi = -10.0`", "")]),
    (&[(LIMITS, "limits = { hi = -1e7 }")], &[("conflict", 19, 17, "`limits.hi = -1e7` must be above `limits.lo = -1e6`, the default", "")]),
    (&[(LIMITS, "limits = { rate = 0 }")], &[("out-of-range", 19, 19, "`limits.rate = 0` is out of range; allowed: above 0", "")]),
    (&[(LIMITS, "limits = { rate = \"None\" }")], &[("unknown-choice", 19, 19, "`limits.rate = \"None\"` is not known; allowed: a number above 0, \"none\"", "write \"none\" in lower case")]),
    (&[(LIMITS, "limits = { rate_up = \"5 V\" }")], &[("wrong-type", 19, 22, "`limits.rate_up` is a text; a number", "write the number alone: `5`")]),
    (&[(LIMITS, "anti_windup = { rule = \"backcalc\" }")], &[("unknown-choice", 19, 24, "`anti_windup.rule = \"backcalc\"`", "did you mean \"back-calculation\"?")]),
    (&[(LIMITS, "limits = { rate = 1, rate_up = 2 }")], &[("conflict", 19, 22, "exclude each other", "`rate_up` and `rate_down`")]),
    (&[(LIMITS, "anti_windup = { rule = \"conditional\", tt = 1 }")], &[("conflict", 19, 44, "`anti_windup.tt` has no meaning", "back-calculation")]),
    (&[(LIMITS, "alarms = { hi = 1, lo = 2 }")], &[("conflict", 19, 25, "`alarms.lo = 2` must be below the next higher alarm level, 1", "hi_hi")]),
    (&[(LIMITS, "fallback = { action = \"ramp\", output = 1 }")], &[("missing-key", 19, 12, "`fallback.rate` is missing", "rate = 1.0")]),
    (&[(LIMITS, "limits = { lo = -10.0, hi = 10.0 }\nfallback = { action = \"substitute\", output = 20 }")], &[("out-of-range", 20, 46, "`fallback.output = 20` is out of range; allowed: -10 to 10", "")]),
    (&[(LIMITS, "limits = { lo = -10.0, hi = 10.0 }\nfallback = { action = \"substitute\", output = 8 }"), (EVENT, "limits = { hi = 5.0 }")], &[("out-of-range", 20, 46, "`fallback.output = 8` is out of range; allowed: -10 to 5", "")]),
    (&[(LIMITS, "off_output = 20.0\nlimits = { lo = -10.0, hi = 10.0 }")], &[("out-of-range", 19, 14, "`off_output = 20.0`", "")]),
    (&[(LIMITS, "deadband = -1\nmeasurement = { lo = 1, hi = 0 }")], &[("out-of-range", 19, 12, "`deadband = -1`", ""), ("conflict", 20, 22, "`measurement.lo = 1` must be below `measurement.hi = 0`", "")]),
    (&[("gain = 1.0", "gain = -1.0")], &[("conflict", 29, 22, "the model's gain is -1, but the controller's `ki` acts as 1.88", "action")]),
    (&[("gain = 1.0", "gain = 0")], &[("out-of-range", 29, 22, "`estimator.gain` must not be 0 (size 1e-15 to 1e15)", "")]),
    (&[("gain = 1.0", "gain = 2e15")], &[("out-of-range", 29, 22, "`estimator.gain = 2e15` is out of range; allowed: size 1e-15 to 1e15", "")]),
    (&[("a1 = 1.2", "a1 = -1.2")], &[("out-of-range", 29, 32, "`estimator.a1 = -1.2` makes an unstable model", "")]),
    (&[("a2 = 0.2", "a2 = 2e-9")], &[("out-of-range", 29, 42, "time constant of 1.66667e-9 s; allowed: 1e-5 to 1e7 s", "faster than a sample")]),
    (&[("kfd = 0.69, ", "")], &[("missing-key", 29, 13, "`estimator.kfd` is missing", "kfd = 0.7")]),
    (&[("kfd = 0.69", "kfd = 1.5")], &[("out-of-range", 29, 70, "`estimator.kfd = 1.5` is out of range; allowed: 0 to 1", "")]),
    (&[("alpha = 0.1", "alpha = 0.1, order = 9")], &[("out-of-range", 24, 76, "`observer.order = 9` is out of range; allowed: 2 to 5", "leave `order` out")]),
    (&[("observer =", "estimator = { gain = 1, a1 = 1, kfd = 1, tfd = 1 }\nobserver =")], &[("conflict", 25, 1, "not both", "two controllers")]),
    // what one mistake must not hide, and what must not follow from it
    (&[("ts = 0.01", "ts = -1"), (PLANT, "1/(1+S)"), ("kp = 2.35", "Kp = 2.35"), (EVENT, "distrubance = 1.0"), ("b = 1.0", "b = 4"), ("alpha = 0.1", "alpha = \"a\"")], &[
        ("out-of-range", 2, 6, "`ts = -1`", ""), ("expression", 6, 12, "unknown name `S`", ""),
        ("unknown-key", 14, 1, "`distrubance`", "`disturbance`"),
        ("unknown-key", 18, 9, "`Kp`", ""), ("wrong-type", 24, 63, "`observer.alpha` is a text", ""), ("out-of-range", 28, 58, "`pid.b = 4`", "")]),
    (&[("duration = 20.0", "duration = 20,0"), ("kfd = 0.69", "kfd = 7")], &[("syntax", 3, 14, "decimal comma", "`20.0`"), ("out-of-range", 29, 70, "`estimator.kfd = 7`", "")]),
];
