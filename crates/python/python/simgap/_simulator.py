"""Simulators of the user's: a function in the place of a model."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _simgap
from ._model import Model

_Array = npt.NDArray[np.float64]
#: ``f(parameters, inputs, forces) -> outputs``.
SimulatorFunction = Callable[[dict[str, float], dict[str, _Array], dict[str, _Array]], Any]


class Simulator:
    """A simulator that stands for the plant: a MuJoCo model, an FMU, a function of NumPy.

    ::

        def arm(parameters, inputs, forces):
            ...  # step a model over inputs["t"], from the same state every time
            return {"q": q, "qd": qd}

        simulator = simgap.Simulator(
            arm,
            inputs=["torque"],                                   # columns of the records
            outputs=["q"],
            parameters={"inertia": 0.05, "damping": (0.1, 0.3)},  # value, or value and uncertainty
            ports={"joint": ("q", "qd")},                        # displacement and velocity there
        )
        d = simgap.diagnose(simulator=simulator, train=[run1, run2], check=[run3])

    ``function(parameters, inputs, forces)`` is called with

    - ``parameters``: ``dict`` of names to ``float``;
    - ``inputs``: ``dict`` of names to arrays of shape ``(samples,)``: the inputs, in SI where the
      unit of the column has one (mm come in m, degrees in rad; V and A as they are), and ``"t"``,
      s, from 0 in even steps. What an input is between its samples is up to the function;
    - ``forces``: ``dict`` of the names of the ports to arrays of shape ``(samples,)``: a force, N,
      or a torque, N m, that acts there in the direction of the displacement, beside everything
      that the simulator has there itself. Each value holds from its sample to the next.

    It returns a mapping of names to arrays of shape ``(samples,)``, or a data frame: every output
    that is compared and the displacement (m or rad) and velocity (m/s or rad/s) of every port, at
    the stamps ``t``, in SI. What it returns beside these is not looked at.

    The same arguments have to give the same answer, and every call begins in the same state: in that
    in which the records begin. It is called thousands of times, from several threads but never by
    two at a time; equal questions are asked once.

    ``inputs`` and ``outputs`` are names of columns of the records, or mappings of columns to the
    names that the function uses. ``parameters`` are the values that may be wrong: a value that is
    not zero, or the value and its relative standard deviation, 0.02 where none is given. ``ports``
    are the places where a force may act: friction at a joint, a stop at a slide. Which effects can
    sit where is on the page ``docs/simulators.md``.
    """

    def __init__(
        self,
        function: SimulatorFunction,
        *,
        inputs: Sequence[str] | Mapping[str, str] = (),
        outputs: Sequence[str] | Mapping[str, str],
        parameters: Mapping[str, float | tuple[float, float]] | None = None,
        ports: Mapping[str, tuple[str, str]] | None = None,
        name: str = "simulator",
    ) -> None:
        if "t" in [signal for _, signal in _named(inputs)]:
            raise _simgap.SimgapError(
                "an input of the simulator is called 't', needed is another name: inputs['t'] is the "
                "time"
            )
        model = Model(name)
        for column, signal in _named(inputs):
            model = model.input(column, at=signal, kind="signal")
        for column, signal in _named(outputs):
            model = model.output(column, at=signal, kind="signal")
        for parameter, value in (parameters or {}).items():
            known = value if isinstance(value, tuple) else (value, None)
            model = model.parameter(parameter, known[0], uncertainty=known[1])
        for port, (displacement, velocity) in (ports or {}).items():
            model = model.port(port, displacement=displacement, velocity=velocity)
        model.to_toml()
        self.function = function
        #: The model that stands for it: its signals, parameters and ports.
        self.model = model

    def __call__(
        self,
        parameters: Mapping[str, float] | None = None,
        inputs: Mapping[str, Any] | None = None,
        forces: Mapping[str, Any] | None = None,
    ) -> Any:
        """Calls the function."""
        return self.function(dict(parameters or {}), dict(inputs or {}), dict(forces or {}))

    def __repr__(self) -> str:
        return f"<simgap.Simulator {self.model.name!r}>"


def _named(columns: Sequence[str] | Mapping[str, str]) -> list[tuple[str, str]]:
    if isinstance(columns, str):
        return [(columns, columns)]
    if isinstance(columns, Mapping):
        return list(columns.items())
    return [(column, column) for column in columns]


def asked(simulator: Simulator | SimulatorFunction | None) -> Callable[..., list[_Array]] | None:
    """A simulator as the native half calls it; its errors become one line."""
    if simulator is None:
        return None
    function = simulator.function if isinstance(simulator, Simulator) else simulator
    # A simulator that frees the interpreter while it steps has one state all the same.
    turn = threading.Lock()

    def call(
        parameters: dict[str, float],
        inputs: dict[str, _Array],
        forces: dict[str, _Array],
        t: _Array,
        wanted: list[str],
    ) -> list[_Array]:
        inputs["t"] = t
        try:
            with turn:
                found = function(parameters, inputs, forces)
        except Exception as error:
            line = f"the simulator failed: {type(error).__name__}: {error}"
            raise _simgap.SimgapError(line) from error
        return [_output(found, name, len(t)) for name in wanted]

    return call


def _output(found: Any, name: str, samples: int) -> _Array:
    """One output, checked but for the numbers in it."""
    if not hasattr(found, "keys"):
        raise _simgap.SimgapError(
            f"the simulator returned {type(found).__name__}, needed is a mapping of names to "
            "arrays, or a data frame"
        )
    if name not in found:
        known = ", ".join(str(key) for key in found.keys())
        raise _simgap.SimgapError(
            f'the simulator returned no output "{name}", found is: {known or "nothing"}'
        )
    try:
        array = np.asarray(found[name], dtype=np.float64)
    except (TypeError, ValueError):
        raise _simgap.SimgapError(
            f'output "{name}" of the simulator holds no numbers, needed is an array of float64'
        ) from None
    if array.shape != (samples,):
        raise _simgap.SimgapError(
            f'output "{name}" of the simulator has shape {array.shape}, needed is ({samples},): '
            "one value for each sample of the inputs"
        )
    return np.ascontiguousarray(array)
