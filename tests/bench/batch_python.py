"""The batch of Tena et al. 2022, section 5.2, as one writes it with numpy and scipy: for each of the 134 processes the PI with
the largest integral gain at a given sensitivity peak, the disturbance observer at the noise ratios 2 and 10, the response of
the three loops to a step of the load, and their sensitivity peaks.

    python batch_python.py 1.2               the times, of the processor
    python batch_python.py --values 1.2 ..   a table of the values, of two steps extrapolated, and the set-point too; slow

Without dead time a loop is a system of linear differential equations, solved by the matrix exponential. With dead time the
times are those of a state space of plant, controller, observer and the points of the dead time, whose powers give many steps
at once; the values come from the simulation dead time by dead time: what enters the plant is known then, and a lag whose
input is linear between the points has an exact recursion. Controller, plant and both paths of the observer stand side by
side as they are wired.
"""

import itertools
import sys
import time

import numpy as np
from scipy.linalg import block_diag, expm
from scipy.signal import lfilter

from design_python import frequencies, pi_ms

RATIOS = (2.0, 10.0)
# Points of a dead time, and of the time that a loop without dead time needs.
POINTS, STEPS = 100, 20000
# Dead times of the longest response to a set-point that is simulated.
LONGEST = 2000.0
# The same for the times, least and most points: most indices are within 0.1 %.
FAST_POINTS, FAST_STEPS = (20, 100), 4000


class Process:
    """exp(-dead_time*s)*(1 - zero*s)/(s^integrators*prod(1 + lag*s)), with a pair 1 + a*s + b*s^2 of poles at most."""

    def __init__(self, name, lags, dead_time=0.0, integrators=0, zero=0.0, pair=None):
        self.name, self.lags, self.dead_time = name, [float(lag) for lag in lags], float(dead_time)
        self.integrators, self.zero, self.pair = integrators, zero, pair
        self.order = len(self.lags) + integrators + (2 if pair else 0)
        self.lead = np.prod(self.lags) * (pair[1] if pair else 1.0)

    def poles(self, s):
        p = s**self.integrators * np.prod([1.0 + lag * s for lag in self.lags], axis=0)
        return p * (1.0 + self.pair[0] * s + self.pair[1] * s * s) if self.pair else p

    def __call__(self, s):
        return np.exp(-self.dead_time * s) * (1.0 - self.zero * s) / self.poles(s)

    def times(self):
        times = list(self.lags) + [self.zero] * (self.zero > 0.0)
        return times + ([self.pair[1] ** 0.5] * 2 if self.pair else [])

    def grid(self):
        total = sum(self.times()) + self.dead_time
        shortest = min(t for t in self.times() + [self.dead_time] if t > 0.0)
        return frequencies(total, shortest, self.dead_time)


def processes():
    """The nine families."""
    p1 = "0.02 0.05 0.1 0.2 0.3 0.5 0.7 1 1.3 1.5 2 4 6 8 10 20 50 100 200 500 1000".split()
    p2 = ["0.01"] + p1
    for tau in p1:
        yield Process(f"P1 tau={tau}", [tau], 1.0)
    for tau in p2:
        yield Process(f"P2 tau={tau}", [tau, tau], 1.0)
    for tau in "0.005 0.01 0.02 0.05 0.1 0.2 0.5 2 5 10".split():
        yield Process(f"P3 tau={tau}", [1.0, tau, tau])
    for n in range(3, 9):
        yield Process(f"P4 n={n}", [1.0] * n)
    for tenth in range(1, 10):
        tau = tenth / 10
        yield Process(f"P5 tau={tau:g}", [1.0, tau, tau**2, tau**3])
    for dead_time in "0.01 0.02 0.05 0.1 0.2 0.3 0.5 0.7 0.9 1".split():
        yield Process(f"P6 T={dead_time}", [] if dead_time == "1" else [1.0 - float(dead_time)], dead_time, 1)
    for tau1, dead_time in itertools.product("1 2 5 10".split(), "0.01 0.02 0.05 0.1 0.3 0.5 0.7 0.9 1".split()):
        second = [] if dead_time == "1" else [1.0 - float(dead_time)]
        yield Process(f"P7 tau1={tau1} T={dead_time}", [float(tau1)] + second, dead_time)
    for tenth in range(1, 12):
        yield Process(f"P8 delta={tenth / 10:g}", [1.0] * 3, zero=tenth / 10)
    for tenth in range(1, 10):
        tau = tenth / 10
        yield Process(f"P9 tau={tau:g}", [1.0], pair=(1.4 * tau, tau**2))


