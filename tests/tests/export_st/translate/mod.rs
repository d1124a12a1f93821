//! From the exported text to C, by way of a parser that is not ours: the crate `iec61131` reads the text, this prints its
//! tree.
//!
//! Nothing here knows how the text was made. What has no translation is a fault, never left out.

mod expression;
mod program;
mod tokens;

use iec61131::{
    Expression, FunctionBlockDecl, Literal, Parser, PouDeclaration, Statement, Token, TypeSpec, VarDecl,
};
use std::collections::HashMap;
use std::fmt::Write;
use tokens::Tokens;

pub(crate) use program::translate_program;

/// An elementary type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Bool,
    Dint,
    Dword,
    Real,
    Lreal,
}

impl Kind {
    fn of(name: &str) -> Option<(Self, Token)> {
        Some(match name {
            "BOOL" => (Self::Bool, Token::Bool),
            "DINT" => (Self::Dint, Token::Dint),
            "DWORD" => (Self::Dword, Token::Dword),
            "REAL" => (Self::Real, Token::Real),
            "LREAL" => (Self::Lreal, Token::Lreal),
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Bool => "_Bool",
            Self::Dint => "int32_t",
            Self::Dword => "uint32_t",
            Self::Real => "float",
            Self::Lreal => "double",
        }
    }
}

/// A function block as a C program: reads a record of doubles, one for each input, and writes one for each output.
#[derive(Debug)]
pub(crate) struct Translated {
    /// Names in the order of a record.
    pub(crate) inputs: Vec<String>,
    /// Names in the order of a record.
    pub(crate) outputs: Vec<String>,
    /// With `BY_DOUBLE` defined, a REAL is read from its decimals by way of double precision, as some compilers of
    /// Structured Text do; otherwise at once.
    pub(crate) source: String,
}

struct Declared {
    kind: Kind,
    /// First and last index of an array.
    cells: Option<(i32, i32)>,
    /// Whether a statement may assign to it.
    own: bool,
}

struct Translator {
    tokens: Tokens,
    /// By their names in C.
    names: HashMap<String, Declared>,
    /// What they begin with there.
    prefix: &'static str,
    /// The block that a program calls.
    instance: Option<program::Instance>,
    out: String,
}

const HEAD: &str = "#include <float.h>\n#include <stdint.h>\n#include <stdio.h>\n#include <stdlib.h>\n\
    _Static_assert(FLT_EVAL_METHOD == 0, \"operations are rounded to the type of their operands\");\n\
    #ifdef BY_DOUBLE\n#define REAL_LITERAL(x) ((float)x)\n#else\n#define REAL_LITERAL(x) x##f\n#endif\n\
    #ifdef __GNUC__\n#pragma GCC diagnostic ignored \"-Wunused-variable\"\n#endif\n\
    int32_t cell(int32_t index, int32_t first, int32_t last);\n\
    int32_t cell(int32_t index, int32_t first, int32_t last)\n{\n\
    if (index < first || index > last) {\nabort();\n}\nreturn index - first;\n}\n";

/// The one function block of `text`.
pub(crate) fn translate(text: &str) -> Result<Translated, String> {
    let (mut all, block) = function_block(text)?;
    all.main(&block.inputs, &block.outputs)?;
    let names = |list: &[VarDecl]| list.iter().map(|v| v.name.clone()).collect();
    Ok(Translated { inputs: names(&block.inputs), outputs: names(&block.outputs), source: all.out })
}

/// The one function block of `text`: its variables and its statements as `step`, without what feeds it.
fn function_block(text: &str) -> Result<(Translator, FunctionBlockDecl), String> {
    let unit = Parser::new(text).parse().map_err(|fault| fault.to_string())?;
    let [PouDeclaration::FunctionBlock(block)] = unit.declarations.as_slice() else {
        return Err("not one function block".to_owned());
    };
    let plain = block.in_outs.is_empty()
        && block.methods.is_empty()
        && block.implements.is_empty()
        && block.extends.is_none()
        && !block.is_final
        && !block.is_abstract;
    let Some(body) = block.body.as_ref().filter(|_| plain) else {
        return Err("more than variables and statements, or less".to_owned());
    };
    let mut all = Translator::new(text, "v_")?;
    all.out += HEAD;
    all.tokens.take(&Token::FunctionBlock)?;
    all.tokens.name(&block.name)?;
    for (list, opening) in
        [(&block.inputs, Token::VarInput), (&block.outputs, Token::VarOutput), (&block.vars, Token::Var)]
    {
        all.sections(list, &opening)?;
    }
    all.out += "static void step(void)\n{\n";
    all.statements(body)?;
    all.out += "}\n";
    all.tokens.take(&Token::EndFunctionBlock)?;
    all.tokens.end()?;
    Ok((all, block.clone()))
}

impl Translator {
    fn new(text: &str, prefix: &'static str) -> Result<Self, String> {
        let (names, out) = (HashMap::new(), String::new());
        Ok(Self { tokens: Tokens::of(text)?, names, prefix, instance: None, out })
    }

