"""Largest ki of a PI at max|S| = ms for the 134 processes, by trial: writes pi_ms.csv beside this file.

No ellipse is used: |S| = 1/|1+GC| on a dense grid with a zoom at its top, ki by bisection from 0 upwards, kp by a
scan and a golden section below the first gain at which proportional control breaks the limit. Needs numpy.
"""
import pathlib
import numpy as np


def plants():
    lag = lambda *taus: [[t, 1.0] for t in taus]
    for t in (.02, .05, .1, .2, .3, .5, .7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500, 1000):
        yield f"P1 tau={t:g}", [1.0], lag(t), 1.0
    for t in (.01, .02, .05, .1, .2, .3, .5, .7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500, 1000):
        yield f"P2 tau={t:g}", [1.0], lag(t, t), 1.0
    for t in (.005, .01, .02, .05, .1, .2, .5, 2, 5, 10):
        yield f"P3 tau={t:g}", [1.0], lag(1, t, t), 0.0
    for n in range(3, 9):
        yield f"P4 n={n}", [1.0], lag(*[1.0] * n), 0.0
    for t in (.1, .2, .3, .4, .5, .6, .7, .8, .9):
        yield f"P5 tau={t:g}", [1.0], lag(1, t, t * t, t ** 3), 0.0
    for d in (.01, .02, .05, .1, .2, .3, .5, .7, .9):
        yield f"P6 T={d:g}", [1.0], [[1.0, 0.0]] + lag(1 - d), d
    yield "P6 T=1", [1.0], [[1.0, 0.0]], 1.0
    for tau1 in (1, 2, 5, 10):
        for d in (.01, .02, .05, .1, .3, .5, .7, .9):
            yield f"P7 tau1={tau1} T={d:g}", [1.0], lag(tau1, 1 - d), d
        yield f"P7 tau1={tau1} T=1", [1.0], lag(tau1), 1.0
    for d in (.1, .2, .3, .4, .5, .6, .7, .8, .9, 1, 1.1):
        yield f"P8 delta={d:g}", [-d, 1.0], lag(1, 1, 1), 0.0
    for t in (.1, .2, .3, .4, .5, .6, .7, .8, .9):
        yield f"P9 tau={t:g}", [1.0], lag(1) + [[t * t, 1.4 * t, 1.0]], 0.0


class Loop:
    def __init__(self, num, dens, delay):
        self.num, self.dens, self.delay = num, dens, delay
        times = [d[0] for d in dens if len(d) == 2 and d[1] == 1.0] + [d[0] ** .5 for d in dens if len(d) == 3]
        times += [delay] if delay else []
        low, high = 1e-3 / sum(times), 100.0 / min(times)
        w = np.geomspace(low, high, 6000)
        if delay:
            w = np.concatenate([w, np.arange(0.01, 40, 0.01) / delay])
        self.w = np.unique(w)
        self.g = self.at(self.w)

    def at(self, w):
        s = 1j * w
        g = np.polyval(self.num, s) * np.exp(-s * self.delay)
        for d in self.dens:
            g = g / np.polyval(d, s)
        return g

    def ms(self, kp, ki):
        size = lambda w, g: 1 / np.abs(1 + (kp - 1j * ki / w) * g)
        s = size(self.w, self.g)
        k = int(s.argmax())
        a, b = self.w[max(k - 1, 0)], self.w[min(k + 1, len(s) - 1)]
        best = s[k]
        for _ in range(3):
            w = np.linspace(a, b, 41)
            s = size(w, self.at(w))
            k = int(s.argmax())
            best = max(best, s[k])
            a, b = w[max(k - 1, 0)], w[min(k + 1, 40)]
        return best

    def first(self, breaks, start):
        """The first value above 0 at which `breaks`."""
        x = start
        while breaks(x):
            x *= 0.5
        while not breaks(x):
            x *= 1.15
        a, b = x / 1.15, x
        for _ in range(46):
            m = 0.5 * (a + b)
            a, b = (a, m) if breaks(m) else (m, b)
        return a

    def ki(self, kp, ms, hint):
        if self.ms(kp, hint * 1e-6) > ms:
            return 0.0
        return self.first(lambda ki: self.ms(kp, ki) > ms, hint)

    def design(self, ms):
        top = self.first(lambda kp: self.ms(kp, 0.0) > ms, 1e-2)
        kps = top * np.concatenate([np.geomspace(1e-3, .05, 8), np.linspace(.08, .98, 26)])
        # From far below: a start beyond the limit could lie on an island of gains that are stable again.
        hint, kis = top * 1e-8, []
        for kp in kps:
            kis.append(self.ki(kp, ms, hint))
            hint = max(kis[-1], top * 1e-6) * .5
        k = int(np.argmax(kis))
        a, d = kps[max(k - 1, 0)], kps[min(k + 1, len(kps) - 1)]
        hint = kis[k] * .9
        r = (5 ** .5 - 1) / 2
        b, c = d - r * (d - a), a + r * (d - a)
        fb, fc = self.ki(b, ms, hint), self.ki(c, ms, hint)
        while d - a > 1e-6 * d:
            if fb > fc:
                d, c, fc = c, b, fb
                b = d - r * (d - a)
                fb = self.ki(b, ms, hint)
            else:
                a, b, fb = b, c, fc
                c = a + r * (d - a)
                fc = self.ki(c, ms, hint)
        return 0.5 * (a + d), max(fb, fc)


if __name__ == "__main__":
    lines = ["# made by pi_ms.py: process,ms,kp,ki"]
    for name, num, dens, delay in plants():
        loop = Loop(num, dens, delay)
        for ms in (1.2, 1.4, 2.0):
            kp, ki = loop.design(ms)
            lines.append(f"{name},{ms},{kp:.7g},{ki:.8g}")
            print(lines[-1], flush=True)
    pathlib.Path(__file__).with_name("pi_ms.csv").write_text("\n".join(lines) + "\n")
