//! The built-in scenarios: each can be read and run, and what its description says is so. A figure in a description is
//! taken from the run here (`Page::says`), and compared with the references, the papers or a closed form where there is
//! one; expected figures come from those only.

#[path = "figures/all.rs"]
mod all;
#[path = "figures/chapter.rs"]
mod chapter;
#[path = "figures/observer.rs"]
mod observer;
#[path = "figures/page.rs"]
mod page;
#[path = "figures/practice.rs"]
mod practice;
#[path = "figures/rig.rs"]
mod rig;
#[path = "figures/wandering.rs"]
mod wandering;
