"""Checks of the loops: a cruder, unrelated simulation, and that they settle."""

from fractions import Fraction

import numpy as np
from scipy.integrate import solve_ivp
from scipy.signal import tf2ss

TOLERANCE = 1e-9


def check_settling(loop):
    """The last tenth stays within three times what the middle did: no loop that amplifies rounding."""
    y = np.array([float(x - loop.path.y0) for x in loop.y])
    tenth = len(y) // 10
    assert np.abs(y[-tenth:]).max() <= 3 * np.abs(y[tenth:-tenth]).max(), loop.case["name"]


def check_by_solver(loop):
    """Integrates the plant's state equations under the loop's own inputs from one change of the input to the next.

    The inputs are those of the finished loop: in a loop that settles, an error of the plant's output would show as it
    is. Returns the largest difference, relative to the largest output.
    """
    case = loop.case
    plant = case["plant"]
    lags = [float(tau) for tau in plant.get("lags", [])]
    forcing = [(float(at), kind, float(c)) for at, kind, c in loop.disturbances if isinstance(kind, tuple)]
    numerator, denominator = np.array([float(plant["gain"])]), np.array([1.0])
    for z1, z2 in plant.get("zeros", []):
        numerator = np.polymul(numerator, np.trim_zeros([float(z2), float(z1), 1.0], "f"))
    for tau in lags:
        denominator = np.polymul(denominator, [tau, 1.0])
    for a1, a2 in plant.get("pairs", []):
        denominator = np.polymul(denominator, [float(a2), float(a1), 1.0])
    for _ in range(plant.get("integrators", 0)):
        denominator = np.polymul(denominator, [1.0, 0.0])
    a, b, c, d = tf2ss(numerator, denominator)
    b, c, d = b[:, 0], c[0], d[0, 0]

    # Changes of level and slope at the plant's input, in deviations.
    changes = {}
    for k, rise in loop.steps:
        at = k * loop.ts + loop.latency + loop.path.dead
        changes.setdefault(at, [0.0, 0.0])[0] += float(rise)
    for at, kind, coefficient in loop.disturbances:
        if isinstance(kind, tuple):
            changes.setdefault(at + loop.path.dead, [0.0, 0.0])
        else:
            changes.setdefault(at + loop.path.dead, [0.0, 0.0])[kind == "ramp"] += float(coefficient)
    samples = {k * loop.ts: k for k in range(len(loop.y))}
    instants = sorted({*samples, *changes, Fraction(0)})

    x, level, slope, begun = np.zeros(len(b)), 0.0, 0.0, 0.0
    worst, scale = 0.0, max(abs(float(y - loop.path.y0)) for y in loop.y)
    dead = float(loop.path.dead)

    def sines(t):
        return sum(
            q * np.sin(float(kind[1]) * (t - dead - at) + float(kind[2])) for at, kind, q in forcing if t - dead >= at
        )

    for now, later in zip(instants, [*instants[1:], None]):
        t = float(now)
        if now in samples:
            # What arrives now is not seen yet.
            y = c @ x + d * (level + slope * (t - begun) + sines(np.nextafter(t, -1.0)))
            worst = max(worst, abs(y - float(loop.y[samples[now]] - loop.path.y0)))
        if now in changes:
            level, begun = level + slope * (t - begun) + changes[now][0], t
            slope += changes[now][1]
        if later is None:
            break

        def flow(t, x):
            return a @ x + b * (level + slope * (t - begun) + sines(t))

        x = solve_ivp(flow, (t, float(later)), x, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
    assert worst <= TOLERANCE * scale, (case["name"], worst, scale)
    return worst / scale
