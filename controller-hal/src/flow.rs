//! Flow from a differential pressure.

use crate::faults::{Faults, RANGE_LIMIT};
use crate::sense::Reading;
use controller_core::{ConfigErrors, Param, Quality, Real};
use micromath::F32;

/// Largest pressure, as a multiple of the one at full flow: twice the flow. What lies beyond is not a measurement.
const MOST: f32 = 4.0;

/// What a negative differential pressure means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum NegativePressure {
    /// No flow. As far below zero as the line of [`FlowConfig::linear_below`] goes above, that is the noise of a transmitter;
    /// further, the reading is [`Quality::Uncertain`]: the lines are swapped, blocked or the flow is reversed.
    #[default]
    Zero,
    /// Flow the other way, for an element that measures both.
    Mirror,
}

/// What a person writes for a [`SquareRootFlow`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FlowConfig {
    /// Differential pressure at full flow, above 0, 1e-12 to 1e12.
    pub pressure: f64,
    /// Full flow, above 0, 1e-12 to 1e12.
    pub flow: f64,
    /// Part of `pressure` below which the root is replaced by a line through 0, 1e-6 to 0.25; default 0.01, a tenth of the
    /// flow. The root's slope grows without bound towards 0, and with it the noise of the pressure.
    pub linear_below: f64,
    /// Part of `flow` below which there is no flow, 0 to 0.5; default 0: no cut-off.
    pub cut_off: f64,
    /// What a negative pressure means.
    pub negative: NegativePressure,
}

impl Default for FlowConfig {
    fn default() -> Self {
        Self { pressure: 1.0, flow: 1.0, linear_below: 0.01, cut_off: 0.0, negative: NegativePressure::Zero }
    }
}

/// Square-root extraction: the flow through an orifice or a nozzle from its differential pressure, in single precision.
///
/// Law: `q = flow * root(dp/pressure)`, `root(x) = sqrt(x)` from `linear_below` on and `x/sqrt(linear_below)` below, 0 below
/// `cut_off`; limited at twice the full flow. The root is [`fast_sqrt`]: the flow's relative error is at most 5e-6 for it
/// and 3e-7 for scaling, far below that of any pressure transmitter. It serves signals: no law is built with it.
/// Cost: 16 operations, no division, 8 compares.
///
/// Quality: that of the pressure; [`Quality::Bad`] and a flow of 0 when it is not finite (a value that means nothing: look at
/// the quality); at best [`Quality::Uncertain`] where
/// the flow is limited, or the pressure is negative and should not be.
///
/// ```
/// use controller_core::Quality;
/// use controller_hal::{FlowConfig, Reading, SquareRootFlow};
/// // 25 kPa at 80 m3/h, nothing below 2 % of it
/// let flow = SquareRootFlow::new(&FlowConfig { pressure: 25.0, flow: 80.0, cut_off: 0.02, ..FlowConfig::default() }).unwrap();
/// let at = |value: f32| flow.convert(Reading { value, quality: Quality::Good });
/// assert!((at(6.25).value - 40.0).abs() < 40.0 * 6e-6);
/// assert!((at(0.125).value - 4.0).abs() < 1e-4); // on the line: half of the pressure, half of the flow
/// assert_eq!((at(0.01).value, at(-0.1).value, at(-0.1).quality), (0.0, 0.0, Quality::Good));
/// assert_eq!((at(-1.0).quality, at(f32::NAN).quality), (Quality::Uncertain, Quality::Bad));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareRootFlow {
    per_pressure: f32,
    flow: f32,
    linear_below: f32,
    slope: f32,
    cut_off: f32,
    negative: NegativePressure,
}

