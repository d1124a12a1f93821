//! How far the runs are, for a person who waits.

use crate::simulate::Control;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Nothing is shown of what takes less.
const AFTER: Duration = Duration::from_secs(1);
/// Time between two looks.
const EVERY: Duration = Duration::from_millis(200);

/// Does `work` and shows on the terminal how much of `total` samples is done; nothing off a terminal, and nothing of what
/// takes less than a second.
pub(super) fn watch<T>(control: &Control, total: u64, quiet: bool, work: impl FnOnce() -> T) -> T {
    watch_count("samples", || control.done(), total, quiet, work)
}

/// [`watch`] for whatever `done` counts.
pub(super) fn watch_count<T>(
    what: &'static str,
    done: impl Fn() -> u64 + Send,
    total: u64,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    if quiet || !is_terminal() {
        return work();
    }
    let (finished, is_finished) = channel::<()>();
    thread::scope(|scope| {
        let shown = scope.spawn(move || {
            let mut wait = AFTER;
            let mut bar: Option<ProgressBar> = None;
            while is_finished.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                wait = EVERY;
                bar.get_or_insert_with(|| self::bar(total, what)).set_position(done());
            }
            if let Some(bar) = bar {
                bar.finish_and_clear();
            }
        });
        let result = work();
        drop(finished);
        // The line is gone before anything else is printed; a display that failed is no failure of the work.
        let _ = shown.join();
        result
    })
}

fn is_terminal() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Without colours: `NO_COLOR` has nothing to take away.
fn bar(total: u64, what: &'static str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {speed}  {left}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> ");
    let style = style
        .with_key("speed", move |state: &ProgressState, to: &mut dyn Write| {
            let _ = write!(to, "{} {what}/s", large(rate(state)));
        })
        .with_key("left", |state: &ProgressState, to: &mut dyn Write| {
            let rest = state.len().unwrap_or(0).saturating_sub(state.pos()) as f64;
            let _ = write!(to, "{} left", time(rest / rate(state)));
        });
    bar.set_style(style);
    // The work began before the bar was shown.
    bar.with_elapsed(AFTER)
}

/// Samples per second since the beginning: runs are even, and this does not jump.
fn rate(state: &ProgressState) -> f64 {
    state.pos() as f64 / state.elapsed().as_secs_f64().max(1e-3)
}

/// Three digits and a letter.
fn large(x: f64) -> String {
    match x {
        x if x >= 1e9 => format!("{:.2} G", x / 1e9),
        x if x >= 1e6 => format!("{:.2} M", x / 1e6),
        x if x >= 1e3 => format!("{:.0} k", x / 1e3),
        x if x >= 10.0 => format!("{x:.0}"),
        x => format!("{x:.1}"),
    }
}

/// Seconds as people say them; at most years.
fn time(left: f64) -> String {
    match left.clamp(0.0, 1e9).round() as u64 {
        s @ 0..60 => format!("{s} s"),
        s @ 60..3600 => format!("{} min {:02} s", s / 60, s % 60),
        s => format!("{} h {:02} min", s / 3600, s % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_and_times_are_short() {
        assert_eq!([0.43, 12.0, 4321.0, 1.234e6, 5.6e9].map(large), ["0.4", "12", "4 k", "1.23 M", "5.60 G"]);
        let shown = [5.2, 75.0, 3725.0].map(time);
        assert_eq!(shown, ["5 s", "1 min 15 s", "1 h 02 min"]);
    }

    #[test]
    fn the_work_is_done_without_a_terminal() {
        assert_eq!(watch(&Control::new(), 10, false, || 7), 7);
    }
}
