"""Golden indices of load responses: the loop as it is wired, sampled finely, extrapolated.

Plant, controller, C_u and C_y are separate state spaces (so the identity with the PI loop is not used); the delayed
signals are taken as straight lines between samples, everything else is exact (matrix exponential), and two steps are
extrapolated (Richardson, order 2). Needs numpy and scipy; prints the lines of responses.csv.

    python responses.py > responses.csv
"""

import numpy as np
from scipy.linalg import block_diag, expm
from scipy.signal import tf2ss

P = np.polynomial.polynomial


def poly(*factors):
    p = np.array([1.0])
    for f in factors:
        p = P.polymul(p, f)
    return p


def space(num, den):
    """State space of num/den, coefficients in ascending powers."""
    a, b, c, d = tf2ss(np.trim_zeros(np.array(num, float)[::-1], "f"), np.array(den, float)[::-1])
    return a, b[:, 0], c[0], d[0, 0]


def indices(case, h):
    """case: text, gain, mp zeros, nmp zeros, poles, T, (kp, ki, kd, tf), alpha or None, ramp, horizon"""
    _, k, mp, nmp, den, dead, (kp, ki, kd, tf), alpha, ramp, horizon = case
    n_mp, n_nmp, den = poly(*mp), poly(*nmp), poly(*den)
    parts = [space(k * P.polymul(n_mp, n_nmp), den)]
    # C(s) = ki/s + ((kp - ki*tf) + kd*s)/(1 + tf*s)
    parts.append(space([ki, kp, kd] if tf else [ki, kp], [0.0, 1.0, tf] if tf else [0.0, 1.0]))
    if alpha:
        lags = poly(*[[1.0, alpha]] * (len(den) - len(n_mp)))
        parts.append(space(n_nmp, lags))
        parts.append(space(-den, k * P.polymul(n_mp, lags)))
    a = block_diag(*[p[0] for p in parts])
    n = len(a)
    at = np.cumsum([0] + [len(p[1]) for p in parts])
    row = np.zeros(n)
    from_u, from_d, c = np.zeros(n), np.zeros(n), np.zeros(n)
    c[at[0] : at[1]] = parts[0][2]
    from_u[at[0] : at[1]] = from_d[at[0] : at[1]] = parts[0][1]
    a[at[1] : at[2]] += np.outer(-parts[1][1], c)
    row[at[1] : at[2]] = parts[1][2]
    row -= parts[1][3] * c
    if alpha:
        from_u[at[2] : at[3]] = parts[2][1]
        row[at[2] : at[3]] += parts[2][2]
        a[at[3] : at[4]] += np.outer(parts[3][1], c)
        row[at[3] : at[4]] += parts[3][2]
        row += parts[3][3] * c
    if dead == 0.0:
        a = a + np.outer(from_u, row)
    lag = int(round(dead / h))
    # x' = a*x + from_u*u(t-T) + from_d*d(t-T), inputs as straight lines: [x, u, slope, d, slope]
    big = np.zeros((n + 4, n + 4))
    big[:n, :n], big[:n, n], big[:n, n + 2] = a, from_u, from_d
    big[n, n + 1] = big[n + 2, n + 3] = 1.0
    e = expm(big * h)
    phi = e[:n, :n]
    u0, u1 = e[:n, n] - e[:n, n + 1] / h, e[:n, n + 1] / h
    d0, d1 = e[:n, n] * 0 + e[:n, n + 2], e[:n, n + 3]
    steps = int(round(horizon / h))
    x = np.zeros(n)
    u, y = np.zeros(steps + 1), np.zeros(steps + 1)
    for i in range(steps):
        j = i - lag
        new = phi @ x
        if j >= 0:
            new = new + d0 * (j * h if ramp else 1.0) + (d1 if ramp else 0.0)
            if lag:
                new = new + u0 * u[j] + u1 * u[j + 1]
        x = new
        y[i + 1], u[i + 1] = c @ x, row @ x
    t = h * np.arange(steps + 1)
    iae = itae = 0.0
    y0, y1, t0 = y[:-1], y[1:], t[:-1]
    cross = y0 * y1 < 0
    same = ~cross
    iae = (np.abs(y0 + y1)[same] * h / 2).sum()
    w = np.abs(t0 * y0 + (t0 + h) * y1)
    itae = (w[same] * h / 2).sum()
    part = np.abs(y0[cross]) / (np.abs(y0[cross]) + np.abs(y1[cross])) * h
    iae += (np.abs(y0[cross]) * part / 2 + np.abs(y1[cross]) * (h - part) / 2).sum()
    itae += ((t0[cross]) * (np.abs(y0[cross]) * part / 2 + np.abs(y1[cross]) * (h - part) / 2)).sum()
    ise = (h * (y0 * y0 + y0 * y1 + y1 * y1) / 3).sum()
    ie = -(h * (y0 + y1) / 2).sum()
    m = np.argmax(np.abs(y))
    q = np.abs(y[m - 1 : m + 2])
    e_max = q[1] + (q[2] - q[0]) ** 2 / 8 / (2 * q[1] - q[0] - q[2])
    tv = np.abs(np.diff(u)).sum()
    return np.array([ie, iae, ise, itae, e_max, tv]), abs(y[-1]) / e_max


