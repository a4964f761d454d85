"""Many machines: the same plan as the command ``simgap fleet``, on an engine of your own.

::

    import simgap.fleet
    from dask.distributed import Client

    fleet = simgap.fleet.run("plan.toml", out="result", client=Client("tcp://scheduler:8786"))
    for finding in fleet.findings:
        print(finding.scope, finding.text)
    fleet.to_pandas()

Each machine and date is a unit of work: text goes to a worker and the bytes of one file of the
table come back. Any engine can do that; nothing is scheduled here. The table and the report are,
byte for byte, those of the command.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _simgap
from ._frame import page_in_notebook
from ._progress import Steps

if TYPE_CHECKING:
    import pandas

__all__ = ["Finding", "Fleet", "run"]

#: Units that an engine holds at the same time; the others wait here, so that memory does not grow
#: with the fleet.
_IN_FLIGHT = 256


@dataclass(frozen=True)
class Finding:
    """One thing that a fleet says."""

    #: ``"common"`` (the model is wrong), ``"machine"``, ``"condition"`` (a day, a rig, a load; no
    #: machine is to blame) or ``"undecided"`` (they differ together; nobody is to blame).
    scope: str
    #: Kind of the catalogue.
    kind: str
    #: Where it acts, in words.
    place: str
    #: The parameter, where values tell.
    parameter: str | None
    #: Machines, dates and conditions that it belongs to, by factor.
    levels: Mapping[str, list[str]]
    #: First and last value, where it goes over time.
    course: tuple[float, float] | None
    #: Dates of steps.
    steps: list[str]
    #: One or two sentences.
    text: str


class Fleet:
    """What a fleet says. Made by :func:`run`; in a notebook it shows its report."""

    def __init__(self, out: Path, text: str) -> None:
        self.out = out
        self._values: dict[str, Any] = json.loads(text)

    @property
    def findings(self) -> list[Finding]:
        """What is common to all machines, one machine's own, a day's, or cannot be told."""
        found = []
        for one in self._values["findings"]:
            course = one["course"]
            found.append(Finding(**{**one, "course": None if course is None else tuple(course)}))
        return found

    @property
    def answered(self) -> int:
        """Units that the table has an answer for."""
        return self._values["answered"]

    @property
    def failed(self) -> int:
        """Of these, diagnoses that failed; their rows hold the reason."""
        return self._values["failed"]

    @property
    def notes(self) -> list[str]:
        """What the plan says that no record answers to."""
        return list(self._values["notes"])

    def to_dict(self) -> dict[str, Any]:
        """Everything, as ``fleet.json`` holds it."""
        return json.loads(json.dumps(self._values))

    def to_html(self) -> str:
        """The report: one self-contained page."""
        return (self.out / "fleet.html").read_text(encoding="utf-8")

    def to_pandas(self) -> pandas.DataFrame:
        """The table: one row for each diagnosis, effect and parameter. Needs pyarrow."""
        import pandas

        return pandas.read_parquet(self.out / "table")

    def __repr__(self) -> str:
        return f"<simgap.fleet.Fleet {self._values['name']!r}: {self.answered} diagnoses, {len(self.findings)} findings>"

    def _repr_html_(self) -> str:
        return page_in_notebook(self.to_html())


def run(
    plan: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    client: Any = None,
    progress: bool | Callable[[str], object] = True,
    storage_options: Mapping[str, Any] | None = None,
) -> Fleet:
    """Diagnoses a fleet by a plan and writes table, report and models into the folder ``out``.

    ``client`` is what does the work: a ``dask.distributed.Client``, the module ``ray`` (after
    ``ray.init``), or any executor with the interface of ``concurrent.futures``. Without one,
    processes on this machine do, as many as there are cores.

    What the table in ``out`` answers already is not done again, so that the same call goes on where
    a killed one ended. Answers are put in the table as they come. A diagnosis that fails is a row
    with its reason.

    Records and models may lie at addresses of fsspec (``s3://bucket/...`` with the package of that
    store); ``storage_options`` go to it. Other paths must be the same for the workers as here.
    """
    path, folder = Path(plan).resolve(), Path(out).resolve()
    options = dict(storage_options or {})
    listed = _listed(_simgap.fleet_places(path), options)
    units = _simgap.fleet_units(path, list(listed), folder)
    texts = [_addressed(unit, listed) for unit in units]
    with Steps(progress) as steps:
        tell = steps.call
        try:
            for count, (index, found) in enumerate(_answers(client, texts, options), start=1):
                if found[0] is not None:
                    _simgap.fleet_put(folder, units[index], found[0])
                if tell is not None:
                    tell(f"{count} of {len(units)} diagnoses")
        except Exception as error:
            if type(error).__name__ in {"BrokenProcessPool", "KilledWorker", "WorkerCrashedError"}:
                raise _simgap.SimgapError(
                    f"a worker died ({error}); the same call goes on where this one ended"
                ) from error
            raise
    return Fleet(folder, _simgap.fleet_report(path, list(listed), folder))


def work(unit: str, options: dict[str, Any]) -> tuple[bytes | None, str | None]:
    """One unit of work, wherever it is done: the bytes of its file of the table, ``None`` where the
    table has it already, and why the diagnosis failed, if it did.
    """
    asked = json.loads(unit)
    names = [asked["model"], *asked["train"], *asked["check"]]
    if not any("://" in name for name in names):
        return _simgap.fleet_answer(unit)
    with tempfile.TemporaryDirectory(prefix="simgap-") as folder:

        def fetched(index: int, name: str) -> str:
            if "://" not in name:
                return name
            # A folder of its own for each, so that names of files stay as they are.
            place = Path(folder) / str(index) / name.rsplit("/", 1)[-1]
            place.parent.mkdir()
            _fetch(name, place, options)
            return str(place)

        local = [fetched(index, name) for index, name in enumerate(names)]
        trained = len(asked["train"])
        asked["model"], asked["train"] = local[0], local[1 : 1 + trained]
        asked["check"] = local[1 + trained :]
        return _simgap.fleet_answer(json.dumps(asked))


def _fetch(address: str, place: Path, options: dict[str, Any]) -> None:
    """Copies a file from a store; where that is not possible there is none, and the diagnosis says so."""
    import fsspec  # type: ignore[import-untyped]

    try:
        with fsspec.open(address, "rb", **options) as source, place.open("wb") as target:
            shutil.copyfileobj(source, target)
    except FileNotFoundError:
        place.unlink(missing_ok=True)


def _listed(globs: list[str], options: dict[str, Any]) -> dict[str, str]:
    """Addresses of the files at the patterns: as the plan would write them, to what opens them."""
    found: dict[str, str] = {}
    for glob in globs:
        import fsspec

        store, path = fsspec.core.url_to_fs(glob, **options)
        scheme = glob.split("://", 1)[0]
        for one in sorted(store.glob(path)):
            found[f"{scheme}://{str(one).lstrip('/')}"] = store.unstrip_protocol(one)
    return found


def _addressed(unit: str, listed: Mapping[str, str]) -> str:
    if not listed:
        return unit
    asked = json.loads(unit)
    for key in ("train", "check"):
        asked[key] = [listed.get(name, name) for name in asked[key]]
    return json.dumps(asked)


_Answer = tuple[int, tuple[bytes | None, str | None]]


def _answers(client: Any, units: list[str], options: dict[str, Any]) -> Iterator[_Answer]:
    """Places of units with their answers, as they come."""
    if client is None:
        import concurrent.futures
        import multiprocessing

        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(mp_context=context) as executor:
            yield from _by_executor(executor, units, options)
    elif getattr(client, "__name__", "") == "ray":
        yield from _by_ray(client, units, options)
    elif type(client).__module__.split(".")[0] == "distributed":
        yield from _by_dask(client, units, options)
    elif hasattr(client, "submit"):
        yield from _by_executor(client, units, options)
    else:
        raise _simgap.SimgapError(
            f"client is of {type(client).__name__}, needed is a dask.distributed.Client, the module "
            "ray, or an executor of concurrent.futures"
        )


def _by_executor(executor: Any, units: list[str], options: dict[str, Any]) -> Iterator[_Answer]:
    from concurrent.futures import FIRST_COMPLETED, wait

    waiting = iter(enumerate(units))
    under_way: dict[Any, int] = {}
    try:
        while True:
            while len(under_way) < _IN_FLIGHT and (one := next(waiting, None)) is not None:
                under_way[executor.submit(work, one[1], options)] = one[0]
            if not under_way:
                return
            for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                yield under_way.pop(future), future.result()
    finally:
        for future in under_way:
            future.cancel()


def _by_dask(client: Any, units: list[str], options: dict[str, Any]) -> Iterator[_Answer]:
    from distributed import as_completed

    waiting = iter(enumerate(units))
    places: dict[str, int] = {}
    completed = as_completed([], with_results=True)

    def submit() -> None:
        one = next(waiting, None)
        if one is not None:
            # Every unit is work of its own, also where an earlier run asked for the same.
            future = client.submit(work, one[1], options, pure=False)
            places[future.key] = one[0]
            completed.add(future)

    for _ in range(_IN_FLIGHT):
        submit()
    for future, found in completed:
        yield places.pop(future.key), found
        future.release()
        submit()


def _by_ray(ray: Any, units: list[str], options: dict[str, Any]) -> Iterator[_Answer]:
    # A worker that dies is replaced and its unit done again.
    remote = ray.remote(max_retries=3)(work)
    waiting = iter(enumerate(units))
    under_way: dict[Any, int] = {}
    while True:
        while len(under_way) < _IN_FLIGHT and (one := next(waiting, None)) is not None:
            under_way[remote.remote(one[1], options)] = one[0]
        if not under_way:
            return
        done, _ = ray.wait(list(under_way), num_returns=1)
        for reference in done:
            yield under_way.pop(reference), ray.get(reference)
