//! The header of constants for the C interface: it compiles everywhere, and what it writes is the configuration.

use crate::compiled::{compiler, folder, not_run};
use crate::loops::{all, scenario};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::simulate::Precision;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of `ctl.h`.
fn include() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../controller-capi/include");
    folder.join("ctl.h").is_file().then_some(folder)
}

/// A program that fills the configuration and prints some of it; `ctl_config_default` is a stand-in.
fn program(header: &str, prefix: &str) -> String {
    let upper = prefix.to_uppercase();
    format!(
        "#include \"{header}\"\n#include <stdio.h>\n#include <string.h>\n\
         int32_t ctl_config_default(ctl_config *config, size_t size)\n{{\n    memset(config, 0, size);\n    \
         config->struct_size = (uint32_t)size;\n    return CTL_OK;\n}}\n\
         static {upper}_STATE(block);\nint main(void)\n{{\n    ctl_config c;\n    int k;\n    \
         if ({prefix}_config(&c) != CTL_OK) {{\n        return 1;\n    }}\n    \
         printf(\"%.17g %.17g %.17g %.17g %.17g %.17g %.17g\\n\", {upper}_TS, c.ts, c.kp, c.ki, c.kd, c.tf, c.b);\n    \
         printf(\"%.17g %.17g %.17g %.17g %d %d\\n\", c.output_lo, c.output_hi, c.output_rate_up, c.deadband, c.action, c.hold_samples);\n    \
         printf(\"%d %.17g %.17g %.17g %.17g %d %d %d\\n\", c.compensator, c.model_gain, c.model_dead_time, c.kfd, c.alpha, c.filter_order, \
         c.model_pole_count, c.model_zero_count);\n    \
         for (k = 0; k < c.model_pole_count; k++) {{\n        printf(\"%.17g %.17g\\n\", c.model_pole_a1[k], c.model_pole_a2[k]);\n    }}\n    \
         return sizeof block == 0;\n}}\n"
    )
}

#[test]
fn the_header_of_every_loop_fills_its_configuration() {
    let Some(include) = include() else {
        return not_run("headers for the C interface", "there is no controller-capi/include/ctl.h");
    };
    let Some(cc) = compiler() else { return not_run("headers for the C interface", "no C compiler") };
    let scenario = scenario(all());
    for spec in &scenario.controllers {
        let export = Export::new(&scenario, spec, Precision::F64, None).expect("a loop");
        let text = export.text(Format::C, "loops.toml").expect("a header");
        let prefix =
            text.lines().find_map(|line| line.strip_prefix("static inline int32_t ")).expect("a function");
        let prefix = prefix.split("_config(").next().expect("a name");
        let header = folder().join(format!("{prefix}.h"));
        let source = folder().join(format!("{prefix}_header.c"));
        std::fs::write(&header, &text).expect("the header can be written");
        std::fs::write(&source, program(&format!("{prefix}.h"), prefix)).expect("the source can be written");
        let file = folder().join(format!("{prefix}_header"));
        for options in [
            ["-x", "c", "-std=c99"],
            ["-x", "c++", "-std=c++11"],
            ["-x", "c++", "-std=c++20"],
            ["-x", "c", "-std=c11"],
        ] {
            // Without the C++ front end the C standards remain.
            if options[1] == "c++" && Command::new("c++").arg("--version").output().is_err() {
                not_run("headers as C++", "no C++ compiler");
                continue;
            }
            let mut command = Command::new(cc);
            command.args(options).args(["-Wall", "-Wextra", "-pedantic", "-Werror", "-I"]).arg(&include);
            let output = command.arg("-o").args([&file, &source]).output().expect("the compiler starts");
            assert!(
                output.status.success(),
                "{options:?}\n{}{text}",
                String::from_utf8_lossy(&output.stderr)
            );
        }
        let output = Command::new(&file).output().expect("the program runs");
        assert!(output.status.success(), "{prefix}");
        let said = String::from_utf8_lossy(&output.stdout);
        let numbers: Vec<f64> = said.split_whitespace().map(|word| word.parse().expect("a number")).collect();
        let c = &spec.config;
        let p = &c.pid;
        let mut expected = vec![scenario.ts, scenario.ts, p.kp, p.ki, p.kd, p.tf, p.b];
        let rate = c.limits.rate_up.unwrap_or(0.0);
        let action = f64::from(u8::from(p.action == controller_core::Action::Direct));
        expected.extend([
            c.limits.lo,
            c.limits.hi,
            rate,
            c.deadband,
            action,
            f64::from(c.fallback.hold_samples),
        ]);
        expected.extend(compensator(spec));
        assert_eq!(numbers, expected, "{prefix}\n{text}");
    }
}

fn compensator(spec: &controller_sim_host::scenario::ControllerSpec) -> Vec<f64> {
    use controller_sim_host::scenario::CompensatorSpec;
    let count = |n: usize| n as f64;
    match &spec.compensator {
        CompensatorSpec::None => vec![0.0; 8],
        CompensatorSpec::Estimator(e) => {
            vec![1.0, e.gain, e.dead_time, e.kfd, 0.0, 0.0, 1.0, 0.0, e.a1, e.a2]
        }
        CompensatorSpec::Observer(o) => {
            let m = &o.model;
            let order = count(o.order.unwrap_or(0));
            let mut list = vec![2.0, m.gain, m.dead_time, 0.0, o.alpha, order];
            list.extend([count(m.poles.len()), count(m.zeros.len())]);
            list.extend(m.poles.iter().flat_map(|pole| [pole.a1, pole.a2]));
            list
        }
    }
}
