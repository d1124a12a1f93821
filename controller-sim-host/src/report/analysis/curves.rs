//! The responses of a loop over frequency, continuous and sampled.

use crate::analysis::Analysis;
use controller_design::margins::Margins;
use controller_design::model::Complex;
use core::f64::consts::{PI, TAU};

/// Points of a curve besides those that the loop asks for.
const POINTS: u32 = 500;
/// Most points that the loop may ask for.
const MOST: usize = 3000;

/// A response at one frequency.
pub(super) struct At {
    /// Frequency \[rad/s\].
    pub(super) omega: f64,
    pub(super) open: Complex,
    /// Phase of the loop gain \[deg\], without jumps.
    pub(super) phase: f64,
    pub(super) sensitivity: f64,
    pub(super) complementary: f64,
    pub(super) noise: f64,
}

/// The curves of a controller.
pub(super) struct Curves {
    /// Its place in the order of controllers.
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) continuous: Vec<At>,
    pub(super) sampled: Vec<At>,
    /// Nyquist frequency \[rad/s\].
    pub(super) nyquist: f64,
    /// The margins of the sampled loop, when it is stable, and the loop gain where they are.
    pub(super) margins: Option<Margins>,
    pub(super) crossings: Vec<Crossing>,
}

/// A place where a margin is measured.
pub(super) struct Crossing {
    pub(super) kind: Kind,
    /// Frequency \[rad/s\].
    pub(super) omega: f64,
    /// The margin: a factor, or degrees.
    pub(super) margin: f64,
    /// The loop gain there.
    pub(super) open: Complex,
    /// Its phase \[deg\], on the curve.
    pub(super) phase: f64,
}

/// What a margin is a margin of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Gain,
    Phase,
}

/// The lowest frequency that is drawn of a loop \[rad/s\].
pub(super) fn lowest(a: &Analysis) -> f64 {
    let nyquist = PI / a.sampled.ts();
    let crossover = match (&a.discrete.margins, &a.continuous.margins) {
        (Ok(m), _) | (Err(_), Ok(m)) => m.omega_pm.unwrap_or(m.omega_ms).min(m.omega_ms),
        _ => 0.1 * nyquist,
    };
    (crossover * 0.01).min(0.1 * nyquist)
}

/// The curves from `low` \[rad/s\] to the Nyquist frequency.
pub(super) fn curves(index: usize, a: &Analysis, low: f64) -> Curves {
    let ts = a.sampled.ts();
    let nyquist = PI / ts;
    let ratio = nyquist / low;
    let mut places: Vec<f64> =
        (0..=POINTS).map(|k| low * libm::pow(ratio, f64::from(k) / f64::from(POINTS))).collect();
    let asked: Vec<f64> = a.sampled.angles().iter().map(|t| t / ts).filter(|w| *w > low).collect();
    places.extend(asked.iter().step_by(asked.len() / MOST + 1));
    places.push(nyquist);
    places.retain(|w| *w <= nyquist);
    places.sort_by(f64::total_cmp);
    places.dedup();

    let continuous = places.iter().map(|&w| {
        let (s, t) = (a.design.sensitivity(w), a.design.complementary(w));
        (w, a.design.loop_gain(w), s, t, a.design.noise_response(w))
    });
    let continuous = unwrapped(continuous);
    let sampled = unwrapped(places.iter().map(|&w| {
        let p = a.sampled.at((w * ts).min(PI));
        (w, p.open(), p.sensitivity(), p.complementary(), p.noise())
    }));
    let margins = a.discrete.margins.as_ref().ok().copied();
    Curves {
        index,
        name: a.name.clone(),
        continuous,
        crossings: margins.as_ref().map_or(Vec::new(), |m| crossings(a, m, &sampled)),
        sampled,
        nyquist,
        margins,
    }
}

fn crossings(a: &Analysis, m: &Margins, curve: &[At]) -> Vec<Crossing> {
    let list = [
        (Kind::Gain, m.omega_gm, m.gm),
        (Kind::Gain, m.omega_gm_low, m.gm_low),
        (Kind::Phase, m.omega_pm, m.pm_deg),
    ];
    let crossing = |(kind, omega, margin): (Kind, Option<f64>, f64)| {
        let omega = omega?;
        let open = a.sampled.at((omega * a.sampled.ts()).min(PI)).open();
        let near = curve.iter().min_by(|p, q| (p.omega - omega).abs().total_cmp(&(q.omega - omega).abs()))?;
        let raw = open.arg().to_degrees();
        let phase = raw + 360.0 * libm::round((near.phase - raw) / 360.0);
        Some(Crossing { kind, omega, margin, open, phase })
    };
    list.into_iter().filter_map(crossing).collect()
}

/// The responses with a phase that does not jump, begun between -360 and 0 deg.
fn unwrapped(list: impl Iterator<Item = (f64, Complex, Complex, Complex, Complex)>) -> Vec<At> {
    let mut last: Option<f64> = None;
    list.map(|(omega, open, s, t, n)| {
        let raw = open.arg();
        let phase = match last {
            None if raw > 0.0 => raw - TAU,
            None => raw,
            Some(before) => raw + TAU * libm::round((before - raw) / TAU),
        };
        last = Some(phase);
        At {
            omega,
            open,
            phase: phase.to_degrees(),
            sensitivity: s.abs(),
            complementary: t.abs(),
            noise: n.abs(),
        }
    })
    .collect()
}
