//! What a page and a picture consist of: well-formed, escaped, complete, of bounded size, always the same bytes.

mod report;

use controller_design::model::parse;
use controller_sim_host::output::run_table;
use controller_sim_host::report::{Chapter, figure, page};
use controller_sim_host::scenario::{Change, ControllerSpec, Event, Fault, Noise, Signal, Units};
use controller_sim_host::simulate::View;
use report::{Ran, ran, ran_in};
use roxmltree::{Document, Node};

const DEMO: &str = include_str!("data/report_demo.toml");
const SENSOR: &str = include_str!("data/report_sensor.toml");
const WINDUP: &str = include_str!("data/report_windup.toml");
const NAMESPACE: &str = "http://www.w3.org/2000/svg";

fn only(run: &Ran) -> String {
    page(&[run.chapter()], "controller-sim run")
}

/// The pictures of a page, each as a document.
fn pictures(page: &str) -> Vec<String> {
    let parts = page.split("<figure").skip(1).map(|part| {
        let start = part.find("<svg class=\"canvas\"").expect("a picture");
        let end = part.find("</figure>").expect("its end");
        let svg = &part[start..end];
        svg[..svg.rfind("</svg>").expect("its end") + "</svg>".len()].to_owned()
    });
    parts.collect()
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let texts = document.descendants().filter(|node| node.has_tag_name((NAMESPACE, "text")));
    texts.map(|node| node.descendants().filter_map(|n| n.text().filter(|_| n.is_text())).collect()).collect()
}

fn classes<'a>(node: &Node<'a, '_>) -> Vec<&'a str> {
    node.attribute("class").unwrap_or("").split(' ').collect()
}

#[test]
fn a_picture_has_its_title_its_words_and_its_labels() {
    let run = ran("demo.toml", DEMO, |s| {
        s.title = "Three controllers".to_owned();
        s.units = Units { y: "cm".to_owned(), u: "V".to_owned() };
        s.events[1].label = "a bucket".to_owned();
    });
    let text = figure(&run.chapter());
    let document = Document::parse(&text).expect("well formed");
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "svg");
    let child = |name: &str| root.children().find(|n| n.has_tag_name((NAMESPACE, name)));
    assert_eq!(child("title").and_then(|n| n.text()), Some("Three controllers, 0 s to 20 s"));
    let description = child("desc").and_then(|n| n.text()).expect("a description");
    for name in ["MOMI", "DRMO", "DE-MOMI"] {
        assert!(description.contains(&format!(" {name}: plant output ")), "{description}");
    }
    assert!(description.ends_with("Events: r = 1 cm at 0 s; a bucket at 10 s."), "{description}");

    let texts = texts(&document);
    for label in [
        "Three controllers",
        "set-point r, disturbance d",
        "Plant output y, set-point r [cm]",
        "Controller output u [V]",
        "Disturbance d, estimate d_hat [V]",
        "Output of the disturbance block u_f [V]",
        "time t [s]",
        "a bucket",
        "DE-MOMI",
        "DE-MOMI: Auto throughout",
    ] {
        assert!(texts.iter().any(|text| text == label), "{label} is not in {texts:?}");
    }
    // The names of what is drawn refer to something.
    for id in root.attribute("aria-labelledby").expect("named").split(' ') {
        assert!(document.descendants().any(|n| n.attribute("id") == Some(id)), "{id}");
    }
}

#[test]
fn a_run_without_units_and_disturbances_has_neither() {
    let run = ran("demo.toml", DEMO, |s| {
        s.events.truncate(1);
        s.controllers.truncate(2);
    });
    let text = figure(&run.chapter());
    let texts = texts(&Document::parse(&text).expect("well formed"));
    assert!(texts.contains(&"Plant output y, set-point r".to_owned()), "{texts:?}");
    assert!(texts.contains(&"set-point r".to_owned()), "{texts:?}");
    assert!(!texts.iter().any(|text| text.contains("isturbance")), "{texts:?}");
}

