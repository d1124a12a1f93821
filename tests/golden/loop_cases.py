"""The loops of `loops.json`: plants of order 1 to 6. All numbers are decimals and taken as exact."""


def pi(kp, ki, **more):
    return {"kp": kp, "ki": ki, **more}


def event(at, **what):
    return {"at": at, **what}


SETPOINT = event("0", setpoint={"step": "1"})


def load(at, size="0.5"):
    return event(at, disturbance={"step": size})


def case(name, ts, plant, pid, events, latency="0", samples=220, **more):
    return {"name": name, "ts": ts, "latency": latency, "plant": plant, "pid": pid, "events": events,
            "samples": samples, **more}


# ts = 0.1: 0.37 ts = 0.037; ts = 0.05: 17.618 ts = 0.8809.
PLAIN = [
    case("one lag, 0.37 samples of dead time", "0.1", dict(gain="2", lags=["1"], dead_time="0.037"),
         pi("0.8", "0.9"), [SETPOINT, load("12.34")]),
    case("one lag, 17.618 samples, latency 0.4", "0.05", dict(gain="1", lags=["1"], dead_time="0.8809"),
         pi("0.5", "0.5"), [SETPOINT, load("5.5128")], latency="0.02"),
    case("unstable lag", "0.05", dict(gain="-1", lags=["-1"], dead_time="0.0185"),
         pi("3", "0.6"), [SETPOINT, load("5.777", "-0.4")], latency="0.02"),
    case("integrator, latency 1.6, from 5", "0.1", dict(gain="0.8", integrators=1, dead_time="0.3"),
         pi("0.6", "0.08"), [event("1", setpoint={"step": "4"}), load("10.05", "0.3")], latency="0.16",
         initial={"setpoint": "5", "disturbance": "0.2"}),
    case("direct feedthrough, latency 0.4", "0.1", dict(gain="0.8", lags=["2"], zeros=[("0.5", "0")]),
         pi("0.7", "0.9"), [SETPOINT, load("9.99")], latency="0.04"),
    case("direct feedthrough, one sample of latency", "0.1",
         dict(gain="0.8", lags=["2"], zeros=[("0.5", "0")], dead_time="0.2"),
         pi("0.7", "0.6"), [SETPOINT, load("9.96")], latency="0.1"),
    case("two lags and a fast zero", "0.1", dict(gain="1.5", lags=["2", "0.3"], zeros=[("0.15", "0")],
         dead_time="0.037"), pi("1.2", "0.6"), [SETPOINT, load("11.111")], latency="0.1"),
    case("lightly damped pair, four samples", "0.05", dict(gain="1", pairs=[("0.3", "0.25")], dead_time="0.2"),
         pi("0.2", "0.6"), [SETPOINT, load("6.01", "1")]),
    case("two lags, right-half-plane zero", "0.1", dict(gain="1", lags=["1", "0.5"], zeros=[("-0.3", "0")],
         dead_time="0.13"), pi("0.7", "0.5"), [SETPOINT, load("12.5678")], latency="0.04"),
    case("integrator and lag", "0.1", dict(gain="0.5", integrators=1, lags=["0.8"], dead_time="0.25"),
         pi("0.6", "0.05"), [SETPOINT, event("9.87", disturbance={"pulse": "1.5", "duration": "0.033"})],
         latency="0.16", initial={"setpoint": "-2"}),
    case("double integrator under PID", "0.05", dict(gain="1", integrators=2, dead_time="0.0185"),
         pi("1", "0.2", kd="1.6", tf="0.1", b="0.6", c="0.2"),
         [SETPOINT, event("5.003", disturbance={"ramp": "0.3", "duration": "1.27"})], latency="0.02"),
    case("two equal lags, slow zero", "0.1", dict(gain="1", lags=["1", "1"], zeros=[("3", "0")], dead_time="0.04"),
         pi("0.2", "0.25", rule="trapezoid"), [SETPOINT, load("10.02")], latency="0.06"),
    case("three equal lags", "0.1", dict(gain="1", lags=["1", "1", "1"], dead_time="0.037"),
         pi("0.8", "0.35"), [SETPOINT, load("11.234")], latency="0.16"),
    case("lag, pair, right-half-plane zero, PID", "0.05",
         dict(gain="2", lags=["0.4"], pairs=[("0.6", "0.5")], zeros=[("-0.2", "0")], dead_time="0.8809"),
         pi("0.1", "0.16", kd="0.05", tf="0.08", c="1"), [SETPOINT, load("6.017", "0.3")]),
    case("integrator, two equal lags, right-half-plane zero", "0.1",
         dict(gain="0.4", integrators=1, lags=["0.6", "0.6"], zeros=[("-0.25", "0")], dead_time="0.0999"),
         pi("0.4", "0.02"), [SETPOINT, load("10.7", "-0.2")], latency="0.1"),
    case("double integrator and lag under PID", "0.05", dict(gain="0.7", integrators=2, lags=["0.12"]),
         pi("0.8", "0.1", kd="1.7", tf="0.06", rule="trapezoid"),
         [event("0.5", setpoint={"step": "2"}), event("5.512", disturbance={"ramp": "0.2"})], latency="0.08",
         initial={"setpoint": "1.5", "disturbance": "-0.3"}),
    case("four equal lags, 17.618 samples", "0.05", dict(gain="1", lags=["0.5"] * 4, dead_time="0.8809"),
         pi("0.35", "0.25"), [SETPOINT, load("5.9", "1")], latency="0.05"),
    case("four lags, each a fifth of the last", "0.05", dict(gain="2.5", lags=["1", "0.2", "0.04", "0.008"]),
         pi("0.9", "0.9"), [SETPOINT, event("5.3", disturbance={"pulse": "-1", "duration": "2.2222"})],
         latency="0.02"),
    case("two equal pairs", "0.1", dict(gain="1", pairs=[("0.8", "0.49")] * 2, dead_time="0.037"),
         pi("0.25", "0.25"), [SETPOINT, load("12.012")]),
    case("notch: as many zeros as poles", "0.1",
         dict(gain="1", pairs=[("2", "1")], zeros=[("0.2", "1")], dead_time="0.055"),
         pi("0.3", "0.5"), [SETPOINT, load("10.404")], latency="0.04"),
    case("order 4, relative degree 1, complex right-half-plane zeros", "0.1",
         dict(gain="1.2", lags=["2", "0.5"], pairs=[("0.9", "0.6")], zeros=[("-0.4", "0.3"), ("0.7", "0")],
              dead_time="0.3"), pi("0.3", "0.2"), [SETPOINT, load("11.98")], latency="0.16"),
    case("five equal lags", "0.1", dict(gain="1", lags=["0.4"] * 5, dead_time="0.037"),
         pi("0.6", "0.35"), [SETPOINT, load("10.003")], latency="0.04"),
    case("integrator, pair, two lags, right-half-plane zero", "0.1",
         dict(gain="0.3", integrators=1, pairs=[("0.5", "0.3")], lags=["0.4", "0.2"], zeros=[("-0.15", "0")],
              dead_time="0.037"), pi("0.5", "0.025"), [SETPOINT, load("10.7", "-0.2")], latency="0.16", samples=260),
    case("five lags, two zeros, PI by trapezoids", "0.05",
         dict(gain="1.5", lags=["1", "0.6", "0.3", "0.1", "0.05"], zeros=[("0.8", "0"), ("-0.12", "0")],
              dead_time="0.0185"), pi("0.5", "0.5", rule="trapezoid"),
         [SETPOINT, event("5.55", disturbance={"ramp": "-0.5", "duration": "0.717"})], latency="0.05"),
    case("six equal lags", "0.1", dict(gain="1", lags=["0.5"] * 6), pi("0.5", "0.22"),
         [SETPOINT, load("13.3")], samples=260),
    case("order 6: two pairs, two lags, a pair of right-half-plane zeros", "0.1",
         dict(gain="1", lags=["1.5", "0.2"], pairs=[("0.5", "0.2"), ("0.4", "0.3")], zeros=[("-0.3", "0.1")],
              dead_time="0.037"), pi("0.4", "0.3"), [SETPOINT, load("11.45")], latency="0.04"),
    case("order 6: integrator and five lags", "0.05",
         dict(gain="0.5", integrators=1, lags=["1", "0.5", "0.25", "0.12", "0.06"], dead_time="0.8809"),
         pi("0.3", "0.015"), [SETPOINT, load("6.123", "0.2")], latency="0.02", samples=260),
    case("observer, fractions of dead time and latency", "0.1",
         dict(gain="1.6", lags=["2"], dead_time="0.237"), pi("0.9", "0.4"), [SETPOINT, load("9.73", "1")],
         latency="0.04", observer=dict(gain="1.6", lags=["2"], dead_time="0.237", alpha="0.3")),
    case("estimator, model of second order, from 3", "0.05",
         dict(gain="0.8", lags=["1", "0.4"], dead_time="0.3333"), pi("1", "0.8", kd="0.2", tf="0.05"),
         [event("0.1", setpoint={"step": "4"}), load("5.018", "-1")], initial={"setpoint": "3", "disturbance": "0.5"},
         estimator=dict(gain="0.9", a1="1.4", a2="0.4", dead_time="0.31", kfd="0.7", tfd="0.1")),
    case("output range and rate, back-calculation", "0.1", dict(gain="1", lags=["2", "0.4"], dead_time="0.137"),
         pi("3", "1.5"), [SETPOINT, load("9.09", "-0.4")], limits=dict(lo="-0.2", hi="1.6", rate="2"), tt="0.7"),
    case("output range, conditional integration", "0.1", dict(gain="1", lags=["2", "0.4"], dead_time="0.137"),
         pi("2.5", "1.5"), [SETPOINT, load("9.09", "-0.4")], limits=dict(lo="-0.2", hi="1.5"),
         anti_windup="conditional"),
]

