//! What a picture of a run needs, of a size that does not grow with the run.

use super::run::Sample;
use controller_core::{Mode, Status};

/// The part of a run that is recorded and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Beginning \[s\].
    pub from: f64,
    /// End \[s\].
    pub to: f64,
    /// Most bands that the time between is divided into.
    pub columns: usize,
}

/// Bands of a record when nothing else is asked for.
pub const COLUMNS: usize = 1000;

impl View {
    /// A whole run of `duration` \[s\].
    #[must_use]
    pub fn whole(duration: f64) -> Self {
        Self { from: 0.0, to: duration, columns: COLUMNS }
    }
}

/// What a signal did within one band: nothing that reaches beyond `min..=max` is lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// First value.
    pub first: f64,
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
    /// Last value.
    pub last: f64,
}

/// A signal, band by band; `None` where it has no finite value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Envelope {
    /// One for each band of the record.
    pub bands: Vec<Option<Band>>,
}

impl Envelope {
    fn new(bands: usize) -> Self {
        Self { bands: vec![None; bands] }
    }

    fn add(&mut self, index: usize, value: f64) {
        let Some(slot) = self.bands.get_mut(index).filter(|_| value.is_finite()) else { return };
        let band = slot.get_or_insert(Band { first: value, min: value, max: value, last: value });
        band.min = if value < band.min { value } else { band.min };
        band.max = if value > band.max { value } else { band.max };
        band.last = value;
    }

    /// Smallest and largest value of all, when there is one.
    #[must_use]
    pub fn range(&self) -> Option<(f64, f64)> {
        let join = |(lo, hi): (f64, f64), band: &Band| (lo.min(band.min), hi.max(band.max));
        self.bands
            .iter()
            .flatten()
            .fold(None, |range, band| Some(join(range.unwrap_or((band.min, band.max)), band)))
    }
}

/// The signals of one controller, divided into bands of equal length of time. Up to `View::columns` samples, each has a
/// band of its own and the record is exact.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Beginning of the first band \[s\].
    pub from: f64,
    /// Length of a band \[s\], a multiple of the sampling period.
    pub width: f64,
    /// Samples in a band.
    pub samples: u64,
    /// Set-point as asked for \[y\].
    pub r: Envelope,
    /// Output of the plant, without noise, between the samples, too \[y\].
    pub output: Envelope,
    /// Measurement, as the controller gets it \[y\].
    pub y: Envelope,
    /// Output of the controller \[u\].
    pub u: Envelope,
    /// Output that the actuator applies \[u\].
    pub applied: Envelope,
    /// Output of the disturbance block \[u\].
    pub u_f: Envelope,
    /// Estimated disturbance \[u\].
    pub d_hat: Envelope,
    /// Disturbance at the plant input \[u\].
    pub d: Envelope,
    /// Modes that were in force in each band: bit `mode as u8`.
    pub modes: Vec<u8>,
    /// Status bits that were set in each band.
    pub status: Vec<u32>,
    ts: f64,
    first_sample: u64,
}

impl Record {
    /// An empty record of what `view` shows of a run of `count` samples.
    #[must_use]
    pub fn new(view: View, ts: f64, count: u64) -> Self {
        // A time on the grid is that sample, although its quotient may be rounded to just below it.
        let sample = |t: f64| (((t / ts) * (1.0 + 1e-9)).max(0.0).floor() as u64).min(count);
        let first_sample = sample(view.from);
        let shown = (sample(view.to).max(first_sample + 1)) - first_sample;
        let samples = shown.div_ceil(view.columns.max(1) as u64).max(1);
        let bands = shown.div_ceil(samples) as usize;
        let empty = || Envelope::new(bands);
        Self {
            from: first_sample as f64 * ts,
            width: samples as f64 * ts,
            samples,
            r: empty(),
            output: empty(),
            y: empty(),
            u: empty(),
            applied: empty(),
            u_f: empty(),
            d_hat: empty(),
            d: empty(),
            modes: vec![0; bands],
            status: vec![0; bands],
            ts,
            first_sample,
        }
    }

    /// Number of bands.
    #[must_use]
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    /// Whether there is no band.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// The band of the sample `k`; one beyond the last for samples that are not shown.
    pub(super) fn band(&self, k: u64) -> usize {
        match k.checked_sub(self.first_sample) {
            Some(shown) => (shown / self.samples) as usize,
            None => usize::MAX,
        }
    }

    /// Adds a sample to its band.
    pub(super) fn sample(&mut self, index: usize, s: &Sample) {
        self.r.add(index, s.r);
        self.y.add(index, s.y);
        self.u.add(index, s.u);
        self.applied.add(index, s.applied);
        self.u_f.add(index, s.u_f);
        self.d_hat.add(index, s.d_hat);
        self.d.add(index, s.d);
        if let (Some(modes), Some(status)) = (self.modes.get_mut(index), self.status.get_mut(index)) {
            *modes |= 1 << s.mode as u8;
            *status |= s.status.bits();
        }
    }

    /// Adds the plant's output, at the samples and between them.
    pub(super) fn output(&mut self, index: usize, y: f64) {
        self.output.add(index, y);
    }

    /// Time of the beginning of a band \[s\].
    #[must_use]
    pub fn time(&self, index: usize) -> f64 {
        (self.first_sample + index as u64 * self.samples) as f64 * self.ts
    }

    /// Whether `mode` was in force within a band.
    #[must_use]
    pub fn has_mode(&self, index: usize, mode: Mode) -> bool {
        self.modes.get(index).is_some_and(|modes| modes & (1 << mode as u8) != 0)
    }

    /// Whether any bit of `status` was set within a band.
    #[must_use]
    pub fn has_status(&self, index: usize, status: Status) -> bool {
        self.status.get(index).is_some_and(|bits| bits & status.bits() != 0)
    }
}
