//! Plain `cargo test` runs everything that needs nothing but the compiler; this says what it leaves out.

use std::io::Write;

#[test]
fn rungs_that_plain_cargo_test_leaves_out() {
    // Written past the test harness, which would swallow it.
    let text = "\nnot run by `cargo test`: format, clippy, documentation, builds for Cortex-M0 and M4F, the dependency tree, \
                the same bits at every optimisation level, the demo, LinuxCNC's HAL, Octave, the examples in C, the reports in a browser, \
                fuzzing.\n`cargo xtask test` runs them, too.\n";
    std::io::stderr().write_all(text.as_bytes()).expect("stderr can be written");
}
