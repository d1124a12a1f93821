//! The load-response experiment on simulated loops, whose true loss against the best PI is known.

mod loops;
mod pcg;
mod records;
mod verdicts;
