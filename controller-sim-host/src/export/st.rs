//! A function block as Structured Text of IEC 61131-3.

use super::block::{Block, Expression, Initial, Operator, Place, Role, Statement, Type, Variable};
use crate::simulate::Precision;
use std::fmt::Write;

/// The file of a function block whose numbers are of the type `precision`.
#[must_use]
pub fn function_block(block: &Block, precision: Precision) -> String {
    let mut text = Text { out: String::new(), precision };
    text.line(0, &format!("FUNCTION_BLOCK {}", block.name));
    for line in &block.head {
        text.line(0, &format!("(* {line} *)"));
    }
    text.section(block, "VAR_INPUT", &[Role::Input]);
    text.section(block, "VAR_OUTPUT", &[Role::Output]);
    let own = [Role::Named, Role::Constant, Role::Coefficient, Role::State, Role::Scratch];
    text.section(block, "VAR", &own);
    text.line(0, "");
    text.all(&block.body, 0);
    text.line(0, "END_FUNCTION_BLOCK");
    text.out
}

/// The keyword of a type.
pub(super) fn keyword(kind: Type, precision: Precision) -> &'static str {
    match kind {
        Type::Flag => "BOOL",
        Type::Count => "DINT",
        Type::Word => "DWORD",
        Type::Long => "LREAL",
        Type::Real => match precision {
            Precision::F32 => "REAL",
            Precision::F64 => "LREAL",
        },
    }
}

/// The exact decimals: read as double precision, and then rounded to the type, they are `value` again.
pub(super) fn decimal(value: f64) -> String {
    let text = format!("{value:?}");
    match text.split_once('e') {
        None => text,
        Some((digits, exponent)) if digits.contains('.') => format!("{digits}E{exponent}"),
        Some((digits, exponent)) => format!("{digits}.0E{exponent}"),
    }
}

struct Text {
    out: String,
    precision: Precision,
}

impl Text {
    fn line(&mut self, depth: usize, words: &str) {
        if words.is_empty() {
            self.out.push('\n');
        } else {
            let _ = writeln!(self.out, "{:1$}{words}", "", 4 * depth);
        }
    }

    fn section(&mut self, block: &Block, opening: &str, roles: &[Role]) {
        let of = |role: Role| block.variables.iter().filter(move |v| v.role == role);
        let list: Vec<&Variable> = roles.iter().flat_map(|role| of(*role)).collect();
        if list.is_empty() {
            return;
        }
        self.line(0, opening);
        let mut last = None;
        for variable in list {
            let about = match variable.role {
                Role::Named => {
                    "codes and counts; all that follows takes its values by statements, at the beginning of the body"
                }
                Role::Constant => {
                    "numbers of the design: variables, so that no translator makes literals of them"
                }
                Role::Coefficient => "coefficients of the PID",
                Role::State => "state",
                Role::Scratch => "scratch of one sample",
                Role::Input | Role::Output => "",
            };
            if last != Some(variable.role) && !about.is_empty() {
                self.line(1, &format!("(* {about} *)"));
            }
            last = Some(variable.role);
            self.variable(variable);
        }
        self.line(0, "END_VAR");
    }

    fn variable(&mut self, variable: &Variable) {
        let kind = keyword(variable.kind, self.precision);
        let kind = match variable.cells {
            Some(cells) => format!("ARRAY [0..{}] OF {kind}", cells.saturating_sub(1)),
            None => kind.to_owned(),
        };
        let initial = match &variable.initial {
            Initial::Zero => String::new(),
            _ if variable.role != Role::Input => String::new(),
            Initial::Number(value) => format!(" := {}", decimal(*value)),
            Initial::Count(n) => format!(" := {n}"),
            // Not all front ends know numbers with a base.
            Initial::Word(bits) => format!(" := {bits}"),
            Initial::Flag(is) => format!(" := {}", truth(*is)),
        };
        let comment =
            if variable.comment.is_empty() { String::new() } else { format!(" (* {} *)", variable.comment) };
        self.line(1, &format!("{} : {kind}{initial};{comment}", variable.name));
    }

    fn all(&mut self, statements: &[Statement], depth: usize) {
        for statement in statements {
            self.statement(statement, depth);
        }
    }

    fn statement(&mut self, statement: &Statement, depth: usize) {
        match statement {
            Statement::Comment(words) => self.line(depth, &format!("(* {words} *)")),
            Statement::Assign(place, value) => {
                let place = match place {
                    Place::Variable(name) => name.clone(),
                    Place::Cell(array, index) => format!("{array}[{index}]"),
                };
                let value = self.expression(value, false);
                self.line(depth, &format!("{place} := {value};"));
            }
            Statement::If(branches, last) => {
                for (n, (condition, body)) in branches.iter().enumerate() {
                    let word = if n == 0 { "IF" } else { "ELSIF" };
                    let condition = self.expression(condition, false);
                    self.line(depth, &format!("{word} {condition} THEN"));
                    self.body(body, depth);
                }
                if !last.is_empty() {
                    self.line(depth, "ELSE");
                    self.body(last, depth);
                }
                self.line(depth, "END_IF;");
            }
            Statement::Repeat { counter, first, last, body } => {
                self.line(depth, &format!("FOR {counter} := {first} TO {last} DO"));
                self.body(body, depth);
                self.line(depth, "END_FOR;");
            }
        }
    }

    /// The statements of a branch; the language allows none without a statement.
    fn body(&mut self, body: &[Statement], depth: usize) {
        self.all(body, depth + 1);
        if body.iter().all(|statement| matches!(statement, Statement::Comment(_))) {
            self.line(depth + 1, ";");
        }
    }

    /// An expression, in parentheses if it is an operand.
    fn expression(&self, value: &Expression, operand: bool) -> String {
        match value {
            Expression::Variable(name) => name.clone(),
            Expression::Cell(array, index) => format!("{array}[{index}]"),
            Expression::Count(n) => n.to_string(),
            Expression::Number(value) => decimal(*value),
            Expression::Word(bits) => bits.to_string(),
            Expression::Flag(is) => truth(*is).to_owned(),
            Expression::Operation(operator, a, b) => {
                let sign = match operator {
                    Operator::Add => "+",
                    Operator::Subtract => "-",
                    Operator::Multiply => "*",
                    Operator::Divide => "/",
                    Operator::Below => "<",
                    Operator::AtMost => "<=",
                    Operator::Above => ">",
                    Operator::AtLeast => ">=",
                    Operator::Is => "=",
                    Operator::And => "AND",
                    Operator::Or => "OR",
                };
                let text = format!("{} {sign} {}", self.expression(a, true), self.expression(b, true));
                if operand { format!("({text})") } else { text }
            }
            Expression::Not(a) => format!("NOT ({})", self.expression(a, false)),
            // A block that is printed has none: its builder makes products of them.
            Expression::Negative(a) => format!("-({})", self.expression(a, false)),
            Expression::Convert(kind, a) => {
                let a = self.expression(a, false);
                // In parentheses of its own: some front ends take a name in a call for that of a parameter.
                match (self.precision, kind) {
                    (Precision::F32, Type::Long) => format!("REAL_TO_LREAL(({a}))"),
                    (Precision::F32, _) => format!("LREAL_TO_REAL(({a}))"),
                    (Precision::F64, _) => a,
                }
            }
        }
    }
}

pub(super) fn truth(is: bool) -> &'static str {
    if is { "TRUE" } else { "FALSE" }
}
