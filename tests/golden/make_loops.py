#!/usr/bin/env python3
"""Writes loops.json: closed sampled loops around plants with dead time, from 50-digit arithmetic.

How to run (no network is used once the packages are installed):

    python3 -m venv .venv && .venv/bin/pip install numpy==2.4.6 scipy==1.17.1 mpmath==1.4.1
    .venv/bin/python make_loops.py            # checks itself, then writes loops.json beside this file
    .venv/bin/python make_loops.py --check    # compares with the file instead of writing it

Method: the held output of a sampled loop is a sum of steps, so the output of a linear plant is a sum of its step
responses, each shifted by its sample, the latency and the dead time. Step, ramp and sine responses come from partial
fractions (`exact_response.py`). The control laws are written from their difference equations (`loop_law.py`,
`loop_compensator.py`). All inputs are decimals, taken as exact; a program that reads them as doubles works on the same loop
within 1e-16 of each number.

Checked on the way (`loop_check.py`): a second simulation by scipy, which integrates the state equations of an ordinary
differential equation solver from one change of the input to the next (method of steps), agrees to 1e-9; every loop
settles, so that rounding does not grow.
"""

import json
import sys
from fractions import Fraction
from pathlib import Path

import mpmath as mp

from loop_cases import CASES
from loop_check import check_by_solver, check_settling
from loop_simulation import Loop

OUTPUT = Path(__file__).with_name("loops.json")
# Instants between the samples that are stored, too.
BETWEEN = (Fraction(3, 10), Fraction(7, 10))
EVERY = 11


def short(x):
    """15 digits: a rounding of 5e-15 at most, below what doubles can be expected to give."""
    return mp.nstr(x, 15, strip_zeros=True, min_fixed=-3, max_fixed=7)


def rows(loop, count):
    """Sample, measurement, controller output, output in between, in a cascade the set-point and the measurement of the
    inner loop: the first few, then every eleventh, then the last."""
    chosen = sorted({*range(6), *range(6, count, EVERY), count - 1})
    table = []
    for k in chosen:
        between = [loop.output((k + f) * loop.ts) for f in BETWEEN]
        signals = (loop.seen[k], loop.u[k], *between, *loop.extra[k])
        table.append([k, *(float(short(x)) for x in signals)])
    return table


def main():
    results = []
    for case in CASES:
        loop = Loop(case)
        check_settling(loop)
        solved = check_by_solver(loop)
        print("%-62s solver %.1e" % (case["name"], solved), file=sys.stderr)
        results.append({**case, "rows": rows(loop, case["samples"])})
    text = "[\n" + ",\n".join(json.dumps(r, separators=(",", ":")) for r in results) + "\n]\n"
    if "--check" in sys.argv:
        assert OUTPUT.read_text() == text, "loops.json differs"
    else:
        OUTPUT.write_text(text)
    print(len(text), "bytes", file=sys.stderr)


if __name__ == "__main__":
    main()
