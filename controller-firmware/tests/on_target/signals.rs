//! Signal blocks of `controller-hal` on a processor that may have no root.

use controller_core::{Pid, PidConfig, PidInput, PidState, Quality};
use controller_hal::{
    Actuate, FlowConfig, GainSchedule, OperatingPoint, OutputConfig, Reading, SquareRootFlow,
    TimeProportioned, TimeProportionedConfig, fast_sqrt,
};

pub(crate) const TESTS: &[(&str, fn())] = &[
    ("the root is as good as stated", root),
    ("the root has the bits of the host", root_bits),
    ("the flow follows its law", flow),
    ("a schedule changes its law bumplessly, and not by a failed signal", schedule),
    ("a relay is on for what is due", relay),
];

/// Against a root by bisection of the square in double precision, which needs no root of anybody.
fn root() {
    for k in 0_u32..300 {
        let x = f32::from_bits(0x3600_0000 + k * 0x3_1415);
        let found = f64::from(fast_sqrt(x));
        let exact = f64::from(x);
        // (1 + e)^2 = 1 + 2 e, e small
        assert!((found * found / exact - 1.0).abs() <= 2.0 * 5e-6, "{x:e}");
    }
}

/// A hash over many roots; the same number stands in the tests of `controller-hal`, which run on the host.
fn root_bits() {
    let mut hash = 0x811C_9DC5_u32;
    for k in 0_u32..4000 {
        hash =
            (hash ^ fast_sqrt(f32::from_bits(0x3580_0000 + k * 0x4021)).to_bits()).wrapping_mul(0x0100_0193);
    }
    assert_eq!(hash, 0xC99B_0D1D, "{hash:#010x}");
}

fn flow() {
    let config = FlowConfig { pressure: 25.0, flow: 80.0, cut_off: 0.02, ..FlowConfig::default() };
    let flow = SquareRootFlow::new(&config).unwrap();
    let at = |value: f32| flow.convert(Reading { value, quality: Quality::Good });
    for (pressure, expected) in [(25.0, 80.0), (6.25, 40.0), (56.25, 120.0), (0.25, 8.0)] {
        let found = at(pressure);
        assert!((found.value - expected).abs() < expected * 6e-6 && found.quality == Quality::Good);
    }
    assert!((at(0.125).value - 4.0).abs() < 1e-4);
    assert_eq!((at(0.01).value, at(-0.1)), (0.0, Reading { value: 0.0, quality: Quality::Good }));
    assert_eq!((at(-1.0).quality, at(f32::NAN).quality), (Quality::Uncertain, Quality::Bad));
}

fn schedule() {
    let flow =
        SquareRootFlow::new(&FlowConfig { pressure: 25.0, flow: 100.0, ..FlowConfig::default() }).unwrap();
    let law = |kp: f64| Pid::<f32>::new(&PidConfig { kp, ki: kp, ..PidConfig::default() }, 0.1).unwrap();
    let points = [10.0, 50.0, 100.0].map(|at| OperatingPoint { at, law: law(0.02 * at) });
    let input = PidInput { r: 1.0, y: 1.0 };
    let begin = |law: &Pid<f32>| {
        let mut state = PidState::default();
        law.settle(&mut state, input, 5.0);
        state
    };
    let mut loops = GainSchedule::new(points, 8.0, 12.0_f32, begin).unwrap();
    // Flows of 20, 40, 90; none that is known, which is not a flow of 0; 27; a transmitter that failed at 4 mA.
    let (good, bad) = (Quality::Good, Quality::Bad);
    let walk = [
        (1.0, good, 0),
        (4.0, good, 1),
        (20.25, good, 2),
        (f32::NAN, good, 2),
        (1.8225, good, 1),
        (0.0, bad, 1),
    ];
    for (pressure, quality, active) in walk {
        let signal = flow.convert(Reading { value: pressure, quality });
        let u = loops.step(signal, &input).u();
        assert!((u - 5.0).abs() < 1e-5, "{u}");
        assert_eq!(loops.active(), active);
    }
}

struct Pin;

impl embedded_hal::digital::ErrorType for Pin {
    type Error = core::convert::Infallible;
}

impl embedded_hal::digital::OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

fn relay() {
    let config = TimeProportionedConfig {
        output: OutputConfig::default(),
        window: 100,
        minimum_on: 10,
        minimum_off: 10,
    };
    let mut heater = TimeProportioned::<_, f32>::new(Pin, &config).unwrap();
    for (duty, on) in [(0.0, 0_usize), (3.0, 300), (37.5, 3750), (96.0, 9600), (100.0, 10_000)] {
        assert_eq!(heater.apply(duty), Ok(duty));
        let done = (0..10_000).filter(|_| heater.tick() == Ok(true)).count();
        assert!(done.abs_diff(on) <= 10, "{duty} {done}");
        heater.switch_off().unwrap();
    }
    assert!(heater.apply(f32::NAN).is_err());
}
