//! Actuators over mocked devices.

use controller_hal::{Actuate, ActuateError, Mcp4725, OnInvalid, OutputConfig, OutputSpan, Pwm};
use embedded_hal::i2c::ErrorKind as I2cFault;
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::i2c::{Mock as I2c, Transaction as OnI2c};
use embedded_hal_mock::eh1::pwm::{Mock as PwmMock, Transaction as OnPwm};
use proptest::prelude::*;

const RANGE: OutputConfig = OutputConfig { lo: -20.0, hi: 80.0, invalid: OnInvalid::Keep };

/// What a PWM channel is asked in one sample.
fn duty(max: u16, duty: u16) -> [OnPwm; 2] {
    [OnPwm::max_duty_cycle(max), OnPwm::set_duty_cycle(duty)]
}

#[test]
fn a_duty_saturates_at_every_resolution() {
    for max in [1, 2, 255, 1000, 65_534, 65_535] {
        let outputs = [-20.0, -20.1, -1e30, f32::MIN, 80.0, 80.1, 1e30, f32::MAX];
        let script: Vec<OnPwm> =
            outputs.iter().flat_map(|&u| duty(max, if u < 0.0 { 0 } else { max })).collect();
        let mut channel = PwmMock::new(&script);
        let mut output = Pwm::<_, f32>::new(&mut channel, &RANGE).unwrap();
        for u in outputs {
            assert_eq!(output.apply(u), Ok(if u < 0.0 { -20.0 } else { 80.0 }), "{max} {u}");
        }
        channel.done();
    }
}

#[test]
fn a_duty_of_one_bit_rounds() {
    let script: Vec<OnPwm> = [duty(1, 0), duty(1, 1)].concat();
    let mut channel = PwmMock::new(&script);
    let mut output = Pwm::<_, f64>::new(&mut channel, &RANGE).unwrap();
    assert_eq!((output.apply(29.9), output.apply(30.0)), (Ok(-20.0), Ok(80.0)));
    channel.done();
}

#[test]
fn what_is_no_number_never_becomes_a_duty() {
    let mut channel = PwmMock::new(&[
        // before anything was applied: nothing is set
        OnPwm::max_duty_cycle(100),
        OnPwm::max_duty_cycle(100),
        OnPwm::set_duty_cycle(50),
        OnPwm::max_duty_cycle(100),
        OnPwm::max_duty_cycle(100),
    ]);
    let mut output = Pwm::<_, f32>::new(&mut channel, &RANGE).unwrap();
    assert_eq!((output.apply(f32::NAN), output.applied()), (Err(ActuateError::NotFinite), None));
    assert_eq!(output.apply(30.0), Ok(30.0));
    assert_eq!(output.apply(f32::INFINITY), Err(ActuateError::NotFinite));
    assert_eq!(output.apply(f32::NEG_INFINITY), Err(ActuateError::NotFinite));
    assert_eq!(output.applied(), Some(30.0));
    channel.done();
}

#[test]
fn an_actuator_goes_to_its_safe_output() {
    let script = [duty(1000, 900), duty(1000, 200)].concat();
    let mut channel = PwmMock::new(&script);
    let config = OutputConfig { invalid: OnInvalid::Safe(0.0), ..RANGE };
    let mut output = Pwm::<_, f32>::new(&mut channel, &config).unwrap();
    assert_eq!(output.apply(70.0), Ok(70.0));
    assert_eq!((output.apply(f32::NAN), output.applied()), (Err(ActuateError::NotFinite), Some(0.0)));
    channel.done();
}

#[test]
fn a_failed_channel_is_reported() {
    let failed = MockError::Io(std::io::ErrorKind::Other);
    let mut channel = PwmMock::new(&[
        OnPwm::max_duty_cycle(100),
        OnPwm::set_duty_cycle(20).with_error(failed.clone()),
        OnPwm::max_duty_cycle(100),
        OnPwm::set_duty_cycle(20),
    ]);
    let mut output = Pwm::<_, f32>::new(&mut channel, &RANGE).unwrap();
    assert_eq!((output.apply(0.0), output.applied()), (Err(ActuateError::Device(failed)), None));
    assert_eq!((output.apply(0.0), output.applied()), (Ok(0.0), Some(0.0)));
    channel.done();
}

