//! The frequency response of a plant with its gain taken out.

use std::vec::Vec;

use crate::model::{Complex, Polynomial, TransferFunction};

/// `g(s) = G(s)/gain` at `s = j*omega`, as factors ready to evaluate.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    num: Vec<Vec<f64>>,
    den: Vec<Vec<f64>>,
    /// Poles at `s = 0` less zeros there.
    integrators: i32,
    dead_time: f64,
}

impl Response {
    pub(crate) fn new(plant: &TransferFunction) -> Self {
        let factors =
            |list: &[Polynomial]| list.iter().map(|p| p.coefficients().to_vec()).collect::<Vec<_>>();
        let count = |n: usize| i32::try_from(n).unwrap_or(i32::MAX);
        Self {
            num: factors(plant.num()),
            den: factors(plant.den()),
            integrators: count(plant.integrators()) - count(plant.differentiators()),
            dead_time: plant.dead_time(),
        }
    }

    /// Poles at `s = 0` less zeros there.
    pub(crate) fn integrators(&self) -> i32 {
        self.integrators
    }

    /// The value without dead time.
    pub(crate) fn rational(&self, omega: f64) -> Complex {
        let mut value = Complex::ONE;
        // In turn, so that partial products stay as moderate as the result.
        let (mut num, mut den) = (self.num.iter(), self.den.iter());
        loop {
            let (top, bottom) = (num.next(), den.next());
            if top.is_none() && bottom.is_none() {
                break;
            }
            value = top.map_or(value, |p| value * polynomial(p, omega));
            value = bottom.map_or(value, |p| value / polynomial(p, omega));
        }
        let s = Complex::new(0.0, omega);
        for _ in 0..self.integrators {
            value = value / s;
        }
        for _ in self.integrators..0 {
            value = value * s;
        }
        value
    }

    /// The value.
    pub(crate) fn at(&self, omega: f64) -> Complex {
        self.rational(omega) * turn(omega * self.dead_time)
    }
}

/// `exp(-j*angle)`.
pub(crate) fn turn(angle: f64) -> Complex {
    if angle == 0.0 {
        return Complex::ONE;
    }
    let (sin, cos) = libm::sincos(angle);
    Complex::new(cos, -sin)
}

/// A real polynomial at `s = j*omega`: even powers make the real part, odd ones the imaginary.
pub(crate) fn polynomial(coefficients: &[f64], omega: f64) -> Complex {
    match *coefficients {
        [c0, c1] => Complex::new(c0, c1 * omega),
        [c0, c1, c2] => Complex::new(c0 - c2 * omega * omega, c1 * omega),
        _ => {
            let s = Complex::new(0.0, omega);
            coefficients.iter().rev().fold(Complex::ZERO, |sum, &c| sum * s + Complex::real(c))
        }
    }
}
