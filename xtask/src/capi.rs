//! What a C program links: the archive and one relocatable object for each target, which symbols they export, their sizes.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::ladder::Done;
use crate::packages;
use crate::setup::{self, Part};
use crate::shell::{Cmd, Outcome, in_ci, target_dir};

/// The package of the archive, and the archive.
const PACKAGE: &str = "controller-capi-staticlib";
const ARCHIVE: &str = "libctl.a";
/// The object, for build systems that take no archives.
const OBJECT: &str = "ctl.o";
const PROFILE: &str = "embedded";

const HEADER: &str = "controller-capi/include/ctl.h";
/// The header of the function block.
const BLOCK_HEADER: &str = "controller-capi/include/ctl_fb.h";
const EXAMPLE: &str = "controller-capi/examples/heater.c";

/// What a program calls at least.
const LEAST: [&str; 3] = ["ctl_config_default", "ctl_f32_init", "ctl_f32_step"];

/// The committed table of sizes.
const PAGE: &str = "controller-capi/SIZES.md";

/// The packages of Debian with what the tests of the C interface need: a question to a program, and what its answer contains
/// when it is there. A compiler that does not find a file gives its bare name back.
const PACKAGES: [(&str, [&str; 2], &str); 8] = [
    ("gcc", ["gcc", "--version"], ""),
    ("g++", ["g++", "--version"], ""),
    ("clang", ["clang", "--version"], ""),
    ("libclang-rt-dev", ["clang", "--print-file-name=libclang_rt.asan-x86_64.a"], "/"),
    ("valgrind", ["valgrind", "--version"], ""),
    ("gcc-arm-none-eabi", ["arm-none-eabi-gcc", "--version"], ""),
    ("libnewlib-arm-none-eabi", ["arm-none-eabi-gcc", "--print-file-name=rdimon.specs"], "/"),
    ("qemu-system-arm", ["qemu-system-arm", "--version"], ""),
];

/// A machine that the archive is shipped for.
struct Machine {
    /// For people.
    name: &'static str,
    /// The target of rustc; nothing: this machine.
    target: &'static str,
    gcc: &'static str,
    flags: &'static [&'static str],
}

const HOST: &str = "x86_64-unknown-linux-gnu";

const MACHINES: [Machine; 4] = [
    Machine { name: "x86-64", target: HOST, gcc: "gcc", flags: &[] },
    Machine {
        name: "Cortex-M4F, hard-float ABI",
        target: "thumbv7em-none-eabihf",
        gcc: "arm-none-eabi-gcc",
        flags: &["-mthumb", "-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"],
    },
    Machine {
        name: "Cortex-M4, soft-float ABI",
        target: "thumbv7em-none-eabi",
        gcc: "arm-none-eabi-gcc",
        flags: &["-mthumb", "-mcpu=cortex-m4", "-mfloat-abi=soft"],
    },
    Machine {
        name: "Cortex-M0",
        target: "thumbv6m-none-eabi",
        gcc: "arm-none-eabi-gcc",
        flags: &["-mthumb", "-mcpu=cortex-m0"],
    },
];

/// What to do with what is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Then {
    /// Compare it with the committed table.
    Check,
    /// Write the table.
    Update,
}

/// Installs what the tests of the C interface need, when it may; else says what is lacking.
pub(crate) fn ready(root: &Path) -> Option<String> {
    let names = missing(root);
    if names.is_empty() { None } else { packages::install(root, &names, || missing(root).is_empty()) }
}

/// The packages that are not there.
fn missing(root: &Path) -> Vec<&'static str> {
    let there = |[program, question]: [&str; 2], sign: &str| {
        Cmd::new(program, root).arg(question).probe().is_some_and(|answer| answer.contains(sign))
    };
    let absent = PACKAGES.iter().filter(|(_, question, sign)| !there(*question, sign));
    absent.map(|(package, ..)| *package).collect()
}

/// The rung.
pub(crate) fn rung(root: &Path) -> Outcome<Done> {
    let targets: Vec<String> = MACHINES.iter().map(|machine| machine.target.into()).collect();
    if let Some(message) = setup::lacking(root, Part::Target, &targets)? {
        return Ok(Done::Lacking(message));
    }
    let message = if in_ci() {
        ready(root)
    } else {
        let names = missing(root);
        (!names.is_empty()).then(|| format!("missing: {}; run: cargo xtask setup", names.join(", ")))
    };
    if let Some(message) = message {
        return Ok(if in_ci() { Done::Lacking(message) } else { Done::Skipped(message) });
    }
    let remark = run(root, Then::Check)?;
    if !TESTED.load(Ordering::Relaxed) {
        let tests = ["--test", "capi", "--test", "function_block"];
        Cmd::cargo(root).args(["test", "-p", "controller-tests"]).args(tests).run()?;
    }
    Ok(Done::Passed(remark))
}

