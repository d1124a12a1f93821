//! What the README and the pages of the C interface link to exists: files, and headings in them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// All pages in a folder and below.
fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

/// The lines that are no code.
fn prose(page: &str) -> Vec<&str> {
    let mut inside = false;
    let mut lines = Vec::new();
    for line in page.lines() {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if !inside {
            lines.push(line);
        }
    }
    lines
}

/// What a heading is called in a link: its letters and digits in lower case, `-` for a space.
fn anchors(page: &str) -> BTreeSet<String> {
    let heading = |line: &&str| line.starts_with('#');
    let kept = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    let name = |line: &str| {
        let words = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        words.chars().filter(|&c| kept(c)).collect()
    };
    prose(page).into_iter().filter(heading).map(name).collect()
}

/// The targets of `[text](target)`.
fn links(page: &str) -> Vec<String> {
    let text = prose(page).join("\n");
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    targets.map(|(target, _)| target.to_owned()).collect()
}

/// What is wrong with the links of a page.
fn faults(path: &Path, page: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for link in links(page) {
        if link.contains("://") || link.starts_with("mailto:") {
            continue;
        }
        let (file, anchor) = match link.split_once('#') {
            Some((file, anchor)) => (file, Some(anchor)),
            None => (&*link, None),
        };
        let target = match file {
            "" => path.to_owned(),
            file => path.parent().unwrap_or(path).join(file),
        };
        if !target.exists() {
            faults.push(format!("{}: there is no {link}", path.display()));
        } else if let Some(anchor) = anchor {
            let text = if file.is_empty() {
                page.to_owned()
            } else {
                std::fs::read_to_string(&target).unwrap_or_default()
            };
            if !anchors(&text).contains(anchor) {
                faults.push(format!("{}: there is no heading for {link}", path.display()));
            }
        }
    }
    faults
}

#[test]
fn links_lead_somewhere() {
    let mut all = vec![root().join("README.md")];
    pages(&root().join("controller-capi"), &mut all);
    assert!(all.len() >= 5, "{all:?}");
    let mut count = 0;
    for path in &all {
        let page = std::fs::read_to_string(path).expect("the page can be read");
        count += links(&page).len();
        assert_eq!(faults(path, &page), Vec::<String>::new());
    }
    assert!(count > 20, "{count} links");
}

#[test]
fn a_link_to_nowhere_is_found() {
    let here = root().join("README.md");
    for page in ["[a](absent.md)", "[a](#absent)", "# A b\n[a](#b)", "[a](controller-capi/README.md#absent)"]
    {
        assert_eq!(faults(&here, page).len(), 1, "{page}");
    }
    for page in [
        "# A `b`, c\n[a](#a-b-c)",
        "[a](https://example.org/x)",
        "```\n[a](absent.md)\n```",
        "[a](LICENSE-MIT)",
    ] {
        assert_eq!(faults(&here, page), Vec::<String>::new(), "{page}");
    }
}
