"""Fleets: the same table whoever does the work, and whatever interrupts it."""

import concurrent.futures
import json
import multiprocessing
import os
import signal
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import command_of

import simgap
import simgap.fleet

MODEL = """schema = "simgap-model/1"
name = "table"
[[mass]]
name = "table"
value = 2.0
[[spring]]
name = "leaf"
between = ["table", "ground"]
stiffness = 800.0
[[damper]]
name = "guide"
between = ["table", "ground"]
damping = 6.0
[[input]]
channel = "u"
kind = "force"
at = "table"
[[output]]
channel = "y"
kind = "displacement"
at = "table"
"""

# What this fleet may be short of is looked for; the rest of the catalogue would only take time.
KINDS = ["coulomb_friction", "sensor_bias", "stiffness_error", "mass_error", "damping_error"]


def fleet_folder(folder):
    """Three machines on two days, one of them with a softer spring; one record is damaged."""
    (folder / "table.toml").write_text(MODEL)
    withheld = [kind for kind in simgap.effects() if kind not in KINDS]
    for machine in range(3):
        for day in range(2):
            record = MODEL.replace("800.0", "640.0") if machine == 1 else MODEL
            rng = np.random.default_rng(10 * machine + day)
            t = 0.01 * np.arange(240)
            tones = zip([0.7, 1.7, 2.9, 4.3], rng.uniform(0, 2 * np.pi, 4))
            u = sum(4.0 * np.sin(2 * np.pi * f * t + p) for f, p in tones)
            run = simgap.Record({"t": t, "u": u}, units={"u": "N"})
            found = simgap.simulate(simgap.Model.from_toml(record), run, from_rest=True)
            y = found.iloc[:, 1].to_numpy() + 4e-5 * rng.standard_normal(len(t))
            at = folder / "records" / f"machine=m{machine}" / f"date=2026-03-0{day + 1}"
            at.mkdir(parents=True)
            rows = [f"{a!r},{b!r},{c!r}" for a, b, c in np.column_stack([t, u, y]).tolist()]
            (at / "run.csv").write_text("t [s],u [N],y [m]\n" + "\n".join(rows) + "\n")
    (folder / "records/machine=m2/date=2026-03-02/run.csv").write_text("t [s],u [N]\n0,1\n")
    plan = {
        "schema": "simgap-plan/1",
        "name": "tables",
        "records": ["records/machine={machine}/date={date}/{record}.csv"],
        "model": "table.toml",
        "withhold": withheld,
    }
    lines = [f"{key} = {json.dumps(value)}" for key, value in plan.items()]
    (folder / "plan.toml").write_text("\n".join(lines) + "\n")
    return folder


@pytest.fixture(scope="module")
def fleet(tmp_path_factory):
    return fleet_folder(tmp_path_factory.mktemp("fleet"))


@pytest.fixture(scope="module")
def by_command(fleet):
    out = fleet / "by-command"
    command_of("fleet", fleet / "plan.toml", "--out", out)
    return contents(out)


def contents(out):
    """Every file of a result, but for the list of files that the command keeps."""
    files = [path for path in sorted(Path(out).rglob("*")) if path.is_file()]
    return {str(path.relative_to(out)): path.read_bytes() for path in files}


def test_an_executor_gives_the_bytes_of_the_command(fleet, by_command, tmp_path):
    steps = []
    with concurrent.futures.ThreadPoolExecutor(2) as client:
        found = simgap.fleet.run(
            fleet / "plan.toml", tmp_path, client=client, progress=steps.append
        )
    assert contents(tmp_path) == by_command
    assert (found.answered, found.failed, len(steps), found.notes) == (6, 1, 6, [])
    table = found.to_pandas()
    soft = table[(table.role == "named") & (table.machine == "m1")]
    assert set(soft.kind) == {"stiffness_error"}
    assert abs(soft.value - 0.8).max() < 0.02
    reason = table[table.role == "failed"].reason
    assert len(reason) == 1 and reason.iloc[0].startswith("run.csv")
    assert found.to_html().startswith("<!DOCTYPE html>")


