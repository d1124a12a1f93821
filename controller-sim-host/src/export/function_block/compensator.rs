//! The disturbance compensator: two chains of lags, the delay line, the excess sections.

use super::super::block::{Builder, Expression, number, x};
use super::parts::{add, restart};
use super::plan::Chains;

/// What is done with the lags on the way.
#[derive(Clone, Copy, PartialEq)]
enum Lags {
    Move,
    Keep,
}

fn lag(chain: &str, n: usize) -> (String, String) {
    (format!("{chain}{n}"), format!("{chain}{n}_C"))
}

/// `to := input - w`; then `w <- w + gain*to` if the lags move. `before` is left with `w` as it was.
fn step(b: &mut Builder, (w, carry): &(String, String), gain: &str, input: &str, to: &str, lags: Lags) {
    b.set(to, x(input) - x(w));
    b.set("BEFORE", x(w));
    if lags == Lags::Move {
        add(b, w, carry, x(gain) * x(to));
    }
}

/// `FROM_U := w_n + sum E_j*(w_(j-1) - w_j)`, `w_0` being the delayed output in `U_DELAYED`.
fn from_u(b: &mut Builder, chains: &Chains, lags: Lags) {
    b.note("x_u = w_n + sum of EU_j*(w_j-1 - w_j), w_0 = delayed output");
    b.set("CX", x("U_DELAYED"));
    b.set("FROM_U", x("ZERO"));
    for n in 1..=chains.g.len() {
        step(b, &lag("WU", n), &format!("CG{n}"), "CX", "DIFF", lags);
        b.set("FROM_U", x("FROM_U") + x(&format!("EU{n}")) * x("DIFF"));
        b.set("CX", x("BEFORE"));
    }
    b.set("FROM_U", x("FROM_U") + x("CX"));
}

/// `FROM_Y`: sections of second order, and one of first order when the number of lags is odd.
fn from_y(b: &mut Builder, chains: &Chains, y: &str, lags: Lags) {
    b.note("x_y = DC*w_2 + EY_2*(x_2 - w_2) + EY_1*(x - w_1), x_2 = w_1 + FY*(x - w_1), section by section");
    b.set("CX", x(y));
    let order = chains.g.len();
    let mut n = 1;
    while n < order {
        let m = n + 1;
        step(b, &lag("WY", n), &format!("CG{n}"), "CX", "DIFF", lags);
        b.set("CX", x("BEFORE") + x(&format!("FY{n}")) * x("DIFF"));
        step(b, &lag("WY", m), &format!("CG{m}"), "CX", "DIFF2", lags);
        let [dc, e1, e2] = [format!("DC{m}"), format!("EY{n}"), format!("EY{m}")].map(|name| x(&name));
        b.set("CX", (dc * x("BEFORE") + e2 * x("DIFF2")) + e1 * x("DIFF"));
        n += 2;
    }
    if n == order {
        step(b, &lag("WY", n), &format!("CG{n}"), "CX", "DIFF", lags);
        b.set("CX", x(&format!("DC{n}")) * x("BEFORE") + x(&format!("EY{n}")) * x("DIFF"));
    }
    b.set("FROM_Y", x("CX"));
}

/// `EST`: minus the disturbance, filtered, not yet relative to the point of initialisation.
fn estimate(b: &mut Builder, chains: &Chains, y: &str, lags: Lags) {
    from_u(b, chains, lags);
    from_y(b, chains, y, lags);
    b.note("x = x_u - x_y/K");
    b.set("EST", x("FROM_U") - x("INV_GAIN") * x("FROM_Y"));
    for n in 1..=chains.e_gain.len() {
        b.note("mean of a lag's state before and after the sample");
        step(b, &lag("WE", n), &format!("EG{n}"), "EST", "DIFF", lags);
        b.set("EST", x("BEFORE") + x(&format!("EH{n}")) * x("DIFF"));
    }
}

