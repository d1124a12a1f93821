//! Compilers, the archive, programs.

use crate::archive::archive;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

/// Compilers that a runtime uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compiler {
    Gcc,
    Clang,
    /// Some runtimes compile the C of a block as C++.
    Gxx,
    /// With checks of every access to memory.
    Checked,
}

impl Compiler {
    pub(crate) fn command(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Gcc => ("gcc", &["-std=c99"]),
            Self::Clang => ("clang", &["-std=c99"]),
            Self::Gxx => ("g++", &["-std=gnu++11", "-x", "c++"]),
            Self::Checked => {
                ("gcc", &["-std=c99", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"])
            }
        }
    }
}

/// How the functions come into the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Linked {
    Archive,
    /// One relocatable object, for runtimes that take no library.
    Object,
}

/// The compilers that are there; the others are named.
pub(crate) fn available() -> Vec<Compiler> {
    let there = |compiler: &Compiler| {
        let name = compiler.command().0;
        let found = Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
        if !found {
            // Past the test harness, which would swallow it; nothing depends on whether it can be written.
            let _ = writeln!(
                std::io::stderr(),
                "\nnot run: the function block with {name} ({compiler:?}), which is missing; `cargo xtask setup` installs it"
            );
        }
        found
    };
    [Compiler::Gcc, Compiler::Clang, Compiler::Gxx, Compiler::Checked].into_iter().filter(there).collect()
}

/// The workspace.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests is a folder of the workspace")
}

/// Where what is built here goes.
pub(crate) fn folder() -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("function_block");
    fs::create_dir_all(&path).expect("the folder can be created");
    path
}

/// One build at a time; after a failure the others fail by themselves.
static BUILDING: Mutex<()> = Mutex::new(());

/// A source file with this text; it is not touched while something is built, nor when it is there already.
pub(crate) fn write(name: &str, text: &str) -> PathBuf {
    let _building = BUILDING.lock();
    let path = folder().join(name);
    if fs::read_to_string(&path).ok().as_deref() != Some(text) {
        fs::write(&path, text).expect("the source can be written");
    }
    path
}

/// The emulated board, a Cortex-M4F.
const TARGET: &str = "thumbv7em-none-eabihf";

/// Whether an image for the board can be built and run; what is missing is named.
pub(crate) fn has_board() -> bool {
    let sysroot = Command::new("rustc").args(["--print", "sysroot"]).current_dir(root()).output();
    let library = sysroot.is_ok_and(|output| {
        let path = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        path.join("lib/rustlib").join(TARGET).is_dir()
    });
    let answers = |name: &str| Command::new(name).arg("--version").output().is_ok_and(|o| o.status.success());
    let there = library && answers("arm-none-eabi-gcc") && answers("qemu-system-arm");
    if !there {
        let _ = writeln!(
            std::io::stderr(),
            "\nnot run: the function block on a Cortex-M4F: {TARGET}, arm-none-eabi-gcc or qemu-system-arm is missing; \
             `cargo xtask setup` installs it"
        );
    }
    there
}

/// An image of a program for the board.
pub(crate) fn image(source: &Path) -> PathBuf {
    let _building = BUILDING.lock();
    let archive = archive(Some(TARGET));
    let board = root().join("tests/c/board");
    let image = source.with_extension("elf");
    let mut command = Command::new("arm-none-eabi-gcc");
    command
        .args(["-mthumb", "-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-std=c99", "-O2"])
        .args(["-ffunction-sections", "-Wl,--gc-sections", "-Wl,--no-warn-execstack", "--specs=rdimon.specs"])
        .args(["-include", "ctl_fb.h", "-I"])
        .arg(root().join("controller-capi/include"))
        .arg("-T")
        .args([board.join("board.ld"), board.join("start.c"), source.to_path_buf(), archive])
        .arg("-o")
        .arg(&image);
    let output = command.output().expect("the compiler starts");
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    image
}

/// What an image prints on the board that reads `input` and ends well.
pub(crate) fn emulated(image: &Path, input: &str) -> String {
    let mut command = Command::new("qemu-system-arm");
    command
        .args(["-M", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-semihosting-config", "enable=on,target=native,arg=image", "-kernel"])
        .arg(image);
    output(command, image, input)
}

/// How iec/README.md tells to make the object.
pub(crate) const OBJECT: [&str; 6] = [
    "-r",
    "-nostdlib",
    "-Wl,--gc-sections",
    "-Wl,-u,ctl_f32_fb",
    "-Wl,-u,ctl_f64_fb",
    "-Wl,-u,ctl_fb_param_name",
];

/// One relocatable object.
fn object(archive: &Path) -> PathBuf {
    let path = folder().join("ctl_fb.o");
    let output = Command::new("gcc")
        .args(OBJECT)
        .arg(archive)
        .arg("-o")
        .arg(&path)
        .output()
        .expect("gcc links the object");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    path
}

/// Compiles and links a program.
pub(crate) fn compile(compiler: Compiler, source: &Path, linked: Linked) -> PathBuf {
    let _building = BUILDING.lock();
    let archive = archive(None);
    let library = if linked == Linked::Archive { archive } else { object(&archive) };
    let (name, flags) = compiler.command();
    let program = source.with_extension(format!("{compiler:?}-{linked:?}"));
    let mut command = Command::new(name);
    command.args(flags).args(["-O1", "-Wall", "-Wextra", "-Werror", "-include", "ctl_fb.h"]);
    command
        .arg("-I")
        .arg(root().join("controller-capi/include"))
        .arg(source)
        .args(["-x", "none"])
        .arg(library);
    let output = command.arg("-o").arg(&program).output().expect("the compiler starts");
    assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    program
}

/// What a program prints that reads `input` and ends well.
pub(crate) fn run(program: &Path, input: &str) -> String {
    output(Command::new(program), program, input)
}

fn output(mut command: Command, program: &Path, input: &str) -> String {
    let script = program.with_extension(format!("{:?}.txt", std::thread::current().id()));
    fs::write(&script, input).expect("the script can be written");
    let stdin = fs::File::open(&script).expect("the script can be read");
    let output = command.stdin(Stdio::from(stdin)).output().expect("the program starts");
    assert!(output.status.success(), "{command:?}: {}", output.status);
    String::from_utf8_lossy(&output.stdout).into_owned()
}