    /// The C name of a variable: the language does not tell capitals from small letters.
    fn c_name(&self, name: &str) -> String {
        format!("{}{}", self.prefix, name.to_ascii_uppercase())
    }

    fn line(&mut self, words: &str) {
        self.out.push_str(words);
        self.out.push('\n');
    }

    fn declared(&self, name: &str) -> Option<(Kind, Option<(i32, i32)>)> {
        self.names.get(&self.c_name(name)).map(|of| (of.kind, of.cells))
    }

    /// Declarations that the text opens with `opening`, in one section or more.
    fn sections(&mut self, list: &[VarDecl], opening: &Token) -> Result<(), String> {
        let mut inside = false;
        for variable in list {
            if inside && self.tokens.skip(&Token::EndVar) {
                inside = false;
            }
            if !inside {
                self.tokens.take(opening)?;
                if variable.is_constant {
                    self.tokens.take(&Token::Constant)?;
                }
                inside = true;
            }
            self.declaration(variable, *opening == Token::VarInput)?;
        }
        if inside { self.tokens.take(&Token::EndVar) } else { Ok(()) }
    }

    fn declaration(&mut self, variable: &VarDecl, input: bool) -> Result<(), String> {
        let VarDecl { name, var_type, init_value, is_constant, is_retain, location, .. } = variable;
        self.tokens.name(name)?;
        self.tokens.take(&Token::Colon)?;
        if self.is_instance(variable)? {
            return Ok(());
        }
        let (kind, cells) = match var_type {
            TypeSpec::Elementary(of) => (self.elementary(of)?, None),
            TypeSpec::Array { dimensions, element_type } => {
                self.tokens.take(&Token::Array)?;
                self.tokens.take(&Token::LBracket)?;
                let ([range], TypeSpec::Elementary(of)) = (dimensions.as_slice(), &**element_type) else {
                    return Err(self.tokens.fault("an array of arrays"));
                };
                let first = self.index(&range.start)?;
                self.tokens.take(&Token::DotDot)?;
                let last = self.index(&range.end)?;
                self.tokens.take(&Token::RBracket)?;
                self.tokens.take(&Token::Of)?;
                (self.elementary(of)?, Some((first, last)))
            }
            other => return Err(self.tokens.fault(&format!("the type {other:?}"))),
        };
        let size = match cells {
            None => String::new(),
            Some((first, last)) if first <= last && init_value.is_none() => {
                format!("[{}]", i64::from(last) - i64::from(first) + 1)
            }
            Some(_) => return Err(self.tokens.fault(&format!("the array {name}"))),
        };
        // Without a value the language starts every variable at zero or FALSE.
        let initial = match init_value {
            None if cells.is_some() => "{0}".to_owned(),
            None => "0".to_owned(),
            Some(value) => {
                self.tokens.take(&Token::Assign)?;
                self.expression(value, kind)?
            }
        };
        self.tokens.take(&Token::Semicolon)?;
        if *is_retain || location.is_some() {
            return Err(self.tokens.fault(&format!("{name} is more than a variable")));
        }
        // A constant that is not static may stand unused.
        let scope = if *is_constant { "const" } else { "static" };
        self.line(&format!("{scope} {} {}{size} = {initial};", kind.name(), self.c_name(name)));
        let declared = Declared { kind, cells, own: !(*is_constant || input) };
        match self.names.insert(self.c_name(name), declared) {
            None => Ok(()),
            Some(_) => Err(self.tokens.fault(&format!("{name} is declared twice"))),
        }
    }

    fn elementary(&mut self, name: &str) -> Result<Kind, String> {
        let (kind, token) = Kind::of(name).ok_or_else(|| self.tokens.fault(&format!("the type {name}")))?;
        self.tokens.take(&token)?;
        Ok(kind)
    }

