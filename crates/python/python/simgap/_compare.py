"""Two traces compared, for models in other simulators."""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _simgap
from ._frame import frame, page_in_notebook
from ._parts import Effect, Where, made
from ._progress import Steps
from ._record import Record, native_records

if TYPE_CHECKING:
    import pandas


@dataclasses.dataclass(frozen=True)
class Agreement:
    """How well one channel agrees."""

    channel: str
    #: Column of the simulated record.
    simulated: str
    unit: str
    #: rms(measured - simulated) / std(measured).
    nrmse: float
    r_squared: float
    correlation: float
    #: rms of the discrepancy, in the unit.
    rms: float
    #: Largest discrepancy, in the unit.
    largest: float


class Comparison:
    """A measured and a simulated trace: how far apart, where, and what of it the measurement
    chain explains.
    """

    def __init__(self, native: _simgap.Compared) -> None:
        self._native = native

    @cached_property
    def _values(self) -> dict[str, Any]:
        return json.loads(self.to_json())

    @property
    def status(self) -> str:
        """``"none"`` (the gap is noise), ``"effect"`` (faults of the measurement chain explain
        it) or ``"unknown"`` (they do not: look for it in the model).
        """
        return self._values["chain"]["status"]

    @cached_property
    def effects(self) -> list[Effect]:
        """Faults of the measurement chain that explain the gap."""
        return [Effect.of(one) for one in self._values["chain"]["effects"]]

    @cached_property
    def channels(self) -> list[Agreement]:
        """How well each channel agrees."""
        return [made(Agreement, one) for one in self._values["channels"]]

    @cached_property
    def where(self) -> Where:
        """Where the discrepancy lies."""
        return Where.of(self._values["where"])

    @property
    def notes(self) -> list[str]:
        """What a reader must know, one sentence each."""
        return self._values["notes"]

    @cached_property
    def traces(self) -> pandas.DataFrame:
        """``t [s]`` and, for each channel, what was measured, what was simulated, and what was
        simulated with the named faults.
        """
        return frame(self._native.traces())

    def to_dict(self) -> dict[str, Any]:
        """Everything, as ``comparison.json`` holds it."""
        return json.loads(self.to_json())

    def to_json(self) -> str:
        """The text of ``comparison.json``: the bytes that the command writes for the same input."""
        return self._native.json()

    def to_html(self) -> str:
        """The report: one self-contained page."""
        return self._native.page()

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes the folder that the command writes."""
        self._native.save(Path(folder))

    def __repr__(self) -> str:
        gaps = ", ".join(f"{one.channel} nrmse {one.nrmse:.3g}" for one in self.channels)
        return f"<simgap.Comparison {self.status}: {gaps}>"

    def _repr_html_(self) -> str:
        """The report, in a frame."""
        return page_in_notebook(self.to_html())


def compare(
    measured: Record | str | os.PathLike[str],
    simulated: Record | str | os.PathLike[str],
    *,
    pairs: Mapping[str, str] | None = None,
    inputs: Iterable[str] = (),
    align_start: bool = False,
    progress: bool | Callable[[str], object] = True,
    map: Iterable[str] = (),
    columns: str | None = None,
    mend: bool = False,
) -> Comparison:
    """Compares a measured with a simulated trace, without a model: for models in other
    simulators.

    Both are records or paths; ``map``, ``columns`` and ``mend`` are about the measured one, as
    in :func:`simgap.read`. ``pairs`` names the columns to compare where they are called
    differently, measured to simulated; otherwise columns of the same name are compared.
    ``inputs`` are columns of both that drive the machine and are not compared. ``align_start``
    takes both to begin at the same moment, whatever their stamps say.
    """
    (one,) = native_records(measured, None, map=map, columns=columns, mend=mend)
    (other,) = native_records(simulated, None, mend=True)
    driving = [inputs] if isinstance(inputs, str) else list(inputs)
    with Steps(progress) as steps:
        named = list((pairs or {}).items())
        compared = _simgap.compare(one, other, named, driving, align_start, steps.call)
    return Comparison(compared)
