//! The emulator: one process with one image, two named pipes, a time limit.

use super::Target;
use super::link::{Link, LinkError};
use controller_pil::frame::{FRAME, Header};
use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The emulator's program.
pub(super) const QEMU: &str = "qemu-system-arm";
/// Every instruction takes 2^7 ns of the board's time, and waiting takes none of ours.
const CLOCK: &str = "shift=7,sleep=off,align=off";
/// Longest wait for an answer; the first one takes the start of the emulator, on a busy machine too.
const LIMIT: Duration = Duration::from_secs(20);
/// Time between two looks at the emulator.
const EVERY: Duration = Duration::from_millis(20);
/// Time for the image to end by itself.
const GRACE: Duration = Duration::from_secs(2);

/// A running emulator. It is gone when this is dropped.
#[derive(Debug)]
pub(super) struct Emulator {
    /// Closed at the end, so that the image sees that nobody is left.
    requests: Option<File>,
    answers: File,
    /// Odd while an answer is waited for.
    turns: Arc<AtomicU64>,
    doorstop: Doorstop,
    end: Option<Sender<()>>,
    watch: Option<JoinHandle<String>>,
    folder: Option<Folder>,
}

/// Our own other end of the pipes: while it is open, to open them waits for nobody, and nobody sees an end of them. The
/// watch takes it away when the emulator has gone, so that whoever reads wakes up.
type Doorstop = Arc<Mutex<Option<[File; 2]>>>;

fn take_away(doorstop: &Doorstop) {
    *doorstop.lock().unwrap_or_else(PoisonError::into_inner) = None;
}

impl Emulator {
    pub(super) fn start(target: &Target) -> Result<Self, LinkError> {
        let failed = |what: &str, error: &dyn std::fmt::Display| LinkError(format!("{what}: {error}"));
        let folder = Folder::new().map_err(|e| failed("cannot make a folder for the pipes", &e))?;
        let pipes = ["requests", "answers"].map(|name| folder.0.join(name));
        let made = Command::new("mkfifo").args(&pipes).stdin(Stdio::null()).output();
        match made {
            Ok(output) if output.status.success() => {}
            Ok(output) => {
                return Err(failed("cannot make pipes", &String::from_utf8_lossy(&output.stderr).trim()));
            }
            Err(error) => return Err(failed("cannot make pipes: mkfifo", &error)),
        }
        let image = std::path::absolute(&target.image).map_err(|e| failed("the image", &e))?;
        let open = |pipe: &PathBuf, read, write| {
            let file = File::options().read(read).write(write).open(pipe);
            file.map_err(|e| failed("cannot open a pipe", &e))
        };
        let [requests, answers] = &pipes;
        let doorstop = [open(requests, true, true)?, open(answers, true, true)?];
        let (requests, answers) = (open(requests, false, true)?, open(answers, true, false)?);
        let mut command = Command::new(QEMU);
        command
            .args(["-M", target.board.name, "-display", "none", "-monitor", "none", "-serial", "none"])
            .args(target.board.emulator)
            .args(["-icount", CLOCK, "-semihosting-config"])
            .arg("enable=on,target=native,arg=pil,arg=requests,arg=answers")
            .arg("-kernel")
            .arg(image)
            .current_dir(&folder.0)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        // Ctrl-C is for this program, which then ends the emulator.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child = command.spawn().map_err(|e| failed(&format!("cannot start {QEMU}"), &e))?;
        let (end, ended) = channel();
        let turns = Arc::new(AtomicU64::new(0));
        let doorstop = Arc::new(Mutex::new(Some(doorstop)));
        let watch = Watch { child, turns: turns.clone(), doorstop: doorstop.clone(), ended };
        Ok(Self {
            requests: Some(requests),
            answers,
            turns,
            doorstop,
            end: Some(end),
            watch: Some(std::thread::spawn(move || watch.run())),
            folder: Some(folder),
        })
    }

