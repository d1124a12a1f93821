//! Who calls whom in an image.

use crate::thumb::{self, Does};
use anyhow::{Context as _, bail, ensure};
use object::{Object as _, ObjectSection as _, ObjectSymbol as _, SymbolKind};
use std::collections::{BTreeMap, BTreeSet};

/// The section with the compiler's figures: an address and a size, again and again.
const FRAMES: &str = ".stack_sizes";
/// The section with the code.
const CODE: &str = ".text";
/// In the names of functions that end the image: what they take is nobody's cost.
const PANICKING: &str = "9panicking";

/// The functions of an image by their addresses.
pub(crate) struct Graph(BTreeMap<u32, Function>);

struct Function {
    name: String,
    size: u32,
    /// Bytes of stack of its own.
    frame: u32,
    calls: BTreeSet<u32>,
    /// Functions that it ends in, its own frame gone.
    ends_in: BTreeSet<u32>,
}

/// A function and all that it can call.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Size {
    /// Bytes of code.
    pub(crate) code: u32,
    /// Bytes of stack.
    pub(crate) stack: u32,
}

impl Graph {
    /// Of an image.
    ///
    /// # Errors
    /// When it is not an image with symbols.
    pub(crate) fn of(elf: &[u8]) -> anyhow::Result<Self> {
        let file = object::File::parse(elf)?;
        let frames = file.section_by_name(FRAMES).context("no stack sizes: build with -Zemit-stack-sizes")?;
        let frames = frames_of(frames.data()?)?;
        let code = file.section_by_name(CODE).context("no code")?;
        let (origin, bytes) = (u32::try_from(code.address())?, code.data()?);

        // Constants stand between the instructions; these symbols say where either begins.
        let mut is_code = BTreeMap::new();
        let mut functions = BTreeMap::new();
        for symbol in file.symbols() {
            let (address, name) = (u32::try_from(symbol.address())?, symbol.name()?);
            if name.starts_with("$t") || name.starts_with("$d") {
                is_code.insert(address, name.starts_with("$t"));
            } else if symbol.kind() == SymbolKind::Text && symbol.size() > 0 {
                functions.insert(address & !1, (name, u32::try_from(symbol.size())?));
            }
        }
        let mut graph = BTreeMap::new();
        for (&address, &(name, size)) in &functions {
            let own = address..address + size;
            let mut function = Function {
                name: name.to_string(),
                size,
                frame: 0,
                calls: BTreeSet::new(),
                ends_in: BTreeSet::new(),
            };
            let half = |at: u32| -> u16 {
                let at = (at - origin) as usize;
                bytes.get(at..at + 2).map_or(0, |two| u16::from_le_bytes([two[0], two[1]]))
            };
            let mut at = address;
            let mut taken = 0;
            while own.contains(&at) && at >= origin {
                if is_code.range(..=at).next_back().is_some_and(|(_, code)| !code) {
                    at += 2;
                    continue;
                }
                let (does, length) = thumb::decode(at, half(at), half(at + 2));
                match does {
                    // The smallest core has no other jump that goes far.
                    Does::Calls(to) if own.contains(&to) && to != address => {}
                    Does::Calls(to) => _ = function.calls.insert(to),
                    Does::Jumps(to) if !own.contains(&to) => _ = function.ends_in.insert(to),
                    // No function has the address 1: whoever asks for this one learns what is wrong.
                    Does::CallsRegister => _ = function.calls.insert(1),
                    Does::Takes(bytes) => taken += bytes,
                    Does::Jumps(_) | Does::Other => {}
                }
                at += length;
            }
            function.frame = frames.get(&address).copied().unwrap_or(taken);
            graph.insert(address, function);
        }
        Ok(Self(graph))
    }

    /// The size of the function at `address` with all that it can call.
    ///
    /// # Errors
    /// When there is no function, a call goes through a register, or functions call each other in a circle.
    pub(crate) fn size(&self, address: u32) -> anyhow::Result<Size> {
        let mut seen = BTreeSet::new();
        let stack = self.stack(address, &mut seen, &mut Vec::new())?;
        let code = seen.iter().filter_map(|at| self.0.get(at)).map(|function| function.size).sum();
        Ok(Size { code, stack })
    }

    fn stack(&self, address: u32, seen: &mut BTreeSet<u32>, chain: &mut Vec<u32>) -> anyhow::Result<u32> {
        let Some(function) = self.0.get(&address) else {
            let from = chain.last().and_then(|at| self.0.get(at)).map_or("nobody", |f| &f.name);
            bail!("{from} calls {address:#x}, where no function is (1: through a register)");
        };
        if function.name.contains(PANICKING) {
            return Ok(0);
        }
        ensure!(!chain.contains(&address), "{} calls itself", function.name);
        seen.insert(address);
        chain.push(address);
        let mut most = function.frame;
        for to in &function.calls {
            most = most.max(function.frame + self.stack(*to, seen, chain)?);
        }
        for to in &function.ends_in {
            most = most.max(self.stack(*to, seen, chain)?);
        }
        chain.pop();
        Ok(most)
    }
}

/// The compiler's figures: four bytes of address, then a size of seven bits a byte.
fn frames_of(mut bytes: &[u8]) -> anyhow::Result<BTreeMap<u32, u32>> {
    let mut frames = BTreeMap::new();
    while let Some((address, rest)) = bytes.split_first_chunk::<4>() {
        let length = rest.iter().position(|byte| byte & 0x80 == 0).context("a stack size is cut off")? + 1;
        let (size, rest) = rest.split_at(length);
        let size = size.iter().rev().fold(0, |sum, byte| sum << 7 | u32::from(byte & 0x7F));
        frames.insert(u32::from_le_bytes(*address) & !1, size);
        bytes = rest;
    }
    Ok(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn function(frame: u32, calls: &[u32], ends_in: &[u32]) -> Function {
        let set = |list: &[u32]| list.iter().copied().collect();
        Function { name: "f".into(), size: 10, frame, calls: set(calls), ends_in: set(ends_in) }
    }

    #[test]
    fn the_deepest_chain_counts_and_all_the_code() {
        let graph = Graph(BTreeMap::from([
            (0x10, function(8, &[0x20, 0x30], &[])),
            (0x20, function(16, &[], &[])),
            (0x30, function(4, &[], &[0x40])),
            (0x40, function(24, &[], &[])),
            (0x50, function(8, &[0x50], &[])),
            (0x60, function(8, &[1], &[])),
        ]));
        assert_eq!(graph.size(0x10).unwrap(), Size { code: 40, stack: 32 });
        assert!(graph.size(0x50).unwrap_err().to_string().contains("itself"));
        assert!(graph.size(0x60).unwrap_err().to_string().contains("register"));
    }

    #[test]
    fn the_compilers_figures_are_read() {
        let bytes = [0x01, 0x10, 0, 0, 0x08, 0x21, 0x10, 0, 0, 0x80, 0x02];
        assert_eq!(frames_of(&bytes).unwrap(), BTreeMap::from([(0x1000, 8), (0x1020, 256)]));
        assert!(frames_of(&[0, 0, 0, 0, 0x80]).is_err());
    }
}
