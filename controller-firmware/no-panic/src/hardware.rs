//! Sensors, actuators and signal blocks over drivers that nothing is known of, and telemetry.

use crate::keep;
use controller_core::{Controller, ControllerState, Real, Trace, TraceSample};
use controller_hal::{
    Actuate, Ads1115, CountSpan, GainSchedule, Mcp3201, Mcp3204, Mcp4725, Monitored, Number, OutputSpan, Pwm,
    Reading, Sense, SquareRootFlow, TimeProportioned,
};
use core::hint::black_box;
use embedded_hal::{digital, i2c, pwm, spi};

/// A driver: fails or not, reads anything.
pub(crate) struct Driver(u8);

/// Why it fails.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Broken;

impl Driver {
    fn act(&self, bytes: &mut [u8]) -> Result<(), Broken> {
        for byte in bytes {
            *byte = black_box(self.0);
        }
        if black_box(self.0) == 0 { Err(Broken) } else { Ok(()) }
    }
}

impl spi::Error for Broken {
    fn kind(&self) -> spi::ErrorKind {
        spi::ErrorKind::Other
    }
}

impl i2c::Error for Broken {
    fn kind(&self) -> i2c::ErrorKind {
        i2c::ErrorKind::Other
    }
}

impl pwm::Error for Broken {
    fn kind(&self) -> pwm::ErrorKind {
        pwm::ErrorKind::Other
    }
}

impl digital::Error for Broken {
    fn kind(&self) -> digital::ErrorKind {
        digital::ErrorKind::Other
    }
}

impl spi::ErrorType for Driver {
    type Error = Broken;
}

impl i2c::ErrorType for Driver {
    type Error = Broken;
}

impl pwm::ErrorType for Driver {
    type Error = Broken;
}

impl digital::ErrorType for Driver {
    type Error = Broken;
}

impl spi::SpiDevice for Driver {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Broken> {
        for operation in operations {
            if let spi::Operation::Read(bytes) | spi::Operation::TransferInPlace(bytes) = operation {
                self.act(bytes)?;
            }
        }
        Ok(())
    }
}

impl i2c::I2c for Driver {
    fn transaction(&mut self, _: u8, operations: &mut [i2c::Operation<'_>]) -> Result<(), Broken> {
        for operation in operations {
            if let i2c::Operation::Read(bytes) = operation {
                self.act(bytes)?;
            }
        }
        Ok(())
    }
}

impl pwm::SetDutyCycle for Driver {
    fn max_duty_cycle(&self) -> u16 {
        u16::from(black_box(self.0))
    }
    fn set_duty_cycle(&mut self, _: u16) -> Result<(), Broken> {
        self.act(&mut [])
    }
}

impl digital::OutputPin for Driver {
    fn set_low(&mut self) -> Result<(), Broken> {
        self.act(&mut [])
    }
    fn set_high(&mut self) -> Result<(), Broken> {
        self.act(&mut [])
    }
}

type Schedule<T> = GainSchedule<Controller<T>, ControllerState<T, ()>, T, 3>;

pub(crate) fn keep_all<T: Number + Real>() {
    keep! {
        CountSpan::<T>::new => fn(&_) -> _,
        CountSpan::<T>::reading => fn(&_, _) -> _,
        CountSpan::<T>::reading_between => fn(&_, _, _) -> _,
        OutputSpan::<T>::new => fn(&_) -> _,
        OutputSpan::<T>::level => fn(&_, _, _) -> _,
        OutputSpan::<T>::output => fn(&_, _, _) -> _,
        Reading::<T>::into_input => fn(_, _) -> _,
        Monitored::<Mcp3201<Driver, T>, T>::read => fn(&mut _) -> _,
        Monitored::<Ads1115<Driver, T>, T>::read => fn(&mut _) -> _,
        <Mcp3204<Driver, T> as Sense<T>>::sample => fn(&mut _) -> _,
        Ads1115::<Driver, T>::start => fn(&mut _) -> _,
        Ads1115::<Driver, T>::collect => fn(&mut _) -> _,
        <Mcp4725<Driver, T> as Actuate<T>>::apply => fn(&mut _, _) -> _,
        <Pwm<Driver, T> as Actuate<T>>::apply => fn(&mut _, _) -> _,
        <TimeProportioned<Driver, T> as Actuate<T>>::apply => fn(&mut _, _) -> _,
        TimeProportioned::<Driver, T>::tick => fn(&mut _) -> _,
        TimeProportioned::<Driver, T>::switch_off => fn(&mut _) -> _,
        Schedule::<T>::choose => fn(&mut _, _) -> _,
        Schedule::<T>::step => fn(&mut _, _, &_) -> _,
        TraceSample::<T>::new => fn(_, &_, &_) -> _,
        Trace::<TraceSample<T>, 16>::push => fn(&_, _) -> _,
        Trace::<TraceSample<T>, 16>::pop => fn(&_) -> _,
        Trace::<TraceSample<T>, 16>::dropped => fn(&_) -> _,
        Trace::<TraceSample<T>, 16>::len => fn(&_) -> _,
    }
}

/// What there is in single precision alone.
pub(crate) fn keep_single() {
    keep! {
        SquareRootFlow::new => fn(&_) -> _,
        SquareRootFlow::convert => fn(&_, _) -> _,
        flow_with => fn(&_, _, _) -> _,
        controller_hal::fast_sqrt => fn(_) -> _,
    }
}

/// With a root that nothing is known of.
fn flow_with(flow: &SquareRootFlow, pressure: Reading<f32>, root: fn(f32) -> f32) -> Reading<f32> {
    flow.convert_with(pressure, root)
}
