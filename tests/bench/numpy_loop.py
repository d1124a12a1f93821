"""The loop of the benchmark as one writes it in a notebook: numpy arrays for the states, a plain loop over the samples.

    python numpy_loop.py SAMPLES EVERY

Plant, controller and disturbance estimator are those of the scenario `demo`, controller DE-MOMI. Every EVERY samples the
next of four things happens: set-point to 1, disturbance to 1, set-point to 0, disturbance to 0.

Prints one line: samples per second of the loop alone, and the integral of the absolute error.
"""

import sys
import time
from collections import deque

import numpy as np
from scipy.linalg import expm

TS = 0.01

# Plant exp(-0.2 s)/((1 + 0.2 s)(1 + s)); the estimator's model is the same.
GAIN, A1, A2, DEAD_TIME = 1.0, 1.2, 0.2, 0.2
KP, KI, KD, TF = 2.354490875, 1.879564327, 0.4753148656, 0.1187005288
KFD, TFD = 0.688669975, 0.05996942655
U_LO, U_HI = -100.0, 100.0


def hold_equivalent():
    """Matrices of x[k+1] = A x[k] + B w[k], y[k] = C x[k] for an input that is held over a sample (exact)."""
    a = np.array([[0.0, 1.0], [-1.0 / A2, -A1 / A2]])
    b = np.array([[0.0], [GAIN / A2]])
    block = np.zeros((3, 3))
    block[:2, :2] = a
    block[:2, 2:] = b
    discrete = expm(block * TS)
    return discrete[:2, :2], discrete[:2, 2], np.array([1.0, 0.0])


def inputs(samples, every):
    """Set-point and disturbance at every sample."""
    part = np.arange(samples) // every % 4
    return np.isin(part, [0, 1]).astype(float), np.isin(part, [1, 2]).astype(float)


def run(samples, every):
    """Simulates the loop; gives the seconds it took and the integral of the absolute error."""
    A, B, C = hold_equivalent()
    setpoint, disturbance = inputs(samples, every)
    delay = round(DEAD_TIME / TS)

    x = np.zeros(2)  # plant
    x_model = np.zeros(2)
    plant_line = deque([0.0] * delay)
    model_line = deque([0.0] * delay)
    y = 0.0

    # First-order sections by Tustin's rule: s += g (input + last input - 2 s).
    g_fd = TS / (TS + 2.0 * TFD)
    g_pid = TS / (TS + 2.0 * TF)
    lag1 = lag2 = lag3 = gap_before = 0.0
    r_lag = y_lag = r_before = y_before = 0.0

    integral = 0.0
    v = u = 0.0
    unwind = min(1.0, TS / max(KP / KI, TF, TS))
    iae = 0.0

    start = time.process_time()
    for k in range(samples):
        r = setpoint[k]
        d = disturbance[k]

        # Disturbance estimator: what the model cannot explain, through (1 + A1 s + A2 s^2)/(1 + TFD s)^3.
        gap = y - C @ x_model
        lag1_before, lag2_before = lag1, lag2
        lag1 += g_fd * (gap + gap_before - 2.0 * lag1)
        lag2 += g_fd * (lag1 + lag1_before - 2.0 * lag2)
        lag3 += g_fd * (lag2 + lag2_before - 2.0 * lag3)
        gap_before = gap
        first = (lag2 - lag3) / TFD
        second = (lag1 - 2.0 * lag2 + lag3) / TFD**2
        d_f = KFD / GAIN * (lag3 + A1 * first + A2 * second)

        # PID, parallel form, trapezoid for the integral term, back-calculation from the last output.
        integral += unwind * (u - v)
        integral += KI * TS * 0.5 * ((r - y) + (r_before - y_before))
        r_lag += g_pid * (r + r_before - 2.0 * r_lag)
        y_lag += g_pid * (y + y_before - 2.0 * y_lag)
        r_before, y_before = r, y
        # (P + D s)/(1 + TF s) with P = KP - KI TF: D s/(1 + TF s) = (D/TF) (1 - 1/(1 + TF s)).
        e_lag = r_lag - y_lag
        pd = (KP - KI * TF) * e_lag + KD / TF * ((r - y) - e_lag)
        v = integral + pd - d_f
        u = min(max(v, U_LO), U_HI)

        # Plant and model, exactly over one sample; the disturbance adds to the output before the dead time.
        plant_line.append(u + d)
        model_line.append(u)
        x = A @ x + B * plant_line.popleft()
        x_model = A @ x_model + B * model_line.popleft()

        y_next = C @ x
        iae += 0.5 * TS * (abs(r - y) + abs(r - y_next))
        y = y_next
    return time.process_time() - start, iae


def main():
    samples, every = int(sys.argv[1]), int(sys.argv[2])
    seconds, iae = run(samples, every)
    print(f"samples_per_second={samples / seconds:.1f} iae={iae:.9g}")


if __name__ == "__main__":
    main()