/// One sample: `D_HAT` and `UF_NEW` from the measurement `y` and the output `applied`.
pub(super) fn sample(b: &mut Builder, chains: &Chains, y: &str, applied: &str) {
    b.note("disturbance compensator: the applied output into the delay line, the delayed one out of it");
    b.either(
        outside(chains.last_cell() - 1),
        |b| b.set("NEWEST", number(0)),
        |b| b.set("NEWEST", x("NEWEST") + number(1)),
    );
    b.set_cell("DELAY", "NEWEST", x(applied));
    tap(b, chains, chains.delay);
    estimate(b, chains, y, Lags::Move);
    b.note("d_hat = x at the point of initialisation - x, u_f = -gain*d_hat");
    b.set("DH", x("EST_0") - x("EST"));
    b.set("UF_NEW", -(x("COMP_GAIN") * x("DH")));
}

/// Whether `NEWEST` is not one of 0 to `last`. A number in the text and not a variable, so that nothing in memory, damaged or
/// not, leads out of the delay line.
fn outside(last: i32) -> Expression {
    x("NEWEST").below(number(0)).or(x("NEWEST").above(number(last)))
}

/// `U_DELAYED`: the sample that was pushed `samples` pushes before the newest. `NEWEST` is a cell, and `samples` less than there
/// are cells.
fn tap(b: &mut Builder, chains: &Chains, samples: usize) {
    let whole = |n: usize| number(i32::try_from(n).unwrap_or(i32::MAX));
    b.set("CELL", x("NEWEST") - whole(samples));
    b.when(x("CELL").below(number(0)), |b| b.set("CELL", x("CELL") + whole(chains.capacity)));
    b.set("U_DELAYED", Expression::Cell("DELAY".to_owned(), "CELL".to_owned()));
}

/// Everything at rest at the measurement `y` and the output `u`.
pub(super) fn settle(b: &mut Builder, chains: &Chains, y: &str, u: &str) {
    b.note("compensator at rest: the whole delay line at the output");
    b.repeat("CELL", 0, chains.last_cell(), |b| b.set_cell("DELAY", "CELL", x(u)));
    for n in 1..=chains.g.len() {
        let (w, carry) = lag("WU", n);
        restart(b, &w, &carry, x(u));
    }
    b.set("U_DELAYED", x(u));
    settle_y(b, chains, y);
}

/// The part that follows the measurement at rest at `y`; the chain of applied outputs goes on.
pub(super) fn settle_y(b: &mut Builder, chains: &Chains, y: &str) {
    b.set("CX", x(y));
    let order = chains.g.len();
    for n in 1..=order {
        let (w, carry) = lag("WY", n);
        restart(b, &w, &carry, x("CX"));
        if n % 2 == 0 || n == order {
            b.set("CX", x("CX") * x(&format!("DC{n}")));
        }
    }
    b.set("FROM_Y", x("CX"));
    from_u(b, chains, Lags::Keep);
    b.set("EST_0", x("FROM_U") - x("INV_GAIN") * x("FROM_Y"));
    for n in 1..=chains.e_gain.len() {
        let (w, carry) = lag("WE", n);
        restart(b, &w, &carry, x("EST_0"));
    }
}

/// The PID's parameters have changed: the estimate is referred anew, as a change of any parameter does. `JUMP` is what
/// `u_f` changes by.
pub(super) fn refer_anew(b: &mut Builder, chains: &Chains, y: &str, u: &str) {
    b.note("the compensator keeps its estimate");
    if chains.delay == 0 {
        b.set("U_DELAYED", x(u));
    } else {
        b.when(outside(chains.last_cell()), |b| b.set("NEWEST", number(0)));
        tap(b, chains, chains.delay - 1);
    }
    estimate(b, chains, y, Lags::Keep);
    b.set("DH", x("EST_0") - x("EST"));
    b.set("EST_0", x("DH") + x("EST"));
    b.set("JUMP", x("ZERO") * x("DH"));
}
