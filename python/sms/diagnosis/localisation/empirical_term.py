"""The curve of what is not explained, carried along as a term: a better prediction, and no explanation.

The curve was fitted to the identify records, and as much of it is carried as they confirm of each other
(localisation/unknown_inputs.py). On records that it has not seen the simulation is corrected by it to first order, the
initial states of the windows and the known parameters following within what is declared.
"""

from __future__ import annotations

import numpy as np

from sms.arrays import Array
from sms.diagnosis.evidence import gains_on
from sms.diagnosis.fitting import nuisance_of
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.localisation.unknown_inputs import with_curve
from sms.diagnosis.other_records import refitted_on
from sms.diagnosis.remainder import Shape
from sms.diagnosis.result import Empirical, Gain


def empirical_of(
    baseline: Fitted, data: Data, shape: Shape, floor: Array, rng: np.random.Generator
) -> Empirical:
    """What the curve is worth on each record that was not fitted; floor (channels,) as in Excess."""
    gains: list[Gain] = []
    for runs in (data.validate, data.test):
        if runs is not None:
            there = refitted_on(baseline, runs)
            before = there.fit.residual
            after = before + with_curve(runs, nuisance_of(there), there.params, shape)
            gains += gains_on(runs, (before, after), (before, after), floor, rng)
    return Empirical(shape, tuple(gains))


def table_of(empirical: Empirical) -> str:
    """What is carried of the curve as CSV, columns `name [unit]`."""
    shape = empirical.shape
    header = (
        f"{shape.signal},{shape.equation} [{shape.unit}],half width of 95 percent [{shape.unit}]"
    )
    rows = (
        f"{at:.9g},{shape.confirmed * value:.9g},{shape.confirmed * band:.3g}"
        for at, value, band in zip(shape.at, shape.value, shape.band, strict=True)
    )
    return "\n".join((header, *rows)) + "\n"
