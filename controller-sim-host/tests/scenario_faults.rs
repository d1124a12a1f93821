//! Mistakes in scenarios: each is named at its line and column, with the help that fits.

use controller_sim_host::output::{Severity, Source, render};
use controller_sim_host::scenario::{Fault, read};
use controller_sim_host::simulate::Precision;

/// The scenario that the mistakes are made in. The numbers of its lines stand in the table.
const BASE: &str = include_str!("data/base.toml");

/// `(code, line, column, part of the message, part of the help)`; the help is empty where there need be none.
type Expected = (&'static str, usize, usize, &'static str, &'static str);
/// What is replaced by what, in the first place where it occurs, and every fault that this makes.
type Case = (&'static [(&'static str, &'static str)], &'static [Expected]);

const GAINS: &str = "kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119";
const LIMITS: &str = "limits = { lo = -10.0, hi = 10.0 }";
const WIDE: &str = "limits = { lo = -1e12, hi = 1e12 }\nmeasurement = { lo = -1e12, hi = 1e12 }";
const PLANT: &str = "exp(-0.2*s)/((1+0.2*s)*(1+s))";
const EVENT: &str = "disturbance = 1.0";

#[rustfmt::skip]
const CASES: &[Case] = &[
    // TOML
    (&[("ts = 0.01", "ts = 0,01")], &[("syntax", 2, 7, "decimal comma", "write `0.01`")]),
    (&[("ts = 0.01", "ts =")], &[("syntax", 2, 5, "`ts` has no value", "key = value")]),
    (&[("ts = 0.01", "ts 0.01")], &[("syntax", 2, 4, "no `=`", "key = value")]),
    (&[("ts = 0.01", "ts = .01")], &[("syntax", 2, 6, "digits on both sides", "0.5")]),
    (&[("duration = 20.0", "duration = 20 s")], &[("syntax", 3, 12, "`20 s` is neither", "write the number alone, in seconds: `20`")]),
    (&[("tf = \"exp(-0.2*s)", "tf = exp(-0.2*s)"), ("(1+s))\"", "(1+s))")], &[("syntax", 6, 6, "neither a number nor a text", "in quotes")]),
    (&[("(1+s))\"", "(1+s))")], &[("syntax", 6, 36, "no closing quote", "same line")]),
    (&[("[plant]", "[plant")], &[("syntax", 5, 7, "header is not closed", "write `[plant]`")]),
    (&[("tf = 0.119 }", "tf = 0.119")], &[("syntax", 18, 52, "closing `}` is missing", "separated by `,`")]),
    (&[("kp = 2.35,", "kp = 2.35")], &[("syntax", 18, 18, "a `,` is missing here", "separated by `,`")]),
    (&[("ts = 0.01", "ts = 0.01\nts = 0.02")], &[("duplicate", 3, 1, "`ts` is written twice", "remove one")]),
    (&[("[[event]]\nat = 10.0", "[event]\nat = 10.0")], &[("duplicate", 12, 2, "two tables `event`", "`[[event]]`")]),
    (&[("ts = 0.01", "ts = 100ms")], &[("syntax", 2, 6, "`100ms` is neither", "write the number alone, in seconds: `0.1`")]),
    (&[("kp = 2.35", "kp = 2.35volt")], &[("syntax", 18, 14, "`2.35volt` is neither", "write the number alone: `2.35`")]),
    (&[("ts = 0.01", "ts: 0.01")], &[("syntax", 2, 3, "a `:` where a `=` belongs", "write `ts = 0.01`")]),
    (&[("duration = 20.0\n\n[plant]\ntf = \"", "duration: 20.0\n\n[plant]\ntf: \"")], &[("syntax", 3, 9, "a `:` where", "write `duration = 20.0`"), ("syntax", 6, 3, "a `:` where", "write `tf = ")]),
    (&[("[plant]\n", "plant:\n")], &[("syntax", 5, 6, "a `:` where", "write `[plant]` for a table")]),
    (&[("kp = 2.35", "kp: 2.35")], &[("syntax", 18, 11, "a `:` where", "write `kp = 2.35`")]),
    (&[("tf = 0.119 }", "tf = 0.119 }}")], &[("syntax", 18, 54, "this `}` closes nothing", "remove it")]),
    (&[("kfd = 0.69, tfd = 0.06 }", "kfd = 0.69, tfd = 0.06 }\n}")], &[("syntax", 30, 1, "this `}` closes nothing", "remove it")]),
    (&[("ts = 0.01", "ts = 0.01 duration = 3")], &[("syntax", 2, 10, "nothing else may stand on this line", "a new line")]),
    (&[("kp = 2.35, ki", "kp = 2.35,, ki")], &[("syntax", 18, 19, "a `,` with nothing before it", "remove it")]),
    (&[("ts = 0.01", "ts = = 0.01")], &[("syntax", 2, 6, "one `=` too many", "key = value")]),
    (&[("ts = 0.01", "ts = 1e")], &[("syntax", 2, 8, "power of ten without digits", "1e3")]),
    (&[("version = 1", "{\n \"version\": 1,\n \"plant\": { \"tf\": \"1/(1+s)\" }\n}")], &[("syntax", 1, 1, "this looks like JSON", "`[plant]`")]),
    (&[("version = 1", "a b\nc d\ne f\ng h\ni j\nk l\nm n\no p\nq r\ns t\nu v\nw x")], &[("syntax", 1, 1, "this does not look like a scenario: more than 10", "demo --save")]),
    // keys
    (&[("version = 1\n", "")], &[("missing-key", 1, 1, "`version` is missing", "`version = 1`")]),
    (&[("version = 1", "version = 2")], &[("not-supported", 1, 11, "`version = 2` is not known; this program reads version 1", "version = 1")]),
    (&[("ts = 0.01", "Ts = 0.01")], &[("unknown-key", 2, 1, "unknown key `Ts`", "did you mean `ts`?")]),
    (&[("duration = 20.0", "tend = 20.0")], &[("unknown-key", 3, 1, "unknown key `tend`", "did you mean `duration`?")]),
    (&[("[plant]\ntf", "[plant]\nft")], &[("unknown-key", 6, 1, "unknown key `ft` in `plant`", "did you mean `tf`?")]),
    (&[("[[event]]\nat = 10", "[[events]]\nat = 10")], &[("unknown-key", 12, 3, "`events`", "did you mean `[[event]]`?")]),
    (&[("ts = 0.01\n", ""), ("[plant]\n", "[plant]\nts = 0.01\n")], &[("unknown-key", 5, 1, "unknown key `ts` in `plant`", "`ts` belongs above the first `[table]`")]),
    (&[("duration = 20.0\n", ""), (EVENT, "disturbance = 1.0\nduration = 20.0\nlatency = 0.0")], &[("unknown-key", 14, 1, "unknown key `duration`", "above the first `[table]`"), ("unknown-key", 15, 1, "`latency`", "above the first")]),
    (&[("version = 1\n", ""), (LIMITS, "version = 1\nsubsteps = 5")], &[("unknown-key", 18, 1, "`version`", "above the first"), ("unknown-key", 19, 1, "`substeps`", "above the first")]),
    (&[("[plant]\n", "[plant]\nts = 0.01\n")], &[("unknown-key", 6, 1, "unknown key `ts` in `plant`", "")]),
    (&[("[plant]\n", "[plants]\n")], &[("unknown-key", 5, 2, "`plants`", "did you mean `plant`?")]),
    (&[(EVENT, "")], &[("missing-key", 12, 1, "changes nothing", "disturbance")]),
    (&[(EVENT, "colour = 1")], &[("unknown-key", 14, 1, "`colour`", "known keys: at")]),
    // types
    (&[("version = 1", "version = \"1\"")], &[("wrong-type", 1, 11, "`version` is a text; a whole number", "`version = 1`")]),
    (&[("ts = 0.01", "ts = \"0,01\"")], &[("wrong-type", 2, 6, "`ts` is a text; a number", "with a point: `ts = 0.01`")]),
    (&[("ts = 0.01", "ts = \"10 ms\"")], &[("wrong-type", 2, 6, "`ts` is a text; a number", "in seconds: `0.01`")]),
    (&[("[plant]", "[[plant]]")], &[("wrong-type", 5, 1, "`plant` is a list; a table", "write `[plant]`")]),
    (&[("[[event]]\nat = 10.0\ndisturbance = 1.0\n", ""), ("[[event]]", "[event]")], &[("wrong-type", 8, 1, "`event` is a table", "`[[event]]`")]),
    (&[("tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"", "tf = 1")], &[("wrong-type", 6, 6, "`plant.tf` is a number; a text", "quotes")]),
    (&[(LIMITS, "limits = 10")], &[("wrong-type", 19, 10, "`limits` is a number; a table", "limits = {")]),
    (&[(EVENT, "setpoint = { lo = 0.0 }")], &[("wrong-type", 14, 1, "`setpoint` of an event is a number", "setpoint_limits")]),
    (&[("duration = 20.0", "duration = 20.0\nsubsteps = 5.0")], &[("wrong-type", 4, 12, "a whole number", "`substeps = 5`")]),
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
    // controllers
    (&[("name = \"PID\"\n", "")], &[("missing-key", 16, 1, "`name` is missing", "name =")]),
    (&[("name = \"PID\"", "name = \"DE\"")], &[("duplicate", 27, 8, "two controllers named `DE`", "name of its own")]),
    (&[("name = \"PID\"", "name = \" \"")], &[("out-of-range", 17, 8, "is empty; allowed: 1 to 60 characters", "")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }\n", "")], &[("missing-key", 16, 1, "`pid` is missing", "pid = {")]),
    (&[(GAINS, "")], &[("missing-key", 18, 7, "`pid` has no gain", "`kp`")]),
    (&[("pid = { kp = 2.35, ki = 1.88, kd = 0.48, tf = 0.119 }", "design = { method = \"drmo\" }")], &[("not-supported", 18, 1, "design rules are not part of this version", "pid = {")]),
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

fn edited(edits: &[(&str, &str)]) -> String {
    let mut text = BASE.to_owned();
    for (from, to) in edits {
        assert!(text.contains(from), "`{from}` is not in the base");
        text = text.replacen(from, to, 1);
    }
    text
}

/// What differs between the faults that were found and those expected; empty when nothing does.
fn differences(text: &str, found: &[Fault], expected: &[Expected]) -> String {
    let shown = render(Source { name: "s.toml", text }, found, Severity::Error, false);
    let mut wrong = Vec::new();
    if found.len() != expected.len() {
        wrong.push(format!("{} faults instead of {}", found.len(), expected.len()));
    }
    for (fault, (code, line, column, message, help)) in found.iter().zip(expected) {
        let place = fault.place(text);
        if (fault.code, place.line, place.column) != (*code, *line, *column) {
            wrong.push(format!("not {code} at {line}:{column}"));
        }
        let said = fault.help.as_deref().unwrap_or("");
        for (part, whole) in [(message, &*fault.message), (help, said)] {
            if !whole.contains(part) {
                wrong.push(format!("`{part}` is not in `{whole}`"));
            }
        }
        if fault.message.ends_with('.') || fault.message.contains('\n') {
            wrong.push(format!("`{}` is not one line without a full stop", fault.message));
        }
        if !shown.contains(&format!("s.toml:{line}:{column}")) {
            wrong.push(format!("{line}:{column} is not shown"));
        }
    }
    if wrong.is_empty() { String::new() } else { format!("{}\n{shown}", wrong.join("\n")) }
}

fn faults(text: &str, precision: Precision) -> Vec<Fault> {
    match read(text, precision) {
        Ok(_) => panic!("this was read:\n{text}"),
        Err(faults) => faults,
    }
}

#[test]
fn the_base_is_good() {
    let base = read(BASE, Precision::F32).expect("no faults");
    assert_eq!(base.warnings, []);
}

#[test]
fn every_fault_is_named_at_its_place() {
    let mut wrong = String::new();
    for (edits, expected) in CASES {
        let text = edited(edits);
        let differences = differences(&text, &faults(&text, Precision::F64), expected);
        if !differences.is_empty() {
            wrong.push_str(&format!("{edits:?}:\n{differences}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn a_text_without_anything_has_one_fault() {
    for (text, message) in [("", "is empty"), (" \n\n", "is empty"), ("# later\n", "has comments only")] {
        let found = faults(text, Precision::F64);
        assert_eq!(differences(text, &found, &[("missing-key", 1, 1, message, "demo --save")]), "");
    }
}

/// What only single precision cannot do is found before the run.
#[test]
fn faults_of_single_precision() {
    #[rustfmt::skip]
    let cases: &[Case] = &[
        (&[(LIMITS, "limits = { lo = 1.0, hi = 1.00000001 }")], &[("conflict", 19, 17, "`limits.lo = 1.0` must be below `limits.hi = 1.00000001`, in single precision", "f64")]),
        (&[("ts = 0.01", "ts = 1e-9"), ("duration = 20.0", "duration = 0.5"), ("at = 10.0", "at = 0.1"), (PLANT, "1/(1+s)"),
            (PLANT, "1/(1+s)"), ("dead_time = 0.2", "dead_time = 0.0"), ("alpha = 0.1", "alpha = 0.2"), ("tfd = 0.06", "tfd = 0.07")],
            &[("out-of-range", 2, 6, "`ts = 1e-9` is out of range", "f64")]),
        (&[(LIMITS, "limits = { rate = 1e-60 }")], &[("out-of-range", 19, 19, "`limits.rate = 1e-60` is out of range; allowed: above 0", "f64")]),
        (&[(LIMITS, WIDE), ("kp = 2.35", "kp = 1e15"), ("kd = 0.48, tf = 0.119", "kd = 1e15, tf = 1e-6"), ("ts = 0.01", "ts = 1e-6"), ("duration = 20.0", "duration = 11.0")],
            &[("too-large", 18, 14, "the gains times the ranges", "f64")]),
    ];
    for (edits, expected) in cases {
        let text = edited(edits);
        assert!(read(&text, Precision::F64).is_ok(), "{edits:?} is good in double precision");
        let found = faults(&text, Precision::F32);
        assert_eq!(found.len(), expected.len(), "{edits:?}: {found:?}");
        for (fault, (code, line, column, message, help)) in found.iter().zip(*expected) {
            let place = fault.place(&text);
            assert_eq!((fault.code, place.line, place.column), (*code, *line, *column), "{found:?}");
            assert!(
                fault.message.contains(message) && fault.message.ends_with("single precision"),
                "{found:?}"
            );
            assert!(fault.help.as_deref().unwrap_or("").contains(help), "{found:?}");
        }
    }
}

#[test]
fn odd_scenarios_are_read_with_warnings() {
    #[rustfmt::skip]
    let cases: &[Case] = &[
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
    ];
    let mut wrong = String::new();
    for (edits, expected) in cases {
        let text = edited(edits);
        let found = read(&text, Precision::F64).unwrap_or_else(|faults| panic!("{edits:?}: {faults:?}"));
        let differences = differences(&text, &found.warnings, expected);
        if !differences.is_empty() {
            wrong.push_str(&format!("{edits:?}:\n{differences}\n"));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// A text with a million mistakes is refused as soon as nobody would read on.
#[test]
fn the_number_of_faults_has_a_limit() {
    let text: String = (0..20_000).map(|i| format!("key{i} = 1\n")).collect();
    assert_eq!(faults(&text, Precision::F64).len(), 100);
}