SIGNALS = [
    case("sines that begin and end between samples", "0.1", dict(gain="1", lags=["1", "0.5", "0.2"], dead_time="0.237"),
         pi("0.8", "0.5"),
         [SETPOINT, event("1.234", disturbance={"sine": "0.8", "period": "1.7", "phase": "0.7", "duration": "9.1"}),
          event("4.056", disturbance={"sine": "-0.5", "period": "0.23"}), load("13.3")], latency="0.04"),
    case("sine into an integrating loop with a zero", "0.05",
         dict(gain="0.5", integrators=1, pairs=[("0.5", "0.3")], zeros=[("-0.2", "0")], dead_time="0.0185"),
         pi("0.5", "0.03"), [event("0.777", disturbance={"sine": "0.6", "period": "3.1", "phase": "-1"})],
         latency="0.05", initial={"setpoint": "2", "disturbance": "0.1"}),
    case("sine through feedthrough", "0.1", dict(gain="0.8", lags=["2"], zeros=[("0.5", "0")], dead_time="0.033"),
         pi("0.7", "0.9"), [event("0.05", disturbance={"sine": "1", "period": "0.9", "phase": "1.5"})]),
    case("recorded lines, then a step", "0.1", dict(gain="1", lags=["1", "1"], dead_time="0.137"), pi("0.6", "0.4"),
         [SETPOINT, event("3.21", disturbance={"times": ["0", "0.513", "1.9", "2.004", "9.9", "12"],
                                               "values": ["0.3", "-0.2", "0.5", "1.5", "-1", "0"], "between": "line"}),
          event("5.5", disturbance={"pulse": "0.7", "duration": "1.234"}),
          event("14.04", disturbance={"step": "0.4"})], latency="0.04", initial={"disturbance": "0.2"}),
    case("recorded values that are held", "0.1", dict(gain="0.6", integrators=1, lags=["0.5"], dead_time="0.1"),
         pi("0.6", "0.05"),
         [event("0.123", disturbance={"times": ["0", "0.513", "1.9", "2.004", "4.444", "9.1"],
                                      "values": ["0.3", "-0.2", "0.5", "1.5", "-0.3", "0.1"], "between": "hold"}),
          event("12.5", disturbance={"ramp": "0.1", "duration": "2.02"})], latency="0.1"),
    case("set-point ramp, pulse and sine", "0.1", dict(gain="1", lags=["1", "0.3"], dead_time="0.05"),
         pi("1.2", "0.8", b="0.7"),
         [event("0.25", setpoint={"ramp": "0.4", "duration": "3.33"}),
          event("6.07", setpoint={"pulse": "-0.8", "duration": "2.5"}),
          event("7", setpoint={"sine": "0.3", "period": "2.9", "phase": "0.4", "duration": "10.05"}),
          event("12.1", setpoint={"step": "0.5"}), load("15.5")], latency="0.04"),
]

