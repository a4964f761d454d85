"""Long work: errors, other threads, Ctrl-C, budgets, progress."""

import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import simgap
from conftest import DEMO, command_of

TRAIN = [DEMO / "train-1.csv", DEMO / "train-2.csv"]
#: Seconds after Ctrl-C in which the work must have ended.
LATEST_S = 1.0


def test_errors_are_the_line_that_the_command_prints(tmp_path):
    questions = [
        (DEMO / "model.toml", TRAIN, [DEMO / "train-1.csv"], []),
        (DEMO / "model.toml", [tmp_path / "none.csv"], [], []),
        (DEMO / "model.toml", TRAIN, [DEMO / "check.csv"], ["coulomb"]),
        (DEMO / "train-1.csv", TRAIN, [], []),
    ]
    for model, train, check, withhold in questions:
        words = [word for path in train for word in ("--train", path)]
        words += [word for path in check for word in ("--check", path)]
        words += [word for kind in withhold for word in ("--withhold", kind)]
        told = command_of("diagnose", model, *words, "--out", tmp_path / "out", check=False)
        with pytest.raises(simgap.SimgapError) as raised:
            simgap.diagnose(model, train, check, withhold=withhold, progress=False)
        assert told.returncode == 2 and told.stderr == f"simgap: {raised.value}\n"


def test_records_that_do_not_fit_the_model_are_refused():
    model = DEMO / "model.toml"
    record = simgap.Record({"t": 0.01 * np.arange(100), "z": np.arange(100.0)}, name="odd")
    with pytest.raises(simgap.SimgapError, match="^odd: column '.*' is needed"):
        simgap.diagnose(model, [record], progress=False)
    with pytest.raises(simgap.SimgapError, match="a record is of int"):
        simgap.diagnose(model, [3], progress=False)
    twice = [simgap.read(path) for path in (TRAIN[0], TRAIN[0])]
    with pytest.raises(simgap.SimgapError, match="would be called"):
        simgap.diagnose(model, twice, progress=False)


def test_ctrl_c_ends_a_diagnosis_within_a_second():
    program = f"""
import os, signal, simgap, threading, time
steps = []
def strike(step):
    steps.append(step)
    if step == "single effects":
        struck.append(time.monotonic() + 0.3)
        threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
struck = []
try:
    simgap.diagnose({str(DEMO / "model.toml")!r}, {[str(p) for p in TRAIN]!r}, progress=strike)
except KeyboardInterrupt:
    print("ended", time.monotonic() - struck[0])
    busy = time.process_time()
    time.sleep(0.5)
    print("idle", time.process_time() - busy)
"""
    found = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60
    )
    told = dict(line.split() for line in found.stdout.splitlines())
    assert float(told["ended"]) < LATEST_S, found.stderr
    # Nothing goes on behind the back of the caller.
    assert float(told["idle"]) < 0.2


def test_other_threads_run_during_the_work():
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begun = time.monotonic()
    simgap.diagnose(DEMO / "model.toml", TRAIN, progress=False, budget_s=0.0)
    took = time.monotonic() - begun
    done.set()
    thread.join()
    # A held interpreter would let the thread run a few times only.
    assert counted[0] > 50 * took


def test_a_budget_and_the_steps_of_the_work():
    steps = []
    d = simgap.diagnose(DEMO / "model.toml", TRAIN, budget_s=0.0, progress=steps.append)
    assert d.stopped_early
    assert steps[0] == "nominal model" and steps[-1] == "check records"

    def fails(step):
        raise RuntimeError(step)

    with pytest.raises(RuntimeError, match="nominal model"):
        simgap.diagnose(DEMO / "model.toml", TRAIN, progress=fails)


def resident():
    """Memory that this process holds, bytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def test_large_arrays_are_copied_once():
    # As many as a record may have.
    samples = 5_000_000
    t = 1e-4 * np.arange(samples)
    columns = {"t": t, "u": np.sin(t), "y": np.cos(t)}
    if not os.path.exists("/proc/self/statm"):
        pytest.skip("memory is measured on Linux")
    before, begun = resident(), time.monotonic()
    record = simgap.Record(columns, units={"u": "N", "y": "m"})
    took, grown = time.monotonic() - begun, resident() - before
    size = sum(values.nbytes for values in columns.values())
    print(
        f"{samples} samples of {len(columns)} columns: {took:.2f} s, {grown / size:.2f} times their size"
    )
    assert len(record) == samples
    assert grown < 1.2 * size
