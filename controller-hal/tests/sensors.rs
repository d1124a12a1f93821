//! Sensors over mocked buses.

use controller_core::{Quality, Real};
use controller_hal::{
    Ads1115, Ads1115Config, Ads1115Error, CountSpan, Gain, Inputs, Mcp320xError, Mcp3201, Mcp3204, Monitored,
    Rate, Reading, Sense, SpanConfig,
};
use embedded_hal::i2c::{ErrorKind as I2cFault, NoAcknowledgeSource};
use embedded_hal::spi::{ErrorKind as SpiFault, Operation};
use embedded_hal_mock::eh1::i2c::{Mock as I2c, Transaction as OnI2c};
use embedded_hal_mock::eh1::spi::{Mock as Spi, Transaction as OnSpi};
use proptest::prelude::*;

fn span(counts: (i32, i32), units: (f64, f64)) -> CountSpan<f32> {
    CountSpan::new(&SpanConfig::new(counts, units)).unwrap()
}

fn read_of(bytes: [u8; 2]) -> Vec<OnSpi<u8>> {
    vec![OnSpi::transaction_start(), OnSpi::read_vec(bytes.to_vec()), OnSpi::transaction_end()]
}

#[test]
fn the_mcp3201_reads_twelve_bits_between_undefined_ones() {
    // The data sheet's frame: ??0BBBBB BBBBBBB1 for the code 0xABC, the undefined bits once high, once low.
    for (undefined, last) in [(0xC000, 1), (0, 0)] {
        let word: u16 = undefined | 0xABC << 1 | last;
        let mut spi = Spi::new(&read_of(word.to_be_bytes()));
        let reading = Mcp3201::new(&mut spi, span((0, 4095), (0.0, 4095.0))).sample().unwrap();
        assert_eq!(reading, Reading { value: 2748.0, quality: Quality::Good });
        spi.done();
    }
}

#[test]
fn the_ends_of_an_adc_are_not_good() {
    let cases = [(0x0000, Quality::Uncertain), (0x0002, Quality::Good), (0x1FFE, Quality::Uncertain)];
    for (word, quality) in cases {
        let word: u16 = word;
        let mut spi = Spi::new(&read_of(word.to_be_bytes()));
        let reading = Mcp3201::new(&mut spi, span((0, 4095), (0.0, 5.0))).sample().unwrap();
        assert_eq!(reading.quality, quality, "{word:#x}");
        spi.done();
    }
}

#[test]
fn a_line_that_nobody_drives_is_no_answer() {
    let mut spi = Spi::new(&read_of([0xFF, 0xFF]));
    let mut sensor = Mcp3201::new(&mut spi, span((0, 4095), (0.0, 5.0)));
    assert_eq!(sensor.sample(), Err(Mcp320xError::NoAnswer));
    spi.done();
}

#[test]
fn the_mcp3204_asks_for_its_channel() {
    // The data sheet's frames: start bit and SGL, then the three bits of the channel.
    let frames = [(0, [0x06, 0x00, 0]), (3, [0x06, 0xC0, 0]), (5, [0x07, 0x40, 0]), (8, [0x06, 0x00, 0])];
    for (channel, frame) in frames {
        let mut spi = Spi::new(&[
            OnSpi::transaction_start(),
            OnSpi::transfer_in_place(frame.to_vec(), vec![0xFF, 0xE7, 0xD0]),
            OnSpi::transaction_end(),
        ]);
        let reading = Mcp3204::new(&mut spi, channel, span((0, 4000), (0.0, 400.0))).sample().unwrap();
        assert_eq!(reading, Reading { value: 200.0, quality: Quality::Good });
        spi.done();
    }
}

/// A device that answers words until its script fails.
struct Script(std::vec::IntoIter<Result<u16, SpiFault>>);

impl embedded_hal::spi::ErrorType for Script {
    type Error = SpiFault;
}

impl embedded_hal::spi::SpiDevice for Script {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), SpiFault> {
        let word = self.0.next().expect("more transactions than the script has")?;
        match operations {
            [Operation::Read(bytes)] => bytes.copy_from_slice(&word.to_be_bytes()),
            _ => panic!("one read is all it takes"),
        }
        Ok(())
    }
}

#[test]
fn a_failed_bus_is_a_bad_sample_and_counted() {
    let script = vec![Ok(0x0FA0), Err(SpiFault::Overrun), Err(SpiFault::ModeFault), Ok(0xFFFF), Ok(0x0FA2)];
    let device = Script(script.into_iter());
    let mut sensor = Monitored::new(Mcp3201::new(device, span((0, 4000), (0.0, 400.0))));
    assert_eq!(sensor.read(), Reading { value: 200.0, quality: Quality::Good });
    for error in
        [Mcp320xError::Bus(SpiFault::Overrun), Mcp320xError::Bus(SpiFault::ModeFault), Mcp320xError::NoAnswer]
    {
        assert_eq!(sensor.read(), Reading { value: 200.0, quality: Quality::Bad });
        assert_eq!(sensor.last_error(), Some(&error));
    }
    assert_eq!((sensor.failures(), sensor.failures_in_a_row()), (3, 3));
    let last = sensor.read();
    assert!((last.value - 200.1).abs() < 1e-4 && last.quality == Quality::Good);
    assert_eq!((sensor.failures(), sensor.failures_in_a_row()), (3, 0));
}

