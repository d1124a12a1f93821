//! What must hold in a block before it may be printed.

use super::{Block, Expression, Initial, Operator, Place, Statement, Type, Variable};
use std::collections::HashMap;

/// Words that a variable must not be called, in any case of letters: keywords of IEC 61131-3, its types, operators of its
/// instruction list, standard functions and function blocks.
const RESERVED: &[&str] = &[
    "ABS",
    "ACOS",
    "ACTION",
    "ADD",
    "AND",
    "ANDN",
    "ANY",
    "ARRAY",
    "ASIN",
    "AT",
    "ATAN",
    "BOOL",
    "BY",
    "BYTE",
    "CAL",
    "CALC",
    "CALCN",
    "CASE",
    "CD",
    "CLASS",
    "CLK",
    "CONCAT",
    "CONFIGURATION",
    "CONSTANT",
    "CONTINUE",
    "COS",
    "CTD",
    "CTU",
    "CTUD",
    "CU",
    "D",
    "DATE",
    "DELETE",
    "DERIVATIVE",
    "DINT",
    "DIV",
    "DO",
    "DS",
    "DT",
    "DWORD",
    "ELSE",
    "ELSIF",
    "EN",
    "END",
    "ENO",
    "EQ",
    "EXIT",
    "EXP",
    "EXPT",
    "FALSE",
    "FIND",
    "FOR",
    "FROM",
    "FUNCTION",
    "FUNCTION_BLOCK",
    "F_EDGE",
    "F_TRIG",
    "GE",
    "GT",
    "HYSTERESIS",
    "IF",
    "IN",
    "INITIAL_STEP",
    "INSERT",
    "INT",
    "INTEGRAL",
    "INTERFACE",
    "INTERVAL",
    "JMP",
    "JMPC",
    "JMPCN",
    "L",
    "LD",
    "LDN",
    "LE",
    "LEFT",
    "LEN",
    "LIMIT",
    "LINT",
    "LN",
    "LOG",
    "LREAL",
    "LT",
    "LWORD",
    "MAX",
    "METHOD",
    "MID",
    "MIN",
    "MOD",
    "MOVE",
    "MUL",
    "MUX",
    "N",
    "NAMESPACE",
    "NE",
    "NIL",
    "NON_RETAIN",
    "NOT",
    "NULL",
    "OF",
    "ON",
    "OR",
    "ORN",
    "OVERRIDE",
    "P",
    "PID",
    "POINTER",
    "PRIORITY",
    "PROGRAM",
    "PT",
    "Q",
    "R",
    "R1",
    "RAMP",
    "READ_ONLY",
    "READ_WRITE",
    "REAL",
    "REF",
    "REF_TO",
    "REPEAT",
    "REPLACE",
    "RESOURCE",
    "RET",
    "RETAIN",
    "RETC",
    "RETCN",
    "RETURN",
    "RIGHT",
    "ROL",
    "ROR",
    "RS",
    "RTC",
    "R_EDGE",
    "R_TRIG",
    "S",
    "S1",
    "SD",
    "SEL",
    "SEMA",
    "SHL",
    "SHR",
    "SIN",
    "SINGLE",
    "SINT",
    "SL",
    "SQRT",
    "SR",
    "ST",
    "STEP",
    "STN",
    "STRING",
    "STRUCT",
    "SUB",
    "SUPER",
    "TAN",
    "TASK",
    "THEN",
    "THIS",
    "TIME",
    "TIME_OF_DAY",
    "TO",
    "TOD",
    "TOF",
    "TON",
    "TP",
    "TRANSITION",
    "TRUE",
    "TRUNC",
    "TYPE",
    "UDINT",
    "UINT",
    "ULINT",
    "UNTIL",
    "USING",
    "USINT",
    "VAR",
    "WHILE",
    "WITH",
    "WORD",
    "WSTRING",
    "XOR",
    "XORN",
];

impl Block {
    /// What is wrong with this block: names that are reserved, malformed, missing or double; an operation on numbers of two
    /// types; an assignment of another type, or with more than one operation; a condition with arithmetic. Empty for every
    /// block that is exported.
    #[must_use]
    pub fn faults(&self) -> Vec<String> {
        let mut faults: Vec<String> = Vec::new();
        let mut names = HashMap::new();
        for variable in &self.variables {
            faults.extend(declaration(variable));
            if names.insert(variable.name.to_uppercase(), variable).is_some() {
                faults.push(format!("{} is declared twice", variable.name));
            }
        }
        let mut check = Check { names, faults };
        check.all(&self.body);
        check.faults
    }
}

