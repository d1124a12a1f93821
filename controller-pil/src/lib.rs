//! What both sides of a processor-in-the-loop run share.
//!
//! The plant runs on the host, the controller in an image on a board, real or emulated; between them go frames of fixed
//! size. `no_std`, no dependency: the image and the host program are built from the same definitions, so they cannot
//! drift apart.
//!
//! | module | holds |
//! |---|---|
//! | [`board`] | the boards images are built for: memory, core, the machine that emulates them |
#![no_std]
#![forbid(unsafe_code)]

pub mod board;
