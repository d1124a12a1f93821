//! A function block as a C program: reads one record of inputs per sample, writes one of outputs.

use controller_sim_host::export::block::{
    Block, Expression, Operator, Place, Role, Statement, Type, Variable,
};
use controller_sim_host::simulate::Precision;
use std::collections::HashMap;
use std::fmt::Write;

/// The program. Records are doubles, in the order in which the block declares its inputs and outputs.
pub(crate) fn program(block: &Block, precision: Precision) -> String {
    source(block, precision, false, &Memory::Bytes(0))
}

/// What the memory holds before the first sample.
pub(crate) enum Memory<'a> {
    /// This byte everywhere.
    Bytes(u8),
    /// The values of some variables by name, the cells of arrays alike; zero elsewhere.
    Values(&'a HashMap<String, f64>),
}

/// The same program on memory that has been used before.
pub(crate) fn program_on(block: &Block, precision: Precision, memory: &Memory<'_>) -> String {
    source(block, precision, false, memory)
}

/// The same program with every operation formed in double precision and rounded by its assignment.
pub(crate) fn wide_program(block: &Block) -> String {
    source(block, Precision::F32, true, &Memory::Bytes(0))
}

fn source(block: &Block, precision: Precision, wide: bool, memory: &Memory<'_>) -> String {
    let mut out = String::from("#include <stdint.h>\n#include <stdio.h>\n#include <string.h>\n");
    let real = match precision {
        Precision::F32 => "float",
        Precision::F64 => "double",
    };
    out += &format!("typedef {real} real;\n");
    for variable in &block.variables {
        declare(&mut out, variable);
    }
    out += if wide { "#define OPERAND(x) ((double)(x))\n" } else { "#define OPERAND(x) (x)\n" };
    out += "static void step(void)\n{\n";
    all(&mut out, &block.body);
    out += "}\n";
    let named = |role: Role| block.variables.iter().filter(move |v| v.role == role);
    let (inputs, outputs) = (named(Role::Input).count(), named(Role::Output).count());
    let _ = writeln!(out, "int main(void)\n{{\n    double in[{inputs}], out[{outputs}];");
    fill(&mut out, block, memory);
    let _ = writeln!(out, "    while (fread(in, sizeof(double), {inputs}, stdin) == {inputs}) {{");
    for (n, v) in named(Role::Input).enumerate() {
        let _ = writeln!(out, "        {} = ({})in[{n}];", name(&v.name), kind(v.kind));
    }
    out += "        step();\n";
    for (n, v) in named(Role::Output).enumerate() {
        let _ = writeln!(out, "        out[{n}] = (double){};", name(&v.name));
    }
    let _ =
        writeln!(out, "        fwrite(out, sizeof(double), {outputs}, stdout);\n    }}\n    return 0;\n}}");
    out
}

/// The statements that bring the memory into its state; inputs come from the records.
fn fill(out: &mut String, block: &Block, memory: &Memory<'_>) {
    for v in block.variables.iter().filter(|v| v.role != Role::Input) {
        let at = name(&v.name);
        match memory {
            Memory::Bytes(byte) => {
                let _ = writeln!(out, "    memset(&{at}, {byte}, sizeof {at});");
            }
            Memory::Values(values) => {
                let Some(value) = values.get(&v.name) else { continue };
                let value = match value {
                    _ if value.is_nan() => "(0.0 / 0.0)".to_owned(),
                    _ => format!("{value:.17e}"),
                };
                let _ = match v.cells {
                    None => writeln!(out, "    {at} = ({}){value};", kind(v.kind)),
                    Some(cells) => {
                        writeln!(
                            out,
                            "    for (int k = 0; k < {cells}; k++) {{ {at}[k] = ({}){value}; }}",
                            kind(v.kind)
                        )
                    }
                };
            }
        }
    }
}

/// Names of the block behind a prefix: C has its own.
fn name(of: &str) -> String {
    format!("v_{of}")
}

fn kind(kind: Type) -> &'static str {
    match kind {
        Type::Flag => "int",
        Type::Count => "int32_t",
        Type::Word => "uint32_t",
        Type::Real => "real",
        Type::Long => "double",
    }
}

/// Memory begins as zero bytes: no initial value is applied, inputs come from the records.
fn declare(out: &mut String, v: &Variable) {
    let cells = v.cells.map_or(String::new(), |cells| format!("[{cells}]"));
    // Every variable must be used, but for the names, which are the same in every block.
    let scope = if v.role == Role::Named { "" } else { "static " };
    let _ = writeln!(out, "{scope}{} {}{cells};", kind(v.kind), name(&v.name));
}

fn all(out: &mut String, statements: &[Statement]) {
    for statement in statements {
        match statement {
            Statement::Comment(_) => {}
            Statement::Assign(place, value) => {
                let place = match place {
                    Place::Variable(of) => name(of),
                    Place::Cell(array, index) => format!("{}[{}]", name(array), name(index)),
                };
                let _ = writeln!(out, "{place} = {};", expression(value));
            }
            Statement::If(branches, last) => {
                for (n, (condition, body)) in branches.iter().enumerate() {
                    let word = if n == 0 { "if" } else { "} else if" };
                    let _ = writeln!(out, "{word} ({}) {{", expression(condition));
                    all(out, body);
                }
                out.push_str("} else {\n");
                all(out, last);
                out.push_str("}\n");
            }
            Statement::Repeat { counter, first, last, body } => {
                let c = name(counter);
                let _ = writeln!(out, "for ({c} = {first}; {c} <= {last}; {c}++) {{");
                all(out, body);
                out.push_str("}\n");
            }
        }
    }
}

fn expression(value: &Expression) -> String {
    match value {
        Expression::Variable(of) => name(of),
        Expression::Cell(array, index) => format!("{}[{}]", name(array), name(index)),
        Expression::Count(n) => n.to_string(),
        // As a translator of Structured Text does it: decimal, double, then the type of the variable.
        Expression::Number(value) => format!("{value:.17e}"),
        Expression::Word(bits) => format!("{bits}u"),
        Expression::Flag(is) => i32::from(*is).to_string(),
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
                Operator::Is => "==",
                // Both sides are evaluated, as some translators do it.
                Operator::And => "&",
                Operator::Or => "|",
            };
            let real = matches!(
                operator,
                Operator::Subtract | Operator::Multiply | Operator::Divide | Operator::Add
            );
            let count = matches!(**b, Expression::Count(_));
            if real && !count {
                return format!("(OPERAND({}) {sign} OPERAND({}))", expression(a), expression(b));
            }
            format!("({} {sign} {})", expression(a), expression(b))
        }
        Expression::Not(a) => format!("!({})", expression(a)),
        Expression::Negative(_) => panic!("a sign that is no operation"),
        Expression::Convert(to, a) => format!("(({})({}))", kind(*to), expression(a)),
    }
}
