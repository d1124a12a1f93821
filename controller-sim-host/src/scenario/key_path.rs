//! The path of a key, such as `noise.std` or `controller."PI + DOB".pid.kp`.

use std::ops::Range;

/// A part of a path: what it says and where it stands in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) span: Range<usize>,
}

/// The parts of `path`; a part in quotes may have any characters, also points.
///
/// # Errors
/// What is wrong, for people.
pub(super) fn parse(path: &str) -> Result<Vec<Part>, &'static str> {
    let mut parts = Vec::new();
    let mut at = 0;
    loop {
        let rest = path.get(at..).unwrap_or("");
        let blank = rest.len() - rest.trim_start().len();
        at += blank;
        let rest = rest.trim_start();
        let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''));
        let (name, length) = match quote {
            Some(quote) => {
                let inner = rest.get(1..).unwrap_or("");
                let end = inner.find(quote).ok_or("a quote is not closed")?;
                (inner.get(..end).unwrap_or(""), end + 2)
            }
            None => {
                let end = rest.find('.').unwrap_or(rest.len());
                (rest.get(..end).unwrap_or("").trim_end(), end)
            }
        };
        if name.is_empty() {
            return Err("a part of it is empty");
        }
        parts.push(Part { name: name.to_owned(), span: at..at + length });
        at += length;
        let after = path.get(at..).unwrap_or("");
        at += after.len() - after.trim_start().len();
        match path.get(at..).and_then(|rest| rest.chars().next()) {
            None => return Ok(parts),
            Some('.') => at += 1,
            Some(_) => return Err("a `.` is missing after the quotes"),
        }
    }
}

/// A part as TOML writes it; none when it cannot be a key.
pub(super) fn written(name: &str) -> Option<String> {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) {
        return Some(name.to_owned());
    }
    let plain = !name.is_empty() && name.chars().all(|c| c != '\'' && !c.is_control());
    plain.then(|| format!("'{name}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &str) -> Result<Vec<String>, &'static str> {
        Ok(parse(path)?.into_iter().map(|part| part.name).collect())
    }

    #[test]
    fn parts_and_quotes() {
        assert_eq!(names("latency"), Ok(vec!["latency".to_owned()]));
        let parts = names("controller.\"PI + 1.5\" . 'pid'.kp");
        assert_eq!(parts.expect("a path"), ["controller", "PI + 1.5", "pid", "kp"]);
        for wrong in ["", ".", "a.", "a..b", "\"a", "\"a\"b", "'' "] {
            assert!(names(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse("a. 'b c'").expect("a path")[1].span, 3..8);
    }
}
