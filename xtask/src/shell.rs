//! Running commands: every command is printed before it runs, so that a person can repeat it by hand.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// What a step gives back: nothing, or a message for the person who reads the terminal.
pub(crate) type Outcome<T = ()> = Result<T, String>;

/// One command to run. Standard input is always closed: nothing here may wait for a person.
pub(crate) struct Cmd {
    program: OsString,
    args: Vec<OsString>,
    envs: Vec<(String, String)>,
    dir: PathBuf,
}

impl Cmd {
    /// A command that runs in `dir`.
    pub(crate) fn new(program: impl Into<OsString>, dir: &Path) -> Self {
        Self { program: program.into(), args: Vec::new(), envs: Vec::new(), dir: dir.to_path_buf() }
    }

    /// `cargo` in the workspace root.
    pub(crate) fn cargo(root: &Path) -> Self {
        Self::new("cargo", root)
    }

    /// Adds one argument.
    pub(crate) fn arg(mut self, arg: impl Into<OsString>) -> Self {
        self.args.push(arg.into());
        self
    }

    /// Adds several arguments.
    pub(crate) fn args<I>(mut self, args: I) -> Self
    where
        I: IntoIterator,
        I::Item: Into<OsString>,
    {
        self.args.extend(args.into_iter().map(Into::into));
        self
    }

    /// Sets a variable of the environment.
    pub(crate) fn env(mut self, key: &str, value: &str) -> Self {
        self.envs.push((key.into(), value.into()));
        self
    }

    /// Prints the command and runs it with its output on the terminal.
    pub(crate) fn run(&self) -> Outcome {
        println!("  $ {self}");
        let status = self.command().status().map_err(|e| self.not_started(&e))?;
        if status.success() { Ok(()) } else { Err(format!("`{self}` failed ({status})")) }
    }

    /// Prints the command, runs it and gives its standard output; standard error goes to the terminal.
    pub(crate) fn capture(&self) -> Outcome<String> {
        println!("  $ {self}");
        let output = self.command().stderr(Stdio::inherit()).output().map_err(|e| self.not_started(&e))?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        if output.status.success() {
            Ok(text)
        } else {
            // What it had printed is often the reason.
            print!("{text}");
            Err(format!("`{self}` failed ({})", output.status))
        }
    }

    /// Prints the command and runs it, whatever comes of it: whether it succeeded, and all it printed.
    pub(crate) fn attempt(&self) -> Outcome<(bool, String)> {
        self.ended().map(|(code, text)| (code == Some(0), text))
    }

    /// Prints the command and runs it, whatever comes of it: its exit code, and all it printed.
    pub(crate) fn ended(&self) -> Outcome<(Option<i32>, String)> {
        println!("  $ {self}");
        let output = self.command().output().map_err(|e| self.not_started(&e))?;
        let text = [output.stdout, output.stderr].concat();
        Ok((output.status.code(), String::from_utf8_lossy(&text).into_owned()))
    }

    /// Asks a question quietly: the output when the command succeeds, else nothing.
    pub(crate) fn probe(&self) -> Option<String> {
        let output = self.command().output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// The command as the standard library has it.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.args).current_dir(&self.dir).stdin(Stdio::null());
        // Set by the `cargo run` that started this program. A child must choose its own: with CARGO inherited,
        // `rustup run CHANNEL cargo ..` could mix the cargo of one toolchain with the compiler of another.
        for inherited in ["CARGO", "CARGO_MANIFEST_DIR", "CARGO_MANIFEST_PATH"] {
            command.env_remove(inherited);
        }
        command.envs(self.envs.iter().map(|(k, v)| (k, v)));
        command
    }

    fn not_started(&self, error: &std::io::Error) -> String {
        format!("`{self}` could not be started: {error}")
    }
}

impl std::fmt::Display for Cmd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (key, value) in &self.envs {
            write!(f, "{key}={} ", quoted(value))?;
        }
        write!(f, "{}", quoted(&self.program.to_string_lossy()))?;
        for arg in &self.args {
            write!(f, " {}", quoted(&arg.to_string_lossy()))?;
        }
        Ok(())
    }
}

/// The word as a shell wants it, so that a printed command can be pasted.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+./:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// The folder of the workspace: named by cargo, or found upwards from the current folder.
pub(crate) fn workspace_root() -> Outcome<PathBuf> {
    let is_root =
        |dir: &Path| dir.join("rust-toolchain.toml").is_file() && dir.join("xtask/Cargo.toml").is_file();
    let here = std::env::current_dir().map_err(|e| format!("no current folder: {e}"))?;
    let start = std::env::var_os("CARGO_MANIFEST_DIR").map_or(here, PathBuf::from);
    start.ancestors().find(|dir| is_root(dir)).map(Path::to_path_buf).ok_or_else(|| {
        "run this inside the workspace (no rust-toolchain.toml with an xtask folder found)".into()
    })
}

/// Where cargo puts what it builds.
pub(crate) fn target_dir(root: &Path) -> PathBuf {
    // `join` with an absolute path gives that path, with a relative one a path below the root, as cargo does.
    ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"]
        .iter()
        .find_map(std::env::var_os)
        .map_or_else(|| root.join("target"), |dir| root.join(dir))
}

/// Whether an automatic build runs this, by the variable that all of them set.
pub(crate) fn in_ci() -> bool {
    std::env::var("CI").is_ok_and(|v| !matches!(v.as_str(), "" | "0" | "false"))
}

/// A time as people read it: `0.4 s`, `12.3 s`, `4 min 05 s`.
pub(crate) fn human(time: Duration) -> String {
    // Round once, to tenths, so that 59.96 s does not print as `60.0 s`.
    let tenths = (time.as_secs_f64() * 10.0).round() as u64;
    if tenths < 600 {
        format!("{}.{} s", tenths / 10, tenths % 10)
    } else {
        let seconds = (tenths + 5) / 10;
        format!("{} min {:02} s", seconds / 60, seconds % 60)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_commands_can_be_pasted() {
        let here = Path::new(".");
        let cmd = Cmd::cargo(here).env("RUSTDOCFLAGS", "-D warnings").args(["doc", "--no-deps"]);
        assert_eq!(cmd.to_string(), "RUSTDOCFLAGS='-D warnings' cargo doc --no-deps");
        assert_eq!(quoted("profile.dev.opt-level=0"), "profile.dev.opt-level=0");
        assert_eq!(quoted("it's"), "'it'\\''s'");
        assert_eq!(quoted(""), "''");
    }

    #[test]
    fn a_command_that_is_not_there_is_an_error_not_a_panic() {
        let cmd = Cmd::new("no-such-program-anywhere", Path::new("."));
        assert!(cmd.probe().is_none());
        assert!(cmd.run().unwrap_err().contains("could not be started"));
    }

    #[test]
    fn times_read_well() {
        assert_eq!(human(Duration::from_millis(449)), "0.4 s");
        assert_eq!(human(Duration::from_millis(12_340)), "12.3 s");
        assert_eq!(human(Duration::from_millis(59_960)), "1 min 00 s");
        assert_eq!(human(Duration::from_secs(245)), "4 min 05 s");
    }
}
