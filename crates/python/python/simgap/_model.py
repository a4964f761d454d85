"""Models: read from a file, from text, or built part by part."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from . import _simgap

_Value = str | float | Sequence[str] | Sequence[float]


class Model:
    """A lumped model of a machine: masses, springs, dampers, inputs, outputs.

    Read it with :meth:`from_file` or :meth:`from_toml`, or build it::

        model = (
            simgap.Model("axis")
            .mass("carriage", 95.1)                                        # kg
            .spring("bellows", ("carriage", "ground"), stiffness=2000.0)   # N/m
            .damper("guide", ("carriage", "ground"), damping=203.5)        # N s/m
            .input("drive", at="carriage")                                 # a force
            .output("q", at="carriage")                                    # a displacement
        )

    Rigid bodies with points, beams, hydraulic cylinders, servo valves and linear blocks (controllers,
    filters, sensors) are parts as well: :meth:`body`, :meth:`point`, :meth:`beam`, :meth:`cylinder`,
    :meth:`valve`, :meth:`block`.

    A model never changes: each part gives a new model. The node ``"ground"`` never moves.
    Rotation uses the same parts: inertia for mass, angle for displacement, torque for force.
    ``uncertainty`` says how well a value is known: relative standard deviation, 0.02 where none
    is stated. A model is checked when it is used; what is wrong is a :class:`SimgapError`.
    """

    def __init__(self, name: str = "model") -> None:
        """A model without parts."""
        self._text = f'schema = "simgap-model/1"\nname = {_text(name)}\n'
        self._native: _simgap.Model | None = None

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Model:
        """Reads a model file (TOML, schema ``simgap-model/1``)."""
        return cls._of(_simgap.Model.from_file(Path(path)))

    @classmethod
    def from_toml(cls, text: str) -> Model:
        """A model from the text of a model file."""
        return cls._of(_simgap.Model.from_text(text, "model text"))

    @classmethod
    def _of(cls, native: _simgap.Model) -> Model:
        model = cls.__new__(cls)
        model._native = native
        model._text = None  # type: ignore[assignment]
        return model

    def _compiled(self) -> _simgap.Model:
        if self._native is None:
            self._native = _simgap.Model.from_text(self._text, "model")
        return self._native

    def _with(self, table: str, values: Mapping[str, _Value | None]) -> Model:
        lines = [f"\n[[{table}]]"]
        given = ((key, value) for key, value in values.items() if value is not None)
        lines += [f"{key} = {_toml(value)}" for key, value in given]
        model = Model.__new__(Model)
        before = self._text if self._text is not None else self._compiled().to_toml()
        model._text = before.rstrip("\n") + "\n" + "\n".join(lines) + "\n"
        model._native = None
        return model

    def mass(self, name: str, value: float, *, uncertainty: float | None = None) -> Model:
        """Adds a mass, kg, or an inertia, kg m². One degree of freedom."""
        return self._with("mass", {"name": name, "value": value, "uncertainty": uncertainty})

    def spring(
        self,
        name: str,
        between: Sequence[str],
        stiffness: float,
        *,
        uncertainty: float | None = None,
    ) -> Model:
        """Adds a linear spring, N/m or N m/rad, between two nodes."""
        value = {"stiffness": stiffness, "uncertainty": uncertainty}
        return self._with("spring", {"name": name, "between": list(between), **value})

    def damper(
        self,
        name: str,
        between: Sequence[str],
        damping: float,
        *,
        uncertainty: float | None = None,
    ) -> Model:
        """Adds a linear damper, N s/m or N m s/rad, between two nodes."""
        value = {"damping": damping, "uncertainty": uncertainty}
        return self._with("damper", {"name": name, "between": list(between), **value})

    def input(
        self,
        channel: str,
        *,
        at: str,
        kind: str = "force",
        gain: float | None = None,
        uncertainty: float | None = None,
        between_samples: str | None = None,
    ) -> Model:
        """Adds what drives the machine, as measured: a ``"force"`` on the mass ``at``, N, the
        ``"displacement"`` of the moving base node ``at``, m, the ``"command"`` of the valve ``at``,
        1, the ``"set_point"`` of the block ``at``, or the ``"signal"`` ``at`` of a simulator. ``gain`` is in model units per unit of the
        channel; without it the unit must fit. ``between_samples`` is ``"smooth"``, ``"linear"``,
        ``"held"`` or ``"stepped"``; where it is not stated a diagnosis asks the records if the signal goes in jumps.
        """
        values = {"channel": channel, "kind": kind, "at": at, "gain": gain}
        values |= {"uncertainty": uncertainty, "between_samples": between_samples}
        return self._with("input", values)

    def output(
        self,
        channel: str,
        *,
        at: str | None = None,
        between: Sequence[str] | None = None,
        kind: str = "displacement",
        gain: float | None = None,
        uncertainty: float | None = None,
    ) -> Model:
        """Adds what is measured and compared: ``"displacement"``, ``"velocity"`` or
        ``"acceleration"`` of the node ``at``, the ``"force"`` that the members carry between the
        nodes ``between``, the ``"roll"`` of a body, rad, the ``"pressure"``, Pa, or ``"flow"``,
        m³/s, of a chamber such as ``"left.p1"``, the ``"spool"`` of a valve, 1, or a ``"signal"`` of a simulator. ``gain`` as in
        :meth:`input`.
        """
        pair = None if between is None else list(between)
        values = {"channel": channel, "kind": kind, "at": at, "between": pair, "gain": gain}
        return self._with("output", {**values, "uncertainty": uncertainty})

    def body(self, name: str, mass: float, inertia: float) -> Model:
        """Adds a rigid body with heave and roll: its mass, kg, and its inertia about the centre of
        mass, kg m²."""
        return self._with("body", {"name": name, "mass": mass, "inertia": inertia})

    def point(self, name: str, body: str, offset: float) -> Model:
        """Adds a point of a body, ``offset`` from its centre of mass, m, of either sign: the node
        ``"body.name"``."""
        return self._with("point", {"name": name, "body": body, "offset": offset})

    def beam(
        self,
        name: str,
        between: Sequence[str],
        *,
        length: float,
        width: float,
        thickness: float,
        youngs_modulus: float,
        density: float,
        elements: int | None = None,
        modes: int | None = None,
        damping_ratio: float | None = None,
        uncertainty: float | None = None,
    ) -> Model:
        """Adds an Euler-Bernoulli beam clamped at both ends, in SI units. ``uncertainty`` is that
        of Young's modulus."""
        size = {"length": length, "width": width, "thickness": thickness}
        material = {"youngs_modulus": youngs_modulus, "density": density}
        kept = {"elements": elements, "modes": modes, "damping_ratio": damping_ratio}
        values = {"name": name, "between": list(between), **size, **material, **kept}
        return self._with("beam", {**values, "uncertainty": uncertainty})

    def cylinder(
        self,
        name: str,
        between: Sequence[str],
        *,
        areas: Sequence[float],
        dead_volumes: Sequence[float],
        stroke: float,
        bulk_modulus: float,
        position: float | None = None,
        leakage: float | None = None,
        external_leakage: float | None = None,
        pressures: Sequence[float] | None = None,
    ) -> Model:
        """Adds a double-acting hydraulic cylinder between rod and housing, in SI units; its
        pressures are the nodes ``"name.p1"`` and ``"name.p2"``. ``pressures`` are those at the
        start, ``position`` is where in the stroke it moves (its middle where not stated)."""
        oil: dict[str, _Value | None] = {"bulk_modulus": bulk_modulus, "leakage": leakage}
        values: dict[str, _Value | None] = {
            "name": name,
            "between": list(between),
            "areas": list(areas),
        }
        size: dict[str, _Value | None] = {
            "dead_volumes": list(dead_volumes),
            "stroke": stroke,
            "position": position,
        }
        more: dict[str, _Value | None] = {
            "external_leakage": external_leakage,
            "pressures": None if pressures is None else list(pressures),
        }
        return self._with("cylinder", {**values, **size, **oil, **more})

    def valve(
        self,
        name: str,
        cylinder: str,
        *,
        rated_flow: float,
        rated_drop: float,
        natural_freq: float,
        damping_ratio: float,
        supply: float,
        from_block: str | None = None,
        tank: float | None = None,
        overlap: float | None = None,
        asymmetry: float | None = None,
        supply_droop: float | None = None,
    ) -> Model:
        """Adds a four-way servo valve that feeds a cylinder, in SI units (``natural_freq`` in Hz),
        commanded by the block ``from_block`` or by an input of the kind ``"command"``."""
        values = {"name": name, "cylinder": cylinder, "from": from_block}
        flow = {"rated_flow": rated_flow, "rated_drop": rated_drop, "overlap": overlap}
        spool = {"natural_freq": natural_freq, "damping_ratio": damping_ratio}
        more = {"tank": tank, "asymmetry": asymmetry, "supply_droop": supply_droop}
        return self._with("valve", {**values, **flow, **spool, "supply": supply, **more})

    def block(
        self,
        name: str,
        numerator: Sequence[float],
        denominator: Sequence[float],
        *,
        plus: Sequence[str] | None = None,
        minus: Sequence[str] | None = None,
        force: str | None = None,
    ) -> Model:
        """Adds a transfer function, coefficients of s with the highest power first, of the sum of
        the signals ``plus`` less those of ``minus``: blocks, nodes (their displacement, m) and
        chambers (their pressure, Pa). Its output commands a valve, or is a force, N, on the node
        ``force``."""
        values: dict[str, _Value | None] = {
            "name": name,
            "numerator": list(numerator),
            "denominator": list(denominator),
        }
        joined: dict[str, _Value | None] = {
            "plus": None if plus is None else list(plus),
            "minus": None if minus is None else list(minus),
        }
        return self._with("block", {**values, **joined, "force": force})

    def load(self, at: str, value: float, *, uncertainty: float | None = None) -> Model:
        """Adds a known constant force on a mass, N, such as its weight."""
        return self._with("load", {"at": at, "value": value, "uncertainty": uncertainty})

    def pendulum(self, at: str, value: float, *, uncertainty: float | None = None) -> Model:
        """Adds gravity on an arm: torque ``-value sin(angle)``, N m."""
        return self._with("pendulum", {"at": at, "value": value, "uncertainty": uncertainty})

    def parameter(self, name: str, value: float, *, uncertainty: float | None = None) -> Model:
        """Adds a parameter of a simulator (:class:`simgap.Simulator`), in the simulator's unit."""
        return self._with("parameter", {"name": name, "value": value, "uncertainty": uncertainty})

    def port(self, name: str, *, displacement: str, velocity: str) -> Model:
        """Adds a place of a simulator where a force can act, a node of the model: the names of the
        outputs of the simulator that are its displacement, m or rad, and its velocity, m/s or rad/s."""
        motion = {"displacement": displacement, "velocity": velocity}
        return self._with("port", {"name": name, **motion})

    def law(
        self,
        name: str,
        force: str,
        parameters: Mapping[str, Mapping[str, str | float]],
        *,
        between: Sequence[str] | None = None,
        summary: str | None = None,
    ) -> Model:
        """Adds a law of your own: a force across a member as an expression of the displacement ``d``, the
        velocity ``v``, the time ``t`` and its parameters. It competes with the catalogue. Each parameter has a
        ``unit`` and what is known of it: ``usual``, or ``value`` and ``uncertainty``, or ``lower`` and
        ``upper``::

        model.law("grease", "c * tanh(v / v0)", {"c": {"unit": "N", "usual": 20.0},
                                                 "v0": {"unit": "m/s", "usual": 0.05}})
        """
        pair = None if between is None else list(between)
        values = {"summary": summary, "between": pair, "force": force}
        model = self._with("law", {"name": name, **values})
        for parameter, known in parameters.items():
            model = model._with("law.parameter", {"name": parameter, **known})
        return model

    def effect(
        self,
        kind: str,
        *,
        between: Sequence[str] | None = None,
        mass: str | None = None,
        input: str | None = None,
        channel: str | None = None,
        parameter: str | None = None,
        **parameters: float,
    ) -> Model:
        """Adds an effect of the catalogue (:func:`simgap.effects`) at one place, with its
        parameters in SI units::

        model.effect("coulomb_friction", between=("carriage", "ground"), friction_force_n=20.0)
        """
        pair = None if between is None else list(between)
        at = {"between": pair, "mass": mass, "input": input, "channel": channel}
        return self._with("effect", {"kind": kind, **at, "parameter": parameter, **parameters})

    @property
    def name(self) -> str:
        """Name of the model."""
        return self._compiled().name

    @property
    def inputs(self) -> list[str]:
        """Channels of a record that drive the model."""
        return self._compiled().channels[0]

    @property
    def outputs(self) -> list[str]:
        """Channels of a record that are compared."""
        return self._compiled().channels[1]

    def to_toml(self) -> str:
        """The text of the model file."""
        return self._compiled().to_toml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model file."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def __repr__(self) -> str:
        channels = ", ".join(self.inputs) + " -> " + ", ".join(self.outputs)
        return f"<simgap.Model {self.name!r}: {channels}>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Model) and self.to_toml() == other.to_toml()

    __hash__ = None  # type: ignore[assignment]

    def _repr_html_(self) -> str:
        """The picture of the machine in a notebook, and its frequency responses."""
        native = self._compiled()
        # A simulator has no matrices that frequency responses could be computed from.
        responses = "" if native.is_simulator else f"<div>{native.responses_svg()}</div>"
        return f"<div>{native.picture()}</div>{responses}"


def _text(value: str) -> str:
    # A string of JSON is one of TOML, but for the one control character that JSON leaves alone.
    return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")


def _toml(value: _Value) -> str:
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Sequence):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    # Counts are whole numbers in the file.
    return str(value) if isinstance(value, int) else repr(float(value))
