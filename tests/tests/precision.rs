//! Single precision for months: nothing stalls, nothing drifts.
//!
//! With `SOAK` set in the environment the long runs are ten times longer.

use controller_core::{
    Accumulator, Controller, ControllerConfig, ControllerInput, EstimatorConfig, Lag, LimitConfig, Pid,
    PidConfig, PidInput, PidState,
};
use controller_tests::rig::law;

fn factor() -> usize {
    if std::env::var_os("SOAK").is_some() { 10 } else { 1 }
}

/// 1 kHz PI, gain 1, integral time 1800 s, set-point 50, plant a lag of 300 s, load -2 for 6 hours. A plain
/// single-precision sum stays 1.0 away from the set-point for ever.
#[test]
fn the_slow_integrator_does_not_stall() {
    let config = ControllerConfig {
        pid: PidConfig { kp: 1.0, ki: 1.0 / 1800.0, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 100.0),
        ..ControllerConfig::default()
    };
    let ts = 0.001;
    let law = Controller::<f32>::new(&config, ts).expect("valid");
    let mut state = law.zeroed();
    law.settle(&mut state, 50.0, 50.0, 50.0);
    // The plant in double precision; its exact hold equivalent.
    let (mut y, step) = (50.0_f64, -(-ts / 300.0_f64).exp_m1());
    // A second controller, written here, that sums plainly: the case is one where that fails.
    let (mut plain, mut y_plain) = (50.0_f32, 50.0_f64);
    for _ in 0..6 * 3600 * 1000 {
        let u =
            law.step(&mut state, &ControllerInput { r: 50.0, y: y as f32, ..ControllerInput::default() }).u;
        y += step * (f64::from(u) - 2.0 - y);
        let e = 50.0 - y_plain as f32;
        plain += e * (1.0 / 1800.0) * 0.001;
        y_plain += step * (f64::from(plain + e) - 2.0 - y_plain);
    }
    println!("offset after 6 h: compensated {:.5}, plain {:.5}", (y - 50.0).abs(), (y_plain - 50.0).abs());
    assert!((y - 50.0).abs() <= 0.005, "{y}");
    assert!((y_plain - 50.0).abs() > 0.5, "the case must be one in which a plain sum stalls: {y_plain}");
}

/// A lag with `g = 1e-5` in single precision follows a step and then a ramp to 1e-5 of range; the exact response is
/// `X*(1-(1-g)^k)`, and behind a ramp of slope `s` per sample `x - s/g + (w0 - x0 + s/g)*(1-g)^k`.
#[test]
fn a_slow_lag_is_accurate() {
    let (single_g, range, level, slope) = (1e-5_f32, 100.0, 50.0_f64, 3e-5_f32);
    let g = f64::from(single_g);
    let decay = |k: f64| (k * (-g).ln_1p()).exp();
    let mut single = Lag::settled(0.0_f32);
    let (mut worst, mut plain, mut exact) = (0.0_f64, 0.0_f32, 0.0);
    for k in 0..1_500_000_u32 {
        single.advance(single_g, 50.0);
        plain += single_g * (50.0 - plain);
        exact = level * (1.0 - decay(f64::from(k + 1)));
        worst = worst.max((f64::from(single.value()) - exact).abs());
    }
    let start = exact;
    for k in 0..1_500_000_u32 {
        // The input as single precision holds it; the slope it really has differs by at most a rounding of the level.
        let x = 50.0 + k as f32 * slope;
        single.advance(single_g, x);
        plain += single_g * (x - plain);
        let (s, n) = (f64::from(slope), f64::from(k + 1));
        exact = level + s * n - s / g + (start - level + s / g) * decay(n);
        worst = worst.max((f64::from(single.value()) - exact).abs());
    }
    println!("worst error {worst:.2e} of range {range}, plain {:.2e}", (f64::from(plain) - exact).abs());
    assert!(worst <= 1e-5 * range, "{worst}");
}

