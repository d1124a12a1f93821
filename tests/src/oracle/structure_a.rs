//! The 2-DOF PID loop with disturbance estimator in its textbook arrangement ("structure A").
//!
//! Signal flow of Vrancic and Huba (2021), figure 3, eqs (4), (13), with a limited output:
//!
//! - `u = limit(u_C - d_f)`
//! - `u_C = G_CR r - G_CY y`, parallel form: `KI/s` on `r - y` and `((w KP - KI TF) + w' KD s)/(1 + s TF)`,
//!   `w, w' = b, c` for r and 1, 1 for y; both parts by Tustin's rule
//! - `d_f = G_MI G_FD (y - y_M)`, one filter `KFD (1 + a1 s + a2 s^2)/(K (1 + s TFD)^3)` by Tustin's rule
//! - `y_M`: exact hold equivalent of `G_M = K e^{-s Tdel}/(1 + a1 s + a2 s^2)` driven by the limited `u`
//!
//! A perfect model makes `y - y_M` vanish while the set-point moves, so `d_f` is zero to rounding.

use super::sampled_loop::{LoopResponse, UnitStep, run_unit_step};
use super::sampled_plant::SampledPlant;
use super::state_space::PlantFactors;

/// Parallel PID gains of eq (4), filter and set-point weights included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidGains {
    /// Proportional gain \[u/y\].
    pub kp: f64,
    /// Integral gain \[u/(y s)\].
    pub ki: f64,
    /// Derivative gain \[u s/y\].
    pub kd: f64,
    /// Filter time constant \[s\], above zero.
    pub tf: f64,
    /// Set-point weight of the proportional part.
    pub b: f64,
    /// Set-point weight of the derivative part.
    pub c: f64,
}

/// Second-order model with dead time and the filter of the disturbance estimator, eq (13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimator {
    /// Model gain `K_PRM` \[y/u\].
    pub gain: f64,
    /// Model coefficient \[s\].
    pub a1: f64,
    /// Model coefficient \[s^2\]; 0 for a first-order model.
    pub a2: f64,
    /// Model dead time \[s\].
    pub dead_time: f64,
    /// Filter gain `K_FD`.
    pub kfd: f64,
    /// Filter time constant `T_FD` \[s\].
    pub tfd: f64,
}

/// Unit-gain lag `1/(1 + s T)` by Tustin's rule, `s = (2/ts) (1 - z^-1)/(1 + z^-1)`, from rest.
#[derive(Clone, Debug)]
struct TustinLag {
    /// `1/(1 + 2 T/ts)`
    gain: f64,
    input: f64,
    output: f64,
}

impl TustinLag {
    fn new(time: f64, ts: f64) -> Self {
        Self { gain: ts / (ts + 2.0 * time), input: 0.0, output: 0.0 }
    }

    fn step(&mut self, input: f64) -> f64 {
        self.output += self.gain * (input + self.input - 2.0 * self.output);
        self.input = input;
        self.output
    }
}

/// Estimator in operation: the model and the third-order filter as three equal lags.
#[derive(Clone, Debug)]
struct EstimatorState {
    parameters: Estimator,
    model: SampledPlant,
    lags: [TustinLag; 3],
}

impl EstimatorState {
    fn new(parameters: Estimator, ts: f64) -> Self {
        let Estimator { gain, a1, a2, dead_time, tfd, .. } = parameters;
        let base = PlantFactors { gain, dead_time, ..PlantFactors::UNITY };
        let model = if a2 == 0.0 {
            PlantFactors { lags: &[a1], ..base }.sampled(ts)
        } else {
            PlantFactors { pairs: &[(a1, a2)], ..base }.sampled(ts)
        };
        Self { parameters, model, lags: [(); 3].map(|()| TustinLag::new(tfd, ts)) }
    }

