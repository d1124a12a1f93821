//! The emulator: one process, one image, a time limit.

use crate::log::Log;
use anyhow::{Context as _, ensure};
use controller_pil::board::Board;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The emulator's program.
const QEMU: &str = "qemu-system-arm";
/// Exit code of a run that the time limit ended.
const TOO_LONG: u8 = 124;
/// Exit code of a shell that finds no such program.
const NOT_FOUND: i32 = 127;
/// Most seconds that can be asked for: a year.
const MOST_SECONDS: u64 = 365 * 86_400;

/// Runs its words and ends with their exit code. When its standard input ends, which it does with whoever started it, even
/// if that was killed, they are ended, too: an emulator that nobody waits for would run for ever.
#[cfg(unix)]
const LEASH: &str = r#"
exec 3<&0 </dev/null
"$@" 3<&- &
run=$!
{ cat <&3; kill -9 $run; } >/dev/null 2>&1 &
watch=$!
exec 3<&-
wait $run
code=$?
kill $watch 2>/dev/null
exit $code
"#;
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
    ensure!(
        (1..=MOST_SECONDS).contains(&seconds),
        "EMULATE_SECONDS={seconds}: from 1 to {MOST_SECONDS} are possible"
    );
    let mut arguments = String::from("enable=on,target=native,arg=image");
    for word in words {
        // In this list a comma is written twice.
        arguments.push_str(",arg=");
        arguments.push_str(&word.replace(',', ",,"));
    }
    let mut child = leashed(QEMU)
        .args(["-M", board.name, "-display", "none", "-monitor", "none", "-serial", "none"])
        .args(board.emulator)
        .args(["-icount", CLOCK, "-semihosting-config", &arguments, "-kernel", path])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .with_context(cannot_start)?;
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
    ensure!(code != NOT_FOUND, cannot_start());
    // An image that failed says so by its own code, whatever became of its log.
    if code == 0 {
        copied?;
    }
    Ok(u8::try_from(code).unwrap_or(u8::MAX))
}

/// The program, bound to this process where there is a shell to do it.
fn leashed(program: &str) -> Command {
    #[cfg(unix)]
    {
        let mut command = Command::new("sh");
        command.args(["-c", LEASH, "sh", program]);
        command
    }
    #[cfg(not(unix))]
    Command::new(program)
}

fn cannot_start() -> String {
    format!("cannot start {QEMU}; `cargo xtask setup` installs it or says how")
}

fn stop(mut child: Child, seconds: u64) -> anyhow::Result<u8> {
    // Waiting closes its input, on which the shell ends the emulator.
    if cfg!(not(unix)) {
        child.kill()?;
    }
    child.wait()?;
    eprintln!("error: stopped after {seconds} s (EMULATE_SECONDS)");
    Ok(TOO_LONG)
}
