//! Figures 4 and 5 of Tena, Penarrocha-Alos and Sanchis (2022), and the pages about disturbance observers.

use super::page::{Page, mentions, near, quiet};
use controller_sim_host::simulate::Metrics;
use controller_tests::oracle::dob_cases::{CASES, DobCase};

/// The reference's own sampling error of the ratios at 100 samples per dead time \[%\]: IAE, ISE, ITAE, e_max, TV.
const SAMPLING_ERROR: [f64; 5] = [0.7, 1.2, 0.8, 0.4, 0.5];
const STEP: &str = "step 0 to 1";
const RAMP: &str = "ramp of 0.01 a second";

fn name(case: &DobCase) -> String {
    format!("dob-fig-04-05-plant-{}-ms-{:.1}", case.plant_number, case.ms0)
}

fn indices(m: &Metrics) -> [f64; 5] {
    [m.iae, m.ise, m.itae, m.e_max, m.tv]
}

/// The ratio of each index to that of the PI alone after the step.
fn ratios(page: &Page, controller: &str) -> [f64; 5] {
    let (with, alone) = (indices(&page.after(STEP, controller)), indices(&page.after(STEP, "PI")));
    [0, 1, 2, 3, 4].map(|i| with[i] / alone[i])
}

#[test]
fn the_step_ratios_are_the_true_ones() {
    for case in &CASES {
        let page = Page::new(&name(case));
        assert!((page.scenario.ts / case.plant.dead_time - 0.01).abs() < 1e-12);
        for cell in &case.cells {
            let ours = ratios(&page, &format!("alpha = {}", cell.alpha));
            let r = &cell.ratios;
            let expected = [r.iae, r.ise, r.itae, r.e_max, r.tv];
            for i in 0..5 {
                let what = format!("{} alpha {} index {i}", name(case), cell.alpha);
                near(&what, ours[i], expected[i], SAMPLING_ERROR[i] / 100.0);
            }
        }
    }
}

/// With the observer the ramp leaves `IE = -slope D/ki` and no lasting error; the PI alone stays behind by `slope/ki`.
/// `D` is the mean delay of `C_u`: its pole, the dead time and the sample that a held output is late; `alpha + T + Ts/2`
/// to second order in `Ts`. Both events have 4000 s here, more than 14 time constants of the slowest loop (plant 3,
/// Ms 1.2: about `1/ki - T` = 275 s) and 40 of the slowest filter.
#[test]
fn the_ramp_leaves_what_the_closed_forms_say() {
    for case in &CASES {
        let mut scenario = Page::scenario(&name(case));
        scenario.events[1].at = scenario.events[0].at + 4000.0;
        scenario.duration = scenario.events[1].at + 4000.0;
        let page = Page::of(scenario);
        for cell in &case.cells {
            let who = format!("alpha = {}", cell.alpha);
            let ts = page.scenario.ts;
            let lag = ts / (ts / cell.alpha).exp_m1();
            let expected = -0.01 * (lag + case.plant.dead_time + ts) / case.ki;
            near(&format!("{} {who}", name(case)), page.after(RAMP, &who).ie, expected, 1e-5);
        }
        let behind = page.last("PI").y - page.last("PI").r;
        near(&name(case), behind, 0.01 / case.ki, 1e-4);
    }
}

