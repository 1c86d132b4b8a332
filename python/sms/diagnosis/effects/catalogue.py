"""The effects that can be named: one hypothesis for each effect and each signal or part that it can sit on.

cylinder.toml is that of a cylinder's force balance, pneumatic.toml that of tank, bench and platform,
platform.toml what the platform has beyond it. A rig file may name a file with entries of its user's own.
"""

from __future__ import annotations

import tomllib
from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from sms.diagnosis.effects.own_entries import (
    Known,
    filled,
    own_entries,
    parameters_of,
    places_of,
)
from sms.io.rig import Rig
from sms.io.signals import LEGS, SIGNALS, label, without_leg
from sms.parameters import PARAMETERS, common_parameter, is_of_leg

LINKS = (*(f"actuator {i}" for i in LEGS), *(f"Panhard rod {i}" for i in LEGS))
"""The links between ground and platform, in the order of their joints."""
PARTS_IN_WORDS = {
    "chamber_pressure": "chamber pressures",
    "proportional_gain": "proportional gain",
    "integral_gain": "integral gain",
    "derivative_gain": "derivative gain",
    "dead_band_step": "dead-band compensation",
    "position_gain": "position gain",
    "velocity_gain": "velocity gain",
    "acceleration_gain": "acceleration gain",
    **{
        f"{side}_joint_{i}_{axis}": f"{side} joint of {link} ({axis})"
        for side in ("base", "platform")
        for i, link in enumerate(LINKS, 1)
        for axis in "xyz"
    },
    **{f"actuator_length_offset_{i}": f"actuator {i}" for i in LEGS},
    **{f"panhard_length_offset_{i}": f"Panhard rod {i}" for i in LEGS},
}


@dataclass(frozen=True)
class Effect:
    """One hypothesis: an effect of the catalogue, for one signal where it belongs to a sensor."""

    id: str
    signal: str | None
    """The sensor it sits on, or the part of the machine ("lower"); None where there is only one."""
    kind: Literal["missing", "shifted"]
    parameters: tuple[str, ...]
    block: str
    title: str
    cause: str
    """The physics, and how it shows in the records."""
    needs: tuple[str, ...]
    plausible: tuple[float, float]
    separated_by: str
    of_sensor: bool = False
    """`signal` names a measured signal, without which there is nothing to test."""
    seen_in: tuple[str, ...] = ()
    """Signals of which one has to be measured; none: it shows in what every such rig measures."""
    step: float | None = None
    """The size at which its sensitivity is taken, where it has no slope at its neutral value."""
    sizes: int | None = None
    """How many of its parameters, the first, are sizes, of which none has an effect at its neutral value; the others
    shape what these switch on, and without them have no value. None: all are sizes."""
    absolute: bool = False
    """Of a shifted parameter: `plausible` is a shift in its unit, not relative."""
    chambers: str | None = None
    """The law of the chambers under which the hypothesis stands; None under any."""
    controller: str | None = None
    """"recorded", or the law of a simulated controller, under which the hypothesis stands; None under any."""

    @property
    def key(self) -> str:
        """Its name in messages: "sensor_gain of rod_force"."""
        return self.id if self.signal is None else f"{self.id} of {self.signal}"

    def not_measured(self, signals: Container[str]) -> str:
        """What a rig with these signals lacks to ask for it, in words; empty where it can be asked."""
        if self.of_sensor and self.signal not in signals:
            return f"{self.signal} is not measured"
        if self.seen_in and not any(s in signals for s in self.seen_in):
            return f"it is seen from {' and '.join(self.seen_in)}, of which none is measured"
        return ""

    def plausible_range(self, reference: float) -> tuple[float, float]:
        """The plausible values of its parameter, SI; `reference` is the declared value, that of all legs."""
        low, high = self.plausible_change(reference)
        about = 0.0 if self.kind == "missing" or is_of_leg(self.parameters[0]) else reference
        return about + low, about + high

    def plausible_change(self, reference: float) -> tuple[float, float]:
        """By how much its parameter may plausibly differ from what is declared, SI."""
        low, high = self.plausible
        if self.kind == "missing" or self.absolute:
            return low, high
        return reference * low, reference * high


