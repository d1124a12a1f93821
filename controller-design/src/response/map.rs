//! What one element does to the loop: a linear map, found once and used for every element of that length.

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
pub(super) const TERMS: usize = 28;

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
        // Taylor coefficients of the states over the element, all columns at once.
        let mut term = Block::zeros(n, n + inputs);
        for j in 0..n {
            term.set(j, j, 1.0);
        }
        let outputs = [&loop_.k, &loop_.c];
        for k in 0..TERMS {
            let scale = term.largest();
            for j in 0..n + inputs {
                let (from, to) = (term.col(j), block.col_mut(j));
                if k > 0 {
                    to.iter_mut().zip(from).for_each(|(to, x)| *to += x);
                }
                for (signal, row) in outputs.iter().enumerate() {
                    let value: f64 = from.iter().zip(row.iter()).map(|(x, c)| x * c).sum();
                    let at = n + signal * NODES;
                    for (to, power) in to[at..at + NODES].iter_mut().zip(&nodes().powers[k]) {
                        *to += value * power;
                    }
                }
            }
            // The input's own series ends with the degree of its polynomial.
            if k >= NODES && scale < 1e-19 {
                break;
            }
            let mut next = equations.times(&term);
            if k < NODES {
                for j in 0..inputs {
                    let input = step * nodes().forward[k][j];
                    next.col_mut(n + j).iter_mut().zip(&loop_.b).for_each(|(next, b)| *next += b * input);
                }
            }
            next.scale(1.0 / (k as f64 + 1.0));
            term = next;
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
        // All rows of the first half, then of the second, both by the states and inputs of the whole.
        let mut first = Block::zeros(self.block.rows, n + inputs);
        let driven = nodes().finer.each_ref().map(|half| by_input.times(half));
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
