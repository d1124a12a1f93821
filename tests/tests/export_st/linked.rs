//! The exported header with the archive: a C program built from both steps with the bits of the core.

use crate::archive::archive;
use crate::compiled::{compiler, folder, not_run};
use crate::drive::{Driven, Sample};
use crate::loops::{all, random, scenario};
use controller_core::{ControllerOutput, Mode, Real};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::path::Path;
use std::process::Command;

const SAMPLES: u32 = 1000;
const INPUTS: usize = 15;
const OUTPUTS: usize = 11;

/// A program that reads the inputs of each sample as doubles and writes what the step gives.
fn program(text: &str, precision: Precision) -> String {
    let prefix =
        text.lines().find_map(|line| line.strip_prefix("static inline int32_t ")).expect("a function");
    let prefix = prefix.split("_config(").next().expect("a name");
    let (upper, ctl, real) = match precision {
        Precision::F32 => (prefix.to_uppercase(), "ctl_f32", "float"),
        Precision::F64 => (prefix.to_uppercase(), "ctl_f64", "double"),
    };
    format!(
        "#include <stdio.h>\n#include <string.h>\n{text}\n\
         int main(void)\n{{\n    static {upper}_STATE(block);\n    double x[{INPUTS}];\n    ctl_config config;\n    \
         if ({prefix}_config(&config) != CTL_OK || {ctl}_init(block, sizeof block, &config, NULL) != CTL_OK) {{\n        \
         return 1;\n    }}\n    \
         while (fread(x, sizeof x, 1, stdin) == 1) {{\n        {ctl}_input in;\n        {ctl}_output out;\n        \
         {real} *numbers[] = {{&in.r, &in.r_remote, &in.y, &in.u_applied, &in.manual, &in.track, &in.offset}};\n        \
         int32_t *choices[] = {{&in.mode, &in.quality, &in.has_u_applied, &in.has_manual, &in.compensator_off,\n            \
         &in.inhibit_up, &in.inhibit_down, &in.acknowledge}};\n        \
         for (int i = 0; i < 7; i++) {{\n            *numbers[i] = ({real})x[i];\n        }}\n        \
         for (int i = 0; i < 8; i++) {{\n            *choices[i] = (int32_t)x[7 + i];\n        }}\n        \
         if ({ctl}_step(block, sizeof block, &in, &out) != CTL_OK) {{\n            return 2;\n        }}\n        \
         double given[] = {{out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r, out.mode, out.status, out.blocked_up,\n            \
         out.blocked_down}};\n        \
         if (fwrite(given, sizeof given, 1, stdout) != 1) {{\n            return 3;\n        }}\n    }}\n    return 0;\n}}\n"
    )
}

fn record<T: Real>(sample: &Sample<T>) -> [f64; INPUTS] {
    let i = &sample.input;
    let flag = |is: bool| f64::from(u8::from(is));
    let number = |x: Option<T>| x.unwrap_or_default().to_f64();
    // Nobody asks C for a fallback; the core takes such a wish for Hold.
    let mode = if i.mode == Mode::Fallback { Mode::Hold } else { i.mode };
    [
        i.r.to_f64(),
        i.r_remote.to_f64(),
        i.y.to_f64(),
        number(i.u_applied),
        number(i.manual),
        i.track.to_f64(),
        i.offset.to_f64(),
        f64::from(mode as u8 + 1),
        f64::from(i.quality as u8),
        flag(i.u_applied.is_some()),
        flag(i.manual.is_some()),
        flag(!i.compensate),
        flag(i.inhibit_up),
        flag(i.inhibit_down),
        flag(i.acknowledge),
    ]
}

fn given<T: Real>(out: &ControllerOutput<T>) -> [f64; OUTPUTS] {
    let flag = |is: bool| f64::from(u8::from(is));
    let [u, v, i, pd, u_f, d_hat, r] =
        [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r].map(T::to_f64);
    let mode = f64::from(out.mode as u8 + 1);
    let (up, down) = (flag(out.blocked_up), flag(out.blocked_down));
    [u, v, i, pd, u_f, d_hat, r, mode, f64::from(out.status.bits()), up, down]
}

fn same<T: Real>(cc: &str, library: &Path, scenario: &Scenario, spec: &ControllerSpec, precision: Precision) {
    let name = format!("{} {precision:?}", spec.name);
    let export = Export::new(scenario, spec, precision, None).unwrap_or_else(|why| panic!("{name}: {why:?}"));
    let text = export.text(Format::C, "loops.toml").expect("a header");
    let block = export.block("test").expect("a block");
    let mut driven = Driven::<T>::new(scenario, spec, &block, export.capacity(), 11, false);
    let (mut records, mut expected) = (Vec::new(), Vec::new());
    for k in 0..SAMPLES {
        let (sample, out, _) = driven.sample(k);
        records.extend(record(&sample));
        expected.push(given(&out));
    }
    let file = folder().join(format!("linked_{}.c", name.replace([' ', ','], "_")));
    let binary = file.with_extension("program");
    std::fs::write(&file, program(&text, precision)).expect("the source can be written");
    let include = Path::new(env!("CARGO_MANIFEST_DIR")).join("../controller-capi/include");
    let mut command = Command::new(cc);
    command.args(["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O1", "-I"]).arg(include);
    let output = command.args([&file, library]).arg("-o").arg(&binary).output().expect("the compiler starts");
    assert!(output.status.success(), "{name}\n{}", String::from_utf8_lossy(&output.stderr));
    let numbers = crate::compiled::run(&binary, &records);
    assert_eq!(numbers.len(), OUTPUTS * expected.len(), "{name}");
    for (k, (expected, given)) in expected.iter().zip(numbers.chunks(OUTPUTS)).enumerate() {
        let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(
            bits(expected) == bits(given),
            "{name}, sample {k}\nRust {expected:?}\nC    {given:?}\ninput {:?}",
            records.chunks(INPUTS).nth(k)
        );
    }
}

#[test]
fn the_header_with_the_archive_steps_with_the_bits_of_the_core() {
    let Some(cc) = compiler() else {
        return not_run(
            "exported headers with the archive",
            "no C compiler; `cargo xtask setup` installs it",
        );
    };
    let library = archive(None);
    let mut specs = all();
    specs.extend((1..=6).map(random));
    let scenario = scenario(specs);
    for spec in &scenario.controllers {
        same::<f32>(cc, &library, &scenario, spec, Precision::F32);
        same::<f64>(cc, &library, &scenario, spec, Precision::F64);
    }
}
