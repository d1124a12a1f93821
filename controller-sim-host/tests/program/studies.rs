//! The pages of `identify`, `assess` and `analyze`: of one family, complete, well formed, asking for nothing outside.

use crate::folder::Folder;
use roxmltree::{Document, Node};
use std::fmt::Write;

/// A page for each kind of study, and one of several cases.
fn pages(name: &str) -> Vec<(&'static str, String)> {
    let folder = Folder::new(name);
    let mut log = String::from("t,u,y\n");
    for row in 0..600 {
        let t = 0.25 * f64::from(row);
        let u = if t < 20.0 { 10 } else { 30 };
        let y = 25.0 + 40.0 * (1.0 - (-(t - 21.5).max(0.0) / 8.0).exp());
        let _ = writeln!(log, "{t},{u},{y:.6}");
    }
    folder.write("step.csv", &log);
    folder.done(&["demo", "load-experiment", "--csv", "loop.csv", "--quiet"]);
    let demo = include_str!("../../scenarios/demo.toml");
    folder.write("demo.toml", demo);
    folder.write("sweep.toml", &format!("{demo}\n[sweep]\nkey = \"latency\"\nvalues = [0.0, 0.05]\n"));
    let kinds: [(&str, &[&str]); 4] = [
        ("identify", &["identify", "step.csv"]),
        ("assess", &["assess", "loop.csv", "--controller", "well tuned"]),
        ("analyze", &["analyze", "demo.toml"]),
        ("sweep", &["analyze", "sweep.toml"]),
    ];
    let page = |(kind, words): (&'static str, &[&str])| {
        folder.done(&[words, &["--report", "page.html", "--force"]].concat());
        (kind, folder.read("page.html"))
    };
    kinds.into_iter().map(page).collect()
}

/// The page as XML: what HTML leaves open is closed.
fn xml(page: &str) -> String {
    let mut text = page.replacen("<!DOCTYPE html>", "", 1);
    for tag in ["<meta ", "<br"] {
        text = text
            .split(tag)
            .enumerate()
            .map(|(i, part)| if i == 0 { part.to_owned() } else { part.replacen('>', "/>", 1) })
            .collect::<Vec<_>>()
            .join(tag);
    }
    text
}

fn named<'a, 'b>(document: &'a Document<'b>, tag: &'a str) -> impl Iterator<Item = Node<'a, 'b>> {
    document.descendants().filter(move |node| node.tag_name().name() == tag)
}

fn words(node: Node<'_, '_>) -> String {
    node.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect()
}

fn has_class(node: Node<'_, '_>, class: &str) -> bool {
    node.attribute("class").is_some_and(|list| list.split(' ').any(|one| one == class))
}

#[test]
fn all_pages_have_one_frame() {
    let mut frames: Vec<(String, String)> = Vec::new();
    for (kind, page) in pages("studies-frame") {
        let text = xml(&page);
        let document = Document::parse(&text).unwrap_or_else(|error| panic!("{kind}: {error}"));
        for (tag, count) in [("h1", 1), ("main", 1), ("header", 1), ("footer", 1), ("title", 1), ("style", 1)]
        {
            let here =
                named(&document, tag).filter(|n| n.ancestors().all(|up| up.tag_name().name() != "svg"));
            assert_eq!(here.count(), count, "{kind}: {tag}");
        }
        let heading = words(named(&document, "h1").next().expect("a heading"));
        assert_eq!(words(named(&document, "title").next().expect("a title")), heading, "{kind}");
        let footer = words(named(&document, "footer").next().expect("a footer"));
        let command = footer.strip_prefix("How this page was made").expect("what made it");
        assert!(command.starts_with("controller-sim "), "{kind}: {footer}");
        assert!(
            footer.ends_with(&format!("controller-sim {}", env!("CARGO_PKG_VERSION"))),
            "{kind}: {footer}"
        );
        let style = words(named(&document, "style").next().expect("a style"));
        let head = page.split("<title>").next().expect("a head").to_owned();
        frames.push((head, style));
    }
    assert!(frames.windows(2).all(|pair| pair[0] == pair[1]), "another head or style");
}

