"""What can be wrong with the bench of the demonstration: effects of the catalogue, of sizes that curves show."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from sms.diagnosis.effects.catalogue import Effect, catalogue
from sms.diagnosis.result import Diagnosis
from sms.errors import InputError, did_you_mean
from sms.parameters import PARAMETERS

HIDEABLE: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "fitting_leakage:lower": (1e-8, 2e-8),  # kg/(s Pa)
        "fitting_leakage:upper": (1e-8, 2e-8),
        "supply_droop": (1e7, 2.5e7),  # Pa s/kg
        "moving_mass": (20.0, 40.0),  # kg
        "tube": (4.0, 8.0),  # m
        "sensor_lag:extension": (0.03, 0.06),  # s
    }
)
"""Effect, and its part after a colon -> from where to where its first parameter is drawn, SI."""


@dataclass(frozen=True)
class Hidden:
    """One effect of one size."""

    key: str
    value: float  #: of its parameter, SI

    @property
    def effect(self) -> Effect:
        """As the catalogue has it."""
        return next(e for e in catalogue("bench") if key_of(e.id, e.signal) == self.key)

    @property
    def parameter(self) -> str:
        """Which number of the machine it is."""
        return self.effect.parameters[0]

    @property
    def unit(self) -> str:
        """Of the value."""
        return PARAMETERS[self.parameter].unit

    def named_by(self, answer: Diagnosis) -> bool:
        """Whether a diagnosis names it, alone or in a class, and nothing else."""
        return len(answer.causes) == 1 and self.key in said(answer)[0]


def key_of(effect: str, part: str | None) -> str:
    """ "fitting_leakage:lower" of an effect and the part or signal that it sits on."""
    return effect if part is None else f"{effect}:{part}"


def said(answer: Diagnosis) -> list[list[str]]:
    """What a diagnosis names: of each cause the explanations that it leaves."""
    return [
        list(
            dict.fromkeys(
                [
                    key_of(cause.effect, cause.signal),
                    *(key_of(other.effect, other.signal) for other in cause.alternatives),
                ]
            )
        )
        for cause in answer.causes
    ]


def draw_hidden(name: str | None, rng: np.random.Generator) -> Hidden:
    """An effect by its name, "fitting_leakage" or "fitting_leakage:lower", or any; its size is drawn, log-uniformly.

    InputError for one that is not hidden here.
    """
    which, part = (
        rng.integers(2**32),
        rng.uniform(),
    )  # both at once: the size does not depend on the name
    keys = [key for key in HIDEABLE if name in (None, key, key.partition(":")[0])]
    if not keys:
        raise InputError(
            f"--effect {name}: the demonstration does not hide it; {did_you_mean(str(name), HIDEABLE)}"
        )
    key = keys[int(which) % len(keys)]
    low, high = HIDEABLE[key]
    return Hidden(key, float(low * (high / low) ** part))
