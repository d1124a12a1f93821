//! A design for people: what was designed, what it promises, what to do with it.

use super::table::{format_number, rounded_numbers};
use crate::design_run::DesignRun;
use crate::scenario::show_short;
use controller_core::PidConfig;
use controller_design::areas::Areas;
use controller_design::design::{Design, Law, RuleModel};
use std::fmt::Write;

/// Share of the IAE from which that of the sampled loop and that of the continuous one are two.
const DIFFERENT: f64 = 0.005;

/// What was designed as text, at most 100 columns wide, and what its run showed where there was one.
#[must_use]
pub fn design_table(made: &Design, run: Option<&DesignRun>) -> String {
    let mut text = designed_table(made, run.map(|run| run.iae_load));
    let notes = run.map_or(Vec::new(), DesignRun::notes);
    if !notes.is_empty() {
        text.push_str("\nwarnings\n");
        for note in notes {
            line(&mut text, format_args!("  {note}"));
        }
    }
    text
}

/// The design alone; `iae_load` is of the sampled loop.
pub(super) fn designed_table(made: &Design, iae_load: Option<f64>) -> String {
    let mut text = format!("{} for {}\n", made.method.title(), rounded_numbers(&made.plant.to_string()));
    let latency = if made.latency > 0.0 { format!(", latency {} s", made.latency) } else { String::new() };
    line(&mut text, format_args!("{}, ts = {} s{latency}", made.method.source(), made.ts));
    text.push_str("\nparameters\n");
    for (name, value) in parameters(&made.law) {
        line(&mut text, format_args!("  {name:<22}{value}"));
    }
    if let Some(model) = &made.model {
        line(&mut text, format_args!("  {:<22}{}", "model of the rule", expression(model)));
    }
    if let Some(areas) = &made.areas {
        line(&mut text, format_args!("  {:<22}{}", "areas A0..A5", list(areas)));
    }
    margins(&mut text, made);
    predicted(&mut text, made, iae_load);
    if !made.warnings.is_empty() {
        text.push_str("\nnotes\n");
        for warning in &made.warnings {
            line(&mut text, format_args!("  {warning}"));
        }
    }
    text
}

/// A line; writing to a text cannot fail.
fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    let _ = writeln!(text, "{content}");
}

/// The model as an expression, with as many digits as a person reads.
fn expression(model: &RuleModel) -> String {
    let RuleModel { gain, integrators, a1, a2, dead_time } = *model;
    let mut text = show_short(gain);
    if dead_time > 0.0 {
        text.push_str(&format!("*exp(-{}*s)", show_short(dead_time)));
    }
    let mut bottom: Vec<String> = vec!["s".to_owned(); integrators];
    let term = |a: f64, s: &str| if a == 0.0 { String::new() } else { format!("+{}*{s}", show_short(a)) };
    if a1 != 0.0 || a2 != 0.0 {
        bottom.push(format!("(1{}{})", term(a1, "s"), term(a2, "s^2")));
    }
    match &*bottom {
        [] => text,
        [only] => format!("{text}/{only}"),
        several => format!("{text}/({})", several.join("*")),
    }
}

fn list(areas: &Areas) -> String {
    areas.values().map(format_number).join("  ")
}

