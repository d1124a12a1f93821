//! A function block as a C program: reads one record of inputs per sample, writes one of outputs.

use controller_sim_host::export::block::{
    Block, Expression, Initial, Operator, Place, Role, Statement, Type, Variable,
};
use controller_sim_host::simulate::Precision;
use std::fmt::Write;

/// The program. Records are doubles, in the order in which the block declares its inputs and outputs.
pub(crate) fn program(block: &Block, precision: Precision) -> String {
    source(block, precision, false)
}

/// The same program with every operation formed in double precision and rounded by its assignment.
pub(crate) fn wide_program(block: &Block) -> String {
    source(block, Precision::F32, true)
}

fn source(block: &Block, precision: Precision, wide: bool) -> String {
    let mut out = String::from("#include <stdint.h>\n#include <stdio.h>\n");
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

fn declare(out: &mut String, v: &Variable) {
    let (kind, name) = (kind(v.kind), name(&v.name));
    let initial = match &v.initial {
        Initial::Zero => "{0}".to_owned(),
        // As a translator of Structured Text does it: decimal, double, then the type.
        Initial::Number(value) => format!("({kind}){value:.17e}"),
        Initial::Count(n) => n.to_string(),
        Initial::Word(bits) => format!("{bits}u"),
        Initial::Flag(is) => i32::from(*is).to_string(),
    };
    let cells = v.cells.map_or(String::new(), |cells| format!("[{cells}]"));
    let initial = if v.cells.is_none() && initial == "{0}" { "0".to_owned() } else { initial };
    // Every variable must be used, but for the names, which are the same in every block.
    let scope = if v.role == Role::Named { "" } else { "static " };
    let _ = writeln!(out, "{scope}{kind} {name}{cells} = {initial};");
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
