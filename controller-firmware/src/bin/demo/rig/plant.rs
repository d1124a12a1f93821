//! A plant of two lags and a dead time.

/// `gain*exp(-s*N*dt)/((1 + s*dt/fast)*(1 + s*dt/slow))`, stepped by `dt` = 10 ms.
pub(super) struct Plant<const N: usize> {
    line: [f32; N],
    next: usize,
    gain: f32,
    /// Shares of the way that the lags go in a step.
    fast: f32,
    slow: f32,
    inner: f32,
    outer: f32,
}

impl<const N: usize> Plant<N> {
    pub(super) const fn new(gain: f32, fast: f32, slow: f32) -> Self {
        Self { line: [0.0; N], next: 0, gain, fast, slow, inner: 0.0, outer: 0.0 }
    }

    /// Takes `power` for a step.
    pub(super) fn pass(&mut self, power: f32) {
        let late = core::mem::replace(&mut self.line[self.next], power);
        self.next = (self.next + 1) % N;
        self.inner += self.fast * (self.gain * late - self.inner);
        self.outer += self.slow * (self.inner - self.outer);
    }

    pub(super) fn output(&self) -> f32 {
        self.outer
    }
}
