//! Mistakes people make: every one is found, at its place, with the help that fits.

use controller_design::model::{MAX_ERRORS, parse};

/// `(text under the caret, part of the message, part of the help)`; the help is empty where there need be none.
type Fault = (&'static str, &'static str, &'static str);

#[rustfmt::skip]
const FAULTS: &[(&str, &[Fault])] = &[
    // what may have been meant
    ("1/(1+S)", &[("S", "unknown name `S`", "lower-case `s`")]),
    ("1/(1+0.5*z)", &[("z", "unknown name `z`", "discrete-time")]),
    ("1/(1+p)", &[("p", "unknown name `p`", "written `s`")]),
    ("e^(-s)/(1+s)", &[("e", "unknown name `e`", "exp(-T*s)")]),
    ("Exp(-s)/(1+s)", &[("Exp", "unknown name `Exp`", "lower case")]),
    ("1/(j*s+1)", &[("j", "unknown name `j`", "1+a1*s+a2*s^2")]),
    ("K/(1+tau*s)", &[("K", "unknown name `K`", "number itself"), ("tau", "unknown name `tau`", "number itself")]),
    ("tanh(s)/(1+s)", &[("tanh", "unknown name", "only function is `exp`")]),
    ("1/(1+s2)", &[("s2", "unknown name `s2`", "`s^2`")]),
    ("1/(1+ss)", &[("ss", "unknown name `ss`", "`s^2`")]),
    ("exp-s/(1+s)", &[("exp", "parentheses", "exp(-T*s)")]),
    ("exp s/(1+s)", &[("exp", "parentheses", "exp(-T*s)")]),
    ("exp*2", &[("exp", "parentheses", "exp(-T*s)")]),
    ("G(s) = 1/(1+s)", &[("=", "an equation", "right of the `=`")]),
    // numbers
    ("1/(1+0,2*s)", &[(",", "decimal comma", "write `0.2`")]),
    ("2,5e-1/(1+s)", &[(",", "decimal comma", "write `2.5e-1`")]),
    ("1,000/(1+s)", &[(",", "decimal comma", "`1000`")]),
    ("1e999/(1+s)", &[("1e999", "too large", "")]),
    ("1e-999/(1+s)", &[("1e-999", "too small", "")]),
    ("1.2.3/(1+s)", &[("1.2.3", "more than one point", "")]),
    ("1_000/(1+s)", &[("1_000", "separators", "")]),
    ("3e+/(1+s)", &[("3e+", "power of ten without digits", "")]),
    ("./(1+s)", &[(".", "point without digits", "")]),
    // characters
    ("2\u{b7}s/(1+s)", &[("\u{b7}", "not understood", "write `*`")]),
    ("1/(1\u{2212}2*s)", &[("\u{2212}", "not understood", "write `-`")]),
    ("1/(1+s\u{b2})", &[("\u{b2}", "not understood", "write `^2`")]),
    ("1/[1+s)", &[("[", "not understood", "write `(`")]),
    ("1/(1+s)**2", &[("**", "not understood", "`^`")]),
    ("1/(1+$%s)", &[("$%", "no meaning", "")]),
    ("exp(-s, 2)/(1+s)", &[(",", "no meaning", "")]),
    // operators and operands
    ("2s/(1+s)", &[("2s", "an operator is missing between `2` and `s`", "write `2*s`")]),
    ("3 (1+s)^-1", &[("3 (", "missing between `3` and `(`", "write `3*(1+s)^-1`")]),
    ("1/((1+s)(1+2*s))", &[(")(", "missing between `)` and `(`", "write `(1+s)*(1+2*s)`")]),
    ("2exp(-s)/(1+s)", &[("2exp", "missing between `2` and `exp`", "write `2*exp(-s)`")]),
    ("s(1+s)", &[("s(", "missing between `s` and `(`", "write `s*(1+s)`")]),
    ("2/(1+10*s)(1+s)", &[(")(", "missing between `)` and `(`", "write `2/((1+10*s)*(1+s))`")]),
    ("1/(1+s)(1+2s)", &[(")(", "missing between `)` and `(`", "write `1/((1+s)*(1+2*s))`"), ("2s", "missing", "write `2*s`")]),
    ("2*exp(-s)/(1+s)^2 (1+2*s)(1+3*s)", &[("2 (", "missing between `2` and `(`", "write `2*exp(-s)/((1+s)^2*(1+2*s)*(1+3*s))`")]),
    ("3+1/2s", &[("2s", "missing between `2` and `s`", "write `1/(2*s)`")]),
    ("1/(1+s)*2(1+s)", &[("2(", "missing between `2` and `(`", "write `2*(1+s)`")]),
    ("1/(1+0.123456789*s+0.123456789*s^2)(1+0.123456789*s+0.123456789*s^2)(1+0.123*s)", &[(")(", "missing", ".../(a*b)")]),
    ("2 3", &[("2 3", "missing between `2` and `3`", "")]),
    ("1/(1+s)+", &[("+", "`+` has nothing to its right", "remove it")]),
    ("1/(1+)", &[("+", "`+` has nothing to its right", "remove it")]),
    ("2*", &[("*", "`*` has nothing to its right", "remove it")]),
    ("-", &[("-", "`-` has nothing to its right", "remove it")]),
    ("*2", &[("*", "`*` has nothing to its left", "remove it")]),
    ("(/2)", &[("/", "`/` has nothing to its left", "remove it")]),
    ("1//(1+s)", &[("//", "a value is missing between `/` and `/`", "")]),
    ("2^", &[("^", "`^` has nothing to its right", "")]),
    // parentheses
    ("1/((1+s)*2", &[("(", "never closed", "add the `)`")]),
    ("1/(", &[("(", "never closed", "add the `)`")]),
    ("exp(-s/(1+s)", &[("(", "never closed", "add the `)`")]),
    ("2*exp(-s/(1+10*s)+1", &[("(", "never closed", "add the `)`")]),
    ("(exp(-s)/(1+s)+1", &[("(", "never closed", "add the `)`")]),
    ("1/(1+s))", &[(")", "never opened", "remove it")]),
    (")", &[(")", "never opened", "remove it")]),
    ("2*()", &[("()", "nothing in these parentheses", "")]),
    ("exp()", &[("()", "nothing in these parentheses", "exp(-T*s)")]),
    ("", &[("", "no expression", "write a plant")]),
    (" \t", &[(" \t", "no expression", "write a plant")]),
    // dead times
    ("exp(2*s)/(1+s)", &[("2*s", "a dead time cannot be negative", "write `exp(-2*s)`")]),
    ("exp(s)/(1+s)", &[("s", "a dead time cannot be negative", "write `exp(-s)`")]),
    ("1/((1+s)*exp(-s))", &[("1/((1+s)*exp(-s))", "a dead time cannot be negative", "numerator")]),
    ("exp(2)/(1+s)", &[("2", "`exp` of a constant", "7.38906")]),
    ("exp(1-s)/(1+s)", &[("1-s", "constant part, 1", "2.71828*exp(-T*s)")]),
    ("exp(-s^2)/(1+s)", &[("-s^2", "must come to -T*s", "exp(-T*s)")]),
    ("exp(-1/s)/(1+s)", &[("-1/s", "must come to -T*s", "exp(-T*s)")]),
    ("exp(-s*exp(-s))/(1+s)", &[("-s*exp(-s)", "an `exp` in the argument", "")]),
    ("1/(1+s)+exp(-s)/(1+s)", &[("1/(1+s)+exp(-s)/(1+s)", "different dead times, 0 s and 1 s", "one dead time")]),
    ("2*exp(-s)/1+10*s", &[("2*exp(-s)/1+10*s", "different dead times, 1 s and 0 s", "parentheses: `2*exp(-s)/(1+10*s)`")]),
    ("3*(exp(-s)/1+s+s^2)", &[("exp(-s)/1+s", "different dead times", "parentheses: `exp(-s)/(1+s+s^2)`")]),
    // values
    ("1/0", &[("0", "division by zero", "")]),
    ("1/(s-s)", &[("(s-s)", "division by zero", "")]),
    ("(s-s)^-1", &[("(s-s)^-1", "division by zero", "")]),
    ("0^0", &[("0^0", "0^0 has no value", "")]),
    ("0/(1+s)", &[("0/(1+s)", "0 for every s", "")]),
    ("0.1+0.2-0.3", &[("0.1+0.2-0.3", "0 for every s", "")]),
    ("s/(1+s)*s", &[("s/(1+s)*s", "more zeros than poles", "filter")]),
    ("1/1+s", &[("1/1+s", "more zeros than poles", "parentheses")]),
    ("s^0.5", &[("0.5", "whole number; it is 0.5", "")]),
    ("2^s", &[("s", "exponent must be a number", "")]),
    ("1/(1+s)^21", &[("21", "exponent 21 is too large; at most 20", "")]),
    ("1/(1+s)^1e300", &[("1e300", "too large", "")]),
    ("1/((1+s)^5)^5", &[("((1+s)^5)^5", "the order here is 25; allowed are at most 20", "")]),
    ("1e300*1e300/(1+s)", &[("1e300*1e300", "too large or too small", "")]),
    ("1e-300*1e-300/(1+s)", &[("1e-300*1e-300", "too large or too small", "")]),
    // several at once
    ("2s/(1+0,5*S", &[("2s", "operator is missing", "2*s"), ("(", "never closed", ""), (",", "decimal comma", "0.5"),
        ("S", "unknown name", "")]),
    ("exp(s)/(1+s)+1/0", &[("s", "cannot be negative", ""), ("0", "division by zero", "")]),
    ("1/(1+s))*(1+2s))", &[(")", "never opened", ""), ("2s", "operator is missing", ""), (")", "never opened", "")]),
    ("(1+)*(2*)", &[("+", "nothing to its right", ""), ("*", "nothing to its right", "")]),
    ("1e999*x+1e-999", &[("1e999", "too large", ""), ("x", "unknown name", ""), ("1e-999", "too small", "")]),
];

#[test]
fn every_fault_is_named_at_its_place() {
    for (text, expected) in FAULTS {
        let errors = match parse(text) {
            Ok(g) => panic!("`{text}` was read as {g}"),
            Err(errors) => errors,
        };
        assert_eq!(errors.len(), expected.len(), "`{text}`: {errors:?}");
        for (error, (place, message, help)) in errors.iter().zip(*expected) {
            assert_eq!(text.get(error.span.clone()), Some(*place), "`{text}`: {error:?}");
            assert!(error.message.contains(message), "`{text}`: {error:?}");
            assert!(error.help.as_deref().unwrap_or("").contains(help), "`{text}`: {error:?}");
            assert!(!error.message.ends_with('.'), "`{text}`: {error:?}");
        }
    }
}

/// Spans where the text under the caret occurs several times.
#[test]
fn spans_point_at_the_right_one_of_several() {
    let span = |text: &str| parse(text).expect_err("a mistake")[0].span.clone();
    assert_eq!(span("1/((1+s)*(1+2*s)"), 2..3);
    assert_eq!(span("(1+s)/((1+s)"), 6..7);
    assert_eq!(span("1/(1+s))"), 7..8);
    assert_eq!(span("1/(1+s)*exp(s)"), 12..13);
    assert_eq!(span("1/(2+s)/0/2"), 8..9);
    assert_eq!(span("1+1+"), 3..4);
}

#[test]
fn a_text_too_long_is_not_read() {
    let errors = parse(&"1+".repeat(3000)).expect_err("too long");
    assert_eq!((errors.len(), errors[0].span.clone()), (1, 4096..6000));
    // The limit falls into a character of two bytes.
    let errors = parse(&format!("1{}", "\u{e9}".repeat(3000))).expect_err("too long");
    assert_eq!(errors[0].span, 4095..6001);
}

#[test]
fn nesting_too_deep_is_refused_without_overflowing_the_stack() {
    for (unit, repeats) in
        [("(", 4000), ("2^", 2000), ("exp(", 1000), ("exp ", 1000), ("-(", 2000), ("K(", 2000)]
    {
        let errors = parse(&format!("{}s", unit.repeat(repeats))).expect_err("too deep");
        assert!(
            errors.iter().any(|e| e.message.contains("nesting is too deep")) || errors.len() == MAX_ERRORS
        );
    }
    // Balanced: the depth is then the only mistake.
    let errors = parse(&format!("{}s{}", "(".repeat(100), ")".repeat(100))).expect_err("too deep");
    assert_eq!((errors.len(), errors[0].span.clone()), (1, 64..65));
}

#[test]
fn no_more_than_the_stated_number_of_errors_comes_back() {
    let errors = parse(&"x+".repeat(1000)).expect_err("many unknown names");
    assert_eq!(errors.len(), MAX_ERRORS);
    assert_eq!(errors[MAX_ERRORS - 1].span, 38..39);
}
