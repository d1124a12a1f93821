//! A sample as a scenario file.

use super::quantity::keys;
use super::study::SampleStudy;
use crate::scenario::{Fault, Files, Scenario, override_key, read_with};

/// The text of the scenario from which `study` was made, changed to its sample `number`: `plant.actual` is the drawn plant,
/// which the controllers do not know of, and what is drawn around it stands in its place. `comments` head it.
///
/// # Errors
/// The sample is no scenario; a key that cannot be written where the text has something else.
pub fn replay(study: &SampleStudy, text: &str, number: usize, comments: &[String]) -> Result<String, String> {
    let scenario = study.sample(number).scenario?;
    let fault = |fault: Fault| fault.message;
    let mut text = text.to_owned();
    if scenario.plant != study.scenario.plant {
        text = override_key(&text, "plant.actual", &format!("\"{}\"", scenario.plant)).map_err(fault)?;
    }
    for (key, value) in keys(&scenario, &study.drawn.quantities) {
        text = override_key(&text, key, &format!("{value:?}")).map_err(fault)?;
    }
    if let (true, Some(noise)) = (study.has_noise(), scenario.noise) {
        text = override_key(&text, "noise.seed", &noise.seed.to_string()).map_err(fault)?;
    }
    if scenario.substeps != 10 || text.contains("substeps") {
        text = override_key(&text, "substeps", &scenario.substeps.to_string()).map_err(fault)?;
    }
    let head: String =
        comments.iter().map(|line| format!("# {}\n", line.replace(['\n', '\r'], " "))).collect();
    Ok(head + &text)
}

/// Whether a run of `text`, read with the files it names, is that of the sample.
///
/// # Errors
/// What it is instead.
pub fn verify(study: &SampleStudy, text: &str, number: usize, files: &dyn Files) -> Result<(), String> {
    let wanted: Scenario = study.sample(number).scenario?;
    let read = read_with("", text, study.drawn.precision, files)
        .map_err(|faults| faults.first().map_or_else(String::new, |fault| fault.message.clone()))?;
    match &*read.cases {
        [case] if case.scenario == wanted => Ok(()),
        _ => Err("the file would say something else".to_owned()),
    }
}