#[test]
fn a_channel_without_levels_stays_at_the_lower_end() {
    let mut channel = PwmMock::new(&duty(0, 0));
    let mut output = Pwm::<_, f32>::new(&mut channel, &RANGE).unwrap();
    assert_eq!(output.apply(80.0), Ok(-20.0));
    channel.done();
}

#[test]
fn the_mcp4725_takes_two_bytes() {
    let write = |high, low| OnI2c::write(0x60, vec![high, low]);
    let mut bus = I2c::new(&[
        write(0x00, 0x00),
        write(0x0F, 0xFF),
        write(0x08, 0x00),
        write(0x08, 0x00).with_error(I2cFault::ArbitrationLoss),
        write(0x03, 0x33),
    ]);
    let config = OutputConfig { invalid: OnInvalid::Safe(0.0), ..RANGE };
    let mut valve = Mcp4725::<_, f32>::new(&mut bus, Mcp4725::<(), f32>::ADDRESS, &config).unwrap();
    assert_eq!((valve.apply(-30.0), valve.apply(200.0)), (Ok(-20.0), Ok(80.0)));
    let half = valve.apply(30.0).unwrap();
    assert!((half - (-20.0 + 100.0 * 2048.0 / 4095.0)).abs() < 1e-5);
    assert_eq!(
        (valve.apply(30.0), valve.applied()),
        (Err(ActuateError::Device(I2cFault::ArbitrationLoss)), None)
    );
    // 20 of 100: the code 819
    assert_eq!(valve.apply(f32::NAN), Err(ActuateError::NotFinite));
    assert_eq!(valve.applied(), Some(0.0));
    bus.done();
}

#[test]
fn faults_of_an_output_come_all_at_once() {
    use controller_core::{Param, Reason};
    let all = |lo, hi, invalid| {
        let faults = OutputSpan::<f32>::new(&OutputConfig { lo, hi, invalid }).unwrap_err();
        faults.iter().map(|fault| (fault.param, fault.reason)).collect::<Vec<_>>()
    };
    assert_eq!(all(1.0, 0.0, OnInvalid::Keep), [(Param::Span, Reason::OutOfRange)]);
    assert_eq!(all(1.0, 1.0, OnInvalid::Keep), [(Param::Span, Reason::Inverted)]);
    assert_eq!(all(0.0, f64::INFINITY, OnInvalid::Keep), [(Param::Span, Reason::NotFinite)]);
    assert_eq!(
        all(f64::NAN, 1.0, OnInvalid::Safe(f64::NAN)),
        [(Param::Span, Reason::NotFinite), (Param::SafeOutput, Reason::NotFinite)]
    );
    assert_eq!(all(0.0, 1.0, OnInvalid::Safe(1.5)), [(Param::SafeOutput, Reason::OutOfRange)]);
}

proptest! {
    /// Every bit pattern: a level in range or none, and back an output in range that is at most half a level away.
    #[test]
    fn a_level_is_the_nearest(bits in any::<u32>(), inside in -30.0_f32..90.0, full in 1_u16..) {
        let span = OutputSpan::<f32>::new(&RANGE).unwrap();
        for u in [f32::from_bits(bits), inside] {
            let Some(level) = span.level(u, full) else {
                prop_assert!(!u.is_finite());
                continue;
            };
            prop_assert!(u.is_finite() && level <= full);
            let back = span.output(level, full);
            prop_assert!((-20.0..=80.0).contains(&back));
            let wanted = f64::from(u).clamp(-20.0, 80.0);
            let half = 50.0 / f64::from(full);
            prop_assert!((f64::from(back) - wanted).abs() <= half + 200.0 * f64::from(f32::EPSILON));
            // What was accepted is accepted again as it is.
            prop_assert_eq!(span.level(back, full), Some(level));
        }
    }

    #[test]
    fn a_level_rises_with_the_output(a in -30.0_f32..90.0, b in -30.0_f32..90.0, full in any::<u16>()) {
        let span = OutputSpan::<f32>::new(&RANGE).unwrap();
        let (lower, higher) = if a < b { (a, b) } else { (b, a) };
        prop_assert!(span.level(lower, full) <= span.level(higher, full));
    }
}
