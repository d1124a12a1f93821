//! The Nyquist plot with the circle of Ms.

use super::curves::{At, Curves};
use super::picture::{continuous, sampled};
use crate::output::table::format_number;
use crate::report::drawing::{controller, pixel};
use maud::{Markup, html};

/// What is shown of the plane: real and imaginary part.
const RE: (f64, f64) = (-2.6, 1.4);
const IM: (f64, f64) = (-2.4, 1.2);
/// Pixels per unit.
const UNIT: f64 = 120.0;

pub(super) fn plot(id: &str, curves: &[Curves]) -> Markup {
    let (width, height) = ((RE.1 - RE.0) * UNIT, (IM.1 - IM.0) * UNIT);
    let x = |re: f64| (re - RE.0) * UNIT;
    let y = |im: f64| (IM.1 - im) * UNIT;
    html! {
        figure class="plot" {
            svg width=(pixel(width)) viewBox={ "-34 0 " (pixel(width + 40.0)) " " (pixel(height + 40.0)) }
                style="max-width:100%;height:auto;display:block" role="img" aria-labelledby={ (id) "-title" } {
                title id={ (id) "-title" } { "Nyquist plot of the loop gain" }
                clipPath id={ (id) "-clip" } { rect width=(pixel(width)) height=(pixel(height)) {} }
                g class="grid" {
                    @for k in -2..=1 { line x1=(pixel(x(f64::from(k)))) x2=(pixel(x(f64::from(k)))) y1="0" y2=(pixel(height)) {} }
                    @for k in -2..=1 { line y1=(pixel(y(f64::from(k)))) y2=(pixel(y(f64::from(k)))) x1="0" x2=(pixel(width)) {} }
                }
                line class="axis" x1="0" x2=(pixel(width)) y1=(pixel(y(0.0))) y2=(pixel(y(0.0))) {}
                line class="axis" y1="0" y2=(pixel(height)) x1=(pixel(x(0.0))) x2=(pixel(x(0.0))) {}
                g clip-path={ "url(#" (id) "-clip)" } {
                    circle class="level" cx=(pixel(x(0.0))) cy=(pixel(y(0.0))) r=(pixel(UNIT)) {}
                    @for c in curves {
                        @if let Some(ms) = c.ms {
                            circle class={ "l asked " (controller(c.index)) } style="stroke-dasharray:1.5 3"
                                cx=(pixel(x(-1.0))) cy=(pixel(y(0.0))) r=(pixel(UNIT / ms)) {}
                        }
                        path class=(continuous(c.index)) d=(path(&c.continuous, &x, &y)) {}
                        path class=(sampled(c.index)) d=(path(&c.sampled, &x, &y)) {}
                    }
                }
                path class="l ref" d={ "M" (pixel(x(-1.0) - 5.0)) " " (pixel(y(0.0))) "h10m-5-5v10" } {}
                text class="small" x=(pixel(x(-1.0) - 5.0)) y=(pixel(y(0.0) + 18.0)) { "\u{2212}1" }
                @for k in -2..=1 {
                    text class="t" x=(pixel(x(f64::from(k)))) y=(pixel(height + 16.0)) { (number(k)) }
                    text class="n" x="-6" y=(pixel(y(f64::from(k)) + 4.0)) { (number(k)) }
                }
                text class="title t" x=(pixel(0.5 * width)) y=(pixel(height + 34.0)) { "Re L" }
                text class="title t" transform={ "translate(-24," (pixel(0.5 * height)) ") rotate(-90)" } { "Im L" }
            }
            figcaption {
                "Dotted: the circle around \u{2212}1 that the sampled loop touches, of radius 1/Ms"
                @for c in curves {
                    @if let Some(ms) = c.ms { "; " (c.name) ": Ms = " (format_number(ms)) }
                }
                ". Dash-dotted: the unit circle."
            }
        }
    }
}

fn number(k: i32) -> String {
    if k < 0 { format!("\u{2212}{}", -k) } else { k.to_string() }
}

/// The curve within and somewhat around what is shown.
fn path(points: &[At], x: &impl Fn(f64) -> f64, y: &impl Fn(f64) -> f64) -> String {
    let mut text = String::new();
    let mut drawing = false;
    let mut last = (f64::NAN, f64::NAN);
    for p in points {
        let near = p.open.re.abs() < 40.0 && p.open.im.abs() < 40.0;
        if !near {
            drawing = false;
            continue;
        }
        let place = (x(p.open.re), y(p.open.im));
        if drawing && (place.0 - last.0).abs() < 0.4 && (place.1 - last.1).abs() < 0.4 {
            continue;
        }
        text.push_str(if drawing { "L" } else { "M" });
        text.push_str(&format!("{:.1} {:.1}", place.0, place.1));
        (drawing, last) = (true, place);
    }
    text
}
