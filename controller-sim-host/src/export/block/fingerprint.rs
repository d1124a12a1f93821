//! The number of a design: blocks with the same declarations and statements share it, others do not but by chance.

use super::{Expression, Initial, Place, Statement, Variable};

/// The number of these declarations and statements, without names of the block, heads and comments: FNV-1a of 32 bits,
/// from 1 to 2^31 - 1.
pub(super) fn number(variables: &[Variable], parts: [&Vec<Statement>; 2]) -> i32 {
    let mut sum = Sum(0x811C_9DC5);
    for variable in variables {
        sum.word(&variable.name);
        sum.bytes(&[variable.kind as u8, variable.role as u8]);
        sum.bytes(&variable.cells.map_or(0, |cells| cells as u64).to_le_bytes());
        match &variable.initial {
            Initial::Zero => sum.bytes(b"zero"),
            Initial::Number(value) => sum.expression(&Expression::Number(*value)),
            Initial::Count(n) => sum.expression(&Expression::Count(*n)),
            Initial::Word(bits) => sum.expression(&Expression::Word(*bits)),
            Initial::Flag(is) => sum.expression(&Expression::Flag(*is)),
        }
    }
    for part in parts {
        sum.statements(part);
    }
    i32::try_from(sum.0 & 0x7FFF_FFFF).unwrap_or(1).max(1)
}

struct Sum(u32);

impl Sum {
    fn bytes(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |sum, &byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    }

    /// A name, and an end that no name has.
    fn word(&mut self, name: &str) {
        self.bytes(name.as_bytes());
        self.bytes(&[0]);
    }

    fn statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Comment(_) => {}
                Statement::Assign(place, value) => {
                    match place {
                        Place::Variable(name) => self.word(name),
                        Place::Cell(array, index) => {
                            [array, index].into_iter().for_each(|name| self.word(name))
                        }
                    }
                    self.bytes(b":=");
                    self.expression(value);
                }
                Statement::If(branches, last) => {
                    for (condition, body) in branches {
                        self.bytes(b"if");
                        self.expression(condition);
                        self.statements(body);
                    }
                    self.bytes(b"else");
                    self.statements(last);
                    self.bytes(b"end");
                }
                Statement::Repeat { counter, first, last, body } => {
                    self.bytes(b"for");
                    self.word(counter);
                    [first, last].into_iter().for_each(|n| self.bytes(&n.to_le_bytes()));
                    self.statements(body);
                    self.bytes(b"end");
                }
            }
        }
    }

    fn expression(&mut self, value: &Expression) {
        match value {
            Expression::Variable(name) => self.word(name),
            Expression::Cell(array, index) => [array, index].into_iter().for_each(|name| self.word(name)),
            Expression::Count(n) => self.bytes(&n.to_le_bytes()),
            Expression::Number(value) => self.bytes(&value.to_bits().to_le_bytes()),
            Expression::Word(bits) => self.bytes(&bits.to_le_bytes()),
            Expression::Flag(is) => self.bytes(&[u8::from(*is)]),
            Expression::Operation(operator, a, b) => {
                self.bytes(&[*operator as u8]);
                self.expression(a);
                self.expression(b);
            }
            Expression::Not(a) => {
                self.bytes(b"not");
                self.expression(a);
            }
            Expression::Negative(a) => {
                self.bytes(b"minus");
                self.expression(a);
            }
            Expression::Convert(kind, a) => {
                self.bytes(&[b'c', *kind as u8]);
                self.expression(a);
            }
        }
    }
}
