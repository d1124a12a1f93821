//! The page of a load-response experiment: verdict, picture, features beside their ranges, what to change.

use super::drawing::pixel;
use super::experiment::{Picture, Signals, downwards, draw};
use super::legend::{area, line};
use super::page::{document, notes, scroll};
use crate::output::table::format_number;
use controller_design::assessment::{Acceptance, Assessment, Change, Features, Marks, Verdict};
use maud::{Markup, html};

/// An experiment with what came of it.
#[derive(Debug, Clone, Copy)]
pub struct Experiment<'a> {
    /// The file of the record, and which controller in it.
    pub name: &'a str,
    /// What was recorded.
    pub signals: Signals<'a>,
    /// What it says.
    pub assessment: &'a Assessment,
    /// The ranges it was held against.
    pub acceptance: Acceptance,
}

/// One line that says it all.
#[must_use]
pub fn verdict_line(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NearOptimal => "tuned for loads: the IAE is close to the least a PI can have",
        Verdict::Aggressive => "too aggressive: the loop swings after a load",
        Verdict::Sluggish => "too sluggish: the loop takes its time after a load",
        Verdict::Inconclusive => "the record does not tell how the loop is tuned",
    }
}

/// A feature, its value, the range of a near-optimal loop, and whether it is in it.
pub struct Line {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// Its value as text; `-` when there is none.
    pub value: String,
    /// The range as text.
    pub range: String,
    /// Whether it is in the range; `None`: it has none.
    pub good: Option<bool>,
}

/// The features as a person reads them, for the terminal and the page.
#[must_use]
pub fn lines(features: &Features, acceptance: &Acceptance) -> Vec<Line> {
    let number = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), format_number);
    let within = |x: Option<f64>, (lo, hi): (f64, f64)| Some(x.is_some_and(|x| x >= lo && x <= hi));
    let Acceptance { dip, t_ratio, r3, .. } = *acceptance;
    let line = |name, about, value: Option<f64>, range: String, good| Line {
        name,
        about,
        value: number(value),
        range,
        good,
    };
    vec![
        line(
            "dip",
            "turning point after the first peak, in first peaks; below 0 beyond the baseline",
            features.dip,
            format!("{:.2} to {:.2}", dip.0, dip.1),
            within(features.dip, dip),
        ),
        line(
            "t_ratio",
            "time of the dip, in times of the first peak",
            features.t_ratio,
            format!("{:.2} to {:.2}", t_ratio.0, t_ratio.1),
            within(features.t_ratio, t_ratio),
        ),
        line(
            "r3",
            "peak after the dip, to the side of the first, in first peaks",
            features.r3,
            format!("at most {r3:.2}"),
            within(features.r3, (f64::NEG_INFINITY, r3)),
        ),
        line("p1", "first peak, size [y]", Some(features.p1), String::new(), None),
        line("t1", "its time from the step [s]", Some(features.t1), String::new(), None),
        line("sigma", "noise of a sample [y]", Some(features.sigma), String::new(), None),
    ]
}

/// What to change in the controller, in words; nothing when there is nothing to change.
#[must_use]
pub fn advice(assessment: &Assessment) -> Option<String> {
    let is_reverse = assessment.marks.as_ref().is_some_and(Marks::is_reverse);
    let gain = assessment.advice.kp.map(|change| match (change, is_reverse) {
        (Change::Raise, false) => "raise the gain",
        (Change::Lower, false) => "lower the gain",
        (Change::Raise, true) => "make the negative gain larger in size",
        (Change::Lower, true) => "make the negative gain smaller in size",
    });
    let time = assessment.advice.ti.map(|change| match change {
        Change::Raise => "make the integral time longer",
        Change::Lower => "make the integral time shorter",
    });
    let list: Vec<&str> = gain.into_iter().chain(time).collect();
    (!list.is_empty()).then(|| format!("{}, by 10 to 30 %, then repeat the experiment", list.join(", ")))
}

/// A page that needs nothing else. `command` is what made it.
#[must_use]
pub fn assessment_page(experiment: &Experiment<'_>, command: &str) -> String {
    let assessment = experiment.assessment;
    let heading = format!("{}: {}", experiment.name, assessment.verdict.name());
    let content = html! {
        main {
            (verdict(assessment))
            (notes(&assessment.warnings.iter().map(ToString::to_string).collect::<Vec<_>>()))
            @if let Some(marks) = &assessment.marks {
                h2 id="response" { "Response" }
                @let sigma = assessment.features.map_or(0.0, |features| features.sigma);
                (picture(&draw(&experiment.signals, marks, &experiment.acceptance, sigma), experiment))
            }
            @if let Some(features) = &assessment.features {
                h2 id="features" { "Features" }
                (scroll("features", &table(features, &experiment.acceptance)))
            }
            h2 id="about" { "How to read it" }
            (about())
        }
    };
    document("Load-response experiment", &heading, &content, command)
}

