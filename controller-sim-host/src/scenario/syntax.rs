//! What is wrong with a text that is no TOML, in words for people who do not know TOML.

use super::fault::{Fault, boundary, code};
use super::number::without_unit;
use super::value::shortened;
use std::ops::Range;

/// The message for braces that are not closed.
const OPEN_BRACE: &str = "a `,` or the closing `}` is missing here";

/// With more faults than this the text is something else.
const MOST: usize = 10;

/// The faults of the parser, in the order of the text, one for a line: what follows on the same line is
/// mostly a consequence. A text that is something else altogether has one fault.
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
    if let (false, Some(brace)) = (found.is_empty(), json(text)) {
        return vec![brace];
    }
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
        if faults.len() >= MOST && !follows {
            return vec![no_scenario(text)];
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

/// The one fault of a text in JSON.
fn json(text: &str) -> Option<Fault> {
    let start = text.find(|c: char| !c.is_whitespace() && c != '\u{feff}')?;
    let brace = start..start + 1;
    (text.get(brace.clone()) == Some("{")).then(|| {
        Fault::new(code::SYNTAX, brace, "this looks like JSON; a scenario is TOML and does not begin with `{`")
            .help("write `ts = 0.1` for `\"ts\": 0.1`, and a line `[plant]` for `\"plant\": {`; `controller-sim demo --save` writes an example")
    })
}

fn no_scenario(text: &str) -> Fault {
    let message = format!("this does not look like a scenario: more than {MOST} of its lines are not TOML");
    Fault::new(code::SYNTAX, line_of(text, 0), message).help("`controller-sim demo --save` writes an example")
}

/// Whether `faults` say that the text is something else altogether: nothing else in it is to be reported.
pub(super) fn is_hopeless(faults: &[Fault]) -> bool {
    faults.iter().any(|fault| {
        fault.message.starts_with("this looks like JSON")
            || fault.message.starts_with("this does not look like")
    })
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
    let certain = [code::WRONG_TYPE, code::OUT_OF_RANGE, code::EXPRESSION, code::FILE, code::RECORDING]
        .contains(&fault.code)
        || (fault.code == code::UNKNOWN_KEY && !structure_broken);
    // What could not be read has no place.
    certain && !fault.span.is_empty() && !lines.contains(&line)
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
    if let Some((place, help)) = colon(raw, span.start - line.start) {
        let place = line.start + place..line.start + place + 1;
        return Fault::new(code::SYNTAX, place, "a `:` where a `=` belongs").help(help);
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
        let in_braces = raw.get(..span.start - line.start).is_some_and(|before| before.contains('{'));
        if let (Some(end), true) = (under.find(char::is_whitespace), after.starts_with('=')) {
            let end = span.start + end;
            if !in_braces {
                return in_plain_words("unexpected key or value", |words| {
                    Fault::new(code::SYNTAX, end..end, words)
                });
            }
            return Fault::new(code::SYNTAX, end..end, "a `,` is missing here")
                .help("entries are separated by `,`");
        }
        return unquoted(under, span);
    }
    let is_word = |c: char| c.is_alphanumeric() || ".+-_%".contains(c);
    if message.starts_with("invalid float") || message.starts_with("invalid integer") {
        let before = raw.get(..span.start - line.start).unwrap_or("");
        let start = line.start + before.trim_end_matches(is_word).len();
        let whole = text.get(start..line.end).unwrap_or("").split(|c| !is_word(c)).next().unwrap_or("");
        if without_unit(whole).is_some() {
            return unquoted(whole, start..start + whole.len());
        }
        return syntax("this is no number".to_owned()).help("write numbers as `0.5`, `-3` or `1e-3`");
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
    let at_end = text.get(span.start..).unwrap_or("").trim_start();
    let closing = [under.trim(), at_end].into_iter().find_map(|rest| rest.chars().next());
    let unexpected = message.starts_with("unexpected") || message.starts_with("invalid key-value pair");
    if let (Some(c @ ('}' | ']')), true) = (closing, unexpected) {
        let fault = syntax(format!("this `{c}` closes nothing"));
        return fault.help("remove it, or add what it is to close");
    }
    in_plain_words(message, syntax)
}

/// What is left of the parser's messages.
fn in_plain_words(message: &str, syntax: impl FnOnce(String) -> Fault) -> Fault {
    let (words, help) = match message {
        _ if message.starts_with("unexpected key or value") => {
            ("nothing else may stand on this line", "begin a new line for the next `key = value`")
        }
        _ if message.starts_with("invalid unquoted key") || message.starts_with("invalid key-value pair") => {
            ("this is no key", "a line is `key = value`; a key has letters, digits, `_` and `-`")
        }
        _ if message.starts_with("extra comma") || message.starts_with("missing key for") => {
            ("a `,` with nothing before it", "remove it")
        }
        _ if message.starts_with("extra `=`") || message.starts_with("extra assignment") => {
            ("one `=` too many", "a line is `key = value`")
        }
        _ if message.starts_with("missing assignment") => {
            ("an `=` is missing here", "an entry is `key = value`")
        }
        _ if message.starts_with("missing value") => ("a value is missing here", "an entry is `key = value`"),
        _ if message.starts_with("unclosed array") || message.starts_with("missing comma between array") => {
            ("this list is not closed", "a list is written as `[1.0, 2.0]`")
        }
        _ if message.starts_with("invalid exponent") => {
            ("a power of ten without digits", "write `1e3` or `1e-3`")
        }
        _ if message.starts_with("invalid multi-line") => {
            ("this text has no closing quotes", "write it on one line in single quotes")
        }
        _ if message.starts_with("cannot extend") => (
            "this belongs to something that is no table, or is written above already",
            "write all keys of a table below one header",
        ),
        _ => return syntax(format!("this cannot be read: {message}")).help("a line is `key = value`"),
    };
    syntax(words.to_owned()).help(help)
}

/// `ts: 0.1` at or before the byte `at` of a line: the place of the colon, and how to write it.
fn colon(line: &str, at: usize) -> Option<(usize, String)> {
    let place = if line.get(at..).is_some_and(|rest| rest.starts_with(':')) {
        at
    } else {
        // The whole line is of the form `key: value`.
        line.find(':').filter(|&place| place <= at)?
    };
    let before = line.get(..place)?;
    let key = before.rsplit(['{', ',']).next()?.trim().trim_matches('"');
    let is_key = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let after = line.get(place + 1..)?.trim();
    let value = after.split([',', '}', '#']).next().unwrap_or("").trim();
    is_key.then(|| {
        let help = match value {
            "" => format!("write `[{key}]` for a table, `{key} = ...` for a value"),
            _ => format!("write `{key} = {}`", shortened(value)),
        };
        (place, help)
    })
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
        _ => match without_unit(value) {
            Some(help) => fault.help(help),
            None => fault.help(format!("write a text in quotes: `\"{shown}\"`")),
        },
    }
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
