//! Texts by hand with bits by hand: what the way from text to C makes of literals, ranks of operators, conversions.
//!
//! Bits are derived beside each: from integers that fit, from exact binary fractions, or by rounding a fraction to 23 or
//! 52 bits (IEEE 754, to nearest, ties to even). Ranks are those of IEC 61131-3: sign and NOT, then `* /`, `+ -`,
//! comparisons, AND, OR; equal ranks from the left.

use crate::compiled::{compile, compiler, not_run, run};
use crate::translate::translate;
use std::fmt::Write;

const BUILDS: [&[&str]; 2] = [&["-O0"], &["-O2", "-DBY_DOUBLE"]];

/// Outputs of a text for records of inputs, in both builds.
fn outputs(cc: &str, name: &str, text: &str, records: &[f64]) -> [Vec<f64>; 2] {
    let translated = translate(text).unwrap_or_else(|fault| panic!("{name}: {fault}\n{text}"));
    BUILDS.map(|options| run(&compile(cc, &format!("fixture_{name}"), &translated.source, options), records))
}

/// A block whose n-th output is the n-th expression.
fn block(inputs: &str, variables: &str, kind: &str, expressions: &[&str]) -> String {
    let mut text = format!("FUNCTION_BLOCK FIXTURE\nVAR_INPUT\n{inputs}\nEND_VAR\nVAR_OUTPUT\n");
    for n in 0..expressions.len() {
        let _ = writeln!(text, "OUT{n} : {kind};");
    }
    let _ = writeln!(text, "END_VAR\nVAR\n{variables}\nEND_VAR");
    for (n, expression) in expressions.iter().enumerate() {
        let _ = writeln!(text, "OUT{n} := {expression};");
    }
    text + "END_FUNCTION_BLOCK\n"
}

fn real() -> Vec<(&'static str, u32)> {
    vec![
        // 1.6/2^4; 0.6*2^23 = 5033164.8.
        ("0.1", 0x3DCC_CCCD),
        ("TENTH", 0x3DCC_CCCD),
        // 1.6777216/2^24; 0.6777216*2^23 = 5685140.8.
        ("1.0E-7", 0x33D6_BF95),
        ("1.0e-07", 0x33D6_BF95),
        ("-0.0", 0x8000_0000),
        // 2^24 + 1, half way: to the even 2^24. 2^24 + 3: to 2^24 + 4.
        ("16777217.0", 0x4B80_0000),
        ("16777219.0", 0x4B80_0002),
        // (2 - 2^-23)*2^127 and 2^-149.
        ("3.4028234663852886E38", 0x7F7F_FFFF),
        ("1.401298464324817E-45", 0x0000_0001),
        // 3, 9 = 1.125*8, -2, 18 = 1.125*16.
        ("TEN - FOUR - THREE", 0x4040_0000),
        ("TEN - (FOUR - THREE)", 0x4110_0000),
        ("TEN - FOUR * THREE", 0xC000_0000),
        ("(TEN - FOUR) * THREE", 0x4190_0000),
        // -0.5, 2.5.
        ("TEN / FOUR - THREE * ONE", 0xBF00_0000),
        ("TEN / FOUR", 0x4020_0000),
        // -12 = -1.5*8, 1, -7 = -1.75*4, -7.
        ("-(THREE) * FOUR", 0xC140_0000),
        ("-(THREE) + FOUR", 0x3F80_0000),
        ("-(THREE + FOUR)", 0xC0E0_0000),
        ("-THREE - FOUR", 0xC0E0_0000),
        // A sign is turned on zero too; 0 - 0 is +0.
        ("-(ZERO) * ONE", 0x8000_0000),
        ("-(ZERO)", 0x8000_0000),
        ("ZERO - ZERO", 0x0000_0000),
        ("-(ZERO - ZERO)", 0x8000_0000),
        // 2^24 + 1 is half way to 2^24 + 2 and rounded to 2^24 each time: no sum is kept in more digits.
        ("BIG + ONE + ONE", 0x4B80_0000),
        ("BIG + (ONE + ONE)", 0x4B80_0001),
        // 1.333/4: 0.333*2^23 = 2796202.7. Three times 11184811/2^25 is 1 + 2^-25, rounded to 1.
        ("ONE / THREE", 0x3EAA_AAAB),
        ("ONE / THREE * THREE", 0x3F80_0000),
        // 1.777/2^4: 0.777*2^23 = 6524472.9.
        ("ONE / (THREE * THREE)", 0x3DE3_8E39),
        // (1 + 2^-12)^2 = 1 + 2^-11 + 2^-24, half way, to the even 1 + 2^-11; a fused operation would give 2^-24.
        ("ROOT * ROOT - SQUARE", 0x0000_0000),
        // Half way from 1 to 1 + 2^-23, to the even 1; half way from 1 + 2^-23 on, to 1 + 2^-22.
        ("LREAL_TO_REAL((D_TIE))", 0x3F80_0000),
        ("LREAL_TO_REAL((D_TIE_ODD))", 0x3F80_0002),
        // 2^-150, half way from 0 to 2^-149; a little more.
        ("LREAL_TO_REAL((D_TINY))", 0x0000_0000),
        ("LREAL_TO_REAL((D_TINY * D_TIE))", 0x0000_0001),
        // Every REAL is an LREAL.
        ("LREAL_TO_REAL((REAL_TO_LREAL((TENTH))))", 0x3DCC_CCCD),
        ("LREAL_TO_REAL((REAL_TO_LREAL((SMALLEST))))", 0x0000_0001),
        ("LREAL_TO_REAL((REAL_TO_LREAL((-(ZERO)))))", 0x8000_0000),
        // The sum in LREAL is 2^24 + 1, then half way: 2^24; the sum of three is 2^24 + 2.
        ("LREAL_TO_REAL((REAL_TO_LREAL((BIG)) + D_ONE))", 0x4B80_0000),
        ("LREAL_TO_REAL((REAL_TO_LREAL((BIG)) + D_ONE + D_ONE))", 0x4B80_0001),
    ]
}

