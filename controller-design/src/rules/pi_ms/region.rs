//! The gains that a frequency forbids.

use std::vec;
use std::vec::Vec;

use crate::frequency::{Features, Response, ascending};

/// Points of a decade.
const PER_DECADE: u32 = 60;
/// Most that the phase of the dead time turns between two frequencies that matter, in rad.
const TURN: f64 = 0.1;
/// The phase of the dead time up to which it is followed before the gains are known, in rad.
const TURNS: f64 = 60.0;
/// The phase of the dead time up to which the logarithmic points alone show which frequencies matter, in rad.
const SLOW_TURNS: f64 = 3.0;
/// Least frequency for an integrating plant, as a share of the largest proportional gain.
const SLOW: f64 = 1e-8;
/// Slack when frequencies are left out: an ellipse counts as this much larger.
const SLACK: f64 = 1.15;
/// Slack where only the size of the plant's gain counts.
const NEARLY: f64 = 1.05;

/// The ellipse of one frequency: centre `(-p, omega*q)`, half axes `r` and `omega*r`; for a plant of gain 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ellipse {
    pub(super) omega: f64,
    p: f64,
    q: f64,
    r: f64,
}

impl Ellipse {
    fn at(response: &Response, ms: f64, omega: f64) -> Option<Self> {
        let inverse = crate::model::Complex::ONE / response.at(omega);
        let r = inverse.abs() / ms;
        (inverse.is_finite() && r > 0.0 && r.is_finite()).then_some(Self {
            omega,
            p: inverse.re,
            q: inverse.im,
            r,
        })
    }

    /// The least `ki` forbidden at `kp`, if one at or above 0 is; negative when 0 is forbidden.
    pub(super) fn lower_edge(&self, kp: f64) -> Option<f64> {
        let x = kp + self.p;
        let square = (self.r - x) * (self.r + x);
        if square < 0.0 {
            return None;
        }
        let root = libm::sqrt(square);
        (self.q + root > 0.0).then_some(self.omega * (self.q - root))
    }

    /// The least `kp` above 0 forbidden to proportional control.
    fn left_edge(&self) -> Option<f64> {
        let square = (self.r - self.q) * (self.r + self.q);
        let left = -self.p - libm::sqrt(square.max(0.0));
        (square >= 0.0 && left > 0.0).then_some(left)
    }

    /// `|S|` with these gains.
    pub(super) fn sensitivity(&self, ms: f64, kp: f64, ki: f64) -> f64 {
        ms * self.r / libm::hypot(self.p + kp, self.q - ki / self.omega)
    }

    /// Whether these gains would be forbidden at some phase of the plant.
    fn in_reach(&self, kp: f64, ki: f64, ms: f64) -> bool {
        self.r * (ms - 1.0) <= NEARLY * libm::hypot(kp, ki / self.omega)
    }

    /// Whether the ellipse can meet `0..kp_hi` by `0..ki_hi`; `phase_known`: not only its size counts.
    fn matters(&self, kp_hi: f64, ki_hi: f64, ms: f64, phase_known: bool) -> bool {
        let r = SLACK * self.r;
        if phase_known {
            -self.p - r <= kp_hi
                && r - self.p >= 0.0
                && self.q + r > 0.0
                && self.omega * (self.q - r) <= ki_hi
        } else {
            self.in_reach(kp_hi, ki_hi, ms)
        }
    }
}

/// The ellipses of all frequencies that matter, for a plant with its gain taken out.
#[derive(Debug)]
pub(super) struct Region<'a> {
    response: &'a Response,
    ms: f64,
    kp_hi: f64,
    features: &'a Features,
    /// Everywhere, for a last look.
    all: Vec<Ellipse>,
    /// For each interval of `all`: whether the turns of the dead time in it are among `near`.
    followed: Vec<bool>,
    /// Where an ellipse meets the gains in question, dense.
    near: Vec<Ellipse>,
}

