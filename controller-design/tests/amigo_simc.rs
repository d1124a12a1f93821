//! AMIGO and SIMC against the robustness that their authors publish.

mod sensitivity;

use controller_core::PidConfig;
use controller_design::areas::Areas;
use controller_design::design::{Law, Method, Request, design};
use controller_design::model::{TransferFunction, parse};
use controller_design::rules::amigo::Amigo;
use controller_design::rules::reduction::Reduced;
use controller_design::rules::simc::Simc;
use sensitivity::ms;

const SCALES: [(f64, f64); 3] = [(1.0, 1.0), (-4e6, 1e-6), (1e-8, 1e6)];

/// Skogestad 2003, Table 1: `Ms` 1.59 where the integral time is the lag, 1.70 on an integrating plant.
#[test]
fn simc_has_its_published_robustness() {
    for (gain, unit) in SCALES {
        for tau in [0.0, 0.2, 1.0, 5.0, 8.0] {
            let (tau, dead_time) = (tau * unit, unit);
            let plant = TransferFunction::first_order(gain, tau, dead_time).unwrap();
            let simc = Simc::pi(gain, tau, dead_time, None).unwrap();
            let worst = ms(&simc.pid, &plant, unit);
            assert!((1.585..1.595).contains(&worst), "tau {tau}: {worst}");
            assert!(simc.warnings.is_empty() && simc.tau_c == dead_time);
        }
        let plant = TransferFunction::integrating(gain, unit).unwrap();
        let worst = ms(&Simc::integrating_pi(gain, unit, None).unwrap().pid, &plant, unit);
        assert!((1.695..1.705).contains(&worst), "{worst}");
    }
}

/// Cancelling the second lag leaves the same loop, but for the filter of the derivative.
#[test]
fn simc_pid_cancels_the_second_lag() {
    let series = Simc::pid(2.0, 6.0, 1.5, 1.0, None).unwrap().pid;
    let plain = Simc::pi(2.0, 6.0, 1.0, None).unwrap().pid;
    // (kp + ki/s + kd*s) = (plain.kp + plain.ki/s)*(1 + 1.5*s)
    assert!((series.ki - plain.ki).abs() < 1e-15);
    assert!((series.kp - (plain.kp + 1.5 * plain.ki)).abs() < 1e-15);
    assert!((series.kd - 1.5 * plain.kp).abs() < 1e-15);
    let pid = Simc::integrating_pid(0.5, 3.0, 1.0, Some(2.0)).unwrap().pid;
    let pi = Simc::integrating_pi(0.5, 1.0, Some(2.0)).unwrap().pid;
    assert!((pid.kp - (pi.kp + 3.0 * pi.ki)).abs() < 1e-15 && (pid.kd - 3.0 * pi.kp).abs() < 1e-15);
}

/// Both branches of the integral time meet where the lag is four times the horizon; far above it is the integrator.
#[test]
fn simc_passes_into_its_limits() {
    let (below, above) =
        (Simc::pi(1.0, 8.0 * (1.0 - 1e-9), 1.0, None), Simc::pi(1.0, 8.0 * (1.0 + 1e-9), 1.0, None));
    let (below, above) = (below.unwrap().pid, above.unwrap().pid);
    assert!((below.ki / above.ki - 1.0).abs() < 1e-8 && (below.kp / above.kp - 1.0).abs() < 1e-8);
    let (slow, integrator) = (Simc::pi(1e9, 1e9, 1.0, None), Simc::integrating_pi(1.0, 1.0, None));
    let (slow, integrator) = (slow.unwrap().pid, integrator.unwrap().pid);
    assert!((slow.kp / integrator.kp - 1.0).abs() < 1e-12 && (slow.ki / integrator.ki - 1.0).abs() < 1e-12);
}

#[test]
fn simc_of_a_model_takes_its_lags() {
    let model =
        |den: &[f64], delay| Reduced::new(&Areas::of_model(-2.0, &[1.0], den, delay).unwrap()).unwrap();
    let ours = Simc::of_model(&model(&[1.0, 7.5, 9.0], 1.0), None).unwrap().pid;
    let direct = Simc::pid(-2.0, 6.0, 1.5, 1.0, None).unwrap().pid;
    assert!((ours.kp / direct.kp - 1.0).abs() < 1e-9 && (ours.kd / direct.kd - 1.0).abs() < 1e-9);
    let first = Simc::of_model(&model(&[1.0, 4.0], 1.0), None).unwrap().pid;
    assert_eq!((first.kd, first.tf), (0.0, 0.0));
    assert!(Simc::of_model(&model(&[1.0, 0.4, 1.0], 0.1), None).is_err());
}