/// Whether the tests that need compilers have passed in this run of the ladder, with all compilers there.
static TESTED: AtomicBool = AtomicBool::new(false);

/// All tests have passed: if no compiler was missing, those of the rung need not run again.
pub(crate) fn tested(root: &Path) {
    TESTED.store(missing(root).is_empty(), Ordering::Relaxed);
}

/// Builds everything into `capi/` of the target folder, checks its symbols, then does what is asked for with the sizes.
pub(crate) fn run(root: &Path, then: Then) -> Outcome<String> {
    let functions = functions(root)?;
    let mut rows = Vec::new();
    for machine in &MACHINES {
        rows.push(machine.ship(root, &functions)?);
    }
    let page = page(root, &rows)?;
    print!("{page}");
    let path = root.join(PAGE);
    match then {
        Then::Update => {
            std::fs::write(&path, page).map_err(|e| format!("cannot write {PAGE}: {e}"))?;
        }
        Then::Check => {
            let committed = std::fs::read_to_string(&path).unwrap_or_default();
            // With another compiler other sizes are right.
            let version = |text: &str| text.lines().find(|line| line.contains("rustc")).map(str::to_string);
            if committed.is_empty() || version(&committed) == version(&page) && committed != page {
                return Err(format!(
                    "{PAGE} says something else; if that is meant: cargo xtask capi --update"
                ));
            }
        }
    }
    Ok(format!("{} machines, {} functions, no other symbol", MACHINES.len(), functions.len()))
}

/// The functions that the headers declare.
fn functions(root: &Path) -> Outcome<Vec<String>> {
    let read = |header| std::fs::read_to_string(root.join(header)).map_err(|e| format!("{header}: {e}"));
    Ok([read(HEADER)?, read(BLOCK_HEADER)?].iter().flat_map(|text| declared(text)).collect())
}

fn declared(header: &str) -> Vec<String> {
    let prototypes = header.lines().filter(|line| line.ends_with(");") && !line.starts_with([' ', '/', '#']));
    let names = prototypes.filter_map(|line| line.split('(').next()?.split([' ', '*']).next_back());
    names.map(str::to_string).collect()
}

/// Sizes of what one machine gets, in bytes.
struct Row {
    name: &'static str,
    target: &'static str,
    /// Code and constants of the object, all functions.
    object: u64,
    /// The same with the functions for `float` alone.
    single: u64,
    /// The same with [`LEAST`] alone.
    least: u64,
}

impl Machine {
    fn ship(&self, root: &Path, functions: &[String]) -> Outcome<Row> {
        let target = target_dir(root);
        let cmd = Cmd::cargo(root).args(["build", "-p", PACKAGE, "--profile", PROFILE]);
        cmd.args(["--target", self.target]).run()?;
        let folder = target.join("capi").join(self.target);
        std::fs::create_dir_all(&folder).map_err(|e| format!("cannot create {}: {e}", folder.display()))?;
        let built = target.join(self.target).join(PROFILE).join(ARCHIVE);
        let archive = folder.join(ARCHIVE);
        std::fs::copy(&built, &archive).map_err(|e| format!("cannot copy {}: {e}", built.display()))?;

        let all: Vec<&str> = functions.iter().map(String::as_str).collect();
        let object = folder.join(OBJECT);
        self.object(root, &archive, &all, &object)?;
        let listed = symbols(root, &object)?;
        no_panic(&object, &listed)?;
        let exported = exported(&listed);
        let mut expected = functions.to_vec();
        expected.sort_unstable();
        if exported != expected {
            return Err(format!(
                "{} exports {exported:?}, the headers declare {expected:?}",
                object.display()
            ));
        }
        self.example(root, &archive, &all, &folder)?;
        let part = |file: &str, wanted: &dyn Fn(&str) -> bool| {
            let names: Vec<&str> = all.iter().copied().filter(|name| wanted(name)).collect();
            let object = folder.join(file);
            self.object(root, &archive, &names, &object)?;
            code(root, &object)
        };
        Ok(Row {
            name: self.name,
            target: self.target,
            object: code(root, &object)?,
            single: part("ctl-f32.o", &|name| !name.contains("_f64_"))?,
            least: part("ctl-f32-least.o", &|name| LEAST.contains(&name))?,
        })
    }

