//! Tells the crate what builds it: the compiler and the sources. Another one of either may lay a block out, or mean it, in
//! another way.

mod sources;

use std::path::Path;
use std::process::Command;

fn main() {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).arg("--version").output();
    let version = version.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    println!("cargo:rustc-env=CTL_COMPILER={}", version.unwrap_or_default());

    let here = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default();
    let here = Path::new(&here);
    println!("cargo:rerun-if-changed=build");
    let folders = [here.join("src"), here.join("../controller-core/src")];
    for folder in &folders {
        println!("cargo:rerun-if-changed={}", folder.display());
    }
    match sources::digest(&folders) {
        Ok(digest) => println!("cargo:rustc-env=CTL_SOURCES={digest:016x}"),
        Err(why) => println!("cargo::error=the sources of a block cannot be read: {why}"),
    }
}
