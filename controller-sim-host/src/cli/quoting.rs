//! Commands as a person types them into a shell.

use std::ffi::OsString;

/// A word as a shell takes it whole.
pub(super) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./+,:@=%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// The command that a report was made by, from the arguments of the process. The number of threads is left out: the
/// results are the same, and so shall be the reports.
pub(super) fn command_line(arguments: &[OsString]) -> String {
    let mut words = vec!["controller-sim".to_owned()];
    let mut rest = arguments.iter().skip(1).map(|word| word.to_string_lossy());
    while let Some(word) = rest.next() {
        if word == "--threads" {
            rest.next();
        } else if !word.starts_with("--threads=") {
            words.push(quoted(&word));
        }
    }
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_survive_a_shell() {
        for (word, expected) in [
            ("my.toml", "my.toml"),
            ("my file", "'my file'"),
            ("it's", r"'it'\''s'"),
            ("", "''"),
            ("a$b", "'a$b'"),
        ] {
            assert_eq!(quoted(word), expected);
        }
    }

    #[test]
    fn the_command_is_what_was_typed_but_for_threads() {
        let typed =
            ["/usr/bin/x", "run", "a b", "--threads", "2", "--threads=3", "--set", "plant.tf=1/(1+s)"];
        let line = command_line(&typed.map(OsString::from));
        assert_eq!(line, "controller-sim run 'a b' --set 'plant.tf=1/(1+s)'");
    }
}