/// 1e7 steps at rest with one-LSB noise: the output does not drift beyond what the noise itself does in double precision.
#[test]
fn rest_with_noise_does_not_drift() {
    let config = ControllerConfig {
        pid: PidConfig { kp: 2.0, ki: 0.02, kd: 1.0, tf: 0.5, ..PidConfig::default() },
        limits: LimitConfig::range(0.0, 100.0),
        ..ControllerConfig::default()
    };
    let model = EstimatorConfig { gain: 1.5, a1: 30.0, a2: 60.0, dead_time: 2.0, kfd: 0.7, tfd: 4.0 };
    let compensator = model.to_compensator(0.0);
    let ts = 0.1;
    let single = law::<f32>(&config, &compensator, ts).expect("valid");
    let double = law::<f64>(&config, &compensator, ts).expect("valid");
    let mut s =
        controller_core::ControllerState::over(single.compensator().state(vec![0.0; 64]).expect("fits"));
    let mut d =
        controller_core::ControllerState::over(double.compensator().state(vec![0.0; 64]).expect("fits"));
    single.settle(&mut s, 60.0, 60.0, 40.0);
    double.settle(&mut d, 60.0, 60.0, 40.0);
    // One LSB of a 16-bit sensor of range 128: exactly representable, mean exactly 0 over every pair of samples.
    let lsb = 128.0 / 65536.0;
    let mut seed = 12345_u32;
    let (mut up, mut worst) = (0.0_f64, 0.0_f64);
    let steps = 10_000_000 * factor();
    for k in 0..steps {
        if k % 2 == 0 {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            up = if seed >> 31 == 0 { lsb } else { -lsb };
        } else {
            up = -up;
        }
        let y = 60.0 + up;
        let a =
            single.step(&mut s, &ControllerInput { r: 60.0, y: y as f32, ..ControllerInput::default() }).u;
        let b = double.step(&mut d, &ControllerInput { r: 60.0, y, ..ControllerInput::default() }).u;
        worst = worst.max((f64::from(a) - b).abs());
    }
    // The noise's own effect on the output in one sample: the high-frequency gain times one LSB.
    let noise = lsb * (f64::from(single.pid().high_frequency_gain()) + 0.7 / 1.5 * 60.0 / 16.0);
    println!(
        "largest difference to double precision over {steps} steps: {worst:.2e}; one LSB moves the output by {noise:.2e}"
    );
    assert!(worst <= noise, "{worst} beyond {noise}");
}

/// `resolution()` is the smallest error that still moves the integral: measured by bisection, it is an upper bound and
/// within a factor of eight.
#[test]
fn resolution_is_what_is_measured() {
    for (ki, ts, level) in [(1.0 / 1800.0, 0.001, 50.0_f32), (0.02, 0.1, 80.0), (5.0, 0.01, 3.0)] {
        let pid = Pid::<f32>::new(&PidConfig { kp: 1.0, ki, ..PidConfig::default() }, ts).expect("valid");
        // Moves: a long constant error changes the integral at all, whatever the carry was.
        let moves = |e: f64| {
            // The worst carry: just below half a unit of the level.
            let mut state = PidState::default();
            pid.settle(&mut state, PidInput { r: 0.0, y: 0.0 }, level);
            let half = 0.5 * f64::from(f32::EPSILON) * f64::from(level);
            state.shift_integral((0.49 * half) as f32);
            let before = state.integral();
            // r - y is e exactly when y is 0; the increment is what the law makes of it.
            let increment = pid.increment(&state, PidInput { r: e as f32, y: 0.0 });
            let mut sum = Accumulator::new(before);
            sum.add((0.49 * half) as f32);
            let start = (f64::from(sum.value()), f64::from(sum.carry()));
            sum.add(increment);
            (f64::from(sum.value()), f64::from(sum.carry())) != start
        };
        let (mut lo, mut hi) = (1e-20_f64, 1.0_f64);
        assert!(moves(hi) && !moves(lo));
        for _ in 0..80 {
            let middle = (lo * hi).sqrt();
            if moves(middle) { hi = middle } else { lo = middle }
        }
        let stated = pid.resolution(level);
        let plain = f64::from(f32::EPSILON) * f64::from(level) / (2.0 * ki * ts);
        println!("ki {ki:.2e} ts {ts}: stated {stated:.2e}, measured {hi:.2e}, a plain sum {plain:.2e}");
        assert!(hi <= stated && stated <= 8.0 * hi, "stated {stated:e}, measured {hi:e}");
    }
}
