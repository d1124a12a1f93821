//! The largest sensitivity of a loop, by looking at many frequencies.

use controller_core::PidConfig;
use controller_design::model::{Complex, TransferFunction};

/// `max |1/(1 + C*G)|` over six decades around `1/time`; the loop must be stable.
pub(crate) fn ms(pid: &PidConfig, plant: &TransferFunction, time: f64) -> f64 {
    let sensitivity = |k: u32| {
        let s = Complex::new(0.0, libm::exp10(f64::from(k) / 3000.0 - 3.0) / time);
        let one = Complex::real(1.0);
        let law = (s * s * pid.kd + s * pid.kp + Complex::real(pid.ki)) / (s * (s * pid.tf + one));
        1.0 / (one + law * plant.at(s)).abs()
    };
    (0..18_000).map(sensitivity).fold(0.0, f64::max)
}
