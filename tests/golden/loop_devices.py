"""Sensor and actuator, written from their descriptions in the format.

Both round to a multiple of a resolution, which is a jump: a program that computes 1e-14 beside must still round alike, so
every value has to keep its distance from the middle between two multiples, and from the edge of the dead band.
"""

import mpmath as mp

from exact_response import exact

DISTANCE = mp.mpf("1e-7")


def rounded(x, resolution):
    if resolution == 0:
        return x
    steps = x / resolution
    nearest = mp.nint(steps)
    assert abs(abs(steps - nearest) - 0.5) > DISTANCE, "too near to a tie"
    return nearest * resolution


class Sensor:
    def __init__(self, case):
        sensor = case.get("sensor", {})
        self.lo, self.hi = exact(sensor.get("lo", "-1e30")), exact(sensor.get("hi", "1e30"))
        self.resolution = exact(sensor.get("resolution", "0"))

    def show(self, y):
        """Into the range, then to the resolution."""
        return rounded(min(max(y, self.lo), self.hi), self.resolution)


class Positioner:
    """Range, dead band, rate, resolution, in this order; the position itself is not rounded."""

    def __init__(self, case, ts, u0):
        actuator = case.get("actuator", {})
        self.lo, self.hi = exact(actuator.get("lo", "-1e30")), exact(actuator.get("hi", "1e30"))
        self.most = exact(actuator.get("rate", "1e30")) * ts
        self.resolution = exact(actuator.get("resolution", "0"))
        self.deadband = exact(actuator.get("deadband", "0"))
        self.position = u0

    def stands(self):
        return rounded(self.position, self.resolution)

    def move(self, u):
        target = min(max(u, self.lo), self.hi)
        way = target - self.position
        assert self.deadband == 0 or abs(abs(way) - self.deadband) > DISTANCE * self.deadband, "at the edge"
        if abs(way) > self.deadband:
            self.position += min(max(way, -self.most), self.most)
        return self.stands()
