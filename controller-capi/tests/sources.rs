//! The number of a build changes with every source that a block's layout or meaning comes from.

#![allow(clippy::unwrap_used)]

#[path = "../build/sources.rs"]
mod sources;

use std::path::{Path, PathBuf};

const OURS: &str = "controller-capi/src";
const CORE: &str = "controller-core/src";

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

#[test]
fn every_source_counts() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let here = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sources");
    let _ = std::fs::remove_dir_all(&here);
    let folders: [PathBuf; 2] = [OURS, CORE].map(|folder| {
        copy(&root.join(folder), &here.join(folder));
        here.join(folder)
    });
    let digest = || sources::digest(&folders).unwrap();
    let before = digest();
    assert_eq!(before, sources::digest(&[OURS, CORE].map(|folder| root.join(folder))).unwrap());

    let files = [
        format!("{OURS}/block.rs"),
        format!("{OURS}/plc/instance.rs"),
        format!("{OURS}/plc/vars.rs"),
        format!("{CORE}/controller/state.rs"),
        format!("{CORE}/compensator/any.rs"),
        format!("{CORE}/lag.rs"),
    ];
    for file in files {
        let path = here.join(&file);
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, format!("{text} ")).unwrap();
        assert_ne!(digest(), before, "{file}");
        std::fs::write(&path, text.replace('\n', "\r\n")).unwrap();
        assert_eq!(digest(), before, "{file}: the ends of lines count");
        std::fs::rename(&path, path.with_file_name("other.rs")).unwrap();
        assert_ne!(digest(), before, "{file} has another name");
        std::fs::rename(path.with_file_name("other.rs"), &path).unwrap();
        std::fs::write(&path, text).unwrap();
        assert_eq!(digest(), before);
    }
    assert!(sources::digest(&[here.join("nowhere")]).is_err());
}
