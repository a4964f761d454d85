"""A simulator of the user's in the place of a model."""

import _thread
import math
import signal

import numpy as np
import pandas
import pytest

import simgap

STEP = 5e-3
SAMPLES = 500
INERTIA, STIFFNESS, DAMPING = 0.12, 7.0, 0.15  # kg m2, N m/rad, N m s/rad
FRICTION = 0.11  # N m
LATE = 0.012  # s
# Looked for in the test; the whole catalogue finds the same in ten times as long.
RIVALS = {
    "parameter_error",
    "input_gain",
    "input_delay",
    "coulomb_friction",
    "viscous_damping",
    "quadratic_damping",
    "linear_stiffness",
    "sensor_delay",
    "sensor_lag",
    "sensor_gain",
    "sensor_bias",
}


def moves(inertia, damping, h):
    """What a step of an arm on a spring does to its angle and velocity, and what one newton metre adds."""
    decay = damping / (2.0 * inertia)
    omega = math.sqrt(STIFFNESS / inertia - decay**2)
    e, c, s = math.exp(-decay * h), math.cos(omega * h), math.sin(omega * h)
    a = e * (c + decay / omega * s), e * s / omega
    b = -e * s / omega * STIFFNESS / inertia, e * (c - decay / omega * s)
    return a, b, ((1.0 - a[0]) / STIFFNESS, -b[0] / STIFFNESS)


def swing(torque, inertia, damping, friction=0.0, substeps=1):
    """Angle and velocity under torques that are held between samples: exact without friction."""
    h = STEP / substeps
    (aq, av), (bq, bv), (gq, gv) = moves(inertia, damping, h)
    most = h / inertia * friction
    q = v = 0.0
    qs, vs = [], []
    for u in torque.tolist():
        qs.append(q)
        vs.append(v)
        for _ in range(substeps):
            q, v = aq * q + av * v + gq * u, bq * q + bv * v + gv * u
            if most:
                # What friction takes of the velocity in a step, at most all of it.
                v -= math.copysign(min(abs(v), most), v)
    return np.array(qs), np.array(vs)


def arm(parameters, inputs, forces):
    q, v = swing(inputs["torque"] + forces["joint"], parameters["inertia"], parameters["damping"])
    return {"q": q, "qd": v, "unused": "anything"}


def simulator(function=arm, **changed):
    told = {
        "inputs": ["torque"],
        "outputs": ["q"],
        "parameters": {"inertia": INERTIA, "damping": (DAMPING, 0.1)},
        "ports": {"joint": ("q", "qd")},
        "name": "arm",
    }
    return simgap.Simulator(function, **{**told, **changed})


def torque(k):
    t = STEP * np.arange(SAMPLES)
    phase = np.random.default_rng(7 + k).uniform(0.0, 2.0 * np.pi, 3)
    tones = zip([0.35, 0.8, 1.7 + 0.1 * k], [0.9, 0.6, 0.4], phase)
    # It sets in gently: the arm is at rest before.
    return (1.0 - np.exp(-2.0 * t)) * sum(a * np.sin(2 * np.pi * f * t + p) for f, a, p in tones)


def record(k, friction=FRICTION, late=LATE, noise=3e-4):
    t = STEP * np.arange(SAMPLES)
    u = torque(k)
    q, _ = swing(u, INERTIA, DAMPING, friction, substeps=20)
    q = np.interp(t - late, t, q) + np.random.default_rng(k).normal(0.0, noise, SAMPLES)
    return simgap.Record({"t": t, "torque": u, "q": q}, {"torque": "N m", "q": "rad"}, name=f"run{k}")


@pytest.fixture(scope="module")
def runs():
    return [record(k) for k in range(3)]


@pytest.fixture(scope="module")
def found(runs):
    others = [kind for kind in simgap.effects() if kind not in RIVALS]
    return simgap.diagnose(
        simulator=simulator(), train=runs[:2], check=runs[2:], withhold=others, progress=False
    )


def test_friction_and_a_late_sensor_are_named(found):
    named = {effect.kind: effect for effect in found.effects}
    # From rest, with one input and one output, what is late comes out the same whichever of both it is.
    late = {"sensor_delay", "input_delay"} & set(named)
    assert set(named) == {"coulomb_friction", *late} and len(late) == 1, str(found)
    assert "sensor delay" in str(found)
    friction = named["coulomb_friction"]
    assert friction.at == {"between": ["joint", "ground"]}
    value = friction.parameters["friction_force_n"].value
    assert value == pytest.approx(FRICTION, rel=0.05)
    delay = named[late.pop()].parameters["delay_s"].value
    assert delay == pytest.approx(LATE, rel=0.1)
    assert found.gap.closed > 0.95


def test_the_corrected_model_gives_the_corrected_predictions(found, runs):
    corrected = found.corrected
    assert corrected.to_toml().count("[[port]]") == 1
    predicted = simgap.simulate(corrected, runs[2], simulator=arm)
    expected = found.predictions["run2"]["q corrected [rad]"]
    assert np.abs(predicted["q [rad]"] - expected).max() < 1e-6
    assert "joint" in found.to_html()


