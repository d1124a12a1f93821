//! The text in tokens. What cannot be read is reported here, once, and leaves a token that keeps the parser from
//! reporting it again.

use std::borrow::ToOwned;
use std::string::String;
use std::vec::Vec;

use super::names;
use crate::model::error::{ExpressionError, Span};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Number(f64),
    S,
    Exp,
    Plus,
    Minus,
    Star,
    Slash,
    Caret,
    Open,
    Close,
    /// A number or name that was reported: stands for a value.
    Unknown,
    /// Characters that were reported: may stand for anything.
    Junk,
}

impl Kind {
    /// Whether a value can begin with this token, signs left aside.
    pub(super) const fn begins_value(self) -> bool {
        matches!(self, Self::Number(_) | Self::S | Self::Exp | Self::Open | Self::Unknown)
    }

    /// Whether this is an operator, signs included.
    pub(super) const fn is_operator(self) -> bool {
        matches!(self, Self::Plus | Self::Minus | Self::Star | Self::Slash | Self::Caret)
    }
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) span: Span,
}

/// All tokens and all mistakes found in making them.
pub(super) fn tokenise(text: &str) -> (Vec<Token>, Vec<ExpressionError>) {
    let mut scanner = Scanner { text, at: 0, tokens: Vec::new(), errors: Vec::new() };
    while let Some(c) = scanner.rest().chars().next() {
        scanner.scan(c);
    }
    (scanner.tokens, scanner.errors)
}

/// A short form of a piece of text for messages.
pub(super) fn shown(piece: &str) -> String {
    const LONGEST: usize = 24;
    if piece.chars().count() <= LONGEST {
        piece.to_owned()
    } else {
        piece.chars().take(LONGEST).chain("...".chars()).collect()
    }
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
    tokens: Vec<Token>,
    errors: Vec<ExpressionError>,
}

impl<'t> Scanner<'t> {
    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or("")
    }

    /// Moves on by `length` bytes and returns their span.
    fn advance(&mut self, length: usize) -> Span {
        let start = self.at;
        self.at += length;
        Span::new(start, self.at)
    }

    fn push(&mut self, kind: Kind, length: usize) -> Span {
        let span = self.advance(length);
        self.tokens.push(Token { kind, span });
        span
    }

    /// A token that is understood but must be written differently.
    fn push_misspelt(&mut self, kind: Kind, length: usize, help: impl Into<String>) {
        let span = self.push(kind, length);
        let message = format!("`{}` is not understood here", span.of(self.text));
        self.errors.push(ExpressionError::new(span, message).with_help(help));
    }

    fn scan(&mut self, c: char) {
        let length = c.len_utf8();
        if c.is_whitespace() {
            self.advance(length);
        } else if c.is_ascii_digit() || c == '.' {
            self.number();
        } else if is_name_start(c) {
            self.name();
        } else if self.rest().starts_with("**") {
            self.push_misspelt(Kind::Caret, 2, "a power is written with `^`");
        } else if let Some(kind) = plain(c) {
            self.push(kind, length);
        } else if c == '=' {
            self.equals();
        } else if let Some((kind, spelling)) = lookalike(c) {
            self.push_misspelt(kind, length, format!("write `{spelling}`"));
        } else if let Some(power) = superscript(c) {
            self.push_misspelt(Kind::Junk, length, format!("write `^{power}`"));
        } else {
            self.foreign();
        }
    }

    /// `G(s) = ...`: what stands to the left is not read any further.
    fn equals(&mut self) {
        self.tokens.clear();
        self.errors.clear();
        let span = self.advance(1);
        self.errors.push(
            ExpressionError::new(span, "an equation, where an expression is expected")
                .with_help("write only what is to the right of the `=`"),
        );
    }

    /// A run of characters without any meaning is one mistake.
    fn foreign(&mut self) {
        let run: String = self.rest().chars().take_while(|&c| is_foreign(c)).collect();
        // One character at least, or the scan would stand still.
        let length = run.len().max(self.rest().chars().next().map_or(1, char::len_utf8));
        let span = self.push(Kind::Junk, length);
        let message =
            format!("`{}` has no meaning in a plant expression", shown(span.of(self.text)).escape_debug());
        self.errors.push(ExpressionError::new(span, message));
    }

    fn name(&mut self) {
        let rest = self.rest();
        let length = rest.find(|c: char| !(is_name_start(c) || c.is_ascii_digit())).unwrap_or(rest.len());
        let name = rest.get(..length).unwrap_or("");
        match name {
            "s" => self.push(Kind::S, length),
            "exp" => self.push(Kind::Exp, length),
            _ => {
                let span = self.push(Kind::Unknown, length);
                let message = format!("unknown name `{}`", shown(name));
                self.errors.push(ExpressionError::new(span, message).with_help(names::suggestion(name)));
                span
            }
        };
    }

    fn number(&mut self) {
        let rest = self.rest();
        let whole = digits(rest, 0);
        let mut length = whole;
        if byte(rest, length) == Some(b'.') {
            length += 1 + digits(rest, length + 1);
        }
        let after_comma = digits(rest, length + 1);
        if length == 1 && whole == 0 {
            self.push_unreadable(1, "a decimal point without digits");
        } else if whole == length && byte(rest, length) == Some(b',') && after_comma > 0 {
            self.decimal_comma(whole, after_comma);
        } else {
            match exponent(rest, length) {
                Exponent::None => {}
                Exponent::Digits(n) => length += n,
                Exponent::Broken(n) => {
                    return self.push_unreadable(length + n, "a power of ten without digits");
                }
            }
            let more = rest.get(length..).unwrap_or("");
            let tail =
                more.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '_')).unwrap_or(more.len());
            if tail > 0 && (more.starts_with('.') || digits(more, 1) > 0) {
                return self
                    .push_unreadable(length + tail, "a number with more than one point or with separators");
            }
            self.push_number(length);
        }
    }

    /// A number that has the form of one; only its size can be wrong.
    fn push_number(&mut self, length: usize) {
        let piece = self.rest().get(..length).unwrap_or("");
        let value: f64 = piece.parse().unwrap_or(f64::NAN);
        let mantissa = piece.split(['e', 'E']).next().unwrap_or("");
        let is_zero = !mantissa.bytes().any(|b| matches!(b, b'1'..=b'9'));
        if value.is_finite() && (value != 0.0 || is_zero) {
            self.push(Kind::Number(value), length);
            return;
        }
        let (what, bound) = if value == 0.0 {
            ("small", "the smallest is 5e-324")
        } else {
            ("large", "the largest is 1.7e308")
        };
        self.push_unreadable(length, format!("the number `{}` is too {what}; {bound}", shown(piece)));
    }

    fn push_unreadable(&mut self, length: usize, message: impl Into<String>) {
        let span = self.push(Kind::Unknown, length);
        self.errors.push(ExpressionError::new(span, message));
    }

    fn decimal_comma(&mut self, whole: usize, fraction: usize) {
        let rest = self.rest();
        let length = whole + 1 + fraction;
        let power = if let Exponent::Digits(n) = exponent(rest, length) { n } else { 0 };
        let piece = rest.get(..length + power).unwrap_or("");
        let span = self.push(Kind::Unknown, length + power);
        let comma = Span::new(span.start + whole, span.start + whole + 1);
        let mut help = format!("write `{}`", shown(&piece.replacen(',', ".", 1)));
        if fraction == 3 && whole <= 3 && !piece.starts_with('0') {
            help.push_str(&format!(
                ", or `{}` if the comma was to separate thousands",
                piece.replacen(',', "", 1)
            ));
        }
        let message = "a decimal comma; numbers are written with a point";
        self.errors.push(ExpressionError::new(comma, message).with_help(help));
    }
}

