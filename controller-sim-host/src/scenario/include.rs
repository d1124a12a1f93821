//! `include`: design files whose loop is run beside the controllers of a scenario.

use super::fault::{Fault, SourceText, code};
use super::library::Library;
use super::table::Table;
use super::value::shortened;
use std::ops::Range;
use std::sync::Arc;
use toml::de::DeTable;

/// Most files that one scenario includes.
const MOST: usize = 100;

/// All keys at the top of a scenario.
const ROOT_KEYS: [&str; 18] = [
    "version",
    "title",
    "description",
    "include",
    "ts",
    "duration",
    "latency",
    "substeps",
    "units",
    "plant",
    "initial",
    "noise",
    "sensor",
    "actuator",
    "event",
    "controller",
    "sweep",
    "uncertainty",
];

/// A file that `include` names.
#[derive(Debug)]
pub(super) struct Include {
    /// Where it is named.
    span: Range<usize>,
    name: String,
    /// Its text, or why there is none.
    pub(super) text: Result<Arc<SourceText>, String>,
}

/// Loads what the `include` of a text names. `replaced` is a file's name with the text to take for it.
pub(super) fn load(
    document: &DeTable<'_>,
    own: &str,
    replaced: Option<(&str, &str)>,
    library: &Library<'_>,
) -> Vec<Include> {
    let Some(value) = document.get("include") else { return Vec::new() };
    let items = match value.get_ref().as_array() {
        Some(list) => list.iter().collect(),
        None => vec![value],
    };
    let named = items.into_iter().filter_map(|item| Some((item.get_ref().as_str()?, item.span())));
    named
        .take(MOST)
        .map(|(name, span)| {
            let text = match replaced.filter(|(path, _)| *path == name) {
                Some((_, text)) => Ok(text.into()),
                None => library.text(name),
            };
            let text = text.and_then(|text| {
                if *text == *own {
                    return Err(format!("`{}` includes itself", shortened(name)));
                }
                Ok(Arc::new(SourceText { name: name.to_owned(), text: text.as_ref().to_owned() }))
            });
            Include { span, name: name.to_owned(), text }
        })
        .collect()
}

/// The tables of all texts.
#[derive(Debug)]
pub(super) struct Roots<'a> {
    /// That of the scenario itself.
    pub(super) own: Table<'a>,
    /// Those it includes.
    pub(super) included: Vec<Table<'a>>,
}

impl<'a> Roots<'a> {
    /// The one whose `key` counts: the scenario's own, or what the first included text says when it has none.
    pub(super) fn of(&self, key: &'static str) -> &Table<'a> {
        match self.included.first() {
            Some(first) if self.own.span(key).is_none() && first.span(key).is_some() => first,
            _ => &self.own,
        }
    }

    /// The scenario's own table last, as its controllers come after the included ones.
    pub(super) fn all(&self) -> impl Iterator<Item = &Table<'a>> {
        self.included.iter().chain([&self.own])
    }

    /// Reports all keys that nobody asked for.
    pub(super) fn finish(self) {
        for table in &self.included {
            for key in ROOT_KEYS {
                let _ = table.span(key);
            }
        }
        self.own.finish();
        self.included.into_iter().for_each(Table::finish);
    }
}

/// Reports everything that is wrong with the files as such.
/// `read` are those whose tables `roots` has.
pub(super) fn check(roots: &Roots<'_>, includes: &[Include], read: &[&Include]) {
    let (own, log) = (&roots.own, roots.own.log);
    let items = own.items("include");
    for item in items.iter().filter(|item| !item.value.is_str()) {
        let help = "write `include = \"loop.toml\"` or `include = [\"a.toml\", \"b.toml\"]`";
        own.wrong_type("include", item.value, item.span.clone(), "the name of a file", Some(help.to_owned()));
    }
    if let (true, Some(span)) = (items.len() > MOST, own.span("include")) {
        let message = format!("`include` names {} files; allowed: at most {MOST}", items.len());
        log.fault(Fault::new(code::TOO_LARGE, span, message));
    }
    for (index, include) in includes.iter().enumerate() {
        let name = shortened(&include.name);
        if let Some(first) = includes.iter().take(index).find(|other| other.name == include.name) {
            let fault =
                Fault::new(code::DUPLICATE, include.span.clone(), format!("`{name}` is included twice"));
            log.fault(fault.help("remove one of the two").related(first.span.clone(), "the first time"));
        }
        if let Err(problem) = &include.text {
            let mut parts = problem.splitn(2, "; ");
            let fault = Fault::new(code::FILE, include.span.clone(), parts.next().unwrap_or(""));
            log.fault(match parts.next() {
                Some(help) => fault.help(help),
                None => fault,
            });
        }
    }
    for (table, include) in roots.included.iter().zip(read) {
        for (key, problem) in [
            ("include", "a file that is included cannot include others"),
            ("sweep", "a file that is included cannot be a sweep"),
        ] {
            if let Some(span) = table.key_span(key) {
                let help = format!("write the `{key}` in the scenario that is run");
                log.fault(Fault::new(code::NOT_SUPPORTED, span, problem).help(help));
            }
        }
        let count = table.items("controller").len();
        if count != 1 {
            let message = format!(
                "`{}` has {count} controllers; an included file has exactly one",
                shortened(&include.name)
            );
            let help = "a design file holds one loop: a plant and its controller";
            log.fault(Fault::new(code::CONFLICT, include.span.clone(), message).help(help));
        }
    }
}