fn long() -> Vec<(&'static str, u64)> {
    vec![
        // 1.6/2^4; 0.6 is 0.(1001) in binary: 52 bits 9999999999999, the next bits 1001: up.
        ("0.1", 0x3FB9_9999_9999_999A),
        // 1.6777216/2^24; 0.6777216*2^52 = 3052186745220936.3 (6777216*2^52/10^7 in whole numbers).
        ("1.0E-7", 0x3E7A_D7F2_9ABC_AF48),
        ("-0.0", 0x8000_0000_0000_0000),
        // 2^53 + 1, half way.
        ("9007199254740993.0", 0x4340_0000_0000_0000),
        ("1.7976931348623157E308", 0x7FEF_FFFF_FFFF_FFFF),
        ("5.0E-324", 1),
        // 0x3DCCCCCD with 29 bits more.
        ("REAL_TO_LREAL((TENTH))", 0x3FB9_9999_A000_0000),
        // 2^-149 = 1*2^-149: exponent 1023 - 149 = 0x36A.
        ("REAL_TO_LREAL((SMALLEST))", 0x36A0_0000_0000_0000),
        // The sum of REALs is one of REALs: 2^24.
        ("REAL_TO_LREAL((BIG + ONE))", 0x4170_0000_0000_0000),
        ("D_BIG + D_ONE + D_ONE", 0x4340_0000_0000_0000),
        ("D_BIG + (D_ONE + D_ONE)", 0x4340_0000_0000_0001),
        // 3 and -3: from the left, and not.
        ("D_ONE + D_ONE + D_ONE", 0x4008_0000_0000_0000),
        ("-(D_ONE) - (D_ONE + D_ONE)", 0xC008_0000_0000_0000),
        ("-(D_ONE - D_ONE)", 0x8000_0000_0000_0000),
        // 1.333/4: 52 bits 5555555555555, the next bits 01: down.
        ("D_ONE / (D_ONE + D_ONE + D_ONE)", 0x3FD5_5555_5555_5555),
        // (1 + 2^-24)^2 = 1 + 2^-23 + 2^-48 exactly.
        ("D_TIE * D_TIE", 0x3FF0_0000_2000_0010),
    ]
}

