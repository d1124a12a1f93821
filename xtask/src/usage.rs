//! What a command used: time of the processor and memory.

use std::process::Stdio;
use std::time::Duration;

use crate::shell::{Cmd, Outcome};

/// What one command used until its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Usage {
    /// Time of the processor, over all threads. Other programs on the machine disturb it far less than the clock.
    pub(crate) cpu: Duration,
    /// Most memory in use at one time \[kB\]; at least that of this program, which the system counts for its children.
    pub(crate) peak: u64,
}

/// Runs a command to its end with its output thrown away; an error when it fails.
pub(crate) fn measured(cmd: &Cmd) -> Outcome<Usage> {
    println!("  $ {cmd}");
    let child = cmd
        .command()
        .stdout(Stdio::null())
        .stderr(Stdio::inherit())
        .spawn()
        .map_err(|e| format!("`{cmd}` could not be started: {e}"))?;
    let (status, usage) = os::wait(child)?;
    if status == 0 { Ok(usage) } else { Err(format!("`{cmd}` failed (status {status})")) }
}

#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
mod os {
    use super::{Outcome, Usage};
    use std::ffi::{c_int, c_long};
    use std::process::Child;
    use std::time::Duration;

    /// `struct rusage` as the system writes it.
    #[repr(C)]
    #[derive(Default)]
    struct Raw {
        user: [c_long; 2],
        system: [c_long; 2],
        peak: c_long,
        rest: [c_long; 13],
    }

    // The standard library waits for a child, too, but keeps to itself what the child used.
    unsafe extern "C" {
        fn wait4(pid: c_int, status: *mut c_int, options: c_int, usage: *mut Raw) -> c_int;
    }

    pub(super) fn wait(child: Child) -> Outcome<(i32, Usage)> {
        let pid = c_int::try_from(child.id()).map_err(|e| e.to_string())?;
        let (mut status, mut raw) = (0, Raw::default());
        // SAFETY: both pointers are to live values of the types that the call writes. The child is not waited for
        // anywhere else: it was just started and is owned by this function.
        let got = unsafe { wait4(pid, &raw mut status, 0, &raw mut raw) };
        if got != pid {
            return Err(format!("cannot wait for process {pid}: {}", std::io::Error::last_os_error()));
        }
        let time = |[seconds, micros]: [c_long; 2]| {
            Duration::from_secs(seconds.unsigned_abs()) + Duration::from_micros(micros.unsigned_abs())
        };
        Ok((status, Usage { cpu: time(raw.user) + time(raw.system), peak: raw.peak.unsigned_abs() }))
    }
}

#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
mod os {
    use super::{Outcome, Usage};
    use std::process::Child;

    pub(super) fn wait(mut child: Child) -> Outcome<(i32, Usage)> {
        // Best effort: the message below is what matters.
        let _ = child.wait();
        Err("time and memory are measured on 64-bit Linux only".into())
    }
}

#[cfg(all(test, target_os = "linux", target_pointer_width = "64"))]
mod tests {
    use super::*;
    use std::path::Path;

    fn shell(line: &str) -> Cmd {
        Cmd::new("sh", Path::new(".")).args(["-c", line])
    }

    #[test]
    fn memory_of_a_child_is_seen() {
        let small = measured(&shell("true")).unwrap();
        // 32 MB of text in a variable.
        let large = measured(&shell("x=$(head -c 32000000 /dev/zero | tr '\\0' x); : ${#x}")).unwrap();
        assert!(small.peak > 100 && small.peak < 20_000, "{small:?}");
        assert!(large.peak > 32_000, "{large:?}");
    }

    #[test]
    fn time_of_a_child_is_seen() {
        let busy = measured(&shell("i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done")).unwrap();
        let idle = measured(&shell("sleep 0.05")).unwrap();
        assert!(busy.cpu > idle.cpu && idle.cpu < Duration::from_millis(50), "{busy:?} {idle:?}");
    }

    #[test]
    fn a_child_that_fails_is_an_error() {
        assert!(measured(&shell("exit 3")).unwrap_err().contains("failed"));
        assert!(measured(&Cmd::new("no-such-program", Path::new("."))).unwrap_err().contains("started"));
    }
}
