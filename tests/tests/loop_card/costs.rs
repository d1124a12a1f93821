//! The costs that cards show.

/// What is built into the program is what the size table and the page for people say.
#[test]
fn the_costs_of_cards_are_those_that_are_published() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let read =
        |path: &str| std::fs::read_to_string(root.join(path)).unwrap_or_else(|why| panic!("{path}: {why}"));
    let built_in = read("controller-sim-host/src/card/costs.csv");
    let tables = std::fs::read_dir(root.join("tests/target")).expect("a folder");
    let mut tables = tables.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let table = tables.find(|name| name.starts_with("size-")).expect("a table");
    let table = read(&format!("tests/target/{table}"));
    let mut rows: Vec<Vec<String>> = Vec::new();
    for line in table.lines().filter(|line| !line.starts_with('#') && !line.starts_with("board")) {
        let range = |text: &str| -> [String; 2] {
            let (least, most) = text.split_once('-').unwrap_or((text, text));
            [least.to_owned(), most.to_owned()]
        };
        if let Some(classes) = line.strip_prefix("    ") {
            let usual = classes.split(", ").find_map(|class| class.strip_prefix("nominal "));
            if let (Some(usual), Some(row)) = (usual, rows.last_mut()) {
                row[5..7].clone_from_slice(&range(usual));
            }
            continue;
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        let &[board, block, number, step, _, _, law, state, ..] = &*words else { continue };
        let row = [board, block, number].map(str::to_owned).into_iter().chain(range(step)).chain(range(step));
        rows.push(row.chain([law, state].map(str::to_owned)).collect());
    }
    let lines: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
    assert_eq!(built_in.lines().skip(1).collect::<Vec<_>>(), lines, "cargo xtask size --update writes it");
    // The page for people, of the reference board.
    let page = read("controller-firmware/COSTS.md");
    for (block, name) in [("loop-pid", "`Controller`, PID"), ("loop-pid-de", "`Controller`, PID + DE")] {
        let row = rows
            .iter()
            .find(|row| row[0] == "mps2-an386" && row[1] == block && row[2] == "f32")
            .expect("a row");
        let ram: u32 = row[7..9].iter().map(|bytes| bytes.parse::<u32>().expect("a number")).sum();
        let line = page.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect("a line");
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        assert_eq!((cells[2], cells[7]), (&*format!("{}-{}", row[3], row[4]), &*ram.to_string()), "{name}");
    }
}
