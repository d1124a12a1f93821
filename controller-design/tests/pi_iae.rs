//! The IAE-optimal PI against the recomputed table of Airikka 2021 and an independent optimiser.

use controller_core::PidConfig;
use controller_design::model::{TransferFunction, parse};
use controller_design::response::{ContinuousResponse, Load};
use controller_design::rules::PiIae;

fn near(what: &str, ours: f64, exact: f64, tolerance: f64) {
    assert!((ours - exact).abs() <= tolerance * exact.abs(), "{what}: {ours} is not {exact}");
}

/// r = dead_time/tau; kp*k, ti/tau, IAE/(k*theta), Ms, P1/P2, P3/P2, t2/t1, t3/t1.
const TABLE: [[f64; 9]; 8] = [
    [
        0.05,
        18.2578551,
        0.188750824,
        0.224438502,
        3.56661984,
        -12.6455848,
        -2.37217144,
        2.06358806,
        2.88887947,
    ],
    [0.1, 9.15191429, 0.349293355, 0.413809575, 3.42816758, -12.7443523, -2.31322167, 2.06387739, 2.88660354],
    [0.2, 4.60573384, 0.605970053, 0.711662032, 3.198716, -12.9546857, -2.20974888, 2.06583428, 2.8843217],
    [0.41, 2.28985743, 0.965338985, 1.10768594, 2.85886053, -13.4273005, -2.03619493, 2.07265933, 2.88464541],
    [0.84, 1.18290376, 1.35608209, 1.46008077, 2.47945533, -14.4622431, -1.79888447, 2.08395261, 2.88534509],
    [1.0, 1.01937144, 1.45095657, 1.51959292, 2.39508063, -14.8509307, -1.73667417, 2.08508685, 2.88240921],
    [1.7, 0.681470999, 1.76804459, 1.61808049, 2.18530026, -16.3558616, -1.55201429, 2.06795319, 2.84538887],
    [3.0, 0.497263255, 2.28021272, 1.60888203, 2.05065316, -18.1365418, -1.38944318, 1.99321582, 2.72123889],
];

#[test]
fn first_order_with_dead_time() {
    // Scales of time and gain besides r: none may matter.
    for (theta, gain) in [(1.0, 1.0), (1e-6, 1.0), (1e6, -3.0), (7.0, 1e9), (0.2, -1e-12)] {
        for [r, kp, ti, iae, ms, ..] in TABLE {
            let tau = theta / r;
            let d = PiIae::fopdt(gain, tau, theta).unwrap_or_else(|e| panic!("r = {r}: {e}"));
            near("kp", d.pid.kp * gain, kp, 2e-3);
            near("ti", d.pid.kp / d.pid.ki / tau, ti, 2e-3);
            // The optimum may not lie more than rounding of the table below it.
            near("iae", d.iae / (gain.abs() * theta), iae, 3e-6);
            near("ms", d.ms, ms, 3e-3);
            assert_eq!((d.pid.b, d.warnings.len()), (1.0, 1));
        }
    }
}

#[test]
fn integrating_with_dead_time() {
    for (gain, theta) in [(1.0, 1.0), (-4e-5, 300.0), (2e6, 1e-4)] {
        let d = PiIae::ipdt(gain, theta).expect("a design");
        near("kp", d.pid.kp * gain * theta, 0.910983679, 2e-3);
        near("ti", d.pid.kp / d.pid.ki / theta, 4.09940896, 2e-3);
        near("iae", d.iae / (gain.abs() * theta * theta), 4.8907811, 3e-6);
        near("ms", d.ms, 3.72448756, 3e-3);
    }
}

#[test]
fn the_responses_have_the_features_of_the_table() {
    for [r, kp, ti, iae, _, p12, p32, t2, t3] in TABLE {
        let g = TransferFunction::first_order(1.0, 1.0 / r, 1.0).expect("a plant");
        let pid = PidConfig { kp, ki: kp * r / ti, ..PidConfig::default() };
        let response = ContinuousResponse::new(&g, &pid, None).expect("a loop");
        near("iae", response.indices(Load::Step).expect("stable").iae, iae, 1e-7);
        let peaks = response.peaks(Load::Step, 3).expect("stable");
        near("P1/P2", peaks[0].e / peaks[1].e, p12, 1e-5);
        near("P3/P2", peaks[2].e / peaks[1].e, p32, 1e-5);
        near("t2/t1", peaks[1].t / peaks[0].t, t2, 1e-5);
        near("t3/t1", peaks[2].t / peaks[0].t, t3, 1e-5);
    }
}

