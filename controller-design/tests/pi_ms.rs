//! The PI with the largest integral gain at a given sensitivity peak.

use controller_design::Refusal;
use controller_design::batch134::processes;
use controller_design::margins::ContinuousLoop;
use controller_design::model::{Complex, TransferFunction, parse};
use controller_design::rules::PiMs;

fn plant(text: &str) -> TransferFunction {
    parse(text).unwrap_or_else(|e| panic!("{text}: {e:?}"))
}

fn design(text: &str, ms: f64) -> PiMs {
    PiMs::new(&plant(text), ms).unwrap_or_else(|e| panic!("{text}, ms {ms}: {e}"))
}

fn refused(text: &str, ms: f64) -> Refusal {
    match PiMs::new(&plant(text), ms) {
        Err(refusal) => refusal,
        Ok(design) => panic!("{text}, ms {ms}: {design:?}"),
    }
}

fn off(got: f64, want: f64) -> f64 {
    ((got - want) / want).abs()
}

/// Process, ms, kp, ki of `golden/pi_ms.csv` and, at 1.2, of `golden/observer_134.csv`.
fn golden() -> Vec<(String, f64, f64, f64)> {
    let cells = |row: &str| row.split(',').map(str::to_string).collect::<Vec<_>>();
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    let rows = |text: &'static str| text.lines().filter(|line| !line.starts_with('#'));
    let searched = rows(include_str!("golden/pi_ms.csv")).map(cells);
    let tabled = rows(include_str!("golden/observer_134.csv")).map(cells);
    let searched = searched.map(|c| (c[0].clone(), number(&c[1]), number(&c[2]), number(&c[3])));
    searched.chain(tabled.map(|c| (c[0].clone(), 1.2, number(&c[1]), number(&c[2])))).collect()
}

/// The 134 processes at three peaks: the peak by the margins of the loop, which also count encirclements, and the
/// gains against tables made without the ellipses (at 1.2 for all processes).
#[test]
fn all_134_processes_at_three_peaks() {
    let rows = golden();
    let (mut worst_ki, mut worst_kp, mut worst_ms, mut compared) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    for process in processes() {
        let plant = process.plant().expect("valid");
        for ms in [1.2, 1.4, 2.0] {
            let name = &process.name;
            let got = PiMs::new(&plant, ms).unwrap_or_else(|e| panic!("{name}: {e}"));
            let measured = ContinuousLoop::new(&plant, &got.pid).margins().expect("stable");
            assert!((measured.ms - ms).abs() < 1e-8, "{name}: {} for {ms}", measured.ms);
            assert!((got.ms - measured.ms).abs() < 1e-8, "{name}: {} {}", got.ms, measured.ms);
            worst_ms = worst_ms.max((measured.ms - ms).abs());
            for (_, _, kp, ki) in rows.iter().filter(|row| row.0 == *name && row.1 == ms) {
                assert!(off(got.pid.ki, *ki) < 2e-4, "{name} {ms}: ki {} for {ki}", got.pid.ki);
                assert!(off(got.pid.kp, *kp) < 5e-3, "{name} {ms}: kp {} for {kp}", got.pid.kp);
                worst_ki = worst_ki.max(off(got.pid.ki, *ki));
                worst_kp = worst_kp.max(off(got.pid.kp, *kp));
                compared += 1;
            }
        }
    }
    assert_eq!(compared, rows.len());
    println!("{compared} rows; worst: ki {worst_ki:.1e}, kp {worst_kp:.1e}, ms {worst_ms:.1e}");
}

/// Tables 1, 2 and 6 of Tena et al. 2022: the true optimum, to the digits that are known of it.
#[test]
fn tables_1_2_and_6_true_columns() {
    for (text, ms, kp, ki) in [
        ("exp(-5*s)/(1+95*s)", 1.2, 3.16418932, 0.0870833318),
        ("exp(-20*s)/(1+80*s)", 1.2, 0.696075276, 0.011533633),
        ("exp(-90*s)/(1+10*s)", 1.2, 0.100985197, 0.00274121568),
        ("1.98*exp(-3.2*s)/(1+80.3*s)", 1.2, 2.10664726, 0.0821876666),
        ("exp(-5*s)/(1+95*s)", 2.0, 9.33178522, 0.595653038),
        ("exp(-20*s)/(1+80*s)", 2.0, 2.02428791, 0.0521097579),
        ("exp(-90*s)/(1+10*s)", 2.0, 0.266519128, 0.00869073746),
        ("1.98*exp(-3.2*s)/(1+80.3*s)", 2.0, 6.21571202, 0.595441256),
    ] {
        let got = design(text, ms);
        assert!(off(got.pid.ki, ki) < 1e-7, "{text} {ms}: {:?}", got.pid);
        assert!(off(got.pid.kp, kp) < 1e-3, "{text} {ms}: {:?}", got.pid);
    }
}

