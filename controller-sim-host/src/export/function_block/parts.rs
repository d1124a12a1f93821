//! Pieces of statements that several parts of a sample are made of.

use super::super::block::{Builder, Expression, Type, x};

/// `sum + carry` takes `amount` in, compensated: `t = x + carry; s = sum + t; carry = t - (s - sum); sum = s`.
pub(super) fn add(b: &mut Builder, sum: &str, carry: &str, amount: Expression) {
    b.set("ACC_T", amount + x(carry));
    b.set("ACC_S", x(sum) + x("ACC_T"));
    b.set(carry, x("ACC_T") - (x("ACC_S") - x(sum)));
    b.set(sum, x("ACC_S"));
}

/// The sum starts again at `value`.
pub(super) fn restart(b: &mut Builder, sum: &str, carry: &str, value: Expression) {
    b.set(sum, value);
    b.set(carry, x("ZERO"));
}

/// `to := value` within `lo` and `hi`; what is not a number goes to `lo`. `value` is a variable other than `to`.
pub(super) fn clamp(b: &mut Builder, to: &str, value: &str, lo: &str, hi: &str) {
    b.either(x(value).above(x(lo)), |b| b.set(to, x(value)), |b| b.set(to, x(lo)));
    b.when(x(to).below(x(hi)).opposite(), |b| b.set(to, x(hi)));
}

/// Whether a number is neither infinite nor no number: every comparison with the latter is false.
pub(super) fn finite(name: &str) -> Expression {
    x(name).at_least(x("MOST_NEGATIVE")).and(x(name).at_most(x("LARGEST")))
}

/// The sum goes to `target`, by no more than `up`, or by no less than `down`, which is negative. `held`, a flag, says
/// whether that held it back.
pub(super) fn approach(
    b: &mut Builder,
    (sum, carry): (&str, &str),
    target: &str,
    (down, up): (&str, &str),
    held: Option<&str>,
) {
    let say = |b: &mut Builder, is: bool| {
        if let Some(held) = held {
            b.set(held, Expression::Flag(is));
        }
    };
    b.set("WAY", x(target) - x(sum));
    b.either(
        x("WAY").above(x(up)),
        |b| {
            add(b, sum, carry, x(up));
            say(b, true);
        },
        |b| {
            b.either(
                x("WAY").below(x(down)),
                |b| {
                    add(b, sum, carry, x(down));
                    say(b, true);
                },
                |b| {
                    restart(b, sum, carry, x(target));
                    say(b, false);
                },
            );
        },
    );
}

/// The working set-point goes to `target`, which is in its range.
pub(super) fn ramp(b: &mut Builder, (sum, carry): (&str, &str), target: &str) {
    b.either(
        x(target).is(x(sum)),
        |b| restart(b, sum, carry, x(target)),
        |b| approach(b, (sum, carry), target, ("SP_STEP_DOWN", "SP_STEP_UP"), None),
    );
}

/// The output after the limiter: range and rate. `sum` is the last output and becomes this one, `limited` is within the
/// range in any case.
pub(super) fn limit(
    b: &mut Builder,
    (sum, carry): (&str, &str),
    wanted: &str,
    steps: (&str, &str),
    limited: &str,
    rate: Option<&str>,
) {
    approach(b, (sum, carry), wanted, steps, rate);
    b.set(limited, x(sum));
    b.when(x(sum).above(x("OP_LIM_LO")).and(x(sum).below(x("OP_LIM_HI"))).opposite(), |b| {
        clamp(b, limited, sum, "OP_LIM_LO", "OP_LIM_HI");
        b.when(x(limited).is(x(sum)).opposite(), |b| restart(b, sum, carry, x(limited)));
    });
}

/// The measurement as the PID sees it for the set-point `r`: `to := r - (e - clamp(e, -w, w))`.
pub(super) fn deadband(b: &mut Builder, to: &str, r: &str, y: &str) {
    b.set("ERR", x(r) - x(y));
    b.either(
        x("ERR").above(x("DEADBAND")),
        |b| b.set(to, x(y) + x("DEADBAND")),
        |b| {
            b.either(
                x("ERR").below(x("DEADBAND_NEG")),
                |b| b.set(to, x(y) - x("DEADBAND")),
                |b| b.set(to, x(r)),
            );
        },
    );
}

/// A bit of the status word.
pub(super) fn status(b: &mut Builder, bit: &str) {
    b.set("STATUS", x("STATUS").or(x(bit)));
}

/// The number in double precision.
pub(super) fn long(name: &str) -> Expression {
    x(name).to(Type::Long)
}
