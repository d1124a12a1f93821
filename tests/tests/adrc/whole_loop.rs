//! The loop around an ADRC: modes, offset, limits, bad samples, swaps, snapshots, any input.

use super::forms::Draw;
use controller_core::{
    Adrc, AdrcConfig, Controller, ControllerConfig, ControllerInput, ControllerOutput, ControllerState,
    FallbackConfig, LimitConfig, Mode, NoCompensator, Param, PidConfig, Quality, Real, Reason,
    SetpointConfig, Status,
};
use controller_tests::oracle::sampled_plant::SampledPlant;
use controller_tests::oracle::state_space::PlantFactors;

const TS: f64 = 0.02;
const RANGE: f64 = 40.0;

type Law<T> = Controller<T, NoCompensator, Adrc<T>>;
type State<T> = ControllerState<T, (), controller_core::AdrcState<T>>;

#[derive(Clone)]
struct Rig<T: Real> {
    law: Law<T>,
    state: State<T>,
    plant: SampledPlant,
    input: ControllerInput<T>,
    d: f64,
}

impl<T: Real> Rig<T> {
    fn new(config: &ControllerConfig, adrc: &AdrcConfig, plant: &PlantFactors<'_>) -> Self {
        let law = Law::<T>::with_adrc(config, adrc, TS).expect("valid");
        let mut state = law.zeroed();
        law.settle(&mut state, T::ZERO, T::ZERO, T::ZERO);
        Self { law, state, plant: plant.sampled(TS), input: ControllerInput::default(), d: 0.0 }
    }

    fn step(&mut self) -> ControllerOutput<T> {
        self.input.y = T::from_f64(self.plant.output());
        let out = self.law.step(&mut self.state, &self.input);
        let _ = self.plant.step(out.u.to_f64(), self.d);
        out
    }

    fn run(&mut self, samples: usize) -> ControllerOutput<T> {
        let mut out = self.step();
        for _ in 1..samples {
            out = self.step();
        }
        out
    }
}

fn config() -> ControllerConfig {
    ControllerConfig {
        limits: LimitConfig::range(-0.5 * RANGE, 0.5 * RANGE),
        setpoint: SetpointConfig { track: true, ..SetpointConfig::default() },
        ..ControllerConfig::default()
    }
}

const SECOND: PlantFactors<'static> = PlantFactors { lags: &[1.0, 0.2], ..PlantFactors::UNITY };
const MOTOR: PlantFactors<'static> =
    PlantFactors { gain: -3.0, integrators: 1, lags: &[0.3], dead_time: 0.05, ..PlantFactors::UNITY };

fn setups() -> [(&'static str, PlantFactors<'static>, AdrcConfig); 2] {
    [
        ("two lags", SECOND, AdrcConfig::from_bandwidths(5.0, 3.0, 12.0)),
        ("integrating, negative", MOTOR, AdrcConfig::from_bandwidths(-10.0, 2.0, 8.0)),
    ]
}

fn moments<T: Real>(plant: &PlantFactors<'_>, adrc: &AdrcConfig) -> Vec<(&'static str, Rig<T>)> {
    let mut rig = Rig::<T>::new(&config(), adrc, plant);
    let mut list = Vec::new();
    rig.input.r = T::from_f64(3.0);
    rig.input.offset = T::from_f64(0.3);
    rig.d = 0.5;
    rig.run(4000);
    list.push(("at rest", rig.clone()));
    rig.input.r = T::from_f64(3.8);
    rig.run(4);
    list.push(("after a set-point step", rig.clone()));
    rig.d = -1.0;
    rig.run(40);
    list.push(("fighting a disturbance", rig.clone()));
    rig.input.r = T::from_f64(60.0);
    rig.run(20);
    list.push(("saturated", rig));
    list
}

