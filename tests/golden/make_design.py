"""Golden values of the closed-form tuning rules, with 60 digits.

Writes controller-design/tests/data/design.csv. Needs mpmath. Run: python3 tests/golden/make_design.py

Nothing here shares a formula with the crate where there is a second one:
 * areas: quotient of power series, checked against the derivatives at s = 0 by contour integration;
 * MOMI: the 3x3 system of eq. (6), solved by elimination;
 * DRMO: flatness of |K_I + (K_P + g0)s + (K_D + g1)s^2 + g2 s^3 + g3 s^4|^2 with 1/G* = g0 + g1 s + ..;
 * model: the cubic of eq. (14) for the dead time itself, all its roots, the smallest that is real, not negative
   and has a2 >= 0;
 * K_FD: both roots of the quadratic that eqs (18), (19) solve, the one in (0, 1);
 * T_F, T_FD: bisection on a grid of 100 points a decade.
An empty field: there is no such value and the rule must refuse (or the estimator must be off).
"""

import csv
import os

from mpmath import exp, factorial, log10, lu_solve, matrix, mp, mpc, mpf, pi, polyroots, quad, sqrt

mp.dps = 60

# name, gain, numerator factors, denominator factors (ascending), dead time [s]
LAG = lambda t: [1.0, t]
PLANTS = [
    ("second-order-delay", 1.0, [], [LAG(1.0), LAG(1.0)], 0.5),
    ("third-order-delay", 1.0, [], [LAG(1.0)] * 3, 0.2),
    ("two-lags-delay", 1.0, [], [LAG(0.2), LAG(1.0)], 0.2),
    ("four-lags-delay", 1.0, [], [LAG(1.0)] * 4, 1.0),
    ("four-spread-lags", 1.0, [], [LAG(1.0), LAG(0.2), LAG(0.04), LAG(0.008)], 0.0),
    ("three-lags-long-delay", 1.0, [], [LAG(1.0)] * 3, 5.0),
    ("first-order-delay", 1.98, [], [LAG(80.3)], 3.2),
    ("first-order-short-delay", 1.0, [], [LAG(1.0)], 0.003),
    ("first-order-long-delay", -0.4, [], [LAG(1.0)], 20.0),
    ("two-lags", 1.0, [], [LAG(1.0), LAG(0.2)], 0.0),
    ("two-equal-lags", 3.0, [], [LAG(7.0)] * 2, 0.0),
    ("two-far-lags", 1.0, [], [LAG(1.0), LAG(0.01)], 0.0),
    ("three-lags", -2500.0, [], [LAG(1.0), LAG(0.7), LAG(0.1)], 0.0),
    ("eight-lags", 1.0, [], [LAG(1.0)] * 8, 0.0),
    ("eight-lags-fast", 1e5, [], [LAG(1e-6)] * 8, 3e-7),
    ("eight-lags-slow", -1e-5, [], [LAG(1e6)] * 8, 1e5),
    ("twenty-lags", 1.0, [], [LAG(0.3)] * 20, 0.0),
    ("falling-lags", 2.0, [], [LAG(0.5**k) for k in range(12)], 0.05),
    ("underdamped", 1.0, [], [[1.0, 0.8, 1.0]], 0.1),
    ("weakly-damped", 1.0, [], [[1.0, 0.4, 1.0]], 0.2),
    ("underdamped-and-lag", 0.2, [], [[1.0, 1.0, 1.0], LAG(2.0)], 0.0),
    ("right-zero", 1.0, [LAG(-0.3)], [LAG(1.0)] * 3, 0.0),
    ("right-zero-large", 1.0, [LAG(-2.0)], [LAG(1.0)] * 3, 0.0),
    ("right-zero-delay", 10.0, [LAG(-1.0)], [LAG(3.0), LAG(2.0)], 0.5),
    ("left-zero-fast", 1.0, [LAG(0.05)], [LAG(1.0), LAG(0.5), LAG(0.3)], 0.1),
    ("left-zero", 5.0, [LAG(0.2)], [[1.0, 3.2, 3.6, 1.6]], 0.0),
    ("left-zero-slow", 1.0, [LAG(0.9)], [LAG(1.0), LAG(0.5), LAG(0.25)], 0.0),
    ("left-zero-slower", 1.0, [LAG(2.0)], [LAG(1.0), LAG(0.5), LAG(0.1)], 0.1),
    ("left-zero-overtakes", 1.0, [LAG(1.5)], [LAG(1.0)] * 4, 0.3),
    ("expanded-eight", 1.0, [], [[1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0]], 0.0),
    ("expanded-six", 4.0, [], [[1.0, 4.1, 6.3, 4.9, 2.05, 0.44, 0.038]], 0.6),
    ("complex-zeros", 1.0, [[1.0, 0.2, 0.5]], [LAG(1.0)] * 5, 0.0),
    ("fast-thermal", 0.35, [], [LAG(240.0), LAG(31.0), LAG(4.0)], 12.0),
    ("microseconds", 48.0, [], [[1.0, 2.2e-5, 1.6e-10]], 1.5e-6),
    ("days", 1e-9, [], [LAG(9e5), LAG(4e5)], 3e4),
    ("huge-gain", -7e12, [], [LAG(2.0), LAG(1.0), LAG(0.5)], 0.25),
    ("delay-below-sample", 1.0, [], [LAG(1.0), LAG(0.6)], 0.0007),
    ("delay-only-almost", 1.0, [], [LAG(0.001)], 1.0),
    ("six-lags-delay", 1.0, [], [LAG(1.0)] * 6, 3.0),
    ("fast-pair-of-zeros", 1.0, [LAG(0.01), LAG(-0.02)], [LAG(1.0), LAG(0.4), LAG(0.2), LAG(0.1)], 0.15),
]


