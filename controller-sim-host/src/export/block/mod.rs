//! A function block as typed statements: what is exported before it is printed in a language.
//!
//! Every assignment of a number has at most one operation, so that a language can hardly give it another result: no order
//! of evaluation is left open, and a processor that works with more digits rounds after each operation.

mod build;
mod check;
mod expression;
mod fingerprint;

pub use build::{Builder, IN_FORCE};
pub use expression::{Expression, Operator, number, x};

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Type {
    /// True or false.
    Flag,
    /// A signed integer of 32 bits.
    Count,
    /// 32 bits.
    Word,
    /// The number type of the loop.
    Real,
    /// Double precision, whatever the loop runs in.
    Long,
}

/// What a variable is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Given by the caller before a sample; the only ones with a value of their own before the first sample.
    Input,
    /// Read by the caller after it.
    Output,
    /// A number that never changes.
    Constant,
    /// A whole number or a set of bits with a name; never changes.
    Named,
    /// A number of the law, changed only when the law is tuned.
    Coefficient,
    /// Kept from sample to sample.
    State,
    /// Used within one sample.
    Scratch,
}

/// What a variable begins with: an input by its declaration, every other one by a statement, when the design changes.
#[derive(Debug, Clone, PartialEq)]
pub enum Initial {
    /// Zero or false.
    Zero,
    /// A number.
    Number(f64),
    /// A whole number.
    Count(i32),
    /// Bits.
    Word(u32),
    /// True or false.
    Flag(bool),
}

/// A variable of a block.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Its name: letters, digits and single underscores.
    pub name: String,
    /// Its type; of an array, that of a cell.
    pub kind: Type,
    /// Number of cells of an array.
    pub cells: Option<usize>,
    /// What it is for.
    pub role: Role,
    /// What it begins with.
    pub initial: Initial,
    /// What it is, with its unit.
    pub comment: String,
}

/// Where an assignment goes.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// A variable.
    Variable(String),
    /// The cell of an array at the index that a variable holds.
    Cell(String, String),
}

/// A statement.
#[derive(Debug, Clone, PartialEq)]
pub enum Statement {
    /// Words for the reader.
    Comment(String),
    /// An assignment.
    Assign(Place, Expression),
    /// The first branch whose condition is true, else the last part.
    If(Vec<(Expression, Vec<Statement>)>, Vec<Statement>),
    /// For every value of a counter, both ends included.
    Repeat {
        /// The counter, a variable.
        counter: String,
        /// Its first value.
        first: i32,
        /// Its last value.
        last: i32,
        /// What is done for each.
        body: Vec<Statement>,
    },
}

/// A function block.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its name.
    pub name: String,
    /// Lines about the whole.
    pub head: Vec<String>,
    /// The number of the design: never 0, another one for other statements or values.
    pub design: i32,
    /// Its variables.
    pub variables: Vec<Variable>,
    /// What it does in one sample.
    pub body: Vec<Statement>,
}

impl Block {
    /// The variable of this name.
    #[must_use]
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }
}
