"""Where the repository lies, and records to ask about."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[3]
DEMO = ROOT / "fixtures" / "demo"


def command_of(*arguments, cwd=None, check=True):
    """Runs the command line program; `SIMGAP_COMMAND` names it where it is not in the target folder."""
    program = os.environ.get("SIMGAP_COMMAND", str(ROOT / "target" / "debug" / "simgap"))
    words = [program, *map(str, arguments)]
    return subprocess.run(words, cwd=cwd, check=check, capture_output=True, text=True)


@pytest.fixture(scope="session")
def by_command(tmp_path_factory):
    """The demo, diagnosed by the command."""
    out = tmp_path_factory.mktemp("command") / "result"
    train = ["--train", DEMO / "train-1.csv", "--train", DEMO / "train-2.csv"]
    words = [DEMO / "model.toml", *train, "--check", DEMO / "check.csv", "--out", out]
    command_of("diagnose", *words)
    return out


def axis_records(folder=None):
    """Three records of an axis with 40 N of Coulomb friction, 1 kHz, 4 s: name to columns of t, drive, q in mm."""
    found = {}
    for k, name in enumerate(["run1", "run2", "run3"]):
        rng = np.random.default_rng(30 + k)
        step, samples, substeps = 1e-3, 4000, 10
        t = step * np.arange(samples)
        tones = [(0.7, 260.0), (1.9, 180.0), (3.1 + 0.4 * k, 120.0)]
        phases = rng.uniform(0.0, 2.0 * np.pi, len(tones))
        drive = sum(a * np.sin(2 * np.pi * f * t + p) for (f, a), p in zip(tones, phases))
        mass, stiffness, damping, friction = 95.1, 2000.0, 203.5, 40.0
        x, v, h = 0.0, 0.0, step / substeps
        q = np.empty(samples)
        for n in range(samples):
            q[n] = x
            force = drive[n] - stiffness * x - damping * v
            following = drive[min(n + 1, samples - 1)]
            for s in range(substeps):
                u = drive[n] + (following - drive[n]) * s / substeps
                force = u - stiffness * x - damping * v
                # Sliding friction, or sticking where it is strong enough.
                slid = v + h / mass * (force - friction * np.sign(v if v != 0.0 else force))
                stuck = v * slid <= 0.0 and abs(force) <= friction
                v = 0.0 if stuck else slid
                x += h * v
        q = 1e3 * q + rng.normal(0.0, 0.2, samples)
        found[name] = {"t": t, "drive": np.round(drive, 4), "q": np.round(q, 5)}
    if folder is not None:
        for name, columns in found.items():
            rows = np.column_stack([columns["t"], columns["drive"], columns["q"]]).tolist()
            lines = [f"{t:.3f},{u!r},{q!r}" for t, u, q in rows]
            (folder / f"{name}.csv").write_text(
                "t [s],drive [N],q [mm]\n" + "\n".join(lines) + "\n"
            )
    return found


def readme_blocks(language):
    """Code of the README's section on Python."""
    section = (ROOT / "README.md").read_text().split("## From Python", 1)[1].split("\n## ", 1)[0]
    blocks = section.split(f"```{language}\n")[1:]
    return [block.split("```", 1)[0] for block in blocks]


@pytest.fixture(scope="session")
def axis_folder(tmp_path_factory):
    """A folder with the README's model file and records of it."""
    folder = tmp_path_factory.mktemp("axis")
    readme = (ROOT / "README.md").read_text()
    model = readme.split("```toml\n", 1)[1].split("```", 1)[0]
    lines = [line.removeprefix("   ") for line in model.splitlines()]
    (folder / "axis.toml").write_text("\n".join(lines))
    axis_records(folder)
    return folder


@pytest.fixture()
def in_axis_folder(axis_folder, tmp_path, monkeypatch):
    """A copy of that folder to work in."""
    for file in axis_folder.iterdir():
        shutil.copy(file, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path
