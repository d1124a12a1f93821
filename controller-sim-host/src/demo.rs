//! The built-in scenarios: what the program shows when it is started without arguments, and a gallery.

mod files;

use crate::output::{FileError, FileTarget, publish};
use crate::scenario::{Files, closest, read_with};
use crate::simulate::Precision;
use std::cell::RefCell;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The text of the first built-in scenario, `scenarios/demo.toml`.
pub const SCENARIO: &str = include_str!("../scenarios/demo.toml");

/// What it is called in messages and results.
pub const NAME: &str = "demo";

/// What to do after the demo.
pub const TRY_NEXT: &str = "
Try next (in the source tree write `cargo sim` for `controller-sim`):
  controller-sim demo --report demo.html      the same with plots, as a page for the browser
  controller-sim demo --list                  what else is built in
  controller-sim demo --save my.toml          write this scenario to a file, to change it
  controller-sim run my.toml --csv my.csv     run it and keep every sample
  controller-sim run --help                   everything else, with examples
";

/// A built-in scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BuiltIn {
    /// Its file below `scenarios/`.
    pub path: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl BuiltIn {
    /// What it is called: the name of its file without folder and ending.
    #[must_use]
    pub fn name(&self) -> &'static str {
        let file = self.path.rsplit_once('/').map_or(self.path, |(_, file)| file);
        file.strip_suffix(".toml").unwrap_or(file)
    }

    /// What it shows: its `title`, or the first line of its text when it has none.
    #[must_use]
    pub fn title(&self) -> String {
        let title = toml::de::DeTable::parse(self.text).ok().and_then(|table| {
            let title = table.get_ref().get("title")?.get_ref().as_str()?.to_owned();
            Some(title)
        });
        title.unwrap_or_else(|| {
            self.text.lines().next().unwrap_or("").trim_start_matches(['#', ' ']).to_owned()
        })
    }

    /// The files that it may name: those beside it.
    #[must_use]
    pub fn files(&self) -> impl Files + use<> {
        self.beside()
    }

    fn beside(&self) -> Beside {
        let folder = self.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        Beside { folder, seen: RefCell::default() }
    }

    /// The files that it names, each once: names and texts.
    fn named_files(&self) -> Vec<(String, &'static str)> {
        let files = self.beside();
        // Built-in scenarios have no faults, and what is named is seen in any case.
        let _ = read_with(self.name(), self.text, Precision::F64, &files);
        files.seen.into_inner()
    }
}

/// The built-in files of a folder below `scenarios/`, and which of them were asked for.
struct Beside {
    folder: &'static str,
    seen: RefCell<Vec<(String, &'static str)>>,
}

impl Files for Beside {
    fn load(&self, path: &str) -> Result<String, String> {
        let mut parts: Vec<&str> = self.folder.split('/').filter(|part| !part.is_empty()).collect();
        for part in path.split('/') {
            match part {
                "." | "" => {}
                ".." => drop(parts.pop()),
                name => parts.push(name),
            }
        }
        let full = parts.join("/");
        let Some((_, text)) = files::ALL.iter().find(|(name, _)| *name == full) else {
            return Err(format!("there is no built-in file `{path}`"));
        };
        let mut seen = self.seen.borrow_mut();
        if seen.iter().all(|(name, _)| name != path) {
            seen.push((path.to_owned(), text));
        }
        Ok((*text).to_owned())
    }
}

/// Every built-in scenario, those for learning first, then the figures of the papers.
pub fn all() -> impl Iterator<Item = BuiltIn> {
    let scenarios = files::ALL.iter().filter(|(path, _)| path.ends_with(".toml"));
    scenarios.map(|&(path, text)| BuiltIn { path, text })
}

/// The built-in scenario `name`, or all of them, in order, whose names begin with `name-`. Folder, ending and leading zeros
/// make no difference.
///
/// # Errors
/// The name that was probably meant, when nothing is called so.
pub fn named(name: &str) -> Result<Vec<BuiltIn>, Option<&'static str>> {
    let file = name.strip_suffix(".toml").unwrap_or(name);
    let wanted = file.rsplit_once('/').map_or(file, |(_, file)| file);
    let begins = |one: &BuiltIn| {
        let mut parts = one.name().split('-');
        wanted.split('-').all(|part| parts.next().is_some_and(|own| is_same_part(own, part)))
    };
    let group: Vec<BuiltIn> = all().filter(begins).collect();
    let count = wanted.split('-').count();
    match group.iter().find(|one| one.name().split('-').count() == count) {
        Some(exact) => Ok(vec![*exact]),
        None if group.is_empty() => {
            let names: Vec<&'static str> = all().map(|one| one.name()).collect();
            let mut known = groups(&names);
            known.splice(0..0, names);
            Err(closest(wanted, &known))
        }
        None => Ok(group),
    }
}

