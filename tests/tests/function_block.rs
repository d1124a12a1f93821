//! The function block in Structured Text, as a runtime that translates it to C would run it.
//!
//! Such a compiler is in no package registry. So the C it would write is written here from the file itself: a structure of its
//! variables, each with a value and flags; the macros that it defines around a pragma; and the pragma as it stands. What
//! that program gives is compared, bit for bit, with the block called from Rust.

#[path = "capi/archive.rs"]
mod archive;
#[path = "function_block/generated.rs"]
mod generated;
#[path = "function_block/program.rs"]
mod program;
#[path = "function_block/readme.rs"]
mod readme;
#[path = "function_block/st.rs"]
mod st;
#[path = "function_block/trace.rs"]
mod trace;
#[path = "function_block/words.rs"]
mod words;

use controller_capi::plc::{Kind, Number, Vars};
use program::{Compiler, available, root};
use st::{Block, Section};
use std::collections::BTreeMap;
use std::path::PathBuf;
use trace::Fb;

fn block(name: &str) -> Block {
    let path = root().join(format!("controller-capi/iec/{name}.st"));
    Block::read(&std::fs::read_to_string(path).expect("the file can be read"))
}

fn both() -> [Block; 2] {
    [block("CTL_LOOP"), block("CTL_LOOP_L")]
}

/// What Structured Text calls a variable of the C structure.
fn name_in_st(field: &str) -> String {
    field.trim_end_matches('_').to_uppercase()
}

#[test]
fn variables_are_those_of_the_structure() {
    fn check<T: Number>(block: &Block, real: &str) {
        let mut declared: BTreeMap<&str, &st::Variable> =
            block.variables.iter().map(|v| (v.name.as_str(), v)).collect();
        let state = declared.remove("STATE").expect("the memory");
        assert_eq!(state.section, Section::Private);
        let (words, delay) = block.room();
        let size =
            if real == "REAL" { controller_capi::ctl_f32_fb_size } else { controller_capi::ctl_f64_fb_size };
        assert!(size(delay) <= words * 8 && size(delay + 1) > words * 8, "{delay} in {words} words");
        let parts = Vars::<T>::initial();
        let outputs = [
            controller_capi::plc::vars::Results::<T>::NAMES,
            controller_capi::plc::vars::Reports::NAMES,
            controller_capi::plc::vars::Flags::NAMES,
        ]
        .concat();
        for (field, kind, _) in Vars::<T>::fields() {
            let name = name_in_st(field);
            let variable = declared.remove(name.as_str()).unwrap_or_else(|| panic!("{name} is missing"));
            let expected = match kind {
                Kind::Real => real,
                Kind::Whole => "DINT",
                Kind::Bits => "DWORD",
                Kind::Flag => "BOOL",
            };
            assert_eq!(variable.kind, expected, "{name}");
            let section = if outputs.contains(&field) { Section::Output } else { Section::Input };
            assert_eq!(variable.section, section, "{name}");
            assert!(variable.comment.len() > 4, "{name} has no comment");
        }
        assert!(declared.is_empty(), "not in the structure: {:?}", declared.keys());
        // Each goes in under its own name, each output comes out under it, and nothing else.
        for (field, ..) in Vars::<T>::fields() {
            let name = name_in_st(field);
            let once = |line: &str| block.pragma.lines().filter(|l| l.trim() == line).count();
            assert_eq!(once(&format!("ctl_vars.{field} = GetFbVar({name});")), 1, "{name}");
            let out = usize::from(outputs.contains(&field));
            assert_eq!(once(&format!("SetFbVar({name}, ctl_vars.{field});")), out, "{name}");
        }
        assert_eq!(block.pragma.matches("GetFbVar").count(), Vars::<T>::fields().count());
        assert_eq!(block.pragma.matches("SetFbVar").count(), outputs.len());
        assert!(parts.settings.list().all(|x| x.is_finite_number()));
    }
    let [single, double] = both();
    assert_eq!((single.name.as_str(), double.name.as_str()), ("CTL_LOOP", "CTL_LOOP_L"));
    check::<f32>(&single, "REAL");
    check::<f64>(&double, "LREAL");
}

#[test]
fn the_two_blocks_differ_in_their_type_only() {
    let [single, double] = both();
    let strip = |block: &Block| -> Vec<(String, String, String)> {
        let variables = block.variables.iter().filter(|v| v.name != "STATE");
        variables.map(|v| (v.name.clone(), v.initial.clone(), v.comment.clone())).collect()
    };
    assert_eq!(strip(&single), strip(&double));
    assert_eq!(single.pragma.replace("f32", "f64"), double.pragma);
}

