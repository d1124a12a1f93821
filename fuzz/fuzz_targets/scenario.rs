//! Scenarios from any text, with files and sweeps: never a panic, and every message points at places inside its text.
//!
//! Random bytes are hardly ever TOML or a table of numbers. So most of the inputs are a valid text with one stretch of it
//! replaced: the scenario, the file it includes, or the recording it replays.

#![no_main]

use controller_sim_host::scenario::{Files, override_key, read, read_with};
use controller_sim_host::simulate::Precision;
use libfuzzer_sys::fuzz_target;

const VALID: &str = include_str!("../../controller-sim-host/tests/data/several/scenario.toml");
const LOOP: &str = include_str!("../../controller-sim-host/tests/data/several/loop.toml");
const LOG: &str = include_str!("../../controller-sim-host/tests/data/several/log.csv");

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
