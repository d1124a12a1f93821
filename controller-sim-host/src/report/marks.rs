//! Events in a picture: a hairline each, with its number and, where there is room, its name.

use super::words;
use crate::scenario::Scenario;
use std::ops::RangeInclusive;

/// An event in the picture.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mark {
    /// Its number in the list of events, from 1.
    pub(super) number: usize,
    /// Its place, 0 at the left and 1 at the right.
    pub(super) share: f64,
    /// When \[s\].
    pub(super) at: f64,
    /// What it is called.
    pub(super) text: String,
    /// Line of the number from above; `None`: no room for it.
    pub(super) row: Option<usize>,
    /// There is room for the number on a wide page only.
    pub(super) wide: bool,
    /// There is room for its name beside the number on a wide page.
    pub(super) named: bool,
}

/// The picture's width \[px\] on a telephone: there the numbers must not touch.
const NARROW: f64 = 300.0;
/// The picture's width \[px\] from which on names are shown.
const WIDE: f64 = 590.0;
/// Width of a number \[px\].
const NUMBER: f64 = 20.0;
/// Width of a character of a name \[px\].
const CHARACTER: f64 = 6.3;
/// Most lines of numbers.
const ROWS: usize = 3;
/// Most marks; of more events those stay that are not hidden behind others.
const MOST: f64 = 400.0;
/// Longest name in a picture.
const NAME: usize = 34;

/// The marks of the events within `time` \[s\].
pub(super) fn marks(scenario: &Scenario, time: RangeInclusive<f64>) -> Vec<Mark> {
    let (from, to) = (*time.start(), *time.end());
    let mut marks: Vec<Mark> = Vec::new();
    // Where each row is free again, on a narrow page.
    let mut free = [f64::NEG_INFINITY; ROWS];
    let seen = || scenario.events.iter().enumerate().filter(|(_, event)| time.contains(&event.at));
    let crowded = seen().count() as f64 > MOST;
    for (index, event) in seen() {
        let share = (event.at - from) / (to - from);
        if crowded && marks.last().is_some_and(|last| share < last.share + 1.0 / MOST) {
            continue;
        }
        let left = share * NARROW;
        let row = free.iter().position(|free| left >= *free);
        let width = NUMBER + if index >= 99 { 8.0 } else { 0.0 };
        if let Some(row) = row {
            free[row] = left + width;
        }
        let text = words::cut(&words::event(scenario, event), NAME);
        marks.push(Mark { number: index + 1, share, at: event.at, text, row, wide: false, named: false });
    }
    for index in 0..marks.len() {
        let apart = |other: &Mark| (other.share - marks[index].share).abs() * WIDE >= NUMBER + 4.0;
        let free = |row: &usize| marks.iter().filter(|other| other.row == Some(*row)).all(apart);
        if marks[index].row.is_none()
            && let Some(row) = (0..ROWS).find(free)
        {
            (marks[index].row, marks[index].wide) = (Some(row), true);
        }
    }
    for index in 0..marks.len() {
        let mark = &marks[index];
        let next = marks[index + 1..].iter().find(|other| other.row == mark.row && mark.row.is_some());
        let end = 4.0 + mark.share * WIDE + NUMBER + mark.text.chars().count() as f64 * CHARACTER;
        marks[index].named = mark.row.is_some() && end < next.map_or(WIDE, |next| next.share * WIDE);
    }
    marks
}

/// Number of lines that the marks take.
pub(super) fn rows(marks: &[Mark]) -> usize {
    marks.iter().filter_map(|mark| mark.row).max().map_or(0, |row| row + 1)
}
