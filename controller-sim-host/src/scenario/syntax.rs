//! What is wrong with a text that is no TOML, in words for people who do not know TOML.

use super::fault::{Fault, boundary, code};
use super::log::MOST;
use super::table::shortened;
use std::ops::Range;

/// The message for braces that are not closed.
const OPEN_BRACE: &str = "a `,` or the closing `}` is missing here";

/// The faults of the parser, in the order of the text, one for a line: what follows on the same line is
/// mostly a consequence.
pub(super) fn faults(text: &str, errors: &[toml::de::Error]) -> Vec<Fault> {
    let mut found: Vec<(Range<usize>, &str)> = errors
        .iter()
        .map(|error| {
            let span = error.span().unwrap_or(text.len()..text.len());
            let start = boundary(text, span.start);
            (start..boundary(text, span.end).max(start), error.message())
        })
        .collect();
    found.sort_by_key(|(span, _)| (span.start, span.end));
    let mut faults: Vec<Fault> = Vec::new();
    let mut last_line = None;
    let (mut header_broken, mut braces_broken) = (false, false);
    for (span, message) in found {
        let line = line_of(text, span.start);
        let header = is_header(text, &line);
        let in_braces = message.contains("inline table") || message.contains("key-value pairs");
        // A brace that is not closed swallows what follows; a header that is not closed spoils the next ones.
        let follows = (in_braces && braces_broken)
            || (message.starts_with("duplicate key") && header && header_broken)
            || last_line.as_ref() == Some(&line);
        if faults.len() >= MOST {
            break;
        }
        if !follows {
            faults.push(explain(text, span, message));
            header_broken |= header;
            braces_broken |= in_braces;
        }
        last_line = Some(line);
    }
    faults
}

fn is_header(text: &str, line: &Range<usize>) -> bool {
    text.get(line.clone()).unwrap_or("").trim_start().starts_with('[')
}

/// Whether a fault found in the recovered document can be believed beside `syntax` faults: not on their
/// lines, and not when it may be missing only because a part of the text could not be read.
pub(super) fn is_credible(text: &str, fault: &Fault, syntax: &[Fault]) -> bool {
    let line = line_of(text, fault.span.start);
    let lines: Vec<Range<usize>> = syntax.iter().map(|other| line_of(text, other.span.start)).collect();
    let structure_broken = lines.iter().any(|line| is_header(text, line))
        || syntax.iter().any(|other| other.message == OPEN_BRACE);
    let certain = [code::WRONG_TYPE, code::OUT_OF_RANGE, code::EXPRESSION].contains(&fault.code)
        || (fault.code == code::UNKNOWN_KEY && !structure_broken);
    certain && !lines.contains(&line)
}

/// The line around `at`, without its end.
fn line_of(text: &str, at: usize) -> Range<usize> {
    let at = boundary(text, at);
    let (before, after) = text.split_at(at);
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let end = after.find('\n').map_or(text.len(), |i| at + i);
    start..end
}

