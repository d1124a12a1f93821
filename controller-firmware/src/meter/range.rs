//! The least and the most of a count.

/// The least and the most of what has been counted.
#[derive(Clone, Copy)]
pub(super) struct Range {
    /// The least; above `most` while nothing has been counted.
    pub(super) least: u32,
    /// The most.
    pub(super) most: u32,
}

impl Range {
    /// Nothing counted.
    pub(super) const NONE: Self = Self { least: u32::MAX, most: 0 };

    /// Takes a count in.
    pub(super) fn note(&mut self, count: u32) {
        self.least = self.least.min(count);
        self.most = self.most.max(count);
    }
}
