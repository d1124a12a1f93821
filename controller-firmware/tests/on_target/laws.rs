//! The core's promises, where they count.

use controller_core::{
    Controller, ControllerConfig, ControllerInput, Estimator, EstimatorConfig, FallbackConfig, Instance,
    LimitConfig, Mode, ParamCell, Pid, PidConfig, PidInput, PidState, Quality, Real, Status,
};

pub(crate) const TESTS: &[(&str, fn())] = &[
    ("a PID gives the bits of its equation", pid),
    ("a law is adopted: the transfer is bumpless", adopted),
    ("a controller starts, saturates and says so", saturates),
    ("a bad sample holds, a long time without falls back", bad_samples),
    ("any bit pattern gives an output in range", total),
    ("a disturbance is estimated, in both precisions", estimated),
    ("a saved state goes on bit for bit", saved),
    ("a configuration is refused with all its faults", refused),
    ("a law is published whole", published),
];

const TS: f64 = 0.01;

fn config() -> ControllerConfig {
    ControllerConfig {
        pid: PidConfig { kp: 2.35, ki: 1.88, kd: 0.48, tf: 0.119, b: 1.0, c: 1.0, ..PidConfig::default() },
        limits: LimitConfig::range(-10.0, 10.0),
        ..ControllerConfig::default()
    }
}

fn at(r: f32, y: f32) -> ControllerInput<f32> {
    ControllerInput { r, y, ..ControllerInput::default() }
}

fn pid() {
    let law = Pid::<f32>::new(&PidConfig { kp: 2.0, ki: 0.5, ..PidConfig::default() }, 0.1).unwrap();
    let mut state = PidState::default();
    assert_eq!(law.step(&mut state, PidInput { r: 1.0, y: 0.0 }).u(), 2.05);
    // Far below one unit in the last place of the integral, and it still moves.
    law.settle(&mut state, PidInput { r: 0.0, y: 0.0 }, 1000.0);
    for _ in 0..20_000 {
        let _ = law.step(&mut state, PidInput { r: 1e-5, y: 0.0 });
    }
    let out = law.step(&mut state, PidInput { r: 1e-5, y: 0.0 });
    assert!((out.i - 1000.01).abs() < 1e-4, "{}", out.i);
}

fn adopted() {
    let law = |kp| Pid::<f64>::new(&PidConfig { kp, ki: 1.0, ..PidConfig::default() }, 0.1).unwrap();
    let mut pid = Instance::new(law(2.0), PidState::default());
    assert_eq!(pid.step(&PidInput { r: 1.0, y: 0.0 }).u(), 2.1);
    pid.adopt(law(1.0));
    assert!((pid.step(&PidInput { r: 1.0, y: 0.0 }).u() - 2.2).abs() < 1e-12);
}

fn saturates() {
    let law = Controller::<f32>::new(&config(), TS).unwrap();
    let mut state = law.zeroed();
    law.settle(&mut state, 1.0, 1.0, 9.5);
    assert_eq!(law.step(&mut state, &at(1.0, 1.0)).u, 9.5);
    let out = law.step(&mut state, &at(5.0, 1.0));
    assert_eq!((out.u, out.status.has(Status::LIMITED_HIGH)), (10.0, true));
    let manual = ControllerInput { mode: Mode::Manual, manual: Some(-3.0), ..at(5.0, 1.0) };
    let out = law.step(&mut state, &manual);
    assert_eq!((out.u, out.mode, out.status.has(Status::LIMITED_HIGH)), (-3.0, Mode::Manual, false));
}

fn bad_samples() {
    let config = ControllerConfig {
        fallback: FallbackConfig { hold_samples: 2, ..FallbackConfig::default() },
        ..config()
    };
    let law = Controller::<f32>::new(&config, TS).unwrap();
    let mut state = law.zeroed();
    law.settle(&mut state, 1.0, 1.0, 4.0);
    for bad in [at(1.0, f32::NAN), ControllerInput { quality: Quality::Bad, ..at(1.0, 1.0) }] {
        let out = law.step(&mut state, &bad);
        assert!(out.u == 4.0 && out.status.has(Status::HELD) && out.mode == Mode::Auto);
    }
    let out = law.step(&mut state, &at(1.0, f32::INFINITY));
    assert!(out.u == 4.0 && out.mode == Mode::Fallback && out.status.has(Status::FALLBACK));
    let out = law.step(&mut state, &at(1.0, 1.0));
    assert_eq!((out.u, out.mode), (4.0, Mode::Auto));
}

