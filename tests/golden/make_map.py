"""Golden points of a trade-off map: a PI with disturbance observer over the PI alone on exp(-L*s)/(1 + (1-L)*s).

    python tests/golden/make_map.py > controller-sim-host/tests/data/map.csv

Needs numpy and scipy. Nothing is shared with the program: the PI comes from the ellipses of `tests/bench/design_python.py`,
the indices from the loop as it is wired, sampled finely and extrapolated (`controller-design/tests/golden/responses.py`),
the sensitivity from a grid of frequencies, refined around its peak. `alpha` is over dead time plus lag, which is 1 s;
`horizon` is in seconds, 0: until the error has died out.
"""

import itertools
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/bench"), str(ROOT / "controller-design/tests/golden")]

from design_python import frequencies, pi_ms  # noqa: E402
from responses import indices  # noqa: E402

# A short dead time needs short steps, and a slow filter a long time: not both.
GRID = itertools.product([0.05, 0.2, 0.5, 0.9], [0.1, 1.0, 10.0], [1.2, 2.0], [0.0, 4.0])
POINTS = [point for point in GRID if point[:2] != (0.05, 10.0)]


def best(dead_time, gains, alpha, horizon):
    """IAE, ISE, ITAE, e_max, TV, extrapolated."""
    h = dead_time / (400 if dead_time > 0.5 else 200)
    case = ["", 1.0, [], [], [[1.0, 1.0 - dead_time]], dead_time, (*gains, 0.0, 0.0), alpha, 0, horizon or 40.0]
    while True:
        coarse, rest = indices(case, h)
        if horizon or rest < 1e-8:
            break
        case[9] *= 1.5
    fine, _ = indices(case, h / 2)
    return (fine + (fine - coarse) / 3)[1:]


def peak(dead_time, gains, alpha):
    """The largest sensitivity."""
    kp, ki = gains

    def size(w):
        s = 1j * w
        delay = np.exp(-s * dead_time)
        observed = delay / (1.0 + alpha * s) if alpha else 0.0
        return np.abs((1.0 - observed) / (1.0 + delay / (1.0 + (1.0 - dead_time) * s) * (kp + ki / s)))

    grid = frequencies(1.0, min(dead_time, alpha or 1.0), dead_time)
    at = grid[np.argmax(size(grid))]
    near = np.linspace(0.98 * at, 1.02 * at, 4001)
    return np.max(size(near))


if __name__ == "__main__":
    print("l,alpha,ms0,horizon,kp,ki,load_iae,load_ise,load_itae,load_e_max,load_tv,ms,a_n")
    for dead_time, alpha, ms, horizon in POINTS:
        lag = 1.0 - dead_time
        omega = frequencies(1.0, min(dead_time, lag), dead_time)
        gains = pi_ms(lambda s: np.exp(-dead_time * s) / (1.0 + lag * s), omega, ms)[:2]
        ratios = best(dead_time, gains, alpha, horizon) / best(dead_time, gains, None, horizon)
        sensitivity = peak(dead_time, gains, alpha) / peak(dead_time, gains, None)
        noise = 1.0 + lag / (alpha * gains[0])
        numbers = [*gains, *ratios, sensitivity, noise]
        print(",".join([f"{x:g}" for x in (dead_time, alpha, ms, horizon)] + [f"{x:.8g}" for x in numbers]), flush=True)