impl SquareRootFlow {
    /// The block of `config`.
    ///
    /// # Errors
    /// A parameter that is not finite or outside the range that its field names.
    pub fn new(config: &FlowConfig) -> Result<Self, ConfigErrors> {
        let mut faults = Faults::default();
        faults.range(Param::Span, config.pressure, 1.0 / RANGE_LIMIT, RANGE_LIMIT);
        faults.range(Param::FlowFull, config.flow, 1.0 / RANGE_LIMIT, RANGE_LIMIT);
        faults.range(Param::LinearBelow, config.linear_below, 1e-6, 0.25);
        faults.range(Param::CutOff, config.cut_off, 0.0, 0.5);
        #[allow(clippy::cast_possible_truncation)] // rounded once
        let single = |x: f64| x as f32;
        let linear_below = single(config.linear_below);
        faults.finish(Self {
            per_pressure: single(1.0 / config.pressure),
            flow: single(config.flow),
            linear_below,
            // Of the same root, so that the line meets it.
            slope: fast_sqrt(linear_below) / linear_below,
            cut_off: single(config.cut_off),
            negative: config.negative,
        })
    }

    /// The flow at a differential pressure.
    #[must_use]
    pub fn convert(&self, pressure: Reading<f32>) -> Reading<f32> {
        self.convert_with(pressure, fast_sqrt)
    }

    /// As [`convert`](Self::convert) with another root of numbers from 1e-6 to 4, such as `libm::sqrtf`, which is exact and,
    /// without a floating-point unit, cheaper; see [`fast_sqrt`]. The line below still ends at the approximate root. What can
    /// be no root of such a number, being not finite, below 0 or above 4, is a flow of 0 and [`Quality::Bad`].
    #[must_use]
    pub fn convert_with(&self, pressure: Reading<f32>, root: impl FnOnce(f32) -> f32) -> Reading<f32> {
        let x = pressure.value * self.per_pressure;
        if x.is_nan() || pressure.value.is_infinite() {
            return Reading { value: 0.0, quality: Quality::Bad };
        }
        let size = x.abs();
        let beyond = size > MOST;
        let size = if beyond { MOST } else { size };
        let root = if size < self.linear_below { size * self.slope } else { root(size) };
        if !(0.0..=MOST).contains(&root) {
            return Reading { value: 0.0, quality: Quality::Bad };
        }
        let root = if root < self.cut_off { 0.0 } else { root };
        let (root, wrong) = match self.negative {
            NegativePressure::Mirror => (if x < 0.0 { -root } else { root }, false),
            NegativePressure::Zero if x < 0.0 => (0.0, size > self.linear_below),
            NegativePressure::Zero => (root, false),
        };
        let quality = match pressure.quality {
            Quality::Good if beyond || wrong => Quality::Uncertain,
            quality => quality,
        };
        Reading { value: self.flow * root, quality }
    }
}

/// The square root of a positive number, approximately: micromath's inverse root, good to 3.5 %, refined by two steps of
/// Newton's iteration `y <- y*(3 - x*y^2)/2`, times `x`.
///
/// Relative error at most 5e-6 for normal numbers (measured over every number of the range that [`SquareRootFlow`] works in).
/// Of what is not above 0, a NaN too, it gives 0; of infinity the root of the largest number; below the normal range the
/// result is too small. Cost: 10 operations, no division, no table, 2 compares.
///
/// Executed instructions, measured: 23 on a Cortex-M4F, where `libm::sqrtf`, which is exact, takes 46; on a Cortex-M0, which does every
/// operation by software, 1226 against 409. There the exact root is the better one ([`SquareRootFlow::convert_with`]); micromath's root
/// alone takes 9 and 46, and is off by up to 6 %.
///
/// ```
/// use controller_hal::fast_sqrt;
/// assert!((fast_sqrt(2.0) - 1.414_213_6).abs() < 8e-6);
/// assert_eq!((fast_sqrt(0.0), fast_sqrt(-2.0), fast_sqrt(f32::NAN)), (0.0, 0.0, 0.0));
/// ```
#[must_use]
pub fn fast_sqrt(x: f32) -> f32 {
    // Outside of this range the integer arithmetic within could overflow.
    let x = x.clamp_to(0.0, f32::MAX);
    let mut y = F32(x).invsqrt().0;
    let half = 0.5 * x;
    for _ in 0..2 {
        y = y * (1.5 - half * y * y);
    }
    x * y
}