#[test]
fn texts_of_a_person_stay_texts() {
    let evil = "<script>alert(1)</script>\"'><img src=x onerror=y>&amp;</svg></style>";
    let mut run = ran("demo.toml", DEMO, |s| {
        s.title = evil.to_owned();
        s.description = format!("{evil}\n\n{evil}");
        s.units = Units { y: "<b>&\"".to_owned(), u: "</text>".to_owned() };
        s.events[0].label = evil.to_owned();
        s.controllers[0].name = evil.to_owned();
    });
    run.name = evil.to_owned();
    run.case = Some(format!("{evil} = 1"));
    run.text = format!("# {evil}\n{DEMO}");
    let warnings = [Fault::new("sign", 0..1, evil).help(evil)];
    let chapter = Chapter { warnings: &warnings, ..run.chapter() };
    let second = Chapter { case: Some("<i> = 2"), ..chapter };
    let text = page(&[chapter, second], evil);
    for forbidden in ["<script", "<img", "<b>", "<i>", "&amp;amp;&lt;/svg&gt;&amp;"] {
        assert!(!text.contains(forbidden), "{forbidden}");
    }
    assert_eq!(text.matches("</style>").count(), 1);
    for picture in pictures(&text) {
        let document = Document::parse(&picture).expect("well formed");
        assert!(document.descendants().any(|n| n.text().is_some_and(|text| text.contains(evil))));
    }
    let picture = figure(&chapter);
    let document = Document::parse(&picture).expect("well formed");
    assert!(document.descendants().all(|n| n.tag_name().name() != "script"));
    assert!(document.root_element().descendants().any(|n| n.text().is_some_and(|t| t.contains(evil))));
}

#[test]
fn nothing_is_asked_of_a_network() {
    let runs = [ran("a.toml", DEMO, |_| {}), ran("b.toml", SENSOR, |_| {})];
    let text = page(&[runs[0].chapter(), runs[1].chapter()], "controller-sim run a.toml b.toml");
    let svg = figure(&runs[0].chapter()).replacen(NAMESPACE, "", 1);
    for text in [text, svg] {
        for word in
            ["http", "//", "<script", "<link", "<img", "<image", "<iframe", " src=", "url(", "@import"]
        {
            assert!(!text.contains(word), "{word}");
        }
        for reference in text.split("href=\"").skip(1) {
            assert!(reference.starts_with('#'), "{}", &reference[..20.min(reference.len())]);
        }
    }
}

#[test]
fn every_reference_on_a_page_has_a_target_and_no_name_is_there_twice() {
    let runs = sweep();
    let chapters: Vec<Chapter<'_>> = runs.iter().map(Ran::chapter).collect();
    let text = page(&chapters, "controller-sim run");
    let values = |key: &str| {
        let parts = text.split(key).skip(1);
        parts.map(|part| part.split('"').next().unwrap_or("").to_owned()).collect::<Vec<_>>()
    };
    let mut ids = values(" id=\"");
    let count = ids.len();
    ids.sort();
    ids.dedup();
    assert_eq!(ids.len(), count, "each once");
    let links = values("href=\"#").into_iter();
    let names = values("labelledby=\"").into_iter();
    let names = names.flat_map(|list| list.split(' ').map(str::to_owned).collect::<Vec<_>>());
    for target in links.chain(names) {
        assert!(ids.contains(&target), "{target}");
    }
    assert_eq!(text.matches("<h1").count(), 1);
    assert_eq!(text.matches("<main").count(), 1);
    assert_eq!(text.matches("<nav").count(), 1);
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let run = || ran("a.toml", SENSOR, |_| {});
    let (a, b) = (run(), run());
    assert_eq!(only(&a), only(&b));
    assert_eq!(figure(&a.chapter()), figure(&b.chapter()));
    // A run with fewer samples than columns is drawn exactly, whatever their number.
    let exact = |columns| {
        let whole = |s: &controller_sim_host::scenario::Scenario| View { columns, ..View::whole(s.duration) };
        ran_in("a.toml", SENSOR, |s| s.duration = 510.0, whole)
    };
    assert_eq!(only(&exact(1020)), only(&exact(5000)));
}

#[test]
fn pages_are_small() {
    let demo = ran("demo.toml", DEMO, |_| {});
    assert!(only(&demo).len() < 300_000, "{}", only(&demo).len());
    let long = ran("long.toml", DEMO, |s| {
        s.ts = 0.001;
        s.duration = 1000.0;
        s.substeps = 1;
        s.noise = Some(Noise { std: 0.02, seed: 1 });
    });
    assert!(only(&long).len() < 1_000_000, "{}", only(&long).len());
    let busy = ran("busy.toml", DEMO, |s| {
        s.duration = 400.0;
        let step = |n: u32| Change::Disturbance(Signal::Step(f64::from(n % 7)));
        let event = |n: u32| Event {
            at: 10.0 + 0.03 * f64::from(n),
            label: String::new(),
            changes: vec![step(n)],
            controller: None,
        };
        s.events.extend((1..12_000).map(event));
    });
    assert!(only(&busy).len() < 1_000_000, "{}", only(&busy).len());
}

