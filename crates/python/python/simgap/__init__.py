"""Diagnoses why a real machine does not move like its model.

You have a model of a machine (masses, springs, dampers, inputs, outputs) and records of the
real one, and the prediction is off. ``diagnose`` says where the gap lies, which unmodelled
effect causes it, and how far the gap closes on records that were not used to find it::

    import simgap

    model = simgap.Model.from_file("axis.toml")
    d = simgap.diagnose(model, train=["run1.csv", "run2.csv"], check=["run3.csv"])
    d.status, d.gap.closed
    d.effects[0].kind, d.effects[0].parameters["friction_force_n"].ci95
    d.save("result")

Everything inside is in SI units. The same input gives the same bytes as the command ``simgap``.
Every error is a ``SimgapError`` with one line: where, what was found, what is needed.
"""

from . import fleet
from ._compare import Agreement, Comparison, compare
from ._diagnose import diagnose
from ._diagnosis import Diagnosis
from ._model import Model
from ._parts import (
    Band,
    Candidate,
    Channel,
    ChannelGap,
    Effect,
    Gap,
    Location,
    Other,
    Parameter,
    Place,
    RecordShare,
    Rival,
    State,
    Time,
    Unexplained,
    Where,
)
from ._record import Record, read
from ._simgap import SimgapError, __version__
from ._simulator import Simulator
from ._tables import Kind, KindParameter, Mode, Modes, effects, modes, simulate

__all__ = [
    "Agreement",
    "Band",
    "Candidate",
    "Channel",
    "ChannelGap",
    "Comparison",
    "Diagnosis",
    "Effect",
    "Gap",
    "Kind",
    "KindParameter",
    "Location",
    "Mode",
    "Model",
    "Modes",
    "Other",
    "Parameter",
    "Place",
    "Record",
    "RecordShare",
    "Rival",
    "SimgapError",
    "Simulator",
    "State",
    "Time",
    "Unexplained",
    "Where",
    "__version__",
    "compare",
    "diagnose",
    "effects",
    "fleet",
    "modes",
    "read",
    "simulate",
]