def expression(gain, num, den, delay):
    def text(p):
        terms = ["1"] + [f"{c!r}*s^{k}" if k > 1 else f"{c!r}*s" for k, c in enumerate(p) if k]
        return "(" + "+".join(terms).replace("+-", "-") + ")"

    top = [repr(gain)] + ([f"exp(-{delay!r}*s)"] if delay else []) + [text(p) for p in num]
    return "*".join(top) + "/(" + "*".join(text(p) for p in den) + ")"


def areas_of(gain, num, den, delay, count=9):
    """Coefficients of the series by powers of -s."""
    series = [mpf(delay) ** k / factorial(k) for k in range(count)]
    for p in num:
        c = [mpf(x) * (-1) ** i for i, x in enumerate(p)]
        series = [sum(c[i] * series[k - i] for i in range(min(k, len(c) - 1) + 1)) for k in range(count)]
    for p in den:
        c = [mpf(x) * (-1) ** i for i, x in enumerate(p)]
        out = []
        for k in range(count):
            out.append(series[k] - sum(c[i] * out[k - i] for i in range(1, min(k, len(c) - 1) + 1)))
        series = out
    return [mpf(gain) * x for x in series]


def check_by_contour(gain, num, den, delay, areas):
    """Cauchy's integral round s = 0, inside the nearest pole, for A_0..A_5."""
    radius = 1 / (4 * sum(abs(mpf(p[i])) ** (mpf(1) / i) for p in den for i in range(1, len(p))) + mpf(delay))

    def g(s):
        value = gain * exp(-s * delay)
        for p in num:
            value *= sum(mpf(c) * s**i for i, c in enumerate(p))
        for p in den:
            value /= sum(mpf(c) * s**i for i, c in enumerate(p))
        return value

    points = 96
    samples = [(g(radius * exp(mpc(0, 2 * pi * j / points))), exp(mpc(0, -2 * pi * j / points))) for j in range(points)]
    for k in range(6):
        value = sum(v * w**k for v, w in samples) / points / radius**k * (-1) ** k
        assert abs(value.real - areas[k]) < mpf(10) ** -20 * max(abs(areas[k]), abs(areas[0]) / radius**k), k


def filtered(a, tf):
    out = []
    for x in a:
        out.append(x + (tf * out[-1] if out else 0))
    return out


