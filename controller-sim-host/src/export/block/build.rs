//! Puts a block together: sums and products of any depth become assignments of one operation each.

use super::{Block, Expression, Initial, Operator, Place, Role, Statement, Type, Variable, fingerprint, x};
use std::collections::{HashMap, HashSet};

/// A block under construction.
#[derive(Debug, Default)]
pub struct Builder {
    variables: Vec<Variable>,
    kinds: HashMap<String, Type>,
    /// Statements of the part that is being written, the outer ones before it.
    open: Vec<Vec<Statement>>,
    /// What stands before and behind the values of a new design.
    before: Vec<Statement>,
    after: Vec<Statement>,
    /// Scratch variables in use by the assignment being written, and the most that were ever: of `Real`, of `Long`.
    scratch: [usize; 2],
    most: [usize; 2],
}

impl Builder {
    /// An empty block.
    #[must_use]
    pub fn new() -> Self {
        Self { open: vec![Vec::new()], ..Self::default() }
    }

    /// Declares a variable.
    pub fn declare(&mut self, role: Role, kind: Type, name: &str, initial: Initial, comment: &str) {
        self.declare_array(role, kind, name, None, initial, comment);
    }

    /// Declares an array, or a variable without `cells`.
    pub fn declare_array(
        &mut self,
        role: Role,
        kind: Type,
        name: &str,
        cells: Option<usize>,
        initial: Initial,
        comment: &str,
    ) {
        self.kinds.insert(name.to_owned(), kind);
        self.variables.push(Variable {
            name: name.to_owned(),
            kind,
            cells,
            role,
            initial,
            comment: comment.to_owned(),
        });
    }

    /// Words for the reader.
    pub fn note(&mut self, words: &str) {
        self.push(Statement::Comment(words.to_owned()));
    }

    /// `name := value`.
    pub fn set(&mut self, name: &str, value: Expression) {
        self.assign(Place::Variable(name.to_owned()), value);
    }

    /// `array[index] := value`.
    pub fn set_cell(&mut self, array: &str, index: &str, value: Expression) {
        self.assign(Place::Cell(array.to_owned(), index.to_owned()), value);
    }

    fn assign(&mut self, place: Place, value: Expression) {
        self.scratch = [0, 0];
        let value = self.flat(value);
        self.push(Statement::Assign(place, value));
    }

    /// The statements of `body` when `condition` is true.
    pub fn when(&mut self, condition: Expression, body: impl FnOnce(&mut Self)) {
        self.either(condition, body, |_| {});
    }

    /// The statements of one or the other.
    pub fn either(&mut self, condition: Expression, yes: impl FnOnce(&mut Self), no: impl FnOnce(&mut Self)) {
        let yes = self.part(yes);
        let mut no = self.part(no);
        let mut branches = vec![(condition, yes)];
        // A lone question in the last part goes on in the same row of questions.
        if let [Statement::If(more, last)] = &mut *no {
            branches.append(more);
            no = std::mem::take(last);
        }
        self.push(Statement::If(branches, no));
    }

    /// The statements of `body` for every value of `counter`, both ends included.
    pub fn repeat(&mut self, counter: &str, first: i32, last: i32, body: impl FnOnce(&mut Self)) {
        let body = self.part(body);
        self.push(Statement::Repeat { counter: counter.to_owned(), first, last, body });
    }

    /// What is done when the design is not the one in force, before and after every variable but the inputs and outputs
    /// takes the value that it begins with.
    pub fn anew(&mut self, before: impl FnOnce(&mut Self), after: impl FnOnce(&mut Self)) {
        self.before = self.part(before);
        self.after = self.part(after);
    }

    /// The block, without the constants and the scratch variables that nothing uses. `head` is given the design's number.
    #[must_use]
    pub fn finish(mut self, name: &str, head: impl FnOnce(i32) -> Vec<String>) -> Block {
        for (kind, most) in [(Type::Real, self.most[0]), (Type::Long, self.most[1])] {
            for n in 1..=most {
                self.declare(
                    Role::Scratch,
                    kind,
                    &scratch(kind, n),
                    Initial::Zero,
                    "result of one operation",
                );
            }
        }
        let mut body = self.open.pop().unwrap_or_default();
        let mut used = HashSet::new();
        for part in [&self.before, &self.after, &body] {
            names(part, &mut used);
        }
        self.variables.retain(|variable| {
            !matches!(variable.role, Role::Constant | Role::Scratch) || used.contains(&variable.name)
        });
        let mut begin = self.before;
        begin.extend(self.variables.iter().filter_map(value));
        begin.append(&mut self.after);
        let design = fingerprint::number(&self.variables, [&begin, &body]);
        let in_force = || Expression::Variable(IN_FORCE.to_owned());
        let number = || Expression::Count(design);
        begin.push(Statement::Assign(Place::Variable(IN_FORCE.to_owned()), number()));
        body.insert(0, Statement::If(vec![(in_force().is(number()).opposite(), begin)], Vec::new()));
        self.variables.push(Variable {
            name: IN_FORCE.to_owned(),
            kind: Type::Count,
            cells: None,
            role: Role::State,
            initial: Initial::Zero,
            comment: "number of the design that the other variables are of".to_owned(),
        });
        Block { name: name.to_owned(), head: head(design), design, variables: self.variables, body }
    }

