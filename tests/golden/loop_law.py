"""A sampled PID as its difference equations are published, in numbers of 50 digits.

Integral `I += ki ts e` (or the trapezoid), everything else `((w kp - ki tf) + v kd s)/(1 + tf s)` by Tustin's rule, in
direct form; back-calculation `I += min(1, ts/tt) (a - v)` or conditional integration at the next sample; rate, then
range.
"""

import mpmath as mp

from exact_response import exact


class Filtered:
    """`(p + q s)/(1 + tf s)` by Tustin's rule, at rest at the input `x0`."""

    def __init__(self, p, q, tf, ts, x0):
        c = 2 / ts
        if tf == 0:
            assert q == 0
            self.n0, self.n1, self.d1 = p, mp.mpf(0), mp.mpf(0)
        else:
            self.n0 = (p + q * c) / (1 + tf * c)
            self.n1 = (p - q * c) / (1 + tf * c)
            self.d1 = (1 - tf * c) / (1 + tf * c)
        self.x, self.y = x0, p * x0

    def next(self, x):
        self.y = self.n0 * x + self.n1 * self.x - self.d1 * self.y
        self.x = x
        return self.y


class Pid:
    """The loop's law, settled at `r0`, `y0`, `u0`."""

    def __init__(self, case, ts, r0, y0, u0):
        pid = {"kp": "0", "ki": "0", "kd": "0", "tf": "0", "b": "1", "c": "0", **case["pid"]}
        self.rule = pid.pop("rule", "backward")
        kp, ki, kd, tf, b, c = (exact(pid[name]) for name in ("kp", "ki", "kd", "tf", "b", "c"))
        self.ki, self.ts = ki, ts
        self.from_r = Filtered(b * kp - ki * tf, c * kd, tf, ts, r0)
        self.from_y = Filtered(kp - ki * tf, kd, tf, ts, y0)
        self.i = u0 - (self.from_r.y - self.from_y.y)
        self.e = r0 - y0
        limits = case.get("limits", {})
        self.lo, self.hi = exact(limits.get("lo", "-1e6")), exact(limits.get("hi", "1e6"))
        self.most = exact(limits["rate"]) * ts if "rate" in limits else None
        self.conditional = case.get("anti_windup") == "conditional"
        tt = exact(case["tt"]) if "tt" in case else max(kp / ki if ki != 0 else 0, tf, ts)
        self.back = min(mp.mpf(1), ts / tt) if ki != 0 and not self.conditional else mp.mpf(0)
        self.u, self.v, self.increment = u0, u0, mp.mpf(0)

    def step(self, r, y, applied=None, u_f=0, blocked=(False, False)):
        """The output of one sample. `applied`: what came of the last one, if it is known; `blocked`: whether the integral
        term must not rise, not fall."""
        a = self.u if applied is None else min(max(applied, self.lo), self.hi)
        if self.conditional:
            if (self.v - a) * self.increment > 0:
                self.i -= self.increment
        else:
            self.i += self.back * (a - self.v)
        e = r - y
        mean = e if self.rule == "backward" else (e + self.e) / 2
        self.increment, self.e = self.ki * self.ts * mean, e
        if (blocked[0] and self.increment > 0) or (blocked[1] and self.increment < 0):
            self.increment = mp.mpf(0)
        self.i += self.increment
        self.v = self.i + self.from_r.next(r) - self.from_y.next(y) + u_f
        u = self.v
        if self.most is not None:
            u = min(max(u, self.u - self.most), self.u + self.most)
        self.u = min(max(u, self.lo), self.hi)
        return self.u
