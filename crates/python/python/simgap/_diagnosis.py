"""The answer of a diagnosis."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _simgap
from ._frame import frame, page_in_notebook
from ._model import Model
from ._parts import Candidate, Channel, ChannelGap, Effect, Gap, Other, Unexplained, Where, made

if TYPE_CHECKING:
    import pandas


class Predictions(Mapping[str, "pandas.DataFrame"]):
    """For each record that the answer is judged by, under its name without an extension: a data
    frame with ``t [s]`` and, for each output, what was measured, what the model as given
    predicts and what the corrected model predicts, in the units of the model; one row for each
    sample.
    """

    def __init__(self, native: _simgap.Answer) -> None:
        self._native = native
        self._index = {name: index for index, name in enumerate(native.judged())}

    def __getitem__(self, record: str) -> pandas.DataFrame:
        if record not in self._index:
            raise KeyError(f"{record}: the records are {', '.join(self._index)}")
        return frame(self._native.predictions(self._index[record]))

    def __iter__(self) -> Iterator[str]:
        return iter(self._index)

    def __len__(self) -> int:
        return len(self._index)

    def __repr__(self) -> str:
        return f"<predictions of {', '.join(self)}>"


class Diagnosis:
    """Where the gap lies, which effect causes it, how far it closes. Made by
    :func:`simgap.diagnose`.

    ``print`` it to see what the command prints; in a notebook it shows its report.
    """

    def __init__(self, native: _simgap.Answer) -> None:
        self._native = native

    @cached_property
    def _values(self) -> dict[str, Any]:
        return json.loads(self.to_json())

    @property
    def status(self) -> str:
        """``"none"`` (the gap is noise), ``"parameters"`` (re-estimated parameters close it),
        ``"effect"`` (effects are named) or ``"unknown"`` (there is structure that no effect of
        the catalogue explains).
        """
        return self._values["verdict"]["status"]

    @property
    def complete(self) -> bool:
        """What is left of the check records is no more than noise and the accuracy of the
        simulation.
        """
        return self._values["verdict"]["complete"]

    @property
    def refuted(self) -> bool:
        """The check records contradict what the training records say."""
        return self._values["verdict"]["refuted"]

    @property
    def stopped_early(self) -> bool:
        """The search ended before it was done, by ``budget_s`` or after so much work."""
        return self._values["stopped_early"]

    @cached_property
    def effects(self) -> list[Effect]:
        """The named effects; empty for the status ``none`` and ``unknown``."""
        return [Effect.of(one) for one in self._values["verdict"]["effects"]]

    @cached_property
    def leading(self) -> list[Effect]:
        """For the status ``unknown``: the best set of the catalogue all the same."""
        return [Effect.of(one) for one in self._values["verdict"]["leading"]]

    @cached_property
    def gap(self) -> Gap:
        """How large the gap is on the check records, before and after."""
        gap = self._values["gap"]
        channels = [made(ChannelGap, one) for one in gap["channels"]]
        return made(Gap, {**gap, "channels": channels})

    @cached_property
    def where(self) -> Where:
        """Where the gap lies: over channels, places, frequency, time, states of motion, records."""
        return Where.of(self._values["where"])

    @cached_property
    def unexplained(self) -> Unexplained:
        """What the answer leaves of the gap."""
        found = self._values["verdict"]["unexplained"]
        channels = [made(Channel, one) for one in found["channels"]]
        return made(Unexplained, {**found, "channels": channels})

    @cached_property
    def other(self) -> Other:
        """How likely the main cause is a law that the catalogue lacks."""
        return made(Other, self._values["verdict"]["other"])

    @cached_property
    def candidates(self) -> list[Candidate]:
        """The single effects that fit best, at most twelve."""
        return [made(Candidate, one) for one in self._values["candidates"]]

    @property
    def next_experiment(self) -> str | None:
        """The experiment that would tell the rivals apart, if there are any."""
        return self._values["next_experiment"]

    @property
    def notes(self) -> list[str]:
        """What a reader must know, one sentence each."""
        return self._values["notes"]

    @cached_property
    def corrected(self) -> Model:
        """The model with re-estimated parameters and the named effects."""
        return Model.from_toml(self._native.corrected())

    @cached_property
    def predictions(self) -> Predictions:
        """Measured and predicted outputs of each check record, as data frames:
        ``d.predictions["run3"]``.
        """
        return Predictions(self._native)

    def to_dict(self) -> dict[str, Any]:
        """Everything, as ``diagnosis.json`` holds it."""
        return json.loads(self.to_json())

    def to_json(self) -> str:
        """The text of ``diagnosis.json``: the bytes that the command writes for the same input."""
        return self._native.json()

    def to_html(self) -> str:
        """The report: one self-contained page."""
        return self._native.page()

    def save(self, folder: str | os.PathLike[str], *, sets: bool = False) -> None:
        """Writes the folder that the command writes: report, data, corrected model,
        predictions, pictures. ``sets`` adds ``sets.json``: every set of effects that was
        fitted, with the terms that decide between them.
        """
        self._native.save(Path(folder), sets)

    def __str__(self) -> str:
        return self._native.summary()

    def __repr__(self) -> str:
        named = ", ".join(effect.kind for effect in self.effects) or "no effect"
        return f"<simgap.Diagnosis {self.status}: {named}; {self.gap.closed:.3g} of the gap closed>"

    def _repr_html_(self) -> str:
        """The report, in a frame."""
        return page_in_notebook(self.to_html())
