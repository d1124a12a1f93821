//! Designs for any plant and any request, and the readers of records: never a panic, and what comes out can run.
//!
//! Random text is hardly ever a plant. So most of the inputs choose one from their bytes: lags over decades, zeros, complex
//! pairs, dead time, integrators.

#![no_main]

#[path = "../../controller-design/tests/support_design/mod.rs"]
mod support_design;

use controller_design::design::Method;
use controller_design::model::parse;
use libfuzzer_sys::fuzz_target;
use support_design::{Draws, assess_any, design_any, expression, identify_any, request};

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, rest)) = bytes.split_first() else { return };
    let method = Method::ALL[usize::from(first / 8) % Method::ALL.len()];
    match first % 8 {
        0 => {
            // A plant as text, the choices of the request behind the end of the line.
            let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            let (text, choices) = rest.split_at(end);
            if let Ok(plant) = parse(&String::from_utf8_lossy(text)) {
                design_any(&plant, &request(&mut Draws::new(choices.get(1..).unwrap_or(&[])), method, 1.0));
            }
        }
        1 => _ = identify_any(&mut Draws::new(rest)),
        2 => _ = assess_any(&mut Draws::new(rest)),
        _ => {
            let mut draws = Draws::new(rest);
            let (text, scale) = expression(&mut draws);
            if let Ok(plant) = parse(&text) {
                design_any(&plant, &request(&mut draws, method, scale));
            }
        }
    }
});
