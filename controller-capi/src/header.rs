//! The beginning of a block: whose it is, what is behind it, sums.

use controller_core::Checksum;
use controller_core::snapshot::Words;

/// Whether a block's loop has a compensator; the numbers stand in blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Kind {
    Plain = 1,
    Compensated = 2,
}

/// The beginning of a block.
#[repr(C, align(8))]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Header {
    pub(crate) magic: u32,
    /// Which library wrote the block: layout and meaning may differ in another one.
    pub(crate) build: u32,
    pub(crate) kind: u32,
    /// Cells of delay memory.
    pub(crate) cells: u32,
    /// Over the words before it.
    check: u32,
    /// The mode of `set_mode`.
    pub(crate) set: i32,
    /// The last mode that was asked for and known.
    pub(crate) asked: i32,
    /// Over the law, which stays as it is from one swap to the next.
    pub(crate) law: u32,
}

/// FNV-1a, 32 bits.
const fn hash(bytes: &[u8], mut hash: u32) -> u32 {
    let mut rest = bytes;
    while let [byte, others @ ..] = rest {
        hash = (hash ^ *byte as u32).wrapping_mul(0x0100_0193);
        rest = others;
    }
    hash
}

/// Stands for the library, its sources and those of the core, the compiler that built it, and the sizes that came out.
pub(crate) const fn build([plain, compensated]: [usize; 2]) -> u32 {
    let version = concat!(env!("CARGO_PKG_VERSION"), " ", env!("CTL_COMPILER"), " ", env!("CTL_SOURCES"));
    let seed = hash(version.as_bytes(), 0x811C_9DC5 ^ crate::ABI_VERSION);
    hash(&(compensated as u64).to_le_bytes(), hash(&(plain as u64).to_le_bytes(), seed))
}

impl Header {
    /// `magic` and `build` say whose block it is; the sum of the law is still to come.
    pub(crate) fn new([magic, build]: [u32; 2], kind: Kind, cells: u32, mode: i32) -> Self {
        let header =
            Self { magic, build, kind: kind as u32, cells, check: 0, set: mode, asked: mode, law: 0 };
        Self { check: header.sum(), ..header }
    }

    /// The same for a loop of this kind.
    pub(crate) fn of_kind(self, kind: Kind) -> Self {
        let header = Self { kind: kind as u32, ..self };
        Self { check: header.sum(), ..header }
    }

    /// Whether its words are those that were written.
    pub(crate) fn is_intact(&self) -> bool {
        self.check == self.sum()
    }

    fn sum(&self) -> u32 {
        let mut sum = Checksum::new();
        [self.magic, self.build, self.kind, self.cells].iter().for_each(|&word| sum.word(word));
        sum.value()
    }
}
