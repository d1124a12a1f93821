//! A compiled block: built with the system's C compiler, fed with records.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Says that a test needs what this machine has not; written past the test harness, which would swallow it.
pub(crate) fn not_run(what: &str, why: &str) {
    let text = format!("\nnot run: {what}: {why}\n");
    std::io::stderr().write_all(text.as_bytes()).expect("stderr can be written");
}

/// The system's C compiler, if there is one.
pub(crate) fn compiler() -> Option<&'static str> {
    ["gcc", "cc", "clang"].into_iter().find(|name| {
        Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
    })
}

/// A folder of this test process for a name.
pub(crate) fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("export_st");
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

/// Compiles `source` with `options`; gives the program.
pub(crate) fn compile(compiler: &str, name: &str, source: &str, options: &[&str]) -> PathBuf {
    let file = folder().join(format!("{name}.c"));
    let program = folder().join(format!("{name}{}", options.concat()));
    std::fs::write(&file, source).expect("the source can be written");
    let output = Command::new(compiler)
        .args(["-std=c11", "-Wall", "-Werror", "-ffp-contract=off", "-Wno-parentheses-equality"])
        .args(options)
        .arg("-o")
        .args([&program, &file])
        .output()
        .expect("the compiler can be started");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    program
}

/// Runs a program over records of doubles.
pub(crate) fn run(program: &Path, records: &[f64]) -> Vec<f64> {
    let bytes: Vec<u8> = records.iter().flat_map(|x| x.to_ne_bytes()).collect();
    let mut child = Command::new(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program can be started");
    let mut input = child.stdin.take().expect("its input");
    let writer = std::thread::spawn(move || input.write_all(&bytes).is_ok());
    let output = child.wait_with_output().expect("the program ends");
    assert!(writer.join().expect("written") && output.status.success(), "{}", program.display());
    let doubles = output.stdout.chunks_exact(8);
    doubles.map(|bytes| f64::from_ne_bytes(bytes.try_into().expect("eight bytes"))).collect()
}