/// The values published for 1/(1+s)^3 with MIGO (Åström, Panagopoulos and Hägglund 1998), to their digits.
#[test]
fn the_published_optimum_of_three_lags() {
    for (ms, kp, ti) in [(1.4, 0.633, 1.95), (2.0, 1.22, 1.78)] {
        let got = design("1/(1+s)^3", ms).pid;
        assert!((got.kp - kp).abs() < 0.005 && (got.kp / got.ki - ti).abs() < 0.01, "{ms}: {got:?}");
    }
}

/// Time and gain scales, both signs: the same design in other units.
#[test]
fn units_change_nothing() {
    let base = design("(1-0.2*s)*exp(-0.1*s)/((1+s)*(1+0.8*s+0.5*s^2))", 1.6);
    for time in [1e-6, 1e-3, 1.0, 1e6] {
        for gain in [1e-9, -1.0, 1e12, -1e-250, 1e250] {
            let t = |x: f64| x * time;
            let text = format!(
                "{gain}*(1-{}*s)*exp(-{}*s)/((1+{}*s)*(1+{}*s+{}*s^2))",
                t(0.2),
                t(0.1),
                t(1.0),
                t(0.8),
                t(t(0.5))
            );
            let got = design(&text, 1.6);
            assert!(off(got.pid.ki, base.pid.ki / gain / time) < 1e-9, "{text}: {:?}", got.pid);
            assert!(off(got.pid.kp, base.pid.kp / gain) < 1e-5, "{text}: {:?}", got.pid);
            assert!(off(got.omega, base.omega / time) < 1e-4, "{text}: {}", got.omega);
        }
    }
}

/// `max|S|` by a sweep that knows nothing of the design's grid.
fn swept_ms(plant: &TransferFunction, kp: f64, ki: f64, low: f64, high: f64) -> f64 {
    let n = 60_000;
    (0..=n).fold(0.0, |ms: f64, k| {
        let omega = low * libm::pow(high / low, f64::from(k) / f64::from(n));
        let l = plant.at(Complex::new(0.0, omega)) * Complex::new(kp, -ki / omega);
        ms.max(1.0 / (Complex::ONE + l).abs())
    })
}