def _effects(entry: dict[str, Any]) -> Iterable[Effect]:
    of_sensor = "signals" in entry
    for place in places_of(entry):
        title, cause, signature, separated_by = (
            filled(entry[key], _said(place))
            for key in ("title", "cause", "signature", "separated_by")
        )
        yield Effect(
            id=entry["id"],
            signal=place,
            kind=entry["kind"],
            parameters=parameters_of(entry, place),
            block=entry["block"],
            title=title,
            cause=f"{cause} In the records: {signature}." if signature else cause,
            separated_by=separated_by,
            needs=tuple(entry["needs"]),
            plausible=_plausible(entry["plausible"], place),
            of_sensor=of_sensor,
            seen_in=tuple(entry.get("seen_in", ())),
            step=entry.get("step"),
            sizes=entry.get("sizes"),
            absolute=entry.get("absolute", False),
            chambers=entry.get("chambers"),
            controller=entry.get("controller"),
        )


def _plausible(
    said: list[float] | dict[str, list[float]], place: str | None
) -> tuple[float, float]:
    """The range of an entry, or its range for one signal, of whatever leg."""
    low, high = said if isinstance(said, list) else said[without_leg(place or "")]
    return low, high


def _said(place: str | None) -> str | None:
    """ "extension_2" -> "position of leg 2"."""
    if place is not None and without_leg(place) in SIGNALS:
        return label(place)
    return PARTS_IN_WORDS.get(place or "", place)


def _in_one_leg(effects: Sequence[Effect], ids: Sequence[str]) -> Iterable[Effect]:
    """Each effect of these ids once more for every leg that may have it alone."""
    for effect in effects:
        for leg in LEGS if effect.id in ids else ():
            yield replace(
                effect,
                signal=f"leg {leg}" if effect.signal is None else f"{effect.signal}, leg {leg}",
                parameters=tuple(f"{p}:{leg}" for p in effect.parameters),
                title=f"{effect.title}, in leg {leg}",
            )


@cache
def catalogue(kind: str = "cylinder") -> tuple[Effect, ...]:
    """Every hypothesis for one kind of rig, in the order of the file. KeyError if one names an unknown parameter."""
    name = "cylinder.toml" if kind == "cylinder" else "pneumatic.toml"
    entries = [e for e in _read(name)["effect"] if kind in e.get("kinds", [kind])]
    legs: Sequence[str] = ()
    if kind == "platform":
        more = _read("platform.toml")
        entries, legs = entries + more["effect"], more["legs"]
    effects = tuple(e for entry in entries for e in _effects(entry))
    effects += tuple(_in_one_leg(effects, legs))
    for effect in effects:
        for parameter in effect.parameters:
            if common_parameter(parameter) not in PARAMETERS:
                raise KeyError(f"{name}: {effect.id} names the unknown parameter {parameter}")
    return effects


def _read(name: str) -> dict[str, Any]:
    return tomllib.loads(files("sms.diagnosis.effects").joinpath(name).read_text(encoding="utf-8"))


@cache
def _known(kind: str) -> Known:
    """What the catalogue has for a kind of rig, that nobody defines it a second time."""
    effects = catalogue(kind)
    every = [
        e["block"] for name in ("cylinder.toml", "pneumatic.toml") for e in _read(name)["effect"]
    ]
    blocks = [*every, *(e["block"] for e in _read("platform.toml")["effect"])]
    return Known(
        {e.id for e in effects}, {e.parameters: e.key for e in effects}, list(dict.fromkeys(blocks))
    )


def own_effects(rig: Rig) -> tuple[Effect, ...]:
    """The hypotheses of the file that [effects] of the rig file names. InputError for a mistake in it."""
    entries, legs = own_entries(rig, _known(rig.kind))
    effects = tuple(e for entry in entries for e in _effects(entry))
    return effects + tuple(_in_one_leg(effects, legs))


def effects_of(rig: Rig) -> tuple[Effect, ...]:
    """The hypotheses that stand for a simulated rig with its laws: those of the catalogue, and its user's own."""
    control = rig.control
    controller = control.law if control.controller == "simulated" else "recorded"
    return tuple(
        e
        for e in (*catalogue(rig.kind), *own_effects(rig))
        if e.chambers in (None, rig.model.chambers) and e.controller in (None, controller)
    )