/// Numbers without a pattern (xorshift).
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    fn number(&mut self) -> f32 {
        f32::from_bits(self.next())
    }
}

fn total() {
    let law = Controller::<f32>::new(&config(), TS).unwrap();
    let mut state = law.zeroed();
    let mut random = Random(0x2545_F491);
    let mut modes = Mode::REQUESTS.iter().cycle();
    for _ in 0..5000 {
        let input = ControllerInput {
            r: random.number(),
            r_remote: random.number(),
            y: random.number(),
            manual: Some(random.number()),
            track: random.number(),
            offset: random.number(),
            u_applied: Some(random.number()),
            mode: *modes.next().unwrap(),
            compensate: random.next() & 1 == 0,
            ..ControllerInput::default()
        };
        let out = law.step(&mut state, &input);
        assert!(
            (-10.0..=10.0).contains(&out.u) && out.v.is_finite() && out.i.is_finite() && out.r.is_finite()
        );
    }
}

/// The DE-MOMI design of Vrančić & Huba 2021 for exp(-0.2 s)/((1+0.2 s)(1+s)), on a first-order stand-in for the plant.
fn estimated() {
    let (single, double) = (disturbed::<f32>(), disturbed::<f64>());
    assert!(single[0].abs() < 1e-3 && (single[1] + 0.5).abs() < 1e-3, "{single:?}");
    let near = single.iter().zip(double).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(near, "{single:?} {double:?}");
}

/// Measurement, output and estimated disturbance 15 s after a step of 0.5 at the plant's input.
#[inline(never)]
fn disturbed<T: Real>() -> [f64; 3] {
    let model = EstimatorConfig { gain: 1.0, a1: 1.2, a2: 0.2, dead_time: 0.2, kfd: 0.69, tfd: 0.06 };
    let estimator = Estimator::<T, 32>::estimator(&model, 0.0, TS).unwrap();
    let law = Controller::with_compensator(&config(), estimator, TS).unwrap();
    let mut state = law.zeroed();
    let (disturbance, part) = (T::from_f64(0.5), T::from_f64(TS));
    let mut y = T::ZERO;
    let mut out = law.step(&mut state, &ControllerInput::default());
    for _ in 0..1500 {
        y = y + part * (out.u + disturbance - y);
        out = law.step(&mut state, &ControllerInput { y, ..ControllerInput::default() });
    }
    [y, out.u, out.d_hat].map(Real::to_f64)
}

fn saved() {
    let law = Controller::<f32>::new(&config(), TS).unwrap();
    let mut state = law.zeroed();
    let mut out = law.step(&mut state, &at(1.0, 0.0));
    for k in 0_u8..50 {
        out = law.step(&mut state, &at(1.0, 0.01 * f32::from(k)));
    }
    let mut words = [0; 64];
    let count = law.save(&state, &mut words).unwrap();
    let mut copy = law.zeroed();
    law.restore(&mut copy, &words[..count]).unwrap();
    assert_eq!(copy, state);
    assert_eq!(law.step(&mut state, &at(1.0, 0.6)), law.step(&mut copy, &at(1.0, 0.6)));
    words[3] ^= 1;
    assert!(law.restore(&mut copy, &words[..count]).is_err());
    assert!(out.u.is_finite());
}

fn refused() {
    let faults =
        Pid::<f32>::new(&PidConfig { kp: f64::NAN, tf: -1.0, ..PidConfig::default() }, TS).unwrap_err();
    assert_eq!(faults.len(), 2);
}

fn published() {
    static CELL: ParamCell<Pid<f32>> = ParamCell::new();
    let law = |kp| Pid::<f32>::new(&PidConfig { kp, ..PidConfig::default() }, TS).unwrap();
    let mut seen = 0;
    assert_eq!(CELL.take_newer(&mut seen), None);
    CELL.publish(law(1.0));
    CELL.publish(law(2.0));
    assert_eq!((CELL.take_newer(&mut seen), CELL.take_newer(&mut seen)), (Some(law(2.0)), None));
}
