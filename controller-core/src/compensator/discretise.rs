//! From a configuration to the coefficients of the discrete-exact pair. Used in `new` only.

use super::MAX_EXCESS;
use super::config::CompensatorConfig;
use super::shape::{least_order, list_of, moved_zeros, nearness, sort_by_number, whole_samples};
use super::zoh::{Pole, numerator, times_linear};
use crate::plant_model::{MAX_ORDER, PlantModel};
use crate::real::Real;
use heapless::Vec;

/// Everything a compensator needs, in `f64`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Discretised {
    /// Gains `1-p` of the lags: one for every state of the `y` chain, the same for the `u` chain.
    pub(super) g: Vec<f64, MAX_ORDER>,
    /// Share of a first lag's difference that the second lag of its section is fed, at the index of the first.
    pub(super) y_feed: Vec<f64, MAX_ORDER>,
    /// Weights of the `y` sections' differences.
    pub(super) y_lead: Vec<f64, MAX_ORDER>,
    /// Static gains of the `y` sections, 1 or 0 (integrating), at the index of a section's last state.
    pub(super) y_dc: Vec<f64, MAX_ORDER>,
    /// Weights of the `u` chain's differences.
    pub(super) u_lead: Vec<f64, MAX_ORDER>,
    /// Gains of the shared lags.
    pub(super) e_gain: Vec<f64, MAX_EXCESS>,
    /// `1/K`.
    pub(super) inv_gain: f64,
    /// Share fed back.
    pub(super) gain: f64,
    /// Whole samples of delay `N`.
    pub(super) delay: usize,
}

/// The poles of a model: the real ones, fast before slow, and the complex pairs.
pub(super) fn split_poles(model: &PlantModel, ts: f64) -> (Vec<Pole, MAX_ORDER>, Vec<Pole, MAX_ORDER>) {
    let mut real: Vec<Pole, MAX_ORDER> = Vec::new();
    let mut pairs: Vec<Pole, MAX_ORDER> = Vec::new();
    for _ in 0..model.integrators {
        let _ = real.push(Pole::Integrator);
    }
    for factor in &model.poles {
        match factor.real_time_constants() {
            Some((slow, fast)) => {
                let _ = real.push(Pole::Real { rate: ts / slow });
                if factor.order() == 2 {
                    let _ = real.push(Pole::Real { rate: ts / fast });
                }
            }
            None => {
                let _ = pairs.push(Pole::Pair { d1: factor.a1 * ts / factor.a2, d0: ts * ts / factor.a2 });
            }
        }
    }
    // Fast before slow, as the lags, so that slow poles meet slow lags; integrators come last.
    sort_by_number(&mut real, |&pole| -rate(pole));
    (real, pairs)
}

fn rate(pole: Pole) -> f64 {
    match pole {
        Pole::Real { rate } => rate,
        _ => 0.0,
    }
}

/// Number of states of the chains and of shared lags that `config` needs.
pub(super) fn shape(config: &CompensatorConfig, ts: f64) -> (usize, usize) {
    let least = least_order(&config.model, ts);
    (config.model.order(), config.order.unwrap_or(least).saturating_sub(least))
}

/// Computes the coefficients; `config` must have passed its validation.
pub(super) fn discretise<T: Real>(config: &CompensatorConfig, ts: f64) -> Discretised {
    let model = &config.model;
    let (n, excess) = shape(config, ts);
    let (mut real, pairs) = split_poles(model, ts);
    let lag_gain = |tau: f64| -libm::expm1(-ts / tau);

    // The lags of the chains: moved zeros and as many filter poles as fill the order, fast before slow: a fast lag
    // behind a slow one would need weights of the size of their ratio to show through it.
    let mut taus = moved_zeros(model, ts);
    while taus.len() < n && taus.push(config.time_constant).is_ok() {}
    sort_by_number(&mut taus, |&tau| tau);
    let g: Vec<f64, MAX_ORDER> = list_of(taus.iter().map(|&tau| lag_gain(tau)));

    // Sections of the y path: real poles two by two, then the pairs, a single real pole last.
    let single = if n & 1 == 1 { real.pop() } else { None };
    let mut y_feed: Vec<f64, MAX_ORDER> = Vec::new();
    let mut y_lead: Vec<f64, MAX_ORDER> = Vec::new();
    let mut y_dc: Vec<f64, MAX_ORDER> = Vec::new();
    let mut poles: Vec<Pole, MAX_ORDER> = Vec::new();
    let two_by_two = real.chunks_exact(2).map(|two| (two, None));
    let complex = pairs.iter().map(|pair| (&[][..], Some(*pair)));
    for ((two, pair), gains) in two_by_two.chain(complex).zip(g.chunks_exact(2)) {
        if let [g1, g2] = *gains {
            let (feed, lead, dc) = section_of_two(two, pair, g1, g2, ts);
            let _ = y_feed.extend_from_slice(&[feed, 0.0]);
            let _ = y_lead.extend_from_slice(&lead);
            let _ = y_dc.extend_from_slice(&[0.0, dc]);
        }
        let _ = poles.extend_from_slice(two);
        let _ = poles.extend_from_slice(pair.as_slice());
    }
    if let (Some(pole), Some(&last)) = (single, g.last()) {
        let integrating = pole == Pole::Integrator;
        let _ = y_feed.push(0.0);
        let _ = y_lead.push(lead(pole, last, ts));
        let _ = y_dc.push(if integrating { 0.0 } else { 1.0 });
        let _ = poles.push(pole);
    }

    let (delay, fraction) = whole_samples(model.dead_time + config.latency, ts, nearness::<T>());
    let taps = numerator(&poles, &model.zeros, ts, fraction);
    let alpha_gain = lag_gain(config.time_constant);
    Discretised {
        u_lead: chain_weights(&taps, &g),
        g,
        y_feed,
        y_lead,
        y_dc,
        e_gain: list_of(core::iter::repeat_n(alpha_gain, excess)),
        inv_gain: 1.0 / model.gain,
        gain: config.gain,
        delay,
    }
}

