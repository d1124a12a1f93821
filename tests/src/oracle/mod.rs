//! Independent oracles: plants, loops and control laws computed a second time, by other formulas.
//!
//! Nothing here uses the crates under test. Plants are state spaces with a matrix exponential, control laws
//! are the textbook recursions, reference figures are constants or come from the high-precision files in
//! `golden/`.

pub mod complex;
pub mod de_cases;
pub mod dob_cases;
pub mod dob_discrete;
pub mod expm;
pub mod golden;
pub mod hold_polynomials;
pub mod sampled_loop;
pub mod sampled_plant;
pub mod state_space;
pub mod structure_a;