/// The rules aim at 1.4: the PID keeps to it for every ratio, the PI falls below it (more cautious) in the middle.
#[test]
fn amigo_has_its_published_robustness() {
    let unfiltered = |pid: PidConfig| PidConfig { tf: 0.0, ..pid };
    for (gain, unit) in SCALES {
        for tau in [0.05, 0.2, 0.5, 1.0, 2.0, 4.0, 9.0, 20.0] {
            let plant = TransferFunction::first_order(gain, tau * unit, unit).unwrap();
            let pi = ms(&Amigo::pi(gain, tau * unit, unit).unwrap().pid, &plant, unit);
            let pid = Amigo::pid(gain, tau * unit, unit).unwrap().pid;
            let (plain, filtered) = (ms(&unfiltered(pid), &plant, unit), ms(&pid, &plant, unit));
            assert!((1.2..1.5).contains(&pi), "PI, tau {tau}: {pi}");
            assert!((1.38..1.47).contains(&plain), "PID, tau {tau}: {plain}");
            assert!((filtered - plain).abs() < 0.05, "tau {tau}: {filtered}");
        }
        let plant = TransferFunction::integrating(gain, unit).unwrap();
        let pi = ms(&Amigo::integrating_pi(gain, unit).unwrap().pid, &plant, unit);
        let pid = ms(&unfiltered(Amigo::integrating_pid(gain, unit).unwrap().pid), &plant, unit);
        assert!((1.40..1.42).contains(&pi) && (1.40..1.42).contains(&pid), "{pi} {pid}");
    }
}

/// The integrating rules are the limits of the others for a lag that grows with its gain.
#[test]
fn amigo_passes_into_its_limits() {
    let (slow, integrator) = (Amigo::pid(1e9, 1e9, 2.0), Amigo::integrating_pid(1.0, 2.0));
    let (slow, integrator) = (slow.unwrap().pid, integrator.unwrap().pid);
    for (a, b) in [(slow.kp, integrator.kp), (slow.ki, integrator.ki), (slow.kd, integrator.kd)] {
        assert!((a / b - 1.0).abs() < 1e-7);
    }
    // 13.35 is rounded to 13.4 in print.
    let (slow, integrator) =
        (Amigo::pi(1e9, 1e9, 2.0).unwrap().pid, Amigo::integrating_pi(1.0, 2.0).unwrap().pid);
    assert!((slow.kp / integrator.kp - 1.0).abs() < 1e-7 && (slow.ki / integrator.ki - 1.0).abs() < 0.004);
    assert_eq!(Amigo::pid(1.0, 0.0, 1.0).unwrap().pid.kd, 0.0);
    assert_eq!(
        (Amigo::pi(1.0, 2.0, 1.0).unwrap().pid.b, Amigo::pi(1.0, 1.0, 2.0).unwrap().pid.b),
        (0.0, 1.0)
    );
}

#[test]
fn wishes_beyond_the_rules_are_told_or_refused() {
    let eager = Simc::pi(1.0, 5.0, 1.0, Some(0.3)).unwrap();
    assert!(eager.warnings.iter().any(|w| w.to_string().starts_with("tau_c")));
    let useless = Simc::pid(1.0, 5.0, 0.1, 1.0, None).unwrap();
    assert!(useless.warnings.iter().any(|w| w.to_string().starts_with("tau2")));
    assert!(Simc::pi(1.0, 5.0, 0.0, Some(1.0)).is_ok());
    for refused in [
        Simc::pi(1.0, 5.0, 0.0, None),
        Simc::pi(0.0, 5.0, 1.0, None),
        Simc::pi(1.0, -5.0, 1.0, None),
        Simc::pi(1.0, f64::NAN, 1.0, None),
        Simc::pi(1.0, 5.0, 1.0, Some(f64::NAN)),
        Simc::pi(1.0, 5.0, -1.0, None),
        Simc::pid(1.0, 1.0, 2.0, 1.0, None),
        Simc::pi(1e-300, 1.0, 1e-300, None),
        Simc::integrating_pi(f64::INFINITY, 1.0, None),
    ] {
        assert!(!refused.unwrap_err().help().is_empty());
    }
    for refused in [
        Amigo::pi(1.0, 1.0, 0.0),
        Amigo::pi(0.0, 1.0, 1.0),
        Amigo::pid(1.0, -1.0, 1.0),
        Amigo::pid(f64::NAN, 1.0, 1.0),
        Amigo::integrating_pi(1.0, f64::INFINITY),
        Amigo::integrating_pid(0.0, 1.0),
        Amigo::integrating_pid(1e-200, 1e-200),
    ] {
        assert!(!refused.unwrap_err().help().is_empty());
    }
}

/// Equal lags, whose time constants come back from the sum and the product with an error of the size of the square root of
/// the rounding, on either side of being complex.
#[test]
fn simc_takes_two_equal_lags() {
    for (n, factor) in (1..60).flat_map(|n| [(n, true), (n, false)]) {
        let tau = 0.237 * f64::from(n);
        let lags =
            if factor { format!("(1+{tau}*s)^2") } else { format!("(1+{}*s+{}*s^2)", 2.0 * tau, tau * tau) };
        let plant = parse(&format!("3*exp(-s)/{lags}")).unwrap();
        let made = design(&plant, &Request::new(Method::Simc, 1e-3)).unwrap();
        let Law::Pid { pid, .. } = made.law else { panic!("a PID") };
        let (kc, ti) = (tau / 6.0, tau.min(8.0));
        let (kp, ki, kd) = (kc * (1.0 + tau / ti), kc / ti, kc * tau);
        for (ours, exact) in [(pid.kp, kp), (pid.ki, ki), (pid.kd, kd)] {
            assert!((ours / exact - 1.0).abs() < 1e-7, "{tau}: {ours} {exact}");
        }
    }
}
