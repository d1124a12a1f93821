//! Name and head of an exported function block.

use super::{Export, OpenRange};
use crate::simulate::Precision;

/// Longest name of a block: what the oldest programming systems take.
const LONGEST: usize = 24;

/// The name of the block: letters, digits and single underscores of the controller's name behind `FB_`. What does not fit, or
/// has no such letter, leaves four hexadecimal digits of the whole name, so that two loops keep two names.
pub(super) fn name(controller: &str) -> String {
    let separates = |c: char| matches!(c, ' ' | '-' | '_' | '+' | '.' | '/');
    let words: Vec<String> = controller
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_uppercase)
        .collect();
    let whole = format!("FB_{}", words.join("_"));
    let lost = controller.chars().any(|c| !c.is_ascii_alphanumeric() && !separates(c));
    if words.is_empty() {
        return if controller.is_empty() {
            "FB_LOOP".to_owned()
        } else {
            format!("FB_LOOP_{}", digits(controller))
        };
    }
    if !lost && whole.len() <= LONGEST {
        return whole;
    }
    let room: String = whole.chars().take(LONGEST - 5).collect();
    format!("{}_{}", room.trim_end_matches('_'), digits(controller))
}

/// Four digits that stand for a text: FNV-1a, folded.
fn digits(text: &str) -> String {
    let hash =
        text.bytes().fold(0x811C_9DC5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    format!("{:04X}", (hash >> 16) ^ (hash & 0xFFFF))
}

/// What the file says of itself.
pub(super) fn lines(export: &Export<'_>, origin: &str, tunable: bool, design: i32) -> Vec<String> {
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
    lines.push(format!(
        "Design number {design}. What the variables mean, import, restart, online change: EXPORTED.md."
    ));
    lines.extend(export.open_ranges().iter().flat_map(OpenRange::warning));
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
    more(
        "Start: an instance, all zero or not, settles itself at its first good PV, at OP_READBACK with RB_USE, else at OP_INIT.",
    );
    more(
        "Memory of another design: all values are new and the loop begins anew, at the OP that is still there; bit 27 until ACK.",
    );
    more(
        "Bad PV (not finite, outside PV_MIN to PV_MAX, PV_QUALITY not 2 or 1): output and terms are held for FAIL_HOLD calls,",
    );
    more("  then the fallback; the next good PV settles the block where it is. STATUS tells.");
    if tunable {
        more(
            "KP, TN, TV, TF may change at any time: taken at the next call without a bump, or refused (bit 26).",
        );
        let direct = export.spec.config.pid.signed_gains()[0] < 0.0;
        more(&format!(
            "Only the size of KP counts. The direction is that of the design: PV rises, OP {}.",
            if direct { "rises (direct)" } else { "falls (reverse)" }
        ));
    } else {
        more("This loop has no KP, TN, TV to tune: export it again to change its parameters.");
    }
    lines
}

/// Text of a person in a comment: printable, and nothing that could end or begin one.
pub(super) fn plain(text: &str) -> String {
    let shown = |c: char| if c.is_ascii_graphic() && !"*{}$\\".contains(c) { c } else { ' ' };
    text.chars().map(shown).collect()
}
