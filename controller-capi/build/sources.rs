//! A number that stands for source files.

use std::io;
use std::path::{Path, PathBuf};

/// FNV-1a, 64 bits, over the paths and the text of every Rust file in these folders; the ends of lines, which a checkout may
/// change, do not count.
pub(crate) fn digest(folders: &[PathBuf]) -> io::Result<u64> {
    let mut digest = 0xCBF2_9CE4_8422_2325;
    for folder in folders {
        let mut files = Vec::new();
        list(folder, "", &mut files)?;
        files.sort();
        for name in files {
            let text = std::fs::read(folder.join(&name))?;
            let text = text.into_iter().filter(|&byte| byte != b'\r');
            for byte in name.bytes().chain([0]).chain(text).chain([0]) {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3);
            }
        }
    }
    Ok(digest)
}

/// The Rust files below `folder`, named from there with `/`.
fn list(folder: &Path, before: &str, files: &mut Vec<String>) -> io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else if name.ends_with(".rs") {
            files.push(name);
        }
    }
    Ok(())
}