#[test]
fn the_descriptions_of_the_figures_say_what_the_runs_give() {
    for (index, iae) in [
        (0, ["1.20", "0.411", "0.175"]),
        (1, ["0.858", "0.323", "0.229"]),
        (2, ["0.729", "0.529", "0.491"]),
        (3, ["1.57", "1.02", "0.592"]),
        (4, ["1.31", "0.865", "0.646"]),
        (5, ["1.48", "1.45", "1.37"]),
    ] {
        let page = Page::new(&name(&CASES[index]));
        for (alpha, figure) in [100, 10, 1].into_iter().zip(iae) {
            page.says(&[(figure, ratios(&page, &format!("alpha = {alpha}"))[0])]);
        }
        let behind = ["0.115", "0.867", "3.65", "0.0168", "0.192", "1.15"][index];
        page.says(&[(behind, 0.01 / CASES[index].ki)]);
    }
    let page = Page::new(&name(&CASES[0]));
    page.says(&[("0.861", ratios(&page, "alpha = 100")[3])]);
    let page = Page::new(&name(&CASES[1]));
    page.says(&[("1.33", ratios(&page, "alpha = 1")[4]), ("1.45", ratios(&page, "alpha = 100")[4])]);
    let page = Page::new(&name(&CASES[2]));
    page.says(&[("1", page.after(STEP, "alpha = 1").e_max)]);
    // Only alpha = 1 is a gain in IAE, and each is one in ISE.
    let page = Page::new(&name(&CASES[3]));
    let [a100, a10, a1] = [100, 10, 1].map(|alpha| ratios(&page, &format!("alpha = {alpha}")));
    assert!(a100[0] > 1.0 && a10[0] > 1.0 && a1[0] < 1.0);
    assert!(a100[1] < 1.0 && a10[1] < 1.0 && a1[1] < 1.0);
    let page = Page::new(&name(&CASES[4]));
    page.says(&[("1.60", ratios(&page, "alpha = 10")[4])]);
    let page = Page::new(&name(&CASES[5]));
    for (alpha, figure) in [(100, "1.44"), (10, "1.45"), (1, "1.33")] {
        let r = ratios(&page, &format!("alpha = {alpha}"));
        assert!(r[0] > 1.0 && r[1] > 1.0, "worse, whatever the filter");
        page.says(&[(figure, r[1])]);
    }
}

/// The gains of the page are the optimum of the reference for the tank and Ms = 1.2.
#[test]
fn ramps_on_the_tank() {
    let ki = 2.106_647_26 / 25.632_158_1;
    let quiet = Page::of(quiet(Page::scenario("dob-against-ramps")));
    let ramp = "slowly more";
    for (alpha, who) in [(40.0, "alpha = 40"), (10.0, "alpha = 10"), (2.5, "alpha = 2.5")] {
        // 400 s are ten time constants of the slowest filter.
        let expected = 0.02 * (alpha + 3.2 + 0.5 * quiet.scenario.ts) / ki;
        near(who, quiet.after(ramp, who).ie, expected, 1e-3);
        assert!(quiet.after("1 V lost", who).ie.abs() < 2e-3 / ki);
    }
    let before = quiet.samples("PI", 799.0, 800.0)[0];
    near("stays behind", before.r - before.y, 0.02 / ki, 1e-3);

    let page = Page::new("dob-against-ramps");
    page.says(&[("0.0822", ki), ("0.243", 0.02 / ki)]);
    for (who, figure) in
        [("alpha = 40", "10.6"), ("alpha = 10", "3.65"), ("alpha = 2.5", "1.83"), ("PI", "89.6")]
    {
        page.says(&[(figure, page.after(ramp, who).iae)]);
    }
    page.says(&[
        ("13.3", page.after("1 V lost", "alpha = 40").iae),
        ("13.4", page.after("1 V lost", "PI").iae),
    ]);
    // High-frequency gain: kp + tau/(K alpha).
    let gain = |alpha: f64| 2.106_647_26 + 80.3 / (1.98 * alpha);
    page.says(&[("3.1", gain(40.0)), ("6.2", gain(10.0)), ("18", gain(2.5))]);
    let tv = |who: &str| page.after(ramp, who).tv;
    assert!(
        tv("PI") < tv("alpha = 40")
            && tv("alpha = 40") < tv("alpha = 10")
            && tv("alpha = 10") < tv("alpha = 2.5")
    );
}

