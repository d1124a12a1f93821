"""A sampled loop around a plant with dead time: every output is a sum of shifted, exact responses.

The held output acts from `k ts + latency` on. An output that arrives in the very instant of a sample is not seen by
it: values are limits from the left, which matters for plants with direct feedthrough only.
"""

from fractions import Fraction

import mpmath as mp

from exact_response import Plant, exact
from loop_compensator import Compensator
from loop_devices import Positioner, Sensor
from loop_law import Pid
from loop_signals import disturbance_primitives, setpoint_at


class Path:
    """From the actuator and the disturbance to a measurement, at rest at `y0`."""

    def __init__(self, plant, y0, ts, latency, steps, disturbances):
        plant = dict(plant)
        self.dead = Fraction(plant.pop("dead_time", "0"))
        self.plant = Plant(**plant)
        self.y0, self.ts, self.latency, self.steps, self.disturbances = y0, ts, latency, steps, disturbances
        self.kernels = {}

    def output(self, t):
        """The output at the time `t`, a fraction; `steps` are the changes `(sample, rise)` of the held output."""
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


class Loop:
    """The finished simulation of a case."""

    def __init__(self, case):
        self.case = case
        self.ts, self.latency = Fraction(case["ts"]), Fraction(case.get("latency", "0"))
        initial = case.get("initial", {})
        self.r0_text = initial.get("setpoint", "0")
        r0, d0 = exact(self.r0_text), exact(initial.get("disturbance", "0"))
        self.disturbances = disturbance_primitives(case["events"], initial.get("disturbance", "0"))
        self.steps = []
        shared = (self.ts, self.latency, self.steps, self.disturbances)
        self.path = Path(case["plant"], r0, *shared)
        plant = self.path.plant
        w0 = mp.mpf(0) if plant.integrators else r0 / plant.gain
        self.u0 = w0 - d0
        self.inner = None
        if "inner_plant" in case:
            self.inner = Path(case["inner_plant"], mp.mpf(0), *shared)
            self.inner.y0 = mp.mpf(0) if self.inner.plant.integrators else self.inner.plant.gain * w0
        self.r, self.y, self.seen, self.u, self.extra = [], [], [], [], []
        self._run(r0)

    def output(self, t):
        return self.path.output(t)

    def _run(self, r0):
        case, ts = self.case, exact(self.ts)
        first = self.u0 if self.inner is None else self.inner.y0
        law = Pid(case, ts, r0, r0, first)
        secondary = None
        if self.inner is not None:
            secondary = Pid(case["secondary"], ts, self.inner.y0, self.inner.y0, self.u0)
        compensator = Compensator.of(case, self.ts, self.latency, r0, self.u0)
        sensor, positioner = Sensor(case), Positioner(case, ts, self.u0)
        read_back = case.get("actuator", {}).get("read_back", False)
        applied = positioner.stands()
        assert applied == self.u0
        for k in range(case["samples"]):
            t = k * self.ts
            y = self.output(t)
            seen = sensor.show(y)
            r = setpoint_at(case["events"], self.r0_text, t)
            back = applied if read_back and k else None
            u_f = compensator.step(seen, law.u if back is None else back) if compensator else 0
            if secondary is None:
                u = law.step(r, seen, back, u_f)
                self.extra.append(())
            else:
                # A secondary at its limit stops the primary from asking for more.
                blocked = (secondary.u >= secondary.hi, secondary.u <= secondary.lo) if k else (False, False)
                wanted, inner_y = law.step(r, seen, blocked=blocked), self.inner.output(t)
                u = secondary.step(wanted, inner_y, back)
                self.extra.append((wanted, inner_y))
            now = positioner.move(u)
            if now != applied:
                self.steps.append((k, now - applied))
            applied = now
            self.r.append(r)
            self.y.append(y)
            self.seen.append(seen)
            self.u.append(u)
