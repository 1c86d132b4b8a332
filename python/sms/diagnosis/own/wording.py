"""What is said of a plant of one's own beside what is said of a rig."""

from __future__ import annotations

import numpy as np

from sms.diagnosis.remainder import Shape
from sms.units_display import format_quantity
from sms.units_display import words as spaced

ACTS = 0.1
"""Of its largest value: from where a missing term is said to act. Judgement."""


def where_it_acts(shape: Shape) -> list[str]:
    """ "The missing term acts where upper level is above 9.8 V": a sentence, or none for a curve without such a place.

    A point acts where the curve is beyond its band. Between one that does and one that does not, it is said to begin at
    the latter: the curve is a straight line from there.
    """
    value, band = np.abs(shape.value), np.array(shape.band)
    acts = (value > band) & (value > ACTS * np.max(value))
    changes = np.flatnonzero(np.diff(acts.astype(int)))
    if len(changes) != 1:
        return []
    begins = bool(acts[-1])
    place = shape.at[changes[0] if begins else changes[0] + 1]
    signal, _, unit = shape.signal.removesuffix("]").partition(" [")
    side = "above" if begins else "below"
    largest = shape.value[int(np.argmax(value))]
    return [
        f"The missing term of the {spaced(shape.equation)} acts where {spaced(signal)} is {side} "
        f"{format_quantity(place, unit, signal)}; it goes up to {format_quantity(largest, shape.unit)}."
    ]
