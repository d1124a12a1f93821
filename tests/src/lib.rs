//! What the tests that cross crates share: oracles that share no code with the product ([`oracle`]), the papers' cases
//! as the product's own types ([`cases`]), and a loop of the runtime against an oracle's plant ([`rig`]).

pub mod cases;
pub mod golden_loops;
pub mod oracle;
pub mod response;
pub mod rig;

/// The Rust example of the README, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
