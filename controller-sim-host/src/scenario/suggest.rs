//! "Did you mean": the known word nearest to what was written.

/// What people write for a key or a word in other programs or by habit, and what it is called here.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("set_point", "setpoint"),
    ("reference", "setpoint"),
    ("sp", "setpoint"),
    ("load", "disturbance"),
    ("t", "at"),
    ("time", "at"),
    ("sampling_period", "ts"),
    ("sample_time", "ts"),
    ("dt", "ts"),
    ("tend", "duration"),
    ("t_end", "duration"),
    ("end", "duration"),
    ("stop", "duration"),
    ("min", "lo"),
    ("max", "hi"),
    ("low", "lo"),
    ("high", "hi"),
    ("lower", "lo"),
    ("upper", "hi"),
    ("p", "kp"),
    ("i", "ki"),
    ("d", "kd"),
    ("filter", "tf"),
    ("dob", "observer"),
    ("de", "estimator"),
    ("eso", "adrc"),
    ("leso", "adrc"),
    ("wc", "omega_c"),
    ("wo", "omega_o"),
    ("delay", "dead_time"),
    ("deadtime", "dead_time"),
    ("transfer_function", "tf"),
    ("g", "tf"),
    ("sigma", "std"),
    ("label", "name"),
    ("title", "name"),
    ("output_limits", "limits"),
    ("sp_track", "track"),
    ("antiwindup", "anti_windup"),
    ("backcalc", "back-calculation"),
    ("back_calc", "back-calculation"),
    ("tracking", "back-calculation"),
    ("clamping", "conditional"),
    ("ideal", "standard"),
    ("isa", "standard"),
    ("noninteracting", "standard"),
    ("interacting", "series"),
    ("tustin", "trapezoid"),
    ("bilinear", "trapezoid"),
    ("euler", "backward"),
    ("heating", "reverse"),
    ("cooling", "direct"),
    ("automatic", "auto"),
    ("remote", "cascade"),
    ("latched", "acknowledged"),
    ("k", "gain"),
    ("t", "tau"),
    ("time_constant", "tau"),
    ("t1", "tau1"),
    ("t2", "tau2"),
    ("theta", "dead_time"),
    ("l", "dead_time"),
    ("wn", "omega"),
    ("omega_n", "omega"),
    ("damping", "zeta"),
    ("numerator", "num"),
    ("denominator", "den"),
    ("first_order", "fopdt"),
    ("foptd", "fopdt"),
    ("soptd", "sopdt"),
    ("file", "csv"),
    ("col", "column"),
    ("length", "duration"),
    ("interpolate", "between"),
    ("linear", "line"),
    ("zoh", "hold"),
    ("step_size", "resolution"),
    ("quantisation", "resolution"),
    ("quantization", "resolution"),
    ("slew_rate", "rate"),
    ("sinus", "sine"),
    ("random_walk", "walk"),
    ("frequency", "period"),
    ("parameter", "key"),
    ("param", "key"),
    ("start", "from"),
    ("stop", "to"),
    ("n", "count"),
    ("points", "count"),
    ("steps", "count"),
    ("logarithmic", "log"),
    ("slave", "secondary"),
    ("name", "label"),
    ("name", "title"),
    ("text", "description"),
];

/// The one of `known` that `word` was probably meant to be.
pub(crate) fn closest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    let word = plain(word);
    if let Some(equal) = known.iter().find(|k| plain(k) == word) {
        return Some(equal);
    }
    // The same habit may have several names here; only one of them is known in this place.
    let others = OTHER_NAMES.iter().filter(|(other, _)| *other == word);
    if let Some(same) = others.filter_map(|(_, name)| known.iter().find(|k| *k == name)).next() {
        return Some(same);
    }
    let length = word.chars().count();
    let most = match length {
        0 | 1 => return None,
        2..=4 => 1,
        5..=7 => 2,
        _ => 3,
    };
    known
        .iter()
        // In a short word every letter counts: the first one must be right, or two have changed places.
        .map(|&k| (plain(k), k))
        .filter(|(name, _)| {
            length > 3 || name.chars().next() == word.chars().next() || letters(name) == letters(&word)
        })
        .map(|(name, k)| (if is_beginning(&name, &word) { 1 } else { distance(&word, &name) }, k))
        .filter(|&(d, _)| d <= most)
        .min_by_key(|&(d, _)| d)
        .map(|(_, k)| k)
}

/// The letters of a word, sorted.
fn letters(word: &str) -> Vec<char> {
    let mut letters: Vec<char> = word.chars().collect();
    letters.sort_unstable();
    letters
}

/// Whether one word begins with the other one: "automatic" and "auto".
fn is_beginning(a: &str, b: &str) -> bool {
    a.len().min(b.len()) > 2 && (a.starts_with(b) || b.starts_with(a))
}

/// Lower case, with `_` between words.
fn plain(word: &str) -> String {
    // Longer words are no misspelt keys; the limit keeps the distance cheap.
    word.chars().take(40).flat_map(char::to_lowercase).map(|c| if c == '-' { '_' } else { c }).collect()
}

/// Number of letters to insert, remove, replace or swap with their neighbour.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_was_meant() {
        let known = ["kp", "ki", "kd", "tf", "integral_rule", "action"];
        assert_eq!(closest("Kp", &known), Some("kp"));
        assert_eq!(closest("integral-rule", &known), Some("integral_rule"));
        assert_eq!(closest("acton", &known), Some("action"));
        assert_eq!(closest("actoin", &known), Some("action"));
        assert_eq!(closest("p", &known), Some("kp"));
        assert_eq!(closest("PDI", &["PID", "DE"]), Some("PID"));
        assert_eq!(closest("automatic", &["off", "auto"]), Some("auto"));
        assert_eq!(closest("ft", &known), Some("tf"));
        assert_eq!(closest("x", &known), None);
        assert_eq!(closest("xy", &known), None);
        assert_eq!(closest("gain_of_the_loop", &known), None);
        assert_eq!(closest("", &known), None);
    }
}
