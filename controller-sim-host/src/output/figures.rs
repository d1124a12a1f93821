//! The figures of the papers: which there are, and one that was drawn.

use super::Written;
use super::csv::field as quoted;
use super::json::text;
use crate::batch::show;
use crate::report::sheet::{Content, Sheet};
use crate::reproduce::{Figure, Way, figures};
use serde::Serialize;

/// What draws a figure.
fn command(figure: &Figure) -> Option<String> {
    match figure.way() {
        Way::Not(_) => None,
        Way::Run(_) | Way::Draw => {
            Some(format!("controller-sim reproduce --figure {0} --report {0}.html", figure.name()))
        }
    }
}

/// Every figure with its command, or why there is none.
#[must_use]
pub fn figures_table() -> String {
    let mut out = String::new();
    let mut source = "";
    for one in figures() {
        if source != one.paper.source() {
            source = one.paper.source();
            out.push_str(&format!("{}{source}\n", if out.is_empty() { "" } else { "\n" }));
        }
        let how = match one.way() {
            Way::Not(why) => format!("not drawn: {why}"),
            Way::Run(name) => format!("--figure {} (the built-in scenario {name})", one.name()),
            Way::Draw => format!("--figure {}", one.name()),
        };
        out.push_str(&format!("  figure {:<4}{}\n             {how}\n", one.number, one.title));
    }
    out.push_str("\ncontroller-sim reproduce --figure NAME --report FILE.html draws one; also --svg, and --csv for its numbers\n");
    out
}

/// The same as JSON.
#[must_use]
pub fn figures_json() -> String {
    #[derive(Serialize)]
    struct Whole {
        version: &'static str,
        figures: Vec<One>,
    }
    #[derive(Serialize)]
    struct One {
        figure: String,
        paper: &'static str,
        number: u8,
        title: &'static str,
        command: Option<String>,
        reason: Option<&'static str>,
    }
    let one = |figure: &Figure| One {
        figure: figure.name(),
        paper: figure.paper.name(),
        number: figure.number,
        title: figure.title,
        command: command(figure),
        reason: if let Way::Not(why) = figure.way() { Some(why) } else { None },
    };
    text(&Whole { version: env!("CARGO_PKG_VERSION"), figures: figures().map(one).collect() })
}

/// A figure that was drawn, as JSON.
#[must_use]
pub fn drawn_json(figure: &Figure, sheet: &Sheet, files: &[Written]) -> String {
    #[derive(Serialize)]
    struct Whole<'a> {
        version: &'static str,
        figure: String,
        title: &'a str,
        text: &'a [String],
        panels: Vec<One<'a>>,
        files: &'a [Written],
    }
    #[derive(Serialize)]
    struct One<'a> {
        title: &'a str,
        x: &'a str,
        y: &'a str,
    }
    let panels =
        sheet.panels.iter().map(|panel| One { title: &panel.title, x: &panel.x.name, y: &panel.y.name });
    text(&Whole {
        version: env!("CARGO_PKG_VERSION"),
        figure: figure.name(),
        title: &sheet.title,
        text: &sheet.text,
        panels: panels.collect(),
        files,
    })
}

/// The numbers of a figure as a table: panel (from 1), its title, the curve, x, y, and of maps the value there; a hole has no
/// value.
#[must_use]
pub fn sheet_csv(sheet: &Sheet) -> String {
    let mut out = "panel,title,curve,x,y,value\n".to_owned();
    let number = |x: f64| if x.is_finite() { show(x) } else { String::new() };
    for (i, panel) in sheet.panels.iter().enumerate() {
        let title = quoted(if panel.title.is_empty() { &panel.y.name } else { &panel.title });
        let mut line = |curve: &str, x: f64, y: f64, value: &str| {
            out.push_str(&format!(
                "{},{title},{},{},{},{value}\n",
                i + 1,
                quoted(curve),
                number(x),
                number(y)
            ));
        };
        match &panel.content {
            Content::Curves(curves) => {
                for curve in curves {
                    curve.points.iter().for_each(|(x, y)| line(&curve.name, *x, *y, ""));
                }
            }
            Content::Map(map) => {
                let places = map.y.iter().flat_map(|y| map.x.iter().map(move |x| (*x, *y)));
                places.zip(&map.values).for_each(|((x, y), value)| line("", x, y, &number(*value)));
            }
        }
    }
    out
}
