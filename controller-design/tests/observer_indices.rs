//! alpha of a disturbance observer for a wanted index.

use controller_core::PidConfig;
use controller_design::Refusal;
use controller_design::model::{TransferFunction, parse};
use controller_design::response::{ContinuousResponse, Indices, Load};
use controller_design::rules::{Wish, alpha_for};

fn loop_of(text: &str, kp: f64, ki: f64) -> (TransferFunction, PidConfig) {
    (parse(text).expect("a plant"), PidConfig { kp, ki, ..PidConfig::default() })
}

fn alone((g, pid): &(TransferFunction, PidConfig)) -> Indices {
    ContinuousResponse::new(g, pid, None).and_then(|r| r.indices(Load::Step)).expect("a stable loop")
}

fn with(l: &(TransferFunction, PidConfig), alpha: f64) -> Indices {
    ContinuousResponse::with_alpha(&l.0, &l.1, alpha)
        .and_then(|r| r.indices(Load::Step))
        .expect("a stable loop")
}

#[test]
fn ratios_of_the_table_give_back_its_alpha() {
    // Tena et al. 2022, table 3 recomputed: IAE, ISE, ITAE, e_max over those of the PI.
    let rows = [
        ("exp(-5*s)/(1+95*s)", 3.16418932, 0.0870833318, 10.0, [0.40972, 0.15538, 0.46032, 0.52633]),
        ("exp(-5*s)/(1+95*s)", 3.16418932, 0.0870833318, 1.0, [0.1744, 0.0354, 0.17286, 0.33494]),
        ("exp(-20*s)/(1+80*s)", 0.696075276, 0.011533633, 100.0, [0.8572, 0.5052, 1.2669, 0.7958]),
        ("exp(-20*s)/(1+80*s)", 0.696075276, 0.011533633, 10.0, [0.3218, 0.1166, 0.3285, 0.5534]),
    ];
    for (text, kp, ki, alpha, [iae, ise, itae, e_max]) in rows {
        let l = loop_of(text, kp, ki);
        let base = alone(&l);
        let wishes = [
            (Wish::Iae(iae * base.iae), iae),
            (Wish::Ise(ise * base.ise), ise),
            (Wish::Itae(itae * base.itae), itae),
            (Wish::EMax(e_max * base.e_max), e_max),
        ];
        for (wish, ratio) in wishes {
            let found = alpha_for(&l.0, &l.1, wish).unwrap_or_else(|e| panic!("{text} {wish:?}: {e}"));
            // The ratio is printed to half a unit of its fourth or fifth digit; alpha moves with a power of it
            // that the next decade of alpha shows: at least 0.25 here.
            let tolerance = 4.0 * 6e-5 / ratio * if alpha == 1.0 { 3.0 } else { 1.0 };
            assert!((found / alpha - 1.0).abs() < tolerance, "{text} {wish:?}: {found}");
        }
    }
}

#[test]
fn the_largest_alpha_is_found_where_indices_are_not_monotonic() {
    // Tight PI loops (Ms0 = 2): humps and dips of all indices; a high gain gives resonances.
    let loops = [
        loop_of("exp(-90*s)/(1+10*s)", 0.266519128, 0.00869073746),
        loop_of("exp(-20*s)/(1+80*s)", 2.02428791, 0.0521097579),
        loop_of("-3*(1-0.5*s)/((1+s)^2*(1+0.2*s))", -0.4, -0.25),
    ];
    for l in &loops {
        let base = alone(l);
        let time = base.itae / base.iae;
        let grid: Vec<(f64, Indices)> = (0..1400)
            .map(|i| 200.0 * time * 10_f64.powf(-f64::from(i) / 200.0))
            .map(|alpha| (alpha, with(l, alpha)))
            .collect();
        for share in [1.7, 1.45, 1.4, 1.2, 0.99, 0.9] {
            type Index = fn(&Indices) -> f64;
            let wishes: [(Wish, Index); 3] = [
                (Wish::Iae(share * base.iae), |i| i.iae),
                (Wish::Ise(share * base.ise), |i| i.ise),
                (Wish::Itae(share * base.itae), |i| i.itae),
            ];
            for (wish, of) in wishes {
                let wanted = share * of(&base);
                let first = grid.iter().position(|(_, i)| of(i) <= wanted);
                match (alpha_for(&l.0, &l.1, wish), first) {
                    (Ok(alpha), Some(i)) => {
                        assert!(of(&with(l, alpha)) <= wanted * (1.0 + 1e-6), "{wish:?} {alpha}");
                        // Between the first grid point that attains it and the one before.
                        assert!(alpha >= grid[i].0 * 0.999_999, "{wish:?}: {alpha} {:?}", grid[i]);
                        assert!(i == 0 || alpha <= grid[i - 1].0 * 1.001, "{wish:?}: {alpha} {:?}", grid[i]);
                    }
                    (Err(Refusal::Unattainable { asked, least, .. }), None) => {
                        let seen = grid.iter().map(|(_, i)| of(i)).fold(f64::INFINITY, f64::min);
                        assert!(
                            asked == wanted && least > wanted && least <= seen * 1.001,
                            "{wish:?} {least} {seen}"
                        );
                    }
                    (Err(Refusal::NoSolution { .. }), Some(0)) => {}
                    (result, first) => panic!("{wish:?}: {result:?}, {first:?}"),
                }
            }
        }
    }
}