def momi(a, tf):
    f = filtered(a, tf)
    try:
        k = lu_solve(
            matrix([[-f[1], f[0], 0], [-f[3], f[2], -f[1]], [-f[5], f[4], -f[3]]]), matrix([mpf(-1) / 2, 0, 0])
        )
    except ZeroDivisionError:
        return None
    ki, kp, kd = k
    if kp * a[0] <= 0 or ki * a[0] <= 0:
        return None
    return kp, ki, kd


def drmo(a, tf):
    f = filtered(a, tf)
    k = lu_solve(
        matrix([[-f[1], f[0], 0], [-f[3], f[2], -f[1]], [-f[5], f[4], -f[3]]]), matrix([mpf(-1) / 2, 0, 0])
    )
    kd = k[2]
    # 1/G*, G* = sum (-1)^k f_k s^k
    c = [x * (-1) ** i for i, x in enumerate(f)]
    g = [1 / c[0]]
    for i in range(1, 4):
        g.append(-sum(c[j] * g[i - j] for j in range(1, i + 1)) / c[0])
    sign = 1 if a[0] > 0 else -1
    g = [sign * x for x in g]
    d = sign * kd + g[1]
    radicand = g[2] ** 2 - g[3] * d
    if radicand < 0 or d <= 0:
        return None
    x = d**2 / (g[2] + sqrt(radicand))
    kp, ki = x - g[0], x**2 / (2 * d)
    return None if kp <= 0 or x <= 0 else (sign * kp, sign * ki, kd)


def model(a):
    """gain, a1, a2, dead time of eq. (14); None where there is none."""
    n = [x / a[0] for x in a]
    t = n[1]
    n = [x / t**i for i, x in enumerate(n)]
    found = []
    roots = polyroots(
        [mpf(1) / 6, mpf(-1) / 2, 1 - n[2], 2 * n[2] - n[3] - 1], maxsteps=3000, extraprec=4000, error=False
    )
    for root in roots:
        real, tiny = root.real, mpf(10) ** -24
        if abs(root.imag) > tiny or real < -tiny or real > 1 + tiny:
            continue
        real = mpf(0) if abs(real) < tiny else real
        a1 = 1 - real
        a2 = -n[2] + a1 + real**2 / 2
        if a2 > -tiny:
            found.append((real, a1, mpf(0) if abs(a2) < tiny else a2))
    if not found:
        return None
    real, a1, a2 = min(found)
    return a[0], a1 * t, a2 * t**2, real * t


def kfd_of(pid, m, tf, tfd):
    (kp, ki, kd), (gain, a1, _, dead) = pid, m
    kip, kpp, kdp = ki * gain, kp * gain, kd * gain
    d0, f0 = (1 + kpp) ** 2, a1 + kdp + tf + dead
    a0 = -d0 + 2 * f0 * kip + kip**2 * (tf**2 - 3 * tfd**2)
    b0 = 2 * d0 - 4 * f0 * kip + kip**2 * (-2 * tf**2 + 12 * tfd**2 + 6 * tfd * dead + dead**2)
    c0 = -d0 + 2 * f0 * kip + kip**2 * tf**2
    if c0 >= 0:
        return mpf(0)
    roots = [(-b0 + s * sqrt(b0**2 - 4 * a0 * c0)) / (2 * a0) for s in (1, -1)]
    inside = [r.real for r in roots if abs(mpc(r).imag) == 0 and 0 < mpc(r).real < 1]
    assert len(inside) == 1
    return inside[0]


def noise(pid, tf, ts):
    kp, ki, kd = pid
    w = pi / 2 / ts
    return abs(mpc(ki - kd * w**2, kp * w)) / (w * sqrt(1 + (tf * w) ** 2))


def noise_of_estimator(m, kfd, tfd, ts):
    gain, a1, a2, _ = m
    s = mpc(0, pi / 2 / ts)
    return kfd * abs(1 + a1 * s + a2 * s**2) / abs(gain) / abs(1 + tfd * s) ** 3


