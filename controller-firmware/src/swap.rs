//! A law that is replaced under a running interrupt: whole, and bumpless.
//!
//! The control task takes new laws from a [`ParamCell`] and adopts them. What can go wrong is checked in every sample:
//! the law must be one of those that were published, number by number; and in the first sample of a new law the output
//! must not differ by more than its bound from what the old law would have given.

use controller_core::{
    Controller, ControllerConfig, ControllerInput, ControllerState, Estimator, EstimatorConfig, LimitConfig,
    ParamCell, PidConfig,
};

/// Sampling period \[s\].
pub const TS: f64 = 0.001;
/// Laws that are swapped.
pub const LAWS: usize = 4;

/// The law of the loop.
pub type Law = Controller<f32, Estimator<f32, 32>>;
type State = ControllerState<f32, <Estimator<f32, 32> as controller_core::Compensate<f32>>::State>;

/// How the law gets from one context to the other, and what is done with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// As it should be.
    Whole,
    /// Through plain memory without a lock: the check must find torn laws.
    Torn,
    /// Without adopting the state: the check must find bumps.
    Bare,
}

/// What was seen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Report {
    /// Samples of the loop.
    pub samples: u32,
    /// Laws that were taken over from another one.
    pub swaps: u32,
    /// Laws that nobody has published.
    pub torn: u32,
    /// First samples that differ by more than the bound.
    pub bumps: u32,
    /// The largest difference of a first sample as a share of its bound.
    pub worst: f32,
    /// The largest difference of a first sample \[u\].
    pub difference: f32,
}

/// The laws: designs for plants of other speeds and gains. `None` if one is not valid.
#[must_use]
pub fn laws() -> Option<[Law; LAWS]> {
    let build = |i: usize| {
        let kp = [2.35, 0.8, 5.1, 1.3][i];
        let ki = [18.8, 7.0, 60.0, 3.0][i];
        let config = ControllerConfig {
            pid: PidConfig { kp, ki, kd: 0.02 * kp, tf: 0.012, b: 1.0, c: 1.0, ..PidConfig::default() },
            limits: LimitConfig::range(-10.0, 10.0),
            ..ControllerConfig::default()
        };
        let model = EstimatorConfig {
            gain: [1.0, 1.6, 0.7, 1.0][i],
            a1: 0.12,
            a2: [0.002, 0.003, 0.001, 0.002][i],
            dead_time: [0.02, 0.0125, 0.03, 0.001][i],
            kfd: [0.69, 1.0, 0.4, 0.9][i],
            tfd: 0.006,
        };
        let estimator = Estimator::estimator(&model, 0.0, TS).ok()?;
        Controller::with_compensator(&config, estimator, TS).ok()
    };
    let [a, b, c, d] = core::array::from_fn(build);
    Some([a?, b?, c?, d?])
}

/// Laws by number, in an order that repeats late.
pub struct Order(u32);

impl Order {
    /// The same in every run.
    #[must_use]
    pub const fn new() -> Self {
        Self(20_221_122)
    }

    /// The next number in `0..n`.
    pub fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) % n
    }
}

impl Default for Order {
    fn default() -> Self {
        Self::new()
    }
}

/// The control task and its plant.
pub struct Task {
    known: [Law; LAWS],
    law: Law,
    state: State,
    input: ControllerInput<f32>,
    plant: [f32; 2],
    order: Order,
    report: Report,
}

impl Task {
    /// At rest with the first law.
    #[must_use]
    pub fn new(known: [Law; LAWS]) -> Self {
        let law = known[0];
        let mut state = law.zeroed();
        law.settle(&mut state, 0.0, 0.0, 0.0);
        Self {
            known,
            law,
            state,
            input: ControllerInput::default(),
            plant: [0.0; 2],
            order: Order::new(),
            report: Report::default(),
        }
    }