def test_processes_give_the_same_and_a_second_call_does_nothing_again(fleet, by_command, tmp_path):
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as client:
        simgap.fleet.run(fleet / "plan.toml", tmp_path, client=client, progress=False)
    assert contents(tmp_path) == by_command
    times = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.parquet")}
    # One answer is lost, and one damaged.
    lost, damaged = sorted(times)[:2]
    lost.unlink()
    damaged.write_bytes(damaged.read_bytes()[:100])
    with concurrent.futures.ThreadPoolExecutor(2) as client:
        simgap.fleet.run(fleet / "plan.toml", tmp_path, client=client, progress=False)
    assert contents(tmp_path) == by_command
    same = [path for path, time in times.items() if path.stat().st_mtime_ns == time]
    assert len(same) == 4


def test_a_worker_that_dies_loses_nothing(fleet, by_command, tmp_path):
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as client:

        def kill(step):
            if step.startswith("2 of"):
                for process in client._processes.values():
                    process.kill()

        with pytest.raises(simgap.SimgapError, match="a worker died"):
            simgap.fleet.run(fleet / "plan.toml", tmp_path, client=client, progress=kill)
    kept = len(list(tmp_path.rglob("*.parquet")))
    assert 2 <= kept < 6
    with concurrent.futures.ThreadPoolExecutor(2) as client:
        simgap.fleet.run(fleet / "plan.toml", tmp_path, client=client, progress=False)
    assert contents(tmp_path) == by_command


def test_dask_gives_the_same(fleet, by_command, tmp_path):
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0"}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        simgap.fleet.run(fleet / "plan.toml", tmp_path, client=client, progress=False)
    assert contents(tmp_path) == by_command


@pytest.fixture(scope="module")
def ray():
    """A Ray of two workers on this machine."""
    try:
        import ray
    except ImportError:
        line = "RAY IS NOT INSTALLED: that a plan on Ray gives the table of the command was NOT tested"
        warnings.warn(line, stacklevel=1)
        pytest.skip(line)
    ray.init(num_cpus=2, include_dashboard=False, object_store_memory=80 << 20, log_to_driver=False)
    yield ray
    ray.shutdown()


def test_ray_gives_the_same(ray, fleet, by_command, tmp_path):
    found = simgap.fleet.run(fleet / "plan.toml", tmp_path, client=ray, progress=False)
    assert contents(tmp_path) == by_command
    assert (found.answered, found.failed) == (6, 1)


def test_a_worker_of_ray_that_dies_loses_nothing(ray, fleet, by_command, tmp_path, monkeypatch):
    died = tmp_path / "died"

    def work(unit, options, done=simgap.fleet.work):
        # The first unit takes its worker along, once.
        try:
            died.touch(exist_ok=False)
        except FileExistsError:
            return done(unit, options)
        os.kill(os.getpid(), signal.SIGKILL)

    monkeypatch.setattr(simgap.fleet, "work", work)
    out = tmp_path / "out"
    simgap.fleet.run(fleet / "plan.toml", out, client=ray, progress=False)
    assert died.exists() and contents(out) == by_command


def test_records_in_a_store_give_the_same(fleet, by_command, tmp_path):
    fsspec = pytest.importorskip("fsspec")
    store = fsspec.filesystem("memory")
    store.put(str(fleet / "records"), "/bucket/records", recursive=True)
    text = (fleet / "plan.toml").read_text().replace("records/", "memory://bucket/records/")
    (tmp_path / "plan.toml").write_text(text)
    (tmp_path / "table.toml").write_text(MODEL)
    out = tmp_path / "out"
    # The store is that of this process.
    with concurrent.futures.ThreadPoolExecutor(2) as client:
        simgap.fleet.run(tmp_path / "plan.toml", out, client=client, progress=False)
    assert contents(out) == by_command


def test_what_is_no_client_is_refused(fleet, tmp_path):
    with pytest.raises(simgap.SimgapError, match="client is of str, needed is"):
        simgap.fleet.run(fleet / "plan.toml", tmp_path, client="dask", progress=False)
    with pytest.raises(simgap.SimgapError, match="no-plan.toml: cannot be read"):
        simgap.fleet.run(fleet / "no-plan.toml", tmp_path, progress=False)