class Indices:
    """The integrals of a response that comes piece by piece."""

    def __init__(self):
        self.sums = np.zeros(4)
        self.peak, self.t = 0.0, 0.0

    def add(self, h, e, u):
        """Samples e, u at distances h, the last of the piece before included."""
        t = self.t + h * np.arange(len(e))
        size = np.abs(e)
        mean = lambda x: h * (np.sum(x) - 0.5 * (x[0] + x[-1]))  # noqa: E731
        self.sums += [mean(size), mean(e * e), mean(t * size), np.sum(np.abs(np.diff(u)))]
        self.peak = max(self.peak, np.max(size))
        self.t = t[-1]

    def values(self):
        iae, ise, itae, tv = self.sums
        return np.array([iae, ise, itae, self.peak, tv])


class Lag:
    """1/(1 + tau*s) for an input that is linear between points at the distance h; an integrator 1/s without tau."""

    def __init__(self, h, tau=None):
        self.y = 0.0
        if tau is None:
            self.decay, self.new, self.old = 1.0, 0.5 * h, 0.5 * h
        else:
            self.decay = np.exp(-h / tau)
            rise = -np.expm1(-h / tau)
            self.new, self.old = 1.0 - tau / h * rise, tau / h * rise - self.decay

    def __call__(self, x):
        if len(x) > 1:
            rest, _ = lfilter([1.0], [1.0, -self.decay], self.old * x[:-1] + self.new * x[1:], zi=[self.decay * self.y])
            y = np.concatenate(([self.y], rest))
        else:
            y = np.array([self.y])
        self.y = y[-1]
        return y


def settle_time(process, kp, ki, alpha):
    """Time after which a response is over, about."""
    gain = 0.0 if process.integrators else 1.0
    slow = max([(gain + kp) / ki, alpha or 0.0] + process.times() + [process.dead_time])
    return 30.0 * slow + 60.0 * process.dead_time


def delayed_response(process, kp, ki, alpha, load, points):
    """The indices of a loop with dead time, for a step of the load or of the set-point."""
    h = process.dead_time / points
    plant = [Lag(h, tau) for tau in process.lags] + [Lag(h) for _ in range(process.integrators)]
    integral = Lag(h)
    lags_u = [Lag(h, alpha) for _ in range(process.order)] if alpha else []
    lags_y = [Lag(h, alpha) for _ in range(process.order)] if alpha else []
    weights = list(process.lags) + [None] * process.integrators
    r, d = (0.0, 1.0) if load else (1.0, 0.0)
    u = np.zeros(points + 1)
    held = d
    indices, end = Indices(), settle_time(process, kp, ki, alpha)
    e = np.full(points + 1, r)
    u_last, quiet = 0.0, 0
    first = True
    while indices.t < end:
        x = u + (0.0 if first else held)
        for lag in plant:
            x = lag(x)
        y = x
        e = r - y
        feed = np.zeros(points + 1)
        if alpha:
            w = u
            for lag in lags_u:
                w = lag(w)
            z = y
            for lag, tau in zip(lags_y, weights):
                low = lag(z)
                z = low + tau / alpha * (z - low) if tau is not None else (z - low) / alpha
            feed = w - z
        u = kp * e + ki * integral(e) + feed
        indices.sums[3] += abs(u[0] - u_last)
        indices.add(h, e, u)
        u_last, first = u[-1], False
        quiet = quiet + 1 if np.max(np.abs(e)) < 1e-8 * indices.peak else 0
        if quiet > 3:
            break
    return indices.values()


def realised(num, den):
    """State space of num/den, coefficients in ascending powers."""
    top = den[-1]
    den, num = np.array(den) / top, np.concatenate((num, np.zeros(len(den) - len(num)))) / top
    n = len(den) - 1
    direct = num[n]
    a = np.diag(np.ones(n - 1), 1)
    a[-1, :] = -den[:n]
    return a, np.eye(n)[:, -1], num[:n] - direct * den[:n], direct


def polynomial(process):
    p = np.array([1.0])
    for lag in process.lags:
        p = np.polynomial.polynomial.polymul(p, [1.0, lag])
    return np.polynomial.polynomial.polymul(p, [1.0, *process.pair]) if process.pair else p


