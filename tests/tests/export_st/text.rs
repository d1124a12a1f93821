//! What the text says: the committed block, numbers, names, the bits of loops that can be computed by hand.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, scenario};
use crate::print_c::program;
use controller_core::{ControllerConfig, LimitConfig, PidConfig};
use controller_sim_host::export::block::{Block, Role};
use controller_sim_host::export::{Export, Format, Refused};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::path::Path;

fn of(name: &str) -> (Scenario, ControllerSpec) {
    let scenario = scenario(all());
    let spec =
        scenario.controllers.iter().find(|spec| spec.name == name).expect("a loop of this name").clone();
    (scenario, spec)
}

fn text(name: &str, precision: Precision, format: Format) -> String {
    let (scenario, spec) = of(name);
    Export::new(&scenario, &spec, precision, None)
        .and_then(|export| export.text(format, "loops.toml"))
        .unwrap_or_else(|why| panic!("{name}: {why:?}"))
}

#[test]
fn the_committed_block_is_what_is_exported() {
    for (name, format, file) in [
        ("DOB first order", Format::StructuredText, "dob_first_order.st"),
        ("DOB first order", Format::StructuredTextTest, "test_dob_first_order.st"),
        ("DOB first order", Format::C, "dob_first_order.h"),
    ] {
        let text = text(name, Precision::F32, format);
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("exported").join(file);
        if std::env::var_os("RENEW_EXPORTS").is_some() {
            std::fs::write(&file, &text).expect("the file can be written");
        }
        let committed = std::fs::read_to_string(&file).expect("the file is committed");
        assert!(committed == text, "{} is not what is exported today: RENEW_EXPORTS=1", file.display());
    }
}

/// A translator reads decimals as double precision: they must be those of the number in single precision.
#[test]
fn numbers_are_the_exact_values_of_the_type() {
    let single = text("DE first order", Precision::F32, Format::StructuredText);
    for line in [
        "    KP : REAL := 0.800000011920929;",
        "    TF : REAL := 0.029999999329447746;",
        "    LARGEST : REAL;",
        "    LARGEST := 3.4028234663852886E38;",
        "    L_ONE : LREAL;",
        "    L_ONE := 1.0;",
        "    DELAY : ARRAY [0..10] OF REAL;",
        "    PV_QUALITY : DINT := 2;",
        "    ST_ALARM_DEV : DWORD; (* bit 20: alarm deviation *)",
        "    ST_ALARM_DEV := 1048576;",
    ] {
        assert!(single.lines().any(|l| l.starts_with(line)), "`{line}` is not in:\n{single}");
    }
    let double = text("DE first order", Precision::F64, Format::StructuredText);
    assert!(double.contains("    KP : LREAL := 0.8;") && !double.contains(" REAL"), "{double}");
    assert!(!double.contains("_TO_"), "there is nothing to convert");
}

/// No number with a point stands in a statement but alone, no function that treats NaN in its own way, one operation in each.
#[test]
fn statements_hold_one_operation_and_no_number() {
    for spec in all() {
        let text = text(&spec.name, Precision::F32, Format::StructuredText);
        let (_, body) = text.rsplit_once("END_VAR").expect("declarations");
        for line in body.lines().map(str::trim).filter(|line| !line.starts_with("(*")) {
            let literal = line
                .as_bytes()
                .windows(3)
                .any(|w| w[0].is_ascii_digit() && w[1] == b'.' && w[2].is_ascii_digit());
            let alone = line
                .split_once(" := ")
                .is_some_and(|(_, value)| value.trim_end_matches(';').parse::<f64>().is_ok());
            assert!(!literal || alone, "{line}");
            if let Some((_, value)) = line.split_once(":=") {
                let operations = value.matches([' ']).filter(|_| false).count()
                    + ["+", "-", "*", "/"]
                        .iter()
                        .map(|sign| value.matches(&format!(" {sign} ")).count())
                        .sum::<usize>();
                assert!(operations <= 1, "{line}");
            } else {
                assert!(![" + ", " - ", " * ", " / "].iter().any(|sign| line.contains(sign)), "{line}");
            }
            for word in ["MIN(", "MAX(", "LIMIT(", "ABS(", "SQRT(", "EXPT", "SEL(", "MOD", "{", "//"] {
                assert!(!line.contains(word) || line.contains("MODE"), "{line}");
            }
        }
    }
}

