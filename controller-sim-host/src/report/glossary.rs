//! The words of a page: abbreviations and symbols that stand on it, each with what it means.

use maud::{Markup, html};

/// What is looked for on a page, how it is called in the list, and what it means.
struct Word {
    /// As it stands on the page; with angle brackets: alone in its cell.
    found: &'static str,
    name: &'static str,
    means: &'static str,
}

const fn word(name: &'static str, means: &'static str) -> Word {
    Word { found: name, name, means }
}

const fn named(found: &'static str, name: &'static str, means: &'static str) -> Word {
    Word { found, name, means }
}

const WORDS: [Word; 64] = [
    word("PI", "controller with a proportional and an integral part"),
    word("PID", "controller with a proportional, an integral and a derivative part"),
    word("MOMI", "magnitude optimum by multiple integration: tuned by the areas of a response"),
    word("DRMO", "disturbance-rejection magnitude optimum: a MOMI tuned for loads"),
    word("DE-MOMI", "a MOMI with a disturbance estimator beside it"),
    word("DOB", "disturbance observer beside a PI controller"),
    word("ADRC", "active disturbance rejection control: state feedback on an observer of the disturbance"),
    word("AH", "rules of \u{c5}str\u{f6}m and H\u{e4}gglund"),
    word("AMIGO", "rules of \u{c5}str\u{f6}m and H\u{e4}gglund for a robust PID"),
    word("SIMC", "rules of Skogestad"),
    word("kp", "proportional gain of the parallel form"),
    word("ki", "integral gain of the parallel form"),
    word("kd", "derivative gain of the parallel form"),
    word("KP", "gain of the standard form, equal to kp; also K"),
    word("TN", "reset time of the standard form, kp/ki; also Ti"),
    named("TV, derivative time", "TV (standard form)", "derivative time, kd/kp; also Td"),
    word("tf", "time constant of the filter of the measurement"),
    named(">b<", "b", "weight of the set-point in the proportional part"),
    named(">c<", "c", "weight of the set-point in the derivative part"),
    word("tt", "time constant of the back-calculation, which keeps the integral part from winding up"),
    word("ts", "sampling period"),
    word("kfd", "gain of the disturbance estimator's feedback, 1 removes the whole load"),
    word("tfd", "time constant of the disturbance estimator's filter"),
    word("alpha", "time constant of the disturbance observer's filter"),
    word("b0", "ADRC: gain of the plant at high frequency"),
    named("beta1", "beta1, beta2, beta3", "ADRC: gains of its observer"),
    word("a1", "coefficient of s in the denominator of a model"),
    word("a2", "coefficient of s\u{b2} in the denominator of a model"),
    word("f64", "numbers of 64 bits"),
    word("f32", "numbers of 32 bits"),
    word("d_hat", "estimated disturbance at the plant's input, 0 at the beginning of the run"),
    word("u_f", "what the disturbance block adds to the output of the PID"),
    word("IAE", "integral of the absolute error |r \u{2212} y|"),
    word("ISE", "integral of the squared error"),
    word("ITAE", "integral of the absolute error times the time since the event"),
    word("IE", "integral of the error"),
    word("e_max", "largest absolute error"),
    named(
        "IE is the sum over the samples",
        "TV (metrics)",
        "total variation: sum of all moves of the controller output",
    ),
    word("Ms", "largest sensitivity |S|; the loop gain L keeps the distance 1/Ms from \u{2212}1"),
    word("Mt", "largest complementary sensitivity |T|"),
    word("K_PIDn", "gain of the PID from measurement noise to the output at the frequency \u{3c0}/(2 ts)"),
    word("K_DEn", "the same of the disturbance estimator or observer"),
    word("A_n", "gain from measurement noise to the output at high frequency"),
    word("K_i", "integral gain: 1/K_i is the integral of the error after a unit step of the load"),
    named("TV of u by noise", "TV (noise)", "total variation: sum of all moves of the controller output"),
    word("RAM", "memory for data"),
    word("MHz", "million cycles a second"),
    word("std", "standard deviation"),
    word("rms", "root mean square"),
    word("fit_rms", "root mean square of the residuals of the fitted model"),
    word("kp_spread", "standard deviation of K_P over its value"),
    word("K_P", "proportional gain by the magnitude optimum"),
    named(
        "A0",
        "A0 to A5",
        "areas: A0 is the gain of the process, the others are integrals of its step response",
    ),
    word("P1", "first peak of the response"),
    word("P3", "third peak, after the dip"),
    word("t1", "time of the first peak from the step"),
    word("t_dip", "time of the dip from the step"),
    word("t_ratio", "t_dip/t1"),
    word("p1", "size of the first peak"),
    word("r3", "size of the third peak, in first peaks"),
    word("sigma", "standard deviation of the noise of a sample"),
    word("HH", "alarm far above, H: above the range"),
    word("LL", "alarm far below, L: below the range"),
    word("CSV", "table as text, a line for each row"),
];

/// The words that stand in `content`, as a section of the page; nothing when there are none.
pub(super) fn section(content: &str) -> Markup {
    let shown = shown(content);
    let list: Vec<&Word> = WORDS.iter().filter(|word| stands(&shown, word.found)).collect();
    html! {
        @if !list.is_empty() {
            section aria-labelledby="words" {
                h2 id="words" { "Words" }
                dl class="words" {
                    @for word in list { dt { (word.name) } dd { (word.means) } }
                }
            }
        }
    }
}

/// What is seen of a page, each text between angle brackets: without what is copied, unfolded or only spoken.
fn shown(content: &str) -> String {
    const UNSEEN: [&str; 5] = ["pre", "details", "desc", "title", "style"];
    let mut text = String::from(">");
    let mut rest = content;
    while let Some((before, tag)) = rest.split_once('<') {
        text.push_str(before);
        text.push_str("<>");
        let Some((inner, after)) = tag.split_once('>') else { return text };
        let name = inner.split([' ', '/']).next().unwrap_or("");
        rest = match UNSEEN.contains(&name) {
            true => after.split_once(&format!("</{name}>")).map_or("", |(_, after)| after),
            false => after,
        };
    }
    text.push_str(rest);
    text.push('<');
    text
}

/// Whether a word stands in a text, not as a part of another one.
fn stands(text: &str, word: &str) -> bool {
    let joins = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
    text.match_indices(word).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + word.len()..]);
        !before.ends_with(joins) && !after.starts_with(joins)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(content: &str) -> Vec<&'static str> {
        let shown = shown(content);
        WORDS.iter().filter(|word| stands(&shown, word.found)).map(|word| word.name).collect()
    }

    #[test]
    fn words_are_found_whole_and_where_they_are_seen() {
        assert_eq!(names("<p>IAE of the DE-MOMI</p>"), ["DE-MOMI", "IAE"]);
        assert_eq!(names("<th>b</th><td>a b</td><desc>Ms</desc>"), ["b"]);
        assert_eq!(names("<pre><code>kp = 1</code></pre><details><p>ITAE</p></details>"), [""; 0]);
        assert_eq!(names("TV <b>TV, derivative time</b>"), ["TV (standard form)"]);
        assert_eq!(names("plain text without any"), [""; 0]);
    }

    #[test]
    fn no_word_is_listed_twice() {
        for (index, word) in WORDS.iter().enumerate() {
            assert!(WORDS[..index].iter().all(|other| other.name != word.name), "{}", word.name);
        }
    }
}
