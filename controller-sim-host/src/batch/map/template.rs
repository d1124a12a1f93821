//! A plant with letters for numbers.

use std::ops::Range;

/// An expression in s in which other names stand for numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Template {
    text: String,
    /// Where names stand, in order.
    names: Vec<Range<usize>>,
}

impl Template {
    /// Finds the names in an expression.
    ///
    /// ```
    /// use controller_sim_host::batch::map::Template;
    ///
    /// let plant = Template::new("exp(-T*s)/(1+r*s)^n");
    /// assert_eq!(plant.names(), ["T", "r", "n"]);
    /// assert_eq!(plant.with(|name| if name == "n" { 2.0 } else { 0.5 }), "exp(-(0.5)*s)/(1+(0.5)*s)^2");
    /// ```
    #[must_use]
    pub fn new(text: &str) -> Self {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let mut names = Vec::new();
        let mut at = 0;
        while let Some(c) = text[at..].chars().next() {
            let end = if c.is_ascii_digit() || c == '.' {
                at + number(&text[at..])
            } else if is_word(c) {
                at + text[at..].find(|c| !is_word(c)).unwrap_or(text.len() - at)
            } else {
                at + c.len_utf8()
            };
            if c.is_ascii_alphabetic() && !matches!(&text[at..end], "s" | "exp") {
                names.push(at..end);
            }
            at = end;
        }
        Self { text: text.to_owned(), names }
    }

    /// As it was written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its names, each once, in order.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        let mut list: Vec<&str> = Vec::new();
        for range in &self.names {
            let name = &self.text[range.clone()];
            if !list.contains(&name) {
                list.push(name);
            }
        }
        list
    }

    /// The expression with numbers for names.
    #[must_use]
    pub fn with(&self, value: impl Fn(&str) -> f64) -> String {
        let mut out = String::new();
        let mut from = 0;
        for range in &self.names {
            let before = &self.text[from..range.start];
            out.push_str(before);
            let number = crate::batch::show(value(&self.text[range.clone()]));
            // An exponent is a bare number.
            if before.trim_end().ends_with('^') {
                out.push_str(&number);
            } else {
                out.push_str(&format!("({number})"));
            }
            from = range.end;
        }
        out.push_str(&self.text[from..]);
        out
    }
}

/// The length of the number at the beginning of a text: digits, a point, an exponent that has digits.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let behind = digits(end + 1 + sign);
        if behind > end + 1 + sign {
            end = behind;
        }
    }
    end.max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller_design::model::parse;

    #[test]
    fn numbers_are_no_names() {
        for (text, names) in [
            ("1e-3*exp(-2.5e+1*s)/(1+1E4*s)", &[][..]),
            ("K*exp(-T*s)/(1+tau_1*s)/(1+tau_2*s)", &["K", "T", "tau_1", "tau_2"]),
            ("2e/(1+3.e2*s+.5*a*s^2)", &["e", "a"]),
            ("\u{3b1}/(1+s)", &[]),
            ("", &[]),
        ] {
            assert_eq!(Template::new(text).names(), names, "{text}");
        }
    }

    #[test]
    fn what_is_filled_in_can_be_read() {
        let plant = |text: &str, x: f64| parse(&Template::new(text).with(|_| x));
        assert_eq!(plant("exp(-T*s)/(1+(1-T)*s)", 0.25), parse("exp(-0.25*s)/(1+0.75*s)"));
        assert_eq!(plant("1/(1+s)^n", 3.0), parse("1/(1+s)^3"));
        assert_eq!(plant("K/(1+s)", -2e-7), parse("-2e-7/(1+s)"));
        assert!(plant("1/(1+s)^n", 2.5).is_err());
    }
}
