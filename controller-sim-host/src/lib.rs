//! Software in the loop: the code that is flashed, run against an exactly simulated plant.
//!
//! * [`scenario`]: what is to be run, read from TOML with every mistake at its line and column.
//! * [`simulate`]: the run itself and its indices.
//! * [`log`]: logs of real processes, read from CSV.
//! * [`analysis`]: margins and noise of the loops of a scenario.
//! * [`card`]: every figure of one loop as it is deployed, judged against practice and held by a file.
//! * [`plant`]: plants that move exactly between the samples.
//! * [`output`]: tables, JSON, CSV, messages with carets.
//! * [`report`]: pages and pictures.
//! * [`advise`], [`design_file`], [`tuning`]: what the tuning rules make of a plant or a record.
//! * [`advise`], [`design_file`]: what the tuning rules make of a plant.
//! * [`batch`]: many plants by many rules, and maps over two parameters.
//! * [`contour`]: lines of equal values.
//! * [`reproduce`]: every table and figure of the papers, computed again.
//! * [`pil`]: the controllers in an image on an emulated board, compared bit by bit.
//! * [`cli`]: the program `controller-sim`.
//!
//! ```
//! use controller_sim_host::demo;
//! use controller_sim_host::scenario::read;
//! use controller_sim_host::simulate::{Precision, RunOptions, run};
//!
//! let demo = read(demo::SCENARIO, Precision::F32).expect("the demo is valid").scenario;
//! let options = RunOptions { precision: Precision::F32, ..RunOptions::default() };
//! let result = run(&demo, options).expect("and can be run");
//! assert!(result.controllers.iter().all(|controller| controller.total.iae.is_finite()));
//! ```

#![forbid(unsafe_code)]

pub mod advise;
pub mod analysis;
pub mod batch;
pub mod card;
pub mod cli;
pub mod contour;
pub mod demo;
pub mod design_file;
pub mod design_run;
pub mod export;
pub mod log;
pub mod output;
pub mod pil;
pub mod plant;
pub mod quiet;
pub mod report;
pub mod reproduce;
pub mod scenario;
pub mod simulate;
pub mod tuning;
