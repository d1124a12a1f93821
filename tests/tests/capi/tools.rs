//! Compilers and tools: which are there, building a program against the archive, running it.

use crate::archive::archive;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{fs, io::Write};

/// A program that this machine may lack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tool {
    Gcc,
    Clang,
    ArmGcc,
    Qemu,
    Valgrind,
}

impl Tool {
    fn command(self) -> &'static str {
        match self {
            Self::Gcc => "gcc",
            Self::Clang => "clang",
            Self::ArmGcc => "arm-none-eabi-gcc",
            Self::Qemu => "qemu-system-arm",
            Self::Valgrind => "valgrind",
        }
    }
}

/// Says, past the test harness, which would swallow it, what this run leaves out.
pub(crate) fn not_run(what: &str) {
    // Nothing depends on whether it can be written.
    let _ = writeln!(std::io::stderr(), "\nnot run: {what}; `cargo xtask setup` installs it");
}

/// Those of the tools that are there; the others are named.
pub(crate) fn available(tools: &[Tool]) -> Vec<Tool> {
    let there = |tool: &Tool| {
        let found = Command::new(tool.command()).arg("--version").output().is_ok_and(|o| o.status.success());
        if !found {
            not_run(&format!("C interface with {}, which is missing", tool.command()));
        }
        found
    };
    tools.iter().copied().filter(there).collect()
}

/// The workspace.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests is a folder of the workspace")
}

/// Where what is built here goes.
pub(crate) fn folder() -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi");
    fs::create_dir_all(&path).expect("the folder can be created");
    path
}

/// Whether the compiler in use has the library for a target.
pub(crate) fn has_target(target: &str) -> bool {
    let sysroot = Command::new("rustc").args(["--print", "sysroot"]).current_dir(root()).output();
    let there = sysroot.is_ok_and(|output| {
        let path = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        path.join("lib/rustlib").join(target).is_dir()
    });
    if !there {
        not_run(&format!("C interface for {target}, whose library is missing"));
    }
    there
}

/// How programs are built.
pub(crate) struct Build<'a> {
    compiler: Tool,
    flags: &'a [&'a str],
}

impl<'a> Build<'a> {
    pub(crate) fn new(compiler: Tool, flags: &'a [&'a str]) -> Self {
        Self { compiler, flags }
    }

    /// The program of `tests/c` for one number type.
    pub(crate) fn program(&self, name: &str, variant: &str) -> PathBuf {
        let source = root().join(format!("tests/c/{name}.c"));
        let defined = format!("-DVARIANT={variant}");
        self.compile(&source, &format!("{name}-{variant}"), &["-std=c99", &defined])
    }

    /// A program of one source.
    pub(crate) fn compile(&self, source: &Path, name: &str, more: &[&str]) -> PathBuf {
        let marks: String = self.flags.concat().chars().filter(char::is_ascii_alphanumeric).collect();
        let program = folder().join(format!("{name}-{}-{marks}", self.compiler.command()));
        let mut command = self.command();
        command.args(more).arg(source).arg(archive(None)).arg("-lm").arg("-o").arg(&program);
        let output = command.output().expect("the compiler starts");
        assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
        program
    }

    fn command(&self) -> Command {
        let mut command = Command::new(self.compiler.command());
        command.args(["-Wall", "-Wextra", "-pedantic", "-Werror"]).args(self.flags);
        command.arg("-I").arg(root().join("controller-capi/include")).arg("-I").arg(root().join("tests/c"));
        command
    }

    /// Whether a program with these flags can be linked at all.
    pub(crate) fn links(&self) -> bool {
        let source = folder().join(format!("empty-{}.c", self.compiler.command()));
        fs::write(&source, "int main(void) { return 0; }\n").expect("the source can be written");
        let output = self.command().arg(&source).arg("-o").arg(source.with_extension("out")).output();
        output.is_ok_and(|o| o.status.success())
    }
}

/// A program of `tests/c` as an image for the emulated reference board.
pub(crate) fn image(name: &str, variant: &str, target: &str, flags: &[&str]) -> PathBuf {
    let c = |file: &str| root().join("tests/c").join(file);
    let program = folder().join(format!("{name}-{variant}-{target}.elf"));
    let mut command = Build::new(Tool::ArmGcc, flags).command();
    command
        .args(["-mthumb", "-std=c99", "-O2", &format!("-DVARIANT={variant}")])
        .args(["-ffunction-sections", "-Wl,--gc-sections", "-Wl,--no-warn-execstack"])
        // The C library that asks the debugger for its files: on the emulator those of this machine.
        .arg("--specs=rdimon.specs")
        .arg("-T")
        .arg(c("board/board.ld"))
        .args([c("board/start.c"), c(&format!("{name}.c")), archive(Some(target))])
        .arg("-o")
        .arg(&program);
    let output = command.output().expect("the compiler starts");
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    program
}

/// The static assertions of the layouts hold, and the headers have no warning.
pub(crate) fn checks(compiler: Tool, flags: &[&str]) {
    for source in ["tests/c/layout.c", "tests/c/layout_fb.c"] {
        let mut command = Build::new(compiler, flags).command();
        let output = command.arg("-fsyntax-only").arg(root().join(source)).output();
        let output = output.expect("the compiler starts");
        assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// What an image prints on the emulated board.
pub(crate) fn emulated(image: &Path, args: &[PathBuf]) -> String {
    let words: Vec<String> = args.iter().map(|path| format!(",arg={}", path.display())).collect();
    let semihosting = format!("enable=on,target=native,arg=image{}", words.concat());
    let mut runner = vec!["qemu-system-arm", "-M", "mps2-an386", "-display", "none", "-monitor", "none"];
    runner.extend(["-serial", "none", "-semihosting-config", &semihosting, "-kernel"]);
    run(image, &runner, &[])
}

/// What a program prints that ends well.
pub(crate) fn run(program: &Path, runner: &[&str], args: &[PathBuf]) -> String {
    let mut command = match runner {
        [first, rest @ ..] => {
            let mut command = Command::new(first);
            command.args(rest).arg(program);
            command
        }
        [] => Command::new(program),
    };
    let output = command.args(args).output().expect("the program starts");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let shown = text.lines().filter(|line| line.contains(':') || line.contains("failures"));
    let shown: Vec<&str> = shown.take(20).collect();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {}\n{}\n{errors}", output.status, shown.join("\n"));
    text
}

/// The last line of a program that checks says so.
pub(crate) fn passes(output: &str) {
    let verdict = output.lines().last().unwrap_or_default();
    let checks: u32 = verdict.split(' ').next().and_then(|n| n.parse().ok()).unwrap_or(0);
    assert!(checks > 300 && verdict.ends_with(", 0 failures"), "{verdict}");
}
