//! A non-linear plant through time: the method of Dormand and Prince, order 5, with error control.

use super::{Nonlinear, State};
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};

/// Error that a step of the integrator may make, relative to the state and to the plant's
/// [`scale`](Nonlinear::scale). Where nothing bends, a step from one substep to the next is far better than that; it is for
/// the bends that the equations have.
pub const TOLERANCE: f64 = 1e-12;

/// Most steps, rejected ones included, from one change of an input to the next.
const MOST_STEPS: usize = 20_000;

type Method = ExplicitRungeKutta<Ordinary, DormandPrince, f64, State, 5, 7, 7>;

/// The integrator could not go on: the plant is too fast for its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stuck;

/// A plant with its states.
///
/// Equal inputs give equal bits, however many threads there are: nothing is shared, and the length of a step is a power
/// of two or what is left, so that not even the last bit of a platform's power function can move one.
#[derive(Clone)]
pub struct Integrator {
    plant: Nonlinear,
    x: State,
    /// Never run: each piece begins with a copy of it.
    method: Method,
    /// Step that the last piece ended with \[s\].
    step: f64,
}

impl std::fmt::Debug for Integrator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Integrator").field("plant", &self.plant).field("x", &self.x).finish_non_exhaustive()
    }
}

/// The equations under the inputs of a piece: the plant's input and its load, by the time since the piece began.
struct Driven<'a, F> {
    plant: &'a Nonlinear,
    inputs: F,
}

impl<F: Fn(f64) -> [f64; 2]> ODE<f64, State> for Driven<'_, F> {
    fn diff(&self, t: f64, x: &State, rates: &mut State) {
        let [u, d] = (self.inputs)(t);
        *rates = self.plant.derivative(x, u, d);
    }
}

impl Integrator {
    /// The plant with the states `x`.
    #[must_use]
    pub fn new(plant: Nonlinear, x: [f64; 2]) -> Self {
        let method = Method::dopri5()
            .rtol(TOLERANCE)
            .atol(TOLERANCE * plant.scale())
            .max_steps(MOST_STEPS)
            .max_scale(8.0);
        Self { plant, x, method, step: f64::INFINITY }
    }

    /// The plant.
    #[must_use]
    pub fn plant(&self) -> &Nonlinear {
        &self.plant
    }

    /// The states.
    #[must_use]
    pub fn states(&self) -> &[f64; 2] {
        &self.x
    }

    /// What is measured \[y\].
    #[must_use]
    pub fn output(&self) -> f64 {
        self.plant.output(&self.x)
    }

    /// Moves through a piece of `h` seconds, in which `inputs` \[u, load\], by the time since its beginning, have no jump.
    ///
    /// # Errors
    /// More steps than there may be: the plant stays as it was.
    pub fn advance(&mut self, h: f64, inputs: impl Fn(f64) -> [f64; 2]) -> Result<(), Stuck> {
        let driven = Driven { plant: &self.plant, inputs };
        // Behind this, no time is left to move in.
        let end = h * (1.0 - 1e-12);
        let mut step = power_of_two(self.step).min(h);
        let mut method = self.method.clone().h0(step);
        method.init(&driven, 0.0, h, &self.x).map_err(|_| Stuck)?;
        while method.t() < end {
            method.set_h(step.min(h - method.t()));
            method.step(&driven).map_err(|_| Stuck)?;
            step = power_of_two(method.h());
        }
        self.step = step;
        self.x = self.plant.within(*method.y());
        Ok(())
    }
}