    fn talk(&mut self, request: &[u8], answer: &mut [u8; FRAME]) -> std::io::Result<usize> {
        self.requests.as_ref().ok_or(std::io::ErrorKind::BrokenPipe)?.write_all(request)?;
        let mut filled = 0;
        loop {
            let more = self.answers.read(answer.get_mut(filled..).unwrap_or_default())?;
            if more == 0 {
                return Err(std::io::ErrorKind::UnexpectedEof.into());
            }
            filled += more;
            let header = Header::read(answer.get(..filled).unwrap_or_default());
            if header.is_some_and(|header| filled >= header.frame().min(FRAME)) {
                return Ok(filled);
            }
        }
    }
}

impl Link for Emulator {
    fn exchange(&mut self, request: &[u8], answer: &mut [u8; FRAME]) -> Result<usize, LinkError> {
        self.turns.fetch_add(1, Ordering::Relaxed);
        let outcome = self.talk(request, answer);
        self.turns.fetch_add(1, Ordering::Relaxed);
        if self.folder.is_some() {
            // Both sides have the pipes open: they need no names and no doorstop any more.
            take_away(&self.doorstop);
            self.folder = None;
        }
        outcome.map_err(|error| {
            // Who closed the pipe has said why, or the watch has ended it.
            self.end = None;
            let reason = self.watch.take().and_then(|watch| watch.join().ok());
            LinkError(reason.unwrap_or_else(|| format!("the emulator does not answer: {error}")))
        })
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        self.requests = None;
        take_away(&self.doorstop);
        self.end = None;
        if let Some(watch) = self.watch.take() {
            // A watch that failed has nothing to say here.
            let _ = watch.join();
        }
    }
}

/// Looks after the process, on a thread of its own.
struct Watch {
    child: Child,
    turns: Arc<AtomicU64>,
    doorstop: Doorstop,
    ended: Receiver<()>,
}

impl Watch {
    /// Until the emulator is gone; says why.
    fn run(mut self) -> String {
        let mut last = (0, Instant::now());
        loop {
            match self.ended.recv_timeout(EVERY) {
                Err(RecvTimeoutError::Timeout) => {}
                _ => return self.let_end(),
            }
            if let Ok(Some(_)) = self.child.try_wait() {
                return self.gone();
            }
            let turn = self.turns.load(Ordering::Relaxed);
            if turn != last.0 || turn.is_multiple_of(2) {
                last = (turn, Instant::now());
            } else if last.1.elapsed() > LIMIT {
                self.kill();
                take_away(&self.doorstop);
                return format!("the emulator did not answer for {} s", LIMIT.as_secs());
            }
        }
    }

    /// The image has been told to end, or nobody talks to it any more.
    fn let_end(mut self) -> String {
        let end = Instant::now() + GRACE;
        while Instant::now() < end {
            if let Ok(Some(_)) = self.child.try_wait() {
                return self.gone();
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        self.kill();
        self.gone()
    }

    fn kill(&mut self) {
        // One that has just ended by itself is as good.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// What the emulator has said at its end.
    fn gone(mut self) -> String {
        let mut said = String::new();
        if let Some(mut text) = self.child.stdout.take() {
            let _ = text.read_to_string(&mut said);
        }
        if let Some(mut text) = self.child.stderr.take() {
            let _ = text.read_to_string(&mut said);
        }
        let status = self.child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
        take_away(&self.doorstop);
        let said = said.trim();
        let more = if said.is_empty() { String::new() } else { format!(": {said}") };
        format!("the emulator ended ({status}){more}")
    }
}

/// A new folder in the one for temporary files, removed when this is dropped.
#[derive(Debug)]
struct Folder(PathBuf);

impl Folder {
    fn new() -> std::io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let mut tries = 0;
        loop {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let name = format!("controller-sim-{}-{number}", std::process::id());
            let path = std::env::temp_dir().join(name);
            tries += 1;
            match std::fs::create_dir(&path) {
                Ok(()) => return Ok(Self(path)),
                // Left by an earlier process with the same number.
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists && tries < 1000 => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