fn explain(text: &str, span: Range<usize>, message: &str) -> Fault {
    let line = line_of(text, span.start);
    let raw = text.get(line.clone()).unwrap_or("");
    let under = text.get(span.clone()).unwrap_or("");
    let syntax = |message: String| Fault::new(code::SYNTAX, span.clone(), message);
    if message.starts_with("duplicate key") {
        return duplicate(raw, under, span);
    }
    if let Some((place, number)) = decimal_comma(raw, span.start - line.start) {
        let place = line.start + place..line.start + place + 1;
        return Fault::new(code::SYNTAX, place, "a decimal comma; numbers are written with a point")
            .help(format!("write `{number}`"));
    }
    if under.trim().is_empty() && raw.trim_end().ends_with('=') {
        let key = shortened(raw.trim().trim_end_matches('=').trim_end());
        return syntax(format!("`{key}` has no value")).help("a line is `key = value`");
    }
    if message.starts_with("key with no value") {
        return syntax("this line has no `=`".to_owned()).help("a line is `key = value`");
    }
    if message.starts_with("string values must be quoted") {
        let after = text.get(span.end..).unwrap_or("").trim_start();
        if let (Some(end), true) = (under.find(char::is_whitespace), after.starts_with('=')) {
            let end = span.start + end;
            return Fault::new(code::SYNTAX, end..end, "a `,` is missing here")
                .help("entries are separated by `,`");
        }
        return unquoted(under, span);
    }
    if message.starts_with("invalid mantissa") || message.starts_with("invalid fraction") {
        return syntax("a number needs digits on both sides of its point".to_owned())
            .help("write `0.5`, not `.5`, and `5.0`, not `5.`");
    }
    if message.starts_with("invalid basic string") || message.starts_with("invalid literal string") {
        return syntax("this text has no closing quote".to_owned()).help("close it on the same line");
    }
    if message.starts_with("unclosed inline table") || message.starts_with("missing comma between key") {
        // The parser stops at what follows; what is missing is missing before it.
        let end = text.get(..span.start).map_or(0, |before| before.trim_end().len());
        return Fault::new(code::SYNTAX, end..end, OPEN_BRACE)
            .help("entries are separated by `,` and end with `}`");
    }
    if message.starts_with("unclosed") && raw.trim_start().starts_with('[') {
        let inner = shortened(raw.trim().trim_matches(['[', ']']));
        let closed =
            if raw.trim_start().starts_with("[[") { format!("[[{inner}]]") } else { format!("[{inner}]") };
        return syntax("this header is not closed".to_owned()).help(format!("write `{closed}`"));
    }
    syntax(format!("this is not TOML: {message}"))
}

fn duplicate(raw: &str, key: &str, span: Range<usize>) -> Fault {
    let key = shortened(key);
    if raw.trim_start().starts_with('[') {
        let fault = Fault::new(code::DUPLICATE, span, format!("there are two tables `{key}`"));
        return if key == "event" || key == "controller" {
            fault.help(format!("each {key} begins with a line `[[{key}]]`, in double brackets"))
        } else {
            fault.help("write all keys of a table below one header")
        };
    }
    Fault::new(code::DUPLICATE, span, format!("`{key}` is written twice in one table"))
        .help("remove one of the two")
}

/// Something that stands bare where a value must be.
fn unquoted(value: &str, span: Range<usize>) -> Fault {
    let shown = shortened(value);
    let fault = Fault::new(code::SYNTAX, span, format!("`{shown}` is neither a number nor a text in quotes"));
    match value.to_lowercase().as_str() {
        "true" | "yes" | "on" => fault.help("write `true`"),
        "false" | "no" | "off" => fault.help("write `false`, or \"off\" in quotes for the mode"),
        _ if value.starts_with(['\u{201c}', '\u{201d}', '\u{201e}', '\u{ab}']) => {
            fault.help("use straight quotes, `\"`")
        }
        _ => match leading_number(value) {
            Some(number) => fault.help(format!("write the number alone: `{number}`")),
            None => fault.help(format!("write a text in quotes: `\"{shown}\"`")),
        },
    }
}

/// The number that `value` begins with, when a space and something else follow.
fn leading_number(value: &str) -> Option<&str> {
    let (number, _) = value.split_once(' ')?;
    number.parse::<f64>().ok().map(|_| number)
}

/// A number with a decimal comma at or just before the byte `at` of `line`: the place of the comma, and the
/// number as it should be.
fn decimal_comma(line: &str, at: usize) -> Option<(usize, String)> {
    let bytes = line.as_bytes();
    let digit = |i: usize| bytes.get(i).is_some_and(u8::is_ascii_digit);
    // The parser may stop at the comma or at what comes after the digits behind it.
    let mut place = at;
    while place > 0
        && bytes.get(place) != Some(&b',')
        && (digit(place - 1) || bytes.get(place - 1) == Some(&b','))
    {
        place -= 1;
    }
    if bytes.get(place) != Some(&b',') || place == 0 || !digit(place - 1) || !digit(place + 1) {
        return None;
    }
    let number_byte = |i: usize| digit(i) || matches!(bytes.get(i), Some(b'.' | b'-' | b'+'));
    let start = (0..place).rev().take_while(|&i| number_byte(i)).last()?;
    let end = (place + 1..bytes.len()).take_while(|&i| digit(i)).last()? + 1;
    let number = format!("{}.{}", line.get(start..place)?, line.get(place + 1..end)?);
    number.parse::<f64>().is_ok().then_some((place, number))
}
