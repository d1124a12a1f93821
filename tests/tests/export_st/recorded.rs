//! A loop driven through everything, written down: what a compiled block is fed, and what it must give.

use crate::drive::{Driven, Sample, outputs};
use controller_core::Real;
use controller_sim_host::export::Export;
use controller_sim_host::export::block::Block;
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::Precision;
use std::ops::Range;

/// Samples of one loop, with the outputs of the core's step.
pub(crate) struct Recorded<T: Real> {
    pub(crate) name: String,
    pub(crate) block: Block,
    /// The inputs of all samples.
    pub(crate) records: Vec<f64>,
    pub(crate) samples: Vec<(Sample<T>, Vec<f64>)>,
    /// The loop as it is behind the last sample: what it has seen.
    pub(crate) driven: Driven<T>,
}

impl<T: Real> Recorded<T> {
    pub(crate) fn new(
        scenario: &Scenario,
        spec: &ControllerSpec,
        precision: Precision,
        tuning: bool,
        samples: u32,
    ) -> Self {
        Self::with(scenario, spec, precision, tuning, 7 + u64::from(tuning), 0..samples, |_| {})
    }

    /// From power-up on, in the middle of something that `seed` draws; with an odd one from a good sample on.
    pub(crate) fn scattered(
        scenario: &Scenario,
        spec: &ControllerSpec,
        precision: Precision,
        seed: u64,
        samples: u32,
    ) -> Self {
        // The driver's first samples are bad, those from here on are not.
        let first = if seed.is_multiple_of(2) { 0 } else { 1000 };
        Self::with(scenario, spec, precision, false, seed, first..first + samples, Driven::scatter)
    }

    fn with(
        scenario: &Scenario,
        spec: &ControllerSpec,
        precision: Precision,
        tuning: bool,
        seed: u64,
        samples: Range<u32>,
        begin: impl Fn(&mut Driven<T>),
    ) -> Self {
        let name = format!("{} {precision:?} {tuning}", spec.name);
        let export =
            Export::new(scenario, spec, precision, None).unwrap_or_else(|why| panic!("{name}: {why:?}"));
        let block = export.block("test").expect("a block");
        assert_eq!(block.faults(), Vec::<String>::new(), "{name}");
        let mut driven = Driven::<T>::new(scenario, spec, &block, export.capacity(), seed, tuning);
        begin(&mut driven);
        let (mut records, mut expected) = (Vec::new(), Vec::new());
        for k in samples {
            let (sample, out, more) = driven.sample(k);
            records.extend(sample.record(&block));
            expected.push((sample, outputs(&block, &out, &more)));
        }
        Self { name, block, records, samples: expected, driven }
    }

    /// The samples in which `given` has other bits than the core.
    pub(crate) fn differing(&self, given: &[f64]) -> Vec<usize> {
        let width = self.samples[0].1.len();
        assert_eq!(given.len(), width * self.samples.len(), "{}", self.name);
        let same = |a: &[f64], b: &[f64]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
        let pairs = self.samples.iter().zip(given.chunks(width)).enumerate();
        pairs.filter(|(_, ((_, expected), given))| !same(expected, given)).map(|(k, _)| k).collect()
    }

    /// Every output of every sample has the bits of the core.
    pub(crate) fn check(&self, what: &str, given: &[f64]) {
        if let Some(k) = self.differing(given).first() {
            let (sample, expected) = &self.samples[*k];
            let given = given.chunks(expected.len()).nth(*k).expect("a sample");
            let (name, input) = (&self.name, &sample.input);
            panic!("{name} {what}, sample {k}\nexpected {expected:?}\ngiven    {given:?}\ninput {input:?}");
        }
    }
}
