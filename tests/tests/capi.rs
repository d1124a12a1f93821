//! The C interface from C: the same bits as the core, every error, memory that moves, snapshots, layout, clean memory, damaged memory.
//!
//! The programs are in `tests/c`; a compiler or a tool that is missing is named, and its part did not run.

#[path = "capi/archive.rs"]
mod archive;
#[path = "capi/cases.rs"]
mod cases;
#[path = "capi/script.rs"]
mod script;
#[path = "capi/tools.rs"]
mod tools;

use controller_core::Real;
use script::Script;
use std::path::PathBuf;
use tools::{Build, Tool, available, folder, root};

const VARIANTS: [&str; 2] = ["f32", "f64"];

/// The programs that check by themselves.
const PROGRAMS: [&str; 3] = ["errors", "snapshot", "behaviour"];

/// The programs that damage memory, bit by bit in steps of so many bits.
const DAMAGE: [&str; 2] = ["damage", "damage_block"];

fn every_nth_bit(n: u32) -> [PathBuf; 1] {
    [n.to_string().into()]
}

/// Two scripts in the number type `T`, in files.
fn scripts<T: Real>(seed: u64, samples: usize) -> ([std::path::PathBuf; 2], String) {
    let scripts = [seed, seed + 1].map(|seed| Script::<T>::random(seed, samples));
    let name = |i: u64| folder().join(format!("script-{}-{}-{samples}.txt", T::WORDS, seed + i));
    let paths = [name(0), name(1)];
    for (path, script) in paths.iter().zip(&scripts) {
        std::fs::write(path, &script.commands).expect("the script can be written");
    }
    // The instances take turns line by line; a line without an output leaves a gap.
    let [one, other] = scripts.map(|s| s.outputs);
    let mut expected = String::new();
    for line in 0..one.len().max(other.len()) {
        for (number, outputs) in [&one, &other].iter().enumerate() {
            if let Some(Some(text)) = outputs.get(line) {
                expected += &format!("{number} {text}\n");
            }
        }
    }
    (paths, expected)
}

/// Replays scripts with the program that `build` makes, started by `runner`.
fn replayed(build: &Build<'_>, runner: &[&str], samples: usize, seeds: std::ops::Range<u64>) {
    for variant in VARIANTS {
        let program = build.program("replay", variant);
        for seed in seeds.clone() {
            let (paths, expected) =
                if variant == "f32" { scripts::<f32>(seed, samples) } else { scripts::<f64>(seed, samples) };
            let output = tools::run(&program, runner, &paths);
            same(variant, seed, &expected, &output);
        }
    }
}

/// The program's outputs are the expected ones.
fn same(variant: &str, seed: u64, expected: &str, output: &str) {
    let (outputs, verdict) = output.trim_end().rsplit_once('\n').expect("a verdict at the end");
    assert!(verdict.ends_with(", 0 failures"), "{verdict}");
    for (line, (ours, theirs)) in expected.lines().zip(outputs.lines()).enumerate() {
        assert_eq!(ours, theirs, "{variant}, seed {seed}: output {line}, Rust left, C right");
    }
    assert_eq!(expected.lines().count(), outputs.lines().count());
}

#[test]
fn outputs_are_those_of_the_core_bit_for_bit() {
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        replayed(&Build::new(compiler, &["-O2"]), &[], 5000, 10..14);
    }
}

