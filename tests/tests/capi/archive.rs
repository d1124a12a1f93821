//! The archive as a C program links it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

/// For this machine or for a target. It has a target folder of its own, since cargo holds the other one now.
pub(crate) fn archive(target: Option<&str>) -> PathBuf {
    static BUILDING: Mutex<()> = Mutex::new(());
    // One at a time; after a failure the others fail by themselves.
    let _building = BUILDING.lock();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi/target");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests is a folder of the workspace");
    let mut command = Command::new(env!("CARGO"));
    command
        .args(["build", "--quiet", "-p", "controller-capi-staticlib", "--profile", "embedded"])
        .arg("--target-dir")
        .arg(&folder)
        .current_dir(root);
    if let Some(target) = target {
        command.args(["--target", target]);
    }
    assert!(command.status().is_ok_and(|status| status.success()), "the archive can be built");
    folder.join(target.unwrap_or_default()).join("embedded/libctl.a")
}
