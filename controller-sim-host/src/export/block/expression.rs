//! Expressions over the variables of a block.

use super::Type;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An operator with two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Sum.
    Add,
    /// Difference.
    Subtract,
    /// Product.
    Multiply,
    /// Quotient.
    Divide,
    /// `<`.
    Below,
    /// `<=`.
    AtMost,
    /// `>`.
    Above,
    /// `>=`.
    AtLeast,
    /// Equal.
    Is,
    /// Both.
    And,
    /// One or both; of words, the bits of both.
    Or,
}

impl Operator {
    /// Whether it makes a number of two numbers.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        matches!(self, Self::Add | Self::Subtract | Self::Multiply | Self::Divide)
    }

    /// Whether it makes a truth of two numbers.
    #[must_use]
    pub fn is_comparison(self) -> bool {
        matches!(self, Self::Below | Self::AtMost | Self::Above | Self::AtLeast | Self::Is)
    }
}

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// The value of a variable.
    Variable(String),
    /// The cell of an array at the index that a variable holds.
    Cell(String, String),
    /// A whole number.
    Count(i32),
    /// A number, of the type of the variable that it is assigned to; part of no operation.
    Number(f64),
    /// Bits; part of no operation.
    Word(u32),
    /// True or false.
    Flag(bool),
    /// An operator with its operands.
    Operation(Operator, Box<Expression>, Box<Expression>),
    /// The opposite of a truth.
    Not(Box<Expression>),
    /// The opposite number. A [`Builder`](super::Builder) makes a product of it: the sign of a zero is then beyond doubt.
    Negative(Box<Expression>),
    /// A number in another type.
    Convert(Type, Box<Expression>),
}

/// The variable `name`.
#[must_use]
pub fn x(name: &str) -> Expression {
    Expression::Variable(name.to_owned())
}

/// A whole number.
#[must_use]
pub fn number(n: i32) -> Expression {
    Expression::Count(n)
}

impl Expression {
    fn with(self, operator: Operator, other: Self) -> Self {
        Self::Operation(operator, Box::new(self), Box::new(other))
    }

    /// `self < other`.
    #[must_use]
    pub fn below(self, other: Self) -> Self {
        self.with(Operator::Below, other)
    }

    /// `self <= other`.
    #[must_use]
    pub fn at_most(self, other: Self) -> Self {
        self.with(Operator::AtMost, other)
    }

    /// `self > other`.
    #[must_use]
    pub fn above(self, other: Self) -> Self {
        self.with(Operator::Above, other)
    }

    /// `self >= other`.
    #[must_use]
    pub fn at_least(self, other: Self) -> Self {
        self.with(Operator::AtLeast, other)
    }

    /// Equal.
    #[must_use]
    pub fn is(self, other: Self) -> Self {
        self.with(Operator::Is, other)
    }

    /// Both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        self.with(Operator::And, other)
    }

    /// One or both.
    #[must_use]
    pub fn or(self, other: Self) -> Self {
        self.with(Operator::Or, other)
    }

    /// The opposite.
    #[must_use]
    pub fn opposite(self) -> Self {
        Self::Not(Box::new(self))
    }

    /// The same number in the type `kind`.
    #[must_use]
    pub fn to(self, kind: Type) -> Self {
        Self::Convert(kind, Box::new(self))
    }
}

macro_rules! arithmetic {
    ($($name:ident $method:ident $operator:ident;)*) => {$(
        impl $name for Expression {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.with(Operator::$operator, other)
            }
        }
    )*};
}

arithmetic! {
    Add add Add;
    Sub sub Subtract;
    Mul mul Multiply;
    Div div Divide;
}

impl Neg for Expression {
    type Output = Self;
    fn neg(self) -> Self {
        Self::Negative(Box::new(self))
    }
}