#[test]
fn a_measurement_that_is_no_number_is_a_bad_sample() {
    struct Raw(f32);
    impl Sense<f32> for Raw {
        type Error = ();
        fn sample(&mut self) -> Result<Reading<f32>, ()> {
            Ok(Reading { value: self.0, quality: Quality::Good })
        }
    }
    let mut sensor = Monitored::new(Raw(3.0));
    assert_eq!(sensor.read().quality, Quality::Good);
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        sensor.sensor_mut().0 = value;
        assert_eq!(sensor.read(), Reading { value: 3.0, quality: Quality::Bad });
    }
    assert_eq!((sensor.failures_in_a_row(), sensor.last_error()), (3, None));
}

const CHIP: u8 = 0x48;
/// AIN1 against ground, 4.096 V, 860 per second: by the data sheet 1_101_001_1 111_0_1_0_11, the polarity of the comparator
/// (which is off) being the mark of a chip that was configured.
const WORD: [u8; 2] = [0xD3, 0xEB];
/// What the chip has after power-up, by the data sheet.
const POWER_UP: [u8; 2] = [0x85, 0x83];

fn ads1115(bus: &mut I2c) -> Ads1115<&mut I2c, f32> {
    let config =
        Ads1115Config { inputs: Inputs::Single1, gain: Gain::V4_096, rate: Rate::R860, ..Default::default() };
    let counts = (Gain::V4_096.counts(0.0), Gain::V4_096.counts(2.0));
    Ads1115::new(bus, config, span(counts, (0.0, 10.0)))
}

fn start() -> OnI2c {
    OnI2c::write(CHIP, vec![1, WORD[0], WORD[1]])
}

fn configuration(high: u8) -> OnI2c {
    OnI2c::write_read(CHIP, vec![1], vec![high, WORD[1]])
}

fn conversion(counts: i16) -> OnI2c {
    OnI2c::write_read(CHIP, vec![0], counts.to_be_bytes().to_vec())
}

#[test]
fn the_ads1115_collects_what_it_started_a_sample_before() {
    let mut bus = I2c::new(&[
        start(),
        // 1 V
        configuration(WORD[0]),
        conversion(8000),
        start(),
        // still converting: neither taken nor started again
        configuration(WORD[0] & 0x7F),
        configuration(WORD[0]),
        conversion(32767),
        start(),
        configuration(WORD[0]),
        conversion(-32768),
        start(),
    ]);
    let mut sensor = ads1115(&mut bus);
    assert_eq!(sensor.sample(), Err(Ads1115Error::NotReady));
    assert_eq!(sensor.sample(), Ok(Reading { value: 5.0, quality: Quality::Good }));
    assert_eq!(sensor.sample(), Err(Ads1115Error::NotReady));
    // The ends lie outside of the span: not usable.
    assert_eq!(sensor.sample().map(|r| r.quality), Ok(Quality::Bad));
    assert_eq!(sensor.sample().map(|r| r.quality), Ok(Quality::Bad));
    bus.done();
}

#[test]
fn an_ads1115_that_lost_its_configuration_is_started_anew() {
    let mut bus = I2c::new(&[
        start(),
        // 2.048 V, another pin
        OnI2c::write_read(CHIP, vec![1], POWER_UP.to_vec()),
        start(),
        configuration(WORD[0]),
        conversion(8000),
        start(),
    ]);
    let mut sensor = ads1115(&mut bus);
    assert_eq!(sensor.sample(), Err(Ads1115Error::NotReady));
    assert_eq!(sensor.sample(), Err(Ads1115Error::Reset));
    assert_eq!(sensor.sample().map(|r| r.value), Ok(5.0));
    bus.done();
}

/// In every configuration, the one that the chip starts with among them.
#[test]
fn a_reset_of_an_ads1115_is_seen_in_every_configuration() {
    use Gain::*;
    use Inputs::*;
    use Rate::*;
    let inputs =
        [Differential01, Differential03, Differential13, Differential23, Single0, Single1, Single2, Single3];
    let gains = [V6_144, V4_096, V2_048, V1_024, V0_512, V0_256];
    let rates = [R8, R16, R32, R64, R128, R250, R475, R860];
    // The fields of the data sheet: MUX from bit 12 on, PGA from bit 9 on, DR from bit 5 on.
    for (mux, inputs) in (0_u16..).zip(inputs) {
        for (pga, gain) in (0_u16..).zip(gains) {
            for (dr, rate) in (0_u16..).zip(rates) {
                let word = (0x810B | mux << 12 | pga << 9 | dr << 5).to_be_bytes();
                let start = || OnI2c::write(CHIP, vec![1, word[0], word[1]]);
                let reads = |word: [u8; 2]| OnI2c::write_read(CHIP, vec![1], word.to_vec());
                let mut bus =
                    I2c::new(&[start(), reads(POWER_UP), start(), reads(word), conversion(8), start()]);
                let config = Ads1115Config { inputs, gain, rate, ..Ads1115Config::default() };
                let mut sensor = Ads1115::new(&mut bus, config, span((0, 16), (0.0, 16.0)));
                assert_eq!(sensor.sample(), Err(Ads1115Error::NotReady));
                assert_eq!(sensor.sample(), Err(Ads1115Error::Reset), "{config:?}");
                assert_eq!(sensor.sample(), Ok(Reading { value: 8.0, quality: Quality::Good }));
                bus.done();
            }
        }
    }
}

