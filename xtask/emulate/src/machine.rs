//! The emulator: one process, one image, a time limit.

use crate::log::Log;
use anyhow::Context as _;
use controller_pil::board::Board;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The emulator's program.
const QEMU: &str = "qemu-system-arm";
/// Exit code of a run that the time limit ended.
const TOO_LONG: u8 = 124;
/// Seconds that an image may take if nobody says otherwise.
const SECONDS: u64 = 60;

/// Every instruction takes 2^7 ns of the board's time and waiting takes none of ours: timers and counts are the same in
/// every run, on every machine.
const CLOCK: &str = "shift=7,sleep=off,align=off";

/// Runs the image at `path` to its end; gives its exit code.
///
/// # Errors
/// When there is no emulator, or its output cannot be passed on.
pub(crate) fn run(board: &Board, path: &str, words: &[String], log: Log) -> anyhow::Result<u8> {
    let seconds = match std::env::var("EMULATE_SECONDS") {
        Ok(text) => text.parse().with_context(|| format!("EMULATE_SECONDS={text} is not a whole number"))?,
        Err(_) => SECONDS,
    };
    let mut arguments = String::from("enable=on,target=native,arg=image");
    for word in words {
        // In this list a comma is written twice.
        arguments.push_str(",arg=");
        arguments.push_str(&word.replace(',', ",,"));
    }
    let mut child = Command::new(QEMU)
        .args(["-M", board.name, "-display", "none", "-monitor", "none", "-serial", "none"])
        .args(board.emulator)
        .args(["-icount", CLOCK, "-semihosting-config", &arguments, "-kernel", path])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| format!("cannot start {QEMU}; `cargo xtask setup` installs it or says how"))?;
    let output = child.stdout.take().context("no output")?;
    let (finished, copied) = mpsc::channel();
    std::thread::spawn(move || {
        // Whoever waits has gone only when the program ends.
        let _ = finished.send(log.copy(output, std::io::stdout().lock()));
    });
    let end = Instant::now() + Duration::from_secs(seconds);
    let copied = match copied.recv_timeout(end.saturating_duration_since(Instant::now())) {
        Ok(copied) => copied,
        Err(_) => return stop(child, seconds),
    };
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if Instant::now() >= end {
            return stop(child, seconds);
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let code = status.code().context("the emulator was killed")?;
    // An image that failed says so by its own code, whatever became of its log.
    if code == 0 {
        copied?;
    }
    Ok(u8::try_from(code).unwrap_or(u8::MAX))
}

fn stop(mut child: Child, seconds: u64) -> anyhow::Result<u8> {
    child.kill()?;
    child.wait()?;
    eprintln!("error: stopped after {seconds} s (EMULATE_SECONDS)");
    Ok(TOO_LONG)
}
