//! The ADRC in single precision.

use controller_core::{
    Adrc, AdrcConfig, AdrcInput, AdrcState, Controller, ControllerConfig, ControllerInput,
};

/// A level around 100 with a load that drifts; 1 kHz, feedback and observer of minutes: `omega_o*ts = 1e-4`. Eight hours.
/// A plain sum could not take one increment of `d`, of 1e-12 of its size. Single precision stays within 1e-5 of the level
/// of double precision, and the level comes to its set-point.
#[test]
fn a_slow_observer_does_not_stall() {
    let config = AdrcConfig::from_bandwidths(0.02, 0.02, 0.1);
    let ts = 0.001;
    let run = |single: bool| {
        let (law32, law64) = (Adrc::<f32>::new(&config, ts), Adrc::<f64>::new(&config, ts));
        let (law32, law64) = (law32.expect("valid"), law64.expect("valid"));
        let (mut s32, mut s64) = (AdrcState::<f32>::default(), AdrcState::<f64>::default());
        law32.settle(&mut s32, AdrcInput { r: 100.0, y: 100.0, u: 50.0 });
        law64.settle(&mut s64, AdrcInput { r: 100.0, y: 100.0, u: 50.0 });
        // A lag of 200 s with gain 2 behind one of 20 s, by Euler's rule: any plant will do.
        let (mut x, mut y, mut u) = (50.0, 100.0, 50.0);
        let mut seen = Vec::new();
        for k in 0..8 * 3_600_000_u32 {
            let load = -3.0 * f64::from(k.min(14_400_000)) / 14_400_000.0;
            u = if single {
                f64::from(law32.step(&mut s32, AdrcInput { r: 100.0, y: y as f32, u: u as f32 }).u())
            } else {
                law64.step(&mut s64, AdrcInput { r: 100.0, y, u }).u()
            };
            x += ts / 20.0 * (u + load - x);
            y += ts / 200.0 * (2.0 * x - y);
            if k % 600_000 == 0 {
                seen.push((y, u));
            }
        }
        seen.push((y, u));
        seen
    };
    let (single, double) = (run(true), run(false));
    let error =
        single.iter().zip(&double).map(|(a, b)| (a.0 - b.0).abs().max((a.1 - b.1).abs())).fold(0.0, f64::max);
    let (y, u) = single[single.len() - 1];
    println!("largest difference {error:.1e}, at the end y {y}, u {u}");
    assert!(error <= 1e-3, "{error:e}");
    assert!((y - 100.0).abs() <= 1e-3 && (u - 53.0).abs() <= 1e-3, "{y} {u}");
}

/// Table 7, G_P5, as the chapter samples it: the two number types run the same loop.
#[test]
fn both_number_types_track_alike() {
    let config = AdrcConfig { b0: 5.0, kp: 100.0, kd: 20.0, beta1: 120.0, beta2: 4800.0, beta3: 19200.0 };
    let ts = 0.001;
    let whole = ControllerConfig::default();
    let law32 = Controller::<f32, _, _>::with_adrc(&whole, &config, ts).expect("valid");
    let law64 = Controller::<f64, _, _>::with_adrc(&whole, &config, ts).expect("valid");
    let (mut s32, mut s64) = (law32.zeroed(), law64.zeroed());
    law32.settle(&mut s32, 0.0, 0.0, 0.0);
    law64.settle(&mut s64, 0.0, 0.0, 0.0);
    let (mut a, mut b) = ([0.0_f64; 4], [0.0_f64; 4]);
    let advance = |x: &mut [f64; 4], u: f64| {
        let mut input = u;
        for (x, lag) in x.iter_mut().zip([1.0, 0.2, 0.04, 0.008]) {
            *x += (ts / lag) * (input - *x);
            input = *x;
        }
    };
    let mut worst = 0.0_f64;
    for _ in 0..6000 {
        let u32 =
            law32.step(&mut s32, &ControllerInput { r: 1.0, y: a[3] as f32, ..ControllerInput::default() });
        let u64 = law64.step(&mut s64, &ControllerInput { r: 1.0, y: b[3], ..ControllerInput::default() });
        advance(&mut a, f64::from(u32.u));
        advance(&mut b, u64.u);
        worst = worst.max((a[3] - b[3]).abs());
    }
    println!("largest difference {worst:.1e}");
    assert!(worst <= 1e-5, "{worst:e}");
    assert!((a[3] - 1.0).abs() <= 1e-4, "{}", a[3]);
}