#[test]
fn numbers_have_the_bits_that_are_due() {
    let Some(cc) = compiler() else { return not_run("numbers of texts by hand", "no C compiler") };
    // Values, as inputs so that no compiler forms a result beforehand; all are binary fractions.
    let given = [
        ("ZERO", "REAL", 0.0),
        ("ONE", "REAL", 1.0),
        ("THREE", "REAL", 3.0),
        ("FOUR", "REAL", 4.0),
        ("TEN", "REAL", 10.0),
        ("BIG", "REAL", 16_777_216.0),
        ("ROOT", "REAL", 1.0 + 2.0_f64.powi(-12)),
        ("SQUARE", "REAL", 1.0 + 2.0_f64.powi(-11)),
        ("SMALLEST", "REAL", 2.0_f64.powi(-149)),
        ("D_ONE", "LREAL", 1.0),
        ("D_BIG", "LREAL", 2.0_f64.powi(53)),
        ("D_TIE", "LREAL", 1.0 + 2.0_f64.powi(-24)),
        ("D_TIE_ODD", "LREAL", 1.0 + 3.0 * 2.0_f64.powi(-24)),
        ("D_TINY", "LREAL", 2.0_f64.powi(-150)),
    ];
    let inputs: Vec<String> = given.iter().map(|(name, kind, _)| format!("{name} : {kind};")).collect();
    let inputs = inputs.join("\n");
    let record: Vec<f64> = given.iter().map(|(.., value)| *value).collect();
    let expressions: Vec<&str> = real().iter().map(|(expression, _)| *expression).collect();
    let text = block(&inputs, "TENTH : REAL := 0.1;", "REAL", &expressions);
    for given in outputs(cc, "real", &text, &record) {
        assert_eq!(given.len(), real().len());
        for ((expression, bits), given) in real().iter().zip(given) {
            assert_eq!((given as f32).to_bits(), *bits, "{expression} gave {given:e}");
        }
    }
    let expressions: Vec<&str> = long().iter().map(|(expression, _)| *expression).collect();
    let text = block(&inputs, "TENTH : REAL := 0.1;", "LREAL", &expressions);
    for given in outputs(cc, "long", &text, &record) {
        assert_eq!(given.len(), long().len());
        for ((expression, bits), given) in long().iter().zip(given) {
            assert_eq!(given.to_bits(), *bits, "{expression} gave {given:e}");
        }
    }
}

/// A little above half way from 1 to 1 + 2^-23: at once up; by double precision it is half way, and goes to the even 1.
/// So the two builds do read decimals in two ways.
#[test]
fn a_decimal_is_read_at_once_or_by_double_precision() {
    let Some(cc) = compiler() else { return not_run("decimals of texts by hand", "no C compiler") };
    let text = block("UNUSED : REAL;", "UNUSED_TOO : REAL;", "REAL", &["1.00000005960464477539062500001"]);
    let [once, twice] = outputs(cc, "decimal", &text, &[0.0]).map(|out| (out[0] as f32).to_bits());
    assert_eq!((once, twice), (0x3F80_0001, 0x3F80_0000));
}

/// The n-th bit of a mask: the truth for the n-th record.
fn truths(cc: &str, name: &str, text: &str, records: &[f64], expected: &[(&str, u32)]) {
    for given in outputs(cc, name, text, records) {
        for (at, (expression, mask)) in expected.iter().enumerate() {
            let rows = given.chunks(expected.len()).enumerate();
            let found = rows.fold(0, |all, (n, row)| all | u32::from(row[at] != 0.0) << n);
            assert_eq!(found, *mask, "{expression}: {found:#x}");
        }
    }
}

