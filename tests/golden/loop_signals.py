"""What set-points and disturbances do, as a person reads the format's description.

A disturbance becomes a list of primitives `(time, kind, coefficient)` whose responses are added; a set-point is asked
for its value at a sample. The last step or recorded signal gives the level, everything else adds to it.
"""

from fractions import Fraction

import mpmath as mp

from exact_response import exact


def disturbance_primitives(events, level):
    """Steps, ramps and sines that add up to the disturbance minus its level before `t = 0`."""
    level = exact(level)
    list_ = []
    changes = [e for e in events if "disturbance" in e]
    for index, event in enumerate(changes):
        at, d = Fraction(event["at"]), event["disturbance"]
        if "step" in d:
            list_.append((at, "step", exact(d["step"]) - level))
            level = exact(d["step"])
        elif "ramp" in d:
            list_.append((at, "ramp", exact(d["ramp"])))
            if "duration" in d:
                list_.append((at + Fraction(d["duration"]), "ramp", -exact(d["ramp"])))
        elif "pulse" in d:
            list_.append((at, "step", exact(d["pulse"])))
            list_.append((at + Fraction(d["duration"]), "step", -exact(d["pulse"])))
        elif "sine" in d:
            omega, phase = 2 * mp.pi / exact(d["period"]), exact(d.get("phase", "0"))
            list_.append((at, ("sine", omega, phase), exact(d["sine"])))
            if "duration" in d:
                later = phase + omega * exact(d["duration"])
                list_.append((at + Fraction(d["duration"]), ("sine", omega, later), -exact(d["sine"])))
        else:
            # Until the next signal that sets the level.
            ends = (Fraction(e["at"]) for e in changes[index + 1 :] if {"step", "times"} & set(e["disturbance"]))
            level = recorded(list_, at, d, level, next(ends, None))
    return sorted(list_, key=lambda item: item[0])


def recorded(list_, at, d, level, end):
    """Adds a table that begins at `at`; gives the level at its end."""
    times = [at + Fraction(t) for t in d["times"]]
    values = [exact(v) for v in d["values"]]
    slope = mp.mpf(0)
    for i, (t, v) in enumerate(zip(times, values)):
        if end is not None and t >= end:
            list_.append((end, "ramp", -slope))
            return level
        if d["between"] == "hold" or i == 0:
            list_.append((t, "step", v - level))
            level = v
        if d["between"] == "line":
            last = i + 1 == len(times)
            new = mp.mpf(0) if last else (values[i + 1] - v) / exact(times[i + 1] - t)
            list_.append((t, "ramp", new - slope))
            slope, until = new, t if last else times[i + 1]
            until = until if end is None else min(until, end)
            level = v + slope * exact(until - t)
    return level


def setpoint_at(events, initial, t):
    """The set-point asked for at the sample at `t`."""
    level, added = exact(initial), mp.mpf(0)
    for event in events:
        if "setpoint" not in event or Fraction(event["at"]) > t:
            continue
        s = event["setpoint"]
        passed = t - Fraction(event["at"])
        ended = "duration" in s and passed >= Fraction(s["duration"])
        if "step" in s:
            level = exact(s["step"])
        elif "ramp" in s:
            added += exact(s["ramp"]) * exact(Fraction(s["duration"]) if ended else passed)
        elif "pulse" in s and not ended:
            added += exact(s["pulse"])
        elif "sine" in s and not ended:
            omega = 2 * mp.pi / exact(s["period"])
            added += exact(s["sine"]) * mp.sin(omega * exact(passed) + exact(s.get("phase", "0")))
    return level + added
