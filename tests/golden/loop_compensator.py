"""The disturbance block from the published transfer functions, as polynomials in 50 digits.

`C_u = z^-(N+1) B/B(1) F`, `C_y = -A/B(1) F`, `F = gain ((1-p)/(1-p z^-1))^d ((1+z^-1)/2)^e`, `e = d - deg A`, for models
without zeros. The taps B of the hold equivalent, the delay in front of them included, are read off the model's exact
step response. At rest before `t = 0`, so everything is computed in
deviations: a level of `u_f` at rest is the integral term's business.
"""

from fractions import Fraction

import mpmath as mp

from exact_response import Plant, exact


def product(p, q):
    r = [mp.mpf(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            r[i + j] += a * b
    return r


class Compensator:
    @staticmethod
    def of(case, ts, latency, y0, u0):
        if "estimator" in case:
            e = case["estimator"]
            if exact(e["a2"]) == 0:
                model = Plant(e["gain"], lags=[e["a1"]])
            else:
                model = Plant(e["gain"], pairs=[(e["a1"], e["a2"])])
            return Compensator(model, e["dead_time"], e["kfd"], e["tfd"], 3, ts, latency, y0, u0)
        if "observer" in case:
            o = dict(case["observer"])
            alpha, dead_time = o.pop("alpha"), o.pop("dead_time", "0")
            model = Plant(**o)
            order = sum(model.poles.values()) + model.integrators
            return Compensator(model, dead_time, "1", alpha, order, ts, latency, y0, u0)
        return None

    def __init__(self, model, dead_time, gain, filter_time, d, ts, latency, y0, u0):
        a = [mp.mpf(1)]
        for pole, count in [*model.poles.items(), (mp.mpf(0), model.integrators)]:
            for _ in range(count):
                a = product(a, [mp.mpf(1), -mp.exp(pole * exact(ts))])
        a = [mp.re(x) for x in a]
        order = len(a) - 1
        delay = Fraction(dead_time) + latency
        whole = int(delay / ts)
        step = model.step()
        steps = [step.at(exact(t)) if t > 0 else mp.mpf(0) for t in (k * ts - delay for k in range(whole + order + 2))]
        pulse = [b - c for b, c in zip(steps, [mp.mpf(0), *steps])]
        taps = product(a, pulse)[: whole + order + 2]
        assert all(t == 0 for t in taps[: whole + 1])
        total = mp.fsum(taps)
        p = mp.exp(-exact(ts) / exact(filter_time))
        shared = [exact(gain)]
        self.den = [mp.mpf(1)]
        for _ in range(d):
            shared = [(1 - p) * x for x in shared]
            self.den = product(self.den, [mp.mpf(1), -p])
        for _ in range(d - order):
            shared = product(shared, [mp.mpf("0.5"), mp.mpf("0.5")])
        self.from_u = product(shared, [t / total for t in taps])
        self.from_y = product(shared, [-x / total for x in a])
        self.y0, self.u0 = y0, u0
        rest = self.from_u[0] * 0
        self.u, self.y = [rest] * len(self.from_u), [rest] * len(self.from_y)
        self.out = [rest] * d

    def step(self, y, u_before):
        """`u_f` of this sample; `from_u[0]` is 0 and belongs to the output that is not there yet."""
        self.u = [mp.mpf(0), u_before - self.u0, *self.u[1:]][: len(self.from_u)]
        self.y = [y - self.y0, *self.y][: len(self.from_y)]
        value = mp.fsum(c * x for c, x in zip(self.from_u, self.u))
        value += mp.fsum(c * x for c, x in zip(self.from_y, self.y))
        value -= mp.fsum(c * x for c, x in zip(self.den[1:], self.out))
        self.out = [value, *self.out][: len(self.den) - 1]
        return value
