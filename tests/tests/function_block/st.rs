//! Reads the file of a function block: one variable a line, one pragma.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Section {
    Input,
    Output,
    Private,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Variable {
    pub(crate) section: Section,
    pub(crate) name: String,
    pub(crate) kind: String,
    /// Empty when there is none.
    pub(crate) initial: String,
    pub(crate) comment: String,
}

#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) name: String,
    pub(crate) variables: Vec<Variable>,
    /// C, without its braces.
    pub(crate) pragma: String,
    pub(crate) without_pragma: String,
    text: String,
}

impl Block {
    pub(crate) fn read(text: &str) -> Self {
        let (before, rest) = text.split_once("{{").expect("a pragma");
        let (pragma, after) = rest.split_once("}}").expect("the end of the pragma");
        assert!(!after.contains("{{"), "one pragma");
        let after = after.trim();
        // A body needs a statement besides the pragma.
        assert!(after.contains(":=") && after.ends_with("END_FUNCTION_BLOCK"), "{after}");
        let mut section = None;
        let mut variables = Vec::new();
        let mut name = String::new();
        let mut lines = before.lines();
        while let Some(line) = lines.next() {
            let line = line.trim();
            match line {
                "VAR_INPUT" => section = Some(Section::Input),
                "VAR_OUTPUT" => section = Some(Section::Output),
                "VAR" => section = Some(Section::Private),
                "END_VAR" => section = None,
                "" => {}
                _ if line.starts_with("(*") => {
                    let mut rest = line;
                    while !rest.contains("*)") {
                        rest = lines.next().expect("the end of the comment");
                    }
                    assert!(rest.trim_end().ends_with("*)"));
                }
                _ if line.starts_with("FUNCTION_BLOCK ") => {
                    name = line["FUNCTION_BLOCK ".len()..].to_string()
                }
                _ => variables.push(Variable::read(line, section.expect("a declaration in a section"))),
            }
        }
        Self {
            name,
            variables,
            pragma: pragma.to_string(),
            without_pragma: format!("{before}{after}\n"),
            text: text.to_string(),
        }
    }

    /// Words of the memory, and the samples of dead time that its comment says it has room for.
    pub(crate) fn room(&self) -> (usize, u32) {
        let state = self.variables.iter().find(|v| v.name == "STATE").expect("the memory");
        let last = state.kind.strip_prefix("ARRAY [0..").and_then(|rest| rest.strip_suffix("] OF LWORD"));
        let last: usize = last.and_then(|n| n.parse().ok()).unwrap_or_else(|| panic!("{}", state.kind));
        let (_, rest) = self.text.split_once("latency of ").expect("what it has room for");
        let delay = rest.split(' ').next().and_then(|n| n.parse().ok()).expect("a number");
        (last + 1, delay)
    }
}

impl Variable {
    fn read(line: &str, section: Section) -> Self {
        let (declaration, comment) = line.split_once(';').unwrap_or_else(|| panic!("{line}"));
        let (name, rest) = declaration.split_once(" : ").unwrap_or_else(|| panic!("{line}"));
        assert!(!name.contains(','), "one variable a line: {line}");
        let (kind, initial) = rest.split_once(" := ").unwrap_or((rest, ""));
        let comment = comment.trim().trim_start_matches("(*").trim_end_matches("*)").trim();
        let text = |s: &str| s.trim().to_string();
        Self { section, name: text(name), kind: text(kind), initial: text(initial), comment: text(comment) }
    }
}
