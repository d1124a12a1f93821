//! Logs of real processes: tables in CSV as loggers, spreadsheets and control systems write them.
//!
//! * Cells are separated by `;`, tabs or `,`, or by spaces where there is nothing else; they may be in quotes. With
//!   `;`, tabs, spaces or in quotes a comma may be the decimal sign; the other one of point and comma parts thousands, and
//!   `1.098` is read as the numbers around it say, or refused where they do not.
//! * Above the table there may be comments (`#`, `%`, `//`), other text, a line with names and one with units.
//! * Times are numbers (seconds, unless the name or the unit says ms, min or h), clock times `12:30:05,5`, ISO date-times
//!   `2024-03-01T12:30:05.5+01:00`, or date-times with dots, `01.03.2024 12:30:05,5`, the day first; date and clock time may
//!   be in two columns next to each other. They may be at any distances and may stand still, never go back.
//! * Rows in which a cell that is needed is empty or no number are left out, and that is said; more than one in five is a
//!   fault.
//!
//! Columns are named by what stands above them, by their number from 1, or not at all: then by the [names](Role::usual)
//! that are usual, else by their order.

mod cells;
mod choose;
mod decode;
mod read;
mod sign;
mod time;

pub use choose::{Column, Role};
pub use decode::decode;
pub use read::{Log, read};
