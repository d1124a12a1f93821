//! The size of functions in an image: `footprint IMAGE ADDRESS..`.
//!
//! One line for each address: `ADDRESS CODE STACK`. CODE is the size of the function there and of everything it can call,
//! STACK the most that they take together, along the deepest chain of calls; both in bytes. The frames are the compiler's
//! own figures (`-Zemit-stack-sizes`); those of functions that came compiled are read from their instructions.

mod graph;
mod thumb;

use anyhow::Context as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some((path, addresses)) = words.split_first().filter(|(path, _)| !path.starts_with('-')) else {
        eprintln!("usage: footprint IMAGE ADDRESS..");
        return ExitCode::from(2);
    };
    match run(path, addresses) {
        Ok(text) => {
            print!("{text}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {path}: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(path: &str, addresses: &[String]) -> anyhow::Result<String> {
    let elf = std::fs::read(path)?;
    let graph = graph::Graph::of(&elf)?;
    let mut text = String::new();
    for word in addresses {
        let address = word.strip_prefix("0x").and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let address = address.with_context(|| format!("not an address: {word}"))?;
        let size = graph.size(address).with_context(|| word.clone())?;
        text.push_str(&format!("{word} {} {}\n", size.code, size.stack));
    }
    Ok(text)
}
