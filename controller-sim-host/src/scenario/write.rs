//! Design files: a scenario with one controller, as a person would write it.

use super::{CompensatorSpec, ControllerSpec, Units};
use controller_core::{Action, ControllerConfig, IntegralRule, PidConfig};
use controller_design::model::TransferFunction;
use std::fmt::Write;

/// What a design file says: the plant, the loop's one controller, and a set-point and a load step to try it with.
///
/// [`text`](Self::text) writes it so that [`read`](super::read) gives back every number, bit for bit.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignFile {
    /// Lines of comment at its head, without the `#`.
    pub comments: Vec<String>,
    /// Heads the report.
    pub title: String,
    /// What the signals are measured in.
    pub units: Units,
    /// Sampling period \[s\].
    pub ts: f64,
    /// From reading `y` to acting `u` \[s\].
    pub latency: f64,
    /// The plant.
    pub plant: TransferFunction,
    /// Set-point and measurement at the start \[y\].
    pub initial_setpoint: f64,
    /// Load at the plant's input at the start \[u\].
    pub initial_load: f64,
    /// Step of the set-point at `t = 0` \[y\].
    pub setpoint_step: f64,
    /// Step of the load in the middle of the run \[u\].
    pub load_step: f64,
    /// Time for each of the two \[s\].
    pub window: f64,
    /// Standard deviation of the measurement's noise \[y\]; 0: none.
    pub noise: f64,
    /// Smallest step of the measurement \[y\]; 0: none.
    pub resolution: f64,
    /// The controller.
    pub controller: ControllerSpec,
}

impl DesignFile {
    /// The file.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        for line in &self.comments {
            push(&mut text, format_args!("# {line}"));
        }
        push(&mut text, format_args!("version = 1"));
        push(&mut text, format_args!("title = {}", quoted(&self.title)));
        push(&mut text, format_args!("ts = {}", number(self.ts)));
        push(&mut text, format_args!("duration = {}", number(2.0 * self.window)));
        push(&mut text, format_args!("latency = {}", number(self.latency)));
        if self.units != Units::default() {
            let Units { y, u } = &self.units;
            push(&mut text, format_args!("units = {{ y = {}, u = {} }}", quoted(y), quoted(u)));
        }
        push(&mut text, format_args!("\n[plant]\ntf = {}", quoted(&self.plant.to_string())));
        if self.initial_setpoint != 0.0 || self.initial_load != 0.0 {
            push(&mut text, format_args!("\n[initial]\nsetpoint = {}", number(self.initial_setpoint)));
            push(&mut text, format_args!("disturbance = {}", number(self.initial_load)));
        }
        if self.noise > 0.0 {
            push(&mut text, format_args!("\n[noise]\nstd = {}", number(self.noise)));
        }
        if self.resolution > 0.0 {
            push(&mut text, format_args!("\n[sensor]\nresolution = {}", number(self.resolution)));
        }
        let setpoint = number(self.initial_setpoint + self.setpoint_step);
        push(&mut text, format_args!("\n[[event]]\nat = 0.0\nlabel = \"set-point\"\nsetpoint = {setpoint}"));
        let load = number(self.initial_load + self.load_step);
        let at = number(self.window);
        push(&mut text, format_args!("\n[[event]]\nat = {at}\nlabel = \"load\"\ndisturbance = {load}"));
        text.push('\n');
        self.push_controller(&mut text);
        text
    }

    fn push_controller(&self, text: &mut String) {
        let spec = &self.controller;
        push(text, format_args!("[[controller]]\nname = {}", quoted(&spec.name)));
        match &spec.adrc {
            None => push(text, format_args!("pid = {}", pid(&spec.config.pid))),
            Some(a) => {
                let keys = [
                    ("b0", a.b0),
                    ("kp", a.kp),
                    ("kd", a.kd),
                    ("beta1", a.beta1),
                    ("beta2", a.beta2),
                    ("beta3", a.beta3),
                ];
                push(text, format_args!("adrc = {}", table(&keys)));
            }
        }
        match &spec.compensator {
            CompensatorSpec::None => {}
            CompensatorSpec::Estimator(e) => {
                let keys = [
                    ("gain", e.gain),
                    ("a1", e.a1),
                    ("a2", e.a2),
                    ("dead_time", e.dead_time),
                    ("kfd", e.kfd),
                    ("tfd", e.tfd),
                ];
                push(text, format_args!("estimator = {}", table(&keys)));
            }
            CompensatorSpec::Observer(o) => {
                let model = quoted(&self.plant.to_string());
                let order = o.order.map_or(String::new(), |order| format!(", order = {order}"));
                let alpha = number(o.alpha);
                push(text, format_args!("observer = {{ model = {model}, alpha = {alpha}{order} }}"));
            }
        }
        let (config, usual) = (&spec.config, ControllerConfig::default());
        let ranges = |config: &ControllerConfig| {
            [
                ("limits", config.limits.lo, config.limits.hi),
                ("setpoint", config.setpoint.lo, config.setpoint.hi),
                ("measurement", config.measurement_lo, config.measurement_hi),
                ("offset", config.offset_lo, config.offset_hi),
            ]
        };
        for (range, default) in ranges(config).into_iter().zip(ranges(&usual)) {
            let (key, lo, hi) = range;
            if range != default {
                push(text, format_args!("{key} = {}", table(&[("lo", lo), ("hi", hi)])));
            }
        }
    }
}

/// A line; writing to a text cannot fail.
fn push(text: &mut String, line: std::fmt::Arguments<'_>) {
    let _ = writeln!(text, "{line}");
}

/// A number that is read back bit for bit, always with a point or an exponent.
fn number(x: f64) -> String {
    format!("{x:?}")
}

fn table(keys: &[(&str, f64)]) -> String {
    let keys: Vec<String> = keys.iter().map(|(key, x)| format!("{key} = {}", number(*x))).collect();
    format!("{{ {} }}", keys.join(", "))
}

fn pid(pid: &PidConfig) -> String {
    let mut keys = vec![("kp", pid.kp), ("ki", pid.ki)];
    if pid.kd != 0.0 {
        keys.push(("kd", pid.kd));
    }
    if pid.tf != 0.0 {
        keys.push(("tf", pid.tf));
    }
    keys.extend([("b", pid.b), ("c", pid.c)]);
    let mut text = table(&keys);
    let mut more = |extra: &str| text.insert_str(text.len() - 2, extra);
    if pid.action == Action::Direct {
        more(", action = \"direct\"");
    }
    if pid.integral_rule == IntegralRule::Trapezoid {
        more(", integral_rule = \"trapezoid\"");
    }
    text
}

/// A TOML basic string.
fn quoted(text: &str) -> String {
    let escaped: String = text
        .chars()
        .flat_map(|c| match c {
            '"' | '\\' => vec!['\\', c],
            c if c.is_control() => format!("\\u{:04X}", u32::from(c)).chars().collect(),
            c => vec![c],
        })
        .collect();
    format!("\"{escaped}\"")
}
