//! The runtime's law against three other forms, `f64`, to 1e-12 of the largest output.

use super::oracle::{Case, ErrorBased, Feedback, Form, StateSpace};
use controller_core::{Adrc, AdrcInput, AdrcState};

/// Numbers between 0 and 1, the same on every machine.
pub(crate) struct Draw(pub(crate) u64);

impl Draw {
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn word(&mut self) -> u32 {
        (self.unit() * 4_294_967_296.0) as u32
    }

    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    fn scale(&mut self, decades: f64) -> f64 {
        10.0_f64.powf(self.between(-decades, decades))
    }
}

/// Observers with a triple pole, three real ones, or a real one and a pair, of 0.25 to 2.5 per sample; feedbacks with
/// two poles of 0.02 to 0.8 per sample; periods, gains and signs over many decades.
fn case(draw: &mut Draw, kind: usize) -> Case {
    let h = draw.scale(5.0);
    let mut fast = || -draw.between(0.25, 2.5) / h;
    let (one, two, three) = (fast(), fast(), fast());
    let poles = match kind {
        0 => [(one, 0.0); 3],
        1 => [(one, 0.0), (two, 0.0), (three, 0.0)],
        _ => [(one, 0.0), (two, three), (two, -three)],
    };
    let (slow, damping) = (draw.between(0.02, 0.8) / h, draw.between(0.6, 1.2));
    let b0 = draw.scale(6.0) * if draw.unit() < 0.5 { -1.0 } else { 1.0 };
    Case { b0, kp: slow * slow, kd: 2.0 * damping * slow, poles, h }
}

/// Runs the runtime and `others` on the same signals: a plant `y'' = b*(u + d) - ..` that differs from the model, noise on
/// its output, steps of the set-point; `limit` bounds what is applied.
fn compare(case: Case, others: &mut [&mut dyn Form], limit: f64, draw: &mut Draw) -> f64 {
    let law = Adrc::<f64>::new(&case.config(), case.h).expect("valid");
    let mut state = AdrcState::default();
    let (mut y, mut slope, mut applied) = (0.0, 0.0, 0.0_f64);
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    let mut r = 0.0;
    for k in 0..400 {
        if k % 80 == 0 {
            r = draw.between(-1.0, 1.0);
        }
        let seen = y + 1e-3 * draw.between(-1.0, 1.0);
        let v = law.step(&mut state, AdrcInput { r, y: seen, u: applied }).u();
        largest = largest.max(v.abs());
        for form in others.iter_mut() {
            worst = worst.max((form.step(r, seen, applied) - v).abs());
        }
        applied = v.clamp(-limit, limit);
        // In units of one sample: the gain is 0.8 times the model's, with some damping.
        let push = 0.8 * case.b0 * case.h * case.h * applied - 0.02 * slope - 1e-4;
        y += slope + 0.5 * push;
        slope += push;
    }
    assert!(largest > 0.0 && largest.is_finite());
    worst / largest
}

#[test]
fn three_forms_agree() {
    let mut draw = Draw(1);
    let mut worst = 0.0_f64;
    for index in 0..600 {
        let case = case(&mut draw, index % 3);
        let mut state_space = StateSpace::new(case);
        let mut feedback = Feedback::new(case);
        let mut error_based = ErrorBased::new(case);
        let forms: &mut [&mut dyn Form] = &mut [&mut state_space, &mut feedback, &mut error_based];
        let error = compare(case, forms, f64::INFINITY, &mut draw);
        assert!(error <= 1e-12, "{case:?}: {error:e}");
        worst = worst.max(error);
    }
    println!("worst {worst:.1e}");
}

/// With limits, the forms that are told what was applied.
#[test]
fn the_forms_agree_in_saturation() {
    let mut draw = Draw(2);
    for index in 0..600 {
        let case = case(&mut draw, index % 3);
        let (mut state_space, mut feedback) = (StateSpace::new(case), Feedback::new(case));
        let limit = 0.1 * case.kp / case.b0.abs();
        let forms: &mut [&mut dyn Form] = &mut [&mut state_space, &mut feedback];
        let error = compare(case, forms, limit, &mut draw);
        assert!(error <= 1e-12, "{case:?}: {error:e}");
    }
}