    fn part(&mut self, body: impl FnOnce(&mut Self)) -> Vec<Statement> {
        self.open.push(Vec::new());
        body(self);
        self.open.pop().unwrap_or_default()
    }

    fn push(&mut self, statement: Statement) {
        if let Some(part) = self.open.last_mut() {
            part.push(statement);
        }
    }

    /// The type of a number; `Real` where there is none to find.
    fn kind(&self, value: &Expression) -> Type {
        match value {
            Expression::Variable(name) | Expression::Cell(name, _) => {
                self.kinds.get(name).copied().unwrap_or(Type::Real)
            }
            Expression::Count(_) => Type::Count,
            Expression::Number(_) => Type::Real,
            Expression::Word(_) => Type::Word,
            Expression::Flag(_) | Expression::Not(_) => Type::Flag,
            Expression::Operation(operator, ..) if operator.is_comparison() => Type::Flag,
            Expression::Operation(_, a, _) | Expression::Negative(a) => self.kind(a),
            Expression::Convert(kind, _) => *kind,
        }
    }

    /// `value` with one operation at most, those below it assigned before.
    fn flat(&mut self, value: Expression) -> Expression {
        match value {
            Expression::Operation(operator, a, b) if operator.is_arithmetic() => {
                let (a, b) = (self.leaf(*a), self.leaf(*b));
                Expression::Operation(operator, Box::new(a), Box::new(b))
            }
            Expression::Negative(a) => {
                let minus_one = if self.kind(&a) == Type::Long { "L_MINUS_ONE" } else { "MINUS_ONE" };
                let a = self.leaf(*a);
                Expression::Operation(Operator::Multiply, Box::new(x(minus_one)), Box::new(a))
            }
            Expression::Convert(kind, a) => Expression::Convert(kind, Box::new(self.leaf(*a))),
            other => other,
        }
    }

    /// `value` without any operation.
    fn leaf(&mut self, value: Expression) -> Expression {
        match value {
            Expression::Operation(..) | Expression::Negative(_) | Expression::Convert(..) => {
                let kind = self.kind(&value);
                let value = self.flat(value);
                let at = usize::from(kind == Type::Long);
                self.scratch[at] += 1;
                self.most[at] = self.most[at].max(self.scratch[at]);
                let name = scratch(kind, self.scratch[at]);
                self.push(Statement::Assign(Place::Variable(name.clone()), value));
                Expression::Variable(name)
            }
            other => other,
        }
    }
}

/// The variable with the number of the design that the others are of; 0: none.
pub const IN_FORCE: &str = "DESIGN_IN_FORCE";

/// The statement that gives a variable of the block's own what it begins with. Arrays are left to the block.
fn value(variable: &Variable) -> Option<Statement> {
    let own = matches!(variable.role, Role::Named | Role::Constant | Role::Coefficient | Role::State);
    let value = match (&variable.initial, variable.kind) {
        (Initial::Zero, Type::Flag) => Expression::Flag(false),
        (Initial::Zero, Type::Count) => Expression::Count(0),
        (Initial::Zero, Type::Word) => Expression::Word(0),
        (Initial::Zero, Type::Real | Type::Long) => Expression::Number(0.0),
        (Initial::Number(value), _) => Expression::Number(*value),
        (Initial::Count(n), _) => Expression::Count(*n),
        (Initial::Word(bits), _) => Expression::Word(*bits),
        (Initial::Flag(is), _) => Expression::Flag(*is),
    };
    let place = Place::Variable(variable.name.clone());
    (own && variable.cells.is_none()).then_some(Statement::Assign(place, value))
}

/// Name of the n-th scratch variable.
fn scratch(kind: Type, n: usize) -> String {
    if kind == Type::Long { format!("L_TMP{n}") } else { format!("TMP{n}") }
}

/// The variables that statements name.
fn names(statements: &[Statement], used: &mut HashSet<String>) {
    for statement in statements {
        match statement {
            Statement::Comment(_) => {}
            Statement::Assign(place, value) => {
                match place {
                    Place::Variable(name) => used.insert(name.clone()),
                    Place::Cell(array, index) => used.insert(array.clone()) | used.insert(index.clone()),
                };
                names_of(value, used);
            }
            Statement::If(branches, last) => {
                for (condition, body) in branches {
                    names_of(condition, used);
                    names(body, used);
                }
                names(last, used);
            }
            Statement::Repeat { counter, body, .. } => {
                used.insert(counter.clone());
                names(body, used);
            }
        }
    }
}

fn names_of(value: &Expression, used: &mut HashSet<String>) {
    match value {
        Expression::Variable(name) => {
            used.insert(name.clone());
        }
        Expression::Cell(array, index) => used.extend([array.clone(), index.clone()]),
        Expression::Count(_) | Expression::Number(_) | Expression::Word(_) | Expression::Flag(_) => {}
        Expression::Operation(_, a, b) => {
            names_of(a, used);
            names_of(b, used);
        }
        Expression::Not(a) | Expression::Negative(a) | Expression::Convert(_, a) => names_of(a, used),
    }
}
