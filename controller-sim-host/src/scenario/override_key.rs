//! Another value for one key of a text, everything else as it is.

use super::fault::{Fault, code};
use super::key_path::{self, Part};
use super::suggest::closest;
use super::value::shortened;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of a scenario with `value` for the key `key`.
///
/// A key is a path: `latency`, `noise.std`, `controller.NAME.pid.kp`, `event.2.disturbance` (from 1, in the order of
/// the text), in quotes where a part has other characters than letters, digits, `_` and `-`:
/// `controller."PI + DOB".observer.alpha`. One that is not written yet is added. `value` is a TOML value; anything else
/// is taken as a text, so that `1/(1+s)` needs no quotes.
///
/// # Errors
/// A path that is none, names nothing, or a whole table that is not written on one line. The place is the table in
/// which it was looked for, or the beginning.
///
/// ```
/// use controller_sim_host::scenario::override_key;
/// let text = "ts = 0.1\n[plant]\ntf = \"1/(1+s)\"\n[[controller]]\nname = \"PI\"\npid = { kp = 1.0 }\n";
/// let faster = override_key(text, "controller.PI.pid.kp", "2.5").expect("it is there");
/// assert!(faster.contains("pid = { kp = 2.5 }"));
/// let other = override_key(text, "plant.tf", "2/(1+s)").expect("it is there");
/// assert!(other.contains("tf = \"2/(1+s)\""));
/// let fault = override_key(text, "controller.pi.pid.kp", "2.5").expect_err("no such controller");
/// assert_eq!(fault.help.as_deref(), Some("did you mean \"PI\"?"));
/// ```
pub fn override_key(text: &str, key: &str, value: &str) -> Result<String, Fault> {
    let (document, _) = DeTable::parse_recoverable(text);
    let edit = Edit::find(text, document.get_ref(), key)?;
    Ok(edit.apply(text, &as_value(value)))
}

/// `value` as TOML.
pub(super) fn as_value(value: &str) -> String {
    let value = value.trim();
    let line = format!("x = {value}");
    let is_value = DeTable::parse(&line).is_ok_and(|table| {
        let mut entries = table.get_ref().iter();
        let whole = entries.next().is_some_and(|(_, only)| only.span() == (4..line.len()));
        whole && entries.next().is_none()
    });
    if is_value {
        return value.to_owned();
    }
    let mut quoted = String::from("\"");
    for c in value.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04x}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// Where and how a value is put into a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Edit {
    /// What goes away.
    pub(super) span: Range<usize>,
    before: String,
    after: &'static str,
}

impl Edit {
    /// How to give `key` a value in `text`, which `document` was parsed from.
    pub(super) fn find(text: &str, document: &DeTable<'_>, key: &str) -> Result<Self, Fault> {
        let wrong = |problem: &str| {
            let message = format!("`{}` is no key: {problem}", shortened(key));
            Fault::new(code::UNKNOWN_KEY, 0..0, message)
                .help("a key is written as `latency`, `noise.std` or `controller.NAME.pid.kp`")
        };
        let parts = key_path::parse(key).map_err(wrong)?;
        let mut search = Search { text, key, rooms: vec![Room::root(text)], names: Vec::new() };
        match search.walk(document, &parts)? {
            Found::Value(span) => Ok(Self { span, before: String::new(), after: "" }),
            Found::Nothing(from) => {
                search.insertion(&parts, from).ok_or_else(|| wrong("it cannot be written in TOML"))
            }
        }
    }

    /// The length of what an application puts in.
    pub(super) fn length(&self, value: &str) -> usize {
        self.before.len() + value.len() + self.after.len()
    }

    /// Whether the key is not written yet.
    pub(super) fn adds_key(&self) -> bool {
        !self.before.is_empty()
    }

    /// The text with `value`, which must be TOML.
    pub(super) fn apply(&self, text: &str, value: &str) -> String {
        let (start, end) = (text.get(..self.span.start), text.get(self.span.end..));
        [start.unwrap_or(text), &self.before, value, self.after, end.unwrap_or("")].concat()
    }
}

/// A table that a key can be added to.
struct Room {
    /// Where the new key goes.
    at: usize,
    /// What has to stand before and after it.
    around: [&'static str; 2],
    /// The first part of the path that belongs into it.
    from: usize,
}

impl Room {
    /// Above everything else.
    fn root(text: &str) -> Self {
        Self { at: if text.starts_with('\u{feff}') { 3 } else { 0 }, around: ["", "\n"], from: 0 }
    }
}

enum Found {
    /// The value is at this place.
    Value(Range<usize>),
    /// There is nothing from this part of the path on.
    Nothing(usize),
}

struct Search<'t> {
    text: &'t str,
    key: &'t str,
    rooms: Vec<Room>,
    /// The parts so far that are keys: those of a header.
    names: Vec<&'t str>,
}