#[test]
fn an_ads1115_on_a_bad_bus_comes_back() {
    let unplugged = I2cFault::NoAcknowledge(NoAcknowledgeSource::Address);
    let mut bus = I2c::new(&[
        start().with_error(unplugged),
        start(),
        configuration(WORD[0]).with_error(unplugged),
        configuration(WORD[0]),
        conversion(8000).with_error(unplugged),
        configuration(WORD[0]),
        conversion(8000),
        start().with_error(unplugged),
        start(),
        configuration(WORD[0]),
        conversion(4000),
        start(),
    ]);
    let mut sensor = Monitored::new(ads1115(&mut bus));
    let qualities: Vec<Quality> = (0..7).map(|_| sensor.read().quality).collect();
    use Quality::{Bad, Good};
    assert_eq!(qualities, [Bad, Bad, Bad, Bad, Good, Bad, Good]);
    assert_eq!(sensor.failures(), 5);
    bus.done();
}

/// Counts of the whole line through two points, in exact arithmetic as far as `f64` goes.
fn scaled(counts: i32, ends: (i32, i32), units: (f64, f64)) -> f64 {
    let part = (f64::from(counts) - f64::from(ends.0)) / (f64::from(ends.1) - f64::from(ends.0));
    units.0 * (1.0 - part) + units.1 * part
}

proptest! {
    #[test]
    fn a_span_scales_as_a_line(
        lo in -30_000_i32..30_000,
        width in 1_i32..65_000,
        units in (-1e6_f64..1e6, -1e6_f64..1e6),
        at in 0.0_f64..1.0,
    ) {
        prop_assume!((units.0 - units.1).abs() > 1e-3 * (units.0.abs() + units.1.abs()));
        let ends = (lo, lo + width);
        let counts = lo + (at * f64::from(width)) as i32;
        let config = SpanConfig::new(ends, units);
        let bound = 2.0 * (units.0.abs() + units.1.abs());
        let expected = scaled(counts, ends, units);
        let single = CountSpan::<f32>::new(&config).unwrap().reading(counts);
        prop_assert!((f64::from(single.value) - expected).abs() <= bound * f64::from(f32::EPSILON));
        prop_assert_eq!(single.quality, Quality::Good);
        let double = CountSpan::<f64>::new(&config).unwrap().units(counts);
        prop_assert!((double - expected).abs() <= bound * f64::EPSILON * 2.0);
    }

    #[test]
    fn any_count_gives_a_finite_number(
        config in (any::<(i32, i32)>(), any::<(f64, f64)>(), any::<(i32, i32)>(), any::<(i32, i32)>())
            .prop_map(|(counts, units, good, usable)| SpanConfig { counts, units, good, usable }),
        near in (-1_000_i32..1_000, 1_i32..1_000, -1e12_f64..1e12, -1e12_f64..1e12),
        counts in any::<i32>(),
    ) {
        if let Ok(span) = CountSpan::<f32>::new(&config) {
            prop_assert!(span.units(counts).is_finite_number());
        }
        let config = SpanConfig::new((near.0, near.0 + near.1), (near.2, near.3));
        if let Ok(span) = CountSpan::<f32>::new(&config) {
            prop_assert!(span.units(counts).is_finite_number());
            let inside = counts >= near.0 && counts <= near.0 + near.1;
            prop_assert_eq!(span.reading(counts).quality == Quality::Good, inside);
        }
    }
}

#[test]
fn faults_of_a_span_come_all_at_once() {
    use controller_core::{Param, Reason};
    let config =
        SpanConfig { counts: (100, 100), units: (f64::NAN, 1.0), good: (-20, 10), usable: (-10, i32::MAX) };
    let faults = CountSpan::<f32>::new(&config).unwrap_err();
    let found: Vec<(Param, Reason)> = faults.iter().map(|fault| (fault.param, fault.reason)).collect();
    assert_eq!(
        found,
        [
            (Param::Counts, Reason::Inverted),
            (Param::UsableCounts, Reason::OutOfRange),
            (Param::GoodCounts, Reason::OutOfRange),
            (Param::Span, Reason::NotFinite),
        ]
    );
    // Two ends that single precision cannot keep apart.
    assert!(CountSpan::<f32>::new(&SpanConfig::new((0, 10), (1e6, 1e6 + 0.1))).is_err());
    assert!(CountSpan::<f64>::new(&SpanConfig::new((0, 10), (1e6, 1e6 + 0.1))).is_ok());
}
