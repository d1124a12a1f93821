//! The loop as it is deployed, and the point at which it works.

use crate::design_file::is_open;
use crate::scenario::{Change, ControllerSpec, Scenario, Signal};
use crate::simulate::{AnyLaw, ClosedLoop};
use controller_core::{Mode, Real};
use controller_design::margins::{DiscreteLaw, DiscreteLoop};

/// A loop with its law in `T`.
pub(super) struct Deployed<'a, T: Real> {
    pub(super) scenario: &'a Scenario,
    /// Closed, with its own set-point.
    pub(super) spec: ControllerSpec,
    pub(super) law: AnyLaw<T>,
    pub(super) sampled: DiscreteLoop,
    pub(super) point: Point,
}

/// Where a loop works and how far it is moved there, after its file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    /// Set-point and measurement at rest \[y\].
    pub(super) y0: f64,
    /// Load at rest \[u\].
    pub(super) d0: f64,
    /// Output at rest \[u\].
    pub(super) u0: f64,
    /// Step of the set-point \[y\].
    pub(super) setpoint: f64,
    /// Step of the load \[u\].
    pub(super) load: f64,
}

impl<'a, T: Real> Deployed<'a, T> {
    pub(super) fn new(scenario: &'a Scenario, spec: &ControllerSpec) -> Result<Self, String> {
        let spec = ControllerSpec { mode: Mode::Auto, ..spec.clone() };
        let (ts, latency) = (scenario.ts, scenario.latency);
        let law = AnyLaw::<T>::new(&spec, ts, latency, spec.needed_capacity(ts, latency));
        let law = law.map_err(|faults| faults.to_string())?;
        let discrete = match (law.adrc(), law.pid()) {
            (Some(adrc), _) => DiscreteLaw::of_adrc(&adrc, ts),
            (None, Some(pid)) => {
                let compensator = law.compensator().map(|compensator| compensator.coefficients());
                DiscreteLaw::of_pid(&pid, compensator.as_ref(), ts)
            }
            (None, None) => return Err("the law has no coefficients".to_owned()),
        };
        let sampled = DiscreteLoop::new(&scenario.plant, discrete, latency).map_err(|why| why.to_string())?;
        let point = Point::of(scenario, &spec, &sampled);
        Ok(Self { scenario, spec, law, sampled, point })
    }

    /// The range that the output can really take \[u\], the controller's and the actuator's; whether the file says one.
    pub(super) fn range(&self) -> ((f64, f64), bool) {
        let (limits, actuator) = (&self.spec.config.limits, &self.scenario.actuator);
        let range = (limits.lo.max(actuator.lo), limits.hi.min(actuator.hi));
        let said = !is_open(limits) || actuator.lo.is_finite() || actuator.hi.is_finite();
        (range, said && range.0 < range.1)
    }

    /// The static gain of the plant [y/u]; none if it integrates or differentiates.
    pub(super) fn static_gain(&self) -> Option<f64> {
        static_gain(self.scenario)
    }
}

fn static_gain(scenario: &Scenario) -> Option<f64> {
    let plant = &scenario.plant;
    (plant.integrators() == 0 && plant.differentiators() == 0).then(|| plant.gain())
}

impl Point {
    fn of(scenario: &Scenario, spec: &ControllerSpec, sampled: &DiscreteLoop) -> Self {
        let (y0, d0) = (scenario.initial.setpoint, scenario.initial.disturbance);
        let steps = || scenario.events.iter().flat_map(|event| &event.changes);
        let moved = |from: f64, change: &Change, of_setpoint: bool| match (change, of_setpoint) {
            (Change::Setpoint(Signal::Step(to)) | Change::RemoteSetpoint(Signal::Step(to)), true)
            | (Change::Disturbance(Signal::Step(to)), false) => Some(to - from).filter(|by| *by != 0.0),
            _ => None,
        };
        let (limits, range) = (&spec.config.limits, &spec.config.setpoint);
        let gain = static_gain(scenario);
        let setpoint = steps().find_map(|change| moved(y0, change, true)).unwrap_or_else(|| {
            // A tenth of what the output's range makes, where there is one.
            let tenth = gain.map_or(f64::INFINITY, |gain| 0.1 * (gain * (limits.hi - limits.lo)).abs());
            if is_open(limits) || !tenth.is_finite() { 1.0 } else { tenth }
        });
        let setpoint = if (range.lo..=range.hi).contains(&(y0 + setpoint)) { setpoint } else { -setpoint };
        let load = steps().find_map(|change| moved(d0, change, false)).unwrap_or_else(|| {
            let by_gain = gain.map_or_else(|| sampled.law().step_gain() * setpoint, |gain| setpoint / gain);
            if is_open(limits) { by_gain.abs() } else { 0.1 * (limits.hi - limits.lo) }
        });
        Self { y0, d0, u0: rest(scenario, (y0, d0)), setpoint, load }
    }
}

/// The output that holds the plant at the measurement `y` under the load `d` \[u\]; 0 when none does.
pub(super) fn rest(scenario: &Scenario, at: (f64, f64)) -> f64 {
    ClosedLoop::new(&scenario.plant, scenario.ts, scenario.latency, 1, at, &[]).map_or(0.0, |(_, u0)| u0)
}