L = lambda tau: [1.0, tau]
S = [0.0, 1.0]
PI = lambda kp, ki: (kp, ki, 0.0, 0.0)
CASES = [
    ("(1+2*s)*exp(-0.1*s)/((1+s)*(1+0.3*s)^2)", 1, [L(2)], [], [L(1), L(0.3), L(0.3)], 0.1, PI(1.5, 1), None, 0, 40),
    ("(1+2*s)*exp(-0.1*s)/((1+s)*(1+0.3*s)^2)", 1, [L(2)], [], [L(1), L(0.3), L(0.3)], 0.1, PI(1.5, 1), 0.4, 0, 60),
    ("(1-0.5*s)*exp(-s)/((1+2*s)*(1+s))", 1, [], [L(-0.5)], [L(2), L(1)], 1, PI(0.5, 0.2), 0.3, 0, 120),
    ("exp(-0.5*s)/(1+0.3*s+s^2)", 1, [], [], [[1, 0.3, 1]], 0.5, PI(0.05, 0.1), None, 0, 500),
    ("exp(-0.5*s)/(1+0.3*s+s^2)", 1, [], [], [[1, 0.3, 1]], 0.5, PI(0.05, 0.1), 0.8, 0, 500),
    ("0.5*exp(-0.3*s)/(s*(1+0.4*s))", 0.5, [], [], [S, L(0.4)], 0.3, PI(0.8, 0.15), 0.3, 0, 120),
    ("0.5*exp(-0.3*s)/(s*(1+0.4*s))", 0.5, [], [], [S, L(0.4)], 0.3, PI(0.8, 0.15), 0.3, 1, 120),
    ("exp(-0.2*s)/((1+s)*(1+0.5*s))", 1, [], [], [L(1), L(0.5)], 0.2, PI(1.2, 0.9), 0.25, 1, 60),
    ("-20*exp(-0.5*s)/(1+s)^5", -20, [], [], [L(1)] * 5, 0.5, PI(-0.025, -0.008), None, 0, 160),
    ("-20*exp(-0.5*s)/(1+s)^5", -20, [], [], [L(1)] * 5, 0.5, PI(-0.025, -0.008), 1.0, 0, 160),
    ("(1-0.7*s)/(1+s)^3", 1, [], [L(-0.7)], [L(1)] * 3, 0, PI(0.4, 0.2), 0.6, 0, 120),
    ("(1-0.4*s+0.5*s^2)/(1+s)^4", 1, [], [[1, -0.4, 0.5]], [L(1)] * 4, 0, PI(0.3, 0.15), None, 0, 160),
    ("(1+0.4*s+s^2)*exp(-0.5*s)/((1+s)*(1+2*s)*(1+3*s))", 1, [[1, 0.4, 1]], [], [L(1), L(2), L(3)], 0.5,
     PI(1.5, 0.5), None, 0, 100),
    ("exp(-0.1*s)/(s-1)", -1, [], [], [L(-1)], 0.1, PI(4, 3), None, 0, 60),
    ("exp(-0.5*s)/(1+s)^2", 1, [], [], [L(1), L(1)], 0.5, (1.8, 1.0, 1.0, 0.1), None, 0, 60),
    ("exp(-0.1*s)/s^2", 1, [], [], [S, S], 0.1, (0.8, 0.1, 1.8, 0.05), None, 0, 120),
    ("exp(-s)/(1+0.05*s)", 1, [], [], [L(0.05)], 1, PI(0.3, 0.4), None, 0, 80),
]

if __name__ == "__main__":
    print("plant;kp;ki;kd;tf;alpha;ramp;ie;iae;ise;itae;e_max;tv")
    for case in CASES:
        shortest = case[5] or 0.5
        h = shortest / (800 if case[0] == "exp(-s)/(1+0.05*s)" else 200)
        rest = 1.0
        while rest > 1e-9:
            coarse, rest = indices(case, h)
            if rest > 1e-9:
                case = (*case[:9], 1.5 * case[9])
        fine, _ = indices(case, h / 2)
        best = fine + (fine - coarse) / 3
        row = [case[0], *case[6], case[7] or 0, case[8], *[f"{x:.8g}" for x in best]]
        print(";".join(str(x) for x in row))
