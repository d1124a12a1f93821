//! A figure as a file of its own.

use super::super::drawing::{LEFT, pixel};
use super::super::standalone::STYLE;
use super::{BESIDE, LINE, Sheet, drawings, framed};
use maud::{PreEscaped, html};

/// Space around the picture \[px\].
const MARGIN: f64 = 14.0;
/// Space below a row of panels \[px\].
const ROW: f64 = 12.0;
/// Width of a character of the text \[px\].
const CHARACTER: f64 = 6.2;

/// The style of what figures have and runs have not.
const SHEET_STYLE: &str = include_str!("../style/sheet.css");
const DIAGRAM_STYLE: &str = include_str!("../style/diagram.css");

/// The picture as text.
pub(crate) fn svg(sheet: &Sheet) -> String {
    let columns = sheet.columns.clamp(1, 3).min(sheet.panels.len().max(1));
    let inner = [780.0, 390.0, 270.0][sheet.columns.clamp(1, 3) - 1];
    let width = 2.0 * MARGIN + columns as f64 * (inner + BESIDE);
    let most = ((width - 2.0 * MARGIN) / CHARACTER) as usize;
    let lines: Vec<String> = sheet.text.iter().flat_map(|sentence| wrapped(sentence, most)).collect();
    let mut y = MARGIN + 22.0 + LINE * lines.len() as f64 + 10.0;
    let mut placed = Vec::new();
    let all = drawings(sheet);
    for row in all.chunks(columns) {
        let height = row.iter().map(|drawing| drawing.height).fold(0.0, f64::max);
        for (i, drawing) in row.iter().enumerate() {
            placed.push((MARGIN + LEFT + i as f64 * (inner + BESIDE), y, drawing));
        }
        y += height + ROW;
    }
    let description: Vec<String> = sheet.panels.iter().map(super::Panel::described).collect();
    let text = html! {
        svg xmlns="http://www.w3.org/2000/svg" class="plot" width=(pixel(width)) height=(pixel(y))
            viewBox={ "0 0 " (pixel(width)) " " (pixel(y)) } role="img" aria-labelledby="title desc" lang="en" {
            title id="title" { (sheet.title) }
            desc id="desc" { (description.join(" ")) }
            style { (PreEscaped(STYLE)) (PreEscaped(DIAGRAM_STYLE)) (PreEscaped(SHEET_STYLE)) }
            rect class="paper" width="100%" height="100%" {}
            text class="head" x=(pixel(MARGIN)) y=(pixel(MARGIN + 14.0)) {
                (super::words::cut(&sheet.title, (most as f64 * 0.72) as usize))
            }
            @for (i, line) in lines.iter().enumerate() {
                text x=(pixel(MARGIN)) y=(pixel(MARGIN + 20.0 + LINE * (i as f64 + 1.0))) { (line) }
            }
            @for (x, y, drawing) in &placed { (framed(drawing, Some((*x, *y, inner)))) }
        }
    };
    format!("{}\n", text.into_string())
}

/// A sentence in lines of at most `most` characters, but for words that are longer.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
