"""Simulations, modes, the catalogue of effects."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from . import _simgap
from ._frame import frame
from ._model import Model
from ._parts import made
from ._record import Record, native_records
from ._simulator import Simulator, SimulatorFunction, asked

if TYPE_CHECKING:
    import pandas


def simulate(
    model: Model | str | os.PathLike[str] | None,
    record: Record | str | os.PathLike[str],
    *,
    simulator: Simulator | SimulatorFunction | None = None,
    from_rest: bool = False,
    map: Iterable[str] = (),
    columns: str | None = None,
    mend: bool = False,
) -> pandas.DataFrame:
    """Predicts the outputs of a model, effects included, from the inputs of a record.

    The columns are ``t [s]`` and name and unit of each output, one row for each sample. The
    motion starts as measured outputs of the record say; at rest at zero displacement where
    there are none, or with ``from_rest``. What a reader must know stands in ``attrs["notes"]``.
    ``map``, ``columns`` and ``mend`` as in :func:`simgap.read`.

    A ``simulator`` (:class:`simgap.Simulator`, or its function) stands for the plant of its own
    model, ``None``, or of one that was corrected: ``simgap.simulate(d.corrected, run,
    simulator=simulator)``. It begins in the state that it begins in.
    """
    if model is None:
        if not isinstance(simulator, Simulator):
            raise _simgap.SimgapError("there is no model, needed is one or a simgap.Simulator")
        model = simulator.model
    if not isinstance(model, Model):
        model = Model.from_file(model)
    (native,) = native_records(record, model, True, map, columns, mend)
    predicted, notes = _simgap.simulate(model._compiled(), native, from_rest, asked(simulator))
    table = frame(predicted)
    table.attrs["notes"] = notes
    return table


@dataclasses.dataclass(frozen=True)
class Mode:
    """A mode of the model, linearised at rest under its loads."""

    natural_freq_hz: float
    damped_freq_hz: float
    damping_ratio: float
    #: rad/s.
    pole: complex
    #: Part of each mass, over that of the mass which moves most.
    shape: dict[str, complex]


class Modes(Sequence[Mode]):
    """The modes of a model, slowest first, and its frequency responses
    (``to_dict()["responses"]``).
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._modes = [_mode(one) for one in json.loads(text)["modes"]]

    def __getitem__(self, index: Any) -> Any:
        return self._modes[index]

    def __iter__(self) -> Iterator[Mode]:
        return iter(self._modes)

    def __len__(self) -> int:
        return len(self._modes)

    def to_dict(self) -> dict[str, Any]:
        """Everything, as ``modes.json`` holds it."""
        return json.loads(self._text)

    def to_json(self) -> str:
        """The text of ``modes.json``: the bytes that the command writes for the same model."""
        return self._text

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each mode: natural and damped frequency, Hz, and damping ratio."""
        import pandas

        names = ("natural_freq_hz", "damped_freq_hz", "damping_ratio")
        return pandas.DataFrame([{name: getattr(mode, name) for name in names} for mode in self])

    def __repr__(self) -> str:
        told = (f"{mode.natural_freq_hz:.4g} Hz ({mode.damping_ratio:.3g})" for mode in self)
        return f"<simgap.Modes {', '.join(told)}>"


def _mode(values: dict[str, Any]) -> Mode:
    import cmath
    import math

    shape = {
        part["mass"]: cmath.rect(part["amplitude"], math.radians(part["phase_deg"]))
        for part in values["shape"]
    }
    pole = complex(values["pole"]["re"], values["pole"]["im"])
    return made(Mode, {**values, "pole": pole, "shape": shape})


def modes(model: Model | str | os.PathLike[str]) -> Modes:
    """Poles, mode shapes and frequency responses of a model, linearised at rest under its loads."""
    if not isinstance(model, Model):
        model = Model.from_file(model)
    return Modes(_simgap.modes(model._compiled()))


@dataclasses.dataclass(frozen=True)
class KindParameter:
    """A parameter of a kind, with its unit at the end of its name."""

    name: str
    unit: str
    #: None where there is no bound.
    lower: float | None
    upper: float | None
    #: None where it only shapes the effect.
    no_effect_at: float | None
    #: Whether each record has its own value.
    per_record: bool


@dataclasses.dataclass(frozen=True)
class Kind:
    """What an entry of the catalogue says of itself."""

    kind: str
    #: ``nominal_parameter``, ``force``, ``dynamics`` or ``measurement``.
    family: str
    summary: str
    equation: str
    #: Where it can sit, in words.
    site: str
    parameters: list[KindParameter]
    #: What shows it best.
    experiment: str
    #: Kinds it is taken for, and why.
    confused_with: dict[str, str]

    @classmethod
    def of(cls, values: dict[str, Any]) -> Kind:
        """A kind from what the JSON holds."""
        parameters = [made(KindParameter, one) for one in values["parameters"]]
        confused = {one["kind"]: one["because"] for one in values["confused_with"]}
        return made(cls, {**values, "parameters": parameters, "confused_with": confused})


def effects(
    kind: str | None = None, model: Model | str | os.PathLike[str] | None = None
) -> dict[str, Kind]:
    """The catalogue of effects by kind, or one entry of it; with a model its own laws
    (``[[law]]``) too.
    """
    if model is not None and not isinstance(model, Model):
        model = Model.from_file(model)
    native = None if model is None else model._compiled()
    found = json.loads(_simgap.effects(kind, native))["effects"]
    return {one["kind"]: Kind.of(one) for one in found}
