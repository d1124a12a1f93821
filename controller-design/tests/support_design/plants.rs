//! Plants as the process industry has them, with touches of nonsense, and requests for them.

use controller_design::design::{EstimatorFilter, Filter, Method, ObserverFilter, Request};
use controller_design::rules::Wish;

use super::Draws;

/// A plant as an expression, and its time scale in s: lags over decades or equal, complex pairs, zeros of either side, dead
/// time from none to hundreds of lags, integrators.
pub(crate) fn expression(draws: &mut Draws<'_>) -> (String, f64) {
    let scale = if draws.one_in(3) { draws.decades(-6.0, 6.0) } else { 1.0 };
    let gain = if draws.one_in(3) { draws.decades(-9.0, 9.0) } else { draws.decades(-1.0, 1.0) };
    let sign = if draws.one_in(4) { "-" } else { "" };
    let mut top = format!("{sign}{gain:e}");
    let mut bottom = String::from("1");
    let mut lag = scale;
    let lags = [1, 2, 3, 1, 2, 4, 8, 0][usize::from(draws.below(8))];
    for _ in 0..lags {
        if !draws.one_in(3) {
            lag = scale * draws.decades(-3.0, 0.5);
        }
        let sign = if draws.one_in(30) { '-' } else { '+' };
        bottom += &format!("*(1{sign}{lag:e}*s)");
    }
    if draws.one_in(4) {
        let (time, damping) = (scale * draws.decades(-2.0, 0.5), draws.decades(-3.0, 0.0));
        let sign = if draws.one_in(20) { '-' } else { '+' };
        bottom += &format!("*(1{sign}{:e}*s+{:e}*s^2)", 2.0 * damping * time, time * time);
    }
    let order = bottom.matches("(1").count();
    if order > 1 && draws.one_in(3) {
        let sign = if draws.one_in(2) { '-' } else { '+' };
        top += &format!("*(1{sign}{:e}*s)", scale * draws.decades(-3.0, 1.0));
    }
    if order > 3 && draws.one_in(5) {
        let (time, damping) = (scale * draws.decades(-2.0, 0.5), draws.between(-0.5, 1.0));
        top += &format!("*(1+{:e}*s+{:e}*s^2)", 2.0 * damping * time, time * time);
    }
    match draws.below(12) {
        7..=9 => bottom += "*s",
        10 => bottom += "*s^2",
        11 if order > 0 => top += "*s",
        _ => {}
    }
    match draws.below(8) {
        0..=4 => top += &format!("*exp(-{:e}*s)", scale * draws.decades(-2.0, 0.7)),
        5 => top += &format!("*exp(-{:e}*s)", scale * draws.decades(-5.0, 2.5)),
        _ => {}
    }
    (format!("{top}/({bottom})"), scale)
}

/// A request for a plant with that time scale.
pub(crate) fn request(draws: &mut Draws<'_>, method: Method, scale: f64) -> Request {
    let ts = scale * if draws.one_in(4) { draws.decades(-6.0, 1.5) } else { draws.decades(-3.0, -1.0) };
    let mut request = Request::new(method, draws.mostly(ts));
    if draws.one_in(4) {
        let latency = if draws.one_in(2) { ts } else { scale * draws.decades(-4.0, 1.0) };
        request.latency = draws.mostly(latency);
    }
    let time = |draws: &mut Draws<'_>| {
        let time = scale * draws.decades(-4.0, 1.0);
        draws.mostly(time)
    };
    let gain = |draws: &mut Draws<'_>| {
        let gain = draws.decades(-1.0, 3.0);
        draws.mostly(gain)
    };
    request.filter = match draws.below(4) {
        1 => Filter::Time(time(draws)),
        2 => Filter::NoiseGain(gain(draws)),
        _ => Filter::Default,
    };
    request.estimator_filter = match draws.below(4) {
        1 => EstimatorFilter::Time(time(draws)),
        2 => EstimatorFilter::NoiseGain(gain(draws)),
        _ => EstimatorFilter::Default,
    };
    request.observer_filter = match draws.below(8) {
        1 => ObserverFilter::Time(time(draws)),
        2 => ObserverFilter::NoiseRatio(gain(draws)),
        3 => {
            let wish = [Wish::Iae, Wish::Ise, Wish::Itae, Wish::EMax, Wish::RampIe];
            ObserverFilter::Wanted(wish[usize::from(draws.below(5))](gain(draws) * scale))
        }
        _ => ObserverFilter::Default,
    };
    if draws.one_in(3) {
        let ms = if draws.one_in(3) { 2.0 } else { draws.between(1.0, 4.0) };
        request.ms = Some(draws.mostly(ms));
    }
    if draws.one_in(3) {
        let most = draws.between(1.0, 3.0);
        request.ms_max = Some(draws.mostly(most));
    }
    request
}