/// The largest power of two not above `h`; infinite and not usable ones as they are.
fn power_of_two(h: f64) -> f64 {
    if h.is_normal() && h > 0.0 { f64::from_bits(h.to_bits() & !((1 << 52) - 1)) } else { h }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Heater, TankLoad, TwoTank};

    #[test]
    fn steps_are_powers_of_two() {
        assert_eq!([3.9, 4.0, 0.3, f64::INFINITY].map(power_of_two), [2.0, 4.0, 0.25, f64::INFINITY]);
    }

    /// Free outflow from a tank that ends at its bottom: `h = (sqrt(h0) - k*t)^2`, `k = c/(2*area)`, until it is empty.
    #[test]
    fn a_tank_drains_along_a_parabola() {
        let tank = TwoTank { drop: 0.0, ..TwoTank::default() };
        let k = 0.5 * tank.drain * tank.valve / 100.0 / tank.area;
        let mut plant = Integrator::new(Nonlinear::TwoTank(tank), [36.0, 0.0]);
        let empty = 6.0 / k;
        let mut t = 0.0;
        while t < 1.2 * empty {
            plant.advance(0.7, |_| [0.0, 0.0]).expect("a step");
            t += 0.7;
            let root = (6.0 - k * t).max(0.0);
            let h = plant.output();
            // Up to where the flow is laminar: a millionth of the height, and less than that behind.
            let allowed = if root * root > 1e-3 { 1e-7 } else { 1e-4 };
            assert!((h - root * root).abs() < allowed, "{t}: {h} {}", root * root);
        }
        assert!(plant.output() < 50e-6 && plant.output() >= 0.0);
    }

    /// While the input is held the target is, too: the heater goes there along one exponential, `tau_heat` upwards and
    /// `tau_cool` downwards, and the sensor is a second lag behind it.
    #[test]
    fn a_heater_is_an_exponential_each_way() {
        let heater = Heater {
            gain: 2.0,
            gain_cool: 0.5,
            tau_heat: 10.0,
            tau_cool: 35.0,
            ambient: 20.0,
            sensor_lag: 3.0,
            dead_time: 0.0,
        };
        let mut plant = Integrator::new(Nonlinear::Heater(heater), [0.0, 0.0]);
        let (mut x, mut s) = (0.0, 0.0);
        for (u, target, tau) in
            [(30.0, 60.0, 10.0), (5.0, 10.0, 35.0), (-8.0, -4.0, 35.0), (0.0, 0.0, 35.0), (20.0, 40.0, 10.0)]
        {
            for _ in 0..40 {
                plant.advance(0.5, |_| [u, 0.0]).expect("a step");
                // Sensor: s = target + a exp(-t/tau) + b exp(-t/3).
                let (gap, h) = (x - target, 0.5);
                let a = gap / (1.0 - 3.0 / tau);
                let b = s - target - a;
                x = target + gap * libm::exp(-h / tau);
                s = target + a * libm::exp(-h / tau) + b * libm::exp(-h / 3.0);
                assert!((plant.output() - 20.0 - s).abs() < 1e-7, "{u}: {} {s}", plant.output() - 20.0);
            }
        }
    }

    /// Volume over the rim and below the bottom: the level stays at its end, and comes back from it at once.
    #[test]
    fn a_tank_has_two_ends() {
        let tank = TwoTank::default();
        let mut plant = Integrator::new(Nonlinear::TwoTank(tank), [45.0, 0.0]);
        for _ in 0..200 {
            plant.advance(1.0, |_| [90.0, 0.0]).expect("a step");
        }
        assert_eq!(plant.output(), 50.0);
        plant.advance(1.0, |_| [0.0, 0.0]).expect("a step");
        let fall = 14.071_247_279_470_288 * libm::sqrt(74.5) / 80.3;
        assert!((50.0 - plant.output() - fall).abs() < 0.02, "{}", plant.output());
        for _ in 0..200 {
            plant.advance(1.0, |_| [10.0, 0.0]).expect("a step");
        }
        assert_eq!(plant.output(), 0.0);
        plant.advance(1.0, |_| [50.0, 0.0]).expect("a step");
        let rise = (99.0 - 14.071_247_279_470_288 * libm::sqrt(24.5)) / 80.3;
        assert!((plant.output() - rise).abs() < 0.01, "{}", plant.output());
        // A feed tank of 30 cm's worth of water ends it earlier.
        let little = TwoTank { feed_area: 80.3, feed_level: 30.0, ..tank };
        let mut plant = Integrator::new(Nonlinear::TwoTank(little), [25.0, 0.0]);
        for _ in 0..200 {
            plant.advance(1.0, |_| [90.0, 0.0]).expect("a step");
        }
        assert_eq!(plant.output(), 30.0);
    }

    /// The published model, from the equations and from finite differences of where the plant rests.
    #[test]
    fn the_linear_model_is_the_one_printed() {
        let tank = Nonlinear::TwoTank(TwoTank::default());
        let (_, u) = tank.rest(25.0, 0.0).expect("a rest");
        assert!((u - 50.0).abs() < 1e-12, "{u}");
        let model = tank.linear_model(25.0, 0.0).expect("a model");
        let lag = -1.0 / model.poles()[0].re;
        assert!((model.gain() - 1.98).abs() < 1e-12, "{model}");
        assert!((lag - 80.3).abs() < 1e-10 && model.dead_time() == 3.2, "{model}");
        for (plant, y0, d0) in [
            (tank, 25.0, 0.0),
            (tank, 3.0, 20.0),
            (tank, 47.0, -35.0),
            (
                Nonlinear::TwoTank(TwoTank {
                    load: TankLoad::Input,
                    pump_start: 2.0,
                    drop: 0.0,
                    ..TwoTank::default()
                }),
                10.0,
                -3.0,
            ),
        ] {
            let (model, h) = (plant.linear_model(y0, d0).expect("a model"), 1e-4);
            let u = |y: f64| plant.rest(y, d0).expect("a rest").1;
            let gain = 2.0 * h / (u(y0 + h) - u(y0 - h));
            assert!((model.gain() / gain - 1.0).abs() < 1e-7, "{model} {gain}");
            // At the rest's input the level falls back by 1/tau of a small change.
            let (_, own) = plant.rest(y0, d0).expect("a rest");
            let (u, load) = if plant.is_disturbed_at_input() { (own + d0, 0.0) } else { (own, d0) };
            let rate = |y: f64| plant.derivative(&[y, 0.0], u, load)[0];
            let lag = -2.0 * h / (rate(y0 + h) - rate(y0 - h));
            assert!((-1.0 / model.poles()[0].re / lag - 1.0).abs() < 1e-7, "{model} {lag}");
        }
    }

    #[test]
    fn where_nothing_holds_the_plant_it_does_not_rest() {
        let tank = Nonlinear::TwoTank(TwoTank::default());
        assert!(tank.rest(-0.1, 0.0).is_none() && tank.rest(50.1, 0.0).is_none());
        // Behind the open valve all of the pump, 198 cm^3/s, holds a head of its own.
        let range = tank.range(50.0).expect("levels");
        assert!((range[1] - ((198.0_f64 / 28.142_494_558_940_577).powi(2) - 24.5)).abs() < 1e-9, "{range:?}");
        assert!(tank.rest(range[1] + 0.01, 50.0).is_none() && tank.rest(range[1] - 0.01, 50.0).is_some());
        assert!(tank.linear_model(0.0, 0.0).is_none(), "an empty tank has no slope to both sides");
        assert!(tank.linear_model(25.0, -50.0).is_none(), "behind a closed valve it integrates");
    }
}
