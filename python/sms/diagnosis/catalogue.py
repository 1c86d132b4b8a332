"""The effects that can be named: catalogue.toml, one hypothesis for each effect and measured signal."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, Literal

from sms.parameters import PARAMETERS

SIGNALS_IN_WORDS = {
    "rod_force": "rod force",
    "chamber_pressure_lower": "lower chamber pressure",
    "chamber_pressure_upper": "upper chamber pressure",
    "extension": "position",
}


@dataclass(frozen=True)
class Effect:
    """One hypothesis: an effect of the catalogue, for one signal where it belongs to a sensor."""

    id: str
    signal: str | None
    kind: Literal["missing", "shifted"]
    parameters: tuple[str, ...]
    block: str
    title: str
    cause: str
    signature: str
    needs: tuple[str, ...]
    plausible: tuple[float, float]
    separated_by: str

    @property
    def key(self) -> str:
        """Its name in messages: "sensor_gain of rod_force"."""
        return self.id if self.signal is None else f"{self.id} of {self.signal}"

    def plausible_range(self, reference: float) -> tuple[float, float]:
        """The plausible values of its parameter, SI; `reference` is the declared value."""
        low, high = self.plausible
        if self.kind == "missing":
            return low, high
        return reference * (1.0 + low), reference * (1.0 + high)


def _effects(entry: dict[str, Any]) -> Iterable[Effect]:
    for signal in entry.get("signals", [None]):
        text = {
            key: entry[key].format(signal=SIGNALS_IN_WORDS.get(signal, ""))
            for key in ("title", "cause")
        }
        yield Effect(
            id=entry["id"],
            signal=signal,
            kind=entry["kind"],
            parameters=tuple(p.format(signal=signal) for p in entry["parameters"]),
            block=entry["block"],
            signature=entry["signature"],
            needs=tuple(entry["needs"]),
            plausible=(entry["plausible"][0], entry["plausible"][1]),
            separated_by=entry["separated_by"],
            **text,
        )


@cache
def catalogue() -> tuple[Effect, ...]:
    """Every hypothesis, in the order of the file. KeyError if one names an unknown parameter."""
    text = files("sms.diagnosis").joinpath("catalogue.toml").read_text(encoding="utf-8")
    effects = tuple(e for entry in tomllib.loads(text)["effect"] for e in _effects(entry))
    for effect in effects:
        for name in effect.parameters:
            if name not in PARAMETERS:
                raise KeyError(f"catalogue.toml: {effect.id} names the unknown parameter {name}")
    return effects
