//! An expression of the foreign tree as C of the type that its place asks for.
//!
//! Every operation is formed in the type of its operands: REAL with REAL is rounded to REAL at once. Nothing is
//! converted unasked: two types in one operation, or a whole number where a REAL is due, are faults.

use super::{Kind, Translator};
use iec61131::{Argument, BinaryOp, Expression, Literal, Token, UnaryOp, Variable};

type Code = Result<String, String>;

impl Translator {
    /// `value` as C of the type `due`.
    pub(super) fn expression(&mut self, value: &Expression, due: Kind) -> Code {
        match value {
            Expression::Literal(literal) => self.literal(literal, due),
            Expression::Variable(variable) => {
                let (place, kind) = self.place(variable)?;
                self.due(kind, due)?;
                Ok(place)
            }
            Expression::Parenthesized(inner) => {
                self.tokens.take(&Token::LParen)?;
                let inner = self.expression(inner, due)?;
                self.tokens.take(&Token::RParen)?;
                Ok(format!("({inner})"))
            }
            Expression::Unary { op, operand } => {
                let (token, sign) = match (op, due) {
                    (UnaryOp::Not, Kind::Bool) => (Token::Not, "!"),
                    (UnaryOp::Neg, Kind::Dint | Kind::Real | Kind::Lreal) => (Token::Minus, "-"),
                    _ => return Err(self.tokens.fault(&format!("{op:?} where {due:?} is due"))),
                };
                self.tokens.take(&token)?;
                Ok(format!("({sign}({}))", self.expression(operand, due)?))
            }
            Expression::Binary { op, left, right } => self.operation(*op, left, right, due),
            Expression::Call { function, arguments } => {
                let (from, to) = match function.as_str() {
                    "REAL_TO_LREAL" => (Kind::Real, Kind::Lreal),
                    "LREAL_TO_REAL" => (Kind::Lreal, Kind::Real),
                    _ => return Err(self.tokens.fault(&format!("the function {function}"))),
                };
                self.due(to, due)?;
                let [Argument::Positional(argument)] = arguments.as_slice() else {
                    return Err(self.tokens.fault("a conversion without its one argument"));
                };
                self.tokens.name(function)?;
                self.tokens.take(&Token::LParen)?;
                let argument = self.expression(argument, from)?;
                self.tokens.take(&Token::RParen)?;
                Ok(format!("(({}){argument})", to.name()))
            }
        }
    }

    fn operation(&mut self, op: BinaryOp, left: &Expression, right: &Expression, due: Kind) -> Code {
        use BinaryOp::{Add, And, Div, Eq, Ge, Gt, Le, Lt, Mul, Ne, Or, Sub};
        let (token, sign) = match op {
            Add => (Token::Plus, "+"),
            Sub => (Token::Minus, "-"),
            Mul => (Token::Star, "*"),
            Div => (Token::Slash, "/"),
            Eq => (Token::Equal, "=="),
            Ne => (Token::NotEqual, "!="),
            Lt => (Token::Less, "<"),
            Le => (Token::LessEqual, "<="),
            Gt => (Token::Greater, ">"),
            Ge => (Token::GreaterEqual, ">="),
            // Both sides are evaluated, as some translators do it.
            And => (Token::And, "&"),
            Or => (Token::Or, "|"),
            BinaryOp::Mod | BinaryOp::Power | BinaryOp::Xor => {
                return Err(self.tokens.fault(&format!("the operator {op:?}")));
            }
        };
        let operands = if compares(op) {
            self.due(Kind::Bool, due)?;
            // The standard ranks `<` above `=`; the parser does not, so that a row of them has no certain tree.
            if [left, right].iter().any(|side| matches!(side, Expression::Binary { op, .. } if compares(*op)))
            {
                return Err(self.tokens.fault("a comparison of comparisons without parentheses"));
            }
            let kind = self.kind(left).or_else(|| self.kind(right));
            kind.ok_or_else(|| self.tokens.fault("a comparison of two numbers"))?
        } else {
            due
        };
        let allowed = match op {
            And => operands == Kind::Bool,
            Or => matches!(operands, Kind::Bool | Kind::Dword),
            // A division of whole numbers has a remainder to answer for: no exported text has one.
            Div => matches!(operands, Kind::Real | Kind::Lreal),
            Add | Sub | Mul | Lt | Le | Gt | Ge => matches!(operands, Kind::Dint | Kind::Real | Kind::Lreal),
            _ => true,
        };
        if !allowed {
            return Err(self.tokens.fault(&format!("{op:?} of {operands:?}")));
        }
        let left = self.expression(left, operands)?;
        // `AND` has another spelling.
        if op != And || !self.tokens.skip(&Token::Ampersand) {
            self.tokens.take(&token)?;
        }
        let right = self.expression(right, operands)?;
        let kind = if compares(op) { Kind::Bool } else { operands };
        Ok(format!("(({})({left} {sign} {right}))", kind.name()))
    }

