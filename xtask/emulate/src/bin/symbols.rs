//! Prints the names of all symbols of an image, one a line: `symbols IMAGE`.

use anyhow::Context as _;
use object::{Object as _, ObjectSymbol as _};

fn main() -> anyhow::Result<()> {
    let path = std::env::args().nth(1).context("usage: symbols IMAGE")?;
    let elf = std::fs::read(&path).with_context(|| path.clone())?;
    let file = object::File::parse(&*elf).context("not an ELF file")?;
    for symbol in file.symbols() {
        if let Some(name) = symbol.name().ok().filter(|name| !name.is_empty()) {
            println!("{name}");
        }
    }
    Ok(())
}
