#!/usr/bin/env python3
"""Writes nonlinear.json: open-loop courses of the plants that are not linear, by another integrator.

Run in an environment with numpy and scipy (made with scipy 1.17): `python make_nonlinear.py`.

The equations are written down here once more, as they stand in the format's description. Each piece of a course, from one
jump or bend of an input to the next, is one call of `solve_ivp` (DOP853, tolerances 1e-12); a tank that meets its bottom
or its top ends the piece there, stays while the flows keep it there, and leaves when their balance turns, found by
bisection. Each case has the text of its scenario, in manual mode, and the level or temperature at every sample.
"""

import json
import math
from pathlib import Path

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

OUTPUT = Path(__file__).with_name("nonlinear.json")

TANK = {
    "area": 80.3,
    "height": 50.0,
    "drop": 24.5,
    "drain": 4.0 * math.sqrt(49.5),
    "valve": 50.0,
    "supply": 15.0,
    "pump": 13.2,
    "pump_start": 0.0,
    "feed_area": 200.0,
    "feed_level": 40.0,
    "dead_time": 3.2,
    "disturbance": "valve",
}


class Disturbance:
    """Steps set a level; ramps, pulses and sines add to it. Times in seconds."""

    def __init__(self, signals, delay):
        self.signals = [(at + delay, kind, values) for at, kind, values in signals]

    def breaks(self):
        for at, kind, values in self.signals:
            yield at
            if kind != "step":
                yield at + values["duration"]

    def __call__(self, t, side):
        """The value at `t`; `side` is a time inside the piece, which says what is on."""
        level, sum_ = 0.0, 0.0
        for at, kind, values in self.signals:
            if side < at:
                continue
            since = t - at
            if kind == "step":
                level = values["step"]
            elif kind == "ramp":
                sum_ += values["ramp"] * (since if side < at + values["duration"] else values["duration"])
            elif side < at + values["duration"]:
                if kind == "pulse":
                    sum_ += values["pulse"]
                else:
                    sum_ += values["sine"] * math.sin(2.0 * math.pi * since / values["period"] + values["phase"])
        return level + sum_


def clamp(x, lo, hi):
    return lo if x < lo else hi if x > hi else x


class Tank:
    def __init__(self, **changed):
        self.p = {**TANK, **changed}
        p = self.p
        self.top = min(p["height"], p["feed_level"] * p["feed_area"] / p["area"])

    def out(self, h, valve):
        p = self.p
        head, laminar = max(h + p["drop"], 0.0), 1e-6 * p["height"]
        x = head / laminar
        root = math.sqrt(head) if x >= 1.0 else math.sqrt(laminar) * x * (1.5 - 0.5 * x)
        return p["drain"] * clamp(valve, 0.0, 100.0) / 100.0 * root

    def net(self, h, u, d):
        p = self.p
        at_input = p["disturbance"] == "input"
        duty = clamp(u + (d if at_input else 0.0), 0.0, 100.0)
        flow = p["pump"] * max(p["supply"] * duty / 100.0 - p["pump_start"], 0.0)
        return (flow - self.out(h, p["valve"] + (0.0 if at_input else d))) / p["area"]

    def toml(self):
        parts = [f"{k} = {json.dumps(v)}" for k, v in self.p.items() if v != TANK[k]]
        return "two_tank = { " + ", ".join(parts) + " }"

    def start(self, y0):
        needed = self.out(y0, self.p["valve"])
        start = self.p["pump_start"] if needed > 0.0 else 0.0
        return [y0], 100.0 * (needed / self.p["pump"] + start) / self.p["supply"]

    def output(self, x):
        return x[0]

    def piece(self, x, t0, t1, u, d):
        """Through a piece without a jump; `d` is a function of time."""
        h, t = x[0], t0
        while t < t1:
            net = lambda h, t: self.net(h, u, d(t))
            end = 0.0 if h <= 0.0 else self.top if h >= self.top else None
            outward = -1.0 if end == 0.0 else 1.0
            if end is not None and outward * net(end, t) >= 0.0:
                # Held at its end until the balance turns.
                steps = 2000
                grid = [t + (t1 - t) * i / steps for i in range(steps + 1)]
                turn = next((i for i in range(1, steps + 1) if outward * net(end, grid[i]) < 0.0), None)
                if turn is None:
                    return [end]
                t = brentq(lambda s: net(end, s), grid[turn - 1], grid[turn], xtol=1e-14)
                t = math.nextafter(t, math.inf)
                h = end - outward * 1e-15
            bottom = lambda s, x: x[0]
            bottom.terminal, bottom.direction = True, -1
            full = lambda s, x: x[0] - self.top
            full.terminal, full.direction = True, 1
            solved = solve_ivp(
                lambda s, x: [net(x[0], s)], (t, t1), [h], "DOP853", rtol=1e-12, atol=1e-12,
                events=[bottom, full], max_step=0.5,
            )
            t, h = solved.t[-1], solved.y[0][-1]
            if solved.status == 1:
                h = 0.0 if len(solved.t_events[0]) else self.top
        return [h]