#[test]
fn truths_are_those_of_the_standard() {
    let Some(cc) = compiler() else { return not_run("truths of texts by hand", "no C compiler") };
    // Record n is P, Q, R = the bits 2, 1, 0 of n.
    let expected = [
        ("P OR Q AND R", 0xF8),
        ("(P OR Q) AND R", 0xA8),
        ("P OR Q & R", 0xF8),
        ("NOT P AND Q", 0x0C),
        ("NOT (P AND Q)", 0x3F),
        ("NOT P OR Q AND R", 0x8F),
        ("P AND NOT Q OR R", 0xBA),
        ("NOT NOT P", 0xF0),
        ("P = Q AND R", 0x82),
        ("P = (Q AND R)", 0x87),
        ("P OR Q = R", 0xF9),
        ("(P OR Q) = R", 0xA9),
        ("P <> Q", 0x3C),
        ("P AND FALSE OR TRUE", 0xFF),
    ];
    let expressions = expected.map(|(expression, _)| expression);
    let text = block("P : BOOL;\nQ : BOOL;\nR : BOOL;", "X : BOOL := TRUE;", "BOOL", &expressions);
    let records: Vec<f64> = (0..8_u32).flat_map(|n| [2, 1, 0].map(|bit| f64::from(n >> bit & 1))).collect();
    truths(cc, "truth", &text, &records, &expected);
    // Nothing compares with NaN but by `<>`; the zeros are equal.
    let pairs = [(1.0, 2.0), (2.0, 2.0), (f64::NAN, 1.0), (f64::NAN, f64::NAN), (-0.0, 0.0), (2.0, 1.0)];
    let expected = [
        ("X < Y", 0x01),
        ("X <= Y", 0x13),
        ("X > Y", 0x20),
        ("X >= Y", 0x32),
        ("X = Y", 0x12),
        ("X <> Y", 0x2D),
        ("NOT (X >= Y)", 0x0D),
        ("X < Y OR X > Y", 0x21),
        // By rank (X + X) > Y: 2 > 2, 4 > 2, -, -, 0 > 0, 4 > 1.
        ("X + X > Y", 0x22),
    ];
    let records: Vec<f64> = pairs.iter().flat_map(|(x, y)| [*x, *y]).collect();
    for kind in ["REAL", "LREAL"] {
        let inputs = format!("X : {kind};\nY : {kind};");
        let text = block(&inputs, "Z : REAL;", "BOOL", &expected.map(|(expression, _)| expression));
        truths(cc, &format!("comparison_{kind}"), &text, &records, &expected);
    }
}

#[test]
fn whole_numbers_and_words() {
    let Some(cc) = compiler() else { return not_run("whole numbers of texts by hand", "no C compiler") };
    let text = block(
        "N : DINT;",
        "X : DINT;",
        "DINT",
        &["N + 1", "N - 1 - 2", "N - (1 - 2)", "-N * 3", "-2147483647"],
    );
    for given in outputs(cc, "whole", &text, &[5.0]) {
        assert_eq!(given, [6.0, 2.0, 6.0, -15.0, -2_147_483_647.0]);
    }
    let text =
        block("W : DWORD;", "HIGH : DWORD := 2147483648;", "DWORD", &["W OR HIGH OR 4", "W", "4294967295"]);
    for given in outputs(cc, "word", &text, &[5.0]) {
        assert_eq!(given, [2_147_483_653.0, 5.0, 4_294_967_295.0]);
    }
}

/// Kept from call to call; an array from -1 on; a loop that does not run; a branch without statements; names in any case.
#[test]
fn statements_run_in_their_order() {
    let Some(cc) = compiler() else { return not_run("statements of texts by hand", "no C compiler") };
    let text = "FUNCTION_BLOCK FIXTURE\nVAR_INPUT\nX : DINT;\nEND_VAR\n\
        VAR_OUTPUT\nSUM : DINT;\nBRANCH : DINT := 7;\nCALLS : DINT;\nEND_VAR\n\
        VAR CONSTANT\nONE : DINT := 1;\nEND_VAR\n\
        VAR\nI : DINT;\nCELLS : ARRAY [-1..2] OF DINT;\nEND_VAR\n\
        (* CALLS := 50; *)\nCALLS := Calls + one;\n\
        FOR I := -1 TO 2 DO\n    CELLS[I] := CELLS[I] + I * X;\nEND_FOR;\n\
        FOR I := 2 TO 1 DO\n    CALLS := 100;\nEND_FOR;\n\
        SUM := CELLS[-1] + CELLS[0] + CELLS[1] + CELLS[2];\n\
        IF X < 0 THEN\n    BRANCH := 1;\nELSIF X = 0 THEN\n    ;\nELSIF X < 10 THEN\n    BRANCH := 3;\n\
        ELSE\n    IF X > 10 THEN\n        BRANCH := 5;\n    END_IF;\nEND_IF;\nEND_FUNCTION_BLOCK\n";
    // Every call adds (-1 + 0 + 1 + 2)*X.
    let expected = [[0.0, 7.0, 1.0], [-4.0, 1.0, 2.0], [6.0, 3.0, 3.0], [26.0, 3.0, 4.0], [48.0, 5.0, 5.0]];
    for given in outputs(cc, "statements", text, &[0.0, -2.0, 5.0, 10.0, 11.0]) {
        assert_eq!(given, expected.concat());
    }
}