#[test]
fn other_plants_against_an_independent_optimiser() {
    let mut rows = 0;
    for line in include_str!("golden/pi_iae.csv").lines().skip(1) {
        let columns: Vec<&str> = line.split(';').collect();
        let number = |i: usize| columns[i].parse::<f64>().expect("a number");
        let d = PiIae::new(&parse(columns[0]).expect("a plant")).unwrap_or_else(|e| panic!("{line}: {e}"));
        near(line, d.iae, number(3), 2e-5);
        near(line, d.pid.kp, number(1), 5e-3);
        near(line, d.pid.kp / d.pid.ki, number(2), 5e-3);
        rows += 1;
    }
    assert_eq!(rows, 5);
}

#[test]
fn no_small_change_of_any_gain_is_better() {
    for text in [
        "exp(-0.3*s)/((1+s)*(1+0.5*s))",
        "-8*exp(-0.02*s)/((1+s)*(1+0.2*s)*(1+0.05*s))",
        "(1-2*s)/(1+s)^3",
        "(1+5*s)*exp(-0.5*s)/((1+s)^2*(1+2*s))",
        "exp(-0.4*s)/(1+0.5*s+s^2)",
        "0.1*exp(-2*s)/(s*(1+s)^2)",
        "1/(1+s)^3",
        "exp(-s)/(1+0.01*s)",
        "exp(-0.2*s)/(s-1)",
        "1/((1+s)*(1+0.01*s)*(1+0.0001*s))",
        "exp(-1e-4*s)/(1+s)",
        "exp(-3*s)/(1+s)^8",
        "(1-10*s)/(1+s)^2",
    ] {
        let g = parse(text).expect("a plant");
        let d = PiIae::new(&g).unwrap_or_else(|e| panic!("{text}: {e}"));
        for (kp, ki) in
            [(1.0, 1.02), (1.0, 0.98), (1.02, 1.0), (0.98, 1.0), (1.1, 1.2), (0.9, 0.8), (0.8, 1.1)]
        {
            let pid = PidConfig { kp: d.pid.kp * kp, ki: d.pid.ki * ki, ..d.pid };
            let other = ContinuousResponse::new(&g, &pid, None).and_then(|r| r.indices(Load::Step));
            assert!(other.is_err() || other.is_ok_and(|i| i.iae > d.iae), "{text}: {kp} {ki}");
        }
    }
}

#[test]
fn plants_without_an_optimum_are_refused() {
    let text = |t: &str| PiIae::new(&parse(t).expect("a plant")).expect_err(t).to_string();
    for plant in
        ["1/(1+s)", "2/s", "1/((1+s)*(1+0.1*s))", "-1/(1+0.2*s+s^2)", "(1+0.5*s)/((1+s)^2*(1+0.2*s))"]
    {
        assert!(text(plant).contains("as small as one likes"), "{plant}: {}", text(plant));
    }
    assert!(text("2*exp(-s)").contains("more poles"));
    assert!(text("s*exp(-s)/(1+s)^2").contains("s = 0"));
    assert!(text("exp(-s)/s^2").contains("one integrator"));
    for (gain, tau, theta) in [(0.0, 1.0, 1.0), (1.0, f64::NAN, 1.0), (1.0, 1.0, -1.0), (1.0, 1.0, 0.0)] {
        assert!(PiIae::fopdt(gain, tau, theta).is_err());
    }
    for (gain, tau, theta) in
        [(1e300, 1e-300, 1e300), (1.0, 1e-200, 1.0), (1.0, 1e200, 1.0), (1e-320, 1.0, 1.0)]
    {
        if let Ok(d) = PiIae::fopdt(gain, tau, theta) {
            assert!(d.iae.is_finite() && d.pid.kp.is_finite() && d.pid.ki.is_finite() && d.ms.is_finite());
        }
    }
}
