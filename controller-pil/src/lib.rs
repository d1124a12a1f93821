//! What both sides of a processor-in-the-loop run share.
//!
//! The plant runs on the host, the controller in an image on a board, real or emulated; between them go frames of fixed
//! layout. `no_std`, no dependency but, with the feature `laws`, the core itself: the image and the host program are built
//! from the same definitions, so they cannot drift apart.
//!
//! | module | holds |
//! |---|---|
//! | [`board`] | the boards images are built for: memory, core, the machine that emulates them |
//! | [`image`] | which board an image says it is for |
//! | [`frame`] | frames: kinds, codes, header, little-endian numbers |
//! | [`serial`] | frames on a serial line: COBS and CRC-16 |
//! | `parameters`, `sample` | what is in the frames: a controller's configuration, one sample (feature `laws`) |
//! | `law`, `peer` | the side on the board: a controller over fixed memory, and who answers (feature `laws`) |
//!
//! One run: `Hello`, `Build` (the board runs `Controller::new` itself, from the configuration), `Settle`, then `Step` by
//! `Step`, with `Adopt` and `Advance` in between, `Save` to compare the whole state, `End`. The host asks, the board
//! answers; every request has one answer, with the same number.
#![no_std]
#![forbid(unsafe_code)]

pub mod board;
pub mod frame;
pub mod image;
#[cfg(feature = "laws")]
pub mod law;
#[cfg(feature = "laws")]
pub mod parameters;
#[cfg(feature = "laws")]
pub mod peer;
#[cfg(feature = "laws")]
pub mod sample;
pub mod serial;
