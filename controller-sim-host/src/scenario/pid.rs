//! The key `pid` of a controller: parallel, standard or series form.

use super::fault::{Fault, code};
use super::number::Allowed;
use super::places::Places;
use super::table::Table;
use controller_core::{Action, IntegralRule, Param, PidConfig};

/// How the gains are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `kp`, `ki`, `kd`.
    Parallel,
    /// `k*(1 + 1/(ti*s) + td*s)`.
    Standard,
    /// `k*(1 + 1/(ti*s))*(1 + td*s)`.
    Series,
}

const FORMS: &[(&str, Form)] =
    &[("parallel", Form::Parallel), ("standard", Form::Standard), ("series", Form::Series)];
const PARALLEL_KEYS: [&str; 3] = ["kp", "ki", "kd"];
const TIME_KEYS: [&str; 3] = ["k", "ti", "td"];
const GAINS: [Param; 3] = [Param::Kp, Param::Ki, Param::Kd];

impl Form {
    fn name(self) -> &'static str {
        FORMS.iter().find(|(_, form)| *form == self).map_or("", |(name, _)| name)
    }

    fn keys(self) -> [&'static str; 3] {
        if self == Self::Parallel { PARALLEL_KEYS } else { TIME_KEYS }
    }
}

/// A PID as it was written, so that an event can change a part of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct PidDraft {
    form: Form,
    /// The values of the form's three keys.
    values: [f64; 3],
    rest: PidConfig,
}

impl Default for PidDraft {
    fn default() -> Self {
        Self { form: Form::Parallel, values: [0.0; 3], rest: PidConfig::default() }
    }
}

impl PidDraft {
    /// The parameters in parallel form.
    pub(super) fn config(&self) -> PidConfig {
        let [first, second, third] = self.values;
        let gains = match self.form {
            Form::Parallel => PidConfig { kp: first, ki: second, kd: third, ..self.rest },
            Form::Standard => PidConfig::from_standard(first, second, third, self.rest.tf),
            Form::Series => PidConfig::from_series(first, second, third, self.rest.tf),
        };
        PidConfig { kp: gains.kp, ki: gains.ki, kd: gains.kd, ..self.rest }
    }

    /// A PID in parallel form.
    pub(super) fn parallel(config: PidConfig) -> Self {
        Self { form: Form::Parallel, values: [config.kp, config.ki, config.kd], rest: config }
    }

    /// Whether the gains were computed from others.
    pub(super) fn is_converted(&self) -> bool {
        self.form != Form::Parallel
    }

    /// Reads the whole PID of a controller.
    pub(super) fn read(table: Table<'_>, places: &mut Places) -> Self {
        let form = table.choice("form", FORMS).map_or(Form::Parallel, |form| form.value);
        let values = if form == Form::Parallel { [0.0; 3] } else { [0.0, f64::INFINITY, 0.0] };
        let mut draft = Self { form, values, ..Self::default() };
        let given = draft.read_gains(&table, places);
        let bad_form = table.span("form").is_some_and(|span| table.log.is_faulty(&span));
        if bad_form {
            places.silence(&GAINS);
        } else if form == Form::Parallel && given == 0 {
            let message = format!("`{}` has no gain", table.name("kp").trim_end_matches(".kp"));
            table.log.fault(
                Fault::new(code::MISSING_KEY, table.place.clone(), message).help(
                    "write at least one of `kp`, `ki`, `kd`, for example `pid = { kp = 1.0, ki = 0.5 }`",
                ),
            );
        } else if form != Form::Parallel && table.span("k").is_none() {
            // With the gains of another form one fault says it.
            if PARALLEL_KEYS.into_iter().all(|key| table.span(key).is_none()) {
                table.missing("k", "the gain, for example `k = 1.0`");
            }
            places.silence(&GAINS);
        }
        draft.read_rest(table, places);
        draft
    }

