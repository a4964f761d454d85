"""What records and models are made of."""

from pathlib import Path

import numpy as np
import pandas
import polars
import pyarrow
import pytest
import simgap
from conftest import axis_records

UNITS = {"drive": "N", "q": "mm"}


@pytest.fixture(scope="module")
def columns():
    return {name: values[:500] for name, values in axis_records()["run1"].items()}


def test_every_kind_of_table_gives_the_same_record(columns):
    tables = {
        "mapping": columns,
        "lists": {name: values.tolist() for name, values in columns.items()},
        "pandas": pandas.DataFrame(columns),
        "pandas, nullable": pandas.DataFrame(columns).convert_dtypes(
            dtype_backend="numpy_nullable"
        ),
        "pandas, index": pandas.DataFrame(columns).set_index("t"),
        "polars": polars.DataFrame(columns),
        "polars, lazy": polars.DataFrame(columns).lazy(),
        "arrow": pyarrow.table(columns),
        "arrow, chunks": pyarrow.concat_tables(
            [
                pyarrow.table({n: v[:200] for n, v in columns.items()}),
                pyarrow.table({n: v[200:] for n, v in columns.items()}),
            ]
        ),
        "arrow, batch": pyarrow.RecordBatch.from_pydict(columns),
        "structured": np.rec.fromarrays(list(columns.values()), names=list(columns)).view(
            np.ndarray
        ),
        "strided": {name: np.repeat(values, 2)[::2] for name, values in columns.items()},
    }
    for kind, table in tables.items():
        record = simgap.Record(table, units=UNITS)
        assert len(record) == 500 and record.units == UNITS, kind
        for name, values in columns.items():
            found = record.t if name == "t" else record[name]
            assert found.dtype == np.float64 and np.array_equal(found, values), (kind, name)


def test_units_and_times(columns):
    named = {"t [ms]": 1e3 * columns["t"], "drive [N]": columns["drive"], "q [mm]": columns["q"]}
    record = simgap.Record(named)
    assert record.units == UNITS and abs(record.t[-1] - columns["t"][-1]) < 1e-12
    assert abs(record.sample_rate_hz - 1000.0) < 1e-6
    dates = pandas.Timestamp("2026-03-01") + pandas.to_timedelta(columns["t"], unit="s")
    record = simgap.Record(pandas.DataFrame({"q": columns["q"]}, index=dates), units={"q": "mm"})
    assert record.t[0] == 0.0 and abs(record.t[-1] - columns["t"][-1]) < 1e-9
    record = simgap.Record({"clock": columns["t"], "q": columns["q"]}, time="clock")
    assert list(record.units) == ["q"]
    assert list(record.to_pandas().columns) == ["t [s]", "q []"]
    assert "500 samples" in repr(record)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (
            {"t": None},
            "run: no time column 't or time' among drive, q, needed is one of that name, or time=COLUMN",
        ),
        ({"q": np.full(500, np.nan)}, "run: row 0: column 'q' "),
        ({"q": ["a"] * 500}, "run: column 'q' holds list, needed are numbers"),
        (
            {"q": np.zeros((500, 2))},
            "run: column 'q' is an array of shape [500, 2], needed is an array of one dimension of float64",
        ),
        ({"q": np.zeros(499)}, "run: column 'q' has 499 "),
        ({"t": np.zeros(500)}, "run: row 1: "),
    ],
)
def test_what_is_wrong_with_columns_is_told_in_one_line(columns, change, line):
    wrong = {name: values for name, values in {**columns, **change}.items() if values is not None}
    with pytest.raises(simgap.SimgapError) as raised:
        simgap.Record(wrong, units=UNITS, name="run")
    assert str(raised.value).startswith(line) and "\n" not in str(raised.value)
    assert isinstance(raised.value, ValueError)


