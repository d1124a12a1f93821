//! The six processes of Vrancic and Huba (2021) with unrounded parameters and reference loop values.
//!
//! Parameters: eqs (5) to (7), (9), (14), (18), (19) solved with 40 digits, with `K_D` (not `2 K_D`) in beta
//! of eq (10). `T_F` and `T_FD` of GP3 to GP6 are the converged fixed points of eqs (28) and (30) for the
//! noise gains 4, 4, 20, 4; those of GP1, GP2 are given (0.1 s). The chapter prints the same numbers with two
//! to four digits, but for GP5, whose printed `T_F` = 0.055 and gains are an iterate that has not converged.

use super::state_space::PlantFactors;
use super::structure_a::{Estimator, PidGains};

/// IAE of the unit reference step and of the unit input disturbance step \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IaePair {
    /// Reference step.
    pub tracking: f64,
    /// Input disturbance step.
    pub rejection: f64,
}

/// One process with its designs and reference values.
#[derive(Clone, Copy, Debug)]
pub struct DeCase {
    /// Name in the chapter.
    pub name: &'static str,
    /// The process.
    pub plant: PlantFactors<'static>,
    /// Sampling time \[s\].
    pub ts: f64,
    /// Length of each of the two experiments \[s\].
    pub horizon: f64,
    /// MOMI gains, eq (6), `b = c = 1`.
    pub momi: PidGains,
    /// DRMO gains, eqs (9), (10), `b = c = 0`.
    pub drmo: PidGains,
    /// Model and filter, eqs (14), (18), (31).
    pub estimator: Estimator,
    /// IAE of MOMI with the estimator, sampled loop, Tustin, exact hold equivalents.
    pub iae_de_momi: IaePair,
    /// IAE of MOMI alone.
    pub iae_momi: IaePair,
    /// IAE of DRMO, where a reference value exists.
    pub iae_drmo: Option<IaePair>,
    /// Half a unit of the last digit of the IAE values above; 0 when all digits are given.
    pub iae_half_unit: f64,
}

const fn momi(kp: f64, ki: f64, kd: f64, tf: f64) -> PidGains {
    PidGains { kp, ki, kd, tf, b: 1.0, c: 1.0 }
}

const fn drmo(kp: f64, ki: f64, momi: PidGains) -> PidGains {
    PidGains { kp, ki, kd: momi.kd, tf: momi.tf, b: 0.0, c: 0.0 }
}

const fn iae(tracking: f64, rejection: f64) -> IaePair {
    IaePair { tracking, rejection }
}

const MOMI_1: PidGains = momi(1.8141882724617508, 0.89007241248528877, 0.93402279800748367, 0.1);
const MOMI_2: PidGains = momi(1.6111695597860784, 0.63974835145032678, 1.0753284548856528, 0.1);
const MOMI_3: PidGains =
    momi(2.3544908753048013, 1.8795643269866222, 0.47531486562504835, 0.11869815484379434);
const MOMI_4: PidGains =
    momi(0.84425041028043346, 0.25892062461108226, 0.76740281287075516, 0.19174713215525425);
const MOMI_5: PidGains =
    momi(6.3515868079178797, 5.2600172489401319, 1.0916443338687911, 0.054578771827875916);
const MOMI_6: PidGains =
    momi(0.53277055930660054, 0.12648387476246069, 0.66142674551214783, 0.16523498545695899);

