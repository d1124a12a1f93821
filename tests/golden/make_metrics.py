#!/usr/bin/env python3
"""Writes metrics.json: indices of some loops of `loops.json`, from their exact continuous error.

Run as `make_loops.py` says, with the same packages. Between two changes of anything (a sample, an output or a
disturbance that arrives, an event) the error is smooth: it is computed at 24 Gauss points from the exact responses, its
polynomial through them is divided at its zeros, and integrated exactly. What that leaves is rounding, about 1e-13.

Of each window, which begins with an event: `ie`, `iae`, `ise`, `itae`, `e_max`, `tv`, and `bend`, the largest second
derivative of the error, which bounds what a straight line between two instants makes wrong. `ie` and `tv` are sums over
samples. A disturbance begins at its time, a set-point with the first sample at or after it; the clock of `itae` starts at
the event.
"""

import json
import math
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.polynomial import legendre
from scipy.optimize import brentq

from loop_cases import CASES
from loop_simulation import Loop

OUTPUT = Path(__file__).with_name("metrics.json")
CHOSEN = [
    "one lag, 0.37 samples of dead time",
    "integrator, latency 1.6, from 5",
    "lightly damped pair, four samples",
    "two lags, right-half-plane zero",
    "integrator and lag",
    "double integrator under PID",
    "four equal lags, 17.618 samples",
    "notch: as many zeros as poles",
    "order 6: two pairs, two lags, a pair of right-half-plane zeros",
    "estimator, model of second order, from 3",
    "sines that begin and end between samples",
    "recorded lines, then a step",
    "actuator with resolution and dead band",
    "cascade",
]
NODES, WEIGHTS = legendre.leggauss(24)
DENSE = np.linspace(-1.0, 1.0, 201)


def windows(loop):
    """`(clock, start)` of each: the time of the event, and when it takes effect."""
    found = {}
    for event in loop.case["events"]:
        at = Fraction(event["at"])
        start = at if "disturbance" in event else math.ceil(at / loop.ts) * loop.ts
        found[at] = min(start, found.get(at, start))
    list_ = sorted(found.items())
    return list_ if list_ and list_[0][1] == 0 else [(Fraction(0), Fraction(0)), *list_]


def pieces(loop, cuts, end):
    """Intervals on which the error is smooth."""
    samples = range(len(loop.y))
    arrival = loop.latency + loop.path.dead
    breaks = {k * loop.ts for k in samples} | {k * loop.ts + arrival for k in samples} | set(cuts) | {end}
    breaks |= {at + loop.path.dead for at, _, _ in loop.disturbances}
    inside = sorted(t for t in breaks if 0 <= t <= end)
    return list(zip(inside, inside[1:]))


def error(loop, t):
    """The error at an array of times, none of which is a break."""
    y = np.full(t.shape, float(loop.path.y0))
    delay = float(loop.latency + loop.path.dead)
    step = loop.path.modes("step")
    for k, rise in loop.steps:
        y += float(rise) * step.array(t - k * float(loop.ts) - delay)
    for at, kind, coefficient in loop.disturbances:
        y += float(coefficient) * loop.path.modes(kind).array(t - float(at + loop.path.dead))
    r = np.array([float(x) for x in loop.r])
    return r[np.floor(t / float(loop.ts)).astype(int)] - y


def indices(loop):
    marks = windows(loop)
    end = len(loop.y) * loop.ts
    parts = pieces(loop, [start for _, start in marks], end)
    begins = np.array([float(a) for a, _ in parts])
    halves = np.array([float(b - a) / 2 for a, b in parts])
    values = error(loop, begins[:, None] + halves[:, None] * (NODES + 1.0))
    table = [dict(at=float(clock), ie=0.0, iae=0.0, ise=0.0, itae=0.0, e_max=0.0, tv=0.0, bend=0.0) for clock, _ in marks]

    def window(t):
        return max(i for i, (_, start) in enumerate(marks) if start <= t)

    for (a, _), begin, half, nodes in zip(parts, begins, halves, values):
        row = table[window(a)]
        fit = legendre.legfit(NODES, nodes, len(NODES) - 1)
        dense = legendre.legval(DENSE, fit)
        row["e_max"] = max(row["e_max"], refined(fit, dense))
        bend = legendre.legval(DENSE, legendre.legder(fit, 2)) / half**2
        row["bend"] = max(row["bend"], 1.01 * np.abs(bend).max())
        zeros = [
            brentq(legendre.legval, DENSE[i], DENSE[i + 1], args=(fit,), xtol=1e-15)
            for i in np.flatnonzero(dense[:-1] * dense[1:] < 0)
        ]
        for lo, hi in zip([-1.0, *zeros], [*zeros, 1.0]):
            x = lo + (hi - lo) / 2 * (NODES + 1)
            e, w = legendre.legval(x, fit), WEIGHTS * (hi - lo) / 2 * half
            row["iae"] += w @ np.abs(e)
            row["ise"] += w @ e**2
            row["itae"] += w @ ((begin - row["at"] + half * (x + 1)) * np.abs(e))
    before = loop.u0
    for k, (r, y, u) in enumerate(zip(loop.r, loop.y, loop.u)):
        row = table[window(k * loop.ts)]
        row["ie"] += float(loop.ts) * float(r - y)
        row["tv"] += abs(float(u - before))
        before = u
    return table


def refined(fit, dense):
    """The largest size of the polynomial: at an end, or where its slope is 0."""
    i = int(np.abs(dense).argmax())
    slope = legendre.legder(fit)
    lo, hi = DENSE[max(i - 1, 0)], DENSE[min(i + 1, len(DENSE) - 1)]
    if legendre.legval(lo, slope) * legendre.legval(hi, slope) >= 0:
        return abs(dense[i])
    return max(abs(dense[i]), abs(legendre.legval(brentq(legendre.legval, lo, hi, args=(slope,)), fit)))


def main():
    results = []
    for name in CHOSEN:
        case = next(case for case in CASES if case["name"] == name)
        table = indices(Loop(case))
        rounded = [{key: float("%.13g" % value) for key, value in row.items()} for row in table]
        results.append({"name": name, "windows": rounded})
        print(name, file=sys.stderr)
    text = "[\n" + ",\n".join(json.dumps(r, separators=(",", ":")) for r in results) + "\n]\n"
    if "--check" in sys.argv:
        compare(json.loads(OUTPUT.read_text()), results)
    else:
        OUTPUT.write_text(text)
    print(len(text), "bytes", file=sys.stderr)


def compare(old, new):
    """Sums in doubles may differ in their last digits between libraries."""
    for a, b in zip(old, new, strict=True):
        for one, other in zip(a["windows"], b["windows"], strict=True):
            assert all(abs(one[key] - other[key]) <= 1e-11 * max(1.0, abs(one[key])) for key in one), a["name"]


if __name__ == "__main__":
    main()
