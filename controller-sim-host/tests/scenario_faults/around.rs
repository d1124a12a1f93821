//! Texts for people, sensor, actuator.

use super::{Case, EVENT, VERSION};

#[rustfmt::skip]
pub(crate) const CASES: &[Case] = &[
    // texts
    (&[(VERSION, "version = 1\ntitle = 1")], &[("wrong-type", 2, 9, "`title` is a number; a text is needed", "")]),
    (&[(VERSION, "version = 1\ntitle = \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\"")], &[("out-of-range", 2, 9, "is too long; allowed: at most 120 characters on one line", "")]),
    (&[(VERSION, "version = 1\ndescription = 3")], &[("wrong-type", 2, 15, "`description` is a number; a text is needed", "")]),
    (&[(VERSION, "version = 1\ndescription = \"a\\u0007b\"")], &[("out-of-range", 2, 15, "`description` has a character that cannot be printed", "")]),
    (&[(VERSION, "version = 1\nunits = \"bar\"")], &[("wrong-type", 2, 9, "`units` is a text; a table is needed", "[units]")]),
    (&[(VERSION, "version = 1\nunits = { y = \"hundredths of a degree\", z = \"V\" }")], &[("out-of-range", 2, 15, "`units.y = \"hundredths of a degree\"` is too long; allowed: at most 20 characters", ""), ("unknown-key", 2, 41, "unknown key `z` in `units`", "known keys: y, u")]),
    (&[(VERSION, "version = 1\ndescripton = \"x\"")], &[("unknown-key", 2, 1, "unknown key `descripton`", "did you mean `description`?")]),
    (&[("[plant]\n", "[plant]\ntitle = \"x\"\n")], &[("unknown-key", 6, 1, "unknown key `title` in `plant`", "belongs above the first `[table]`")]),
    (&[(EVENT, "disturbance = 1.0\nlabel = \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx\"")], &[("out-of-range", 15, 9, "is too long; allowed: at most 60 characters on one line", "")]),
    (&[(EVENT, "disturbance = 1.0\nlabel = \"a\\nb\"")], &[("out-of-range", 15, 9, "`label = \"a b\"` has a line break or a character that cannot be printed", "")]),
    (&[(EVENT, "disturbance = 1.0\nlabel = 7")], &[("wrong-type", 15, 9, "`label` is a number; a text", "")]),
    (&[(EVENT, "label = \"nothing\"")], &[("missing-key", 12, 1, "this event changes nothing", "")]),
    // sensor
    (&[(VERSION, "version = 1\nsensor = 3")], &[("wrong-type", 2, 10, "`sensor` is a number; a table is needed", "[sensor]")]),
    (&[(VERSION, "version = 1\nsensor = { lo = 2, hi = 1 }")], &[("conflict", 2, 17, "`sensor.lo = 2` must be below `sensor.hi = 1`", "")]),
    (&[(VERSION, "version = 1\nsensor = { min = 0 }")], &[("unknown-key", 2, 12, "unknown key `min` in `sensor`", "did you mean `lo`?")]),
    (&[(VERSION, "version = 1\nsensor = { resolution = -1 }")], &[("out-of-range", 2, 25, "`sensor.resolution = -1` is out of range; allowed: 0 to 1e12", "")]),
    (&[(VERSION, "version = 1\nsensor = { lo = 0, hi = 5, resolution = 6 }")], &[("conflict", 2, 41, "`sensor.resolution = 6` is wider than the range from `lo` to `hi`", "")]),
    (&[(VERSION, "version = 1\nsensor = { quantization = 0.1 }")], &[("unknown-key", 2, 12, "unknown key `quantization` in `sensor`", "did you mean `resolution`?")]),
    // actuator
    (&[(VERSION, "version = 1\nactuator = { rate = 0 }")], &[("out-of-range", 2, 21, "`actuator.rate = 0` is out of range; allowed: above 0, at most 1e15 per second", "")]),
    (&[(VERSION, "version = 1\nactuator = { rate = \"none\" }")], &[("wrong-type", 2, 21, "`actuator.rate` is a text; a number is needed", "")]),
    (&[(VERSION, "version = 1\nactuator = { deadband = -0.5, resolution = nan }")], &[("out-of-range", 2, 25, "`actuator.deadband = -0.5`", ""), ("out-of-range", 2, 44, "`actuator.resolution = nan` is not a finite number", "")]),
    (&[(VERSION, "version = 1\nactuator = { lo = 0, hi = 1, deadband = 2 }")], &[("conflict", 2, 41, "`actuator.deadband = 2` is wider than the range", "")]),
    (&[(VERSION, "version = 1\nactuator = { dead_band = 0.5 }")], &[("unknown-key", 2, 14, "unknown key `dead_band` in `actuator`", "did you mean `deadband`?")]),
    (&[(VERSION, "version = 1\nactuator = { stiction = {} }")], &[("missing-key", 2, 25, "`actuator.stiction.band` is missing", "band = 5.0")]),
    (&[(VERSION, "version = 1\nactuator = { stiction = 5 }")], &[("wrong-type", 2, 25, "`actuator.stiction` is a number; a table is needed", "band = 5.0")]),
    (&[(VERSION, "version = 1\nactuator = { stiction = { band = -1, jump = nan } }")], &[("out-of-range", 2, 34, "`actuator.stiction.band = -1` is out of range; allowed: 0 to 1e12", ""), ("out-of-range", 2, 45, "`actuator.stiction.jump = nan` is not a finite number", "")]),
    (&[(VERSION, "version = 1\nactuator = { stiction = { band = 1, jump = 2 } }")], &[("conflict", 2, 44, "`actuator.stiction.jump = 2` must not be above `actuator.stiction.band = 1`", "")]),
    (&[(VERSION, "version = 1\nactuator = { lo = 0, hi = 1, stiction = { band = 2 } }")], &[("conflict", 2, 50, "`actuator.stiction.band = 2` is wider than the range", "")]),
    (&[(VERSION, "version = 1\nactuator = { read_back = \"yes\" }")], &[("wrong-type", 2, 26, "`actuator.read_back` is a text; `true` or `false` is needed", "")]),
];