    /// One relocatable object with these functions and what they need.
    fn object(&self, root: &Path, archive: &Path, functions: &[&str], object: &Path) -> Outcome {
        Cmd::new(self.gcc, root)
            .args(self.flags)
            .args(["-r", "-nostdlib", "-Wl,--gc-sections", "-Wl,--strip-debug"])
            .args(functions.iter().map(|name| format!("-Wl,-u,{name}")))
            .arg(archive)
            .arg("-o")
            .arg(object)
            .run()
    }

    /// Links the example and all functions as a program; no symbol of a panic may be left, and no function missing.
    fn example(&self, root: &Path, archive: &Path, functions: &[&str], folder: &Path) -> Outcome {
        let image = folder.join("heater.elf");
        let board: &[&str] = if self.target == HOST {
            &[]
        } else {
            &[
                "--specs=rdimon.specs",
                "-Wl,--no-warn-execstack",
                "-T",
                "tests/c/board/board.ld",
                "tests/c/board/start.c",
            ]
        };
        Cmd::new(self.gcc, root)
            .args(self.flags)
            .args(["-Os", "-Wl,--gc-sections", "-I", "controller-capi/include", EXAMPLE])
            .args(functions.iter().map(|name| format!("-Wl,-u,{name}")))
            .args(board)
            .arg(archive)
            .arg("-o")
            .arg(&image)
            .run()?;
        let symbols = symbols(root, &image)?;
        let defined = exported(&symbols);
        if let Some(missing) = functions.iter().find(|name| !defined.iter().any(|symbol| symbol == *name)) {
            return Err(format!("{missing} is not in {}", image.display()));
        }
        no_panic(&image, &symbols)
    }
}

/// That nothing of a panic, or of the text of one, is in a file.
fn no_panic(file: &Path, symbols: &str) -> Outcome {
    let panics: Vec<&str> = symbols.lines().filter(|line| is_of_a_panic(line)).collect();
    if panics.is_empty() {
        Ok(())
    } else {
        Err(format!("{} can panic:\n{}", file.display(), panics.join("\n")))
    }
}

fn is_of_a_panic(line: &str) -> bool {
    ["panic", "core3fmt", "unwrap_failed", "expect_failed", "_fail_"].iter().any(|part| line.contains(part))
}

fn symbols(root: &Path, file: &Path) -> Outcome<String> {
    // Of LLVM and the others this one alone reads no bytecode that lies beside the code.
    Cmd::new("readelf", root)
        .arg("-sW")
        .arg(file)
        .probe()
        .ok_or_else(|| format!("no symbols in {}", file.display()))
}

/// The names that another object sees, sorted.
fn exported(symbols: &str) -> Vec<String> {
    let mut names: Vec<String> = symbols
        .lines()
        .filter_map(|line| {
            // Number, value, size, type, binding, visibility, section, name.
            match line.split_whitespace().collect::<Vec<_>>()[..] {
                [_, _, _, _, "GLOBAL" | "WEAK", "DEFAULT" | "PROTECTED", section, name]
                    if section != "UND" =>
                {
                    Some(name.to_string())
                }
                _ => None,
            }
        })
        .collect();
    names.sort_unstable();
    names
}

/// Code and constants of a file: the bytes it takes in a read-only memory.
fn code(root: &Path, file: &Path) -> Outcome<u64> {
    let text = Cmd::new("readelf", root).arg("-SW").arg(file).probe();
    text.map(|text| allocated(&text)).ok_or_else(|| format!("no sections in {}", file.display()))
}

/// Sum of the sections that are in memory and have contents, but for what serves to unwind a stack.
fn allocated(sections: &str) -> u64 {
    let size = |line: &str| {
        let (_, rest) = line.split_once(']')?;
        let words: Vec<&str> = rest.split_whitespace().collect();
        // Name, type, address, offset, size, entry size, flags ..
        let [name, kind, _, _, size, _, flags, ..] = words[..] else { return None };
        let unwinding = name.contains("eh_frame") || name.contains("ARM.ex") || name.contains("note");
        let counts = kind == "PROGBITS" && flags.contains('A') && !unwinding;
        u64::from_str_radix(size, 16).ok().filter(|_| counts)
    };
    sections.lines().filter_map(size).sum()
}

/// The numbers of a macro in the header that is one.
fn number(header: &str, name: &str) -> Option<u64> {
    let line = header.lines().find_map(|line| line.strip_prefix("#define ")?.strip_prefix(name))?;
    line.split(|c: char| !c.is_ascii_digit()).find(|word| word.len() > 1)?.parse().ok()
}

