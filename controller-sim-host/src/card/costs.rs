//! What a loop costs on an emulated board: the published table, built into the program.

use crate::simulate::Precision;
use controller_pil::board::Board;

/// The published table: instructions of a step, least and most over all inputs and over usual ones, bytes of law and state.
/// Written by `cargo xtask size --update`.
const TABLE: &str = include_str!("costs.csv");

/// Cells of the delay memory of a compensator in the table.
const CELLS: usize = 24;

/// What decides the cost of a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// A PID alone.
    Pid,
    /// A second-order ADRC.
    Adrc,
    /// A PID with a compensator of so many lags, shared sections and cells of delay memory.
    Compensated { lags: usize, shared: usize, cells: usize },
}

/// The cost of a step of a loop, and its memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cost {
    /// Most instructions of a step over all inputs; not known for every shape.
    pub(super) most: Option<usize>,
    /// Most instructions of a usual step: closed loop, good samples.
    pub(super) usual: Option<usize>,
    /// Law and state \[bytes\].
    pub(super) ram: usize,
}

/// A line of the table.
#[derive(Debug, Clone, Copy)]
struct Row {
    most: usize,
    usual: usize,
    ram: usize,
}

/// The cost of a loop of `shape` on `board`.
pub(super) fn cost(board: &Board, precision: Precision, shape: Shape) -> Option<Cost> {
    let (number, bytes) = match precision {
        Precision::F32 => ("f32", 4),
        Precision::F64 => ("f64", 8),
    };
    let row = |block: &str| row(board.name, block, number);
    let whole = |row: Row| Cost { most: Some(row.most), usual: Some(row.usual), ram: row.ram };
    let (lags, shared, cells) = match shape {
        Shape::Pid => return row("loop-pid").map(whole),
        Shape::Adrc => return row("loop-adrc").map(whole),
        Shape::Compensated { lags, shared, cells } => (lags, shared, cells),
    };
    // Blocks of other sizes differ from these by whole lags and sections.
    let [one, three, excess] = [row("dob-1")?, row("dob-3")?, row("de-2")?];
    let lag = (three.ram - one.ram) / 2;
    let section = excess.ram - one.ram - lag;
    let block = one.ram + lags.saturating_sub(1) * lag + shared * section;
    let ram = (row("loop-pid")?.ram + block + cells * bytes).saturating_sub(CELLS * bytes);
    let (observer, estimator) = (row("loop-pi-dob")?, row("loop-pid-de")?);
    let (most, usual) = match (lags, shared) {
        (1, 0) => (Some(observer.most), Some(observer.usual)),
        // A model of first order takes a few instructions less.
        (2, 1) | (1, 2) => (Some(estimator.most), Some(estimator.usual)),
        (2 | 3, 0) => (None, Some(observer.usual + three.usual - one.usual)),
        _ => (None, None),
    };
    Some(Cost { most, usual, ram })
}

fn row(board: &str, block: &str, number: &str) -> Option<Row> {
    TABLE.lines().skip(1).find_map(|line| {
        let mut cells = line.split(',');
        if [board, block, number].iter().any(|key| cells.next() != Some(key)) {
            return None;
        }
        let numbers: Vec<usize> = cells.map_while(|cell| cell.parse().ok()).collect();
        let &[_, most, _, usual, law, state] = &*numbers else { return None };
        Some(Row { most, usual, ram: law + state })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_pil::board::BOARDS;

    /// The sum of parts is what the table says of the whole loops.
    #[test]
    fn loops_of_the_table_come_out_as_they_stand_there() {
        for board in &BOARDS {
            for (precision, number) in [(Precision::F32, "f32"), (Precision::F64, "f64")] {
                for (block, lags, shared) in [("loop-pid-de", 2, 1), ("loop-pi-dob", 1, 0)] {
                    let shape = Shape::Compensated { lags, shared, cells: CELLS };
                    let cost = cost(board, precision, shape).expect("in the table");
                    let row = row(board.name, block, number).expect("in the table");
                    assert_eq!((cost.most, cost.usual, cost.ram), (Some(row.most), Some(row.usual), row.ram));
                }
                // The other blocks: their own memory with that of the loop.
                for (block, lags, shared) in [("de-1", 1, 2), ("dob-3", 3, 0)] {
                    let shape = Shape::Compensated { lags, shared, cells: CELLS };
                    let block = row(board.name, block, number).expect("in the table");
                    let pid = row(board.name, "loop-pid", number).expect("in the table");
                    let ram = cost(board, precision, shape).expect("in the table").ram;
                    assert_eq!(ram, pid.ram + block.ram);
                }
            }
        }
    }
}