/// The beginnings that several of `names` share, each once.
fn groups(names: &[&'static str]) -> Vec<&'static str> {
    let mut groups: Vec<&'static str> = Vec::new();
    for name in names {
        let beginnings = name.match_indices('-').filter_map(|(at, _)| name.get(..at));
        for group in beginnings.filter(|group| !groups.contains(group)).collect::<Vec<_>>() {
            let members = names
                .iter()
                .filter(|other| other.strip_prefix(group).is_some_and(|rest| rest.starts_with('-')));
            if members.count() > 1 {
                groups.push(group);
            }
        }
    }
    groups
}

/// `4` is `04`: figures have numbers.
fn is_same_part(a: &str, b: &str) -> bool {
    let number =
        |part: &str| part.bytes().all(|c| c.is_ascii_digit()).then(|| part.parse::<u32>().ok()).flatten();
    a == b || number(a).is_some_and(|n| number(b) == Some(n))
}

/// Writes a built-in scenario to `path`, or to the next free name when that exists and `force` is not given, and beside it
/// the files it names under the names it has for them: all or none. One of these that is there with the same bytes stays.
/// Gives the paths that were written, that of the scenario first.
///
/// # Errors
/// A file that cannot be written; a path that is no file; without `force` another file of the name of one of these.
pub fn save(scenario: &BuiltIn, path: &Path, force: bool) -> Result<Vec<PathBuf>, FileError> {
    let target = FileTarget::next_free(path, force)?;
    let mut files = vec![(target, scenario.text)];
    for (name, text) in scenario.named_files() {
        let beside = path.with_file_name(name);
        if fs::read(&beside).is_ok_and(|bytes| bytes == text.as_bytes()) {
            continue;
        }
        files.push((FileTarget::new(&beside, force)?, text));
    }
    let mut complete = Vec::new();
    for (target, text) in &files {
        let mut draft = target.create()?;
        draft.write_all(text.as_bytes()).map_err(|error| target.failed(&error))?;
        complete.push(draft.complete()?);
    }
    publish(complete)?;
    Ok(files.iter().map(|(target, _)| target.path().to_owned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Every file below `folder` with its path from there.
    fn on_disc(folder: &Path, before: &str, list: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).expect("readable") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy();
            if path.is_dir() {
                on_disc(&path, &format!("{before}{name}/"), list);
            } else {
                list.insert(format!("{before}{name}"), fs::read_to_string(&path).expect("a text"));
            }
        }
    }

    #[test]
    fn every_file_of_the_folder_is_built_in() {
        let mut expected = BTreeMap::new();
        on_disc(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios"), "", &mut expected);
        let built_in: BTreeMap<String, String> =
            files::ALL.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
        assert_eq!(
            built_in.keys().collect::<Vec<_>>(),
            expected.keys().collect::<Vec<_>>(),
            "see src/demo/files.rs"
        );
        assert_eq!(built_in, expected);
        assert_eq!(files::ALL.len(), built_in.len(), "each once");
    }

    #[test]
    fn names_are_unique_and_every_scenario_has_a_title() {
        let names: Vec<&str> = all().map(|one| one.name()).collect();
        assert_eq!(names.first(), Some(&NAME));
        for (i, one) in all().enumerate() {
            assert_eq!(names.iter().filter(|name| **name == one.name()).count(), 1, "{}", one.name());
            assert!(!one.title().is_empty() && one.title().chars().count() <= 120, "{i}: {}", one.title());
        }
    }

    #[test]
    fn a_name_is_exact_or_the_beginning_of_several() {
        let names = |name: &str| named(name).map(|list| list.iter().map(BuiltIn::name).collect::<Vec<_>>());
        assert_eq!(names("demo"), Ok(vec!["demo"]));
        assert_eq!(names("scenarios/windup.toml"), Ok(vec!["windup"]));
        assert_eq!(names("wind-up"), Err(Some("windup")));
        assert_eq!(names("de-fig-6"), Ok(vec!["de-fig-06"]));
        let group = names("figures/dob-fig-4").expect("several");
        assert!(group.len() > 1 && group.iter().all(|name| name.starts_with("dob-fig-04-")), "{group:?}");
        assert_eq!((names(""), names("wind")), (Err(None), Err(Some("windup"))));
        assert_eq!((names("chaptr"), names("de-figg")), (Err(Some("chapter")), Err(Some("de-fig"))));
    }
}
