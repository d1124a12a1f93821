//! What is read on the pages of all commands: numbers of few digits, and words that are explained.

use crate::folder::Folder;

const DEMO: &str = include_str!("../data/report_demo.toml");
const STEP: &str = include_str!("../../scenarios/step-test.toml");
const LOAD: &str = include_str!("../../scenarios/load-experiment.toml");
const CASCADE: &str = include_str!("../../scenarios/cascade.toml");

/// A page of each command, by the names of their files.
fn pages(folder: &Folder) -> Vec<(&'static str, String)> {
    for (name, text) in
        [("demo.toml", DEMO), ("step.toml", STEP), ("load.toml", LOAD), ("cascade.toml", CASCADE)]
    {
        folder.write(name, text);
    }
    let commands: [(&'static str, &[&str]); 12] = [
        ("demo.html", &["run", "demo.toml"]),
        ("cascade.html", &["run", "cascade.toml"]),
        ("step.html", &["run", "step.toml", "--csv", "step.csv"]),
        ("load.html", &["run", "load.toml", "--csv", "load.csv"]),
        ("identify.html", &["identify", "step.csv"]),
        ("tune.html", &["tune", "step.csv", "--save", "tuned.toml"]),
        (
            "observer.html",
            &["tune", "step.csv", "--method", "dob", "--limits", "0:100", "--save", "dob.toml"],
        ),
        ("tuned.html", &["run", "tuned.toml"]),
        ("dob.html", &["run", "dob.toml", "--precision", "f32"]),
        ("analyze.html", &["analyze", "tuned.toml"]),
        ("adrc.html", &["tune", "step.csv", "--method", "adrc"]),
        ("assess.html", &["assess", "load.csv", "--controller", "well tuned"]),
    ];
    let page = |(name, arguments): (&'static str, &[&str])| {
        let output = folder.run(&[arguments, &["--report", name]].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?} {}", crate::folder::text(&output.stderr));
        (name, folder.read(name))
    };
    commands.into_iter().map(page).collect()
}

/// The texts of a page that are read, without those that are copied or unfolded, and the style.
fn texts(page: &str) -> Vec<String> {
    let mut list = Vec::new();
    let mut rest = page;
    while let Some((before, tag)) = rest.split_once('<') {
        list.push(before.trim().to_owned());
        let (inner, after) = tag.split_once('>').expect("well formed");
        let name = inner.split([' ', '/']).next().unwrap_or("");
        rest = if ["style", "pre", "details", "code"].contains(&name) {
            after.split_once(&format!("</{name}>")).expect("its end").1
        } else {
            after
        };
    }
    list.retain(|text| !text.is_empty());
    list
}

/// Digits of a number without the zeros that only tell its size.
fn digits(number: &str) -> usize {
    let whole = !number.contains('.');
    let digits: String = number.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_start_matches('0');
    if whole { digits.trim_end_matches('0').len() } else { digits.len() }
}

#[test]
fn no_number_on_a_page_has_more_than_six_digits() {
    assert_eq!(["4.000832007", "0.0012", "1200000", "12.500"].map(digits), [10, 2, 2, 5]);
    let folder = Folder::new("page-numbers");
    for (name, page) in pages(&folder) {
        for text in texts(&page) {
            for number in text.split(|c: char| !c.is_ascii_digit() && c != '.') {
                assert!(digits(number.trim_end_matches('.')) <= 6, "{name}: {text}");
            }
        }
    }
}

/// The words that a page explains.
fn explained(page: &str) -> Vec<String> {
    let (_, list) = page.split_once("<dl class=\"words\">").expect("words");
    let list = list.split("</dl>").next().expect("its end");
    list.split("<dt>").skip(1).map(|part| part.split('<').next().unwrap_or("").to_owned()).collect()
}

#[test]
fn words_of_a_page_are_explained_and_no_others() {
    let folder = Folder::new("page-words");
    for (name, page) in pages(&folder) {
        let explained = explained(&page);
        let (before, after) = page.split_once("<section aria-labelledby=\"words\">").expect("words");
        let shown = texts(&format!("{before}{}", after.split_once("</section>").expect("its end").1));
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
        let words: Vec<&str> = shown
            .iter()
            .flat_map(|text| text.split(|c| !is_part(c)))
            .map(|word| word.trim_matches('-'))
            .collect();
        for term in &explained {
            let first = term.split([' ', ',']).next().expect("a word");
            assert!(words.contains(&first), "{name}: {term} is not on the page");
        }
        let terms: Vec<&str> = explained.iter().flat_map(|term| term.split([' ', ',', '(', ')'])).collect();
        for word in words {
            let capitals = word.chars().filter(char::is_ascii_uppercase).count();
            let letters = word.chars().filter(|c| c.is_ascii_alphabetic()).count();
            let short = (capitals >= 2 && capitals + 2 >= letters && letters <= 8) || word.contains('_');
            let area =
                word.starts_with('A') && word.len() == 2 && word.ends_with(|c: char| c.is_ascii_digit());
            // In the formula of a model, and what is put into an option.
            let given = ["dead_time", "LO", "HI"].contains(&word);
            if (short
                || ["kp", "ki", "kd", "tf", "tt", "ts", "Ms", "Mt", "kfd", "tfd", "alpha"].contains(&word))
                && !area
                && !given
            {
                assert!(terms.contains(&word), "{name}: {word} is not explained: {explained:?}");
            }
        }
    }
}