    /// Reads a part of a PID over what was there.
    pub(super) fn change(&mut self, table: Table<'_>, controller: &str, places: &mut Places) {
        if let Some(form) = table.choice("form", FORMS)
            && form.value != self.form
        {
            let message = format!("an event cannot change the form of a PID to `{}`", form.value.name());
            let help = format!("controller `{controller}` is written in the {} form", self.form.name());
            table.log.fault(Fault::new(code::CONFLICT, form.span, message).help(help));
            places.silence(&GAINS);
        }
        self.read_gains(&table, places);
        self.read_rest(table, places);
    }

    /// Reads the form's three keys; returns how many were there, in this or another form.
    fn read_gains(&mut self, table: &Table<'_>, places: &mut Places) -> usize {
        let mut given = 0;
        for (index, key) in self.form.keys().into_iter().enumerate() {
            let Some(span) = table.span(key) else { continue };
            given += 1;
            for param in affected(self.form, index) {
                places.set(*param, table.name(key), span.clone());
            }
            let value = match key {
                "ti" => read_integral_time(table),
                "td" => table.number_in(key, Allowed::new(0.0, 1e12, "s")),
                _ => table.number(key, Some(Allowed::new(-1e15, 1e15, ""))),
            };
            if let Some(value) = value {
                self.values[index] = value.value;
            }
        }
        given + self.refuse_other_form(table, places)
    }

    /// Keys of another form are a misunderstanding, told once.
    fn refuse_other_form(&self, table: &Table<'_>, places: &mut Places) -> usize {
        let (others, theirs) = match self.form {
            Form::Parallel => (TIME_KEYS, "standard and series forms"),
            Form::Standard | Form::Series => (PARALLEL_KEYS, "parallel form"),
        };
        let found: Vec<_> =
            others.into_iter().filter_map(|key| table.key_span(key).map(|at| (key, at))).collect();
        let Some((_, first)) = found.iter().min_by_key(|(_, at)| at.start) else { return 0 };
        let bad_form = table.span("form").is_some_and(|span| table.log.is_faulty(&span));
        if !bad_form {
            let names: Vec<String> = found.iter().map(|(key, _)| format!("`{key}`")).collect();
            let (verb, names) = (if found.len() == 1 { "belongs" } else { "belong" }, names.join(", "));
            let message = format!(
                "{names} {verb} to the {theirs}; this PID is in the {} form, with `{}`",
                self.form.name(),
                self.form.keys().join("`, `")
            );
            let help = match self.form {
                Form::Parallel => {
                    "add `form = \"standard\"` or `form = \"series\"`, and use `k`, `ti`, `td` only"
                }
                _ => "take `form` away to write `kp`, `ki`, `kd`",
            };
            table.log.fault(Fault::new(code::CONFLICT, first.clone(), message).help(help));
        }
        places.silence(&GAINS);
        found.len()
    }

    fn read_rest(&mut self, table: Table<'_>, places: &mut Places) {
        let rest = &mut self.rest;
        for (key, param, target) in
            [("tf", Param::Tf, &mut rest.tf), ("b", Param::B, &mut rest.b), ("c", Param::C, &mut rest.c)]
        {
            super::sections::take(&table, key, param, places, target);
        }
        if let Some(action) =
            table.choice("action", &[("reverse", Action::Reverse), ("direct", Action::Direct)])
        {
            rest.action = action.value;
        }
        let rules = [("backward", IntegralRule::Backward), ("trapezoid", IntegralRule::Trapezoid)];
        if let Some(rule) = table.choice("integral_rule", &rules) {
            rest.integral_rule = rule.value;
        }
        table.finish();
    }
}

/// The gains that the key number `index` of `form` sets.
fn affected(form: Form, index: usize) -> &'static [Param] {
    match (form, index) {
        (Form::Parallel, 0) => &[Param::Kp],
        (Form::Parallel, 1) | (_, 1) => &[Param::Ki],
        (_, 0) => &[Param::Kp],
        _ => &[Param::Kd],
    }
}

/// An integral time: above 0, `inf` for none.
fn read_integral_time(table: &Table<'_>) -> Option<super::table::Located<f64>> {
    let number = table.any_number("ti")?;
    if number.value > 0.0 {
        return Some(number);
    }
    let shown = table.log.slice(&number.span);
    table.out_of_range("ti", &number.span, shown, "above 0 s; `inf` or left out for no integral term");
    None
}
