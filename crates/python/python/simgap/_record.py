"""Records: from arrays, tables or files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _simgap
from ._frame import frame
from ._model import Model

if TYPE_CHECKING:
    import pandas

#: Names of a time column.
_TIME = ("t", "time")


class Record:
    """A measured or simulated record: channels over one even time base.

    ::

        units = {"drive": "N", "q": "mm"}
        run = simgap.Record({"t": t, "drive": u, "q": q}, units=units, name="run1")

    ``data`` is a mapping of names to arrays, a pandas or polars data frame, a table of Arrow,
    or a structured array of NumPy. Each column has shape ``(samples,)``. The time column is
    called ``t`` or ``time`` (or as ``time`` says) and is in seconds if ``units`` says nothing
    else; a pandas index of times will do. Units stand in ``units`` or in the names, as in ``"q
    [mm]"``.

    A record holds at least 8 samples, all finite, over stamps that rise evenly. It keeps a copy
    of the values: columns of ``float64`` are copied once, others are converted first.
    """

    def __init__(
        self,
        data: Any,
        units: Mapping[str, str] | None = None,
        *,
        name: str = "record",
        time: str | None = None,
    ) -> None:
        columns = [(*_split(label), values) for label, values in _columns(name, data)]
        columns = _with_units(name, columns, dict(units or {}))
        wanted = _TIME if time is None else (_split(time)[0],)
        found = [index for index, column in enumerate(columns) if column[0] in wanted]
        if found:
            stamps = columns.pop(found[0])
        else:
            stamps = _index(name, data, wanted, [column[0] for column in columns])
        stamps = (stamps[0], stamps[1] or "s", _stamps(name, stamps[0], stamps[2]))
        channels = [(label, unit, _array(name, label, values)) for label, unit, values in columns]
        self._native = _simgap.Record.from_arrays(name, stamps, channels)

    @classmethod
    def _of(cls, native: _simgap.Record) -> Record:
        record = cls.__new__(cls)
        record._native = native
        return record

    @property
    def name(self) -> str:
        """File name, or the name it was given."""
        return self._native.name

    @property
    def units(self) -> dict[str, str]:
        """Unit of each channel."""
        return dict(self._native.units)

    @property
    def notes(self) -> list[str]:
        """What was guessed or changed to read it, one sentence each."""
        return self._native.notes

    @property
    def sample_rate_hz(self) -> float:
        """Samples per second."""
        return self._native.sample_rate_hz

    @property
    def t(self) -> npt.NDArray[np.float64]:
        """Time stamps, s, shape ``(samples,)``; a copy."""
        return self._native.time()

    def __len__(self) -> int:
        return len(self._native)

    def __getitem__(self, channel: str) -> npt.NDArray[np.float64]:
        """Values of a channel in its unit, shape ``(samples,)``; a copy."""
        return self._native.values(channel)

    def to_pandas(self) -> pandas.DataFrame:
        """``t [s]``, then name and unit of each channel, as a CSV file has them."""
        columns = [("t [s]", self.t)]
        columns += [(f"{name} [{unit}]", self[name]) for name, unit in self.units.items()]
        return frame(columns)

    def __repr__(self) -> str:
        channels = ", ".join(f"{name} [{unit}]" for name, unit in self.units.items())
        return f"<simgap.Record {self.name!r}: {len(self)} samples of {channels}>"


def read(
    path: str | os.PathLike[str],
    model: Model | None = None,
    *,
    map: Iterable[str] = (),
    columns: str | None = None,
    mend: bool = False,
) -> Record:
    """Reads a record from a file of any format of the command: CSV, tables of loggers, Parquet,
    Arrow, MATLAB, TDMS, MDF, UFF, xlsx.

    With a model only what it names is read, as the command does; without one, every column that
    holds numbers. ``map`` names columns that are called differently, with a unit where the file
    has none: ``["q=Pos_Carriage [mm]"]``. ``columns`` names those of a table without a header:
    ``"t [s],drive [N],q [mm]"``. ``mend`` fills missing samples and resamples an uneven time
    base also in CSV files of the contract's own form.
    """
    native = None if model is None else model._compiled()
    return Record._of(_simgap.read(Path(path), native, False, list(map), columns, mend))


def native_records(
    records: Any,
    model: Model | None,
    inputs_only: bool = False,
    map: Iterable[str] = (),
    columns: str | None = None,
    mend: bool = False,
) -> list[_simgap.Record]:
    """Records, or paths of records, as the native half takes them; one alone is a list of one."""
    if isinstance(records, (Record, str, os.PathLike)):
        records = [records]
    native = None if model is None else model._compiled()
    found = []
    for one in records:
        if isinstance(one, Record):
            found.append(one._native)
        elif isinstance(one, (str, os.PathLike)):
            path = Path(one)
            found.append(_simgap.read(path, native, inputs_only, list(map), columns, mend))
        else:
            raise _simgap.SimgapError(
                f"a record is of {type(one).__name__}, needed is a simgap.Record or a path"
            )
    return found


def _columns(name: str, data: Any) -> list[tuple[str, Any]]:
    """Labels and columns of whatever holds a table."""
    if isinstance(data, Mapping):
        return [(str(label), values) for label, values in data.items()]
    if hasattr(data, "iloc") and hasattr(data, "columns"):  # pandas
        return [(str(label), data.iloc[:, k]) for k, label in enumerate(data.columns)]
    if hasattr(data, "get_columns"):  # polars
        return [(column.name, column) for column in data.get_columns()]
    if hasattr(data, "collect_schema"):  # polars, lazy
        return _columns(name, data.collect())
    if hasattr(data, "column_names") and hasattr(data, "column"):  # Arrow
        return [(label, data.column(k)) for k, label in enumerate(data.column_names)]
    if isinstance(data, np.ndarray) and data.dtype.names:
        return [(label, data[label]) for label in data.dtype.names]
    if hasattr(data, "__arrow_c_stream__"):
        import pyarrow  # type: ignore[import-untyped]

        return _columns(name, pyarrow.table(data))
    raise _simgap.SimgapError(
        f"{name}: the data are of {type(data).__name__}, needed is a mapping of names to arrays, "
        "a data frame, a table of Arrow or a structured array"
    )


def _split(label: str) -> tuple[str, str]:
    """Name and unit of ``"q [mm]"``; no unit where there are no brackets."""
    label = label.strip()
    if label.endswith("]") and "[" in label:
        before, _, unit = label[:-1].rpartition("[")
        return before.strip(), unit.strip()
    return label, ""


def _with_units(
    name: str, columns: list[tuple[str, str, Any]], units: dict[str, str]
) -> list[tuple[str, str, Any]]:
    known = [column[0] for column in columns]
    for label in units:
        if label not in known and label not in _TIME:
            raise _simgap.SimgapError(
                f"{name}: a unit is given for column '{label}', but there is {', '.join(known)}"
            )
    return [(label, units.get(label, unit), values) for label, unit, values in columns]


def _index(name: str, data: Any, wanted: tuple[str, ...], known: list[str]) -> tuple[str, str, Any]:
    index = getattr(data, "index", None)
    if index is not None and hasattr(data, "iloc"):
        label, unit = _split(str(index.name or ""))
        if label in wanted or getattr(index, "dtype", np.dtype("f8")).kind in "mM":
            return label or wanted[0], unit, index
    raise _simgap.SimgapError(
        f"{name}: no time column '{' or '.join(wanted)}' among {', '.join(known)}, needed is one "
        "of that name, or time=COLUMN"
    )


def _stamps(name: str, label: str, values: Any) -> np.ndarray:
    """Stamps as numbers; dates become seconds since the first."""
    plain = _plain(values)
    if isinstance(plain, np.ndarray) and plain.dtype.kind == "M" and len(plain):
        plain = plain - plain[0]
    if isinstance(plain, np.ndarray) and plain.dtype.kind == "m":
        return plain / np.timedelta64(1, "s")
    return _array(name, label, plain)


def _plain(values: Any) -> Any:
    """An array of NumPy that shares the memory of the column where it can."""
    if isinstance(values, np.ndarray):
        return values
    if hasattr(values, "num_chunks"):  # Arrow, in chunks
        values = values.chunk(0) if values.num_chunks == 1 else values.combine_chunks()
    if hasattr(values, "to_numpy"):
        if hasattr(values, "null_count"):  # Arrow and polars
            arrow = hasattr(values, "buffers")
            return values.to_numpy(zero_copy_only=False) if arrow else values.to_numpy()
        if getattr(values.dtype, "na_value", None) is not None and values.dtype.kind in "iufb":
            return values.to_numpy(dtype="float64", na_value=np.nan)
        return values.to_numpy()
    return values


def _array(name: str, label: str, values: Any) -> np.ndarray:
    """An array of float64, the column's own memory where it is one."""
    plain = _plain(values)
    try:
        array = np.asarray(plain, dtype=np.float64)
    except (TypeError, ValueError):
        found = getattr(plain, "dtype", type(plain).__name__)
        raise _simgap.SimgapError(
            f"{name}: column '{label}' holds {found}, needed are numbers"
        ) from None
    # Fields of packed structures lie where no number can be read in place.
    return array if array.flags.aligned else array.copy()
