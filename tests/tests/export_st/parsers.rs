//! Independent front ends of Structured Text accept what is exported.

use crate::compiled::{folder, not_run};
use crate::loops::{all, scenario};
use controller_sim_host::export::{Export, Format};
use controller_sim_host::simulate::Precision;
use std::path::PathBuf;
use std::process::Command;

/// Block and test program of every loop in both number types.
fn texts() -> Vec<(String, String)> {
    let scenario = scenario(all());
    let mut texts = Vec::new();
    for spec in &scenario.controllers {
        for precision in [Precision::F32, Precision::F64] {
            let export = Export::new(&scenario, spec, precision, None).expect("a loop");
            for format in [Format::StructuredText, Format::StructuredTextTest] {
                let name = format!("{} {precision:?} {}", spec.name, format.name()).replace([' ', ','], "_");
                texts.push((name, export.text(format, "loops.toml").expect("a text")));
            }
        }
    }
    texts
}

#[test]
fn the_crate_iec61131_parses_every_block() {
    for (name, text) in texts() {
        match iec61131::Parser::new(&text).parse() {
            Ok(unit) => assert_eq!(unit.declarations.len(), 1, "{name}"),
            Err(fault) => panic!("{name}: {fault}\n{text}"),
        }
        // It does read: a keyword in the place of a name, a missing end.
        let broken =
            [text.replace("SP", "END_IF"), text.replace("END_IF;", ""), text.replacen(" := ", " = := ", 1)];
        for broken in broken {
            assert!(iec61131::Parser::new(&broken).parse().is_err(), "{name}");
        }
    }
}

/// The Python that `cargo xtask setup` makes for this test.
fn python() -> Option<PathBuf> {
    let target = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).parent()?.to_owned();
    let python = target.join("structured-text/python");
    let python = python.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    python.is_file().then_some(python)
}

#[test]
fn the_python_package_tree_sitter_iec61131_3_st_parses_every_block() {
    let Some(python) = python() else {
        return not_run("tree-sitter on exported blocks", "its Python is missing; run: cargo xtask setup");
    };
    let folder = folder().join("structured_text");
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    let mut files = Vec::new();
    for (name, text) in texts() {
        let file = folder.join(name).with_extension("st");
        std::fs::write(&file, text).expect("the file can be written");
        files.push(file);
    }
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("structured_text/parse.py");
    let output = Command::new(python).arg(script).args(&files).output().expect("Python can be started");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(said.trim(), format!("{} files, {} refused when broken", files.len(), files.len()));
}
