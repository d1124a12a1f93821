//! Runs of HAL, one at a time.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// There is one HAL on a machine.
static HAL: Mutex<()> = Mutex::new(());

/// A folder to run in.
pub(crate) struct Session {
    archive: PathBuf,
    folder: PathBuf,
    _alone: MutexGuard<'static, ()>,
}

/// Where the component is.
pub(crate) fn component() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../controller-capi/hal")
}

impl Session {
    /// An empty folder; nothing when these tests are not asked for.
    pub(crate) fn open(name: &str) -> Option<Self> {
        let Some(archive) = std::env::var_os("CTL_ARCHIVE") else {
            // Written past the test harness, which would swallow it.
            let text = format!("not run: {name} in LinuxCNC's HAL; cargo xtask test --only hal\n");
            std::io::stderr().write_all(text.as_bytes()).expect("stderr can be written");
            return None;
        };
        let alone = HAL.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hal-runs").join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("a folder for the run");
        Some(Self { archive: archive.into(), folder, _alone: alone })
    }

    /// Writes a file that the run reads.
    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder.join(name), text).expect("the file can be written");
    }

    /// Runs commands of `halcmd`; gives what they print.
    pub(crate) fn run(&self, commands: &str) -> String {
        self.write("run.hal", commands);
        self.run_file(&self.folder.join("run.hal"))
    }

    /// Runs a file of commands; gives what they print.
    pub(crate) fn run_file(&self, file: &Path) -> String {
        let (succeeded, text) = self.attempt(file);
        assert!(succeeded, "HAL failed:\n{text}");
        text
    }

    /// Runs commands that may fail; gives whether they succeeded, and what they print.
    pub(crate) fn attempt_commands(&self, commands: &str) -> (bool, String) {
        self.write("run.hal", commands);
        self.attempt(&self.folder.join("run.hal"))
    }

    fn attempt(&self, file: &Path) -> (bool, String) {
        let output = Command::new("sh")
            .arg(component().join("run.sh"))
            .arg(file)
            .current_dir(&self.folder)
            .env("ARCHIVE", &self.archive)
            .env("BUILD", Path::new(env!("CARGO_TARGET_TMPDIR")).join("hal-module"))
            .env("SECONDS_AT_MOST", "40")
            .output()
            .expect("a shell");
        let text = [output.stdout, output.stderr].concat();
        (output.status.success(), String::from_utf8_lossy(&text).into_owned())
    }

    /// What `halsampler` has written, by words.
    pub(crate) fn rows(&self, name: &str) -> Vec<Vec<String>> {
        let text = std::fs::read_to_string(self.folder.join(name)).expect("the sampler's file");
        // A gap in the samples is the word `overrun` on a line of its own.
        assert!(!text.contains("overrun"), "samples are missing");
        text.lines().map(|line| line.split_whitespace().map(String::from).collect()).collect()
    }
}