fn page(root: &Path, rows: &[Row]) -> Outcome<String> {
    let version = Cmd::new("rustc", root).arg("--version").capture()?;
    let header = std::fs::read_to_string(root.join(HEADER)).map_err(|e| format!("{HEADER}: {e}"))?;
    let mut text = format!(
        "# Sizes\n\nWritten by `cargo xtask capi --update` with {}, profile `{PROFILE}`. Bytes of code and constants, without \
         tables for unwinding, with the arithmetic of `double` where the machine has none. In RAM are the blocks alone.\n\n\
         | machine | target | `ctl.o`, all functions | those for `float` | `init` and `step` for `float` |\n\
         |---|---|---:|---:|---:|\n",
        version.trim()
    );
    for row in rows {
        let Row { name, target, object, single, least } = row;
        text.push_str(&format!("| {name} | `{target}` | {object} | {single} | {least} |\n"));
    }
    text.push_str("\n| block | bytes |\n|---|---:|\n");
    let value = |name: &str| number(&header, name).ok_or_else(|| format!("{HEADER} defines no {name}"));
    for (real, cell) in [("F32", 4), ("F64", 8)] {
        let without = value(&format!("CTL_{real}_SIZE_WITHOUT_COMPENSATOR"))?;
        let with = value(&format!("CTL_{real}_SIZE(delay)"))?;
        let name = real.to_lowercase();
        text.push_str(&format!("| `{name}`, never a compensator | {without} |\n"));
        text.push_str(&format!(
            "| `{name}`, with room for a compensator and a delay of n samples | {with} + {cell}(n + 1), in whole words of 8 |\n"
        ));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_a_header_are_found() {
        let header = "/* ctl_not(this); */\n#define X(a) f(a);\nuint32_t ctl_abi_version(void);\n\
                      const char *ctl_error_text(int32_t code);\nsize_t ctl_f32_size(uint32_t delay);\n";
        assert_eq!(declared(header), ["ctl_abi_version", "ctl_error_text", "ctl_f32_size"]);
    }

    #[test]
    fn hidden_and_undefined_symbols_are_not_exported() {
        let text = "   Num:    Value  Size Type    Bind   Vis      Ndx Name\n\
                     1: 0000     4 FUNC    GLOBAL DEFAULT    5 ctl_b\n\
                     2: 0000     4 FUNC    WEAK   HIDDEN     5 __aeabi_dadd\n\
                     3: 0000     0 NOTYPE  GLOBAL DEFAULT  UND memcpy\n\
                     4: 0000     4 FUNC    LOCAL  DEFAULT    5 inner\n\
                     5: 0000     4 FUNC    WEAK   DEFAULT    5 ctl_a\n";
        assert_eq!(exported(text), ["ctl_a", "ctl_b"]);
    }

    #[test]
    fn what_belongs_to_a_panic_is_known() {
        for name in [
            "_ZN4core9panicking5panic17h0E",
            "_ZN4core3fmt9Formatter3pad17h0E",
            "rust_panic",
            "_RNvCs_4core6option13unwrap_failed",
        ] {
            assert!(is_of_a_panic(name), "{name}");
        }
        assert!(!is_of_a_panic("ctl_f32_step") && !is_of_a_panic("_ZN15controller_core4step17h0E"));
    }

    #[test]
    fn sizes_are_those_of_what_is_loaded() {
        let text = "  [ 1] .text             PROGBITS        00000000 000034 000120 00  AX  0   0  4\n\
                    [ 2] .rodata.x         PROGBITS        00000000 000154 000010 00   A  0   0  4\n\
                    [ 3] .bss              NOBITS          00000000 000164 000100 00  WA  0   0  4\n\
                    [ 4] .eh_frame         PROGBITS        00000000 000164 000040 00   A  0   0  4\n\
                    [ 5] .debug_info       PROGBITS        00000000 000164 000040 00      0   0  1\n";
        assert_eq!(allocated(text), 0x130);
    }

    #[test]
    fn numbers_of_macros_are_read() {
        let header = "#define CTL_F32_SIZE(delay) (832 + ((delay) + 2) / 2 * 8)\n#define CTL_F32_ALIGN 8\n#define CTL_X 640\n";
        assert_eq!(number(header, "CTL_F32_SIZE(delay)"), Some(832));
        assert_eq!(number(header, "CTL_X"), Some(640));
        assert_eq!(number(header, "CTL_Y"), None);
    }
}