def test_a_model_is_built_part_by_part(axis_folder):
    built = (
        simgap.Model("axis")
        .mass("carriage", 95.1)
        .spring("bellows", ("carriage", "ground"), stiffness=2000.0)
        .damper("guide", ("carriage", "ground"), damping=203.5)
        .input("drive", at="carriage")
        .output("q", at="carriage")
    )
    assert built == simgap.Model.from_file(axis_folder / "axis.toml")
    assert (built.name, built.inputs, built.outputs) == ("axis", ["drive"], ["q"])
    assert simgap.Model.from_toml(built.to_toml()) == built
    full = (
        built.load("carriage", -3.0, uncertainty=0.1)
        .pendulum("carriage", 0.5)
        .effect("coulomb_friction", between=("carriage", "ground"), friction_force_n=40.0)
    )
    text = full.to_toml()
    assert "friction_force_n = 40.0" in text and "uncertainty = 0.1" in text
    assert built.to_toml() != text
    odd = simgap.Model('a "quoted" \\ name\x7f').mass("m", 1.0).output("y", at="m")
    assert simgap.Model.from_toml(odd.to_toml()) == odd
    picture = built._repr_html_()
    assert picture.count("<svg") == 2 and "bellows" in picture


def test_a_mold_on_cylinders_is_built_part_by_part():
    """Every table of ``fixtures/mold-on-cylinders`` has its method."""
    built = (
        simgap.Model("mold on two cylinders")
        .body("mold", mass=33000.0, inertia=19000.0)
        .point("left", "mold", -1.5)
        .point("right", "mold", 1.5)
        .load("mold", -323730.0)
    )
    steel = {"youngs_modulus": 2.1e11, "density": 7850.0, "damping_ratio": 0.01}
    for side in ("left", "right"):
        ends = (f"mold.{side}", "ground")
        built = (
            built.beam(f"leaves {side}", ends, length=1.06, width=0.4, thickness=0.01, **steel)
            .damper(f"guide {side}", ends, damping=150000.0)
            .cylinder(
                side,
                ends,
                areas=(0.02, 0.012),
                dead_volumes=(5e-4, 5e-4),
                stroke=0.08,
                bulk_modulus=1.4e9,
                leakage=1e-11,
                pressures=(13.0e6, 8.17792e6),
            )
            .valve(
                f"servo {side}",
                side,
                from_block=f"controller {side}",
                rated_flow=3.3e-3,
                rated_drop=3.5e6,
                natural_freq=60.0,
                damping_ratio=0.8,
                supply=21e6,
            )
        )
    built = built.block("reference", [1.0], [1.0])
    for side in ("left", "right"):
        signals = {"plus": ["reference"], "minus": [f"mold.{side}"]}
        built = built.block(f"controller {side}", [60.0], [1.0], **signals)
    built = built.input("r", at="reference", kind="set_point")
    for side in ("left", "right"):
        built = built.output(f"y_{side}", at=f"mold.{side}")
    for side in ("left", "right"):
        for chamber in ("p1", "p2"):
            channel, node = f"{chamber}_{side}", f"{side}.{chamber}"
            built = built.output(channel, at=node, kind="pressure")
    path = Path(__file__).parents[3] / "fixtures" / "mold-on-cylinders" / "model.toml"
    assert built == simgap.Model.from_file(path)
    picture = built._repr_html_()
    assert "servo left" in picture and "controller right" in picture
    fewer = simgap.Model("beam").mass("m", 1.0).output("y", at="m")
    fewer = fewer.beam(
        "leaf",
        ("m", "ground"),
        length=1.0,
        width=0.1,
        thickness=0.01,
        youngs_modulus=2.1e11,
        density=7850.0,
        elements=6,
        modes=2,
    )
    assert "elements = 6" in fewer.to_toml() and "modes = 2" in fewer.to_toml()


def test_what_is_wrong_with_a_model_is_told_in_one_line():
    with pytest.raises(simgap.SimgapError, match="^model: "):
        simgap.Model().mass("m", -1.0).output("y", at="m").to_toml()
    with pytest.raises(simgap.SimgapError, match="^nowhere.toml: no such file"):
        simgap.Model.from_file("nowhere.toml")
    with pytest.raises(simgap.SimgapError, match="unknown kind"):
        simgap.effects("coulomb")
