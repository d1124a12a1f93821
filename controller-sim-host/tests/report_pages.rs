//! Pages that are written for a person to look at.

use controller_sim_host::report::{Chapter, figure, page};
use controller_sim_host::scenario::read;
use controller_sim_host::simulate::{Precision, RunOptions, View, run};
use std::fs;
use std::path::Path;

#[test]
fn the_scenarios_of_the_source_tree_have_pages() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let out = Path::new(env!("CARGO_TARGET_TMPDIR"));
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        let scenario = read(&text, Precision::F64).expect("valid").scenario;
        let options = RunOptions { record: Some(View::whole(scenario.duration)), ..RunOptions::default() };
        let result = run(&scenario, options).expect("runs");
        let name = path.file_name().unwrap().to_string_lossy();
        let chapter = Chapter {
            name: &name,
            case: None,
            text: &text,
            scenario: &scenario,
            precision: Precision::F64,
            result: &result,
            warnings: &[],
        };
        fs::write(out.join(format!("{name}.html")), page(&[chapter], "controller-sim run")).unwrap();
        fs::write(out.join(format!("{name}.svg")), figure(&chapter)).unwrap();
    }
}