    fn literal(&mut self, literal: &Literal, due: Kind) -> Code {
        match (literal, due) {
            (Literal::Bool(is), Kind::Bool) => {
                self.tokens.take(if *is { &Token::True } else { &Token::False })?;
                Ok(u8::from(*is).to_string())
            }
            (Literal::Integer(_), Kind::Dint | Kind::Dword) => {
                let digits = self.tokens.whole()?;
                let (largest, suffix) = match due {
                    Kind::Dint => (u64::from(i32::MAX.unsigned_abs()), ""),
                    _ => (u64::from(u32::MAX), "u"),
                };
                match digits.parse::<u64>() {
                    Ok(value) if value <= largest => Ok(format!("{value}{suffix}")),
                    _ => Err(self.tokens.fault(&format!("{digits} is too large"))),
                }
            }
            (Literal::Real(_), Kind::Real | Kind::Lreal) => {
                let digits = self.tokens.decimal()?;
                let value: f64 = digits.parse().map_err(|_| self.tokens.fault("no number"))?;
                match due {
                    Kind::Real if (value as f32).is_finite() => Ok(format!("REAL_LITERAL({digits})")),
                    Kind::Lreal if value.is_finite() => Ok(digits),
                    _ => Err(self.tokens.fault(&format!("{digits} is too large"))),
                }
            }
            _ => Err(self.tokens.fault(&format!("{literal:?} where {due:?} is due"))),
        }
    }

    /// A variable or a cell as C, with its type.
    pub(super) fn place(&mut self, variable: &Variable) -> Result<(String, Kind), String> {
        match variable {
            Variable::Simple(name) => {
                self.tokens.name(name)?;
                match self.declared(name) {
                    Some((kind, None)) => Ok((self.c_name(name), kind)),
                    _ => Err(self.tokens.fault(&format!("{name} is no variable"))),
                }
            }
            Variable::ArrayAccess { base, indices } => {
                let (Variable::Simple(name), [index]) = (&**base, indices.as_slice()) else {
                    return Err(self.tokens.fault("an array of arrays"));
                };
                self.tokens.name(name)?;
                let Some((kind, Some((first, last)))) = self.declared(name) else {
                    return Err(self.tokens.fault(&format!("{name} is no array")));
                };
                self.tokens.take(&Token::LBracket)?;
                let index = self.expression(index, Kind::Dint)?;
                self.tokens.take(&Token::RBracket)?;
                Ok((format!("{}[cell({index}, {first}, {last})]", self.c_name(name)), kind))
            }
            Variable::MemberAccess { base, member } => self.member(base, member),
            other => Err(self.tokens.fault(&format!("the variable {other:?}"))),
        }
    }

    /// The type that a value has by itself: numbers and what is made of them alone have none.
    fn kind(&self, value: &Expression) -> Option<Kind> {
        match value {
            Expression::Literal(Literal::Bool(_)) => Some(Kind::Bool),
            Expression::Literal(_) => None,
            Expression::Variable(Variable::Simple(name)) => self.declared(name).map(|(kind, _)| kind),
            Expression::Variable(Variable::ArrayAccess { base, .. }) => match &**base {
                Variable::Simple(name) => self.declared(name).map(|(kind, _)| kind),
                _ => None,
            },
            Expression::Variable(Variable::MemberAccess { member, .. }) => self.member_kind(member),
            Expression::Variable(_) => None,
            Expression::Unary { operand, .. } => self.kind(operand),
            Expression::Parenthesized(inner) => self.kind(inner),
            Expression::Binary { op, .. } if compares(*op) => Some(Kind::Bool),
            Expression::Binary { left, right, .. } => self.kind(left).or_else(|| self.kind(right)),
            Expression::Call { function, .. } => match function.as_str() {
                "REAL_TO_LREAL" => Some(Kind::Lreal),
                "LREAL_TO_REAL" => Some(Kind::Real),
                _ => None,
            },
        }
    }

    pub(super) fn due(&self, kind: Kind, due: Kind) -> Result<(), String> {
        if kind == due { Ok(()) } else { Err(self.tokens.fault(&format!("{kind:?} where {due:?} is due"))) }
    }
}

fn compares(op: BinaryOp) -> bool {
    use BinaryOp::{Eq, Ge, Gt, Le, Lt, Ne};
    matches!(op, Eq | Ne | Lt | Le | Gt | Ge)
}