#[test]
fn the_shortest_disturbance_of_a_long_run_is_drawn_in_full_height() {
    let run = ran("long.toml", DEMO, |s| {
        s.ts = 0.001;
        s.duration = 1000.0;
        s.substeps = 1;
        s.controllers.truncate(1);
        let pulse = Signal::Pulse { height: 1.0, duration: 0.001 };
        s.events[1].at = 654.321;
        s.events[1].changes = vec![Change::Disturbance(pulse)];
    });
    let text = figure(&run.chapter());
    let document = Document::parse(&text).expect("well formed");
    let areas: Vec<&str> = document
        .descendants()
        .filter(|n| n.has_tag_name((NAMESPACE, "path")))
        .filter(|n| classes(n).starts_with(&["a", "ref"]))
        .filter_map(|n| n.attribute("d"))
        .collect();
    // One band of the 1000; 0 to 1 with 6 % of room at both ends are 112 % of the panel's 120 px.
    let height = format!("{:.2}", 120.0 / 1.12);
    assert_eq!(areas.len(), 1, "{areas:?}");
    assert!(areas[0].starts_with("M654 ") && areas[0].contains(&format!("h1v{height}h-1z")), "{areas:?}");
}

#[test]
fn no_path_has_a_number_that_is_none() {
    let unstable = ran("unstable.toml", DEMO, |s| {
        s.plant = parse("exp(-0.2*s)/((1-0.2*s)*(1+s))").expect("a plant");
        s.duration = 300.0;
    });
    let one = ran("one.toml", DEMO, |s| s.duration = s.ts);
    let still = ran("still.toml", DEMO, |s| s.events.clear());
    for run in [unstable, one, still] {
        let text = figure(&run.chapter());
        let document = Document::parse(&text).expect("well formed");
        for path in document.descendants().filter(|n| n.has_tag_name((NAMESPACE, "path"))) {
            let d = path.attribute("d").expect("a path");
            assert!(!d.is_empty() && d.chars().all(|c| "Mhvlz 0123456789.-".contains(c)), "{d}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf"), "{}", run.name);
    }
}

#[test]
fn the_table_marks_the_same_numbers_as_the_terminal() {
    let run = ran("demo.toml", DEMO, |_| {});
    let terminal = run_table(&run.chapter());
    let page = only(&run);
    let best: Vec<&str> = page
        .split("<td class=\"best\"><strong>")
        .skip(1)
        .map(|part| part.split('<').next().unwrap_or(""))
        .collect();
    let marked: Vec<&str> = terminal
        .lines()
        .filter(|line| line.starts_with("  "))
        .flat_map(str::split_whitespace)
        .filter_map(|word| word.strip_suffix('*'))
        .collect();
    assert_eq!(best, marked);
    assert!(best.len() > 10, "{best:?}");
}

#[test]
fn modes_and_status_that_occur_are_named() {
    let run = ran("sensor.toml", SENSOR, |_| {});
    let text = figure(&run.chapter());
    let texts = texts(&Document::parse(&text).expect("well formed"));
    for label in ["Fallback", "bad input", "held", "await ack.", "rate limit", "mode"] {
        assert!(texts.iter().any(|text| text == label), "{label} is not in {texts:?}");
    }
    for label in ["overrun", "alarm HH", "limited hi", "Manual"] {
        assert!(!texts.iter().any(|text| text == label), "{label} is in {texts:?}");
    }
}

#[test]
fn bad_samples_leave_gaps_in_the_measurement() {
    let run = ran("sensor.toml", SENSOR, |_| {});
    let text = figure(&run.chapter());
    let document = Document::parse(&text).expect("well formed");
    let line =
        document.descendants().find(|n| classes(n).starts_with(&["l", "faint"]) && n.has_attribute("d"));
    let line = line.and_then(|n| n.attribute("d")).expect("the measurement");
    // 60 bad samples; the two at 200 s share their bands with none or one good sample.
    assert!((2..=3).contains(&line.matches('M').count()), "{}", line.matches('M').count());
}