/// What has no translation, or no certain meaning, or is left out by the parser, is a fault.
#[test]
fn what_cannot_be_translated_is_a_fault() {
    let whole = |statement: &str| {
        format!(
            "FUNCTION_BLOCK FIXTURE\nVAR_INPUT\nX : REAL;\nN : DINT;\nEND_VAR\nVAR_OUTPUT\nY : REAL;\nEND_VAR\n\
             VAR CONSTANT\nC : DINT := 3;\nEND_VAR\nVAR\nL : LREAL;\nB : BOOL;\nI : DINT;\nW : DWORD;\n\
             A : ARRAY [0..3] OF REAL;\nEND_VAR\n{statement}\nEND_FUNCTION_BLOCK\n"
        )
    };
    assert!(translate(&whole("Y := X;")).is_ok());
    for statement in [
        // Types.
        "Y := L;",
        "L := X;",
        "Y := X + L;",
        "Y := X * 2;",
        "Y := 2;",
        "I := 2.0;",
        "B := 1;",
        "B := X = L;",
        "B := 1 < 2;",
        "B := B < B;",
        "B := W AND W;",
        "W := W + 1;",
        "Y := -B;",
        "B := NOT I;",
        "IF X THEN Y := X; END_IF;",
        // Operators, functions, statements.
        "I := N MOD 2;",
        "I := N / 2;",
        "Y := X ** X;",
        "B := B XOR B;",
        "Y := ABS((X));",
        "Y := REAL_TO_LREAL((X));",
        "L := REAL_TO_LREAL((L));",
        "Y := LREAL_TO_REAL(3.0);\nY := LREAL_TO_REAL((L), (L));",
        "WHILE B DO Y := X; END_WHILE;",
        "FOR I := 0 TO 3 BY 2 DO Y := X; END_FOR;",
        "FOR N := 0 TO 3 DO Y := X; END_FOR;",
        "RETURN;",
        "EXIT;",
        "Y();",
        // Places.
        "X := Y;",
        "C := 4;",
        "Z := X;",
        "Y := Z;",
        "Y := A;",
        "Y := X[0];",
        "Y := A[X];",
        "Y := A[0, 1];",
        "A := X;",
        "Y := A.X;",
        // What the parser lets pass or drops.
        "Y;",
        "Y := +X;",
        "Y := X",
        "IF B THEN Y := X END_IF;",
        "B := I = N = B;",
        "B := B = I < N;",
        "Y := 1.0E;",
        "Y := 1.;",
        "Y := 3.5E38;",
        "L := 1.0E309;",
        "I := 2147483648;",
        "I := 99999999999999999999;",
        "W := 4294967296;",
        "Y := X; END_FUNCTION_BLOCK $ Y := Y;",
        "Y := X; END_FUNCTION_BLOCK FUNCTION_BLOCK SECOND Y := X;",
        "Y := X; (* never ended",
        "Y := X; (* \u{e4} *)",
    ] {
        let found = translate(&whole(statement));
        assert!(found.is_err(), "{statement} was translated:\n{}", found.expect("source").source);
    }
    for declaration in [
        "IN_OUT : REAL;\nEND_VAR\nVAR_IN_OUT\nD : REAL;",
        "D : INT;",
        "D : REAL := 1;",
        "D : BOOL := 0;",
        "D AT %QW1 : DINT;",
        "D : ARRAY [0..1, 0..1] OF REAL;",
        "D : ARRAY [0..C] OF REAL;",
        "D : ARRAY [3..0] OF REAL;",
        "D : REF_TO REAL;",
        "x : REAL;",
        "D : STRING;",
        "END_VAR\nVAR RETAIN\nD : REAL;",
    ] {
        let text = whole("Y := X;").replace("W : DWORD;", declaration);
        assert!(translate(&text).is_err(), "{declaration}");
    }
}
