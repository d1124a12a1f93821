//! Name and head of an exported function block.

use super::Export;
use crate::simulate::Precision;

/// Longest name of a block: what the oldest programming systems take.
const LONGEST: usize = 24;

/// The name of the block: letters, digits and single underscores of the controller's name behind `FB_`.
pub(super) fn name(controller: &str) -> String {
    let mut name = String::from("FB");
    let mut gap = true;
    for c in controller.chars() {
        if !c.is_ascii_alphanumeric() {
            gap = true;
            continue;
        }
        if name.len() + 1 + usize::from(gap) > LONGEST {
            break;
        }
        if gap {
            name.push('_');
        }
        gap = false;
        name.push(c.to_ascii_uppercase());
    }
    if name == "FB" { "FB_LOOP".to_owned() } else { name }
}

/// What the file says of itself.
pub(super) fn lines(export: &Export<'_>, origin: &str, tunable: bool) -> Vec<String> {
    let real = match export.precision {
        Precision::F32 => "REAL",
        Precision::F64 => "LREAL",
    };
    let mut lines = vec![format!(
        "{}: the loop of {}, exported by controller-sim export --format st.",
        plain(export.name()),
        plain(origin)
    )];
    lines.push(format!(
        "Call it once every {:?} s, in a task of this period. Numbers are {real}.",
        export.ts()
    ));
    let mut more = |words: &str| lines.push(words.to_owned());
    more("Do not change numbers here: they have passed checks that this file cannot repeat.");
    more("Bits: every output is that of the reference step, bit for bit, where");
    match export.precision {
        Precision::F32 => {
            more(
                "- each assignment of a REAL is rounded to IEEE 754 single precision, to nearest, ties to even;",
            );
            more("  one operation stands in each, so that it may be formed in REAL or in LREAL;");
            more("- LREAL, used only while tuning, is IEEE 754 double precision;");
        }
        Precision::F64 => {
            more(
                "- each operation on LREAL is rounded once, to IEEE 754 double precision, to nearest, ties to even;",
            );
        }
    }
    more(
        "- no statement is fused with another or rearranged: no fast or relaxed floating-point option; where the PLC",
    );
    more("  compiles by way of C with gcc, -ffp-contract=off;");
    more("- numbers below the normal range are kept, and comparisons with NaN are false.");
    more("Elsewhere the block does the same to rounding; a NaN or infinite input may then not be found.");
    more("Start: an instance settles itself at its first good PV, at the output BKCAL_IN or OP_INITIAL.");
    more(
        "Bad PV (not finite, out of range, PV_QUALITY not 0 or 1): output and terms are held for HOLD_SAMPLES calls,",
    );
    more("  then the fallback; the next good PV settles the block where it is. STATUS tells.");
    more(match tunable {
        true => {
            "KP, TN, TV, TF may change at any time: taken at the next call without a bump, or refused (ST_PAR_REFUSED)."
        }
        false => "This loop has no KP, TN, TV to tune: export it again to change its parameters.",
    });
    lines
}

/// Text of a person in a comment: printable, and nothing that could end or begin one.
pub(super) fn plain(text: &str) -> String {
    let shown = |c: char| if c.is_ascii_graphic() && !"*{}$\\".contains(c) { c } else { ' ' };
    text.chars().map(shown).collect()
}
