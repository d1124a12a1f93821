//! Ctrl-C and the wish of the system that the program ends.

use super::EXIT_STOPPED;
use crate::output::remove_drafts;
use crate::simulate::Control;

/// The one control of this process: a signal has no other way to reach the runs.
static CONTROL: Control = Control::new();

/// From here on Ctrl-C stops the runs that are watched through the control, and a second one ends the program at once;
/// neither leaves a temporary file.
pub(super) fn control() -> &'static Control {
    if is_hangup_ignored() {
        return &CONTROL;
    }
    // Without a handler the system ends the program at once: a file that exists is untouched even so.
    let _ = ctrlc::set_handler(|| {
        if CONTROL.is_stopped() {
            remove_drafts();
            std::process::exit(i32::from(EXIT_STOPPED));
        }
        CONTROL.stop();
    });
    &CONTROL
}

/// Whether the program was started to outlive its terminal (`nohup`). A handler would take the place of that wish: all
/// signals that end a program share one.
fn is_hangup_ignored() -> bool {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return false };
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_some_and(|mask| mask & 1 == 1)
}
