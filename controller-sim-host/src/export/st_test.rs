//! A program in Structured Text that replays a recorded trace through the exported block.

use super::block::Type;
use super::{Export, head, st};
use crate::simulate::{AnyLaw, Precision};
use controller_core::{ControllerInput, ControllerOutput, Mode, Quality, Real};
use std::fmt::Write;

/// Samples of the trace.
const SAMPLES: u32 = 120;

/// The program.
pub(super) fn text(export: &Export<'_>, origin: &str) -> String {
    let columns = match export.precision {
        Precision::F32 => record::<f32>(export),
        Precision::F64 => record::<f64>(export),
    };
    let block = head::name(export.name());
    let name = format!("TEST_{}", block.trim_start_matches("FB_"));
    let mut out = format!("PROGRAM {name}\n");
    let last = SAMPLES - 1;
    for line in [
        format!("Replays {SAMPLES} samples through {block}, which is exported by controller-sim export --format st"),
        format!("from the same loop of {}, and compares output and status with those of the reference step.", head::plain(origin)),
        "One sample in each call; the task's period does not matter.".to_owned(),
        "DONE and PASSED: every value is the same. FAULTS counts samples that differ, FIRST_FAULT is the first.".to_owned(),
    ] {
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
    let inputs = ["SP", "SP_CAS", "PV", "PV_QUALITY", "MODE", "MAN", "FF", "INHIBIT_UP", "ACK"];
    let calls: Vec<String> =
        inputs.iter().map(|name| format!("        {name} := IN_{name}[SAMPLE]")).collect();
    out += &calls.join(",\n");
    out += "\n    );\n    SAME := TRUE;\n";
    for name in ["OP", "OP_UNLIM", "SP_WORK", "STATUS"] {
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
type Sample<T> = (ControllerInput<T>, ControllerOutput<T>);

/// A signal of the trace: a word of the language for every sample.
struct Column {
    name: &'static str,
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

/// Inputs and outputs of a loop around a made-up plant: start without a measurement, set-points, bad samples, modes,
/// saturation if the range is near.
fn record<T: Real>(export: &Export<'_>) -> Vec<Column> {
    let (scenario, spec) = (export.scenario, export.spec);
    // It was built when the export was checked.
    let law = AnyLaw::<T>::new(spec, scenario.ts, scenario.latency, export.capacity);
    let Ok(mut law) = law else { return Vec::new() };
    let config = spec.config.rounded::<T>();
    let size = |x: f64| if x == 0.0 { 1.0 } else { x };
    let [kp, ki, _] = config.pid.signed_gains();
    let gain = 0.5 / size(if kp == 0.0 { ki } else { kp });
    let (lo, hi) = (config.setpoint.lo, config.setpoint.hi);
    let base = 0.0_f64.clamp(lo, hi);
    let reach = 1.0_f64.min((hi - lo) / 4.0);
    let (mut y, mut rest) = (base.clamp(config.measurement_lo, config.measurement_hi), None);
    let mut samples: Vec<Sample<T>> = Vec::new();
    for k in 0..SAMPLES {
        let uneven = f64::from(k.wrapping_mul(0x9E37_79B9) >> 20) / 4096.0 - 0.5;
        let aim = match k {
            0..=9 => base,
            10..=49 => base + reach,
            50..=79 => base - 0.37 * reach,
            _ => hi + 1.0,
        };
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
                _ => Mode::Auto,
            },
            manual: Some(T::from_f64(0.3 * config.limits.lo.max(-2.0) + 0.7 * config.limits.hi.min(2.0))),
            offset: T::from_f64(if k > 30 { 0.01 } else { 0.0 }),
            inhibit_up: (100..103).contains(&k),
            acknowledge: k % 8 == 7,
            ..ControllerInput::default()
        };
        let out = law.step(&input);
        let u = out.u.to_f64();
        let u_0 = *rest.get_or_insert(u);
        y += 0.2 * (gain * (u - u_0) - (y - base));
        y = y.clamp(config.measurement_lo, config.measurement_hi);
        samples.push((input, out));
    }
    let numbers = |name, of: &dyn Fn(&Sample<T>) -> T| Column {
        name,
        kind: Type::Real,
        cells: samples.iter().map(|sample| st::decimal(of(sample).to_f64())).collect(),
    };
    let counts = |name, of: &dyn Fn(&ControllerInput<T>) -> u8| Column {
        name,
        kind: Type::Count,
        cells: samples.iter().map(|(i, _)| of(i).to_string()).collect(),
    };
    let flags = |name, of: &dyn Fn(&ControllerInput<T>) -> bool| Column {
        name,
        kind: Type::Flag,
        cells: samples.iter().map(|(i, _)| st::truth(of(i)).to_owned()).collect(),
    };
    let status = samples.iter().map(|(_, o)| o.status.bits().to_string()).collect();
    vec![
        numbers("IN_SP", &|(i, _)| i.r),
        numbers("IN_SP_CAS", &|(i, _)| i.r_remote),
        numbers("IN_PV", &|(i, _)| i.y),
        counts("IN_PV_QUALITY", &|i| i.quality as u8),
        counts("IN_MODE", &|i| i.mode as u8),
        numbers("IN_MAN", &|(i, _)| i.manual.unwrap_or_default()),
        numbers("IN_FF", &|(i, _)| i.offset),
        flags("IN_INHIBIT_UP", &|i| i.inhibit_up),
        flags("IN_ACK", &|i| i.acknowledge),
        numbers("OUT_OP", &|(_, o)| o.u),
        numbers("OUT_OP_UNLIM", &|(_, o)| o.v),
        numbers("OUT_SP_WORK", &|(_, o)| o.r),
        Column { name: "OUT_STATUS", kind: Type::Word, cells: status },
    ]
}