impl<'a> Region<'a> {
    /// `circle`: the plant's gain does not fall at high frequency. `None` if proportional control has no limit.
    pub(super) fn new(response: &'a Response, features: &'a Features, ms: f64, circle: bool) -> Option<Self> {
        let (low, high) = features.range()?;
        let grid = features.logarithmic(low, high, PER_DECADE);
        let ellipse = |omega: &f64| Ellipse::at(response, ms, *omega);
        let all: Vec<Ellipse> = grid.iter().filter_map(ellipse).collect();
        let (near, followed) = (all.clone(), vec![false; all.len()]);
        let mut region = Self { response, ms, kp_hi: f64::INFINITY, features, near, followed, all };
        if circle {
            // At infinity the loop gain goes round a circle of radius kp/|1/G|.
            let last = region.all.last()?;
            region.kp_hi = last.r * ms - last.r;
        }
        region.limit_kp();
        if !region.kp_hi.is_finite() {
            return None;
        }
        let slow = SLOW * region.kp_hi;
        if response.integrators() > 0 && slow > 0.0 && slow < low {
            // An integrating plant crosses over at a frequency of the size of kp, however small kp is.
            let more = features.logarithmic(slow, low, PER_DECADE);
            let mut all: Vec<Ellipse> = more.iter().filter(|w| **w < low).filter_map(ellipse).collect();
            all.append(&mut region.all);
            (region.near, region.followed, region.all) = (all.clone(), vec![false; all.len()], all);
        }
        let ki_hi = 1.5 * super::search::rough_ki(&region);
        let delay = features.longest_delay();
        let known = |e: &Ellipse| e.omega * delay <= SLOW_TURNS;
        let matters: Vec<bool> =
            region.all.iter().map(|e| e.matters(region.kp_hi, ki_hi, ms, known(e))).collect();
        let mut omegas = Vec::new();
        for (k, pair) in region.all.windows(2).enumerate() {
            let around = matters.get(k.saturating_sub(1)..(k + 3).min(matters.len())).unwrap_or(&[]);
            if let [a, b] = pair
                && around.contains(&true)
            {
                omegas.push(a.omega);
                omegas.push(b.omega);
                if a.omega * delay <= TURNS {
                    omegas.extend(features.turning(a.omega, b.omega, TURN));
                    if let Some(followed) = region.followed.get_mut(k) {
                        *followed = true;
                    }
                }
            }
        }
        region.near = ascending(omegas).iter().filter_map(ellipse).collect();
        region.limit_kp();
        Some(region)
    }

    fn limit_kp(&mut self) {
        let first = self.near.iter().filter_map(Ellipse::left_edge).fold(f64::INFINITY, f64::min);
        self.kp_hi = self.kp_hi.min(first);
    }

    pub(super) fn kp_hi(&self) -> f64 {
        self.kp_hi
    }

    pub(super) fn ms(&self) -> f64 {
        self.ms
    }

    pub(super) fn at(&self, omega: f64) -> Option<Ellipse> {
        Ellipse::at(self.response, self.ms, omega)
    }

    pub(super) fn near(&self) -> &[Ellipse] {
        &self.near
    }

    pub(super) fn all(&self) -> &[Ellipse] {
        &self.all
    }

    /// Follows the turns of the dead time wherever these gains could break the limit at some phase; whether there
    /// was anything new to follow.
    pub(super) fn follow(&mut self, kp: f64, ki: f64) -> bool {
        let delay = self.features.longest_delay();
        let mut omegas = Vec::new();
        for (pair, followed) in self.all.windows(2).zip(&mut self.followed) {
            if let [a, b] = pair
                && !*followed
                && b.omega * delay > SLOW_TURNS
                && (a.in_reach(kp, ki, self.ms) || b.in_reach(kp, ki, self.ms))
            {
                *followed = true;
                omegas.extend(self.features.turning(a.omega, b.omega, TURN));
            }
        }
        self.add(&omegas);
        !omegas.is_empty()
    }

    /// Takes more frequencies into account.
    pub(super) fn add(&mut self, omegas: &[f64]) {
        let more: Vec<Ellipse> = omegas.iter().filter_map(|omega| self.at(*omega)).collect();
        self.near.extend(more);
        self.near.sort_by(|a, b| a.omega.total_cmp(&b.omega));
        self.near.dedup_by(|a, b| a.omega == b.omega);
        self.limit_kp();
    }
}
