"""The main question."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence

from . import _simgap
from ._diagnosis import Diagnosis
from ._model import Model
from ._progress import Steps
from ._record import Record, native_records
from ._simulator import Simulator, SimulatorFunction, asked

#: A record, or the path of one.
RecordLike = Record | str | os.PathLike


def diagnose(
    model: Model | str | os.PathLike[str] | None = None,
    train: RecordLike | Sequence[RecordLike] = (),
    check: RecordLike | Sequence[RecordLike] = (),
    *,
    simulator: Simulator | SimulatorFunction | None = None,
    withhold: Iterable[str] = (),
    budget_s: float | None = None,
    progress: bool | Callable[[str], object] = True,
    map: Iterable[str] = (),
    columns: str | None = None,
    mend: bool = False,
) -> Diagnosis:
    """Finds where the gap between a model and records lies, which effect causes it, and how far
    it closes.

    ``model`` is a model or the path of a model file. ``train`` are the records to learn from,
    ``check`` those to judge by: nothing is fitted to them but their initial states. Without
    ``check`` the last third of each training record is held back. Records are
    :class:`simgap.Record` or paths; paths are read as the command reads them, with ``map``,
    ``columns`` and ``mend`` as in :func:`simgap.read`, and the same input gives the same bytes
    as the command. Records that are judged by have different names.

    ``simulator`` stands for the plant in the place of a model: a :class:`simgap.Simulator`, or the
    function of one beside a ``model`` of its signals, parameters and ports. Then ``check`` is
    needed, and an exception of the function comes as the cause of a :class:`SimgapError`.

    ``withhold`` takes kinds out of the catalogue. ``budget_s`` ends the search after so many
    seconds with the best answer so far. ``progress`` shows the steps in a terminal or a
    notebook; a function is called with the name of each step.

    The interpreter is free for other threads meanwhile, and Ctrl-C ends the work within a
    second. The work takes all cores; the environment variable ``RAYON_NUM_THREADS`` sets
    another number, and the result does not depend on it.
    """
    if model is None:
        if not isinstance(simulator, Simulator):
            raise _simgap.SimgapError("there is no model, needed is one or a simgap.Simulator")
        model = simulator.model
    if not isinstance(model, Model):
        model = Model.from_file(model)
    mapped = list(map)
    trained = native_records(train, model, False, mapped, columns, mend)
    checked = native_records(check, model, False, mapped, columns, mend)
    withheld = [withhold] if isinstance(withhold, str) else list(withhold)
    with Steps(progress) as steps:
        answer = _simgap.diagnose(
            model._compiled(),
            trained,
            checked,
            withheld,
            budget_s,
            mapped,
            columns,
            mend,
            steps.call,
            asked(simulator),
        )
    return Diagnosis(answer)