#[test]
fn names_come_from_the_controller_and_nothing_ends_a_comment() {
    let (scenario, spec) = of("PI default");
    for (name, block) in [
        ("DE-MOMI", "FB_DE_MOMI"),
        ("  Ofen 3 Zone-2 ", "FB_OFEN_3_ZONE_2"),
        ("  Ofen 3 / Zone  2 ", "FB_OFEN_3_ZONE_2_F1B5"),
        ("PI-Default", "FB_PI_DEFAULT_C43D"),
        ("*) x := 1; (* {pragma} \u{e9}", "FB_X_1_PRAGMA_18F9"),
        ("\u{65e5}\u{672c}", "FB_LOOP_7177"),
        ("a name that is longer than any PLC would take", "FB_A_NAME_THAT_IS_L_2D1A"),
        ("a name that is longer than any PLC would like", "FB_A_NAME_THAT_IS_L_E067"),
    ] {
        let spec = ControllerSpec { name: name.to_owned(), ..spec.clone() };
        let export = Export::new(&scenario, &spec, Precision::F32, None).expect("a loop");
        let made = export.block("a*)b.toml").expect("a block");
        assert_eq!(made.name, block);
        assert!(made.head.iter().all(|line| line.is_ascii() && !line.contains("*)") && !line.contains('{')));
    }
}

#[test]
fn an_adrc_is_refused_by_name() {
    let (scenario, spec) = of("PI default");
    let adrc = controller_core::AdrcConfig::from_bandwidths(5.0, 10.0, 40.0);
    let config = ControllerConfig { pid: PidConfig::default(), ..spec.config };
    let spec = ControllerSpec { adrc: Some(adrc), config, ..spec };
    let export = Export::new(&scenario, &spec, Precision::F32, None).expect("a loop");
    for format in [Format::StructuredText, Format::StructuredTextTest, Format::C] {
        assert_eq!(export.text(format, "x"), Err(Refused::Adrc));
    }
    assert!(export.text(Format::Rust, "x").is_ok());
}

/// `SP`, `PV` of every sample in, `OP` out.
fn outputs(cc: &str, name: &str, block: &Block, precision: Precision, samples: &[(f64, f64)]) -> Vec<f64> {
    let list = |role: Role| block.variables.iter().filter(move |v| v.role == role);
    let mut records = Vec::new();
    for (sp, pv) in samples {
        for v in list(Role::Input) {
            use controller_sim_host::export::block::Initial;
            records.push(match (v.name.as_str(), &v.initial) {
                ("SP", _) => *sp,
                ("PV", _) => *pv,
                (_, Initial::Number(x)) => *x,
                (_, Initial::Count(n)) => f64::from(*n),
                (_, Initial::Flag(is)) => f64::from(u8::from(*is)),
                _ => 0.0,
            });
        }
    }
    let at = list(Role::Output).position(|v| v.name == "OP").expect("an output");
    let given = run(&compile(cc, name, &program(block, precision), &["-O1"]), &records);
    given.chunks(list(Role::Output).count()).map(|out| out[at]).collect()
}

/// A PI of kp = 2, ki = 0.5 at TS = 0.5, every number a small binary fraction: by hand, `I` from -2 on by `e/4`,
/// `pd = 2*(SP - PV)`.
#[test]
fn a_loop_computed_by_hand() {
    let Some(cc) = compiler() else { return not_run("a loop computed by hand", "no C compiler") };
    let pid = PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() };
    let config = ControllerConfig { limits: LimitConfig::range(-2.0, 10.0), ..ControllerConfig::default() };
    let spec =
        ControllerSpec { config: ControllerConfig { pid, ..config }, ..ControllerSpec::pid("hand", pid) };
    let scenario = Scenario { ts: 0.5, ..scenario(vec![spec.clone()]) };
    for precision in [Precision::F32, Precision::F64] {
        let export = Export::new(&scenario, &spec, precision, None).expect("a loop");
        let block = export.block("hand").expect("a block");
        let samples = [(1.0, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 1.25), (1.0, 1.0), (1.0, 1.0)];
        // The fourth is limited from -2.1875 to -2; the anti-windup gives back 0.5/4 (TT = kp/ki = 4) of 0.1875.
        let expected = [0.0, 0.25, -0.625, -2.0, -1.664_062_5, -1.664_062_5];
        let name = format!("hand_{precision:?}");
        assert_eq!(outputs(cc, &name, &block, precision, &samples), expected, "{precision:?}");
    }
}

/// kp = 0.1, PV = -0.3: the product of 13421773/2^27 and 10066330/2^25, rounded once to 24 bits, is 0x3CF5C290; a literal
/// evaluated in double precision would give another.
#[test]
fn products_of_reals_are_rounded_to_real() {
    let Some(cc) = compiler() else { return not_run("products of REAL", "no C compiler") };
    let pid = PidConfig { kp: 0.1, ..PidConfig::default() };
    let spec = ControllerSpec::pid("product", pid);
    let scenario = scenario(vec![spec.clone()]);
    let export = Export::new(&scenario, &spec, Precision::F32, None).expect("a loop");
    let block = export.block("product").expect("a block");
    let given = outputs(cc, "product", &block, Precision::F32, &[(0.0, 0.0), (0.0, f64::from(-0.3_f32))]);
    assert_eq!((given[0], given[1]), (0.0, f64::from(f32::from_bits(0x3CF5_C290))));
}
