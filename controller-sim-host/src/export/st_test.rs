//! A program in Structured Text that replays a recorded trace through the exported block.

use super::block::{Initial, Type};
use super::{Export, OpenRange, head, st};
use crate::scenario::ControllerSpec;
use crate::simulate::{AnyLaw, Precision};
use controller_core::{ControllerInput, ControllerOutput, Mode, PidConfig, Quality, Real, Status};
use std::fmt::Write;

/// Samples of the trace.
const SAMPLES: u32 = 220;

/// Inputs of the block that tune it.
const TUNING: [&str; 4] = ["KP", "TN", "TV", "TF"];

/// The program.
pub(super) fn text(export: &Export<'_>, origin: &str) -> String {
    let columns = match export.precision {
        Precision::F32 => record::<f32>(export),
        Precision::F64 => record::<f64>(export),
    };
    let block = head::name(export);
    let name = format!("TEST_{}", block.strip_prefix("FB_").unwrap_or(&block));
    let mut out = format!("PROGRAM {name}\n");
    let last = SAMPLES - 1;
    let mut head = vec![
        format!("Replays {SAMPLES} samples through {block}, which is exported by controller-sim export --format st"),
        format!("from the same loop of {}, and compares every output with that of the reference step.", head::plain(origin)),
        "One sample in each call; the task's period does not matter.".to_owned(),
        "DONE and PASSED: every output is the same in every sample. FAULTS counts samples that differ, FIRST_FAULT is the first.".to_owned(),
    ];
    head.extend(export.open_ranges().iter().flat_map(OpenRange::warning));
    for line in head {
        let _ = writeln!(out, "(* {line} *)");
    }
    let _ = write!(
        out,
        "VAR CONSTANT\n    LAST_SAMPLE : DINT := {last};\nEND_VAR\nVAR\n    LAW : {block};\n    READY : BOOL; (* the trace is there *)\n    SAMPLE : DINT := 0; (* next one *)\n    \
         DONE : BOOL; (* all samples are through *)\n    PASSED : BOOL; (* and none differs *)\n    SAME : BOOL;\n    \
         FAULTS : DINT := 0;\n    FIRST_FAULT : DINT := -1;\n"
    );
    for column in &columns {
        let kind = st::keyword(column.kind, export.precision);
        let _ = writeln!(out, "    {} : ARRAY [0..{last}] OF {kind};", column.name);
    }
    // Assignments, because not every front end takes initial values of arrays.
    out += "END_VAR\n\nIF NOT READY THEN\n    READY := TRUE;\n";
    for column in &columns {
        for (k, cell) in column.cells.iter().enumerate().filter(|(_, cell)| cell.as_str() != column.zero()) {
            let _ = writeln!(out, "    {}[{k}] := {cell};", column.name);
        }
    }
    out += "END_IF;\nIF SAMPLE <= LAST_SAMPLE THEN\n    LAW(\n";
    let calls: Vec<String> = columns
        .iter()
        .filter_map(|column| column.name.strip_prefix("IN_"))
        .map(|input| format!("        {input} := IN_{input}[SAMPLE]"))
        .collect();
    out += &calls.join(",\n");
    out += "\n    );\n    SAME := TRUE;\n";
    for name in columns.iter().filter_map(|column| column.name.strip_prefix("OUT_")) {
        let _ = writeln!(
            out,
            "    IF NOT (LAW.{name} = OUT_{name}[SAMPLE]) THEN\n        SAME := FALSE;\n    END_IF;"
        );
    }
    out += "    IF NOT SAME THEN\n        IF FAULTS = 0 THEN\n            FIRST_FAULT := SAMPLE;\n        END_IF;\n        \
            FAULTS := FAULTS + 1;\n    END_IF;\n    SAMPLE := SAMPLE + 1;\nEND_IF;\nDONE := SAMPLE > LAST_SAMPLE;\n\
            PASSED := DONE AND (FAULTS = 0);\nEND_PROGRAM\n";
    out
}

/// What a loop was given and gave.
struct Sample<T> {
    input: ControllerInput<T>,
    /// `KP, TN, TV, TF`.
    tuning: [f64; 4],
    output: ControllerOutput<T>,
    status: u32,
    /// The last finite measurement.
    pv: T,
}

/// A signal of the trace: a word of the language for every sample.
struct Column {
    name: String,
    kind: Type,
    cells: Vec<String>,
}

impl Column {
    /// What an array holds at the start.
    fn zero(&self) -> &'static str {
        match self.kind {
            Type::Flag => "FALSE",
            Type::Count | Type::Word => "0",
            Type::Real | Type::Long => "0.0",
        }
    }
}

/// The law of the trace with what it was tuned to.
struct Tuned<T: Real> {
    law: AnyLaw<T>,
    spec: ControllerSpec,
    taken: [f64; 4],
}

