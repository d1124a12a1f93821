//! What Tena et al. 2022 say of their 134 processes, and whose loops are stable.

use controller_core::PidConfig;
use controller_design::batch134::processes;
use controller_design::margins::ContinuousLoop;
use controller_design::model::parse;
use controller_design::response::{ContinuousResponse, Indices, Load};
use controller_design::rules::PiMs;
use proptest::prelude::*;

/// Counts of the ratios above 1 of IAE, ISE, ITAE at noise ratios 2 and 10, and the largest ratios.
fn counts(ms: f64) -> [[(usize, f64); 3]; 2] {
    let mut result = [[(0, 0.0_f64); 3]; 2];
    for process in processes() {
        let g = process.plant().expect("published");
        let pid = PiMs::new(&g, ms).expect("converges").pid;
        let of = |alpha: Option<f64>| -> Indices {
            let response = match alpha {
                None => ContinuousResponse::new(&g, &pid, None),
                Some(alpha) => ContinuousResponse::with_alpha(&g, &pid, alpha),
            };
            response.and_then(|r| r.indices(Load::Step)).unwrap_or_else(|e| panic!("{}: {e}", process.name))
        };
        let base = of(None);
        for (row, noise) in result.iter_mut().zip([2.0, 10.0]) {
            // alpha^d = prod(tau)/(K*kp*(b1 - 1)); no process has a zero in the left half-plane.
            let den = g.den_polynomial();
            let lead = den.coefficient(den.degree()) / (g.gain() * pid.kp * (noise - 1.0));
            let i = of(Some(lead.powf(1.0 / den.degree() as f64)));
            for (cell, ratio) in row.iter_mut().zip([i.iae / base.iae, i.ise / base.ise, i.itae / base.itae])
            {
                cell.0 += usize::from(ratio > 1.0);
                cell.1 = cell.1.max(ratio);
            }
        }
    }
    result
}

#[test]
fn statements_about_the_134_processes() {
    let largest = |row: [(usize, f64); 3], want: [f64; 3]| {
        for ((_, ours), want) in row.iter().zip(want) {
            assert!((ours / want - 1.0).abs() < 2e-3, "{row:?} {want}");
        }
    };
    let numbers = |row: [(usize, f64); 3]| row.map(|(n, _)| n);
    let near = |row: [(usize, f64); 3], want: [usize; 3], by: usize| {
        assert!(numbers(row).iter().zip(want).all(|(n, w)| n.abs_diff(w) <= by), "{row:?} {want:?}");
    };
    let [two, ten] = counts(1.2);
    assert_eq!((numbers(two), numbers(ten)), ([0, 0, 32], [0, 0, 0]));
    largest(two, [0.958, 0.663, 1.540]);
    largest(ten, [0.539, 0.517, 0.518]);
    // At the other two, ratios lie so near to 1 that the reference allows 1 and 2 more or less.
    let [two, ten] = counts(1.4);
    near(two, [45, 0, 96], 1);
    near(ten, [0, 0, 0], 1);
    largest(two, [1.180, 0.943, 1.889]);
    largest(ten, [0.937, 0.877, 0.979]);
    let [two, ten] = counts(2.0);
    near(two, [85, 51, 114], 2);
    near(ten, [25, 12, 49], 2);
    largest(two, [1.552, 1.584, 1.999]);
    largest(ten, [1.495, 1.500, 1.844]);
}

/// Stable by the argument principle; `None` if a few per cent of gain would change that.
fn stable(text: &str, pid: &PidConfig) -> Option<bool> {
    let g = parse(text).expect("a plant");
    let verdict = |factor: f64| {
        let pid = PidConfig { kp: pid.kp * factor, ki: pid.ki * factor, ..*pid };
        ContinuousLoop::new(&g, &pid).margins().is_ok()
    };
    let all = [0.97, 1.0, 1.03].map(verdict);
    (all[0] == all[1] && all[1] == all[2]).then_some(all[1])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn stable_loops_have_indices_and_others_none(
        kind in 0_usize..6,
        a in -3.0_f64..1.0,
        b in -3.0_f64..1.0,
        delay in -3.0_f64..1.0,
        kp in -2.0_f64..1.3,
        ki in -2.5_f64..1.0,
    ) {
        let [a, b, delay, kp, ki] = [a, b, delay, kp, ki].map(|x| 10_f64.powf(x));
        let text = match kind {
            0 => format!("exp(-{delay:e}*s)/((1+s)*(1+{a:e}*s)*(1+{b:e}*s))"),
            1 => format!("(1-{a:e}*s)*exp(-{delay:e}*s)/((1+s)^2*(1+{b:e}*s))"),
            2 => format!("exp(-{delay:e}*s)/(s*(1+{a:e}*s))"),
            3 => format!("exp(-{delay:e}*s)/((1+{b:e}*s)*(1+0.4*s+s^2))"),
            4 => format!("(1+{b:e}*s)/((1+s)^3*(1+{a:e}*s))"),
            _ => format!("exp(-{delay:e}*s)/(1-s)"),
        };
        let sign = if kind == 5 { -1.0 } else { 1.0 };
        let pid = PidConfig { kp: sign * kp, ki: sign * ki, ..PidConfig::default() };
        let g = parse(&text).expect("a plant");
        let response = ContinuousResponse::new(&g, &pid, None).expect("a loop");
        let indices = response.indices(Load::Step);
        // A loop that is stable by a hair may ring for longer than anybody would wait.
        let rings = indices.as_ref().is_err_and(|refusal| refusal.to_string().contains("settle"));
        if let Some(stable) = stable(&text, &pid)
            && !(stable && rings)
        {
            prop_assert_eq!(indices.is_ok(), stable, "{} {:?} {:?}", text, pid, indices);
        }
        if let Ok(i) = indices {
            prop_assert!((i.ie * pid.ki + 1.0).abs() < 1e-6, "{:?}", i);
            prop_assert!(i.iae >= i.ie.abs() * (1.0 - 1e-6) && i.itae > 0.0 && i.tv >= 1.0 - 1e-6);
            // Cauchy and Schwarz against the largest value.
            prop_assert!(i.ise <= i.e_max * i.iae * (1.0 + 1e-9));
            // With an observer the loop is as stable as without.
            let observed = ContinuousResponse::with_alpha(&g, &pid, b).expect("a loop").indices(Load::Step);
            prop_assert!(observed.is_ok_and(|o| o.ie.abs() < 1e-5 * o.iae));
        }
    }
}