#[test]
fn limits_are_drawn_when_they_are_near() {
    let levels = |run: &Ran| figure(&run.chapter()).matches("class=\"level").count();
    // 0 and 1.5, the same for all controllers; the 3 of the end is twice what any of them gives.
    assert_eq!(levels(&ran("windup.toml", WINDUP, |_| {})), 2);
    let different = |s: &mut controller_sim_host::scenario::Scenario| s.controllers[2].config.limits.hi = 1.4;
    assert_eq!(levels(&ran("windup.toml", WINDUP, different)), 4, "0 of all, and three upper ones");
    // -100 and 100 around outputs of about 4.
    assert_eq!(levels(&ran("demo.toml", DEMO, |_| {})), 0);
}

#[test]
fn a_part_of_a_run_says_so() {
    let part = ran_in("windup.toml", WINDUP, |_| {}, |_| View { from: 9.0, to: 14.0, columns: 1000 });
    assert!(only(&part).contains("Only 9 s to 14 s of 30 s."));
    let text = figure(&part.chapter());
    let texts = texts(&Document::parse(&text).expect("well formed"));
    assert!(texts.contains(&"2".to_owned()) && !texts.contains(&"1".to_owned()), "{texts:?}");
    let whole = ran("windup.toml", WINDUP, |_| {});
    assert!(!only(&whole).contains("Only "));
}

#[test]
fn warnings_and_remarks_stand_above_the_picture() {
    let run = ran("sensor.toml", SENSOR, |_| {});
    let at = SENSOR.find("latency").expect("a key");
    let warnings = [Fault::new("sign", at..at + 1, "`latency` looks odd").help("have a look")];
    let text = page(&[Chapter { warnings: &warnings, ..run.chapter() }], "controller-sim run");
    let picture = text.find("<figure").expect("a picture");
    for note in ["Line 7: `latency` looks odd (have a look)", "in fallback for 56 samples"] {
        assert!(text.find(note).is_some_and(|place| place < picture), "{note}");
    }
}

#[test]
fn the_scenario_and_the_command_are_on_the_page() {
    let run = ran("demo.toml", DEMO, |_| {});
    let command = "controller-sim run demo.toml --report \"a b.html\"";
    let text = page(&[run.chapter()], command);
    assert!(text.contains("controller-sim run demo.toml --report &quot;a b.html&quot;"));
    assert!(text.contains("estimator = { gain = 1.0, a1 = 1.2"));
    assert!(text.contains(&format!("controller-sim {}", env!("CARGO_PKG_VERSION"))));
}

fn sweep() -> Vec<Ran> {
    let cases = [0.0, 0.05, 0.1].into_iter().map(|latency| {
        let mut run = ran("latency.toml", DEMO, |s| s.latency = latency);
        run.case = Some(format!("latency = {latency}"));
        run
    });
    cases.collect()
}

#[test]
fn a_sweep_has_an_overview_and_its_text_once() {
    let runs = sweep();
    let chapters: Vec<Chapter<'_>> = runs.iter().map(Ran::chapter).collect();
    let text = page(&chapters, "controller-sim run");
    let pictures = pictures(&text);
    assert_eq!(pictures.len(), 4);
    let overview = Document::parse(&pictures[0]).expect("well formed");
    let points = overview.descendants().filter(|n| classes(n).contains(&"point")).count();
    assert_eq!(points, 9);
    assert_eq!(text.matches("<details").count(), 1);

    let mut named = sweep();
    for (run, case) in named.iter_mut().zip(["method = none", "method = back", "method = other"]) {
        run.case = Some(case.to_owned());
    }
    let chapters: Vec<Chapter<'_>> = named.iter().map(Ran::chapter).collect();
    assert!(!page(&chapters, "controller-sim run").contains("swept"));
}

#[test]
fn a_cascade_shows_its_inner_loop() {
    let run = ran("cascade.toml", DEMO, |s| {
        s.inner_plant = Some(parse("1/(1+0.2*s)").expect("a plant"));
        let pid = controller_core::PidConfig { kp: 2.0, ki: 5.0, ..Default::default() };
        s.controllers.truncate(1);
        s.controllers[0].secondary = Some(Box::new(ControllerSpec::pid("inner", pid)));
    });
    let text = figure(&run.chapter());
    let document = Document::parse(&text).expect("well formed");
    let texts = texts(&document);
    for label in ["Inner loop: output, set-point (thin)", "MOMI: Auto throughout"] {
        assert!(texts.iter().any(|text| text == label), "{label} is not in {texts:?}");
    }
    assert!(document.descendants().any(|n| classes(&n).contains(&"asked")));
    assert!(only(&run).contains("<th scope=\"col\">MOMI, inner loop</th>"));
}

