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
    # What a recorded signal will still have done when a later step replaces it is not treated.
    list_ = []
    for event in events:
        if "disturbance" not in event:
            continue
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
            times = [at + Fraction(t) for t in d["times"]]
            values = [exact(v) for v in d["values"]]
            if d["between"] == "hold":
                for t, v in zip(times, values):
                    list_.append((t, "step", v - level))
                    level = v
            else:
                list_.append((at, "step", values[0] - level))
                slope = mp.mpf(0)
                for i in range(len(times) - 1):
                    new = (values[i + 1] - values[i]) / exact(times[i + 1] - times[i])
                    list_.append((times[i], "ramp", new - slope))
                    slope = new
                list_.append((times[-1], "ramp", -slope))
                level = values[-1]
    return sorted(list_, key=lambda item: item[0])


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