#[test]
fn outputs_are_those_of_the_core_on_an_emulated_cortex_m() {
    if available(&[Tool::ArmGcc, Tool::Qemu]).len() < 2 {
        return;
    }
    // The board has a Cortex-M4F, which runs the code of its smaller relatives, too.
    let boards: [(&str, &[&str]); 3] = [
        ("thumbv7em-none-eabihf", &["-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]),
        ("thumbv7em-none-eabi", &["-mcpu=cortex-m4", "-mfloat-abi=soft"]),
        ("thumbv6m-none-eabi", &["-mcpu=cortex-m0"]),
    ];
    for (target, flags) in boards.into_iter().filter(|(target, _)| tools::has_target(target)) {
        for (variant, seed) in VARIANTS.into_iter().zip([40, 42]) {
            let image = tools::image("replay", variant, target, flags);
            let (paths, expected) =
                if variant == "f32" { scripts::<f32>(seed, 1500) } else { scripts::<f64>(seed, 1500) };
            same(variant, seed, &expected, &tools::emulated(&image, &paths));
            // Checks are slow there, and the same for all.
            if target == "thumbv7em-none-eabihf" {
                for program in PROGRAMS {
                    tools::passes(&tools::emulated(&tools::image(program, variant, target, flags), &[]));
                }
                for program in DAMAGE {
                    let image = tools::image(program, variant, target, flags);
                    tools::passes(&tools::emulated(&image, &every_nth_bit(53)));
                }
            }
        }
    }
}

#[test]
fn scripts_come_to_everything() {
    let mut seen = 0;
    for seed in 10..14 {
        let script = Script::<f32>::random(seed, 5000);
        seen |= script.seen;
        assert!(script.modes.iter().filter(|&&count| count > 50).count() >= 6, "{:?}", script.modes);
        assert!(script.adoptions.iter().all(|&count| count > 0), "{:?}", script.adoptions);
    }
    // All bits but 15, which has no meaning.
    assert_eq!(seen, 0x1F_7FFF, "status bits seen: {seen:#x}");
}

#[test]
fn every_error_every_damaged_snapshot_and_the_table_of_the_readme() {
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        let build = Build::new(compiler, &["-O1"]);
        for variant in VARIANTS {
            for program in PROGRAMS {
                tools::passes(&tools::run(&build.program(program, variant), &[], &[]));
            }
        }
    }
}

#[test]
fn clean_with_sanitizers() {
    let flags = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        let build = Build::new(compiler, &flags);
        if !build.links() {
            tools::not_run(&format!("sanitizers of {compiler:?}: its run-time library is missing"));
            continue;
        }
        replayed(&build, &[], 1000, 20..22);
        for variant in VARIANTS {
            for program in PROGRAMS {
                tools::passes(&tools::run(&build.program(program, variant), &[], &[]));
            }
            for program in DAMAGE {
                tools::passes(&tools::run(&build.program(program, variant), &[], &every_nth_bit(1)));
            }
        }
    }
}

#[test]
fn clean_under_valgrind() {
    if available(&[Tool::Valgrind]).is_empty() {
        return;
    }
    let suppressions = format!("--suppressions={}", root().join("tests/c/valgrind.supp").display());
    let valgrind = ["valgrind", "-q", "--error-exitcode=9", "--leak-check=full", &suppressions];
    for compiler in available(&[Tool::Gcc]) {
        let build = Build::new(compiler, &["-g"]);
        replayed(&build, &valgrind, 300, 30..31);
        for variant in VARIANTS {
            for program in PROGRAMS {
                tools::passes(&tools::run(&build.program(program, variant), &valgrind, &[]));
            }
            for program in DAMAGE {
                tools::passes(&tools::run(&build.program(program, variant), &valgrind, &every_nth_bit(53)));
            }
        }
    }
}

#[test]
fn headers_and_layouts_hold_for_every_standard() {
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        for enums in ["-fshort-enums", "-fno-short-enums"] {
            for (language, standards) in
                [("c", &["c99", "c11", "c17"][..]), ("c++", &["c++11", "c++14", "c++17", "c++20"])]
            {
                for standard in standards {
                    tools::checks(compiler, &["-x", language, &format!("-std={standard}"), enums]);
                }
            }
        }
    }
    let boards: [&[&str]; 3] = [
        &["-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"],
        &["-mcpu=cortex-m4", "-mfloat-abi=soft"],
        &["-mcpu=cortex-m0"],
    ];
    for compiler in available(&[Tool::ArmGcc]) {
        for board in boards {
            for enums in ["-fshort-enums", "-fno-short-enums"] {
                tools::checks(compiler, &[board, &["-ffreestanding", "-std=c11", enums]].concat());
            }
        }
    }
}

#[test]
fn the_example_holds_its_temperature() {
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        let source = root().join("controller-capi/examples/heater.c");
        let program = Build::new(compiler, &["-O2"]).compile(&source, "heater", &[]);
        let output = tools::run(&program, &[], &[]);
        let last = output.lines().last().expect("the example prints");
        // The disturbance is 10 % of the heater, the tank is at 60 degrees: 50 % for it, 10 % against the cold water.
        assert!(last.contains("60.00 C   60.00 %  disturbance -10.00 %"), "{last}");
    }
}

#[test]
fn the_program_of_the_readme_runs() {
    let page = std::fs::read_to_string(root().join("controller-capi/README.md")).expect("the page is there");
    let (_, rest) = page.split_once("```c\n").expect("a program in C");
    let (program, _) = rest.split_once("```").expect("its end");
    let source = folder().join("readme.c");
    std::fs::write(&source, program).expect("the source can be written");
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        let program = Build::new(compiler, &["-std=c99"]).compile(&source, "readme", &[]);
        assert_eq!(tools::run(&program, &[], &[]).trim(), "50.00");
    }
}

#[test]
fn a_program_in_cpp_links() {
    for compiler in available(&[Tool::Gcc, Tool::Clang]) {
        let source = root().join("tests/c/link.cpp");
        let program = Build::new(compiler, &["-std=c++11"]).compile(&source, "link-cpp", &[]);
        assert_eq!(tools::run(&program, &[], &[]).trim(), "2.1000000");
    }
}