/// As for a PID: a twin keeps the old mode; what the operator asks for is what is there.
fn every_pair_of_modes<T: Real>(eps: f64) {
    let mut pairs = 0;
    for (name, plant, adrc) in setups() {
        for (moment, base) in moments::<T>(&plant, &adrc) {
            for from in Mode::REQUESTS {
                let mut old = base.clone();
                old.input.r_remote = old.input.r + T::from_f64(0.4);
                old.input.track = T::from_f64(1.7);
                old.input.manual = Some(T::from_f64(-1.2));
                old.input.mode = from;
                old.run(7);
                for to in Mode::REQUESTS.into_iter().filter(|&to| to != from) {
                    let there = old.clone().step().u;
                    let (mut new, mut twin) = (old.clone(), old.clone());
                    new.input.mode = to;
                    match to {
                        Mode::Manual => new.input.manual = Some(there),
                        Mode::Track => new.input.track = there,
                        _ => {}
                    }
                    let (u_new, u_twin) = (new.step(), twin.step());
                    assert_eq!(u_new.mode, to);
                    let bump = (u_new.u.to_f64() - u_twin.u.to_f64()).abs();
                    assert!(bump <= RANGE * eps, "{name}, {moment}, {from:?} -> {to:?}: {bump:e}");
                    pairs += 1;
                }
            }
        }
    }
    assert_eq!(pairs, 2 * 4 * 30);
}

#[test]
fn every_ordered_pair_of_modes_is_bumpless() {
    every_pair_of_modes::<f64>(1e-9);
    every_pair_of_modes::<f32>(1e-4);
}

/// From every mode the loop comes back to its set-point with the disturbance and an offset, and stays: at rest, closing the
/// loop on the measurement moves nothing at all.
#[test]
fn the_loop_closes_from_every_mode() {
    for (name, plant, adrc) in setups() {
        for from in Mode::REQUESTS {
            let mut rig = Rig::<f64>::new(&config(), &adrc, &plant);
            rig.input = ControllerInput { r: 2.0, r_remote: 2.0, offset: 1.5, ..rig.input };
            rig.d = 0.7;
            rig.run(3000);
            let rest = rig.step();
            assert!((rig.plant.output() - 2.0).abs() < 1e-6, "{name}: {}", rig.plant.output());
            rig.input.mode = from;
            rig.input.manual = Some(rest.u);
            rig.input.track = rest.u;
            rig.run(500);
            rig.input.mode = Mode::Auto;
            rig.input.r = if from == Mode::Cascade { 2.0 } else { rig.plant.output() };
            let back = rig.run(50);
            assert!((back.u - rest.u).abs() < 1e-5, "{name}, {from:?}: {} from {}", back.u, rest.u);
            rig.input.r = 2.5;
            rig.run(3000);
            assert!((rig.plant.output() - 2.5).abs() < 1e-6, "{name}, {from:?}: {}", rig.plant.output());
        }
    }
}

/// An offset that cancels a disturbance as it comes leaves the measurement alone: the observer does not take it for its own
/// output, nor for a disturbance.
#[test]
fn an_exact_offset_leaves_nothing_to_do() {
    for (name, plant, adrc) in setups() {
        let plant = PlantFactors { dead_time: 0.0, ..plant };
        let mut rig = Rig::<f64>::new(&config(), &adrc, &plant);
        rig.run(10);
        (rig.d, rig.input.offset) = (1.2, -1.2);
        for _ in 0..200 {
            let out = rig.step();
            assert!(rig.plant.output().abs() < 1e-12 && (out.u + 1.2).abs() < 1e-12, "{name}");
        }
    }
}

/// The estimate of the disturbance of a double integrator is the disturbance, whether or not the output saturates.
#[test]
fn a_double_integrator_is_observed_exactly() {
    let plant = PlantFactors { gain: 4.0, integrators: 2, ..PlantFactors::UNITY };
    let limits = LimitConfig { rate_up: Some(20.0), rate_down: Some(20.0), ..LimitConfig::range(-1.0, 1.0) };
    let config = ControllerConfig { limits, ..ControllerConfig::default() };
    let mut rig = Rig::<f64>::new(&config, &AdrcConfig::from_bandwidths(4.0, 3.0, 12.0), &plant);
    rig.run(5);
    rig.d = 0.25;
    rig.run(500);
    assert!((rig.state.adrc().disturbance() - 0.25).abs() < 1e-9);
    rig.input.r = 10.0;
    let mut limited = 0;
    for _ in 0..1500 {
        let status = rig.step().status;
        limited += usize::from(status.has(Status::LIMITED_HIGH) || status.has(Status::LIMITED_LOW));
        let d = rig.state.adrc().disturbance();
        assert!((d - 0.25).abs() < 1e-9, "{d}");
    }
    assert!(limited > 50, "{limited}");
    assert!((rig.plant.output() - 10.0).abs() < 1e-6, "{}", rig.plant.output());
}

