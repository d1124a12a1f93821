//! A map in 16 hexadecimal digits.

use super::study::MapStudy;
use crate::batch::digest::Fnv;

/// Changes whenever rows of the same request would come out otherwise.
const FORMAT: &str = "controller-sim batch map 1";

/// As for a study of plants: over everything that the rows depend on. Not what is drawn of them.
pub(super) fn digest(study: &MapStudy) -> String {
    let mut hash = Fnv::new();
    hash.add_text(FORMAT);
    hash.add_text(env!("CARGO_PKG_VERSION"));
    hash.add_text(study.plant.text());
    study.methods().iter().for_each(|method| hash.add_text(method.name()));
    for axis in study.axes() {
        hash.add_text(&axis.map_or(String::new(), super::Axis::text));
    }
    for (parameter, value) in &study.at {
        hash.add_text(&format!("{parameter}={value:?}"));
    }
    for number in [study.ts, study.horizon] {
        hash.add_text(&number.map_or(String::new(), |x| format!("{x:?}")));
    }
    hash.text()
}