    /// One sample, in whose beginning a law may come.
    pub fn sample(&mut self, news: Option<Law>, way: Way) -> Report {
        self.report.samples += 1;
        let last = self.input;
        if self.report.samples % 400 == 1 {
            // Wide enough to reach the limits of the output.
            self.input.r = self.order.below(9) as f32 - 4.0;
        }
        // Noise, or no measurement would ever differ from the last one.
        self.input.y = self.plant[1] + (self.order.below(65) as f32 - 32.0) / 4096.0;
        match news.filter(|law| self.is_known(law)) {
            Some(law) if law != self.law => self.swap(law, last, way),
            _ => {}
        }
        let out = self.law.step(&mut self.state, &self.input);
        self.plant[0] += 0.02 * (out.u - self.plant[0]);
        self.plant[1] += 0.05 * (self.plant[0] - self.plant[1]);
        self.report
    }

    fn is_known(&mut self, law: &Law) -> bool {
        let known = self.known.contains(law);
        self.report.torn += u32::from(!known);
        known
    }

    /// Replaces the law, and compares this sample with what the old law would have made of it.
    fn swap(&mut self, law: Law, last: ControllerInput<f32>, way: Way) {
        let mut ahead = self.state;
        let old = self.law.step(&mut ahead, &self.input);
        let before = self.law;
        if way != Way::Bare {
            law.adopt(&before, &mut self.state);
        }
        self.law = law;
        let mut ahead = self.state;
        let new = law.step(&mut ahead, &self.input);
        let difference = (new.u - old.u).abs();
        let bound = bound(&before, &law, last, self.input, old.i.abs() + old.pd.abs() + old.u_f.abs());
        let report = &mut self.report;
        report.swaps += 1;
        report.bumps += u32::from(difference > bound);
        report.difference = if difference > report.difference { difference } else { report.difference };
        let share = difference / bound;
        report.worst = if share > report.worst { share } else { report.worst };
    }
}

/// By how much the first sample of `new` may differ from what `old` would have given, see [`Controller::adopt`].
///
/// With the inputs of the last sample again, both laws would give the same but for the integral's increment, since the
/// state is handed over that way. All else is linear, so it is the difference of the two laws' immediate gains times what
/// the inputs have moved by. Limits are the same and can only bring the two together.
fn bound(old: &Law, new: &Law, last: ControllerInput<f32>, now: ControllerInput<f32>, terms: f32) -> f32 {
    let (a, b) = (old.pid().coefficients(), new.pid().coefficients());
    let increment = (b.ki_now - a.ki_now).abs() * (now.r - now.y).abs();
    let from_r = (b.h_r - a.h_r).abs() * (now.r - last.r).abs();
    let from_y = (from_y(new) - from_y(old)).abs() * (now.y - last.y).abs();
    // Half a unit in the last place for each of some hundred operations, none on anything larger than the terms and
    // what the gains make of the signals.
    let (gain_old, gain_new) = (from_y_size(old), from_y_size(new));
    let gains = if gain_new > gain_old { gain_new } else { gain_old };
    let rounding = 100.0 * f32::EPSILON * (terms + gains * (now.r.abs() + now.y.abs() + last.y.abs() + 1.0));
    increment + from_r + from_y + rounding
}

/// The change of the output in the same sample per change of the measurement [u/y].
fn from_y(law: &Law) -> f32 {
    -law.pid().coefficients().h_y - through_estimator(law)
}

fn from_y_size(law: &Law) -> f32 {
    law.pid().coefficients().h_y.abs() + through_estimator(law).abs()
}

/// The estimator's share: its section, `1/K`, and half the gain of each shared lag.
fn through_estimator(law: &Law) -> f32 {
    let c = law.compensator().coefficients();
    let section = c.y_lead[0] + c.y_lead[1] * c.y_feed[0];
    c.e_gain.iter().fold(c.gain * c.inv_gain * section, |gain, g| gain * (0.5 * g))
}

/// The place where laws are handed over.
pub type Cell = ParamCell<Law>;