/// How long a loop was saturated makes no difference to how it leaves its limit: nothing winds up.
#[test]
fn nothing_winds_up() {
    let limits = LimitConfig::range(-1.2, 1.2);
    let adrc = AdrcConfig::from_bandwidths(5.0, 3.0, 12.0);
    let recovery = |saturated: usize| {
        let config = ControllerConfig { limits, ..ControllerConfig::default() };
        let mut rig = Rig::<f64>::new(&config, &adrc, &SECOND);
        rig.input.r = 5.0;
        let out = rig.run(saturated);
        assert!(out.status.has(Status::LIMITED_HIGH));
        rig.input.r = 1.0;
        let course: Vec<f64> = (0..600).map(|_| (rig.step(), rig.plant.output()).1).collect();
        assert!((course[599] - 1.0).abs() < 1e-6, "{}", course[599]);
        course
    };
    let (short, long) = (recovery(1500), recovery(50_000));
    let difference = short.iter().zip(&long).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-9, "{difference:e}");
}

#[test]
fn bad_samples_hold_and_come_back() {
    for (name, plant, adrc) in setups() {
        let fallback = FallbackConfig { hold_samples: 5, ..FallbackConfig::default() };
        let mut rig = Rig::<f64>::new(&ControllerConfig { fallback, ..config() }, &adrc, &plant);
        rig.input.r = 1.0;
        rig.run(2000);
        for (count, mode) in [(3, Mode::Auto), (8, Mode::Fallback)] {
            let before = rig.step();
            rig.input.quality = Quality::Bad;
            let held = rig.run(count);
            assert_eq!((held.u, held.mode), (before.u, mode), "{name}");
            rig.input.quality = Quality::Good;
            let back = rig.step();
            assert_eq!(back.mode, Mode::Auto);
            assert!((back.u - before.u).abs() < 1e-6, "{name}: {} from {}", back.u, before.u);
            rig.run(1000);
            assert!((rig.plant.output() - 1.0).abs() < 1e-6, "{name}");
        }
        rig.law.advance(&mut rig.state, 2);
        assert!(rig.step().status.has(Status::OVERRUN));
    }
}

/// At rest a swap of any parameter, the sampling period included, moves nothing; while moving, no more than the old law's own
/// next move and the new gains' answer to what the observer expects of this sample and to what it did not expect.
#[test]
fn laws_are_swapped_without_a_bump() {
    let others = [
        AdrcConfig::from_bandwidths(5.0, 4.0, 12.0),
        AdrcConfig::from_bandwidths(3.0, 3.0, 12.0),
        AdrcConfig::from_bandwidths(5.0, 3.0, 25.0),
    ];
    let (_, plant, adrc) = setups()[0];
    for (moment, base) in moments::<f64>(&plant, &adrc) {
        for other in others {
            let mut new = base.clone();
            let law = Law::<f64>::with_adrc(&config(), &other, TS).expect("valid");
            law.adopt(&base.law, &mut new.state);
            new.law = law;
            let before = base.state.u();
            let estimates = new.state.adrc();
            let (z1, w) = (estimates.output(), estimates.slope());
            let push = other.b0 * TS * TS * (before - 0.3 + estimates.disturbance());
            let surprise = base.plant.output() - z1 - w - 0.5 * push;
            let (kp, kd) = (other.kp / other.b0, other.kd / (other.b0 * TS));
            let answer = kp * (w + 0.5 * push).abs()
                + kd * push.abs()
                + law.adrc().high_frequency_gain() * surprise.abs();
            let (v_new, v_twin) = (new.step().v, base.clone().step().v);
            let bump = (v_new - v_twin).abs();
            // What the old law wanted in the last sample, from its estimates.
            let old = base.state.adrc();
            let feedback = adrc.kp * (base.input.r - old.output()) - adrc.kd / TS * old.slope();
            let wanted = feedback / adrc.b0 - old.disturbance() + 0.3;
            let allowed = answer + (v_twin - wanted).abs() + 1e-9 * RANGE;
            assert!(bump <= allowed, "{moment}: {bump:e}, allowed {allowed:e}");
            if moment == "at rest" {
                assert!(bump <= 1e-9 * RANGE, "{bump:e}");
            }
        }
        // The same law again: nothing at all.
        let mut same = base.clone();
        base.law.adopt(&base.law, &mut same.state);
        assert_eq!(same.step().u, base.clone().step().u, "{moment}");
    }
    let law = Law::<f64>::with_adrc(&config(), &adrc, 2.0 * TS).expect("valid");
    let (_, base) = moments::<f64>(&plant, &adrc).swap_remove(1);
    let (mut state, slope) = (base.state, base.state.adrc().slope());
    law.adopt(&base.law, &mut state);
    assert_eq!(state.adrc().slope(), 2.0 * slope);
}

