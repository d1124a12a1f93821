"""Golden IAE-optimal PI controllers: scipy's minimiser on the finely sampled loop of responses.py.

Needs numpy and scipy; prints the lines of pi_iae.csv.

    python pi_iae.py > pi_iae.csv
"""

import numpy as np
from scipy.optimize import minimize

from responses import L, S, indices

# text, gain, mp zeros, nmp zeros, poles, dead time, start kp, start ti, horizon, step
PLANTS = [
    ("exp(-10*s)/(1+s)", 1, [], [], [L(1)], 10, 0.35, 5, 300, 0.05),
    ("exp(-0.01*s)/(1+s)", 1, [], [], [L(1)], 0.01, 90, 0.04, 0.6, 2e-4),
    ("(1-0.3*s)*exp(-0.2*s)/((1+s)^2*(1+0.4*s))", 1, [], [L(-0.3)], [L(1), L(1), L(0.4)], 0.2, 0.8, 2, 60, 0.01),
    ("1/(1+s)^8", 1, [], [], [L(1)] * 8, 0, 0.6, 5, 160, 0.05),
    ("0.5*exp(-0.3*s)/(s*(1+0.4*s))", 0.5, [], [], [S, L(0.4)], 0.3, 1.5, 3, 60, 0.01),
]

if __name__ == "__main__":
    print("plant;kp;ti;iae")
    for text, k, mp, nmp, den, dead, kp, ti, horizon, h in PLANTS:

        def iae(x, h=h):
            kp, ti = np.exp(x)
            case = (text, k, mp, nmp, den, dead, (kp, kp / ti, 0.0, 0.0), None, 0, horizon)
            with np.errstate(all="ignore"):
                try:
                    values, rest = indices(case, h)
                except IndexError:
                    return 1e9
            return values[1] if rest < 1e-2 else 1e9

        options = {"xatol": 1e-5, "fatol": 1e-10, "initial_simplex": None}
        best = minimize(iae, np.log([kp, ti]), method="Nelder-Mead", options=options)
        # The place to second order in the step, by extrapolation; the IAE at the extrapolated place.
        finer = minimize(lambda x: iae(x, h / 2), best.x, method="Nelder-Mead", options=options)
        x = finer.x + (finer.x - best.x) / 3
        value = iae(x, h / 2) + (iae(x, h / 2) - iae(x, h)) / 3
        kp, ti = np.exp(x)
        print(f"{text};{kp:.6g};{ti:.6g};{value:.8g}", flush=True)
