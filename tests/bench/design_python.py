"""Two tuning rules for the benchmark as one writes them with numpy and scipy: the PI with the largest integral gain at a
given sensitivity peak, and the PI with the least integral of the absolute error after a step of the load.

    python design_python.py PLANTS MS

PLANTS is a table with tabulators: expression, sum of the plant's times, shortest of them, dead time, and the gains kp and ki
that the other side has found.

Prints one line: the median time of a design of the first kind and the time of one of the second for exp(-s)/(1+s), both of
the processor in seconds, and how far the results lie from the other side's.
"""

import sys
import time

import numpy as np
from scipy.optimize import minimize
from scipy.signal import lfilter


def frequencies(total, shortest, dead_time):
    """Where the sensitivity is looked at: logarithmic, and evenly as long as the dead time turns the phase."""
    grid = np.geomspace(1e-4 / total, 300.0 / shortest, 4000)
    if dead_time > 0.0:
        turns = np.arange(0.01, 60.0, 0.01) / dead_time
        grid = np.union1d(grid, turns[(turns > grid[0]) & (turns < grid[-1])])
    return grid


class Ellipses:
    """The gains kp, ki that bring the Nyquist curve nearer to -1 than 1/ms: an ellipse for each frequency."""

    def __init__(self, plant, omega, ms):
        inverse = 1.0 / plant(1j * omega)
        self.omega, self.p, self.q, self.r = omega, inverse.real, inverse.imag, np.abs(inverse) / ms

    def largest_kp(self):
        """Where proportional control meets the first of them."""
        square = self.r**2 - self.q**2
        left = -self.p - np.sqrt(np.maximum(square, 0.0))
        return np.min(left[(square >= 0.0) & (left > 0.0)], initial=np.inf)

    def edges(self, kp):
        """The least ki that each forbids."""
        square = self.r**2 - (kp + self.p) ** 2
        root = np.sqrt(np.maximum(square, 0.0))
        forbids = (square >= 0.0) & (self.q + root > 0.0)
        return np.where(forbids, self.omega * (self.q - root), np.inf)


def pi_ms(plant, omega, ms):
    """kp and ki of the largest ki with max|S| = ms."""
    ellipses = Ellipses(plant, omega, ms)
    kp_hi = ellipses.largest_kp()

    def largest_ki(kp):
        edges = ellipses.edges(kp)
        k = np.argmin(edges)
        low, high = omega[max(k - 1, 0)], omega[min(k + 1, len(omega) - 1)]
        for _ in range(3):
            near = np.linspace(low, high, 41)
            edges = Ellipses(plant, near, ms).edges(kp)
            k = np.argmin(edges)
            low, high = near[max(k - 1, 0)], near[min(k + 1, 40)]
        return edges[k]

    gains = np.union1d(np.linspace(0.0, kp_hi, 241), kp_hi / 240.0 * np.geomspace(1e-4, 1.0, 60))
    best = np.argmax([np.min(ellipses.edges(kp)) for kp in gains])
    low, high = gains[max(best - 1, 0)], gains[min(best + 1, len(gains) - 1)]
    golden = (np.sqrt(5.0) - 1.0) / 2.0
    a, b = high - golden * (high - low), low + golden * (high - low)
    ki_a, ki_b = largest_ki(a), largest_ki(b)
    while high - low > 1e-9 * kp_hi:
        if ki_a > ki_b:
            high, b, ki_b = b, a, ki_a
            a = high - golden * (high - low)
            ki_a = largest_ki(a)
        else:
            low, a, ki_a = a, b, ki_b
            b = low + golden * (high - low)
            ki_b = largest_ki(b)
    kp = 0.5 * (low + high)
    return kp, largest_ki(kp)


def iae(kp, ki, tau, dead_time, points=100, intervals=60):
    """The integral of |e| of exp(-s*dead_time)/(1+tau*s) after a unit step of the load, by the method of steps.

    Within a dead time the input is known: a lag with an input that is linear between the points has an exact recursion.
    """
    h = dead_time / points
    decay = np.exp(-h / tau)
    gain_new = 1.0 - tau / h * (1.0 - decay)
    gain_old = tau / h * (1.0 - decay) - decay
    y_end, integral, total = 0.0, 0.0, 0.0
    inputs = np.zeros(points + 1)
    for k in range(intervals):
        known = inputs + (1.0 if k > 0 else 0.0)
        steps = gain_old * known[:-1] + gain_new * known[1:]
        rest, _ = lfilter([1.0], [1.0, -decay], steps, zi=[decay * y_end])
        y = np.concatenate(([y_end], rest))
        integrals = integral - np.concatenate(([0.0], np.cumsum(0.5 * h * (y[:-1] + y[1:]))))
        inputs = -kp * y + ki * integrals
        total += np.sum(0.5 * h * (np.abs(y[:-1]) + np.abs(y[1:])))
        y_end, integral = y[-1], integrals[-1]
        if not abs(y_end) < 1e6:
            return np.inf
    return total


def pi_iae(tau, dead_time):
    """kp, ki and the least IAE."""
    start = [0.5 * tau / dead_time + 0.3, tau + 0.3 * dead_time]

    def index(place):
        kp, ti = place
        return iae(kp, kp / ti, tau, dead_time) if kp > 0.0 and ti > 0.0 else np.inf

    found = minimize(index, start, method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-8})
    kp, ti = found.x
    return kp, kp / ti, found.fun


def read(path):
    """The plants: response, frequencies, kp and ki."""
    for row in open(path, encoding="utf-8"):
        expression, *numbers = row.rstrip("\n").split("\t")
        total, shortest, dead_time, kp, ki = map(float, numbers)
        code = compile(expression.replace("^", "**"), expression, "eval")
        plant = lambda s, code=code: eval(code, {"s": s, "exp": np.exp})  # noqa: E731
        yield plant, frequencies(total, shortest, dead_time), kp, ki


def main():
    ms = float(sys.argv[2])
    times, worst = [], 0.0
    for plant, omega, kp, ki in read(sys.argv[1]):
        start = time.process_time()
        found = pi_ms(plant, omega, ms)
        times.append(time.process_time() - start)
        worst = max(worst, abs(found[1] / ki - 1.0))
    iae_times = []
    for _ in range(3):
        start = time.process_time()
        kp, ki, least = pi_iae(1.0, 1.0)
        iae_times.append(time.process_time() - start)
    print(
        f"pi_ms_seconds={np.median(times):.6g} plants={len(times)} worst_ki={worst:.3g} "
        f"pi_iae_seconds={min(iae_times):.6g} kp={kp:.6g} ki={ki:.6g} iae={least:.7g}"
    )


if __name__ == "__main__":
    main()
