"""What poses cannot tell, in words: motions of a frame, a scale, a zero against a length.

A combination is a direction in the space of the parameters. Over the tolerances, at length one, it moves the whitened
readings by |J d|: below one, the poses say less of it than the drawing does, and it is not claimed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sms import _core
from sms.arrays import Array

TOLD = 1.0
"""|J d| from which poses say more of a combination than its tolerance."""
_AXES = {"x": 0, "y": 1, "z": 2}
_STEP = 1e-6


@dataclass(frozen=True)
class Combination:
    """One combination, and how far the poses tell it: deviation over that of the tolerance, 1 where not at all."""

    words: str
    information: float  #: |J d| of the direction at length one over the tolerances

    @property
    def told(self) -> bool:
        """Whether the poses say more of it than the drawing."""
        return self.information > TOLD


def combinations_of(
    params: _core.LegParams, names: list[str], prior: Array, scaled: Array
) -> tuple[Combination, ...]:
    """The combinations that a person knows, each with what the poses tell of it. scaled: (rows, parameters)."""
    place = {name: k for k, name in enumerate(names)}
    found = []
    for words, moved in _known(params):
        direction = np.zeros(len(names))
        for name, by in moved.items():
            if name in place:
                direction[place[name]] = by / prior[place[name]]
        length = np.linalg.norm(direction)
        if length > 0.0:
            found.append(Combination(words, float(np.linalg.norm(scaled @ direction) / length)))
    return tuple(found)


def _joints(params: _core.LegParams, side: str) -> Array:
    return np.array([[params[f"{side}_joint_{i}_{a}"] for a in "xyz"] for i in range(1, 7)])


def _lengths_kept(
    base: Array, platform: Array, by_base: Array, by_platform: Array
) -> dict[str, float]:
    """What keeps the links as long as they are while joints are elsewhere: offsets count from the joints' distance."""
    link = platform - base
    unit = link / np.linalg.norm(link, axis=1)[:, None]
    longer = np.einsum("ij,ij->i", unit, by_platform - by_base)
    names = [f"{kind}_length_offset_{i}" for kind in ("actuator", "panhard") for i in (1, 2, 3)]
    return {name: -float(by) for name, by in zip(names, longer, strict=True)}


def _moved(side: str, by: Array) -> dict[str, float]:
    return {
        f"{side}_joint_{i + 1}_{a}": float(by[i, k]) for i in range(6) for a, k in _AXES.items()
    }


def _known(params: _core.LegParams) -> Iterator[tuple[str, dict[str, float]]]:
    base, platform = _joints(params, "base"), _joints(params, "platform")
    still = np.zeros_like(base)
    reference = np.array([params[f"reference_point_{a}"] for a in "xyz"])
    for a, k in _AXES.items():
        by = np.zeros_like(base)
        by[:, k] = 1.0
        kept = _lengths_kept(base, platform, by, still)
        yield f"the ground's frame: all base joints moved along {a}", _moved("base", by) | kept
        kept = _lengths_kept(base, platform, still, by)
        yield (
            f"the platform's frame: all platform joints moved along {a}",
            _moved("platform", by) | kept,
        )
    for a, k in _AXES.items():
        axis = np.eye(3)[k]
        by = np.cross(axis, base)
        kept = _lengths_kept(base, platform, by, still)
        yield f"the ground's frame: all base joints turned about {a}", _moved("base", by) | kept
        by = np.cross(axis, platform - reference)
        kept = _lengths_kept(base, platform, still, by)
        yield (
            f"the platform's frame: all platform joints turned about {a}",
            _moved("platform", by) | kept,
        )
    gains = {f"sensor_gain_extension:{i}": -1.0 for i in (1, 2, 3)}
    # the platform's arms count from the reference point, so that it grows with them about that point
    grown = _moved("base", base) | _moved("platform", platform - reference)
    kept = _lengths_kept(base, platform, base, platform - reference)
    links = np.linalg.norm(platform - base, axis=1)
    for i, (name, by_offset) in enumerate(list(kept.items())):
        offset = params[name]
        kept[name] = by_offset + float(links[i]) + offset
    yield "the scale: all joints, lengths and extensions by one factor", grown | kept | gains
    for i in (1, 2, 3):
        yield (
            f"the zero of extension sensor {i} against the length of actuator {i}",
            {f"sensor_offset_extension:{i}": 1.0, f"actuator_length_offset_{i}": 1.0},
        )