fn verdict(assessment: &Assessment) -> Markup {
    html! {
        p class="lead" { strong { (assessment.verdict.name()) } ": " (verdict_line(assessment.verdict)) "." }
        ul {
            @for reason in &assessment.reasons { li { (reason) "; " (reason.help()) "." } }
        }
        @if let Some(advice) = advice(assessment) { p { strong { "What to change: " } (advice) "." } }
    }
}

fn picture(picture: &Picture, experiment: &Experiment<'_>) -> Markup {
    let marks = experiment.assessment.marks.as_ref();
    let marked = marks.is_some_and(|marks| marks.peak.is_some());
    html! {
        figure class="plot" id="figure-1" {
            ul class="legend" {
                (line("faint c0", "measurement as recorded (faint)"))
                @if marked { (line("c0", "smoothed")) }
                @if !experiment.signals.setpoint.is_empty() { (line("ref", "set-point")) }
                (line("level", "mean before the step"))
                (area("window", "output held by hand"))
                @if picture.target { (area("target", "where the dip belongs")) }
                @if picture.target { (line("bound", "largest P3")) }
            }
            svg class="canvas" height=(pixel(picture.height)) role="img" aria-labelledby="figure-1-title figure-1-desc" {
                title id="figure-1-title" {
                    "Response to the step of the output, " (format_number(picture.time.0)) " s to "
                    (format_number(picture.time.1)) " s"
                }
                desc id="figure-1-desc" { (described(experiment)) }
                (picture.content)
            }
            figcaption {
                @if let Some(marks) = marks {
                    "By hand the output went from " (format_number(marks.inputs.0)) " to " (format_number(marks.inputs.1))
                    " at " (format_number(marks.step)) " s"
                    @if let Some(auto) = marks.auto { "; back in automatic at " (format_number(auto)) " s" }
                    "."
                }
                @if marks.is_some_and(downwards) { " The first peak points down here, and so the dip points up." }
                @if picture.hidden {
                    " What differs from the mean before the step by less than two standard deviations of the noise is not marked."
                }
                @if picture.target {
                    " Of a near-optimal loop the dip lies in the box, and the third peak P3 is at most "
                    (format!("{:.2}", experiment.acceptance.r3)) " first peaks large."
                }
            }
        }
    }
}

/// The picture in words.
fn described(experiment: &Experiment<'_>) -> String {
    let Some(features) = experiment.assessment.features else {
        return "Measurement and output over time. No response was measured.".to_owned();
    };
    let marks = experiment.assessment.marks.as_ref();
    let side = match marks.and_then(|marks| marks.peak.map(|peak| peak.y < marks.baseline)) {
        Some(true) => " below the mean before the step,",
        Some(false) => " above the mean before the step,",
        None => "",
    };
    let mut text = format!(
        "Measurement and output over time. First peak {}{side} after {} s.",
        format_number(features.p1),
        format_number(features.t1)
    );
    if experiment.assessment.marks.as_ref().is_some_and(downwards) {
        text.push_str(" It points down.");
    }
    if let (Some(dip), Some(t_ratio), Some(r3)) = (features.dip, features.t_ratio, features.r3) {
        text.push_str(&format!(
            " Dip of {dip:.3} first peaks at {t_ratio:.2} times that time, third peak of {r3:.3}."
        ));
    }
    text
}

fn table(features: &Features, acceptance: &Acceptance) -> Markup {
    html! {
        table class="features" {
            thead {
                tr {
                    th scope="col" class="text" { "feature" }
                    th scope="col" { "value" }
                    th scope="col" class="text" { "near-optimal" }
                    th scope="col" class="text" { "in its range" }
                    th scope="col" class="text" { "what it is" }
                }
            }
            tbody {
                @for line in lines(features, acceptance) {
                    tr {
                        th scope="row" { (line.name) }
                        td { (line.value) }
                        td class="text" { (line.range) }
                        td class="text" {
                            @match line.good { Some(true) => "yes", Some(false) => strong { "no" }, None => "" }
                        }
                        td class="text" { (line.about) }
                    }
                }
            }
        }
    }
}

fn about() -> Markup {
    html! {
        p {
            "The output was stepped by hand while the loop was at rest, and the controller switched back to automatic. To the "
            "loop this is a step of the load. Under the PI controller with the least integral of the absolute error (IAE) the "
            "response of nearly every process with dead time has one shape: a first peak P1, a little after twice its time a small "
            "dip to the other side of the mean before the step, then a small third peak P3 to the side of the first. All three "
            "are counted from that mean in the direction of the first peak: where a larger output lowers the measurement, or "
            "the step is a step down, P1 and P3 point down and the dip points up. A deep dip means a short integral time, a high P3 or an early dip a high gain; no dip, or "
            "one before the measurement is back, a long integral time or a low gain. A loop with all three in their "
            "ranges has an IAE within some 15 % of the best."
        }
        p {
            "A disturbance observer or estimator that reads the output really applied takes no part in the experiment: what is judged "
            "is the PI controller alone. The method is that of P. Airikka, PI control for load disturbance rejection, 2021."
        }
    }
}
