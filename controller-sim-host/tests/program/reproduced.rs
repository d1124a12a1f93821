//! The tables of the papers.

use crate::folder::{Folder, json, keys, text};

#[test]
fn a_table_is_printed_with_its_verdicts() {
    let folder = Folder::new("reproduce");
    let shown = folder.done(&["reproduce", "--paper", "de", "--table", "7"]);
    for part in [
        "Vrančić & Huba 2021, table 7: ADRC",
        "row  quantity  printed         true         ours  verdict",
        "beta3       19200        64000        64000  misprint [",
        "1 table, 12 cells: 10 as printed, 2 misprint",
        "ours is true in every cell",
    ] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let both = folder.done(&["reproduce", "--table", "1"]);
    assert!(
        both.contains("Vrančić & Huba 2021, table 1") && both.contains("Tena et al. 2022, table 1"),
        "{both}"
    );
    assert!(both.lines().all(|line| line.chars().count() <= 100), "{both}");
}

#[test]
fn the_tables_are_an_object_for_programs() {
    let folder = Folder::new("reproduce-json");
    let output = folder.run(&["reproduce", "--paper", "dob", "--table", "equations", "--json"]);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
    let value = json(&output);
    assert_eq!(value["differing"], 0);
    let table = &value["tables"][0];
    assert_eq!((table["paper"].as_str(), table["table"].as_str()), (Some("dob"), Some("equations")));
    let cell = &table["cells"][0];
    let expected = ["row", "quantity", "printed", "true", "ours", "tolerance", "verdict", "reason"];
    assert_eq!(keys(cell), expected);
    let number = |key: &str| cell[key].as_f64().expect("a number");
    assert!((number("true") - number("ours")).abs() <= number("tolerance"));
    assert_eq!(cell["verdict"], "misprint");
}

#[test]
fn an_unknown_table_has_a_help() {
    let folder = Folder::new("reproduce-unknown");
    let shown = folder.refused(&["reproduce", "--paper", "pi", "--table", "5"]);
    assert!(shown.contains("there is no table `5` of Airikka 2021"), "{shown}");
    assert!(shown.contains("optimum, rules, ratios, robustness"), "{shown}");
    let output = folder.run(&["reproduce", "--table", "99", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(json(&output)["error"]["code"], "unknown-name");
}