fn byte(text: &str, at: usize) -> Option<u8> {
    text.as_bytes().get(at).copied()
}

/// Number of ASCII digits from `at` on.
fn digits(text: &str, at: usize) -> usize {
    text.as_bytes().iter().skip(at).take_while(|b| b.is_ascii_digit()).count()
}

/// What follows the mantissa of a number, with its length in bytes.
enum Exponent {
    None,
    Digits(usize),
    Broken(usize),
}

fn exponent(text: &str, at: usize) -> Exponent {
    if !matches!(byte(text, at), Some(b'e' | b'E')) {
        return Exponent::None;
    }
    let sign = usize::from(matches!(byte(text, at + 1), Some(b'+' | b'-')));
    let count = digits(text, at + 1 + sign);
    if count > 0 {
        return Exponent::Digits(1 + sign + count);
    }
    // `2exp(-s)` and `2e^(-s)` are a number and a name with an operator missing.
    match text.get(at + 1..).and_then(|rest| rest.chars().next()) {
        Some(c) if sign == 0 && (is_name_start(c) || c == '^' || c == '(') => Exponent::None,
        _ => Exponent::Broken(1 + sign),
    }
}

fn is_name_start(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_foreign(c: char) -> bool {
    let known = c.is_whitespace() || c.is_ascii_digit() || is_name_start(c) || matches!(c, '.' | '=');
    !known && plain(c).is_none() && lookalike(c).is_none() && superscript(c).is_none()
}

const fn plain(c: char) -> Option<Kind> {
    Some(match c {
        '+' => Kind::Plus,
        '-' => Kind::Minus,
        '*' => Kind::Star,
        '/' => Kind::Slash,
        '^' => Kind::Caret,
        '(' => Kind::Open,
        ')' => Kind::Close,
        _ => return None,
    })
}

/// Characters that word processors and other notations put in place of the plain ones.
const fn lookalike(c: char) -> Option<(Kind, char)> {
    Some(match c {
        '\u{2212}' | '\u{2010}'..='\u{2014}' => (Kind::Minus, '-'),
        '\u{d7}' | '\u{b7}' | '\u{22c5}' | '\u{2219}' | '\u{2217}' => (Kind::Star, '*'),
        '\u{f7}' | '\u{2215}' | '\u{2044}' | ':' => (Kind::Slash, '/'),
        '[' | '{' => (Kind::Open, '('),
        ']' | '}' => (Kind::Close, ')'),
        _ => return None,
    })
}

const fn superscript(c: char) -> Option<char> {
    Some(match c {
        '\u{b9}' => '1',
        '\u{b2}' => '2',
        '\u{b3}' => '3',
        '\u{2074}' => '4',
        '\u{2075}' => '5',
        '\u{2076}' => '6',
        '\u{2077}' => '7',
        '\u{2078}' => '8',
        '\u{2079}' => '9',
        _ => return None,
    })
}
