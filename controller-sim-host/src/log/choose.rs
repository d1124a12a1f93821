//! Which column is which.

use crate::scenario::{Fault, closest, code};

/// A column, as a person names it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Column {
    /// Not said.
    #[default]
    Usual,
    /// Its number, from 1.
    Number(usize),
    /// What is written above it.
    Name(String),
}

impl Column {
    /// What was written on the command line: a number, or a name.
    ///
    /// ```
    /// use controller_sim_host::log::Column;
    /// assert_eq!(Column::from_text("2"), Column::Number(2));
    /// assert_eq!(Column::from_text("T_1"), Column::Name("T_1".to_owned()));
    /// ```
    #[must_use]
    pub fn from_text(text: &str) -> Self {
        match text.trim().parse() {
            Ok(number) => Self::Number(number),
            Err(_) => Self::Name(text.trim().to_owned()),
        }
    }
}

/// What a column is wanted for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Role {
    /// In messages: `input`.
    pub name: &'static str,
    /// The option that names its column: `--input`.
    pub option: &'static str,
    /// Which column was asked for.
    pub column: Column,
    /// Words of names that are usual for it, in small letters, the most usual first.
    pub usual: &'static [&'static str],
    /// Whether there must be one.
    pub required: bool,
}

impl Role {
    /// The times.
    #[must_use]
    pub const fn time(column: Column) -> Self {
        let usual = &[
            "time",
            "t",
            "timestamp",
            "datetime",
            "date",
            "seconds",
            "sec",
            "elapsed",
            "zeit",
            "uhrzeit",
            "zeitstempel",
            "datum",
        ];
        Self { name: "time", option: "--time", column, usual, required: true }
    }

    /// The input of the process: what the controller or a person sets.
    #[must_use]
    pub const fn input(column: Column) -> Self {
        let usual = &[
            "u",
            "input",
            "mv",
            "op",
            "co",
            "heater",
            "valve",
            "actuator",
            "manipulated",
            "control",
            "power",
            "pwm",
            "q1",
            "drive",
            "stellgr\u{f6}\u{df}e",
            "stellgroesse",
            "ventil",
            "heizung",
        ];
        Self { name: "input", option: "--input", column, usual, required: true }
    }

    /// The output of the process: what is measured.
    #[must_use]
    pub const fn output(column: Column) -> Self {
        let usual = &[
            "y",
            "output",
            "pv",
            "temperature",
            "temp",
            "level",
            "flow",
            "pressure",
            "speed",
            "measurement",
            "measured",
            "process",
            "sensor",
            "t1",
            "istwert",
            "temperatur",
            "druck",
            "durchfluss",
        ];
        Self { name: "output", option: "--output", column, usual, required: true }
    }

    /// The set-point.
    #[must_use]
    pub const fn setpoint(column: Column) -> Self {
        let usual = &["r", "w", "sp", "setpoint", "set", "reference", "ref", "target", "desired", "sollwert"];
        Self { name: "setpoint", option: "--setpoint", column, usual, required: false }
    }
}

/// A word of a name: letters and digits, small.
pub(super) fn words(name: &str) -> Vec<String> {
    let split = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    split.map(str::to_lowercase).collect()
}

