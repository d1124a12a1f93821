#!/usr/bin/env python3
"""Writes zoh_taps.csv: zero-order-hold equivalents of plants with dead time, from 150-digit arithmetic.

How to run (no network is used once the two packages are installed):

    python3 -m venv .venv && .venv/bin/pip install numpy mpmath
    .venv/bin/python make_golden.py            # writes zoh_taps.csv beside this file, in about a minute
    .venv/bin/python make_golden.py --check    # compares with the file instead of writing it

The output is deterministic: the seed is fixed and only `random.Random.random` is drawn from.

Method. The plant is put in controllable canonical form in the time unit `ts`, its hold equivalent taken with the
exponential of the augmented matrix, the first n+1 samples of the pulse response multiplied by
`A = prod(1 - q_i z^-1)`, `q_i = e^{-ts/tau_i}`. Four things are checked on the way: that the product ends after
n+1 taps, that `B(1) = gain ts^k prod(1 - q_i)`, that the taps give the frequency response of the state space, and
(in doubles, numpy) that this is the sum of the continuous response over all aliases.

Every plant parameter is a short decimal that is rounded to a double before use, so a program that parses the file
works on exactly the same plant.
"""

import math
import random
import sys
from pathlib import Path

import mpmath as mp
import numpy as np

mp.mp.dps = 150
SEED = 20240117
PLANTS = 60
PHASES = [0.01, 0.1, 0.5, 1.0, 3.0]
OUTPUT = Path(__file__).with_name("zoh_taps.csv")


def short(value):
    """The double nearest to `value` rounded to six decimal digits of mantissa."""
    return float("%.6g" % value)


class Plant:
    """gain prod(1+z1 s+z2 s^2) e^{-s dead_time} / (s^integrators prod(1+a1 s+a2 s^2))."""

    def __init__(self, gain, integrators, poles, zeros, dead_time, ts):
        self.gain, self.integrators, self.poles, self.zeros = gain, integrators, poles, zeros
        self.dead_time, self.ts = dead_time, ts

    def order(self):
        return self.integrators + sum(1 if a2 == 0 else 2 for _, a2 in self.poles)