#[test]
fn a_snapshot_continues_bit_for_bit() {
    let (_, plant, adrc) = setups()[0];
    let (_, mut rig) = moments::<f32>(&plant, &adrc).swap_remove(2);
    let mut words = [0; 64];
    let n = rig.law.save(&rig.state, &mut words).expect("fits");
    assert_eq!(n, Law::<f32>::snapshot_words(&rig.state));
    let mut copy = rig.clone();
    copy.state = copy.law.zeroed();
    copy.law.restore(&mut copy.state, &words[..n]).expect("intact");
    for _ in 0..50 {
        assert_eq!(copy.step(), rig.step());
    }
    let pid = Controller::<f32>::new(&ControllerConfig::default(), TS).expect("valid");
    assert!(pid.restore(&mut pid.zeroed(), &words[..n]).is_err());
    words[8] ^= 1;
    assert!(copy.law.restore(&mut copy.state, &words[..n]).is_err());
}

fn any<T: Real>(draw: &mut Draw) -> T {
    match (draw.unit() * 6.0) as u32 {
        0 => T::from_words([draw.word(), draw.word()]),
        1 => T::from_f64(f64::NAN),
        2 => T::from_f64(f64::INFINITY),
        3 => T::from_f64(draw.between(-1e6, 1e6)),
        _ => T::from_f64(draw.between(-3.0, 3.0)),
    }
}

/// Random laws over the ranges, random bit patterns of every input: finite outputs in their range, a finite state.
fn total<T: Real>() {
    let mut draw = Draw(3);
    let mut built = 0;
    for _ in 0..600 {
        let ts = 10.0_f64.powf(draw.between(-6.0, 4.0));
        let rate = |draw: &mut Draw, most: f64| 10.0_f64.powf(draw.between(-4.0, most)) / ts;
        let (omega_o, omega_c) = (rate(&mut draw, 2.0), rate(&mut draw, -0.4));
        let mut adrc = AdrcConfig::from_bandwidths(10.0_f64.powf(draw.between(-7.0, 7.0)), omega_c, omega_o);
        if draw.unit() < 0.3 {
            // Hardly any damping.
            adrc.beta3 = adrc.beta1 * adrc.beta2 * draw.between(0.999, 1.0);
        }
        if draw.unit() < 0.5 {
            adrc.b0 = -adrc.b0;
        }
        let Ok(law) = Law::<T>::with_adrc(&config(), &adrc, ts) else { continue };
        built += 1;
        let mut state = law.zeroed();
        for _ in 0..300 {
            let modes = Mode::REQUESTS;
            let input = ControllerInput {
                r: any(&mut draw),
                r_remote: any(&mut draw),
                y: any(&mut draw),
                quality: if draw.unit() < 0.1 { Quality::Bad } else { Quality::Good },
                mode: if draw.unit() < 0.7 { Mode::Auto } else { modes[(draw.unit() * 6.0) as usize] },
                manual: Some(any(&mut draw)),
                track: any(&mut draw),
                offset: any(&mut draw),
                u_applied: if draw.unit() < 0.5 { Some(any(&mut draw)) } else { None },
                compensate: draw.unit() < 0.5,
                inhibit_up: draw.unit() < 0.5,
                inhibit_down: draw.unit() < 0.5,
                acknowledge: draw.unit() < 0.5,
            };
            let out = law.step(&mut state, &input);
            let numbers = [out.u, out.v, out.i, out.pd, out.u_f, out.d_hat, out.r];
            assert!(numbers.iter().all(|x| x.is_finite_number()), "{adrc:?}, ts {ts}: {out:?}");
            assert!(out.u.magnitude().to_f64() <= 0.5 * RANGE, "{out:?}");
            let estimates = [state.adrc().output(), state.adrc().slope(), state.adrc().disturbance()];
            assert!(estimates.iter().all(|x| x.is_finite_number()), "{adrc:?}, ts {ts}: {state:?}");
        }
        // With good inputs the loop closes at once.
        let out = law.step(&mut state, &ControllerInput { acknowledge: true, ..ControllerInput::default() });
        assert_eq!(out.mode, Mode::Auto);
        // What was saved from any state can be restored.
        let mut words = [0; 64];
        let n = law.save(&state, &mut words).expect("fits");
        law.restore(&mut law.zeroed(), &words[..n]).expect("intact");
    }
    assert!(built > 300, "{built} of 600 were built");
}