impl<T: Real> Tuned<T> {
    /// Puts other values in force as the block does; whether it refuses them.
    fn take(&mut self, tuning: [f64; 4]) -> bool {
        let [kp, tn, tv, tf] = tuning;
        if tuning.iter().any(|x| *x < 0.0) {
            return true;
        }
        if tuning == self.taken {
            return false;
        }
        let old = self.spec.config.pid;
        let direction = if old.kp < 0.0 { -1.0 } else { 1.0 };
        let new = PidConfig::from_standard(direction * kp, if tn > 0.0 { tn } else { f64::INFINITY }, tv, tf);
        let mut spec = self.spec.clone();
        spec.config.pid = PidConfig { kp: new.kp, ki: new.ki, kd: new.kd, tf: new.tf, ..old };
        let refused = self.law.adopt(&spec).is_err();
        if !refused {
            self.taken = tuning;
        }
        refused
    }
}

/// The values of `KP, TN, TV, TF` in a sample of the trace, `start` being those of the design.
fn tuning<T: Real>(k: u32, start: [f64; 4], ts: f64) -> [f64; 4] {
    let round = |x: f64| T::from_f64(x).to_f64();
    let [kp, tn, tv, tf] = start;
    match k {
        170..=179 => [round(1.2 * kp), tn, tv, tf],
        180..=187 => [round(1.2 * kp), round(if tn == 0.0 { 40.0 * ts } else { 1.5 * tn }), tv, tf],
        188..=195 => [kp, 0.0, tv, tf],
        196..=199 => [kp, tn, -1.0, tf],
        _ => start,
    }
}

/// Inputs and outputs of a loop around a made-up plant: start without a measurement, set-points, bad samples, all modes,
/// read-back, inhibition, the compensator out and in, other parameters, saturation if the range is near.
fn record<T: Real>(export: &Export<'_>) -> Vec<Column> {
    let (scenario, spec) = (export.scenario, export.spec);
    // It was built when the export was checked.
    let law = AnyLaw::<T>::new(spec, scenario.ts, scenario.latency, export.capacity);
    let (Ok(law), Ok(block)) = (law, export.block("")) else { return Vec::new() };
    let begins = |name: &str| match block.variable(name).map(|v| &v.initial) {
        Some(Initial::Number(value)) => *value,
        _ => 0.0,
    };
    let start = TUNING.map(begins);
    let tunable = block.variable("KP").is_some();
    let mut tuned = Tuned { law, spec: spec.clone(), taken: start };
    let config = spec.config.rounded::<T>();
    let size = |x: f64| if x == 0.0 { 1.0 } else { x };
    let [kp, ki, _] = config.pid.signed_gains();
    let gain = 0.5 / size(if kp == 0.0 { ki } else { kp });
    let (lo, hi) = (config.setpoint.lo, config.setpoint.hi);
    let base = 0.0_f64.clamp(lo, hi);
    let reach = 1.0_f64.min((hi - lo) / 4.0);
    let (mut y, mut rest) = (base.clamp(config.measurement_lo, config.measurement_hi), None);
    let mut pv = T::ZERO;
    let mut samples: Vec<Sample<T>> = Vec::new();
    for k in 0..SAMPLES {
        let uneven = f64::from(k.wrapping_mul(0x9E37_79B9) >> 20) / 4096.0 - 0.5;
        let aim = match k {
            0..=9 => base,
            10..=49 => base + reach,
            50..=79 => base - 0.37 * reach,
            80..=119 => hi + 1.0,
            _ if k / 8 % 2 == 0 => base + 0.4 * reach,
            _ => base - 0.3 * reach,
        };
        let between =
            |x: f64| T::from_f64((1.0 - x) * config.limits.lo.max(-2.0) + x * config.limits.hi.min(2.0));
        let input = ControllerInput {
            r: T::from_f64(aim),
            r_remote: T::from_f64(base + 0.21 * reach),
            y: T::from_f64(if k == 40 {
                2.0 * config.measurement_hi + 1.0
            } else {
                y + 1e-3 * reach * uneven
            }),
            quality: match k {
                0..=2 | 60..=66 => Quality::Bad,
                20..=22 => Quality::Uncertain,
                _ => Quality::Good,
            },
            mode: match k {
                70..=79 => Mode::Manual,
                90..=99 => Mode::Cascade,
                105..=109 => Mode::Hold,
                120..=127 => Mode::Track,
                132..=135 => Mode::Off,
                _ => Mode::Auto,
            },
            manual: Some(between(0.7)),
            track: between(0.6),
            offset: T::from_f64(if k > 30 { 0.01 } else { 0.0 }),
            u_applied: (138..=145).contains(&k).then(|| between(0.55)),
            compensate: !(148..=155).contains(&k),
            inhibit_up: (100..103).contains(&k),
            inhibit_down: (158..=169).contains(&k),
            acknowledge: k % 8 == 7,
        };
        let tuning = if tunable { tuning::<T>(k, start, export.ts()) } else { start };
        let refused = tunable && tuned.take(tuning);
        let output = tuned.law.step(&input);
        let u = output.u.to_f64();
        let u_0 = *rest.get_or_insert(u);
        y += 0.2 * (gain * (u - u_0) - (y - base));
        y = y.clamp(config.measurement_lo, config.measurement_hi);
        let status = output.status.bits() | u32::from(refused) << 26;
        if input.y.is_finite_number() {
            pv = input.y;
        }
        samples.push(Sample { input, tuning, output, status, pv });
    }
    columns(&samples, tunable)
}