/// Weight `D` of the first-order section `dc*w + D*(x-w)` with the numerator `1-q*z^-1` of `pole` over a lag of gain `g`:
/// `g/(1-q)` for a static gain of 1, `g/ts` for an integrator.
fn lead(pole: Pole, g: f64, ts: f64) -> f64 {
    let (fall, _) = pole.one_minus_q();
    if pole == Pole::Integrator { g / ts } else { g / fall }
}

/// Feed `F`, weights `(E1, E2)` and static gain of a second-order section
/// `dc*w2 + E2*(x2-w2) + E1*(x-w1)`, `x2 = w1 + F*(x-w1)`, with the numerator of two poles over lags of gains `g1`, `g2`.
///
/// Two real poles are two first-order sections in a row (`F = D1`, `E2 = D2`, `E1 = 0`), so that nothing cancels at low
/// frequencies. A complex pair and two integrators need both differences: `F = 0` and
/// `g1*g2*(1-q1 z^-1)(1-q2 z^-1)/norm`, `norm = |1-q|^2` or `ts^2`, matched by `E1 = g1*g2/norm`,
/// `E2 = E1*((1-q1) + (1-q2) - g2)/g1`.
fn section_of_two(two: &[Pole], pair: Option<Pole>, g1: f64, g2: f64, ts: f64) -> (f64, [f64; 2], f64) {
    let matched = |norm: f64, sum: f64, dc: f64| {
        let e1 = g1 * g2 / norm;
        (0.0, [e1, e1 * (sum - g2) / g1], dc)
    };
    match (two, pair) {
        ([Pole::Integrator, Pole::Integrator], None) => matched(ts * ts, 0.0, 0.0),
        ([first, second], None) => {
            let dc = if *second == Pole::Integrator { 0.0 } else { 1.0 };
            (lead(*first, g1, ts), [0.0, lead(*second, g2, ts)], dc)
        }
        (_, Some(pair)) => {
            let (re, im) = pair.one_minus_q();
            matched(re * re + im * im, 2.0 * re, 1.0)
        }
        // The sections are made of chunks of exactly two poles or of one pair.
        (_, None) => (0.0, [0.0, 0.0], 0.0),
    }
}

/// Weights `E_j` such that `w_n + sum E_j*(w_(j-1) - w_j)` has the numerator `prod(g)*B/B(1)`, `taps = b_k`.
///
/// With `1 = z` the chain's static gain is 1 for any weights, so only `(P(z)-P(1) z^-n)/(1-z^-1)` is matched, whose
/// coefficients are partial sums of the taps.
fn chain_weights(taps: &[f64], g: &[f64]) -> Vec<f64, MAX_ORDER> {
    let product: f64 = g.iter().product();
    let mut rest = [0.0; MAX_ORDER + 1];
    let mut sum = 0.0;
    for (x, b) in rest.iter_mut().zip(taps).take(g.len()) {
        sum += b;
        *x = product * sum;
    }
    let mut weights = Vec::new();
    for (j, gain) in g.iter().enumerate() {
        let [lead, ..] = rest;
        let _ = weights.push(lead);
        let mut known = [0.0; MAX_ORDER + 1];
        known[0] = lead;
        for later in g.iter().skip(j + 1) {
            known = times_linear(&known, 1.0, later - 1.0);
        }
        let mut next = [0.0; MAX_ORDER + 1];
        for (x, (r, k)) in next.iter_mut().zip(rest.iter().zip(&known).skip(1)) {
            *x = (r - k) / gain;
        }
        rest = next;
    }
    weights
}