impl<'t> Search<'t> {
    fn walk(&mut self, document: &DeTable<'_>, parts: &'t [Part]) -> Result<Found, Fault> {
        let mut table = document;
        let mut at = 0;
        while let Some(part) = parts.get(at) {
            let Some(mut value) = table.get(&*part.name) else { return Ok(Found::Nothing(at)) };
            self.names.push(&part.name);
            at += 1;
            if let (Some(list), Some(index)) = (value.get_ref().as_array(), parts.get(at)) {
                value = element(list.iter(), &part.name, index, &value.span())?;
                at += 1;
            }
            let last = at >= parts.len();
            match value.get_ref() {
                DeValue::Table(inner) if !last => {
                    self.rooms.extend(self.room(value, inner, at));
                    table = inner;
                }
                _ if last => return self.whole(value),
                _ => {
                    let message =
                        format!("`{}` has no keys; `{}` cannot be set", part.name, shortened(self.key));
                    return Err(Fault::new(code::UNKNOWN_KEY, value.span(), message));
                }
            }
        }
        Ok(Found::Nothing(parts.len()))
    }

    /// The place of a value that stands on its own.
    fn whole(&self, value: &Spanned<DeValue<'_>>) -> Result<Found, Fault> {
        let raw = self.text.get(value.span()).unwrap_or("");
        let in_lines = match value.get_ref() {
            DeValue::Table(_) => !raw.starts_with('{'),
            DeValue::Array(list) => {
                !raw.starts_with('[')
                    || list.iter().any(|item| item.get_ref().is_table() && raw.starts_with("[["))
            }
            _ => false,
        };
        if in_lines {
            let message = format!("`{}` is a table; a single key can be set", shortened(self.key));
            let fault = Fault::new(code::WRONG_TYPE, value.span(), message);
            return Err(fault.help("write one of its keys behind it, after a `.`"));
        }
        Ok(Found::Value(value.span()))
    }

    /// How a key is added to a table; none when its keys do not stand together.
    fn room(&self, value: &Spanned<DeValue<'_>>, table: &DeTable<'_>, from: usize) -> Option<Room> {
        let span = value.span();
        let raw = self.text.get(span.start..)?;
        if raw.starts_with('{') {
            let around = if table.iter().next().is_some() { [" ", ","] } else { [" ", " "] };
            return Some(Room { at: span.start + 1, around, from });
        }
        // A header of a table below this one may stand for it.
        let line = raw.lines().next()?;
        let header = line.split('#').next()?.trim().trim_start_matches('[').trim_end_matches(']');
        let named = raw.starts_with('[')
            && key_path::parse(header).is_ok_and(|parts| parts.len() == self.names.len());
        if !named {
            return None;
        }
        match self.text.get(span.end..)?.find('\n') {
            Some(end) => Some(Room { at: span.end + end + 1, around: ["", "\n"], from }),
            None => Some(Room { at: self.text.len(), around: ["\n", ""], from }),
        }
    }

    /// The key added to the innermost table there is.
    fn insertion(&self, parts: &[Part], nothing_from: usize) -> Option<Edit> {
        let room = self.rooms.last()?;
        let rest = parts.get(room.from..).filter(|rest| !rest.is_empty() && nothing_from < parts.len())?;
        let names: Option<Vec<String>> = rest.iter().map(|part| key_path::written(&part.name)).collect();
        let before = format!("{}{} = ", room.around[0], names?.join("."));
        Some(Edit { span: room.at..room.at, before, after: room.around[1] })
    }
}

/// The element of a list that a part of the path means: by its name, or by its number from 1.
fn element<'v, 'd: 'v>(
    list: impl Iterator<Item = &'v Spanned<DeValue<'d>>> + Clone,
    key: &str,
    wanted: &Part,
    place: &Range<usize>,
) -> Result<&'v Spanned<DeValue<'d>>, Fault> {
    let name = |item: &'v Spanned<DeValue<'d>>| item.get_ref().as_table()?.get("name")?.get_ref().as_str();
    if let Some(named) = list.clone().find(|item| name(item) == Some(&wanted.name)) {
        return Ok(named);
    }
    let index: Option<usize> = wanted.name.parse().ok();
    if let Some(item) = index.and_then(|n| n.checked_sub(1)).and_then(|n| list.clone().nth(n)) {
        return Ok(item);
    }
    let (names, count): (Vec<&str>, usize) = (list.clone().filter_map(name).collect(), list.count());
    let message = format!("there is no `{key}` called `{}`", shortened(&wanted.name));
    let help = match closest(&wanted.name, &names) {
        Some(meant) => format!("did you mean \"{meant}\"?"),
        None if names.is_empty() => format!("they are counted from 1; there are {count}"),
        None => format!("there are \"{}\"", names.join("\", \"")),
    };
    Err(Fault::new(code::UNKNOWN_NAME, place.clone(), message).help(help))
}