#[test]
fn a_run_that_was_not_recorded_still_has_its_numbers() {
    let mut run = ran("demo.toml", DEMO, |_| {});
    for controller in &mut run.result.controllers {
        controller.record = None;
    }
    let text = only(&run);
    assert!(text.contains("there is no picture") && text.contains("0.1807"));
    Document::parse(&figure(&run.chapter())).expect("well formed");
}

/// The estimate begins at 0 at an operating point, and so does the disturbance beside it.
#[test]
fn a_disturbance_is_drawn_from_where_its_estimate_begins() {
    let run = ran("offset.toml", DEMO, |s| {
        s.initial.disturbance = 50.0;
        s.events.truncate(1);
        s.events[0] = Event {
            at: 5.0,
            label: String::new(),
            changes: vec![Change::Disturbance(Signal::Step(50.5))],
            controller: None,
        };
    });
    let text = figure(&run.chapter());
    let texts = texts(&Document::parse(&text).expect("well formed"));
    let title = "Disturbance d \u{2212} d(0), estimate d_hat";
    let at = texts.iter().position(|text| text == title).unwrap_or_else(|| panic!("{texts:?}"));
    let next = texts[at + 1..].iter().position(|text| text.starts_with("Output of")).expect("the next panel");
    let numbers: Vec<f64> = texts[at + 1..at + 1 + next]
        .iter()
        .map(|n| n.replace('\u{2212}', "-").parse().expect("a number"))
        .collect();
    assert!(numbers.len() >= 2 && numbers.iter().all(|n| n.abs() <= 1.0), "{numbers:?}");
    assert!(only(&run).contains("d(0) = 50: the estimate"));
}

/// The record of a load-response experiment on `exp(-s)/(1+s)` with a gain of 1 or -1.
fn experiment_page(gain: f64, noise: f64) -> String {
    use controller_design::assessment::{AssessOptions, Experiment, assess};
    let (kp, ti, ts) = (1.0194, 1.451, 0.02);
    let (mut y, mut i, mut u) = (0.0, 0.0, vec![0.0; 50]);
    let (mut t, mut pv, mut co) = (vec![], vec![], vec![]);
    for k in 0..2000_u32 {
        if (250..260).contains(&k) {
            i = 1.0 + kp * y
        } else {
            i -= kp * ts / ti * y
        }
        t.push(ts * f64::from(k));
        pv.push(gain * y);
        co.push(i - kp * y);
        u.push(i - kp * y);
        y += (u[k as usize] - y) * ts;
    }
    let setpoint = [0.0; 2000];
    let options = AssessOptions::default();
    let mut found = assess(&Experiment::new(&t, &setpoint, &pv, &co), &options).expect("a record");
    if let Some(features) = &mut found.features {
        features.sigma = noise;
    }
    let signals = controller_sim_host::report::Signals {
        t: &t,
        setpoint: &setpoint,
        output: &pv,
        input: &co,
        names: ("y", "u"),
    };
    let experiment = controller_sim_host::report::Experiment {
        name: "loop.csv",
        signals,
        assessment: &found,
        acceptance: options.acceptance,
    };
    controller_sim_host::report::assessment_page(&experiment, "controller-sim assess loop.csv")
}

#[test]
fn what_noise_could_have_drawn_is_not_marked_as_a_dip() {
    let (clear, noisy) = (experiment_page(1.0, 0.0), experiment_page(1.0, 0.2));
    assert!(clear.contains(">dip</text>") && clear.contains("t_dip = ") && !clear.contains("is not marked"));
    assert!(!noisy.contains(">dip</text>") && !noisy.contains("t_dip = ") && noisy.contains(">P1</text>"));
    assert!(noisy.contains("less than two standard deviations of the noise is not marked"));
}

#[test]
fn a_response_that_points_down_is_told_so() {
    let (up, down) = (experiment_page(1.0, 0.0), experiment_page(-1.0, 0.0));
    let said = "The first peak points down here, and so the dip points up.";
    assert!(!up.contains(said) && down.contains(said));
    for page in [up, down] {
        assert!(!page.contains("lowest") && !page.contains("highest"), "words of one direction");
    }
}
