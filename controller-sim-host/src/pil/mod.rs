//! Processor in the loop: the controllers of a run in an image on an emulated board, each output compared with the one
//! computed here, bit by bit.
//!
//! The plant stays here. Every call of a controller goes to the board as well ([`controller_pil`] has the frames): its
//! configuration, from which the board builds the law itself, every sample, every change of parameters, lost samples; at
//! the end the whole states are compared by their checksums.

mod emulator;
mod find;
mod link;
mod shadow;

pub use find::{Missing, find_image};
pub use link::LinkError;
pub use shadow::{Compared, Difference};

pub(crate) use shadow::{Shadow, Timing};

use controller_pil::board::Board;
use std::path::PathBuf;

/// Where the controllers run besides here.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The board that is emulated.
    pub board: &'static Board,
    /// The image that runs on it.
    pub image: PathBuf,
}

impl Target {
    /// An emulator with the image, which answers.
    pub(crate) fn start(&self) -> Result<Box<dyn link::Link>, LinkError> {
        Ok(Box::new(emulator::Emulator::start(self)?))
    }
}
