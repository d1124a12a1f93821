//! `ctl.h`: every function, constant, structure and field, and the table of offsets in `tests/c/layout.c`.

use crate::{Spelled, code, constants, prototypes, prototypes_of, size_of_field, text, words};
use controller_capi::config::MAX_FACTORS;
use controller_capi::fault::choice;
use controller_capi::io::mode;
use controller_capi::*;
use controller_core::{Action, Mode, Param, Quality, Reason, Status};
use std::collections::BTreeMap;
use std::ffi::{c_char, c_void};

const HEADER: &str = include_str!("../../include/ctl.h");
const LAYOUT: &str = include_str!("../../../tests/c/layout.c");

macro_rules! variant {
    ($real:ty: $size:ident $without:ident $align:ident $delay:ident $check:ident $init:ident $settle:ident $set_mode:ident
     $step:ident $adopt:ident $advance:ident $read:ident $words:ident $save:ident $restore:ident) => {
        prototypes! {
            fn $size(delay: u32) -> usize;
            fn $without() -> usize;
            fn $align() -> usize;
            fn $delay(config: *const Config, samples: *mut u32) -> i32;
            fn $check(config: *const Config, faults: *mut Faults) -> i32;
            fn $init(state: *mut c_void, size: usize, config: *const Config, faults: *mut Faults) -> i32;
            fn $settle(state: *mut c_void, size: usize, r: $real, y: $real, u: $real) -> i32;
            fn $set_mode(state: *mut c_void, size: usize, mode: i32) -> i32;
            fn $step(state: *mut c_void, size: usize, input: *const Input<$real>, output: *mut Output<$real>) -> i32;
            fn $adopt(state: *mut c_void, size: usize, config: *const Config, faults: *mut Faults) -> i32;
            fn $advance(state: *mut c_void, size: usize, samples: u32) -> i32;
            fn $read(state: *const c_void, size: usize, output: *mut Output<$real>) -> i32;
            fn $words(state: *mut c_void, size: usize, count: *mut usize) -> i32;
            fn $save(state: *mut c_void, size: usize, words: *mut u32, capacity: usize, written: *mut usize) -> i32;
            fn $restore(state: *mut c_void, size: usize, words: *const u32, count: usize) -> i32;
        }
    };
}

#[test]
fn every_function() {
    let mut ours = prototypes! {
        fn ctl_abi_version() -> u32;
        fn ctl_config_default(config: *mut Config, struct_size: usize) -> i32;
        fn ctl_error_text(code: i32) -> *const c_char;
        fn ctl_param_name(param: i32) -> *const c_char;
        fn ctl_reason_text(reason: i32) -> *const c_char;
    };
    ours.extend(variant! { f32:
        ctl_f32_size ctl_f32_size_without_compensator ctl_f32_align ctl_f32_delay_samples ctl_f32_check ctl_f32_init
        ctl_f32_settle ctl_f32_set_mode ctl_f32_step ctl_f32_adopt ctl_f32_advance ctl_f32_read ctl_f32_snapshot_words
        ctl_f32_save ctl_f32_restore
    });
    ours.extend(variant! { f64:
        ctl_f64_size ctl_f64_size_without_compensator ctl_f64_align ctl_f64_delay_samples ctl_f64_check ctl_f64_init
        ctl_f64_settle ctl_f64_set_mode ctl_f64_step ctl_f64_adopt ctl_f64_advance ctl_f64_read ctl_f64_snapshot_words
        ctl_f64_save ctl_f64_restore
    });
    assert_eq!(prototypes_of(HEADER), ours);
    // Every exported function is one of these: `exports.rs` has no other.
    let exports = include_str!("../../src/exports.rs");
    assert_eq!(exports.matches("no_mangle").count(), 5 + 15);
    // Runtimes give names with these endings a meaning of their own.
    assert!(ours.iter().all(|p| !p.contains("_setup(") && !p.contains("_loop(")));
}