#[test]
fn nothing_is_asked_of_a_network_and_no_number_is_none() {
    for (kind, page) in pages("studies-outside") {
        for word in ["http", "//", "<script", "<link", "<img", " src=", "url(", "@import", "NaN", "inf "] {
            assert!(!page.contains(word), "{kind}: {word}");
        }
        assert!(page.len() < 700_000, "{kind}: {}", page.len());
        let text = xml(&page);
        let document = Document::parse(&text).expect("well formed");
        for node in document.descendants() {
            for name in ["d", "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "width", "height"] {
                let value = node.attribute(name).unwrap_or("");
                assert!(!value.contains("inf"), "{kind}: {name}={value}");
            }
        }
    }
}

#[test]
fn every_reference_has_a_target_and_no_name_is_there_twice() {
    for (kind, page) in pages("studies-names") {
        let text = xml(&page);
        let document = Document::parse(&text).expect("well formed");
        let mut ids: Vec<&str> = document.descendants().filter_map(|n| n.attribute("id")).collect();
        let count = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), count, "{kind}: each once");
        let name = |list: &str| -> String {
            let one = |id: &str| document.descendants().find(|n| n.attribute("id") == Some(id)).map(words);
            list.split(' ').map(|id| one(id).unwrap_or_else(|| panic!("{kind}: {id}"))).collect()
        };
        // Regions that scroll are told from one another, and reached by the keyboard.
        let regions: Vec<Node<'_, '_>> =
            document.descendants().filter(|n| n.attribute("role") == Some("region")).collect();
        let mut names: Vec<String> =
            regions.iter().map(|n| name(n.attribute("aria-labelledby").expect("a name"))).collect();
        assert!(
            regions.iter().all(|n| n.attribute("tabindex") == Some("0") && has_class(*n, "scroll")),
            "{kind}"
        );
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{kind}: {names:?}");
        // So are the pictures.
        let pictures: Vec<Node<'_, '_>> =
            document.descendants().filter(|n| n.attribute("role") == Some("img")).collect();
        assert_eq!(pictures.len(), named(&document, "figure").count(), "{kind}");
        for picture in pictures {
            assert!(!name(picture.attribute("aria-labelledby").expect("a name")).is_empty(), "{kind}");
        }
        for figure in named(&document, "figure") {
            assert!(has_class(figure, "plot"), "{kind}");
            assert!(figure.descendants().any(|n| has_class(n, "legend")), "{kind}: no legend");
            assert!(figure.descendants().any(|n| n.tag_name().name() == "figcaption"), "{kind}: no caption");
        }
        for table in named(&document, "table") {
            let parent = table.parent().expect("a place");
            assert!(has_class(parent, "scroll"), "{kind}");
        }
    }
}

#[test]
fn what_a_reader_looks_for_is_marked() {
    let list = pages("studies-marks");
    for (kind, parts) in [
        ("identify", &["change", "settled", "tail", "Residual: record less model", "time t [s]", "A5"][..]),
        (
            "assess",
            &["P1", "dip", "P3", "t1 = 52.49 s", "t_dip = 108.9 s", "time t [s]", "Controller output u"],
        ),
        (
            "analyze",
            &[
                "unit circle",
                "circles of Ms",
                "Re L",
                "Im L",
                "Phase of L [\u{b0}]",
                "frequency [rad/s]",
                "\u{3c0}/ts",
                "\u{3c0}/(2 ts)",
            ],
        ),
    ] {
        let page = &list.iter().find(|(name, _)| *name == kind).expect("a page").1;
        let text = xml(page);
        let document = Document::parse(&text).expect("well formed");
        let mut texts: Vec<String> = named(&document, "text").map(words).collect();
        texts.extend(named(&document, "th").map(words));
        for part in parts {
            assert!(texts.iter().any(|text| text.starts_with(part)), "{kind}: {part}, {texts:?}");
        }
    }
}

