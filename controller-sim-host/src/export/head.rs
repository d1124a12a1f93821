//! Name and head of an exported function block.

use super::{Export, OpenRange};
use crate::simulate::Precision;

/// Longest name of a block: what the oldest programming systems take.
const LONGEST: usize = 24;

/// The name of the exported block, see [`among`].
pub(super) fn name(export: &Export<'_>) -> String {
    let loops: Vec<&str> = export.scenario.controllers.iter().map(|spec| spec.name.trim()).collect();
    among(export.name(), &loops)
}

/// The name of the block of `controller`: the words of its name in capitals behind `FB_`. Four hexadecimal digits of a hash of
/// the whole name follow when the words do not tell it apart: when it is not plain, or another one of `loops`, those of the
/// same file, has the same words.
///
/// Two names of a file thus keep two names of blocks, unless both have digits, and by chance, once in 65536, the same ones.
/// Plain names of two files that differ in case or in the separator only, such as `PI DOB` and `pi-dob`, have one name.
fn among(controller: &str, loops: &[&str]) -> String {
    if controller.is_empty() {
        return "FB_LOOP".to_owned();
    }
    let same = |name: &str| {
        loops.iter().any(|other| *other != controller && readable(other).is_some_and(|other| other == name))
    };
    if let Some(name) = readable(controller).filter(|name| !same(name)) {
        return name;
    }
    let words = words(controller);
    let words = if words.is_empty() { "LOOP".to_owned() } else { words };
    let room: String = format!("FB_{words}").chars().take(LONGEST - 5).collect();
    format!("{}_{}", room.trim_end_matches('_'), digits(controller))
}

/// The name without digits of a plain controller's name: letters and digits, with one space, hyphen or underscore between
/// words, short enough. `None` for another.
fn readable(controller: &str) -> Option<String> {
    let mut parts = controller.split([' ', '-', '_']);
    let plain = parts.all(|word| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric()));
    let name = format!("FB_{}", words(controller));
    (plain && name.len() <= LONGEST).then_some(name)
}

/// The words of a name in capitals, single underscores between them.
fn words(controller: &str) -> String {
    let words = controller.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_ascii_uppercase).collect::<Vec<_>>().join("_")
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

#[cfg(test)]
mod tests {
    use super::{LONGEST, among, digits};
    use std::collections::HashSet;

    #[test]
    fn plain_names_stay_readable() {
        for (controller, block) in [
            ("PI", "FB_PI"),
            ("tank-2 level", "FB_TANK_2_LEVEL"),
            ("DE_MOMI", "FB_DE_MOMI"),
            ("abcdefghijklmnopqrstu", "FB_ABCDEFGHIJKLMNOPQRSTU"),
        ] {
            assert_eq!(among(controller, &[controller, "another"]), block);
        }
    }

    #[test]
    fn two_loops_of_a_file_keep_two_names() {
        let loops = [
            "PI DOB",
            "PI - DOB",
            "pi+dob",
            "pi-dob",
            "PI_DOB",
            "pi dob",
            "Pi.Dob",
            "PI  DOB",
            "_PI DOB",
            "\u{3c0} DOB",
            "\u{3c1} DOB",
            "+",
            "-",
            "abcdefghijklmnopqrstuv",
            "abcdefghijklmnopqrstuw",
        ];
        let names: HashSet<String> = loops.iter().map(|name| among(name, &loops)).collect();
        assert_eq!(names.len(), loops.len(), "{names:?}");
        for name in &names {
            let plain = name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
            assert!(plain && name.len() <= LONGEST && !name.contains("__") && !name.ends_with('_'), "{name}");
        }
    }

    /// Without the other loops at hand, too: neither is plain.
    #[test]
    fn separators_that_are_not_plain_leave_digits() {
        for controller in ["PI - DOB", "pi+dob", "PI/DOB", "PI.DOB", "-PI DOB", "PI DOB_", "PI  DOB"] {
            assert_eq!(among(controller, &[]), format!("FB_PI_DOB_{}", digits(controller)));
        }
        assert_ne!(among("PI - DOB", &[]), among("pi+dob", &[]));
    }

    /// FNV-1a of the byte `a` is E40C292C by its authors' test vectors.
    #[test]
    fn digits_are_those_of_the_hash() {
        assert_eq!(digits("a"), format!("{:04X}", 0xE40C ^ 0x292C));
    }
}
