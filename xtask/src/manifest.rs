//! A reader for the TOML files of this workspace, as far as the checks need it.
//!
//! It knows tables, arrays of tables, comments, strings, and values that go over several lines inside brackets. It is
//! not a validator: cargo and rustup read the same files and complain about what is wrong in them.

use std::path::Path;

use crate::shell::Outcome;

/// A file as its tables in order; what stands before the first header is a table with an empty name.
pub(crate) struct Manifest {
    tables: Vec<Table>,
}

/// One table: its name and its entries with raw values.
pub(crate) struct Table {
    name: String,
    entries: Vec<(String, String)>,
}

impl Manifest {
    /// Reads a file.
    pub(crate) fn read(path: &Path) -> Outcome<Self> {
        let text =
            std::fs::read_to_string(path).map_err(|e| format!("cannot read {}: {e}", path.display()))?;
        Ok(Self::parse(&text))
    }

    /// Takes a text apart.
    pub(crate) fn parse(text: &str) -> Self {
        let mut tables = vec![Table { name: String::new(), entries: Vec::new() }];
        let mut lines = text.lines().map(without_comment);
        while let Some(line) = lines.next() {
            let line = line.trim();
            if let Some(header) = line.strip_prefix('[') {
                let name = header.trim_matches(['[', ']']).trim().to_string();
                tables.push(Table { name, entries: Vec::new() });
            } else if let Some((key, value)) = line.split_once('=') {
                let mut value = value.trim().to_string();
                while depth(&value) > 0 {
                    let Some(next) = lines.next() else { break };
                    value.push(' ');
                    value.push_str(next.trim());
                }
                let key = key.trim().trim_matches('"').to_string();
                if let Some(table) = tables.last_mut() {
                    table.entries.push((key, value));
                }
            }
        }
        Self { tables }
    }

    /// The first table of this name.
    pub(crate) fn table(&self, name: &str) -> Option<&Table> {
        self.tables.iter().find(|t| t.name == name)
    }

    /// All tables of this name (`[[name]]`).
    pub(crate) fn tables<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Table> {
        self.tables.iter().filter(move |t| t.name == name)
    }
}

impl Table {
    /// The keys in order.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(key, _)| key.as_str())
    }

    /// The value of a key as it is written.
    pub(crate) fn raw(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(k, _)| k == key).map(|(_, value)| value.as_str())
    }

    /// A string.
    pub(crate) fn string(&self, key: &str) -> Option<String> {
        self.list(key).into_iter().next()
    }

    /// All strings in a value; none when the key is not there.
    pub(crate) fn list(&self, key: &str) -> Vec<String> {
        let value = self.raw(key).unwrap_or_default();
        // Every second piece between quotes is the inside of a string.
        value.split('"').skip(1).step_by(2).map(String::from).collect()
    }
}

/// The line up to a `#` that is not inside a string.
fn without_comment(line: &str) -> &str {
    let mut inside = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => inside = !inside,
            '#' if !inside => return &line[..at],
            _ => {}
        }
    }
    line
}

/// How many brackets are still open at the end of a value.
fn depth(value: &str) -> i32 {
    let mut inside = false;
    let mut depth = 0;
    for c in value.chars() {
        match c {
            '"' => inside = !inside,
            '[' | '{' if !inside => depth += 1,
            ']' | '}' if !inside => depth -= 1,
            _ => {}
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLE: &str = r##"
# a comment with = and [brackets]
top = "level"
[package]
name = "x" # "not a name"
url = "http://a/#b"
[features]
default = []
wide = [
    "a[1]", # first
    "b",
]
[[bin]]
name = "one"
[[bin]]
name = "two"
"##;

    #[test]
    fn tables_keys_and_strings() {
        let m = Manifest::parse(SAMPLE);
        let package = m.table("package").unwrap();
        assert_eq!(package.string("name").as_deref(), Some("x"));
        assert_eq!(package.string("url").as_deref(), Some("http://a/#b"));
        assert_eq!(package.raw("missing"), None);
        assert_eq!(m.table("").unwrap().string("top").as_deref(), Some("level"));
        assert!(m.table("nothing").is_none());
    }

    #[test]
    fn lists_over_several_lines() {
        let m = Manifest::parse(SAMPLE);
        let features = m.table("features").unwrap();
        assert_eq!(features.keys().collect::<Vec<_>>(), ["default", "wide"]);
        assert_eq!(features.list("wide"), ["a[1]", "b"]);
        assert!(features.list("default").is_empty());
    }

    #[test]
    fn arrays_of_tables() {
        let m = Manifest::parse(SAMPLE);
        let names: Vec<_> = m.tables("bin").filter_map(|t| t.string("name")).collect();
        assert_eq!(names, ["one", "two"]);
    }
}
