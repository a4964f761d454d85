"""Parts of an answer, as the keys of ``diagnosis.json`` name them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any, TypeVar

#: A place of the model: ``{"between": [a, b]}``,
#: ``{"mass": m}``, ``{"input": channel}`` or ``{"channel": channel}``.
Place = dict[str, Any]

_Part = TypeVar("_Part")


def made(part: type[_Part], values: Mapping[str, Any]) -> _Part:
    """A part from what the JSON holds; keys that a later version adds are left to ``to_dict``."""
    names = {field.name for field in dataclasses.fields(part)}  # type: ignore[arg-type]
    return part(**{key: value for key, value in values.items() if key in names})


def _number(value: float | None) -> float:
    # Infinity has no JSON: an interval that the data do not bound.
    return math.nan if value is None else value


@dataclasses.dataclass(frozen=True)
class Parameter:
    """An estimated value, in the unit at the end of its name, or in ``unit`` where that is stated."""

    name: str
    value: float
    #: 95 % interval: lower and upper end; nan where the data do not bound it.
    ci95: tuple[float, float]
    #: Unit, where the name does not hold it: of a law of the model file.
    unit: str | None = None


@dataclasses.dataclass(frozen=True)
class Rival:
    """What these data cannot tell from a named effect."""

    kind: str
    at: Place
    because: str


@dataclasses.dataclass(frozen=True)
class Effect:
    """A named effect: what it is, where it acts, how sure that is."""

    kind: str
    at: Place
    #: That it, or one of ``indistinguishable``, is part of the cause.
    probability: float
    #: By name, such as ``friction_force_n``.
    parameters: dict[str, Parameter]
    indistinguishable: list[Rival]
    #: Why it is named, one sentence each.
    evidence: list[str]

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Effect:
        """An effect from what the JSON holds."""
        parameters = {}
        for one in values["parameters"]:
            low, high = (_number(end) for end in one["ci95"])
            value = _number(one["value"])
            parameters[one["name"]] = Parameter(one["name"], value, (low, high), one.get("unit"))
        rivals = [made(Rival, one) for one in values["indistinguishable"]]
        return made(cls, {**values, "parameters": parameters, "indistinguishable": rivals})


@dataclasses.dataclass(frozen=True)
class ChannelGap:
    """The gap of one output channel, as in :class:`Gap`."""

    channel: str
    nominal: float
    recalibrated: float
    corrected: float
    noise_floor: float
    input_noise: float


@dataclasses.dataclass(frozen=True)
class Gap:
    """How large the gap is on the check records: rms(measured - predicted) / std(measured)."""

    #: ``nrmse``.
    metric: str
    #: With the model as given.
    nominal: float
    #: With its nominal parameters re-estimated.
    recalibrated: float
    #: With the named effects.
    corrected: float
    #: What white measurement noise alone would leave.
    noise_floor: float
    #: What the noise on the inputs does besides.
    input_noise: float
    #: Share of the gap above noise that is closed, 0 to 1.
    closed: float
    channels: list[ChannelGap]


@dataclasses.dataclass(frozen=True)
class Channel:
    """Share of the discrepancy in one output channel."""

    channel: str
    share: float


@dataclasses.dataclass(frozen=True)
class Location:
    """Share of the discrepancy at one place of the model."""

    at: Place
    share: float


@dataclasses.dataclass(frozen=True)
class Band:
    """Share of the discrepancy in one frequency band."""

    from_hz: float
    to_hz: float
    label: str
    share: float


@dataclasses.dataclass(frozen=True)
class Time:
    """Share of the discrepancy in one stretch of time."""

    record: str
    from_s: float
    to_s: float
    share: float


@dataclasses.dataclass(frozen=True)
class State:
    """Share of the discrepancy in one region of motion, and of the time that the motion is
    there.
    """

    label: str
    variable: str
    at: str
    share: float
    occupancy: float


@dataclasses.dataclass(frozen=True)
class RecordShare:
    """Share of the discrepancy in one record."""

    record: str
    share: float


@dataclasses.dataclass(frozen=True)
class Where:
    """Where the discrepancy of the model as given lies."""

    channels: list[Channel]
    locations: list[Location]
    bands: list[Band]
    times: list[Time]
    states: list[State]
    records: list[RecordShare]

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> Where:
        """The places from what the JSON holds."""
        return cls(
            channels=[made(Channel, one) for one in values["channels"]],
            locations=[made(Location, one) for one in values["locations"]],
            bands=[made(Band, one) for one in values["bands"]],
            times=[made(Time, one) for one in values["times"]],
            states=[made(State, one) for one in values["states"]],
            records=[made(RecordShare, one) for one in values["records"]],
        )


@dataclasses.dataclass(frozen=True)
class Unexplained:
    """What an answer leaves of the gap on the check records."""

    #: rms of what is left above noise, over the rms of the gap of the model as given.
    share: float
    #: In words; empty where nothing is left.
    looks_like: str
    channels: list[Channel]


@dataclasses.dataclass(frozen=True)
class Other:
    """A main cause that the catalogue lacks."""

    probability: float
    #: The place where a free law closes most; None where none was sought.
    at: Place | None
    #: Share of the gap that a free law there closes.
    closed: float | None


@dataclasses.dataclass(frozen=True)
class Candidate:
    """A single effect that was tried."""

    kind: str
    at: Place
    held_back_gap: float
    probability: float
