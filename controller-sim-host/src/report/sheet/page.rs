//! A page of figures.

use super::super::drawing::pixel;
use super::super::page::{document, notes};
use super::{Sheet, drawings, framed};
use maud::{Markup, html};

/// The page: its kind, the figures, what is odd about them, and what stands below; `command` is what made it.
pub(crate) fn page(kind: &str, sheets: &[Sheet], remarks: &[String], more: &Markup, command: &str) -> String {
    let heading = match sheets {
        [only] => only.title.clone(),
        several => format!("{} figures", several.len()),
    };
    let content = html! {
        main {
            @for (i, sheet) in sheets.iter().enumerate() { (section(i, sheet, sheets.len() > 1)) }
            (notes(remarks))
            (more)
        }
    };
    document(kind, &heading, &content, command)
}

fn section(index: usize, sheet: &Sheet, several: bool) -> Markup {
    html! {
        section class="run" {
            @if several { h2 { (sheet.title) } }
            @for sentence in &sheet.text { p { (sentence) } }
            div class={ "sheet s" (sheet.columns.clamp(1, 3)) } {
                @for (i, (panel, drawing)) in sheet.panels.iter().zip(drawings(sheet)).enumerate() {
                    @let id = format!("figure-{}-{}", index + 1, i + 1);
                    figure class="plot" id=(id) {
                        svg class="canvas" height=(pixel(drawing.height)) role="img" aria-labelledby={ (id) "-title" } {
                            title id={ (id) "-title" } { (panel.described()) }
                            (framed(&drawing, None))
                        }
                    }
                }
            }
        }
    }
}
