//! The page of the function block says what the block does, and its examples are accepted.

use crate::program::{Compiler, available, folder, root};
use controller_capi::plc::status;
use controller_core::{Reason, Status};
use std::collections::BTreeMap;
use std::process::Command;

fn page() -> String {
    std::fs::read_to_string(root().join("controller-capi/iec/README.md")).expect("the page can be read")
}

/// The cells of the tables' rows.
fn rows(page: &str) -> Vec<Vec<&str>> {
    let row = |line: &'_ str| line.starts_with('|') && !line.contains("---");
    page.lines()
        .filter(|line| row(line))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect()
}

/// The blocks of code in this language.
fn code(page: &str, language: &str) -> Vec<String> {
    let opening = format!("```{language}\n");
    let blocks = page.split(&opening).skip(1);
    blocks.map(|rest| rest.split("```").next().unwrap_or_default().to_string()).collect()
}

#[test]
fn tables_are_those_of_the_block() {
    let page = page();
    let rows = rows(&page);
    let mut variables: BTreeMap<&str, &Vec<&str>> = rows
        .iter()
        .filter(|row| row[0].starts_with('`') && row.len() >= 4)
        .map(|row| (row[0].trim_matches('`'), row))
        .collect();
    let [block, _] = crate::both();
    for v in block.variables.iter().filter(|v| v.name != "STATE") {
        let row = variables.remove(v.name.as_str()).unwrap_or_else(|| panic!("{} is missing", v.name));
        assert_eq!(row[1], v.kind.replace("REAL", "real"), "{}", v.name);
        assert_eq!(row[2], v.initial, "{}", v.name);
        if row.len() == 5 && row[3] != "-" {
            let number = row[3].parse().expect("a number");
            // SAFETY: a text that lives as long as the program.
            let name = unsafe { std::ffi::CStr::from_ptr(controller_capi::ctl_fb_param_name(number)) };
            assert_eq!(name.to_str().map(str::to_uppercase).as_deref(), Ok(v.name.as_str()));
        }
    }
    assert!(variables.is_empty(), "{variables:?}");
    let bit = |number: &str, hex: &str| rows.iter().any(|row| row[0] == number && row[1] == hex);
    for (status, name) in
        Status::NAMES.iter().filter(|(status, _)| status.bits() < Status::ALARM_HI_HI.bits())
    {
        assert!(bit(&status.bits().trailing_zeros().to_string(), &format!("{:x}", status.bits())), "{name}");
    }
    let own = [
        status::PERIOD_OFF,
        status::COMPENSATOR_OUT,
        status::REFUSED,
        status::STATE_LOST,
        status::NOT_RUNNING,
    ];
    for bits in own {
        assert!(bit(&bits.trailing_zeros().to_string(), &format!("{bits:x}")), "{bits:x}");
    }
    for reason in 1..=Reason::NotProper as u8 {
        assert!(rows.iter().any(|row| row.len() == 2 && row[0] == reason.to_string()), "reason {reason}");
    }
}

#[test]
fn figures_are_those_of_the_library() {
    let page = page();
    let sizes = [(controller_capi::ctl_f32_fb_size(0), 4), (controller_capi::ctl_f64_fb_size(0), 8)];
    let [(single, cell), (double, wide)] = sizes;
    let text = format!("{single} bytes and {cell} for each sample, or {double} and {wide}");
    let words: Vec<&str> = page.split_whitespace().collect();
    assert!(words.join(" ").contains(&text), "{text}");
    // The command for one object is the one that is tested.
    for flag in crate::program::OBJECT {
        assert!(page.contains(flag), "{flag}");
    }
}

#[test]
fn examples_are_accepted() {
    let page = page();
    let programs = code(&page, "iecst");
    assert!(!programs.is_empty());
    for text in programs {
        let parsed = iec61131::Parser::new(&text).parse();
        assert!(parsed.is_ok(), "{text}\n{:?}", parsed.err());
    }
    let compilers = available();
    let editor = "#include <stdint.h>\ntypedef struct { float *SP, *PV, *OP; uint32_t *STATUS; uint64_t *STATE; } TANK_VARS;\n";
    let blocks = [("cpp", Compiler::Gxx, editor), ("c", Compiler::Gcc, "")];
    for (language, compiler, before) in
        blocks.into_iter().filter(|(_, compiler, _)| compilers.contains(compiler))
    {
        let [text] = &code(&page, language)[..] else { panic!("one example in {language}") };
        let source = folder().join(format!("example.{language}"));
        std::fs::write(&source, format!("{before}{text}")).expect("the example can be written");
        let (name, flags) = compiler.command();
        let output = Command::new(name)
            .args(flags)
            .args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I"])
            .arg(root().join("controller-capi/include"))
            .arg(&source)
            .output()
            .expect("the compiler starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}