/// `AlarmHiHi` or `alarm hi hi` as `ALARM_HI_HI`.
fn shouted(name: &str) -> String {
    let mut out = String::new();
    for (at, c) in name.chars().enumerate() {
        if c.is_ascii_uppercase() && at > 0 {
            out.push('_');
        }
        out.push(if c == ' ' || c == '-' { '_' } else { c.to_ascii_uppercase() });
    }
    out
}

#[test]
fn every_constant() {
    use controller_capi::Error as E;
    use controller_core::Param as P;
    use controller_core::Reason as R;
    let mut ours: Vec<(String, i64)> = Vec::new();
    let mut add = |name: &str, value: i64| ours.push((format!("CTL_{name}"), value));
    add("ABI_VERSION", ABI_VERSION.into());
    add("OK", 0);
    let errors = [
        E::Null,
        E::Size,
        E::Align,
        E::NotInitialised,
        E::Version,
        E::StructSize,
        E::Config,
        E::Argument,
        E::Buffer,
        E::SnapshotVersion,
        E::SnapshotShape,
        E::SnapshotChecksum,
        E::SnapshotInvalid,
        E::Damaged,
    ];
    assert!(
        text(ctl_error_text(errors.len() as i32 + 1)).starts_with("unknown"),
        "an error is not in the list"
    );
    for error in errors {
        add(&format!("ERROR_{}", shouted(&format!("{error:?}"))), error as i64);
    }
    add("MODE_AS_SET", mode::AS_SET.into());
    for m in Mode::REQUESTS.into_iter().chain([Mode::Fallback]) {
        add(&format!("MODE_{}", shouted(m.name())), mode::number(m).into());
        assert_eq!(mode::requested(mode::number(m)), Some(m).filter(|&m| m != Mode::Fallback));
    }
    for quality in [Quality::Good, Quality::Uncertain, Quality::Bad] {
        add(&format!("QUALITY_{}", shouted(&format!("{quality:?}"))), quality as i64);
    }
    for (bit, name) in Status::NAMES {
        let name = if *bit == Status::REJECTED { "rejected" } else { name };
        let name = name.replace("set-point", "setpoint");
        add(&format!("STATUS_{}", shouted(&name)), bit.bits().into());
    }
    for action in [Action::Reverse, Action::Direct] {
        add(&format!("ACTION_{}", shouted(&format!("{action:?}"))), action as i64);
    }
    for (at, name) in ["BACKWARD", "TRAPEZOID"].iter().enumerate() {
        add(&format!("INTEGRAL_{name}"), at as i64);
    }
    for (at, name) in ["BACK_CALCULATION", "CONDITIONAL", "NONE"].iter().enumerate() {
        add(&format!("ANTI_WINDUP_{name}"), at as i64);
    }
    for (at, name) in ["HOLD", "SUBSTITUTE", "RAMP"].iter().enumerate() {
        add(&format!("FALLBACK_{name}"), at as i64);
    }
    for (at, name) in ["AUTOMATIC", "ACKNOWLEDGED"].iter().enumerate() {
        add(&format!("RETURN_{name}"), at as i64);
    }
    for (at, name) in ["NONE", "ESTIMATOR", "OBSERVER"].iter().enumerate() {
        add(&format!("COMPENSATOR_{name}"), at as i64);
    }
    let params = [
        P::Ts,
        P::Kp,
        P::Ki,
        P::Kd,
        P::Tf,
        P::B,
        P::C,
        P::Tt,
        P::OutputLo,
        P::OutputHi,
        P::OutputRateUp,
        P::OutputRateDown,
        P::SetpointLo,
        P::SetpointHi,
        P::SetpointRateUp,
        P::SetpointRateDown,
        P::Deadband,
        P::MeasurementLo,
        P::MeasurementHi,
        P::OffsetLo,
        P::OffsetHi,
        P::FallbackOutput,
        P::FallbackRate,
        P::OffOutput,
        P::InitialOutput,
        P::AlarmHiHi,
        P::AlarmHi,
        P::AlarmLo,
        P::AlarmLoLo,
        P::AlarmDeviation,
        P::AlarmHysteresis,
        P::ModelGain,
        P::ModelPoles,
        P::ModelZeros,
        P::ModelOrder,
        P::DeadTime,
        P::Latency,
        P::Kfd,
        P::Tfd,
        P::Alpha,
        P::FilterOrder,
        P::Capacity,
        P::Overflow,
    ];
    for param in params {
        add(&format!("PARAM_{}", shouted(&format!("{param:?}"))), param as i64);
    }
    let choices = [
        ("ACTION", choice::ACTION),
        ("INTEGRAL_RULE", choice::INTEGRAL_RULE),
        ("ANTI_WINDUP", choice::ANTI_WINDUP),
        ("FALLBACK_ACTION", choice::FALLBACK_ACTION),
        ("FALLBACK_RETURN", choice::FALLBACK_RETURN),
        ("HOLD_SAMPLES", choice::HOLD_SAMPLES),
        ("COMPENSATOR", choice::COMPENSATOR),
        ("MODEL_INTEGRATORS", choice::MODEL_INTEGRATORS),
        ("MODEL_POLE_COUNT", choice::MODEL_POLE_COUNT),
        ("MODEL_ZERO_COUNT", choice::MODEL_ZERO_COUNT),
    ];
    for (name, number) in choices {
        add(&format!("PARAM_{name}"), number.into());
    }
    let reasons = [
        R::NotFinite,
        R::OutOfRange,
        R::Inverted,
        R::SignMismatch,
        R::NeedsFilter,
        R::Unstable,
        R::TooLarge,
        R::NotProper,
        R::Mismatch,
    ];
    for reason in reasons {
        add(&format!("REASON_{}", shouted(&format!("{reason:?}"))), reason as i64);
    }
    add("MAX_FACTORS", MAX_FACTORS as i64);
    add("MAX_FAULTS", MAX_FAULTS as i64);
    add("MAX_DELAY", MAX_DELAY.into());
    add("F32_ALIGN", ctl_f32_align() as i64);
    add("F64_ALIGN", ctl_f64_align() as i64);
    add("F32_SIZE_WITHOUT_COMPENSATOR", f32::SIZE_WITHOUT_COMPENSATOR as i64);
    add("F64_SIZE_WITHOUT_COMPENSATOR", f64::SIZE_WITHOUT_COMPENSATOR as i64);
    let count = ours.len();
    let ours: BTreeMap<String, i64> = ours.into_iter().collect();
    assert_eq!(ours.len(), count, "no name twice");
    assert_eq!(constants(HEADER), ours);
}

