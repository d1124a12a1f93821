//! The exported test program, run from its text together with the text of its block: it passes, and with a mistake in
//! either it does not.

use crate::compiled::{compile, compiler, not_run, run};
use crate::loops::{all, scenario};
use crate::mutations::swapped;
use crate::text_bits::text;
use crate::translate::translate_program;
use controller_sim_host::export::{Export, Format};
use controller_sim_host::simulate::Precision;

/// `DONE, PASSED, FAULTS, FIRST_FAULT` after these cycles.
fn verdict(cc: &str, name: &str, program: &str, block: &str, cycles: usize) -> Vec<f64> {
    let named = ["DONE", "PASSED", "FAULTS", "FIRST_FAULT"];
    let source = translate_program(program, block, cycles, &named);
    let source = source.unwrap_or_else(|fault| panic!("{name}: {fault}\n{program}"));
    let name = format!("program_{name}").replace([' ', ','], "_");
    run(&compile(cc, &name, &source, &["-O0"]), &[])
}

#[test]
fn the_test_program_passes_from_its_text() {
    let Some(cc) = compiler() else { return not_run("exported test programs", "no C compiler") };
    let scenario = scenario(all());
    for (n, spec) in scenario.controllers.iter().enumerate() {
        let precision = [Precision::F32, Precision::F64][n % 2];
        let block = text(&scenario, spec, precision);
        let export = Export::new(&scenario, spec, precision, None).expect("a loop");
        let program = export.text(Format::StructuredTextTest, "test").expect("a program");
        let name = format!("{} {precision:?}", spec.name);
        assert_eq!(verdict(cc, &name, &program, &block, 221), [1.0, 1.0, 0.0, -1.0], "{name}");
        if n > 0 {
            continue;
        }
        // The last sample is yet to come.
        assert_eq!(verdict(cc, &name, &program, &block, 219), [0.0, 0.0, 0.0, -1.0], "{name}");
        // Another number in one sample of the outputs that are compared.
        let number = |line: &&str| line.contains("[77] := ") && line.contains('.') && line.contains("OUT_");
        let line = program.lines().find(number).expect("a sample");
        let (place, _) = line.split_once(" := ").expect("a value");
        let other = program.replacen(line, &format!("{place} := 1.0E10;"), 1);
        assert_eq!(verdict(cc, &name, &other, &block, 221), [1.0, 0.0, 1.0, 77.0], "{name}");
        // A block that subtracts where it should add, or divides where it should multiply.
        for (right, wrong) in [(" + ", " - "), (" * ", " / ")] {
            let found = verdict(cc, &name, &program, &swapped(&block, right, wrong), 221);
            assert!(found[..2] == [1.0, 0.0] && found[2] > 10.0, "{right}: {found:?}");
        }
    }
}
