//! The tokens of a text, taken one by one beside the foreign parser's tree.
//!
//! The parser drops some things without a word: a statement that is only a name, a sign `+`, what follows a character
//! that it does not know; a number that it cannot read becomes 0. Taking every token in its turn shows all of that, and
//! gives each number as it is written.

use iec61131::{Lexer, Token};

/// The tokens of one text and the place of the next.
pub(super) struct Tokens {
    list: Vec<(Token, usize)>,
    next: usize,
}

impl Tokens {
    pub(super) fn of(text: &str) -> Result<Self, String> {
        if !text.is_ascii() {
            return Err("a character that is not ASCII".to_owned());
        }
        let mut lexer = Lexer::new(text);
        let mut list = Vec::new();
        loop {
            let found = lexer.next_token();
            let before = text.get(..found.span.start).unwrap_or(text);
            let line = 1 + before.matches('\n').count();
            if found.token != Token::Eof {
                list.push((found.token, line));
            } else if found.span.start < text.len() {
                return Err(format!("line {line}: a character that means nothing"));
            } else {
                return Ok(Self { list, next: 0 });
            }
        }
    }

    /// What is wrong, with the line at which it is.
    pub(super) fn fault(&self, what: &str) -> String {
        let at = self.list.get(self.next.saturating_sub(1)).map_or(0, |(_, line)| *line);
        format!("line {at}: {what}")
    }

    pub(super) fn is(&self, token: &Token) -> bool {
        self.list.get(self.next).is_some_and(|(found, _)| found == token)
    }

    /// The next token must be this one.
    pub(super) fn take(&mut self, token: &Token) -> Result<(), String> {
        let found = self.list.get(self.next).map(|(found, _)| found);
        if found != Some(token) {
            let found = found.map_or("the end".to_owned(), |found| format!("{found:?}"));
            return Err(self.fault(&format!("the tree says {token:?}, the text {found}")));
        }
        self.next += 1;
        Ok(())
    }

    /// The next token must be this one, if it is there at all.
    pub(super) fn skip(&mut self, token: &Token) -> bool {
        let there = self.is(token);
        self.next += usize::from(there);
        there
    }

    pub(super) fn name(&mut self, name: &str) -> Result<(), String> {
        self.take(&Token::Identifier(name.to_owned()))
    }

    /// The next token, a whole number, as it is written.
    pub(super) fn whole(&mut self) -> Result<String, String> {
        match self.list.get(self.next) {
            Some((Token::IntLiteral(digits), _)) => {
                let digits = digits.clone();
                self.next += 1;
                Ok(digits)
            }
            _ => Err(self.fault("no whole number stands here")),
        }
    }

    /// The next token, a number with a point, as it is written.
    pub(super) fn decimal(&mut self) -> Result<String, String> {
        match self.list.get(self.next) {
            Some((Token::RealLiteral(digits), _)) if is_decimal(digits) => {
                let digits = digits.clone();
                self.next += 1;
                Ok(digits)
            }
            _ => Err(self.fault("no number with a point stands here")),
        }
    }

    pub(super) fn end(&self) -> Result<(), String> {
        match self.list.get(self.next) {
            None => Ok(()),
            Some((token, line)) => Err(format!("line {line}: {token:?} behind the end of the tree")),
        }
    }
}

/// The standard's real literal: digits, a point, digits, and perhaps an exponent with digits.
fn is_decimal(text: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|c| c.is_ascii_digit());
    let (number, exponent) = text.split_once(['E', 'e']).unwrap_or((text, "0"));
    let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    number.split_once('.').is_some_and(|(whole, part)| digits(whole) && digits(part)) && digits(exponent)
}
