//! Plants and models in all their forms, cascades.

use super::{Case, LIMITS, MODEL, TF};

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    // forms of a plant
    (&[(TF, "")], &[("missing-key", 5, 1, "`plant.tf` is missing", "fopdt = {")]),
    (&[(TF, "num = [1]")], &[("missing-key", 5, 1, "`plant.den` is missing", "den = [2.0, 1.0]")]),
    (&[(TF, "den = [1, 1]")], &[("missing-key", 5, 1, "`plant.num` is missing", "num = [1.0]")]),
    (&[(TF, "num = 1\nden = [1, 1]")], &[("wrong-type", 6, 7, "`plant.num` is a number; a list of numbers is needed", "falling powers")]),
    (&[(TF, "num = []\nden = [1, 1]")], &[("out-of-range", 6, 7, "`plant.num` has 0 numbers; allowed: 1 to 21", "")]),
    (&[(TF, "num = [\"1\", true]\nden = [1, 1]")], &[("wrong-type", 6, 8, "`plant.num` is a text; a number is needed", ""), ("wrong-type", 6, 13, "`plant.num` is `true`; a number", "")]),
    (&[(TF, "num = [1]\nden = [0, 0]")], &[("out-of-range", 7, 7, "`plant.den = [0, 0]` is 0 for every s", "")]),
    (&[(TF, "num = [1, inf]\nden = [1, 1, 1]")], &[("out-of-range", 6, 11, "`plant.num = inf` is not a finite number", "")]),
    (&[(TF, "num = [1, 0, 0]\nden = [1, 1]")], &[("expression", 6, 7, "`plant.num` over `plant.den`: ", "")]),
    (&[(TF, "num = [1]\nden = [1, 1]\ndead_time = -1")], &[("out-of-range", 8, 13, "`plant.dead_time = -1` is out of range; allowed: 0 to 1e12 s", "")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\nfopdt = { gain = 1, tau = 1 }")], &[("conflict", 7, 1, "`plant.tf` and `plant.fopdt` are two plants", "remove one")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ndead_time = 1")], &[("conflict", 7, 1, "`plant.dead_time` belongs to `num` and `den`", "exp(-0.5*s)")]),
    (&[(TF, "fopdt = { gain = 1, tau = 1 }\ndead_time = 1")], &[("conflict", 7, 1, "`plant.dead_time` belongs into the braces of `fopdt`", "")]),
    (&[(TF, "fopdt = { gain = 1 }")], &[("missing-key", 6, 9, "`plant.fopdt.tau` is missing", "tau = 1.0")]),
    (&[(TF, "fopdt = { gain = 0, tau = 1 }")], &[("out-of-range", 6, 18, "`plant.fopdt.gain = 0` is out of range; allowed: size 1e-15 to 1e15", "")]),
    (&[(TF, "fopdt = { gain = 1, tau = -1, dead_time = -2 }")], &[("out-of-range", 6, 27, "`plant.fopdt.tau = -1` is out of range; allowed: above 0", ""), ("out-of-range", 6, 43, "`plant.fopdt.dead_time = -2`", "")]),
    (&[(TF, "fopdt = { k = 1, tau = 1 }")], &[("unknown-key", 6, 11, "unknown key `k` in `plant.fopdt`", "did you mean `gain`?")]),
    (&[(TF, "fopdt = \"1\"")], &[("wrong-type", 6, 9, "`plant.fopdt` is a text; a table is needed", "fopdt = { gain")]),
    (&[(TF, "fopd = { gain = 1, tau = 1 }")], &[("unknown-key", 6, 1, "unknown key `fopd` in `plant`", "did you mean `fopdt`?")]),
    (&[(TF, "sopdt = { gain = 1, tau1 = 1 }")], &[("missing-key", 6, 9, "`plant.sopdt.tau2` is missing", "")]),
    (&[(TF, "sopdt = { gain = 1, omega = 1 }")], &[("missing-key", 6, 9, "`plant.sopdt.zeta` is missing", "")]),
    (&[(TF, "sopdt = { gain = 1, omega = 1, zeta = -1 }")], &[("out-of-range", 6, 39, "`plant.sopdt.zeta = -1` is out of range; allowed: 0 to 1000", "")]),
    (&[(TF, "sopdt = { gain = 1, omega = 1, zeta = 1, tau1 = 1, tau2 = 1 }")], &[("conflict", 6, 21, "`omega` and `zeta` are given beside `tau1` and `tau2`", "one of the two pairs")]),
    (&[(TF, "sopdt = { gain = 1, tau1 = 1, tau2 = 1, beta = \"x\" }")], &[("wrong-type", 6, 48, "`plant.sopdt.beta` is a text", "")]),
    (&[(TF, "ipdt = { gain = 1, tau = 0 }")], &[("out-of-range", 6, 26, "`plant.ipdt.tau = 0` is out of range", "")]),
    (&[(TF, "ipdt = { dead_time = 1 }")], &[("missing-key", 6, 8, "`plant.ipdt.gain` is missing", "")]),
    (&[(TF, "fopdt = { gain = 1, tau = 1, dead_time = 1e6 }")], &[("too-large", 6, 9, "the plant's dead time and the latency are 1e8 samples long; allowed: at most 1e7", "")]),
    // plants of two parts
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = 3")], &[("wrong-type", 7, 9, "`plant.inner` is a number; a table is needed", "in quotes, or a table")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"1/(1+S)\"")], &[("expression", 7, 15, "unknown name `S`", "")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = { fopdt = { gain = 1 } }")], &[("missing-key", 7, 19, "`plant.inner.fopdt.tau` is missing", "")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = {}")], &[("missing-key", 7, 9, "`plant.inner.tf` is missing", "")]),
    (&[(TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"s/(1+s)\"")], &[("conflict", 7, 9, "`plant.inner` has a zero at s = 0", "")]),
    (&[(TF, "tf = \"s/(1+s)^2\"\ninner = \"1/s\"")], &[("conflict", 7, 9, "`plant.inner` has a pole at s = 0 and the outer part a zero there", "")]),
    (&[(TF, "tf = \"1/(1+s)^15\"\ninner = \"1/(1+s)^6\"")], &[("expression", 7, 9, "`plant.inner` and the outer part together: ", "")]),
    (&[(TF, "tf = \"exp(-1e5*s)/(1+s)\"\ninner = \"exp(-1e5*s)/(1+s)\"")], &[("too-large", 6, 6, "the plant's dead time and the latency are 2e7 samples", "")]),
    // models of an observer
    (&[(MODEL, "model = 3")], &[("wrong-type", 24, 22, "`observer.model` is a number; a table is needed", "in quotes, or a table")]),
    (&[(MODEL, "model = {}")], &[("missing-key", 24, 22, "`observer.model.tf` is missing", "")]),
    (&[(MODEL, "model = { fopdt = { gain = 1 } }")], &[("missing-key", 24, 32, "`observer.model.fopdt.tau` is missing", "")]),
    (&[(MODEL, "model = { num = [1], den = [1, -1] }")], &[("expression", 24, 41, "`observer.model` cannot be used as a model: the pole at s = 1", "")]),
    (&[(MODEL, "model = { tf = \"1/(1+s\" }")], &[("expression", 24, 32, "never closed", "")]),
    // cascades
    (&[(LIMITS, "secondary = { pid = { kp = 1.0 } }")], &[("conflict", 19, 1, "a secondary controller needs the part of the plant that it controls", "inner =")]),
    (&[(LIMITS, "secondary = 3")], &[("wrong-type", 19, 13, "`secondary` is a number; a table is needed", "[controller.secondary]")]),
    (&[(LIMITS, "secondary = {}"), (TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"1/(1+0.1*s)\"")], &[("missing-key", 20, 13, "`secondary.pid` is missing", "pid = {")]),
    (&[(LIMITS, "secondary = { pid = { kp = 1.0 }, name = \"b\", mode = \"auto\" }"), (TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"1/(1+0.1*s)\"")], &[("conflict", 20, 35, "is called after its primary one", "remove it"), ("conflict", 20, 47, "always in mode cascade", "")]),
    (&[(LIMITS, "secondary = { pid = { kp = 1.0, tf = 0.001 } }"), (TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"1/(1+0.1*s)\"")], &[("out-of-range", 20, 38, "`secondary.pid.tf = 0.001` is out of range; allowed: 0, or 0.005 to 1e12 s", "half a sample")]),
    (&[(LIMITS, "secondary = { pid = { kp = 1.0 } }\nestimator = { gain = 1, a1 = 1, kfd = 1, tfd = 1 }"), (TF, "tf = \"exp(-0.2*s)/((1+0.2*s)*(1+s))\"\ninner = \"1/(1+0.1*s)\"")], &[("conflict", 21, 1, "a primary controller has no `estimator`: it drives a closed loop", "`secondary`")]),
];
