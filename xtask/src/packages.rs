//! Packages of the system.
//!
//! They are installed when that may be done without asking: by the superuser, or one whom `sudo` lets without a password,
//! on a system with `apt-get`. Otherwise the person is told the one command.

use std::path::Path;

use crate::shell::Cmd;

/// Whether this system has packages of Debian.
pub(crate) fn can_install(root: &Path) -> bool {
    Cmd::new("apt-get", root).arg("--version").probe().is_some()
}

/// Installs packages after which `done` must hold; gives the message when it cannot.
pub(crate) fn install(root: &Path, names: &[&str], done: impl Fn() -> bool) -> Option<String> {
    let list = names.join(" ");
    let by_hand = format!("missing: {list}; run: sudo apt-get install -y --no-install-recommends {list}");
    let Some(prefix) = can_install(root).then(|| superuser(root)).flatten() else {
        return Some(by_hand);
    };
    let apt = |words: &[&str]| {
        let mut line: Vec<&str> = prefix.to_vec();
        // Set here and not for the command: sudo hands no variable on.
        line.extend(["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"]);
        line.extend(words);
        Cmd::new(line[0], root).args(&line[1..]).run()
    };
    let mut install = vec!["install", "-y", "--no-install-recommends"];
    install.extend(names);
    // The list of packages of a fresh system is empty, that of an old one leads to files that are gone.
    match apt(&["update"]).and_then(|()| apt(&install)) {
        Ok(()) if done() => None,
        Ok(()) => Some(by_hand),
        Err(message) => {
            println!("{message}");
            Some(by_hand)
        }
    }
}

/// The words before a command that only the superuser may run; nothing when this person may not, or not unasked.
fn superuser(root: &Path) -> Option<&'static [&'static str]> {
    if Cmd::new("id", root).arg("-u").probe().is_some_and(|id| id.trim() == "0") {
        Some(&[])
    } else if Cmd::new("sudo", root).args(["-n", "true"]).probe().is_some() {
        Some(&["sudo", "-n"])
    } else {
        None
    }
}