def test_the_function_is_called_as_promised(runs):
    seen = []

    def function(parameters, inputs, forces):
        seen.append((parameters, inputs, forces))
        return pandas.DataFrame(arm(parameters, inputs, forces))

    predicted = simgap.simulate(None, runs[0], simulator=simulator(function))
    parameters, inputs, forces = seen[0]
    assert parameters == {"inertia": INERTIA, "damping": DAMPING}
    assert set(inputs) == {"torque", "t"} and set(forces) == {"joint"}
    for array in [*inputs.values(), *forces.values()]:
        assert array.dtype == np.float64 and array.shape == (SAMPLES,)
    assert np.allclose(inputs["t"], STEP * np.arange(SAMPLES))
    assert not forces["joint"].any()
    assert len(seen) == 1
    q, _ = swing(torque(0), INERTIA, DAMPING)
    assert np.array_equal(predicted["q [rad]"], q)


def test_columns_are_converted_and_named_as_the_function_has_them(runs):
    run = runs[0]
    data = {"t": run.t, "M": 1e3 * run["torque"], "phi": np.degrees(run["q"])}
    other = simgap.Record(data, {"M": "N mm", "phi": "deg"})
    named = simulator(inputs={"M": "torque"}, outputs={"phi": "q"})
    predicted = simgap.simulate(None, other, simulator=named)
    q, _ = swing(torque(0), INERTIA, DAMPING)
    assert np.allclose(predicted["phi [rad]"], q, atol=1e-9)


def test_a_model_of_parts_takes_a_function(runs):
    model = (
        simgap.Model("arm")
        .input("torque", at="torque", kind="signal")
        .output("q", kind="signal")
        .parameter("inertia", INERTIA)
        .parameter("damping", DAMPING, uncertainty=0.1)
        .port("joint", displacement="q", velocity="qd")
        .effect("coulomb_friction", between=("joint", "ground"), friction_force_n=FRICTION)
    )
    predicted = simgap.simulate(model, runs[0], simulator=arm)
    q, _ = swing(torque(0), INERTIA, DAMPING, FRICTION, substeps=20)
    # The same friction, at the end of each step there.
    assert np.abs(predicted["q [rad]"] - q).max() < 0.01 * np.abs(q).max()
    assert "<svg" in model._repr_html_()


def refused(function, runs, **changed):
    with pytest.raises(simgap.SimgapError) as raised:
        simgap.diagnose(
            simulator=simulator(function, **changed), train=runs[0], check=runs[1], progress=False
        )
    assert "\n" not in str(raised.value)
    return raised.value


def test_an_exception_comes_back_as_it_is(runs):
    def function(parameters, inputs, forces):
        raise RuntimeError("the licence has expired")

    error = refused(function, runs)
    assert str(error) == "the simulator failed: RuntimeError: the licence has expired"
    assert isinstance(error.__cause__, RuntimeError)


def test_an_exception_in_the_middle_ends_the_work(runs):
    calls = []

    def function(parameters, inputs, forces):
        calls.append(parameters)
        if len(calls) > 20:
            raise RuntimeError("enough")
        return arm(parameters, inputs, forces)

    assert isinstance(refused(function, runs).__cause__, RuntimeError)
    assert len(calls) < 30


def test_answers_that_are_none_are_told_in_one_line(runs):
    def broken(t):
        return np.where(t < 0.998, 0.0, np.nan)

    cases = [
        (lambda p, i, f: {"q": i["t"]}, 'returned no output "qd", found is: q'),
        (lambda p, i, f: {"q": i["t"][:5], "qd": i["t"]}, '"q" of the simulator has shape (5,)'),
        (lambda p, i, f: {"q": ["a"] * SAMPLES, "qd": i["t"]}, '"q" of the simulator holds no'),
        (lambda p, i, f: None, "the simulator returned NoneType"),
        (lambda p, i, f: {"q": i["t"], "qd": broken(i["t"])}, '"qd" of the simulator is NaN at 1 s'),
        (
            lambda p, i, f: {"q": i["torque"], "qd": i["torque"]},
            'a force at port "joint" does not move',
        ),
    ]
    for function, line in cases:
        assert line in str(refused(function, runs)), line


def test_what_a_simulator_needs_is_told(runs):
    with pytest.raises(simgap.SimgapError, match="needed is a check record"):
        simgap.diagnose(simulator=simulator(), train=runs[:2], progress=False)
    with pytest.raises(simgap.SimgapError, match="simgap.Simulator"):
        simgap.diagnose(simulator=arm, train=runs[:2], check=runs[2], progress=False)
    with pytest.raises(simgap.SimgapError, match="needed is the simulator itself"):
        simgap.diagnose(simulator().model, train=runs[:2], check=runs[2], progress=False)
    with pytest.raises(simgap.SimgapError, match="called 't'"):
        simulator(inputs=["t"])
    with pytest.raises(simgap.SimgapError, match="parameter.*damping"):
        simulator(parameters={"damping": (DAMPING, -1.0)})
    with pytest.raises(simgap.SimgapError, match="no matrices"):
        simgap.modes(simulator().model)


def test_an_interrupt_ends_the_work(runs):
    calls = []
    # A shell starts what runs in the background with interrupts ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)

    def function(parameters, inputs, forces):
        calls.append(parameters)
        if len(calls) == 10:
            _thread.interrupt_main()
        return arm(parameters, inputs, forces)

    with pytest.raises(KeyboardInterrupt):
        simgap.diagnose(
            simulator=simulator(function), train=runs[:2], check=runs[2], progress=False
        )