/// Processes of other kinds: the peak is met on an independent sweep, the loop is stable, and no neighbouring `kp`
/// allows a larger `ki`.
#[test]
fn other_processes_are_at_their_optimum() {
    for text in [
        "1/(1+s)^8",
        "exp(-0.001*s)/(1+s)",
        "exp(-1e-6*s)/(1+s)",
        "exp(-1000*s)/(1+s)",
        "2*exp(-s)",
        "exp(-0.01*s)/s",
        "0.3*exp(-2*s)/(s*(1+5*s))",
        "(1+40*s)*exp(-s)/((1+s)*(1+20*s)*(1+2*s))",
        "(1+0.05*s)*exp(-0.3*s)/(1+s)^2",
        "(1-3*s)/(1+s)^2",
        "(1-s)*exp(-0.2*s)/(1+2*s)",
        "1/((1+s)*(1+0.1*s))",
        "1/((1+s)*(1+1e-4*s))",
        "1/(1+1.2*s+s^2)",
        "exp(-0.5*s)/(1+1.2*s+s^2)",
        "1/((1+5*s)*(1+0.04*s+0.04*s^2))",
        "exp(-0.3*s)*(1+0.02*s+0.01*s^2)/((1+s)*(1+0.5*s)^2)",
        "(2+s)*exp(-0.5*s)/(1+s)",
        "exp(-50*s)/((1+s)*(1+2e-3*s+0.01*s^2))",
        "1/(s*(1+s)*(1+0.1*s))",
    ] {
        let plant = plant(text);
        for ms in [1.1, 1.4, 2.0, 3.5] {
            let Ok(got) = PiMs::new(&plant, ms) else { panic!("{text} {ms}: {:?}", PiMs::new(&plant, ms)) };
            let margins = ContinuousLoop::new(&plant, &got.pid).margins();
            let margins = margins.unwrap_or_else(|e| panic!("{text} {ms}: {e} {got:?}"));
            assert!((margins.ms - ms).abs() < 1e-7, "{text} {ms}: {margins:?} {got:?}");
            let (low, high) = (got.omega * 1e-3, got.omega * 1e3);
            let swept = swept_ms(&plant, got.pid.kp, got.pid.ki, low, high);
            assert!(swept < ms * (1.0 + 1e-6) && swept > ms * 0.98, "{text} {ms}: swept {swept} {got:?}");
            for factor in [0.5, 0.8, 0.95, 0.99, 1.01, 1.05, 1.2] {
                let kp = got.pid.kp * factor;
                let pid = controller_core::PidConfig { kp, ki: got.pid.ki * 1.0001, ..got.pid };
                // Either not stable or above the limit.
                let ms_there = ContinuousLoop::new(&plant, &pid).margins().map_or(f64::INFINITY, |m| m.ms);
                assert!(ms_there > ms, "{text} {ms}: kp*{factor} allows more: {ms_there} {got:?}");
            }
        }
    }
}

#[test]
fn what_has_no_design_is_refused() {
    for text in ["1/(1+s)", "2/s", "-3/(1+0.1*s)", "(1+2*s)/((1+s)*(1+3*s))"] {
        for ms in [1.2, 2.0] {
            assert_eq!(
                refused(text, ms).to_string(),
                "the gains can grow without bound at this ms",
                "{text}"
            );
        }
    }
    for (text, message) in [
        ("1/s^2", "at most one integrator"),
        ("exp(-s)/(s^2*(1+s))", "at most one integrator"),
        ("1/(1-s)", "be stable"),
        ("exp(-s)/((1+s)*(s-0.1))", "be stable"),
        ("1/(1+s^2)", "undamped"),
        ("exp(-s)/(s*(1+4*s^2))", "undamped"),
        ("s/(1+s)^2", "zero at s = 0"),
        ("(1+s)/(1+2*s)", "more poles than zeros"),
        ("5+0*s", "more poles than zeros"),
    ] {
        let refusal = refused(text, 1.5);
        assert!(refusal.to_string().contains(message), "{text}: {refusal}");
        assert!(!refusal.help().is_empty());
    }
    for ms in [1.0, 0.5, -1.0, 5.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(refused("1/(1+s)^3", ms), Refusal::OutOfRange { parameter: "ms", .. }), "{ms}");
    }
    // Lightly damped: the best proportional gain is none.
    for text in ["exp(-s)/(1+0.3*s+s^2)", "exp(-0.2*s)/(1+0.1*s+s^2)"] {
        assert!(refused(text, 1.4).to_string().contains("proportional gain of 0 or less"), "{text}");
    }
    assert!(!design("1/((1+s)*(1+1e-4*s))", 2.0).warnings.is_empty());
    assert!(design("1/(1+s)^3", 2.0).warnings.is_empty());
}

/// Six zeros against an integrator: the gains are tiny, and so is the frequency where the loop crosses over.
#[test]
fn an_integrating_plant_with_a_crossover_far_below_its_time_constants() {
    for text in
        ["(1+0.05*s+s^2)*exp(-0.2*s)/(s*(1+0.01*s)^2)", "(1+10*s+100*s^2)*exp(-0.2*s)/(s*(1+0.01*s)^3)"]
    {
        for ms in [1.05, 1.4, 2.0] {
            if let Ok(got) = PiMs::new(&plant(text), ms) {
                let margins = ContinuousLoop::new(&plant(text), &got.pid).margins().expect("stable");
                assert!((margins.ms - ms).abs() < 1e-7, "{text} {ms}: {got:?} {margins:?}");
            }
        }
    }
}