#[test]
fn no_name_is_a_word_of_the_language() {
    for block in both() {
        for variable in &block.variables {
            assert!(!words::is_reserved(&variable.name), "{}", variable.name);
        }
        assert!(!words::is_reserved(&block.name));
    }
    // Words that such blocks often use by mistake.
    for word in ["DT", "tp", "ACTION", "R_TRIG", "LD", "S", "EN", "step", "LIMIT", "ON"] {
        assert!(words::is_reserved(word), "{word}");
    }
}

#[test]
fn exported_names_do_not_end_like_those_of_a_runtime() {
    for header in ["ctl.h", "ctl_fb.h"] {
        let text =
            std::fs::read_to_string(root().join("controller-capi/include").join(header)).expect("the header");
        for word in text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_') {
            assert!(!word.ends_with("_setup") && !word.ends_with("_loop"), "{word}");
        }
    }
}

#[test]
fn an_independent_front_end_accepts_the_declarations() {
    for block in both() {
        let text = &block.without_pragma;
        let parsed = iec61131::Parser::new(text).parse();
        assert!(parsed.is_ok(), "{}: {:?}", block.name, parsed.err());
        // It does read what it is given.
        let broken = text.replacen(" : DINT", " : ", 1);
        assert!(broken != *text && iec61131::Parser::new(&broken).parse().is_err());
    }
}

/// The program for a block, in a file.
fn source(block: &Block) -> PathBuf {
    program::write(&format!("{}.c", block.name), &generated::program(block))
}

/// Compares what a program gives with what Rust gives.
fn replays<T: Fb>(seeds: std::ops::Range<u64>, calls: u32, run: impl Fn(&str) -> String) {
    let mut seen = (0, 0);
    for seed in seeds.clone() {
        let trace = trace::Trace::<T>::random(seed, calls);
        let output = run(&trace.script);
        for (line, (ours, theirs)) in trace.expected.lines().zip(output.lines()).enumerate() {
            assert_eq!(ours, theirs, "seed {seed}, line {line}: Rust left");
        }
        assert_eq!(trace.expected.lines().count(), output.lines().count());
        assert!(trace.running > calls / 2, "{}", trace.running);
        seen = (seen.0 | trace.seen.0, seen.1 | trace.seen.1);
    }
    // Every mode, and none while there is no loop; every bit but those of three alarms and of a lost state.
    assert!(seeds.end < 4 || seen == (0x1712_7FFF, 0xFF), "{:x} {:x}", seen.0, seen.1);
}

fn compiled<T: Fb>(compiler: Compiler, block: &Block, linked: program::Linked) {
    let program = program::compile(compiler, &source(block), linked);
    replays::<T>(0..4, 4000, |script| program::run(&program, script));
}

#[test]
fn gives_the_bits_of_the_block_called_from_rust() {
    let [single, double] = both();
    for compiler in available() {
        compiled::<f32>(compiler, &single, program::Linked::Archive);
        compiled::<f64>(compiler, &double, program::Linked::Archive);
    }
}

#[test]
fn one_object_file_is_enough() {
    for compiler in available() {
        compiled::<f32>(compiler, &block("CTL_LOOP"), program::Linked::Object);
    }
}

#[test]
fn gives_the_same_bits_on_an_emulated_cortex_m() {
    if program::has_board() {
        let [single, double] = both().map(|block| program::image(&source(&block)));
        replays::<f32>(0..2, 2000, |script| program::emulated(&single, script));
        replays::<f64>(0..2, 2000, |script| program::emulated(&double, script));
    }
}

#[test]
fn header_and_library_have_one_layout() {
    fn expected<T: Number>(variant: &str, out: &mut String) {
        for (field, kind, offset) in Vars::<T>::fields() {
            let size = match kind {
                Kind::Real => size_of::<T>(),
                Kind::Whole | Kind::Bits => 4,
                Kind::Flag => 1,
            };
            *out += &format!("{variant} {field} {offset} {size}\n");
        }
        *out += &format!("{variant} vars {}\n", size_of::<Vars<T>>());
    }
    for compiler in available() {
        let source = program::write("layout.c", &generated::layout());
        let output = program::run(&program::compile(compiler, &source, program::Linked::Archive), "");
        let mut text = String::new();
        expected::<f32>("f32", &mut text);
        expected::<f64>("f64", &mut text);
        text += "0 failures\n";
        assert_eq!(text, output);
    }
}
