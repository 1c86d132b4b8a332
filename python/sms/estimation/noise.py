"""The noise of a sample: as declared, else from how neighbours differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.arrays import Array
from sms.estimation.kind import Kind
from sms.estimation.run import Run
from sms.io.rig import Rig


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
        measured = float(np.median(steps)) if steps else 1.0
        if signal in kind.computed:
            measured = kind.computed[signal]
        resolution = 0.0 if source is None else source.resolution
        noise[signal] = max(declared or measured, resolution / np.sqrt(12.0), 1e-12)
    return noise


def sample_noise(values: Array) -> float:
    """From third differences, which a smooth motion hardly has."""
    return float(np.median(np.abs(np.diff(values, 3))) / 0.6745 / np.sqrt(20.0))
