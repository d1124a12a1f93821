#!/usr/bin/env python3
"""Writes hold.csv: frequency responses of zero-order-hold equivalents, from 400-digit arithmetic.

    python3 -m venv .venv && .venv/bin/pip install mpmath
    .venv/bin/python make_hold.py            # writes hold.csv beside this file
    .venv/bin/python make_hold.py --check    # compares with the file instead

Method: controllable canonical form in the time unit `ts`, matrix exponentials of the augmented matrix by mpmath, the
resolvent solved at each frequency. For plants with two more poles than zeros the result is also compared with the sum of
the continuous response over its aliases, which uses neither states nor exponentials of matrices.
"""

import sys
from pathlib import Path

import mpmath as mp

mp.mp.dps = 400
OUTPUT = Path(__file__).with_name("hold.csv")
THETAS = [1e-6, 1e-3, 0.03, 0.3, 1.0, 2.0, 2.9, 3.1]


def product(factors):
    p = [mp.mpf(1)]
    for f in factors:
        q = [mp.mpf(0)] * (len(p) + len(f) - 1)
        for i, a in enumerate(p):
            for j, b in enumerate(f):
                q[i + j] += a * mp.mpf(b)
        p = q
    return p


def cases():
    """gain, zeros, poles (ascending coefficients, doubles), integrators, dead time, ts, latency."""
    eight = [[1.0, 1.0]] * 8
    for ratio in (1e-6, 1e-3, 0.1, 1.0, 50.0):
        yield 1.0, [], eight, 0, 0.0, ratio, 0.0
        yield 1.0, [], [[1.0, 1.0]] * 20, 0, 0.3 * ratio, ratio, 0.0
        yield -3.0e5, [[1.0, -0.3]], [[1.0, 1.0]] * 3, 0, 0.25, ratio, 0.4 * ratio
        yield 2.5, [], [[1.0, 0.1, 1.0]], 0, 1.0, ratio, 0.0
        yield 1.0, [], [[1.0, 0.9]], 1, 0.1, ratio, 0.0
        yield 1.0, [], [], 2, 0.5 * ratio, ratio, 0.0
        yield 5.0, [[1.0, 0.2]], [[1.0, 3.2], [1.0, 0.5, 0.25], [1.0, 0.01]], 0, 0.0, ratio, 0.1 * ratio
        yield 1.98, [], [[1.0, 80.3]], 0, 3.2, ratio, 0.0
        yield 1.0, [[1.0, 20.0]], [[1.0, 1.0], [1.0, 0.5]], 0, 0.2, ratio, 0.0
        yield 1.0, [[2.0, 1.0]], [[1.0, 1.0], [1.0, 3.0]], 1, 0.0, ratio, 0.7 * ratio
        yield 1.0, [], [[1.0, -2.0], [1.0, 0.3]], 0, 0.05 * ratio, ratio, 0.0
        yield 0.7, [[1.0, -1.0], [1.0, -1.0]], [[1.0, 1.0]] * 2, 0, 0.0, ratio, 0.2 * ratio
    yield 1e-9, [], [[1.0, 1e6], [1.0, 2e6]], 0, 3e5, 1e4, 0.0
    yield 1e9, [], [[1.0, 1e-6], [1.0, 0.5e-6]], 0, 1e-7, 3e-7, 1e-8
    yield 1.0, [], [[1.0, 1.0], [1.0, 1e-6]], 0, 0.0, 0.1, 0.03
    yield 1.0, [[1.0, -0.3, 0.4]], [[1.0, 0.2, 1.0], [1.0, 0.2, 1.0], [1.0, 1.0]], 1, 0.77, 0.2, 0.0


def expression(gain, zeros, poles, integrators, dead_time):
    def factor(f):
        return "(%r%s)" % (f[0], "".join("+(%r)*s^%d" % (c, k + 1) for k, c in enumerate(f[1:])))

    text = "(%r)" % gain + "".join("*" + factor(z) for z in zeros) + "*exp(-(%r)*s)" % dead_time
    return text + "/s" * integrators + "".join("/" + factor(p) for p in poles)


def responses(gain, zeros, poles, integrators, dead_time, ts, latency):
    h = mp.mpf(ts)
    num = product([[mp.mpf(gain)]] + zeros)
    den = [mp.mpf(0)] * integrators + product(poles)
    n = len(den) - 1
    num += [mp.mpf(0)] * (n + 1 - len(num))
    num = [c / h**k for k, c in enumerate(num)]
    den = [c / h**k for k, c in enumerate(den)]
    d = num[n] / den[n]
    c = [(num[k] - d * den[k]) / den[n] for k in range(n)]
    m = mp.zeros(n + 1)
    for k in range(n - 1):
        m[k, k + 1] = 1
    for k in range(n):
        m[n - 1, k] = -den[k] / den[n]
    m[n - 1, n] = 1
    total = (mp.mpf(dead_time) + mp.mpf(latency)) / h
    whole = mp.nint(total)
    if abs(total - whole) < 1e-9:
        fraction = mp.mpf(0)
    else:
        whole = mp.floor(total)
        fraction = total - whole

    def states(matrix):
        return matrix[0:n, 0:n], matrix[0:n, n]

    phi, gamma = states(mp.expm(m))
    early = states(mp.expm(m * fraction))[1]
    late_phi, late = states(mp.expm(m * (1 - fraction)))
    before = late_phi * early
    assert mp.norm(late + before - gamma) < mp.mpf(10) ** -200 * (1 + mp.norm(gamma))
    values = []
    for theta in THETAS:
        z = mp.exp(1j * mp.mpf(theta))
        x = mp.lu_solve(mp.eye(n) * z - phi, late + before / z)
        value = z ** -int(whole) * (sum(ck * xk for ck, xk in zip(c, x)) + d / z)
        values.append(value)
        if len([z for z in num if z != 0]) + 1 <= n and theta in (0.3, 2.0):
            with mp.workdps(30):
                alias_check(value, num, den, total, theta, z)
    return values


def alias_check(value, num, den, total, theta, z):
    def term(k):
        s = 1j * (mp.mpf(theta) + 2 * mp.pi * k)
        return mp.polyval(num[::-1], s) / mp.polyval(den[::-1], s) / s * mp.exp(-s * total)

    summed = term(0) + sum(term(k) + term(-k) for k in range(1, 400))
    assert abs((1 - 1 / z) * summed / value - 1) < 1e-3, (value, summed)


def main():
    lines = ["# Zero-order-hold equivalents G_d(exp(j*theta)); see make_hold.py", "plant,ts,latency,theta,re,im"]
    for gain, zeros, poles, integrators, dead_time, ts, latency in cases():
        text = expression(gain, zeros, poles, integrators, dead_time)
        for theta, value in zip(THETAS, responses(gain, zeros, poles, integrators, dead_time, ts, latency)):
            re, im = (mp.nstr(x, 17, min_fixed=0, max_fixed=0) for x in (value.real, value.imag))
            lines.append("%s,%r,%r,%r,%s,%s" % (text, ts, latency, theta, re, im))
    content = "\n".join(lines) + "\n"
    if "--check" in sys.argv:
        sys.exit(0 if OUTPUT.read_text() == content else "hold.csv differs")
    OUTPUT.write_text(content)


main()
