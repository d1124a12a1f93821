//! Square-root extraction against the root of a processor in double precision.

use controller_core::{Param, Quality};
use controller_hal::{FlowConfig, NegativePressure, Reading, SquareRootFlow, fast_sqrt};
use proptest::prelude::*;

/// What the documentation states of [`fast_sqrt`].
const STATED: f64 = 5e-6;

fn good(value: f32) -> Reading<f32> {
    Reading { value, quality: Quality::Good }
}

/// Largest relative error over every single-precision number from `lo` up to `hi`.
fn worst(lo: f32, hi: f32, root: impl Fn(f32) -> f32) -> f64 {
    (lo.to_bits()..hi.to_bits()).fold(0.0, |worst, bits| {
        let x = f32::from_bits(bits);
        let exact = f64::from(x).sqrt();
        ((f64::from(root(x)) - exact) / exact).abs().max(worst)
    })
}

/// Every number that a flow block can take the root of: from the shortest line up to twice the full flow.
#[test]
fn the_root_is_as_good_as_stated_for_every_number_of_the_working_range() {
    let found = worst(1e-6, 4.0, fast_sqrt);
    assert!(found <= STATED, "{found:e}");
    // And the statement is not a comfortable one.
    assert!(found > 0.9 * STATED, "{found:e}");
}

/// Far outside of the working range, by steps of a prime number.
#[test]
fn the_root_is_as_good_for_all_normal_numbers() {
    let mut worst = 0.0_f64;
    for bits in (f32::MIN_POSITIVE.to_bits()..f32::MAX.to_bits()).step_by(1009) {
        let x = f32::from_bits(bits);
        let exact = f64::from(x).sqrt();
        worst = worst.max(((f64::from(fast_sqrt(x)) - exact) / exact).abs());
    }
    assert!(worst <= STATED, "{worst:e}");
}

/// The exhaustive measurement finds what one refinement less would leave.
#[test]
fn the_measurement_sees_a_worse_root() {
    let one_step = |x: f32| {
        let y = f32::from_bits(0x5f37_5a86 - (x.to_bits() >> 1));
        x * (y * (1.5 - 0.5 * x * y * y))
    };
    let found = worst(1.0, 4.0, one_step);
    assert!(found > 1.7e-3 && found < 1.8e-3, "{found:e}");
}

/// The bits do not depend on the processor: the same number stands in the tests on the target.
#[test]
fn the_root_has_the_bits_of_the_target() {
    let mut hash = 0x811C_9DC5_u32;
    for k in 0_u32..4000 {
        hash =
            (hash ^ fast_sqrt(f32::from_bits(0x3580_0000 + k * 0x4021)).to_bits()).wrapping_mul(0x0100_0193);
    }
    assert_eq!(hash, 0xC99B_0D1D, "{hash:#010x}");
}

#[test]
fn the_root_of_anything_is_a_number() {
    for bits in (0..u32::MAX).step_by(4093).chain([0x7F80_0000, 0xFF80_0000, 0x7FC0_0000, u32::MAX]) {
        let x = f32::from_bits(bits);
        let root = fast_sqrt(x);
        assert!(root.is_finite() && root >= 0.0, "{x:e} {root:e}");
        assert!(x > 0.0 || root == 0.0);
    }
}

#[test]
fn the_line_meets_the_root_and_zero() {
    for linear_below in [1e-6, 1e-4, 0.01, 0.25] {
        let flow = SquareRootFlow::new(&FlowConfig { linear_below, ..FlowConfig::default() }).unwrap();
        let at = |x: f64| f64::from(flow.convert(good(x as f32)).value);
        let knee = linear_below.sqrt();
        assert!((at(linear_below * (1.0 - 1e-6)) - knee).abs() < 1.2e-5 * knee);
        assert!((at(linear_below * (1.0 + 1e-6)) - knee).abs() < 1.2e-5 * knee);
        assert!((at(linear_below * 0.5) - knee * 0.5).abs() < 6e-6 * knee);
        assert_eq!(at(0.0), 0.0);
    }
}

#[test]
fn a_cut_off_says_no_flow_at_all() {
    let config = FlowConfig { pressure: 40.0, flow: 200.0, cut_off: 0.05, ..FlowConfig::default() };
    let flow = SquareRootFlow::new(&config).unwrap();
    // On the line, 5 % of the flow are at 0.5 % of the pressure.
    assert_eq!(flow.convert(good(40.0 * 0.004_999)).value, 0.0);
    assert!((flow.convert(good(40.0 * 0.005_001)).value - 10.0).abs() < 0.01);
}