/// The number of a mode at the output `MODE`.
fn mode_code(mode: Mode) -> u8 {
    match mode {
        Mode::Off => 1,
        Mode::Manual => 2,
        Mode::Auto => 3,
        Mode::Cascade => 4,
        Mode::Track => 5,
        Mode::Hold => 6,
        Mode::Fallback => 7,
    }
}

fn columns<T: Real>(samples: &[Sample<T>], tunable: bool) -> Vec<Column> {
    let column = |name: &str, kind: Type, of: &dyn Fn(&Sample<T>) -> String| Column {
        name: name.to_owned(),
        kind,
        cells: samples.iter().map(of).collect(),
    };
    let number = |name: &str, of: &dyn Fn(&Sample<T>) -> T| {
        column(name, Type::Real, &|sample| st::decimal(of(sample).to_f64()))
    };
    let flag = |name: &str, of: &dyn Fn(&ControllerInput<T>) -> bool| {
        column(name, Type::Flag, &|sample| st::truth(of(&sample.input)).to_owned())
    };
    let shown = |name: &str, of: &dyn Fn(&ControllerOutput<T>) -> bool| {
        column(name, Type::Flag, &|sample| st::truth(of(&sample.output)).to_owned())
    };
    let quality = |sample: &Sample<T>| match sample.input.quality {
        Quality::Good => "2".to_owned(),
        Quality::Uncertain => "1".to_owned(),
        Quality::Bad => "0".to_owned(),
    };
    let mut columns = vec![
        number("IN_SP", &|s| s.input.r),
        number("IN_SP_REMOTE", &|s| s.input.r_remote),
        number("IN_PV", &|s| s.input.y),
        number("IN_OP_MAN", &|s| s.input.manual.unwrap_or_default()),
        number("IN_OP_READBACK", &|s| s.input.u_applied.unwrap_or_default()),
        number("IN_TRK_VALUE", &|s| s.input.track),
        number("IN_FF", &|s| s.input.offset),
        column("IN_PV_QUALITY", Type::Count, &quality),
        flag("IN_OFF", &|i| i.mode == Mode::Off),
        flag("IN_TRK", &|i| i.mode == Mode::Track),
        flag("IN_MAN", &|i| i.mode == Mode::Manual),
        flag("IN_HOLD", &|i| i.mode == Mode::Hold),
        flag("IN_CAS", &|i| i.mode == Mode::Cascade),
        // The others come before it.
        flag("IN_AUTO", &|_| true),
        flag("IN_RB_USE", &|i| i.u_applied.is_some()),
        flag("IN_INHIBIT_UP", &|i| i.inhibit_up),
        flag("IN_INHIBIT_DN", &|i| i.inhibit_down),
        flag("IN_ACK", &|i| i.acknowledge),
        flag("IN_COMPENSATE", &|i| i.compensate),
    ];
    if tunable {
        for (at, name) in TUNING.iter().enumerate() {
            let value = |s: &Sample<T>| s.tuning.get(at).copied().unwrap_or_default();
            columns.push(column(&format!("IN_{name}"), Type::Real, &|s| st::decimal(value(s))));
        }
    }
    columns.extend([
        number("OUT_OP", &|s| s.output.u),
        number("OUT_OP_UNLIM", &|s| s.output.v),
        number("OUT_PV_ENG", &|s| s.pv),
        number("OUT_SP_WORKING", &|s| s.output.r),
        number("OUT_DEV", &|s| s.output.r - s.pv),
        number("OUT_I_TERM", &|s| s.output.i),
        number("OUT_PD_TERM", &|s| s.output.pd),
        number("OUT_UF", &|s| s.output.u_f),
        number("OUT_D_HAT", &|s| s.output.d_hat),
        number("OUT_BKCAL_OUT", &|s| s.output.r),
        column("OUT_MODE", Type::Count, &|s| mode_code(s.output.mode).to_string()),
        column("OUT_STATUS", Type::Word, &|s| s.status.to_string()),
        shown("OUT_IN_AUTO", &|o| matches!(o.mode, Mode::Auto | Mode::Cascade)),
        shown("OUT_IN_CAS", &|o| o.mode == Mode::Cascade),
        shown("OUT_BLOCKED_UP", &|o| o.blocked_up),
        shown("OUT_BLOCKED_DN", &|o| o.blocked_down),
        shown("OUT_HH_ALM", &|o| o.status.has(Status::ALARM_HI_HI)),
        shown("OUT_H_ALM", &|o| o.status.has(Status::ALARM_HI)),
        shown("OUT_L_ALM", &|o| o.status.has(Status::ALARM_LO)),
        shown("OUT_LL_ALM", &|o| o.status.has(Status::ALARM_LO_LO)),
        shown("OUT_DEV_ALM", &|o| o.status.has(Status::ALARM_DEVIATION)),
    ]);
    columns
}