/// The picture of the loop gain in the plane: its units are equally long on both axes, its margins are where they are said
/// to be, and nothing lies outside.
#[test]
fn the_nyquist_plot_is_true() {
    let list = pages("studies-nyquist");
    let text = xml(&list[2].1);
    let document = Document::parse(&text).expect("well formed");
    let plot = document.descendants().find(|n| has_class(*n, "nyquist")).expect("a Nyquist plot");
    let number = |node: Node<'_, '_>, name: &str| -> f64 {
        node.attribute(name).and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("{name}"))
    };
    let view: Vec<f64> =
        plot.attribute("viewBox").expect("a view").split(' ').map(|x| x.parse().expect("a number")).collect();
    let of = |class: &'static str| plot.descendants().filter(move |n| has_class(*n, class));
    let unit = of("level").next().expect("the unit circle");
    let (cx, cy, r) = (number(unit, "cx"), number(unit, "cy"), number(unit, "r"));
    // The tick at 1 of each axis.
    let tick = |class: &'static str, name: &str, other: &str| {
        let found = of(class).find(|n| words(*n) == "1" && number(*n, other) != 0.0).expect("a tick");
        number(found, name)
    };
    assert!((tick("t", "x", "y") - (cx + r)).abs() < 0.02);
    assert!((tick("n", "y", "x") - 4.0 - (cy - r)).abs() < 0.02);
    // The circles of Ms lie around -1.
    for circle in of("applied") {
        assert!((number(circle, "cx") - (cx - r)).abs() < 0.02 && (number(circle, "cy") - cy).abs() < 0.02);
        assert!(number(circle, "r") < r, "1/Ms is below 1");
    }
    // A gain margin lies on the real axis, a phase margin on the unit circle.
    let points: Vec<Node<'_, '_>> = of("point").collect();
    assert_eq!(points.len(), 6, "two of each of three controllers");
    for point in points {
        let (x, y) = ((number(point, "cx") - cx) / r, (number(point, "cy") - cy) / r);
        let (axis, circle) = (y.abs() < 0.001 && x < 0.0, (x.hypot(y) - 1.0).abs() < 0.001);
        assert!(axis || circle, "{x} {y}");
    }
    for path in plot.descendants().filter(|n| n.tag_name().name() == "path") {
        let d = path.attribute("d").expect("a path");
        let places: Vec<f64> = d.split(['M', 'L', ' ', 'h', 'v']).filter_map(|x| x.parse().ok()).collect();
        if has_class(path, "ref") {
            continue;
        }
        for place in places.chunks_exact(2) {
            assert!(place[0] >= -0.1 && place[0] <= view[0] + view[2], "{place:?}");
            assert!(place[1] >= -0.1 && place[1] <= view[1] + view[3], "{place:?}");
        }
    }
}

/// The phase margin is drawn from an odd half turn to the phase where the gain is 1, the gain margin from 1.
#[test]
fn the_margins_are_measured_from_their_levels() {
    let list = pages("studies-margins");
    let text = xml(&list[2].1);
    let document = Document::parse(&text).expect("well formed");
    let bode =
        document.descendants().find(|n| n.attribute("id") == Some("loop-1-bode")).expect("a Bode plot");
    let levels: Vec<&str> = bode
        .descendants()
        .filter(|n| has_class(*n, "axis") && n.attribute("y1") == n.attribute("y2"))
        .filter_map(|n| n.attribute("y1"))
        .collect();
    let spans: Vec<&str> =
        bode.descendants().filter(|n| has_class(*n, "span")).filter_map(|n| n.attribute("y1")).collect();
    assert_eq!(spans.len(), 6, "{spans:?}");
    assert!(spans.iter().all(|y| levels.contains(y)), "{spans:?} {levels:?}");
}