#[test]
fn a_step_is_total() {
    total::<f32>();
    total::<f64>();
}

#[test]
fn wrong_parameters_are_refused_all_at_once() {
    let good = AdrcConfig::from_bandwidths(5.0, 10.0, 40.0);
    let faults = |config: &AdrcConfig, ts: f64| match Adrc::<f64>::new(config, ts) {
        Ok(_) => Vec::new(),
        Err(faults) => faults.iter().map(|f| (f.param, f.reason)).collect::<Vec<_>>(),
    };
    assert!(faults(&good, 0.001).is_empty());
    let out = Reason::OutOfRange;
    let nothing =
        AdrcConfig { b0: 0.0, kp: -1.0, kd: f64::NAN, beta1: 0.0, beta2: -3.0, beta3: f64::INFINITY };
    let all = faults(&nothing, 0.001);
    let params = [Param::B0, Param::AdrcKp, Param::AdrcKd, Param::Beta1, Param::Beta2, Param::Beta3];
    assert_eq!(all.iter().map(|f| f.0).collect::<Vec<_>>(), params);
    assert_eq!((all[0].1, all[2].1, all[5].1), (out, Reason::NotFinite, Reason::NotFinite));
    // An unstable observer; a feedback too fast for the sampling period.
    let unstable = AdrcConfig { beta3: good.beta1 * good.beta2, ..good };
    assert_eq!(faults(&unstable, 0.001), [(Param::Beta3, out)]);
    assert!(faults(&good, 0.0999).is_empty());
    assert_eq!(faults(&good, 0.1), [(Param::AdrcKd, out)]);
    assert_eq!(faults(&AdrcConfig { kp: 2.1e5, kd: 100.0, ..good }, 0.001), [(Param::AdrcKp, out)]);
    // What single precision cannot hold.
    let tiny = AdrcConfig::from_bandwidths(1e-14, 1e-12, 1e-11);
    assert!(Adrc::<f64>::new(&tiny, 1e-9).is_ok());
    let refused = Adrc::<f32>::new(&tiny, 1e-9).expect_err("no room");
    assert_eq!(refused[0].param, Param::Overflow);

    let with = |config: ControllerConfig| {
        let faults = Law::<f64>::with_adrc(&config, &unstable, 0.001).expect_err("refused");
        faults.iter().map(|f| f.param).collect::<Vec<_>>()
    };
    let pid = PidConfig { kp: 1.0, ki: 1.0, ..PidConfig::default() };
    let limits = LimitConfig::range(1.0, 1.0);
    let all = with(ControllerConfig { pid, deadband: 0.1, limits, ..ControllerConfig::default() });
    assert_eq!(all, [Param::Beta3, Param::Kp, Param::Ki, Param::Deadband, Param::OutputLo]);
}
