"""Friction of the load and a late sensor on the machine, neither in its FMU: which is named?

    pip install fmpy
    python crates/python/examples/fmpy_slide.py

A drive on a spring carries a load on a coupling. The FMU (FMI 2.0, co-simulation) is compiled from `slide_fmu` with the C
compiler of the machine; any FMU that takes the force on the load as an input does as well.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

import simgap

HERE = Path(__file__).parent / "slide_fmu"
STEP, SAMPLES = 4e-3, 600
FRICTION, LATE = 2.5, 6e-3  # N, s

# A few rivals, to be quick. The whole catalogue takes many times as many simulations.
SUSPECTED = {"parameter_error", "coulomb_friction", "viscous_damping", "sensor_delay", "input_delay"}


def compiled(folder):
    """The unpacked FMU for this machine."""
    system = {"linux": "linux64", "darwin": "darwin64"}[sys.platform]
    suffix = {"linux": ".so", "darwin": ".dylib"}[sys.platform]
    binaries = folder / "binaries" / system
    binaries.mkdir(parents=True)
    headers = Path(fmpy.__file__).parent / "c-code"
    words = [os.environ.get("CC", "cc"), "-O2", "-shared", "-fPIC", f"-I{headers}"]
    subprocess.run([*words, HERE / "slide.c", "-o", binaries / f"slide{suffix}"], check=True)
    (folder / "modelDescription.xml").write_bytes((HERE / "modelDescription.xml").read_bytes())
    return folder


class Slide:
    """The FMU that is asked, `f(parameters, inputs, forces) -> outputs`."""

    def __init__(self, folder):
        description = fmpy.read_model_description(str(folder), validate=False)
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        identifier = description.coSimulation.modelIdentifier
        self.fmu = FMU2Slave(
            guid=description.guid, unzipDirectory=str(folder), modelIdentifier=identifier
        )
        self.fmu.instantiate()
        self.calls = 0

    def run(self, parameters, driven, step, every=1):
        """Outputs from rest; `driven` are signals by name, each value held for a sample of `every` steps."""
        fmu, reference = self.fmu, self.reference
        fmu.reset()
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        fmu.setReal([reference[name] for name in parameters], list(parameters.values()))
        fmu.exitInitializationMode()
        to, given = [reference[name] for name in driven], np.column_stack(list(driven.values()))
        names = ["x1", "v1", "x2", "v2"]
        of = [reference[name] for name in names]
        found = np.empty((len(given), len(names)))
        for n, values in enumerate(given.tolist()):
            found[n] = fmu.getReal(of)
            fmu.setReal(to, values)
            for k in range(every):
                fmu.doStep((n * every + k) * step / every, step / every)
        return dict(zip(names, found.T))

    def __call__(self, parameters, inputs, forces):
        self.calls += 1
        t = inputs["t"]
        return self.run(parameters, {"u": inputs["u"], "load": forces["load"]}, t[1] - t[0])


def record(k):
    """A record of the machine: the same equations by small steps of their own, with friction at the load."""
    m1, m2, k0, c0, kk, c, d = 3.0, 5.0, 900.0, 12.0, 9000.0, 15.0, 8.0
    rng = np.random.default_rng(k)
    t = STEP * np.arange(SAMPLES)
    tones = zip([0.7, 1.8, 4.3], [22.0, 16.0, 12.0], rng.uniform(0.0, 2.0 * np.pi, 3))
    u = (1.0 - np.exp(-3.0 * t)) * sum(a * np.sin(2 * np.pi * f * t + p) for f, a, p in tones)
    fine = 100
    h = STEP / fine
    x1 = v1 = x2 = v2 = 0.0
    y1, y2 = np.empty(SAMPLES), np.empty(SAMPLES)
    for n, force in enumerate(u.tolist()):
        y1[n], y2[n] = x1, x2
        for _ in range(fine):
            coupling = kk * (x1 - x2) + c * (v1 - v2)
            v1 += h / m1 * (force - k0 * x1 - c0 * v1 - coupling)
            free = v2 + h / m2 * (coupling - d * v2)
            most = h / m2 * FRICTION
            v2 = free - min(abs(free), most) * (1.0 if free > 0.0 else -1.0)
            x1 += h * v1
            x2 += h * v2
    y2 = np.interp(t - LATE, t, y2)
    columns = {"t": t, "u": u}
    y1, y2 = y1 + rng.normal(0.0, 2e-5, SAMPLES), y2 + rng.normal(0.0, 2e-5, SAMPLES)
    columns |= {"x1": y1, "x2": y2}
    return simgap.Record(columns, {"u": "N", "x1": "m", "x2": "m"}, name=f"run{k}")


def main():
    runs = [record(k) for k in range(3)]
    with tempfile.TemporaryDirectory() as folder:
        slide = Slide(compiled(Path(folder)))
        simulator = simgap.Simulator(
            slide,
            inputs=["u"],
            outputs=["x1", "x2"],
            parameters={"m1": 3.0, "m2": 5.0, "k": 9000.0, "d": (8.0, 0.1)},
            ports={"load": ("x2", "v2")},
            name="slide as an FMU",
        )
        begun = time.perf_counter()
        others = [kind for kind in simgap.effects() if kind not in SUSPECTED]
        d = simgap.diagnose(simulator=simulator, train=runs[:2], check=runs[2], withhold=others, budget_s=120)
        print(d)
        print(f"{slide.calls} simulations, {time.perf_counter() - begun:.0f} s")
        slide.fmu.terminate()
        slide.fmu.freeInstance()


if __name__ == "__main__":
    main()
