#!/usr/bin/env python3
"""Writes adrc.json: outputs of a published ADRC and sampled observer poles in 50 digits.

Run in an environment with pyadrc 0.6.1, numpy and mpmath: `python make_adrc.py`.

`loops`: the state-space form of pyadrc, second order, in a loop with a lag of second order (its own recursion, so that
the measurements are any numbers); the set-point steps, a disturbance comes, the output is limited in range and rate.
Each sample is `[r, y, output applied since the last sample, output before the limits]`.

`poles`: observer gains and sampling period, then the elementary symmetric functions of `1 - exp(s*ts)` over the roots of
`s^3 + beta1 s^2 + beta2 s + beta3`.
"""

import json
from pathlib import Path

import mpmath
import pyadrc

OUTPUT = Path(__file__).with_name("adrc.json")

# b0, omega_c, omega_o/omega_c, ts, plant gain
LOOPS = [
    (5.0, 10.0, 4.0, 0.01, 1.0),
    (-0.7, 0.4, 7.5, 0.2, -2.0),
    (300.0, 120.0, 3.0, 0.002, 80.0),
]

# Printed gains of table 7; triple, slow, fast, widely spread and lightly damped roots.
POLES = [
    (120.0, 4800.0, 19200.0, 0.001),
    (4.8, 7.68, 30.72, 0.01),
    (120.0, 4800.0, 64000.0, 0.001),
    (3e-4, 3e-8, 1e-12, 0.001),
    (3e3, 3e6, 1e9, 0.01),
    (101.01, 102.01, 1.0, 0.05),
    (1.001, 1.001, 1.0, 0.3),
    (1e-3, 1e3, 0.9, 0.01),
    (1e3, 1e-3, 0.9, 0.01),
    (7.0, 14.0, 8.0, 0.4),
]


def run(b0, omega_c, ratio, ts, gain):
    law = pyadrc.StateSpace(2, ts, b0, omega_c, ratio)
    limit = 4.0 / abs(gain)
    step = 0.7 * limit
    q = float(mpmath.exp(-omega_c * ts / 3))
    y = lag = u = 0.0
    rows = []
    for k in range(90):
        r = 0.0 if k < 2 else (1.0 if k < 60 else -0.25)
        d = 0.0 if k < 40 else 0.3 / gain
        v = float(law(y, u, r))
        rows.append([r, y, u, v])
        u += max(-step, min(step, v - u))
        u = max(-limit, min(limit, u))
        lag, y = q * lag + (1 - q) * gain * (u + d), q * y + (1 - q) * lag
    return rows


def symmetric(beta1, beta2, beta3, ts):
    roots = mpmath.polyroots([1, beta1, beta2, beta3], maxsteps=2000, extraprec=2000)
    p = [-mpmath.expm1(s * ts) for s in roots]
    sums = p[0] + p[1] + p[2], p[0] * p[1] + p[1] * p[2] + p[0] * p[2], p[0] * p[1] * p[2]
    return [float(mpmath.re(x)) for x in sums]


def main():
    mpmath.mp.dps = 50
    data = {
        "loops": [
            {"b0": b0, "omega_c": wc, "omega_o": wc * k, "ts": ts, "samples": run(b0, wc, k, ts, gain)}
            for b0, wc, k, ts, gain in LOOPS
        ],
        "poles": [{"beta": list(p[:3]), "ts": p[3], "one_minus_q": symmetric(*p)} for p in POLES],
    }
    text = json.dumps(data)
    OUTPUT.write_text(text.replace("], [", "],\n[").replace("}, {", "},\n{") + "\n")


if __name__ == "__main__":
    main()
