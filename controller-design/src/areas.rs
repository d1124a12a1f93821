//! Characteristic areas of a process (skeleton).

/// The areas `A_0..A_5` of a process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Areas {
    values: [f64; 6],
}

impl Areas {
    /// From `A_0..A_5`.
    #[must_use]
    pub const fn new(values: [f64; 6]) -> Self {
        Self { values }
    }

    /// All of them.
    #[must_use]
    pub const fn values(&self) -> [f64; 6] {
        self.values
    }
}