    /// A limit of an array: a whole number, perhaps with a sign.
    fn index(&mut self, value: &Expression) -> Result<i32, String> {
        let negative = self.tokens.skip(&Token::Minus);
        match (value, negative) {
            (Expression::Literal(Literal::Integer(_)), false) => {}
            (Expression::Unary { operand, .. }, true)
                if matches!(**operand, Expression::Literal(Literal::Integer(_))) => {}
            _ => return Err(self.tokens.fault("a limit of an array that is no number")),
        }
        let digits = self.tokens.whole()?;
        let value: i32 = digits.parse().map_err(|_| self.tokens.fault("too many cells"))?;
        Ok(if negative { -value } else { value })
    }

    fn statements(&mut self, list: &[Statement]) -> Result<(), String> {
        // The parser leaves empty statements out.
        while self.tokens.skip(&Token::Semicolon) {}
        for statement in list {
            self.statement(statement)?;
            self.tokens.take(&Token::Semicolon)?;
            while self.tokens.skip(&Token::Semicolon) {}
        }
        Ok(())
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), String> {
        match statement {
            Statement::Assignment { target, value, .. } => {
                let (place, kind) = self.place(target)?;
                let name = place.split('[').next().unwrap_or(&place);
                if !self.names.get(name).is_some_and(|of| of.own) {
                    return Err(self.tokens.fault(&format!("{name} is given a value")));
                }
                self.tokens.take(&Token::Assign)?;
                let value = self.expression(value, kind)?;
                self.line(&format!("{place} = {value};"));
            }
            Statement::If { condition, then_body, elsif_parts, else_body, .. } => {
                self.branch(&Token::If, "if", condition, then_body)?;
                for (condition, body) in elsif_parts {
                    self.branch(&Token::Elsif, "} else if", condition, body)?;
                }
                if let Some(body) = else_body {
                    self.tokens.take(&Token::Else)?;
                    self.line("} else {");
                    self.statements(body)?;
                }
                self.line("}");
                self.tokens.take(&Token::EndIf)?;
            }
            Statement::For { control_var, start, end, step: None, body, .. } => {
                self.tokens.take(&Token::For)?;
                self.tokens.name(control_var)?;
                let own = self.names.get(&self.c_name(control_var)).is_some_and(|of| of.own);
                if !own || self.declared(control_var) != Some((Kind::Dint, None)) {
                    return Err(self.tokens.fault(&format!("{control_var} counts")));
                }
                self.tokens.take(&Token::Assign)?;
                let start = self.expression(start, Kind::Dint)?;
                self.tokens.take(&Token::To)?;
                let end = self.expression(end, Kind::Dint)?;
                self.tokens.take(&Token::Do)?;
                let counter = self.c_name(control_var);
                self.line(&format!("{{\nconst int32_t end = {end};"));
                self.line(&format!("for ({counter} = {start}; {counter} <= end; {counter}++) {{"));
                self.statements(body)?;
                // What the counter holds behind the loop is left open by the standard: nothing may depend on it.
                self.line(&format!("}}\n{counter} = INT32_MIN;\n}}"));
                self.tokens.take(&Token::EndFor)?;
            }
            Statement::FunctionCall { name, arguments, .. } => self.call(name, arguments)?,
            other => return Err(self.tokens.fault(&format!("the statement {other:?}"))),
        }
        Ok(())
    }

    fn branch(
        &mut self,
        token: &Token,
        word: &str,
        condition: &Expression,
        body: &[Statement],
    ) -> Result<(), String> {
        self.tokens.take(token)?;
        let condition = self.expression(condition, Kind::Bool)?;
        self.tokens.take(&Token::Then)?;
        self.line(&format!("{word} ({condition}) {{"));
        self.statements(body)
    }

    /// What reads the inputs, runs a sample and writes the outputs.
    fn main(&mut self, inputs: &[VarDecl], outputs: &[VarDecl]) -> Result<(), String> {
        let (read, written) = (inputs.len(), outputs.len());
        let mut out = format!("int main(void)\n{{\ndouble in[{read}], out[{written}];\n");
        let _ = writeln!(out, "while (fread(in, sizeof(double), {read}, stdin) == {read}) {{");
        for (list, given) in [(inputs, true), (outputs, false)] {
            for (n, v) in list.iter().enumerate() {
                let Some((kind, None)) = self.declared(&v.name) else {
                    return Err(format!("{} is an array", v.name));
                };
                let name = self.c_name(&v.name);
                let _ = match given {
                    true => writeln!(out, "{name} = ({})in[{n}];", kind.name()),
                    false => writeln!(out, "out[{n}] = (double){name};"),
                };
            }
            if given {
                out += "step();\n";
            }
        }
        let _ = writeln!(out, "fwrite(out, sizeof(double), {written}, stdout);\n}}\nreturn 0;\n}}");
        self.out += &out;
        Ok(())
    }
}