#[test]
fn the_ramp_has_a_closed_form() {
    for (text, kp, ki, least, order) in [
        ("exp(-20*s)/(1+80*s)", 0.7, 0.0115, 20.0, 1.0),
        ("-2*(1-3*s)*exp(-5*s)/((1+10*s)*(1+4*s))", -0.3, -0.03, 8.0, 2.0),
        ("(1-0.4*s+0.5*s^2)*(1+0.1*s)/(1+s)^4", 0.3, 0.15, 0.4, 3.0),
    ] {
        let l = loop_of(text, kp, ki);
        let wish = 1.7 * least / ki.abs();
        let alpha = alpha_for(&l.0, &l.1, Wish::RampIe(wish)).expect("attainable");
        assert!((alpha - 0.7 * least / order).abs() < 1e-9 * alpha, "{alpha}");
        let ramp = ContinuousResponse::with_alpha(&l.0, &l.1, alpha).and_then(|r| r.indices(Load::Ramp));
        assert!((ramp.expect("stable").ie.abs() / wish - 1.0).abs() < 1e-9);
        let refusal = alpha_for(&l.0, &l.1, Wish::RampIe(0.9 * least / ki.abs())).expect_err("too little");
        let Refusal::Unattainable { least: told, .. } = refusal else { panic!("{refusal}") };
        assert!((told * ki.abs() / least - 1.0).abs() < 1e-12);
    }
}

#[test]
fn scales_do_not_matter() {
    let l = loop_of("exp(-0.2*s)/(1+s)", 1.0, 1.2);
    let alpha = alpha_for(&l.0, &l.1, Wish::Iae(0.5 * alone(&l).iae)).expect("attainable");
    for (time, gain) in [(1e-6, -1e9), (1e6, 1e-9)] {
        let text = format!("{gain:e}*exp(-{:e}*s)/(1+{time:e}*s)", 0.2 * time);
        let scaled = loop_of(&text, 1.0 / gain, 1.2 / gain / time);
        let wish = Wish::Iae(0.5 * alone(&scaled).iae);
        let found = alpha_for(&scaled.0, &scaled.1, wish).expect("attainable") / time;
        assert!((found / alpha - 1.0).abs() < 1e-6, "{found} {alpha}");
    }
}

#[test]
fn without_dead_time_every_wish_can_be_met() {
    let l = loop_of("1/((1+s)*(1+0.3*s)*(1+0.1*s))", 1.2, 1.0);
    for share in [0.5, 0.1, 1e-3] {
        let wanted = share * alone(&l).iae;
        let alpha = alpha_for(&l.0, &l.1, Wish::Iae(wanted)).expect("attainable");
        assert!((with(&l, alpha).iae / wanted - 1.0).abs() < 1e-6);
    }
}

#[test]
fn wishes_without_meaning_are_refused() {
    let l = loop_of("exp(-0.2*s)/(1+s)", 1.0, 1.2);
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(alpha_for(&l.0, &l.1, Wish::Iae(value)), Err(Refusal::OutOfRange { .. })));
    }
    // The first peak is over before an observer of a loop with a long dead time does anything.
    let slow = loop_of("exp(-90*s)/(1+10*s)", 0.100985197, 0.00274121568);
    let refusal = alpha_for(&slow.0, &slow.1, Wish::EMax(0.9)).expect_err("unattainable");
    assert!(
        matches!(refusal, Refusal::Unattainable { least, .. } if (least - 1.0).abs() < 1e-3),
        "{refusal}"
    );
    let lax = alpha_for(&slow.0, &slow.1, Wish::Iae(1e9)).expect_err("none needed");
    assert!(lax.to_string().contains("however slow"));
    let unstable = loop_of("exp(-s)/(1+s)", 5.0, 1.0);
    assert!(alpha_for(&unstable.0, &unstable.1, Wish::Iae(1.0)).is_err());
}