def first_below(f, low, high, limit):
    """The least x in [low, high] with f(x) <= limit."""
    if f(low) <= limit:
        return mpf(low)
    ratio = mpf(10) ** (mpf(1) / 100)
    x = mpf(low)
    while x < high:
        y = x * ratio
        if f(y) <= limit:
            for _ in range(110):
                z = sqrt(x * y)
                (x, y) = (x, z) if f(z) <= limit else (z, y)
            return y
        x = y
    raise ValueError("no such filter")


def digits(value):
    return "" if value is None else mp.nstr(value, 20, min_fixed=1, max_fixed=0)


def round_up(value):
    """To two digits, so that the file can be read."""
    step = mpf(10) ** (int(mp.floor(log10(value))) - 1)
    return float(mp.nstr(mp.ceil(value / step) * step, 3))


def row(name, gain, num, den, delay):
    a = areas_of(gain, num, den, delay)
    check_by_contour(gain, num, den, delay, a)
    time = abs(a[1] / a[0])
    out = {"name": name, "plant": expression(gain, num, den, delay)}
    out |= {f"a{k}": digits(x) for k, x in enumerate(a)}
    tf, tfd, ts = (float(mp.nstr(x * time, 2)) for x in (0.05, 0.04, 0.002))
    out |= {"tf": repr(tf), "tfd": repr(tfd), "ts": repr(ts)}
    pid, load = (momi(a, mpf(tf)), drmo(a, mpf(tf))) if a[1] * a[0] > 0 else (None, None)
    for rule, gains in (("momi", pid), ("drmo", load)):
        out |= {f"{rule}_{k}": digits(x) for k, x in zip(("kp", "ki", "kd"), gains or (None,) * 3)}
    m = model(a) if a[1] * a[0] > 0 else None
    out |= {f"model_{k}": digits(x) for k, x in zip(("a1", "a2", "dead_time"), (m or (None,) * 4)[1:])}
    out["kfd"] = digits(kfd_of(pid, m, mpf(tf), mpf(tfd)) if pid and m else None)
    if pid is None:
        return out
    f = lambda x: noise(momi(a, x), x, mpf(ts)) if momi(a, x) else mpf(10) ** 300
    kpidn = round_up(sqrt(f(mpf(tf)) * f(mpf(tf) * mpf("1.3"))))
    tf_star = first_below(f, mpf(ts), 100 * time, mpf(kpidn))
    star = momi(a, tf_star)
    out |= {"kpidn": repr(kpidn), "momi_tf": digits(tf_star)}
    out |= {f"limit_{k}": digits(x) for k, x in zip(("kp", "ki", "kd"), star)}
    d = lambda x: noise(drmo(a, x), x, mpf(ts)) if drmo(a, x) else mpf(10) ** 300
    try:
        out["drmo_tf"] = digits(first_below(d, mpf(ts), 100 * time, mpf(kpidn)))
    except ValueError:
        out["drmo_tf"] = ""
    if m is None:
        return out
    k = lambda x: noise_of_estimator(m, kfd_of(star, m, tf_star, x), x, mpf(ts))
    if kfd_of(star, m, tf_star, mpf(tfd)) == 0:
        return out
    kden = round_up(k(mpf(tfd)))
    tfd_star = first_below(k, mpf(ts), 100 * time, mpf(kden))
    out |= {"kden": repr(kden), "limit_tfd": digits(tfd_star)}
    out["limit_kfd"] = digits(kfd_of(star, m, tf_star, tfd_star))
    return out


COLUMNS = (
    ["name", "plant"]
    + [f"a{k}" for k in range(9)]
    + ["tf", "tfd", "ts", "momi_kp", "momi_ki", "momi_kd", "drmo_kp", "drmo_ki", "drmo_kd"]
    + ["model_a1", "model_a2", "model_dead_time", "kfd", "kpidn", "momi_tf", "limit_kp", "limit_ki", "limit_kd"]
    + ["drmo_tf", "kden", "limit_tfd", "limit_kfd"]
)


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    path = os.path.join(here, "..", "..", "controller-design", "tests", "data", "design.csv")
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        writer.writeheader()
        for plant in PLANTS:
            writer.writerow(row(*plant))


if __name__ == "__main__":
    main()
