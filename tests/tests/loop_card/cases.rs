//! The loops whose cards are looked at.

use controller_core::plant_model::PlantModel;
use controller_core::{AdrcConfig, ObserverConfig, PidConfig, Real};
use controller_sim_host::card::{LoopCard, Request, loop_card};
use controller_sim_host::scenario::{ControllerSpec, Scenario};
use controller_sim_host::simulate::{AnyLaw, Precision};
use controller_tests::cases::{self, SETPOINT_STEP, from_rest};
use controller_tests::oracle::de_cases::CASES;
use controller_tests::oracle::state_space::PlantFactors;

pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) plant: PlantFactors<'static>,
    pub(crate) spec: ControllerSpec,
    pub(crate) ts: f64,
    pub(crate) latency: f64,
}

impl Case {
    pub(crate) fn scenario(&self) -> Scenario {
        let specs = vec![self.spec.clone()];
        let scenario = from_rest(&self.plant, self.ts, 100.0 * self.ts, SETPOINT_STEP, specs);
        Scenario { latency: self.latency, ..scenario }
    }

    pub(crate) fn card(&self, precision: Precision) -> LoopCard {
        let request = Request { precision, ..Request::default() };
        loop_card(&self.scenario(), 0, request).unwrap_or_else(|why| panic!("{}: {why}", self.name))
    }

    pub(crate) fn law<T: Real>(&self) -> AnyLaw<T> {
        let capacity = self.spec.needed_capacity(self.ts, self.latency);
        let mut law = AnyLaw::new(&self.spec, self.ts, self.latency, capacity).expect("a valid law");
        law.settle(self.spec.mode, 0.0, 0.0, 0.0);
        law
    }
}

const LAG: PlantFactors<'static> = PlantFactors { gain: 1.98, lags: &[80.3], ..PlantFactors::UNITY };
const TWO_LAGS: PlantFactors<'static> = PlantFactors { lags: &[0.2, 1.0], ..PlantFactors::UNITY };
const DEAD_TIME: PlantFactors<'static> =
    PlantFactors { lags: &[1.0], dead_time: 0.537, ..PlantFactors::UNITY };
const INTEGRATING: PlantFactors<'static> =
    PlantFactors { gain: 0.05, integrators: 1, dead_time: 2.3, ..PlantFactors::UNITY };

/// PID, PID with an estimator, PI with an observer, ADRC, each on a plant of lags, an integrating one, and one of dead time.
pub(crate) fn loops() -> Vec<Case> {
    let pi = |kp: f64, ki: f64| ControllerSpec::pid("PI", PidConfig { kp, ki, ..PidConfig::default() });
    let observer = |spec: ControllerSpec, model: PlantModel, alpha: f64| {
        spec.with_observer(ObserverConfig { model, alpha, order: None })
    };
    let adrc = |b0: f64, control: f64, estimate: f64| {
        ControllerSpec::adrc("ADRC", AdrcConfig::from_bandwidths(b0, control, estimate))
    };
    let case = |name: &str, plant: PlantFactors<'static>, spec: ControllerSpec, ts: f64, latency: f64| Case {
        name: name.to_owned(),
        plant,
        spec,
        ts,
        latency,
    };
    let first = |gain: f64, tau: f64, dead_time: f64| PlantModel::first_order(gain, tau, dead_time);
    let delayed = |plant: PlantFactors<'static>, dead_time: f64| PlantFactors { dead_time, ..plant };
    let mut list = vec![
        case("PI, lag", LAG, pi(6.65, 0.28), 4.0, 0.0),
        case("PI, dead time, late", DEAD_TIME, pi(0.9, 0.8), 0.1, 0.04),
        case("PI, integrating", INTEGRATING, pi(3.0, 0.1), 0.5, 0.2),
        case("PI + DOB, lags", TWO_LAGS, observer(pi(0.8, 0.7), cases::model(&TWO_LAGS), 0.1), 0.02, 0.0),
        case(
            "PI + DOB, dead time, late",
            DEAD_TIME,
            observer(pi(0.6, 0.5), first(1.0, 1.0, 0.537), 0.4),
            0.05,
            0.02,
        ),
        case(
            "PI + DOB, wrong model",
            delayed(DEAD_TIME, 0.6),
            observer(pi(0.6, 0.5), first(0.9, 1.1, 0.5), 0.5),
            0.05,
            0.0,
        ),
        case(
            "P + DOB, integrating",
            INTEGRATING,
            observer(pi(3.0, 0.05), PlantModel::integrating(0.05, 2.3), 3.0),
            0.5,
            0.2,
        ),
        case("ADRC, lags", delayed(TWO_LAGS, 0.2), adrc(5.0, 2.0, 10.0), 0.02, 0.0),
        case(
            "ADRC, integrating",
            PlantFactors { integrators: 1, lags: &[0.5], dead_time: 0.1, ..PlantFactors::UNITY },
            adrc(2.0, 1.0, 6.0),
            0.02,
            0.013,
        ),
        case(
            "ADRC, dead time",
            PlantFactors { lags: &[1.0, 1.0], dead_time: 0.5, ..PlantFactors::UNITY },
            adrc(1.0, 0.5, 2.0),
            0.1,
            0.0,
        ),
    ];
    for one in &CASES {
        let spec = ControllerSpec::pid(one.name, cases::pid(&one.momi));
        // Slower than the chapter's, and by a fraction of the dead time.
        list.push(case(&format!("{} MOMI", one.name), one.plant, spec.clone(), 0.03, 0.01));
        let spec = spec.with_estimator(cases::estimator(&one.estimator));
        list.push(case(&format!("{} DE-MOMI", one.name), one.plant, spec, 0.03, 0.01));
    }
    list
}
