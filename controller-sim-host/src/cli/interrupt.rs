//! Ctrl-C and the wish of the system that the program ends.

use super::EXIT_STOPPED;
use crate::output::remove_drafts;
use crate::simulate::Control;

/// The one control of this process: a signal has no other way to reach the runs.
static CONTROL: Control = Control::new();

/// From here on Ctrl-C stops the runs that are watched through the control, and a second one ends the program at once;
/// neither leaves a temporary file.
pub(super) fn control() -> &'static Control {
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