def draw_plant(index, rng):
    """One random plant; the index steers order and kind so that all combinations occur."""

    def uniform(low, high):
        return low + (high - low) * rng.random()

    order = 1 + index % 8
    integrators = min((0, 0, 0, 1, 0, 2, 1)[index % 7], order)
    kind = ("distinct", "equal", "pairs", "mixed")[(index // 8) % 4]
    ts = short(10 ** uniform(-3, 1))
    slowest = 10 ** uniform(-4, 0)

    def draw_time():
        ratio = slowest if kind == "equal" else min(1.0, slowest * 10 ** uniform(0, 2))
        return ts / ratio

    poles, left = [], order - integrators
    while left > 0:
        time = draw_time()
        if left >= 2 and (kind == "pairs" or (kind == "mixed" and not poles)):
            poles.append((short(2 * uniform(0.1, 0.95) * time), short(time * time)))
            left -= 2
        else:
            poles.append((short(time), 0.0))
            left -= 1

    zeros, room = [], min(order - 1, (0, 1, 2, 3, 1)[index % 5])
    while room > 0:
        time = draw_time() * 10 ** uniform(-0.7, 0.7)
        sign = 1 if rng.random() < 0.5 else -1
        if room >= 2 and rng.random() < 0.5:
            zeros.append((short(2 * sign * uniform(0.1, 0.9) * time), short(time * time)))
            room -= 2
        else:
            zeros.append((short(sign * time), 0.0))
            room -= 1

    delay_kind = index % 3
    steps = int(uniform(0, 12)) * (delay_kind > 0)
    dead_time = float(steps * ts) if delay_kind < 2 else short((steps + uniform(0.02, 0.98)) * ts)
    gain = short((1 if rng.random() < 0.7 else -1) * 10 ** uniform(-1, 1))
    return Plant(gain, integrators, poles, zeros, dead_time, ts)


def poly_product(a, b):
    result = [mp.mpf(0)] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def expand(factors):
    """Ascending coefficients of prod(1 + c1 s + c2 s^2), s in units of 1/ts."""
    result = [mp.mpf(1)]
    for c1, c2 in factors:
        result = poly_product(result, [mp.mpf(1), c1] if c2 == 0 else [mp.mpf(1), c1, c2])
    return result


def scaled(factors, ts):
    return [(mp.mpf(c1) / ts, mp.mpf(c2) / ts**2) for c1, c2 in factors]


def discrete_poles(plant, ts):
    """q_i of the lags and pairs; the integrators' q = 1 are left out."""
    result = []
    for c1, c2 in scaled(plant.poles, ts):
        if c2 == 0:
            result.append(mp.exp(-1 / c1))
        else:
            root = mp.sqrt(c1 * c1 / 4 - c2)
            result += [mp.exp((-c1 / 2 + root) / c2), mp.exp((-c1 / 2 - root) / c2)]
    return result


def hold_over(a, b, time):
    """e^{a t} and the integral of e^{a s} b over [0, t]."""
    n = a.rows
    augmented = mp.zeros(n + 1)
    for i in range(n):
        for j in range(n):
            augmented[i, j] = a[i, j] * time
        augmented[i, n] = b[i] * time
    e = mp.expm(augmented)
    return e[:n, :n], e[:n, n]


def sample(plant):
    """Whole steps N, B(1), taps b_j / B(1), response at PHASES."""
    ts, n = mp.mpf(plant.ts), plant.order()
    samples = mp.mpf(plant.dead_time) / ts
    steps = int(mp.floor(samples + mp.mpf("1e-13")))
    fraction = samples - steps
    if abs(fraction) < mp.mpf("1e-13"):
        fraction = mp.mpf(0)

    gain = mp.mpf(plant.gain) * ts**plant.integrators
    den = [mp.mpf(0)] * plant.integrators + expand(scaled(plant.poles, ts))
    num = expand(scaled(plant.zeros, ts))
    a, b, c = mp.zeros(n), mp.zeros(n, 1), mp.zeros(1, n)
    for i in range(n - 1):
        a[i, i + 1] = 1
    for j in range(n):
        a[n - 1, j] = -den[j] / den[n]
    b[n - 1] = 1
    for j, value in enumerate(num):
        c[0, j] = gain * value / den[n]

    full, _ = hold_over(a, b, mp.mpf(1))
    rest, late = hold_over(a, b, 1 - fraction)
    _, entered = hold_over(a, b, fraction)
    early = rest * entered

    # Pulse response at the samples N+1, N+2, ...: late at first, then early joins one sample later.
    x, pulse = late, []
    for k in range(n + 4):
        pulse.append((c * x)[0])
        x = full * x
        if k == 0:
            x += early

    poles = discrete_poles(plant, ts)
    a_poly = [mp.mpf(1)]
    for q in poles + [mp.mpf(1)] * plant.integrators:
        a_poly = poly_product(a_poly, [mp.mpf(1), -q])
    product = [sum(a_poly[i] * pulse[k - i] for i in range(min(k, n) + 1)) for k in range(n + 4)]
    taps = [mp.re(t) for t in product[: n + 1]]
    total = mp.re(gain * mp.fprod(1 - q for q in poles))
    size = max(abs(t) for t in taps)
    count = n if fraction == 0 else n + 1
    assert all(abs(t) < size * mp.mpf("1e-60") for t in product[count:]), "the taps do not end"
    taps[count:] = [mp.mpf(0)] * (n + 1 - count)
    assert all(abs(mp.im(t)) < size * mp.mpf("1e-60") for t in product), "the taps are not real"
    assert abs(mp.fsum(taps) - total) < size * mp.mpf("1e-60"), "B(1)"

    responses = []
    for phase in PHASES:
        z = mp.expj(mp.mpf(phase))
        numerator = mp.fsum(t * z ** (-j) for j, t in enumerate(taps))
        denominator = mp.fsum(v * z ** (-j) for j, v in enumerate(a_poly))
        direct = numerator / denominator * z ** (-(steps + 1))
        space = (c * mp.lu_solve(mp.eye(n) * z - full, late + early / z))[0] * z ** (-steps)
        assert abs(direct - space) < abs(direct) * mp.mpf("1e-60"), "the two forms of the response"
        responses.append(direct)
    check_aliases(plant, responses)
    return steps, total, [t / total for t in taps], responses


def check_aliases(plant, responses):
    """G_d(e^{j phi}) = (1 - e^{-j phi}) sum_m G(j w_m) / (j w_m ts), w_m = (phi + 2 pi m)/ts, in doubles."""
    count = 400_000
    m = np.arange(-count, count + 1, dtype=float)
    for phase, exact in zip(PHASES, responses):
        s = 1j * (phase + 2 * math.pi * m) / plant.ts
        g = plant.gain * np.exp(-s * plant.dead_time) / s**plant.integrators
        for z1, z2 in plant.zeros:
            g = g * (1 + z1 * s + z2 * s * s)
        for a1, a2 in plant.poles:
            g = g / (1 + a1 * s + a2 * s * s)
        terms = g / (s * plant.ts)
        # The sum converges like 1/m^2 at worst; its rest decides the limit below.
        value = (1 - np.exp(-1j * phase)) * terms.sum()
        error = abs(value - complex(exact)) / abs(complex(exact))
        assert error < 3e-3, f"alias sum: {error:g} at {phase}"


def digits(value):
    return mp.nstr(value, 17, min_fixed=0, max_fixed=0)


def pairs(factors):
    return ";".join(f"{c1!r}:{c2!r}" for c1, c2 in factors)


def row(index, plant):
    steps, total, taps, responses = sample(plant)
    fields = [f"p{index:02}", repr(plant.gain), str(plant.integrators), pairs(plant.poles), pairs(plant.zeros)]
    fields += [repr(plant.dead_time), repr(plant.ts), str(steps), digits(total), ";".join(map(digits, taps))]
    fields += [digits(mp.re(g)) + ":" + digits(mp.im(g)) for g in responses]
    return ",".join(fields)


def main():
    rng = random.Random(SEED)
    lines = [
        "# Zero-order-hold equivalents G_d = z^-(steps+1) B(z^-1)/A(z^-1), A = prod(1 - q_i z^-1); see make_golden.py",
        "# poles, zeros: factors 1+a1 s+a2 s^2 as a1:a2; taps: b_j/B(1); g@phi: G_d(e^{j phi}) as re:im",
        "name,gain,integrators,poles,zeros,dead_time,ts,steps,numerator_sum,taps," + ",".join(f"g@{p}" for p in PHASES),
    ]
    lines += [row(i, draw_plant(i, rng)) for i in range(PLANTS)]
    text = "\n".join(lines) + "\n"
    if "--check" in sys.argv[1:]:
        if OUTPUT.read_text() != text:
            sys.exit("zoh_taps.csv differs from what this program computes")
        print("zoh_taps.csv is up to date")
    else:
        OUTPUT.write_text(text)


if __name__ == "__main__":
    main()
