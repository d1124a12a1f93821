//! Plant expressions from any text: never a panic, and every message points at a place inside the text.

#![no_main]

use controller_design::model::parse;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match parse(text) {
        Ok(plant) => {
            // What is read can be looked at.
            let _ = (plant.poles(), plant.zeros(), plant.to_string());
        }
        Err(faults) => {
            assert!(!faults.is_empty());
            for fault in faults {
                assert!(text.get(fault.span.clone()).is_some(), "{fault:?}");
                assert!(!fault.message.is_empty(), "{fault:?}");
            }
        }
    }
});
