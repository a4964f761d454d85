"""The native half of simgap; use the package ``simgap``."""

import os
from collections.abc import Callable
from typing import final

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
_Path = str | os.PathLike[str]
_Frame = list[tuple[str, _Array]]

__all__ = [
    "Answer",
    "Compared",
    "Model",
    "Record",
    "SimgapError",
    "__version__",
    "compare",
    "diagnose",
    "effects",
    "fleet_answer",
    "fleet_places",
    "fleet_put",
    "fleet_report",
    "fleet_units",
    "modes",
    "read",
    "simulate",
]

__version__: str

class SimgapError(ValueError):
    """What is wrong with an input: one line that says where, what was found and what is needed.

    It is the line that the command ``simgap`` prints for the same input.
    """

@final
class Model:
    @staticmethod
    def from_file(path: _Path) -> Model: ...
    @staticmethod
    def from_text(text: str, label: _Path) -> Model: ...
    @property
    def name(self) -> str: ...
    @property
    def is_simulator(self) -> bool: ...
    @property
    def channels(self) -> tuple[list[str], list[str]]: ...
    def to_toml(self) -> str: ...
    def picture(self) -> str: ...
    def responses_svg(self) -> str: ...

@final
class Record:
    @staticmethod
    def from_arrays(
        name: str,
        time: tuple[str, str, _Array],
        channels: list[tuple[str, str, _Array]],
    ) -> Record: ...
    @property
    def name(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def units(self) -> list[tuple[str, str]]: ...
    @property
    def sample_rate_hz(self) -> float: ...
    def __len__(self) -> int: ...
    def time(self) -> _Array: ...
    def values(self, name: str) -> _Array: ...

@final
class Answer:
    def json(self) -> str: ...
    def corrected(self) -> str: ...
    def page(self) -> str: ...
    def summary(self) -> str: ...
    def judged(self) -> list[str]: ...
    def predictions(self, index: int) -> _Frame: ...
    def save(self, out: _Path, sets: bool) -> None: ...

@final
class Compared:
    def json(self) -> str: ...
    def page(self) -> str: ...
    def traces(self) -> _Frame: ...
    def save(self, out: _Path) -> None: ...

def read(
    path: _Path,
    model: Model | None,
    inputs_only: bool,
    map: list[str],
    columns: str | None,
    mend: bool,
) -> Record: ...
def diagnose(
    model: Model,
    train: list[Record],
    check: list[Record],
    withhold: list[str],
    budget_s: float | None,
    map: list[str],
    columns: str | None,
    mend: bool,
    on_step: Callable[[str], object] | None,
    simulator: Callable[..., list[_Array]] | None,
) -> Answer: ...
def compare(
    measured: Record,
    simulated: Record,
    pairs: list[tuple[str, str]],
    inputs: list[str],
    align_start: bool,
    on_step: Callable[[str], object] | None,
) -> Compared: ...
def simulate(
    model: Model,
    record: Record,
    from_rest: bool,
    simulator: Callable[..., list[_Array]] | None = None,
) -> tuple[_Frame, list[str]]: ...
def modes(model: Model) -> str: ...
def effects(kind: str | None, model: Model | None) -> str: ...
def fleet_places(plan: _Path) -> list[str]: ...
def fleet_units(plan: _Path, listed: list[str], out: _Path) -> list[str]: ...
def fleet_answer(unit: str) -> tuple[bytes | None, str | None]: ...
def fleet_put(out: _Path, unit: str, bytes: bytes) -> None: ...
def fleet_report(plan: _Path, listed: list[str], out: _Path) -> str: ...
