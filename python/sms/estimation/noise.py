"""The noise of a sample: as declared, else from how neighbours differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.arrays import Array
from sms.estimation.kind import Kind
from sms.estimation.run import Run
from sms.io.rig import Rig
from sms.io.signals import SIGNALS, without_leg

FINEST = 2.0**-16
"""Of what runs usually sweep, or such a sensor reads: the step of the finest converters on such rigs. Where no noise is
declared, none smaller than what rounding to it makes is believed, as that of a simulation, or of a signal at rest.
"""


def noise_of(rig: Rig, kind: Kind, runs: Sequence[Run]) -> dict[str, float]:
    """Standard deviation of one sample of each output, SI: as declared, else from how neighbours differ.

    1 where residuals stay in the unit of the signal.
    """
    if not kind.whitened:
        return dict.fromkeys(kind.outputs, 1.0)
    noise = {}
    for signal in kind.outputs:
        source = rig.signals.get(signal)
        declared = None if source is None else source.noise
        steps = [sample_noise(r.signals[signal]) for r in runs if signal in r.signals]
        measured = max(float(np.median(steps)) if steps else 1.0, _finest(signal))
        if signal in kind.computed:
            measured = kind.computed[signal]
        resolution = 0.0 if source is None else source.resolution
        noise[signal] = max(declared or measured, resolution / np.sqrt(12.0))
    return noise


def sample_noise(values: Array) -> float:
    """From third differences, which a smooth motion hardly has; of rounded readings at least what rounding makes."""
    by_differences = float(np.median(np.abs(np.diff(values, 3))) / 0.6745 / np.sqrt(20.0))
    return max(by_differences, rounding_step(values) / float(np.sqrt(12.0)))


def rounding_step(values: Array) -> float:
    """The smallest step between readings of which most are there more than once; 0 where they are not, or all alike."""
    levels = np.unique(values)
    steps = np.diff(levels)
    steps = steps[steps > 1e-12 * np.max(np.abs(levels))]  # less is the last digit of one level
    return float(steps.min()) if steps.size and 2 * levels.size <= values.size else 0.0


def _finest(signal: str) -> float:
    info = SIGNALS[without_leg(signal)]
    return FINEST * (info.sweep or info.high - info.low) / float(np.sqrt(12.0))
