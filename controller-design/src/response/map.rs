//! What one element does to the loop: a linear map, found once and used for every element of that length.

use std::vec;
use std::vec::Vec;

use super::block::Block;
use super::nodes::{NODES, nodes};
use super::realisation::Realisation;

/// Rows: by how much the states change, then v at the nodes, then y at the nodes. Columns: the states at the start,
/// then the delayed v at the nodes (none without dead time).
///
/// Changes, because a step far shorter than the response changes next to nothing: `1 + 1e-12` would keep four digits
/// of a rate that is squared up again later.
#[derive(Debug, Clone)]
pub(super) struct Map {
    block: Block,
    pub(super) states: usize,
    /// So many of the states come as changes, the others (v of the last dead time) as they are.
    changes: usize,
}

/// Terms of the series at most; with a norm of 1/2 the 24th is far below the last bit.
const TERMS: usize = 28;

impl Map {
    /// The map of an element of `step`, which must be short: `step` times the norm of the equations at most 1/2.
    pub(super) fn short(loop_: &Realisation, step: f64) -> Self {
        let n = loop_.a.rows;
        let inputs = if loop_.delay > 0.0 { NODES } else { 0 };
        let mut block = Block::zeros(n + 2 * NODES, n + inputs);
        let mut equations = Block::zeros(n, n);
        for j in 0..n {
            for i in 0..n {
                // Without dead time the loop is closed here.
                let fed_back = if inputs == 0 { loop_.b[i] * loop_.k[j] } else { 0.0 };
                equations.set(i, j, step * (loop_.a.get(i, j) + fed_back));
            }
        }
        let mut next = vec![0.0; n];
        for j in 0..n + inputs {
            let mut powers: Vec<Vec<f64>> = vec![vec![0.0; n]];
            if j < n {
                powers[0][j] = 1.0;
            }
            for k in 0..TERMS {
                let Some(last) = powers.last() else { break };
                equations.apply(last, &mut next);
                if j >= n && k < NODES {
                    let input = step * nodes().forward[k][j - n];
                    next.iter_mut().zip(&loop_.b).for_each(|(next, b)| *next += b * input);
                }
                powers.push(next.iter().map(|x| x / (k as f64 + 1.0)).collect());
            }
            fill(loop_, &powers, block.col_mut(j));
        }
        Self { block, states: n, changes: n }
    }

    /// Rows of the result of [`apply`](Self::apply): states, then v, then y.
    pub(super) fn apply(&self, input: &[f64], output: &mut [f64]) {
        self.block.apply(input, output);
        for (end, start) in output.iter_mut().zip(input).take(self.changes) {
            *end += start;
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.block.is_finite()
    }

    /// The states at the end of an element with these rows.
    fn ends(&self, rows: &Block) -> Block {
        let mut ends = rows.select(0..self.states);
        for i in 0..self.changes {
            ends.set(i, i, ends.get(i, i) + 1.0);
        }
        ends
    }

    /// The map of an element twice as long, the delayed v one polynomial over all of it.
    pub(super) fn doubled(&self) -> Self {
        let n = self.states;
        let inputs = self.block.cols - n;
        let (by_state, by_input) = (self.block.columns(0..n), self.block.columns(n..n + inputs));
        let halves: [Block; 2] = core::array::from_fn(|half| {
            let mut finer = Block::zeros(inputs, inputs);
            for i in 0..inputs {
                for j in 0..inputs {
                    finer.set(i, j, nodes().halves[half][i][j]);
                }
            }
            finer
        });
        // All rows of the first half, then of the second, both by the states and inputs of the whole.
        let mut first = Block::zeros(self.block.rows, n + inputs);
        let driven = halves.each_ref().map(|half| by_input.times(half));
        for j in 0..n {
            first.col_mut(j).copy_from_slice(self.block.col(j));
        }
        for j in 0..inputs {
            first.col_mut(n + j).copy_from_slice(driven[0].col(j));
        }
        let mut second = by_state.times(&self.ends(&first));
        for j in 0..inputs {
            second.col_mut(n + j).iter_mut().zip(driven[1].col(j)).for_each(|(a, b)| *a += b);
        }
        Self { block: self.joined(&first, &second), ..*self }
    }

    /// The map over one dead time of states and v of the last dead time taken together, so that its powers are longer
    /// steps. Rows: these states at the end, v at the nodes, y at the nodes.
    pub(super) fn closed(&self) -> Self {
        let n = self.states;
        let memory = self.block.cols - n;
        let rows = (0..n + memory).chain(n..n + 2 * NODES);
        Self { block: self.block.select(rows), states: n + memory, changes: n }
    }

    /// Two steps of a closed map in one.
    pub(super) fn squared(&self) -> Self {
        let second = self.block.times(&self.ends(&self.block));
        Self { block: self.joined(&self.block, &second), ..*self }
    }

    /// The states over both halves, and every other node of both.
    fn joined(&self, first: &Block, second: &Block) -> Block {
        let mut whole = second.clone();
        for j in 0..whole.cols {
            for i in 0..self.changes {
                whole.set(i, j, first.get(i, j) + second.get(i, j));
            }
            for signal in 0..2 {
                let start = self.states + signal * NODES;
                for i in 0..NODES {
                    let (half, row) = if i <= 4 { (first, 2 * i) } else { (second, 2 * i - 8) };
                    whole.set(start + i, j, half.get(start + row, j));
                }
            }
        }
        whole
    }
}

/// A column of the map from the Taylor coefficients of the states over an element of length 1.
fn fill(loop_: &Realisation, powers: &[Vec<f64>], column: &mut [f64]) {
    let n = loop_.a.rows;
    let along = |row: &[f64]| -> Vec<f64> {
        powers.iter().map(|x| x.iter().zip(row).map(|(x, c)| x * c).sum()).collect()
    };
    for (i, change) in column.iter_mut().take(n).enumerate() {
        *change = powers.iter().skip(1).rev().map(|x| x[i]).sum();
    }
    for (signal, row) in [&loop_.k, &loop_.c].into_iter().enumerate() {
        let series = along(row);
        for i in 0..NODES {
            let x = i as f64 / 8.0;
            column[n + signal * NODES + i] = series.iter().rev().fold(0.0, |sum, c| sum * x + c);
        }
    }
}
