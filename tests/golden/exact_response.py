"""Responses of linear plants to simple inputs, from partial fractions in 50-digit arithmetic.

A plant `gain prod(1+z1 s+z2 s^2) / (s^k prod(1+tau s) prod(1+a1 s+a2 s^2))` times the transform of an input is
expanded about each of its poles; poles are known from the factors, with their multiplicity, and never searched for.
There is no state, no matrix and no recursion in here. Dead times are the caller's business.
"""

from fractions import Fraction

import mpmath as mp
import numpy as np

mp.mp.dps = 50


def exact(number):
    """A decimal, fraction or high-precision number as a number of 50 digits."""
    if isinstance(number, str):
        number = Fraction(number)
    if isinstance(number, Fraction):
        return mp.mpf(number.numerator) / number.denominator
    return mp.mpf(number)


class Modes:
    """`sum of c t^j e^(p t)` for t > 0, from `(p, [c_0, c_1, ..])` for each pole."""

    def __init__(self, terms):
        self.terms = terms
        self.plain = [(complex(p), [complex(c) for c in list_]) for p, list_ in terms]

    def at(self, t):
        """Value at the time `t` > 0, as a number of 50 digits."""
        total = mp.mpc(0)
        for p, coefficients in self.terms:
            polynomial = mp.mpc(0)
            for c in reversed(coefficients):
                polynomial = polynomial * t + c
            total += polynomial * mp.exp(p * t)
        return total.real

    def array(self, t):
        """The same in doubles for an array of times; 0 for times that are not above 0."""
        total = np.zeros(t.shape)
        later = np.where(t > 0.0, t, 0.0)
        for p, coefficients in self.plain:
            polynomial = np.zeros(t.shape, dtype=complex)
            for c in reversed(coefficients):
                polynomial = polynomial * later + c
            total += (polynomial * np.exp(p * later)).real
        return np.where(t > 0.0, total, 0.0)

    def derivative(self):
        terms = []
        for p, c in self.terms:
            shifted = [(j + 1) * c[j + 1] for j in range(len(c) - 1)] + [mp.mpf(0)]
            terms.append((p, [p * a + b for a, b in zip(c, shifted)]))
        return Modes(terms)


class Plant:
    """The rational part of a plant; see the module."""

    def __init__(self, gain, integrators=0, lags=(), pairs=(), zeros=()):
        self.gain, self.integrators = exact(gain), integrators
        self.zeros = [(exact(z1), exact(z2)) for z1, z2 in zeros]
        self.poles, self.lead = {}, mp.mpf(1)
        for tau in lags:
            self._add(-1 / exact(tau))
            self.lead *= exact(tau)
        for a1, a2 in pairs:
            a1, a2 = exact(a1), exact(a2)
            root = mp.sqrt(mp.mpc(a1 * a1 - 4 * a2))
            self._add((-a1 + root) / (2 * a2))
            self._add((-a1 - root) / (2 * a2))
            self.lead *= a2
        self.cache = {}

    def _add(self, pole):
        pole = mp.mpc(pole)
        self.poles[pole] = self.poles.get(pole, 0) + 1

    def step(self):
        return self._respond("step", {mp.mpc(0): 1}, (1,))

    def ramp(self):
        return self._respond("ramp", {mp.mpc(0): 2}, (1,))

    def sine(self, omega, phase):
        """Response to `sin(omega t + phase)`."""
        omega, phase = exact(omega), exact(phase)
        poles = {mp.mpc(0, omega): 1, mp.mpc(0, -omega): 1}
        numerator = (omega * mp.cos(phase), mp.sin(phase))
        return self._respond(("sine", omega, phase), poles, numerator)

    def _respond(self, key, input_poles, input_numerator):
        if key not in self.cache:
            poles = dict(self.poles)
            origin = self.integrators + input_poles.get(mp.mpc(0), 0)
            for pole, count in input_poles.items():
                if pole != 0:
                    poles[pole] = poles.get(pole, 0) + count
            if origin:
                poles[mp.mpc(0)] = poles.get(mp.mpc(0), 0) + origin
            self.cache[key] = Modes([self._about(p, poles, input_numerator) for p in poles])
        return self.cache[key]

    def _about(self, p, poles, input_numerator):
        """The terms of one pole: Taylor coefficients of everything but `(s-p)^m`."""
        m = poles[p]

        def times(a, b):
            return [sum(a[i] * b[j - i] for i in range(j + 1)) for j in range(m)]

        def series(*coefficients):
            """Coefficients in x of `c0 + c1 (p+x) + c2 (p+x)^2`."""
            c = list(coefficients) + [0] * (3 - len(coefficients))
            full = [c[0] + c[1] * p + c[2] * p * p, c[1] + 2 * c[2] * p, mp.mpf(c[2])]
            return (full + [mp.mpf(0)] * m)[:m]

        f = series(self.gain / self.lead)
        f = times(f, series(*input_numerator))
        for z1, z2 in self.zeros:
            f = times(f, series(1, z1, z2))
        for q, count in poles.items():
            if q == p:
                continue
            # 1/(p - q + x) is a geometric series.
            inverse = [(-1) ** j / (p - q) ** (j + 1) for j in range(m)]
            for _ in range(count):
                f = times(f, inverse)
        # f_j (s-p)^(j-m) is f_j t^(m-1-j)/(m-1-j)! e^(p t).
        return p, [f[m - 1 - j] / mp.factorial(j) for j in range(m)]
