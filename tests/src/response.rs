//! The transfer functions `C_u(z)`, `C_y(z)` of a compensator from the coefficients that its step uses, by its published
//! difference equation.

use crate::oracle::complex::{Complex, add, div, mul, pow, scale, unit, unit_minus_one};
use controller_core::{Coefficients, Real};

/// `C_u` and `C_y` at `z = exp(j*phase)`, phase in rad per sample.
#[must_use]
pub fn response<T: Real>(c: &Coefficients<'_, T>, phase: f64) -> (Complex, Complex) {
    let (back, ahead) = (unit(-phase), unit_minus_one(phase));
    // w/x of `w[k+1] = w[k] + g*(x[k]-w[k])` is g/(z - 1 + g).
    let lag = |g: T| div((g.to_f64(), 0.0), add(ahead, (g.to_f64(), 0.0)));
    // (x - w)/x = (z - 1)/(z - 1 + g): written out, since 1 - w/x cancels at low frequencies.
    let difference = |g: T| div(ahead, add(ahead, (g.to_f64(), 0.0)));
    let one = (1.0, 0.0);

    let mut x = one;
    let mut from_u = (0.0, 0.0);
    for (&g, &lead) in c.g.iter().zip(c.u_lead) {
        let w = mul(lag(g), x);
        from_u = add(from_u, scale(lead.to_f64(), mul(x, difference(g))));
        x = w;
    }
    from_u = mul(add(from_u, x), pow(back, c.delay + 1));

    let mut from_y = one;
    let leads = c.y_feed.chunks(2).zip(c.y_lead.chunks(2));
    for ((g, (feed, lead)), dc) in c.g.chunks(2).zip(leads).zip(c.y_dc.chunks(2)) {
        let w1 = lag(g[0]);
        let first = difference(g[0]);
        let mut out = scale(lead[0].to_f64(), first);
        let mut w = w1;
        if g.len() == 2 {
            let x2 = add(w1, scale(feed[0].to_f64(), first));
            w = mul(lag(g[1]), x2);
            out = add(out, scale(lead[1].to_f64(), mul(x2, difference(g[1]))));
        }
        out = add(out, scale(dc[dc.len() - 1].to_f64(), w));
        from_y = mul(from_y, out);
    }
    from_y = scale(-c.inv_gain.to_f64(), from_y);

    let mut shared = (c.gain.to_f64(), 0.0);
    for &g in c.e_gain {
        let w = lag(g);
        shared = mul(shared, add(w, scale(0.5 * g.to_f64(), difference(g))));
    }
    (mul(shared, from_u), mul(shared, from_y))
}