def response(process, kp, ki, alpha, load, steps):
    """The indices of a loop without dead time."""
    poles = polynomial(process)
    zeros = [1.0, -process.zero] if process.zero else [1.0]
    a, b, c, _ = realised(zeros, poles)
    parts_a, n = [a, [[0.0]]], len(a)
    # u = kp*(r - y) + ki*i + cu*xu + cy*xy + dy*y
    row_u = np.concatenate((-kp * c, [ki]))
    drive_y = [np.zeros(n), [-1.0]]
    drive_u = [b, [0.0]]
    if alpha:
        filtered = np.array([1.0])
        for _ in range(process.order):
            filtered = np.polynomial.polynomial.polymul(filtered, [1.0, alpha])
        au, bu, cu, _ = realised(zeros, filtered)
        ay, by, cy, dy = realised(-poles, filtered)
        parts_a += [au, ay]
        row_u = np.concatenate((row_u + dy * np.concatenate((c, [0.0])), cu, cy))
        drive_y += [np.zeros(len(au)), by]
        drive_u += [bu, np.zeros(len(ay))]
    whole = block_diag(*parts_a)
    size = len(whole)
    row_y = np.concatenate((c, np.zeros(size - n)))
    whole = whole + np.outer(np.concatenate(drive_y), row_y) + np.outer(np.concatenate(drive_u), row_u)
    # The load enters the plant only; the set-point the integral and, times kp, the output.
    r, d = (0.0, 1.0) if load else (1.0, 0.0)
    enters = np.zeros(size)
    enters[:n] += b * d
    enters[n] += r
    enters += np.concatenate(drive_u) * kp * r
    end = np.linalg.solve(whole, -enters)
    horizon = 30.0 / np.min(-np.linalg.eigvals(whole).real)
    fastest = 1.0 / np.max(np.abs(np.linalg.eigvals(whole)))
    # Steps that grow with the time: each stage has twice the step of the one before.
    stages = max(1, int(np.ceil(np.log2(max(horizon / (fastest * steps / 40.0), 2.0)))))
    per_stage = steps // stages
    h = horizon / per_stage / (2.0**stages - 1.0)
    indices, x = Indices(), -end
    u_last = 0.0
    for _ in range(stages):
        move = expm(whole * h)
        states = np.empty((per_stage + 1, size))
        states[0] = x
        filled, power = 1, move
        while filled < per_stage + 1:
            more = min(filled, per_stage + 1 - filled)
            states[filled : filled + more] = states[:more] @ power.T
            filled, power = filled + more, power @ power
        y, u = states @ row_y + row_y @ end, states @ row_u + row_u @ end + kp * r
        indices.sums[3] += abs(u[0] - u_last)
        indices.add(h, r - y, u)
        x, u_last, h = states[-1], u[-1], 2.0 * h
    return indices.values()


def chained_response(process, kp, ki, alpha, finer):
    """The indices of a loop with dead time after a step of the load, from when the load reaches the output on."""
    shortest = min(process.lags + [process.dead_time])
    points = finer * int(np.clip(20.0 * process.dead_time / shortest, *FAST_POINTS))
    h = process.dead_time / points
    lags = list(process.lags) + [None] * process.integrators
    p, n = len(lags), len(lags) * (3 if alpha else 1) + 1
    size = n + points + 1
    # One row per signal: what it is now and, once the states have moved, in terms of the state before.
    move = np.zeros((size, size + 1))
    u_old, u_new = np.zeros(size + 1), np.zeros(size + 1)
    u_old[size - 1], u_new[size - 2] = 1.0, 1.0

    def lag(index, tau, old, new):
        """State `index` becomes that of a lag with the input `old` at the start and `new` at the end of the step."""
        one = Lag(h, tau)
        move[index] = one.old * old + one.new * new
        move[index, index] += one.decay
        return np.eye(size + 1)[index], move[index].copy()

    load = np.eye(size + 1)[size]
    old, new = u_old + load, u_new + load
    for i, tau in enumerate(lags):
        old, new = lag(i, tau, old, new)
    y_old, y_new = old, new
    i_old, i_new = lag(n - 1, None, y_old, y_new)
    out_old, out_new = -kp * y_old - ki * i_old, -kp * y_new - ki * i_new
    if alpha:
        old, new = u_old, u_new
        for i in range(p):
            old, new = lag(p + i, alpha, old, new)
        z_old, z_new = y_old, y_new
        for i, tau in enumerate(lags):
            low_old, low_new = lag(2 * p + i, alpha, z_old, z_new)
            if tau is None:
                z_old, z_new = (z_old - low_old) / alpha, (z_new - low_new) / alpha
            else:
                z_old = low_old + tau / alpha * (z_old - low_old)
                z_new = low_new + tau / alpha * (z_new - low_new)
        out_old, out_new = out_old + old - z_old, out_new + new - z_new
    # The dead time: each point takes the one before, the first the new output.
    move[n] = out_new
    for i in range(1, points + 1):
        move[n + i, n + i - 1] = 1.0
    whole = np.vstack((move, load))
    length = 2 * points
    power, filled = whole, 1
    rows_y, rows_u = [y_old], [out_old]
    while filled < length:
        rows_y, rows_u = rows_y + [r @ power for r in rows_y], rows_u + [r @ power for r in rows_u]
        filled, power = 2 * filled, power @ power
    rows_y, rows_u = np.array(rows_y), np.array(rows_u)
    state = np.zeros(size + 1)
    state[size] = 1.0
    indices, y_last, u_last = Indices(), 0.0, 0.0
    indices.t, quiet = process.dead_time, 0
    for _ in range(100000):
        y, u = rows_y @ state, rows_u @ state
        indices.add(h, -np.concatenate(([y_last], y[1:], [rows_y[0] @ power @ state])), np.concatenate(([u_last], u[1:])))
        state = power @ state
        y_last, u_last = y_old @ state, u[-1]
        quiet = quiet + 1 if np.max(np.abs(y)) < 1e-6 / finer**2 * indices.peak else 0
        if quiet > 3:
            break
    return indices.values()