class Heater:
    def __init__(self, **parameters):
        self.p = parameters

    def toml(self):
        return "heater = { " + ", ".join(f"{k} = {v}" for k, v in self.p.items()) + " }"

    def start(self, y0):
        x = y0 - self.p["ambient"]
        return [x, x], x / (self.p["gain"] if x >= 0.0 else self.p["gain_cool"])

    def output(self, x):
        return self.p["ambient"] + x[1]

    def piece(self, x, t0, t1, u, d):
        p = self.p

        def rates(t, x):
            w = u + d(t)
            way = (p["gain"] if w >= 0.0 else p["gain_cool"]) * w - x[0]
            return [way / (p["tau_heat"] if way >= 0.0 else p["tau_cool"]), (x[0] - x[1]) / p["sensor_lag"]]

        solved = solve_ivp(rates, (t0, t1), x, "DOP853", rtol=1e-12, atol=1e-12, max_step=0.25)
        return list(solved.y[:, -1])


def course(plant, ts, count, latency, y0, outputs, signals):
    dead_time = plant.p["dead_time"]
    at_input = plant.p.get("disturbance", "input") == "input"
    disturbance = Disturbance(signals, dead_time if at_input else 0.0)
    x, u0 = plant.start(y0)
    # An output acts from the first sample at or after its event on.
    acts = [(math.ceil(at / ts - 1e-9) * ts + latency + dead_time, u) for at, u in outputs]
    end = (count - 1) * ts
    samples = [k * ts for k in range(count)]
    times = sorted({t for t in [*samples, *(t for t, _ in acts), *disturbance.breaks()] if 0.0 <= t <= end})
    values = {0.0: plant.output(x)}
    for t0, t1 in zip(times, times[1:]):
        if t1 - t0 > 1e-9:
            middle = 0.5 * (t0 + t1)
            u = next((u for t, u in reversed(acts) if t < middle), u0)
            x = plant.piece(x, t0, t1, u, lambda t: disturbance(t, middle))
        values[t1] = plant.output(x)
    return [values[t] for t in samples]


def case(name, plant, ts, count, latency, substeps, y0, outputs, signals):
    text = f'version = 1\nts = {ts}\nduration = {ts * count}\nlatency = {latency}\nsubsteps = {substeps}\n'
    text += f"[plant]\n{plant.toml()}\n[initial]\nsetpoint = {y0}\n"
    for at, u in outputs:
        text += f"[[event]]\nat = {at}\nmanual = {u}\n"
    for at, kind, values in signals:
        signal = values["step"] if kind == "step" else "{ " + ", ".join(f"{k} = {v}" for k, v in values.items()) + " }"
        text += f"[[event]]\nat = {at}\ndisturbance = {signal}\n"
    text += '[[controller]]\nname = "manual"\nmode = "manual"\npid = { kp = 0.0, ki = 0.1 }\n'
    return {"name": name, "scenario": text, "y": course(plant, ts, count, latency, y0, outputs, signals)}


CASES = [
    case(
        "the rig, its valve, both ends", Tank(), 2.0, 360, 0.7, 4, 25.0,
        [(0.0, 62.0), (61.0, 30.0), (200.0, 0.0), (400.0, 100.0), (620.0, 45.0)],
        [
            (33.3, "step", {"step": 20.0}),
            (100.7, "ramp", {"ramp": -0.5, "duration": 40.0}),
            (150.0, "sine", {"sine": 15.0, "period": 37.0, "phase": 0.4, "duration": 200.0}),
            (450.5, "pulse", {"pulse": 60.0, "duration": 50.0}),
        ],
    ),
    case(
        "another tank, its input, a feed tank that runs dry",
        Tank(area=30.0, height=20.0, drop=0.0, drain=9.0, valve=70.0, supply=12.0, pump=5.0, pump_start=1.5,
             feed_area=50.0, feed_level=7.0, dead_time=0.37, disturbance="input"),
        0.25, 400, 0.11, 3, 6.0,
        [(2.0, 60.0), (25.1, 20.0), (60.0, 5.0), (80.0, 95.0)],
        [
            (10.05, "ramp", {"ramp": 1.5, "duration": 12.3}),
            (30.0, "sine", {"sine": 12.0, "period": 4.4, "phase": 0.0, "duration": 30.0}),
            (45.0, "step", {"step": 10.0}),
        ],
    ),
    case(
        "a heater, all that differs",
        Heater(gain=0.8, gain_cool=0.25, tau_heat=12.0, tau_cool=40.0, ambient=21.0, sensor_lag=2.5, dead_time=1.3),
        0.5, 400, 0.2, 5, 29.0,
        [(1.0, 70.0), (50.0, 5.0), (90.0, -60.0), (140.0, 15.0)],
        [
            (30.2, "pulse", {"pulse": -30.0, "duration": 8.0}),
            (100.0, "sine", {"sine": 90.0, "period": 11.0, "phase": 1.0, "duration": 45.0}),
            (160.3, "ramp", {"ramp": -1.0, "duration": 25.0}),
        ],
    ),
]

if __name__ == "__main__":
    rows = [json.dumps({**one, "y": [round(y, 12) for y in one["y"]]}) for one in CASES]
    OUTPUT.write_text("[\n" + ",\n".join(rows) + "\n]\n")
