//! Colours that can be told from the paper, in both schemes: contrast as the accessibility guidelines define it.

const FIGURE: &str = include_str!("../src/report/style/figure.css");
const DIAGRAM: &str = include_str!("../src/report/style/diagram.css");
const PAGE: &str = include_str!("../src/report/style/page.css");
const DARK: &str = "@media screen and (prefers-color-scheme:dark)";

/// Relative luminance of `#rrggbb` or `#rgb`.
fn luminance(colour: &str) -> f64 {
    let digits = colour.trim_start_matches('#');
    let full: String =
        if digits.len() == 3 { digits.chars().flat_map(|c| [c, c]).collect() } else { digits.into() };
    let channel = |at: usize| {
        let x = f64::from(u8::from_str_radix(&full[at..at + 2], 16).expect("a colour")) / 255.0;
        if x <= 0.04045 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    0.2126 * channel(0) + 0.7152 * channel(2) + 0.0722 * channel(4)
}

fn contrast(a: &str, b: &str) -> f64 {
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

/// Light and dark part of a style.
fn schemes(style: &str) -> [&str; 2] {
    let (light, dark) = style.split_once(DARK).expect("a dark scheme");
    [light, dark]
}

/// The value of a property of the rule with exactly this selector.
fn value<'a>(style: &'a str, selector: &str, property: &str) -> &'a str {
    let rule = style.split(&format!("{selector}{{")).nth(1).unwrap_or_else(|| panic!("{selector}"));
    let body = rule.split('}').next().expect("its end");
    let found = body.split(';').find_map(|pair| pair.strip_prefix(property)?.strip_prefix(':'));
    found.unwrap_or_else(|| panic!("{selector} {property}"))
}

#[test]
fn lines_and_texts_stand_out_from_the_paper() {
    for style in schemes(FIGURE) {
        let paper = value(style, ".plot .paper", "fill");
        for n in 0..8 {
            let line = value(style, &format!(".plot .c{n}"), "color");
            assert!(contrast(line, paper) >= 3.0, "{n}: {line} on {paper} {}", contrast(line, paper));
        }
        for block in ["limit", "note", "fault", "alarm", "ref", "level"] {
            let colour = value(style, &format!(".plot .{block}"), "color");
            assert!(contrast(colour, paper) >= 3.0, "{block}: {colour} on {paper}");
        }
        let text = value(style, ".plot text", "fill").trim();
        assert!(contrast(text, paper) >= 4.5);
        for mode in ["auto", "cascade", "manual", "track", "hold", "off", "fallback"] {
            let block = value(style, &format!(".plot .m-{mode}"), "color");
            assert!(contrast(text, block) >= 4.5, "{text} on {block}");
        }
        let badge = value(style, ".plot .events circle", "fill");
        assert!(contrast(value(style, ".plot .events .number", "fill"), badge) >= 4.5);
        assert!(contrast(value(style, ".plot .events .name", "fill"), paper) >= 4.5);
    }
}

/// `above` on `paper`, as a colour.
fn mixed(above: &str, opacity: f64, paper: &str) -> String {
    let full = |colour: &str| if colour == "#fff" { "#ffffff".to_owned() } else { colour.to_owned() };
    let channel = |colour: &str, at: usize| {
        f64::from(u8::from_str_radix(&full(colour)[at..at + 2], 16).expect("a colour"))
    };
    let mix = |at| channel(above, at) * opacity + channel(paper, at) * (1.0 - opacity);
    format!("#{}", [1, 3, 5].map(|at| format!("{:02x}", mix(at).round() as u8)).concat())
}

/// Texts and lines of pictures stand in areas that mark times and values.
#[test]
fn texts_and_lines_stand_out_from_marked_areas() {
    for (figure, diagram) in schemes(FIGURE).into_iter().zip(schemes(DIAGRAM)) {
        let paper = value(figure, ".plot .paper", "fill");
        for area in [".plot .window", ".plot .rest", ".plot .target"] {
            let opacity = value(diagram, area, "fill-opacity").parse().expect("a number");
            let ground = mixed(value(diagram, area, "fill"), opacity, paper);
            let text = value(figure, ".plot text", "fill").trim();
            assert!(contrast(text, &ground) >= 4.5, "{text} on {ground}, {area}");
            assert!(contrast(value(figure, ".plot .c0", "color"), &ground) >= 3.0, "{area}");
        }
        assert!(contrast(value(diagram, ".plot .bound", "stroke"), paper) >= 3.0);
        assert_eq!(value(diagram, ".plot .feature,.plot .halo", "stroke"), paper);
    }
}

#[test]
fn texts_of_the_page_stand_out_from_what_is_behind_them() {
    for style in schemes(PAGE) {
        let colour = |name: &str| value(style, ":root", &format!("--{name}"));
        let rule = style.split(":root{").nth(1).and_then(|rule| rule.split('}').next()).expect("colours");
        assert!(rule.contains("--paper"));
        for text in ["ink", "soft", "mark"] {
            for behind in ["paper", "head"] {
                assert!(contrast(colour(text), colour(behind)) >= 4.5, "{text} on {behind}");
            }
        }
        assert!(contrast(colour("ink"), colour("note")) >= 4.5);
    }
}

#[test]
fn colours_of_neighbours_differ_without_colour_vision_by_pattern() {
    let pattern = |n: usize| {
        let rule = format!(".plot .k{n}{{");
        FIGURE.split(&rule).nth(1).map(|rule| rule.split('}').next().expect("its end").to_owned())
    };
    let patterns: Vec<Option<String>> = (0..8).map(pattern).collect();
    assert_eq!(patterns[0], None, "the first is solid");
    for (n, one) in patterns.iter().enumerate() {
        assert!(!patterns[..n].contains(one), "{n} {one:?}");
    }
}
