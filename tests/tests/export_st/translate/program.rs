//! A program that calls one instance of an exported block.

use super::{Declared, Kind, Translator, function_block};
use iec61131::{Argument, Parser, PouDeclaration, Token, TypeSpec, VarDecl, Variable};
use std::collections::HashMap;
use std::fmt::Write;

/// The block that a program calls.
pub(super) struct Instance {
    /// The block's name.
    block: String,
    /// The instance's, once it is declared.
    name: Option<String>,
    /// The block's variables, by their names in C.
    names: HashMap<String, Declared>,
    inputs: Vec<String>,
    outputs: Vec<String>,
}

/// The one program of `text` with the one function block of `block` that it calls, as C: runs `cycles` times, then writes
/// the variables `named` as doubles.
pub(crate) fn translate_program(
    text: &str,
    block: &str,
    cycles: usize,
    named: &[&str],
) -> Result<String, String> {
    let (of, declaration) = function_block(block)?;
    let unit = Parser::new(text).parse().map_err(|fault| fault.to_string())?;
    let [PouDeclaration::Program(program)] = unit.declarations.as_slice() else {
        return Err("not one program".to_owned());
    };
    let names = |list: &[VarDecl]| list.iter().map(|v| v.name.clone()).collect();
    let mut all = Translator::new(text, "p_")?;
    all.out = of.out;
    all.instance = Some(Instance {
        block: declaration.name.clone(),
        name: None,
        names: of.names,
        inputs: names(&declaration.inputs),
        outputs: names(&declaration.outputs),
    });
    all.tokens.take(&Token::Program)?;
    all.tokens.name(&program.name)?;
    all.sections(&program.vars, &Token::Var)?;
    all.out += "static void cycle(void)\n{\n";
    all.statements(&program.body)?;
    all.out += "}\n";
    all.tokens.take(&Token::EndProgram)?;
    all.tokens.end()?;
    let count = named.len();
    let mut main = format!("int main(void)\n{{\ndouble out[{count}];\n");
    let _ = writeln!(main, "for (int n = 0; n < {cycles}; n++) {{\ncycle();\n}}");
    for (n, name) in named.iter().enumerate() {
        let Some((_, None)) = all.declared(name) else { return Err(format!("{name} is not there")) };
        let _ = writeln!(main, "out[{n}] = (double){};", all.c_name(name));
    }
    let _ = writeln!(main, "fwrite(out, sizeof(double), {count}, stdout);\nreturn 0;\n}}");
    Ok(all.out + &main)
}

impl Translator {
    /// Takes the type of a variable that is the program's instance of its block.
    pub(super) fn is_instance(&mut self, variable: &VarDecl) -> Result<bool, String> {
        let (TypeSpec::Elementary(kind), Some(instance)) = (&variable.var_type, &mut self.instance) else {
            return Ok(false);
        };
        if *kind != instance.block {
            return Ok(false);
        }
        if instance.name.replace(variable.name.clone()).is_some() || variable.init_value.is_some() {
            return Err(self.tokens.fault("more than one instance, or one with a value"));
        }
        self.tokens.name(kind)?;
        self.tokens.take(&Token::Semicolon)?;
        Ok(true)
    }

    /// The call of the instance: the inputs that are named are set, the others stay as they are.
    pub(super) fn call(&mut self, name: &str, arguments: &[Argument]) -> Result<(), String> {
        if self.instance.as_ref().and_then(|of| of.name.as_deref()) != Some(name) {
            return Err(self.tokens.fault(&format!("the call of {name}")));
        }
        self.tokens.name(name)?;
        self.tokens.take(&Token::LParen)?;
        for (n, argument) in arguments.iter().enumerate() {
            let Argument::Named { name, value } = argument else {
                return Err(self.tokens.fault("an argument without a name"));
            };
            if n > 0 {
                self.tokens.take(&Token::Comma)?;
            }
            self.tokens.name(name)?;
            self.tokens.take(&Token::Assign)?;
            let input = self.instance.as_ref().is_some_and(|of| of.inputs.contains(name));
            let Some(kind) = self.member_kind(name).filter(|_| input) else {
                return Err(self.tokens.fault(&format!("{name} is no input")));
            };
            let value = self.expression(value, kind)?;
            self.line(&format!("v_{name} = {value};"));
        }
        self.tokens.take(&Token::RParen)?;
        self.line("step();");
        Ok(())
    }

    /// An output of the instance as C, with its type.
    pub(super) fn member(&mut self, base: &Variable, member: &str) -> Result<(String, Kind), String> {
        let output = self.instance.as_ref().filter(|of| {
            let called = matches!(base, Variable::Simple(name) if Some(name) == of.name.as_ref());
            called && of.outputs.iter().any(|output| output == member)
        });
        let (Some(_), Variable::Simple(name), Some(kind)) = (output, base, self.member_kind(member)) else {
            return Err(self.tokens.fault(&format!("{base:?}.{member}")));
        };
        self.tokens.name(name)?;
        self.tokens.take(&Token::Dot)?;
        self.tokens.name(member)?;
        Ok((format!("v_{member}"), kind))
    }

    /// The type of an input or output of the instance.
    pub(super) fn member_kind(&self, member: &str) -> Option<Kind> {
        let of = self.instance.as_ref()?.names.get(&format!("v_{member}"))?;
        of.cells.is_none().then_some(of.kind)
    }
}