def simulated(process, kp, ki, alpha, load, finer):
    if process.dead_time == 0.0:
        return response(process, kp, ki, alpha, load, STEPS * finer)
    if load:
        return chained_response(process, kp, ki, alpha, 2 * finer)
    # A lag that is not longer than the step would hide the turns of the signals between the points.
    shortest = min(process.lags + [process.dead_time])
    points = max(POINTS, int(np.ceil(8.0 * process.dead_time / shortest)))
    return delayed_response(process, kp, ki, alpha, load, points * finer)


def peak(process, omega, kp, ki, alpha):
    """max|S| on the grid, with the observer or without."""
    s = 1j * omega
    s_pi = 1.0 / (1.0 + (kp + ki / s) * process(s))
    if not alpha:
        return np.max(np.abs(s_pi))
    c_u = np.exp(-process.dead_time * s) * (1.0 - process.zero * s) / (1.0 + alpha * s) ** process.order
    return np.max(np.abs((1.0 - c_u) * s_pi))


def observers(process, kp):
    return [(process.lead / (kp * (ratio - 1.0))) ** (1.0 / process.order) for ratio in RATIOS]


def measure(ms):
    """The times of the processor, in seconds: designs, simulations, margins."""
    spent, iae = np.zeros(3), 0.0
    now = time.process_time
    for process in processes():
        start = now()
        omega = process.grid()
        kp, ki = pi_ms(process, omega, ms)
        alphas = [None] + observers(process, kp)
        designed = now()
        for alpha in alphas:
            if process.dead_time > 0.0:
                found = chained_response(process, kp, ki, alpha, 1)
            else:
                found = response(process, kp, ki, alpha, True, FAST_STEPS)
            iae += found[0] * ki
        done = now()
        for alpha in alphas:
            peak(process, omega, kp, ki, alpha)
        spent += [designed - start, done - designed, now() - done]
    print(
        f"design_seconds={spent[0]:.6g} simulation_seconds={spent[1]:.6g} margins_seconds={spent[2]:.6g} "
        f"total_seconds={sum(spent):.6g} iae_ki={iae:.9g}"
    )


def extrapolated(*arguments):
    """Two steps, the error of each with the square of the step."""
    coarse, fine = (simulated(*arguments, finer=finer) for finer in (1, 2))
    return fine + (fine - coarse) / 3.0


def values(peaks):
    print("# Made by tests/bench/batch_python.py --values: kp, ki, then IAE, ISE, ITAE, e_max, TV of the load response, Ms")
    print("# case 1: the PI alone; 2, 10: noise ratios; set-point: the PI after a step of the set-point, where that is short")
    print("process,ms,case,kp,ki,alpha,iae,ise,itae,e_max,tv,ms_found")
    for ms in peaks:
        for process in processes():
            omega = process.grid()
            kp, ki = pi_ms(process, omega, ms)
            for case, alpha in zip(("1", "2", "10"), [None] + observers(process, kp)):
                found = extrapolated(process, kp, ki, alpha, True)
                row = [kp, ki, alpha or 0.0, *found, peak(process, omega, kp, ki, alpha)]
                print(f"{process.name},{ms:g},{case}," + ",".join(f"{x:.9g}" for x in row), flush=True)
            if settle_time(process, kp, ki, None) > LONGEST * process.dead_time > 0.0:
                continue
            row = [kp, ki, 0.0, *extrapolated(process, kp, ki, None, False)]
            print(f"{process.name},{ms:g},set-point," + ",".join(f"{x:.9g}" for x in row) + ",", flush=True)


if __name__ == "__main__":
    if sys.argv[1] == "--values":
        values([float(ms) for ms in sys.argv[2:]])
    else:
        measure(float(sys.argv[1]))