#[test]
fn one_late_sample() {
    let page = Page::new("latency");
    let after = |who: &str| page.after("disturbance", who);
    page.says(&[
        ("17", after("not told, alpha = 1").tv),
        ("2", after("not told, alpha = 4").tv),
        ("2", after("told, alpha = 0.7").tv),
    ]);
    page.says(&[("5.0", after("told, alpha = 0.7").iae), ("14.3", after("PI").iae)]);
    // Destroyed: at a limit, and at the other one with the next sample.
    let end = page.samples("not told, alpha = 0.7", 90.0, 130.0);
    let jumps = end.windows(2).filter(|w| (w[1].u - w[0].u).abs() > 7.9).count();
    assert!(jumps >= 30, "{jumps} jumps in 40 samples");
    // Calm: a hundredth of the range from sample to sample.
    let calm = page.samples("told, alpha = 0.7", 140.0, 160.0);
    assert!(calm.windows(2).all(|w| (w[1].u - w[0].u).abs() < 0.08));

    // Said as latency, all are calm.
    let told = [
        ("tf = \"1.98*exp(-4*s)", "tf = \"1.98*exp(-3*s)"),
        ("exp(-4*s)", "exp(-3*s)"),
        ("ts = 1.0", "ts = 1.0\nlatency = 1.0"),
    ];
    let page = Page::of(Page::edited("latency", &told));
    for controller in &page.result.controllers {
        let trace = page.samples(&controller.name, 60.0, 80.0);
        assert!(trace.windows(2).all(|w| (w[1].u - w[0].u).abs() < 0.08), "{}", controller.name);
    }
}

/// The limit that the page derives: `ts/alpha = ln 3`. The PI moves it a little: its gain at half the sampling frequency,
/// `kp K (ts/tau)/2 = 0.026`, against the 1 of the observer's loop; a shift of `ts/alpha` of about `0.026*4/3` (from
/// `d/dx 2(1-p)/(1+p) = 3/4` at `ln 3`).
#[test]
fn the_limit_of_the_late_sample() {
    mentions(&Page::scenario("latency"), "more than 1 from ts/alpha = ln 3 = 1.10 on");
    let limit = 3.0_f64.ln();
    for (ratio, grows) in [(limit - 0.07, false), (limit + 0.07, true)] {
        let alpha = format!("alpha = {} }}", 1.0 / ratio);
        let mut scenario = Page::edited(
            "latency",
            &[("alpha = 0.7 }", &alpha), ("lo = -4.0, hi = 4.0", "lo = -1e5, hi = 1e5")],
        );
        scenario.events.pop();
        let page = Page::of(scenario);
        let swing = |from: f64| {
            let part = page.samples("not told, alpha = 0.7", from, from + 20.0);
            part.windows(2).fold(0.0_f64, |a, w| a.max((w[1].u - w[0].u).abs()))
        };
        let (early, late) = (swing(60.0), swing(140.0));
        assert_eq!(late > early, grows, "ts/alpha = {ratio}: {early} then {late}");
    }
}

/// The sweep: IAE falls with alpha, TV rises.
#[test]
fn the_filter_of_an_observer() {
    let pages: Vec<Page> = Page::swept("observer-filter", &[]).into_iter().map(Page::of).collect();
    let after = |page: &Page, who: &str| page.after("disturbance", who);
    let figures = [("16.7", "54"), ("9.9", "85"), ("4.9", "211"), ("3.2", "708")];
    for (page, (iae, tv)) in pages.iter().zip(figures) {
        page.says(&[(iae, after(page, "DOB").iae), (tv, after(page, "DOB").tv)]);
        page.says(&[("13.5", after(page, "PI").iae), ("44", after(page, "PI").tv)]);
        assert_eq!(after(page, "PI"), after(&pages[0], "PI"));
    }
    assert_eq!(pages.len(), figures.len());
    let all = || pages.iter().map(|page| after(page, "DOB"));
    assert!(all().zip(all().skip(1)).all(|(a, b)| b.iae < a.iae && b.tv > a.tv && b.e_max < a.e_max));
    assert!(after(&pages[0], "DOB").iae > after(&pages[0], "PI").iae);
    assert!(after(&pages[0], "DOB").e_max < after(&pages[0], "PI").e_max);
}