    /// `d_f[k]`, before `u[k]` is known. With `L = 1/(1 + s T)`: `s L = (1 - L)/T`.
    fn estimate(&mut self, y: f64) -> f64 {
        let Estimator { gain, a1, a2, kfd, tfd, .. } = self.parameters;
        let x1 = self.lags[0].step(y - self.model.output());
        let x2 = self.lags[1].step(x1);
        let x3 = self.lags[2].step(x2);
        kfd / gain * (x3 + a1 * (x2 - x3) / tfd + a2 * ((x1 - x2) - (x2 - x3)) / (tfd * tfd))
    }
}

/// Signals of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Output of the PID part.
    pub u_c: f64,
    /// Disturbance estimate, subtracted from `u_c`.
    pub d_f: f64,
    /// Controller output before the limits, `u_c - d_f`.
    pub v: f64,
    /// Limited controller output.
    pub u: f64,
}

/// The controller, at rest at zero when built.
#[derive(Clone, Debug)]
pub struct StructureA {
    gains: PidGains,
    ts: f64,
    limits: (f64, f64),
    estimator: Option<EstimatorState>,
    integral: f64,
    last_error: f64,
    setpoint_lag: TustinLag,
    output_lag: TustinLag,
}

impl StructureA {
    /// PID with or without estimator at the sampling time `ts` \[s\], its output within `limits` (low, high).
    pub fn new(gains: PidGains, estimator: Option<Estimator>, limits: (f64, f64), ts: f64) -> Self {
        assert!(gains.tf > 0.0 && ts > 0.0 && limits.0 <= limits.1);
        let lag = TustinLag::new(gains.tf, ts);
        Self {
            gains,
            ts,
            limits,
            estimator: estimator.map(|parameters| EstimatorState::new(parameters, ts)),
            integral: 0.0,
            last_error: 0.0,
            setpoint_lag: lag.clone(),
            output_lag: lag,
        }
    }

    /// Sampling time \[s\].
    pub fn ts(&self) -> f64 {
        self.ts
    }

    /// One sample: from `r[k]`, `y[k]` to the output held over `[k ts, (k+1) ts)`.
    ///
    /// Back-calculation anti-windup with the time constant `KP/KI`: after the output is limited,
    /// `I += ts KI/KP (u - v)`.
    pub fn step(&mut self, r: f64, y: f64) -> Sample {
        let PidGains { kp, ki, kd, tf, b, c } = self.gains;
        let d_f = self.estimator.as_mut().map_or(0.0, |estimator| estimator.estimate(y));

        let error = r - y;
        self.integral += 0.5 * self.ts * ki * (error + self.last_error);
        self.last_error = error;
        let slow_r = self.setpoint_lag.step(r);
        let slow_y = self.output_lag.step(y);
        let static_part = (b * kp - ki * tf) * slow_r - (kp - ki * tf) * slow_y;
        let derivative = kd / tf * (c * (r - slow_r) - (y - slow_y));
        let u_c = self.integral + static_part + derivative;

        let v = u_c - d_f;
        let u = v.max(self.limits.0).min(self.limits.1);
        if u != v {
            self.integral += self.ts * ki / kp * (u - v);
        }
        if let Some(estimator) = &mut self.estimator {
            estimator.model.step(u, 0.0);
        }
        Sample { u_c, d_f, v, u }
    }
}

/// Response of the loop with the trace of the estimate.
#[derive(Clone, Debug)]
pub struct EstimatorResponse {
    /// Record and measures of the loop.
    pub measures: LoopResponse,
    /// Disturbance estimate at the samples.
    pub d_f: Vec<f64>,
}

/// Runs the loop from rest over `horizon` \[s\]; see [`run_unit_step`] for the plant's grid.
pub fn respond(
    mut controller: StructureA,
    plant: SampledPlant,
    step: UnitStep,
    horizon: f64,
) -> EstimatorResponse {
    let mut d_f = vec![];
    let measures = run_unit_step(controller.ts(), plant, step, horizon, |r, y| {
        let sample = controller.step(r, y);
        d_f.push(sample.d_f);
        sample.u
    });
    EstimatorResponse { measures, d_f }
}