fn declaration(variable: &Variable) -> Vec<String> {
    let name = &variable.name;
    let mut faults = Vec::new();
    let plain = name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    let ends = name.starts_with(|c: char| c.is_ascii_uppercase()) && !name.ends_with('_');
    if !plain || !ends || name.contains("__") || name.len() > 24 {
        faults.push(format!("{name} is not a good name"));
    }
    if RESERVED.contains(&name.as_str()) {
        faults.push(format!("{name} is reserved"));
    }
    let numbers = matches!(variable.kind, Type::Real | Type::Long);
    let fits = match &variable.initial {
        Initial::Zero => true,
        Initial::Number(value) => numbers && value.is_finite() && variable.cells.is_none(),
        Initial::Count(_) => variable.kind == Type::Count && variable.cells.is_none(),
        Initial::Word(_) => variable.kind == Type::Word && variable.cells.is_none(),
        Initial::Flag(_) => variable.kind == Type::Flag && variable.cells.is_none(),
    };
    if !fits {
        faults.push(format!("{name} starts with what its type cannot hold"));
    }
    faults
}

struct Check<'a> {
    names: HashMap<String, &'a Variable>,
    faults: Vec<String>,
}

impl Check<'_> {
    fn fault(&mut self, what: String) {
        self.faults.push(what);
    }

    fn all(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Comment(words) => {
                    if !words.is_ascii() || words.contains("*)") || words.contains("(*") {
                        self.fault(format!("a comment that ends early: {words}"));
                    }
                }
                Statement::Assign(place, value) => {
                    let expected = match place {
                        Place::Variable(name) => self.variable(name, false),
                        Place::Cell(array, index) => {
                            self.index(index);
                            self.variable(array, true)
                        }
                    };
                    let given = match value {
                        Expression::Number(number) if number.is_finite() => {
                            expected.filter(|kind| matches!(kind, Type::Real | Type::Long))
                        }
                        Expression::Word(_) => Some(Type::Word),
                        _ => self.kind(value, true),
                    };
                    if expected != given {
                        self.fault(format!("{place:?} is given another type: {value:?}"));
                    }
                }
                Statement::If(branches, last) => {
                    for (condition, body) in branches {
                        if self.kind(condition, false) != Some(Type::Flag) {
                            self.fault(format!("no condition: {condition:?}"));
                        }
                        self.all(body);
                    }
                    self.all(last);
                }
                Statement::Repeat { counter, first, last, body } => {
                    self.index(counter);
                    if first > last {
                        self.fault(format!("{counter} runs backwards"));
                    }
                    self.all(body);
                }
            }
        }
    }

    fn variable(&mut self, name: &str, array: bool) -> Option<Type> {
        match self.names.get(name) {
            Some(variable) if variable.cells.is_some() == array => Some(variable.kind),
            _ => {
                self.fault(format!("{name} is not declared so"));
                None
            }
        }
    }

    fn index(&mut self, name: &str) {
        if self.variable(name, false) != Some(Type::Count) {
            self.fault(format!("{name} is no index"));
        }
    }

    /// The type of an expression that may or may not have one operation of arithmetic.
    fn kind(&mut self, value: &Expression, arithmetic: bool) -> Option<Type> {
        match value {
            Expression::Variable(name) => self.variable(name, false),
            Expression::Cell(array, index) => {
                self.index(index);
                self.variable(array, true)
            }
            Expression::Count(_) => Some(Type::Count),
            Expression::Number(_) | Expression::Word(_) => {
                self.fault(format!("a number within an expression: {value:?}"));
                None
            }
            Expression::Flag(_) => Some(Type::Flag),
            Expression::Not(a) => {
                let kind = self.kind(a, false);
                if kind != Some(Type::Flag) {
                    self.fault(format!("the opposite of what is not true or false: {value:?}"));
                }
                kind
            }
            Expression::Negative(_) => {
                self.fault("a sign that is no operation".to_owned());
                None
            }
            Expression::Convert(kind, a) => {
                let from = self.kind(a, false);
                let whole = matches!(**a, Expression::Variable(_));
                if !whole
                    || !matches!(
                        (from, kind),
                        (Some(Type::Real), Type::Long) | (Some(Type::Long), Type::Real)
                    )
                {
                    self.fault(format!("no conversion: {value:?}"));
                }
                Some(*kind)
            }
            Expression::Operation(operator, a, b) => {
                let nested = |side: &Expression| matches!(side, Expression::Operation(..));
                if operator.is_arithmetic() && (!arithmetic || nested(a) || nested(b)) {
                    self.fault(format!("more than one operation: {value:?}"));
                }
                let (left, right) = (self.kind(a, false), self.kind(b, false));
                if left != right {
                    self.fault(format!("two types in one operation: {value:?}"));
                }
                let wrong = match operator {
                    Operator::And => left != Some(Type::Flag),
                    Operator::Or => !matches!(left, Some(Type::Flag | Type::Word)),
                    _ => matches!(left, Some(Type::Flag | Type::Word)),
                };
                if wrong {
                    self.fault(format!("an operation that this type does not have: {value:?}"));
                }
                if operator.is_comparison() { Some(Type::Flag) } else { left }
            }
        }
    }
}
