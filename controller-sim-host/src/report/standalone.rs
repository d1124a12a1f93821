//! A picture as a file of its own.

use super::Chapter;
use super::describe::{description, title};
use super::drawing::{LEFT, RIGHT, draw, loops, pixel};
use super::legend::{entries, sample};
use super::words;
use maud::{PreEscaped, html};

/// Width of the picture \[px\].
const WIDTH: f64 = 900.0;
/// Space around it \[px\].
const MARGIN: f64 = 14.0;
/// Longest title.
const TITLE: usize = 110;
/// Height of a line of the legend \[px\].
const LINE: f64 = 20.0;

/// The style of every picture.
pub(super) const STYLE: &str = include_str!("style/figure.css");

/// One picture with its style, title and legend.
pub(super) fn figure(chapter: &Chapter<'_>) -> String {
    let loops = loops(chapter);
    let drawing = draw(chapter, &loops);
    let legend = entries(chapter.scenario, &loops);
    let mut places = Vec::new();
    let (mut x, mut y) = (MARGIN, MARGIN + 40.0);
    for entry in &legend {
        let text = words::cut(&entry.text, 60);
        let width = 36.0 + text.chars().count() as f64 * 6.6 + 18.0;
        if x > MARGIN && x + width > WIDTH - MARGIN {
            (x, y) = (MARGIN, y + LINE);
        }
        places.push((x, y, text, entry));
        x += width;
    }
    let top = y + 16.0;
    let height = top + drawing.height + MARGIN;
    let inner = WIDTH - 2.0 * MARGIN - LEFT - RIGHT;
    let text = html! {
        svg xmlns="http://www.w3.org/2000/svg" class="plot" width=(pixel(WIDTH)) height=(pixel(height))
            viewBox={ "0 0 " (pixel(WIDTH)) " " (pixel(height)) } role="img" aria-labelledby="title desc" lang="en" {
            title id="title" { (title(chapter, &loops)) }
            desc id="desc" { (description(chapter, &loops)) }
            style { (PreEscaped(STYLE)) }
            rect class="paper" width="100%" height="100%" {}
            text class="head" x=(pixel(MARGIN)) y=(pixel(MARGIN + 14.0)) { (words::cut(&chapter.title(), TITLE)) }
            @for (x, y, text, entry) in &places {
                svg class="p" x=(pixel(*x)) y=(pixel(*y)) {
                    (sample(entry, "-4"))
                    text x="36" y="0" { (text) }
                }
            }
            svg class="p" x=(pixel(MARGIN + LEFT)) y=(pixel(top)) width=(pixel(inner)) height=(pixel(drawing.height)) {
                (drawing.content)
            }
        }
    };
    format!("{}\n", text.into_string())
}