DEVICES = [
    case("sensor with range and resolution", "0.1", dict(gain="1", lags=["2", "0.5"], dead_time="0.137"),
         pi("1.5", "0.6"), [SETPOINT, load("9.99", "-0.7")],
         sensor=dict(lo="-0.1", hi="1.07", resolution="0.03")),
    case("actuator with range, rate and read-back", "0.1", dict(gain="1", lags=["2", "0.5"], dead_time="0.137"),
         pi("2", "1"), [SETPOINT, load("9.99", "-0.7")],
         actuator=dict(lo="-0.5", hi="1.5", rate="1.3", read_back=True)),
    case("actuator with resolution and dead band", "0.1", dict(gain="1", lags=["2", "0.5"], dead_time="0.137"),
         pi("1.2", "0.5"), [SETPOINT, load("9.99", "-0.7")], latency="0.04",
         actuator=dict(lo="-1", hi="1.4", rate="3", resolution="0.05", deadband="0.021")),
    case("sensor and actuator together, read-back", "0.05", dict(gain="0.6", integrators=1, lags=["0.3"]),
         pi("0.9", "0.1"), [SETPOINT, load("5.02", "0.3")], latency="0.02",
         sensor=dict(resolution="0.01"),
         actuator=dict(lo="-0.8", hi="0.8", rate="4", resolution="0.02", deadband="0.03", read_back=True)),
]

CASCADES = [
    case("cascade", "0.1", dict(gain="1.2", lags=["0.4", "2", "1"], dead_time="0.137"), pi("1.5", "0.5"),
         [event("0.2", setpoint={"step": "3"}), load("10.77", "1.5")], latency="0.04",
         inner_plant=dict(gain="1.5", lags=["0.4"], dead_time="0.037"), secondary=dict(pid=pi("0.8", "1.6")),
         initial={"setpoint": "2", "disturbance": "0.3"}),
    case("cascade whose inner loop meets its limit", "0.1",
         dict(gain="1", integrators=1, lags=["0.3", "0.8"], dead_time="0.1"), pi("0.5", "0.04"),
         [event("0", setpoint={"step": "4"}), load("14.05", "-0.2")], samples=300,
         inner_plant=dict(gain="1", lags=["0.3"]), secondary=dict(pid=pi("0.9", "3"), limits=dict(lo="-0.3", hi="0.6"))),
]

CASES = PLAIN + SIGNALS + DEVICES + CASCADES