/// The six processes. The IAE values come from an independent simulation of the same structure; those of GP1
/// to GP4 carry four decimals, those of GP5, GP6 all digits. Table 8 of the chapter prints those of GP5, GP6
/// rounded.
pub const CASES: [DeCase; 6] = [
    DeCase {
        name: "GP1",
        plant: PlantFactors { lags: &[1.0, 1.0], dead_time: 0.5, ..PlantFactors::UNITY },
        ts: 0.01,
        horizon: 15.0,
        momi: MOMI_1,
        drmo: drmo(2.2468756420154297, 1.4915299132559225, MOMI_1),
        estimator: Estimator {
            gain: 1.0,
            a1: 2.0,
            a2: 1.0,
            dead_time: 0.5,
            kfd: 0.57255105788246963,
            tfd: 0.1,
        },
        iae_de_momi: iae(1.2477, 0.5081),
        iae_momi: iae(1.2477, 1.1235),
        iae_drmo: None,
        iae_half_unit: 5e-5,
    },
    DeCase {
        name: "GP2",
        plant: PlantFactors { lags: &[1.0, 1.0, 1.0], dead_time: 0.2, ..PlantFactors::UNITY },
        ts: 0.01,
        horizon: 20.0,
        momi: MOMI_2,
        drmo: drmo(1.9348594494752593, 0.98431467225691165, MOMI_2),
        estimator: Estimator {
            gain: 1.0,
            a1: 2.5842254432165209,
            a2: 1.839110570683812,
            dead_time: 0.61577455678347908,
            kfd: 0.58918703970190293,
            tfd: 0.1,
        },
        iae_de_momi: iae(1.7988, 0.7022),
        iae_momi: iae(1.8115, 1.5632),
        iae_drmo: None,
        iae_half_unit: 5e-5,
    },
    DeCase {
        name: "GP3",
        plant: PlantFactors { lags: &[0.2, 1.0], dead_time: 0.2, ..PlantFactors::UNITY },
        ts: 0.01,
        horizon: 8.0,
        momi: MOMI_3,
        drmo: drmo(2.9086169687354908, 3.830789079976755, MOMI_3),
        estimator: Estimator {
            gain: 1.0,
            a1: 1.2,
            a2: 0.2,
            dead_time: 0.2,
            kfd: 0.68866997499473139,
            tfd: 0.059969426546307519,
        },
        iae_de_momi: iae(0.5986, 0.1806),
        iae_momi: iae(0.5986, 0.5317),
        iae_drmo: None,
        iae_half_unit: 5e-5,
    },
    DeCase {
        name: "GP4",
        plant: PlantFactors { lags: &[1.0; 4], dead_time: 1.0, ..PlantFactors::UNITY },
        ts: 0.01,
        horizon: 40.0,
        momi: MOMI_4,
        drmo: drmo(0.94052582742765005, 0.31595450036098482, MOMI_4),
        estimator: Estimator {
            gain: 1.0,
            a1: 3.0641777724759121,
            a2: 2.6945927106677214,
            dead_time: 1.9358222275240879,
            kfd: 0.36237010552021974,
            tfd: 0.11565556992162312,
        },
        iae_de_momi: iae(4.3633, 2.8670),
        iae_momi: iae(4.3742, 3.9626),
        iae_drmo: None,
        iae_half_unit: 5e-5,
    },
    DeCase {
        name: "GP5",
        plant: PlantFactors { lags: &[1.0, 0.2, 0.04, 0.008], ..PlantFactors::UNITY },
        ts: 0.001,
        horizon: 6.0,
        momi: MOMI_5,
        drmo: drmo(9.4853820826305747, 22.960107008648885, MOMI_5),
        estimator: Estimator {
            gain: 1.0,
            a1: 1.2048343830991575,
            a2: 0.20498094534896369,
            dead_time: 0.043165616900842518,
            kfd: 0.90851345919331857,
            tfd: 0.01808687484745324,
        },
        iae_de_momi: iae(0.21641184532587884, 0.01763847485554691),
        iae_momi: iae(0.21770008113085507, 0.1894342920552567),
        iae_drmo: Some(iae(0.5292388560161796, 0.056407451510569064)),
        iae_half_unit: 0.0,
    },
    DeCase {
        name: "GP6",
        plant: PlantFactors { lags: &[1.0, 1.0, 1.0], dead_time: 5.0, ..PlantFactors::UNITY },
        ts: 0.01,
        horizon: 50.0,
        momi: MOMI_6,
        drmo: drmo(0.57437275797067481, 0.14040696565631559, MOMI_6),
        estimator: Estimator {
            gain: 1.0,
            a1: 2.5842254432165209,
            a2: 1.839110570683812,
            dead_time: 5.4157745567834791,
            kfd: 0.16030524426361889,
            tfd: 0.077445967792010409,
        },
        iae_de_momi: iae(8.650118618095552, 7.801611440325949),
        iae_momi: iae(8.649160663436547, 8.422631652583132),
        iae_drmo: Some(iae(12.341909166941257, 8.794881560542667)),
        iae_half_unit: 0.0,
    },
];

#[cfg(test)]
mod tests {
    use super::super::complex;
    use super::*;

    /// Model and process share the areas A0 to A3, so their frequency responses agree up to the third order.
    #[test]
    fn models_match_their_processes_at_low_frequencies() {
        for case in CASES {
            let Estimator { gain, a1, a2, dead_time, .. } = case.estimator;
            let model = PlantFactors { gain, pairs: &[(a1, a2)], dead_time, ..PlantFactors::UNITY };
            let omega = 0.01 / (a1 + dead_time);
            let error = complex::abs(complex::sub(model.response(omega), case.plant.response(omega)));
            assert!(error < 1e-8, "{}: {error:e}", case.name);
        }
    }

    /// Eqs (28), (30): gain of the PID and of the estimator's filter at the quarter of the sampling
    /// frequency.
    #[test]
    fn filters_meet_their_noise_gains() {
        for (case, noise_gain) in CASES[2..].iter().zip([4.0, 4.0, 20.0, 4.0]) {
            let omega = 0.5 * std::f64::consts::PI / case.ts;
            let PidGains { kp, ki, kd, tf, .. } = case.momi;
            let pid = (ki - kd * omega * omega).hypot(kp * omega) / (omega * (tf * omega).hypot(1.0));
            let Estimator { gain, a1, a2, kfd, tfd, .. } = case.estimator;
            let filter =
                kfd / gain * (1.0 - a2 * omega * omega).hypot(a1 * omega) / (tfd * omega).hypot(1.0).powi(3);
            assert!((pid / noise_gain - 1.0).abs() < 1e-12, "{}: {pid}", case.name);
            assert!((filter / noise_gain - 1.0).abs() < 1e-12, "{}: {filter}", case.name);
        }
    }
}