/// The table of one structure, as `layout.c` has it, and the names of its fields.
macro_rules! layout {
    ($c:literal, $rust:ty; $($field:ident)*) => {{
        let mut lines = format!("ALL({}, {}, {});\n", $c, size_of::<$rust>(), align_of::<$rust>());
        let mut at = 0;
        $(
            let offset = std::mem::offset_of!($rust, $field);
            let size = size_of_field(|x: &$rust| &x.$field);
            assert_eq!(offset, at, "no gap before {}", stringify!($field));
            at += size;
            lines += &format!("AT({}, {}, {offset}, {size});\n", $c, stringify!($field));
        )*
        assert_eq!(at, size_of::<$rust>(), "no field of {} is missing", $c);
        (lines, vec![$(stringify!($field)),*])
    }};
}

macro_rules! input {
    ($c:literal, $real:ty) => {
        layout!($c, Input<$real>;
            r r_remote y u_applied manual track offset mode quality has_u_applied has_manual compensator_off inhibit_up
            inhibit_down acknowledge)
    };
}

macro_rules! output {
    ($c:literal, $real:ty) => {
        layout!($c, Output<$real>; u v i pd u_f d_hat r mode status blocked_up blocked_down)
    };
}

#[test]
fn every_field() {
    let config = layout!("ctl_config", Config;
        struct_size action integral_rule anti_windup setpoint_track fallback_action fallback_return hold_samples compensator
        filter_order model_integrators model_pole_count model_zero_count reserved ts kp ki kd tf b c output_lo output_hi
        output_rate_up output_rate_down setpoint_lo setpoint_hi setpoint_rate_up setpoint_rate_down tt deadband measurement_lo
        measurement_hi offset_lo offset_hi fallback_output fallback_rate alarm_hi_hi alarm_hi alarm_lo alarm_lo_lo
        alarm_deviation alarm_hysteresis off_output initial_output latency kfd tfd alpha model_gain model_dead_time
        model_pole_a1 model_pole_a2 model_zero_a1 model_zero_a2);
    let fault = layout!("ctl_fault", Fault; param reason value min max);
    let faults = layout!("ctl_faults", Faults; count total list);
    let inputs = [input!("ctl_f32_input", f32), input!("ctl_f64_input", f64)];
    let outputs = [output!("ctl_f32_output", f32), output!("ctl_f64_output", f64)];

    let lines: Vec<&str> = [&config, &fault, &faults]
        .into_iter()
        .chain(&inputs)
        .chain(&outputs)
        .map(|(l, _)| l.as_str())
        .collect();
    let expected = lines.join("\n");
    let table = LAYOUT.find("ALL(ctl_config").map(|at| &LAYOUT[at..]).unwrap_or_default();
    assert_eq!(table.trim_end(), expected.trim_end(), "tests/c/layout.c must end with this:\n{expected}");

    // Every field of the header is in the table, in this order; a structure is one flat list of them.
    let code = code(HEADER);
    let body = |after: &str, until: &str| {
        let (_, rest) = code.split_once(after).expect(after);
        let (body, _) = rest.split_once(until).expect(until);
        let names = body.split(';').filter_map(|field| {
            let name = field.trim().rsplit(' ').next()?.split('[').next()?;
            (!name.is_empty()).then(|| name.to_string())
        });
        names.collect::<Vec<_>>()
    };
    assert_eq!(body("typedef struct ctl_config {", "}"), config.1);
    assert_eq!(body("typedef struct ctl_fault {", "}"), fault.1);
    assert_eq!(body("typedef struct ctl_faults {", "}"), faults.1);
    assert_eq!(body("#define CTL_INPUT_FIELDS(real)", "\n"), inputs[0].1);
    assert_eq!(body("#define CTL_OUTPUT_FIELDS(real)", "\n"), outputs[0].1);
}

