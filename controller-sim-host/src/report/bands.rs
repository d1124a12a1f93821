//! Modes and status as bands: what was in force when.

use super::panels::Loop;
use super::words;
use crate::simulate::Record;
use controller_core::{Mode, Status};

/// A row of the bands of one controller.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// What it shows.
    pub(super) label: &'static str,
    /// Its blocks.
    pub(super) blocks: Vec<Block>,
}

/// Bands in a row of a record, from the first to before the last, that have something in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) first: usize,
    pub(super) end: usize,
    /// What stands in it; empty: nothing.
    pub(super) text: &'static str,
    pub(super) class: &'static str,
}

/// The bands of one controller.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Bands {
    /// Its place in the order of controllers.
    pub(super) index: usize,
    pub(super) name: String,
    /// The only mode, when there is nothing else to show: it needs no band.
    pub(super) always: Option<&'static str>,
    /// Auto first, so that a short time in another mode lies above it.
    pub(super) modes: Vec<Block>,
    /// One for each status that occurs.
    pub(super) status: Vec<Row>,
}

/// What is shown of the status, in the order of the rows, with names that fit beside the picture.
const ROWS: [(Status, &str, &str); 19] = [
    (Status::LIMITED_HIGH, "limited hi", "limit"),
    (Status::LIMITED_LOW, "limited lo", "limit"),
    (Status::RATE_LIMITED, "rate limit", "limit"),
    (Status::INHIBITED, "inhibited", "limit"),
    (Status::SETPOINT_LIMITED, "r limited", "limit"),
    (Status::SETPOINT_RAMPING, "r ramping", "note"),
    (Status::BAD_INPUT, "bad input", "fault"),
    (Status::UNCERTAIN, "uncertain", "note"),
    (Status::HELD, "held", "fault"),
    (Status::FALLBACK, "fallback", "fault"),
    (Status::AWAITING_ACKNOWLEDGEMENT, "await ack.", "fault"),
    (Status::REJECTED, "rejected", "fault"),
    (Status::UNINITIALISED, "uninit.", "fault"),
    (Status::OVERRUN, "overrun", "fault"),
    (Status::ALARM_HI_HI, "alarm HH", "alarm"),
    (Status::ALARM_HI, "alarm H", "alarm"),
    (Status::ALARM_LO, "alarm L", "alarm"),
    (Status::ALARM_LO_LO, "alarm LL", "alarm"),
    (Status::ALARM_DEVIATION, "alarm dev.", "alarm"),
];

const MODES: [(Mode, &str); 7] = [
    (Mode::Auto, "m-auto"),
    (Mode::Cascade, "m-cascade"),
    (Mode::Manual, "m-manual"),
    (Mode::Track, "m-track"),
    (Mode::Hold, "m-hold"),
    (Mode::Off, "m-off"),
    (Mode::Fallback, "m-fallback"),
];

/// The bands of a controller; in a cascade those of the inner loop after them.
pub(super) fn bands(l: &Loop<'_>) -> Vec<Bands> {
    let mut list = vec![of(l.index, l.spec.name.clone(), l.record)];
    list.extend(l.inner.map(|record| of(l.index, format!("{}, inner loop", l.spec.name), record)));
    list
}

fn of(index: usize, name: String, record: &Record) -> Bands {
    let mut modes = Vec::new();
    for (mode, class) in MODES {
        let has = |i| record.has_mode(i, mode);
        runs(record.len(), has, |first, end| {
            modes.push(Block { first, end, text: words::mode(mode), class });
        });
    }
    let mut status = Vec::new();
    for (bit, label, class) in ROWS {
        let mut blocks = Vec::new();
        let has = |i| record.has_status(i, bit);
        runs(record.len(), has, |first, end| blocks.push(Block { first, end, text: "", class }));
        // The mode says it already.
        let said = bit == Status::FALLBACK && blocks.iter().all(|b| modes.iter().any(|m| is_fallback(m, b)));
        if !blocks.is_empty() && !said {
            status.push(Row { label, blocks });
        }
    }
    let always = match &*modes {
        [only] if only.first == 0 && only.end == record.len() && status.is_empty() => Some(only.text),
        _ => None,
    };
    let modes = if always.is_some() { Vec::new() } else { modes };
    Bands { index, name, always, modes, status }
}

fn is_fallback(mode: &Block, status: &Block) -> bool {
    mode.text == words::mode(Mode::Fallback) && (mode.first, mode.end) == (status.first, status.end)
}

/// Gives every longest run of bands that `holds` is true for.
fn runs(count: usize, holds: impl Fn(usize) -> bool, mut give: impl FnMut(usize, usize)) {
    let mut begun = None;
    for index in 0..=count {
        match (begun, index < count && holds(index)) {
            (None, true) => begun = Some(index),
            (Some(first), false) => {
                give(first, index);
                begun = None;
            }
            _ => {}
        }
    }
}