/// Every parameter with its unit.
fn parameters(law: &Law) -> Vec<(&'static str, String)> {
    let mut rows = Vec::new();
    let mut row = |name: &'static str, value: f64, unit: &str| {
        rows.push((name, format!("{} {unit}", show_short(value)).trim_end().to_owned()));
    };
    let (pid, estimator, observer) = match law {
        Law::Pid { pid, estimator, observer } => (pid, estimator, observer),
        Law::Adrc(a) => {
            row("b0", a.b0, "y/(u s^2)");
            row("kp", a.kp, "1/s^2");
            row("kd", a.kd, "1/s");
            row("beta1", a.beta1, "1/s");
            row("beta2", a.beta2, "1/s^2");
            row("beta3", a.beta3, "1/s^3");
            return rows;
        }
    };
    let PidConfig { kp, ki, kd, tf, b, c, .. } = *pid;
    for (name, value, unit) in [
        ("kp", kp, "u/y"),
        ("ki", ki, "u/(y s)"),
        ("kd", kd, "u s/y"),
        ("tf", tf, "s"),
        ("b", b, ""),
        ("c", c, ""),
    ] {
        row(name, value, unit);
    }
    if let Some(e) = estimator {
        row("estimator: gain", e.gain, "y/u");
        row("estimator: a1", e.a1, "s");
        row("estimator: a2", e.a2, "s^2");
        row("estimator: dead_time", e.dead_time, "s");
        row("estimator: kfd", e.kfd, "");
        row("estimator: tfd", e.tfd, "s");
    }
    if let Some(o) = observer {
        row("observer: alpha", o.alpha, "s");
        if let Some(order) = o.order {
            rows.push(("observer: order", order.to_string()));
        }
    }
    rows
}

/// The margins of the continuous design beside those of the law that will run.
fn margins(text: &mut String, made: &Design) {
    let (one, two) = (&made.robustness, &made.sampled.margins);
    line(text, format_args!("\n{:<24}{:>12}{:>12}", "robustness", "continuous", "sampled"));
    let rows = [
        ("Ms", one.ms, two.ms, ""),
        ("Mt", one.mt, two.mt, ""),
        ("gain margin", one.gm, two.gm, ""),
        ("phase margin", one.pm_deg, two.pm_deg, "deg"),
        ("delay margin", one.delay_margin, two.delay_margin, "s"),
        ("", one.delay_margin / made.ts, two.delay_margin / made.ts, "samples"),
    ];
    for (name, one, two, unit) in rows {
        let (one, two) = (number(one), number(two));
        line(text, format_args!("{}", format!("  {name:<22}{one:>12}{two:>12} {unit}").trim_end()));
    }
    let noise = &made.sampled.noise;
    line(text, format_args!("\n{:<24}{:>12}{:>12}", "noise gain [u/y]", "formula", "sampled"));
    let rows = [
        ("PID, K_PIDn", made.noise.kpidn, made.noise.kpidn.map(|_| noise.kpidn)),
        ("controller at w_HF", None, made.noise.kpidn.is_none().then_some(noise.controller)),
        ("estimator, K_DEn", made.noise.kden, made.noise.kden.map(|_| noise.kden)),
        ("PI + observer, A_n", made.noise.an, made.noise.an.map(|_| noise.step)),
        ("white noise, std(u)/std(n)", None, Some(noise.white)),
    ];
    for (name, formula, sampled) in rows {
        if formula.is_some() || sampled.is_some() {
            let cell = |x: Option<f64>| x.map_or(String::new(), number);
            let (formula, sampled) = (cell(formula), cell(sampled));
            line(text, format_args!("{:<26}{formula:>10}{sampled:>12}", format!("  {name}")));
        }
    }
}

fn number(x: f64) -> String {
    if x == f64::INFINITY { "none".to_owned() } else { format_number(x) }
}

/// The integrals: the closed forms hold for the sampled loop, the least IAE of a rule for the continuous one.
fn predicted(text: &mut String, made: &Design, iae_load: Option<f64>) {
    let continuous = made.predicted.iae_load;
    let sampled = continuous.and(iae_load);
    let is_same = |(one, two): (f64, f64)| (one / two - 1.0).abs() <= DIFFERENT;
    let is_same = continuous.zip(sampled).is_some_and(is_same);
    let rows = [
        ("IE, unit set-point step", made.predicted.ie_setpoint),
        ("IE, unit load step", made.predicted.ie_load),
        ("IAE, unit load step", sampled),
        ("  of the continuous loop", continuous.filter(|_| !is_same)),
    ];
    if rows.iter().all(|(_, value)| value.is_none()) {
        return;
    }
    text.push_str("\npredicted\n");
    for (name, value) in rows {
        if let Some(value) = value {
            line(text, format_args!("  {name:<24}{:>10} y s", number(value)));
        }
    }
}
