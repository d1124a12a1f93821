"""A sampled loop around a plant with dead time: every output is a sum of shifted, exact responses.

The held output acts from `k ts + latency` on. An output that arrives in the very instant of a sample is not seen by
it: values are limits from the left, which matters for plants with direct feedthrough only.
"""

from fractions import Fraction

import mpmath as mp

from exact_response import Plant, exact
from loop_compensator import Compensator
from loop_law import Pid
from loop_signals import disturbance_primitives, setpoint_at


class Loop:
    """The finished simulation of a case: inputs of the plant with their times, outputs at any time."""

    def __init__(self, case):
        self.case = case
        self.ts, self.latency = Fraction(case["ts"]), Fraction(case.get("latency", "0"))
        p = dict(case["plant"])
        self.dead = Fraction(p.pop("dead_time", "0"))
        self.plant = Plant(**p)
        initial = case.get("initial", {})
        r0, d0 = exact(initial.get("setpoint", "0")), exact(initial.get("disturbance", "0"))
        self.y0 = r0
        w0 = mp.mpf(0) if self.plant.integrators else r0 / self.plant.gain
        self.u0 = w0 - d0
        self.events = case["events"]
        self.disturbances = disturbance_primitives(self.events, initial.get("disturbance", "0"))
        self.applied, self.steps, self.kernels = [self.u0], [], {}
        self.r, self.y, self.u = [], [], []
        self._run(r0)

    def _run(self, r0):
        case, ts = self.case, exact(self.ts)
        law = Pid(case, ts, r0, r0, self.u0)
        compensator = Compensator.of(case, self.ts, self.latency, r0, self.u0)
        chain = case.get("chain") or (lambda loop, y: y, lambda loop, u: u)
        read_back = case.get("actuator", {}).get("read_back", False)
        for k in range(case["samples"]):
            t = k * self.ts
            y = self.output(t)
            r = setpoint_at(self.events, case.get("initial", {}).get("setpoint", "0"), t)
            seen = chain[0](self, y)
            back = self.applied[-1] if read_back and k else None
            u_f = compensator.step(seen, law.u if back is None else back) if compensator else 0
            u = law.step(r, seen, back, u_f)
            a = chain[1](self, u)
            if a != self.applied[-1]:
                self.steps.append((k, a - self.applied[-1]))
            self.applied.append(a)
            self.r.append(r)
            self.y.append(y)
            self.u.append(u)

    def output(self, t):
        """The plant's output at the time `t`, a fraction."""
        total = self.y0
        # Instants at the same fraction of a sample share their step responses.
        whole, fraction = divmod(t, self.ts)
        kernel = self.kernels.setdefault(fraction, [])
        while len(kernel) <= whole:
            kernel.append(self._response("step", len(kernel) * self.ts + fraction - self.latency - self.dead))
        for k, rise in self.steps:
            if k <= whole:
                total += rise * kernel[whole - k]
        for at, kind, coefficient in self.disturbances:
            total += coefficient * self._response(kind, t - at - self.dead)
        return total

    def modes(self, kind):
        return self.plant.sine(*kind[1:]) if isinstance(kind, tuple) else getattr(self.plant, kind)()

    def _response(self, kind, t):
        return self.modes(kind).at(exact(t)) if t > 0 else mp.mpf(0)
