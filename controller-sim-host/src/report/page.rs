//! The page.

use super::Chapter;
use super::describe::{description, title};
use super::drawing::{draw, loops, pixel};
use super::legend::{entries, sample};
use super::standalone::STYLE;
use maud::{DOCTYPE, Markup, PreEscaped, html};

const PAGE_STYLE: &str = include_str!("style/page.css");

/// The page as text.
pub(super) fn page(chapters: &[Chapter<'_>], command: &str) -> String {
    let heading = match chapters {
        [only] => only.title(),
        several => format!("Simulation report: {} runs", several.len()),
    };
    let text = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (heading) }
                style { (PreEscaped(STYLE)) (PreEscaped(PAGE_STYLE)) }
            }
            body {
                header { h1 { (heading) } }
                main {
                    @for (index, chapter) in chapters.iter().enumerate() { (section(index, chapter)) }
                }
                footer {
                    p { "Made by controller-sim " (env!("CARGO_PKG_VERSION")) " with" }
                    pre tabindex="0" role="region" aria-label="Command" { code { (command) } }
                }
            }
        }
    };
    text.into_string()
}

fn section(index: usize, chapter: &Chapter<'_>) -> Markup {
    html! {
        section id={ "run-" (index + 1) } {
            (picture(index, chapter))
        }
    }
}

fn picture(index: usize, chapter: &Chapter<'_>) -> Markup {
    let loops = loops(chapter);
    let drawing = draw(chapter, &loops);
    let id = format!("figure-{}", index + 1);
    html! {
        figure class="plot" id=(id) {
            ul class="legend" {
                @for entry in entries(chapter.scenario, &loops) {
                    li {
                        svg width="30" height="10" aria-hidden="true" { (sample(&entry, "5")) }
                        span { (entry.text) }
                    }
                }
            }
            svg class="canvas" height=(pixel(drawing.height)) role="img"
                aria-labelledby={ (id) "-title " (id) "-desc" } {
                title id={ (id) "-title" } { (title(chapter, &loops)) }
                desc id={ (id) "-desc" } { (description(chapter, &loops)) }
                (drawing.content)
            }
        }
    }
}
