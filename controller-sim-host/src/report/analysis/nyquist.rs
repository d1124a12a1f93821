//! The Nyquist plot with the circle of Ms.

use super::curves::{At, Curves};
use super::picture::{continuous, legend, sampled};
use crate::output::table::format_number;
use crate::report::drawing::{colour, pixel};
use maud::{Markup, html};

/// What is shown of the plane: real and imaginary part.
const RE: (f64, f64) = (-2.6, 1.4);
const IM: (f64, f64) = (-2.4, 1.2);
/// Pixels per unit, on both axes.
const UNIT: f64 = 120.0;
/// Space for numbers and titles, at the left and elsewhere \[px\].
const LEFT: f64 = 50.0;
const AROUND: f64 = 8.0;
const BELOW: f64 = 46.0;

fn x(re: f64) -> f64 {
    (re - RE.0) * UNIT
}

fn y(im: f64) -> f64 {
    (IM.1 - im) * UNIT
}

pub(super) fn plot(id: &str, curves: &[Curves]) -> Markup {
    let (width, height) = (x(RE.1), y(IM.0));
    let view = [-LEFT, -AROUND, width + LEFT + AROUND, height + AROUND + BELOW].map(pixel).join(" ");
    let circles: Vec<(&Curves, f64)> = curves.iter().filter_map(|c| Some((c, c.margins?.ms))).collect();
    let widest = circles.iter().map(|(_, ms)| *ms).fold(f64::INFINITY, f64::min);
    let name = if circles.len() == 1 {
        format!("Ms = {}", format_number(widest))
    } else {
        "circles of Ms".to_owned()
    };
    html! {
        figure class="plot" id=(id) {
            (legend(curves))
            svg class="nyquist" viewBox=(view) role="img" aria-labelledby={ (id) "-title" } {
                title id={ (id) "-title" } { "Nyquist plot of the loop gain L" }
                g class="grid" {
                    @for k in -2..=1 { line x1=(pixel(x(f64::from(k)))) x2=(pixel(x(f64::from(k)))) y1="0" y2=(pixel(height)) {} }
                    @for k in -2..=1 { line y1=(pixel(y(f64::from(k)))) y2=(pixel(y(f64::from(k)))) x1="0" x2=(pixel(width)) {} }
                }
                line class="axis" x1="0" x2=(pixel(width)) y1=(pixel(y(0.0))) y2=(pixel(y(0.0))) {}
                line class="axis" y1="0" y2=(pixel(height)) x1=(pixel(x(0.0))) x2=(pixel(x(0.0))) {}
                circle class="level" cx=(pixel(x(0.0))) cy=(pixel(y(0.0))) r=(pixel(UNIT)) {}
                @for (c, ms) in &circles {
                    circle class={ "l applied " (colour(c.index)) } cx=(pixel(x(-1.0))) cy=(pixel(y(0.0))) r=(pixel(UNIT / ms)) {}
                }
                @for c in curves {
                    path class=(continuous(c.index)) d=(path(&c.continuous)) {}
                    path class=(sampled(c.index)) d=(path(&c.sampled)) {}
                }
                @for c in curves {
                    @for crossing in c.crossings.iter().filter(|c| inside((c.open.re, c.open.im))) {
                        circle class={ "point " (colour(c.index)) } r="4"
                            cx=(pixel(x(crossing.open.re))) cy=(pixel(y(crossing.open.im))) { title { (c.name) } }
                    }
                }
                path class="l ref" d={ "M" (pixel(x(-1.0) - 5.0)) " " (pixel(y(0.0))) "h10m-5-5v10" } {}
                text class="halo n" x=(pixel(x(-1.0) - 7.0)) y=(pixel(y(0.0) + 16.0)) { "\u{2212}1" }
                text class="halo" x=(pixel(x(0.56))) y=(pixel(y(0.9))) { "unit circle" }
                @if !circles.is_empty() {
                    text class="halo t" x=(pixel(x(-1.0))) y=(pixel(y(1.0 / widest) - 6.0)) { (name) }
                }
                @for k in -2..=1 {
                    text class="t" x=(pixel(x(f64::from(k)))) y=(pixel(height + 18.0)) { (number(k)) }
                    text class="n" x="-6" y=(pixel(y(f64::from(k)) + 4.0)) { (number(k)) }
                }
                text class="title t" x=(pixel(0.5 * width)) y=(pixel(height + 38.0)) { "Re L" }
                text class="title t" transform={ "translate(-34," (pixel(y(-0.5))) ") rotate(-90)" } { "Im L" }
            }
            figcaption {
                "Dotted: the circle around \u{2212}1 that the sampled loop touches, of radius 1/Ms"
                @for (c, ms) in &circles { "; " (c.name) ": Ms = " (format_number(*ms)) }
                ". Dash-dotted: the unit circle. Points: where the gain and the phase margin are."
            }
        }
    }
}

fn number(k: i32) -> String {
    if k < 0 { format!("\u{2212}{}", -k) } else { k.to_string() }
}

fn inside((re, im): (f64, f64)) -> bool {
    re >= RE.0 && re <= RE.1 && im >= IM.0 && im <= IM.1
}

/// The part of the curve that is shown.
fn path(points: &[At]) -> String {
    let mut text = String::new();
    let mut last: Option<(f64, f64)> = None;
    for pair in points.windows(2) {
        let [a, b] = [(pair[0].open.re, pair[0].open.im), (pair[1].open.re, pair[1].open.im)];
        let Some((from, to)) = cut(a, b) else {
            last = None;
            continue;
        };
        let places = [from, to].map(|(re, im)| (x(re), y(im)));
        let near = |p: (f64, f64), q: (f64, f64)| (p.0 - q.0).abs() < 0.4 && (p.1 - q.1).abs() < 0.4;
        if last.is_none() {
            text.push_str(&format!("M{:.1} {:.1}", places[0].0, places[0].1));
            last = Some(places[0]);
        }
        if last.is_some_and(|last| !near(last, places[1])) || to != b {
            text.push_str(&format!("L{:.1} {:.1}", places[1].0, places[1].1));
            last = Some(places[1]);
        }
        if to != b {
            last = None;
        }
    }
    text
}

/// The part of a stretch that lies in what is shown.
fn cut(a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    if inside(a) && inside(b) {
        return Some((a, b));
    }
    let (mut first, mut end) = (0.0_f64, 1.0_f64);
    for (from, to, (lo, hi)) in [(a.0, b.0, RE), (a.1, b.1, IM)] {
        let step = to - from;
        if !step.is_finite() || (step == 0.0 && !(lo..=hi).contains(&from)) {
            return None;
        }
        if step != 0.0 {
            let (p, q) = ((lo - from) / step, (hi - from) / step);
            (first, end) = (first.max(p.min(q)), end.min(p.max(q)));
        }
    }
    let at = |k: f64| (a.0 + k * (b.0 - a.0), a.1 + k * (b.1 - a.1));
    let to = if end >= 1.0 { b } else { at(end) };
    (first < end).then(|| (if first <= 0.0 { a } else { at(first) }, to))
}