#[test]
fn a_negative_pressure_is_noise_or_a_fault_or_flow() {
    let zero = SquareRootFlow::new(&FlowConfig::default()).unwrap();
    assert_eq!(zero.convert(good(-0.01)), good(0.0));
    assert_eq!(zero.convert(good(-0.02)), Reading { value: 0.0, quality: Quality::Uncertain });
    assert_eq!(zero.convert(good(f32::MIN)), Reading { value: 0.0, quality: Quality::Uncertain });
    let config = FlowConfig { negative: NegativePressure::Mirror, ..FlowConfig::default() };
    let both = SquareRootFlow::new(&config).unwrap();
    let reversed = both.convert(good(-0.36));
    assert_eq!((reversed.value, reversed.quality), (-both.convert(good(0.36)).value, Quality::Good));
}

#[test]
fn another_root_is_taken_where_there_is_one() {
    let flow = SquareRootFlow::new(&FlowConfig { flow: 80.0, ..FlowConfig::default() }).unwrap();
    for k in 1_u16..400 {
        let x = 0.01 * f32::from(k) + 0.001;
        let exact = 80.0 * f64::from(x).sqrt();
        let found = flow.convert_with(good(x), f32::sqrt);
        assert!((f64::from(found.value) - exact).abs() <= exact * 3e-7, "{x}");
        assert_eq!(found.quality, Quality::Good);
    }
    assert_eq!(flow.convert_with(good(0.001), |_| f32::NAN), flow.convert(good(0.001)));
}

#[test]
fn what_is_no_root_is_no_flow() {
    for negative in [NegativePressure::Zero, NegativePressure::Mirror] {
        for cut_off in [0.0, 0.1] {
            let config = FlowConfig { flow: 1e12, cut_off, negative, ..FlowConfig::default() };
            let flow = SquareRootFlow::new(&config).unwrap();
            for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.5, f32::MAX, 1e30] {
                for pressure in [0.5, 4.0, 9.0, -0.5] {
                    let found = flow.convert_with(good(pressure), |_| wrong);
                    assert_eq!(found, Reading { value: 0.0, quality: Quality::Bad }, "{wrong} {pressure}");
                }
            }
        }
    }
}

#[test]
fn quality_only_gets_worse() {
    let flow = SquareRootFlow::new(&FlowConfig::default()).unwrap();
    let of = |value, quality| flow.convert(Reading { value, quality });
    assert_eq!(of(0.5, Quality::Bad).quality, Quality::Bad);
    assert_eq!(of(9.0, Quality::Bad).quality, Quality::Bad);
    assert_eq!(of(0.5, Quality::Uncertain).quality, Quality::Uncertain);
    assert_eq!(of(4.0, Quality::Good).quality, Quality::Good);
    let beyond = of(f32::MAX, Quality::Good);
    assert!(beyond.quality == Quality::Uncertain && (beyond.value - 2.0).abs() < 1.1e-5);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(of(bad, Quality::Good), Reading { value: 0.0, quality: Quality::Bad });
    }
}

#[test]
fn faults_of_a_flow_come_all_at_once() {
    let config = FlowConfig {
        pressure: 0.0,
        flow: f64::NAN,
        linear_below: 0.3,
        cut_off: -0.1,
        negative: NegativePressure::Zero,
    };
    let faults = SquareRootFlow::new(&config).unwrap_err();
    let found: Vec<Param> = faults.iter().map(|fault| fault.param).collect();
    assert_eq!(found, [Param::Span, Param::FlowFull, Param::LinearBelow, Param::CutOff]);
}

proptest! {
    /// The law of the documentation in double precision, over spans of all sizes.
    #[test]
    fn the_flow_is_that_of_the_law(
        exponents in (-11.0_f64..11.0, -11.0_f64..11.0),
        part in -0.01_f64..4.0,
        linear_below in 1e-6_f64..0.25,
    ) {
        let [pressure, flow] = [exponents.0, exponents.1].map(|e| 10.0_f64.powf(e));
        let config = FlowConfig { pressure, flow, linear_below, ..FlowConfig::default() };
        let block = SquareRootFlow::new(&config).unwrap();
        let x = (part * pressure) as f32;
        let exact = f64::from(x) / pressure;
        let root = if exact < 0.0 {
            0.0
        } else if exact < linear_below {
            exact / linear_below.sqrt()
        } else {
            exact.sqrt()
        };
        let found = block.convert(good(x));
        prop_assert!((f64::from(found.value) - flow * root).abs() <= flow * root * (STATED + 1e-6));
    }

    #[test]
    fn every_bit_pattern_gives_a_finite_flow(bits in any::<u32>(), mirror in any::<bool>(), cut_off in 0.0_f64..0.5) {
        let negative = if mirror { NegativePressure::Mirror } else { NegativePressure::Zero };
        let config = FlowConfig { pressure: 1e-12, flow: 1e12, linear_below: 1e-6, cut_off, negative };
        let flow = SquareRootFlow::new(&config).unwrap().convert(good(f32::from_bits(bits)));
        prop_assert!(flow.value.is_finite() && flow.value.abs() <= 2.001e12);
        prop_assert!(mirror || flow.value >= 0.0);
    }
}