#[cfg(test)]
mod tests {
    use super::super::de_cases::{CASES, DeCase};
    use super::*;

    const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    fn respond_to(
        case: &DeCase,
        gains: PidGains,
        estimator: Option<Estimator>,
        limits: (f64, f64),
        step: UnitStep,
        horizon: f64,
    ) -> EstimatorResponse {
        let controller = StructureA::new(gains, estimator, limits, case.ts);
        respond(controller, case.plant.sampled(case.ts / 20.0), step, horizon)
    }

    #[test]
    fn reference_loop_values_come_out() {
        for case in &CASES {
            let designs = [
                (case.momi, Some(case.estimator), Some(case.iae_de_momi)),
                (case.momi, None, Some(case.iae_momi)),
                (case.drmo, None, case.iae_drmo),
            ];
            for (gains, estimator, reference) in designs {
                let Some(reference) = reference else { continue };
                let expected = [
                    (UnitStep::Reference, reference.tracking),
                    (UnitStep::InputDisturbance, reference.rejection),
                ];
                for (step, expected) in expected {
                    let iae = respond_to(case, gains, estimator, FREE, step, case.horizon).measures.iae;
                    // 2e-6: the trapezoids on a twentieth of the sampling time, here and in the reference.
                    let allowed = case.iae_half_unit + 2e-6 * expected;
                    assert!((iae - expected).abs() <= allowed, "{} {step:?}: {iae}, {expected}", case.name);
                }
            }
        }
    }

    #[test]
    fn a_perfect_model_leaves_tracking_untouched() {
        for case in [&CASES[0], &CASES[2]] {
            let run =
                |estimator| respond_to(case, case.momi, estimator, FREE, UnitStep::Reference, case.horizon);
            let (with, without) = (run(Some(case.estimator)), run(None));
            assert!(with.d_f.iter().all(|d_f| d_f.abs() < 1e-12));
            assert!(with.measures.y.iter().zip(&without.measures.y).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }

    /// The integral of the error follows from the balance of the integrator: `(1/K + (1-b) KP)/KI` in
    /// tracking, `-(1-KFD)/KI` for a disturbance (KFD = 0 without estimator).
    #[test]
    fn integral_of_the_error_is_what_the_integrator_must_hold() {
        for case in &CASES {
            for (gains, estimator) in
                [(case.momi, Some(case.estimator)), (case.momi, None), (case.drmo, None)]
            {
                let tracking = (1.0 / case.plant.gain + (1.0 - gains.b) * gains.kp) / gains.ki;
                let rejection = -(1.0 - estimator.map_or(0.0, |e| e.kfd)) / gains.ki;
                for (step, exact) in
                    [(UnitStep::Reference, tracking), (UnitStep::InputDisturbance, rejection)]
                {
                    let ie = respond_to(case, gains, estimator, FREE, step, 6.0 * case.horizon).measures.ie;
                    assert!((ie / exact - 1.0).abs() < 1e-10, "{} {step:?}: {ie} {exact}", case.name);
                }
            }
        }
    }

    /// Reference step against a limited output: IAE to three decimals, overshoot about 2 %.
    #[test]
    fn back_calculation_under_limits() {
        for (case, limit, iae) in [(&CASES[2], 1.5, 0.877), (&CASES[4], 2.0, 0.568)] {
            let estimator = Some(case.estimator);
            let response =
                respond_to(case, case.momi, estimator, (-limit, limit), UnitStep::Reference, case.horizon);
            assert!((response.measures.iae - iae).abs() < 5e-4, "{}: {}", case.name, response.measures.iae);
            assert!(response.measures.u.iter().all(|u| u.abs() <= limit));
            assert!(response.measures.y.iter().all(|&y| y < 1.03));
        }
    }
}