/// The column of each role; `None` for one that is not there and need not be. `names` are empty without a line of names;
/// `date` belongs to the times in another column and is not offered.
pub(super) fn choose(
    file: &str,
    names: &[String],
    width: usize,
    roles: &[Role],
    date: Option<usize>,
) -> Result<Vec<Option<usize>>, Fault> {
    let mut chosen: Vec<Option<usize>> = vec![None; roles.len()];
    for (place, role) in chosen.iter_mut().zip(roles) {
        *place = match &role.column {
            Column::Usual => None,
            named => Some(named_column(file, names, width, role, named)?),
        };
    }
    for i in 0..roles.len() {
        for j in 0..i {
            if chosen[i].is_some() && chosen[i] == chosen[j] {
                let message = format!("`{}` and `{}` name the same column", roles[j].option, roles[i].option);
                return Err(Fault::new(code::UNKNOWN_NAME, 0..0, message).help(listing(names, width)));
            }
        }
    }
    // The whole name first, then a word of it; the most usual words before the others.
    let parts: Vec<Vec<String>> = names.iter().map(|name| words(name)).collect();
    for whole in [true, false] {
        for (i, role) in roles.iter().enumerate() {
            if chosen[i].is_some() || role.column != Column::Usual {
                continue;
            }
            let fits = |column: &usize, word: &str| {
                let words = &parts[*column];
                let matches = |own: &String| own == word || (word.len() >= 4 && own.starts_with(word));
                if whole { words.len() == 1 && words[0] == word } else { words.iter().any(matches) }
            };
            let taken = chosen.clone();
            let mut free = role.usual.iter().flat_map(|word| {
                let columns = (0..parts.len()).filter(|c| !taken.contains(&Some(*c)) && date != Some(*c));
                columns.filter(|c| fits(c, word)).collect::<Vec<_>>()
            });
            chosen[i] = free.next();
        }
    }
    let left: Vec<usize> = (0..width).filter(|c| !chosen.contains(&Some(*c)) && date != Some(*c)).collect();
    let missing: Vec<usize> =
        (0..roles.len()).filter(|&i| chosen[i].is_none() && roles[i].required).collect();
    let named = missing.len() < roles.iter().filter(|role| role.required).count();
    // By their order: when no name says anything, or when there is nothing else it could be.
    if (!named && left.len() >= missing.len()) || left.len() == missing.len() {
        for (role, column) in missing.iter().zip(&left) {
            chosen[*role] = Some(*column);
        }
    } else if let Some(&first) = missing.first() {
        let role = &roles[first];
        let message = match left.is_empty() {
            true => format!("`{file}` has no column left for the {}", role.name),
            false => format!("`{file}`: which column is the {}?", role.name),
        };
        let rows = if role.option == "--time" { ", or `--log-ts S` where the log has no times" } else { "" };
        let help = format!("say it by `{}`{rows}; {}", role.option, listing(names, width));
        return Err(Fault::new(code::UNKNOWN_NAME, 0..0, message).help(help));
    }
    Ok(chosen)
}

fn named_column(
    file: &str,
    names: &[String],
    width: usize,
    role: &Role,
    column: &Column,
) -> Result<usize, Fault> {
    let fault = |message: String, help: String| Err(Fault::new(code::UNKNOWN_NAME, 0..0, message).help(help));
    match column {
        Column::Number(n) => match n.checked_sub(1).filter(|index| *index < width) {
            Some(index) => Ok(index),
            None => fault(format!("`{file}` has no column {n} for `{}`", role.option), listing(names, width)),
        },
        Column::Usual => Ok(0),
        Column::Name(name) => {
            let same =
                |other: &&String| other.as_str() == name || other.to_lowercase() == name.to_lowercase();
            let exact: Vec<usize> = (0..names.len()).filter(|&i| names[i] == *name).collect();
            let alike: Vec<usize> = (0..names.len()).filter(|&i| same(&&names[i])).collect();
            match (&*exact, &*alike) {
                ([only], _) | ([], [only]) => Ok(*only),
                ([], []) => {
                    let known: Vec<&str> = names.iter().map(String::as_str).collect();
                    let help = match closest(name, &known) {
                        Some(meant) => format!("did you mean \"{meant}\"?"),
                        None => listing(names, width),
                    };
                    fault(format!("`{file}` has no column `{name}` for `{}`", role.option), help)
                }
                ([], several) | (several, _) => fault(
                    format!("`{file}` has {} columns `{name}`", several.len()),
                    format!(
                        "give the number of one: {}",
                        several.iter().map(|i| (i + 1).to_string()).collect::<Vec<_>>().join(", ")
                    ),
                ),
            }
        }
    }
}

fn listing(names: &[String], width: usize) -> String {
    if names.is_empty() {
        return format!("columns are counted from 1; there are {width}, without names");
    }
    let shown: Vec<String> = names.iter().take(12).map(|name| format!("\"{name}\"")).collect();
    let more = if names.len() > shown.len() { ", ..." } else { "" };
    format!("there are {}{more}", shown.join(", "))
}