#[test]
fn every_text() {
    for (name, number) in constants(HEADER) {
        let number = i32::try_from(number).unwrap();
        if name.starts_with("CTL_ERROR_") {
            assert!(!text(ctl_error_text(number)).starts_with("unknown"), "{name}");
        } else if let Some(field) = name.strip_prefix("CTL_PARAM_") {
            let text = text(ctl_param_name(number));
            let several = ["MODEL_POLES", "MODEL_ZEROS", "MODEL_ORDER", "DEAD_TIME", "CAPACITY", "OVERFLOW"];
            assert!(text == field.to_lowercase() || several.contains(&field), "{name}: {text}");
            assert!(!text.starts_with("unknown"), "{name}");
        } else if name.starts_with("CTL_REASON_") {
            assert!(!text(ctl_reason_text(number)).starts_with("unknown"), "{name}");
        }
    }
    let core =
        [Reason::NotFinite, Reason::OutOfRange, Reason::Inverted, Reason::NeedsFilter, Reason::Unstable];
    for reason in core {
        assert_eq!(text(ctl_reason_text(reason as i32)), reason.text());
    }
    assert_eq!(text(ctl_param_name(Param::Kp as i32)), "kp");
}

#[test]
fn the_macros_of_sizes_are_the_functions() {
    // The C tests evaluate the macros themselves; here the numbers in them.
    let line = |name: &str| words(code(HEADER).lines().find(|l| l.contains(name)).expect(name));
    let base = |name: &str| -> usize {
        let line = line(name);
        let (_, rest) = line.split_once("(delay) (").expect(&line);
        rest.split(' ').next().and_then(|n| n.parse().ok()).expect(&line)
    };
    assert_eq!(base("#define CTL_F32_SIZE(delay)"), f32::SIZE_WITH_COMPENSATOR);
    assert_eq!(base("#define CTL_F64_SIZE(delay)"), f64::SIZE_WITH_COMPENSATOR);
}
