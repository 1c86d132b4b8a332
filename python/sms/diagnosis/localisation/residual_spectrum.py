"""What is wrong, signal by signal: by how much, when most, and at which frequencies.

From the baseline's error within its windows, on the records that it was not fitted to. An initial state is free in each
window, so that what is slower than a window is not seen here.
"""

from __future__ import annotations

import numpy as np

from sms.arrays import Array
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import unseen
from sms.diagnosis.remainder import Symptom
from sms.diagnosis.thresholds import POWER_SHARE
from sms.estimation.problem import Window
from sms.estimation.windows import Runs


def symptoms_of(baseline: Fitted, data: Data, floor: Array) -> tuple[Symptom, ...]:
    """One a signal, in the order of the problem; floor (channels,) of the noise, in units of the declared one."""
    runs = data.validate
    residual = unseen(baseline, data)
    return tuple(
        _symptom(runs, residual, c, float(np.sqrt(floor[c]))) for c in range(len(runs.channels))
    )


def _symptom(runs: Runs, residual: Array, channel: int, floor: float) -> Symptom:
    name, windows = runs.channels[channel], runs.problem.windows
    scale = runs.noise[name]
    errors = [_error(runs, residual, w, channel) for w in windows]
    power = np.array([np.mean(e**2) for e in errors])
    worst = windows[int(np.argmax(power))]
    time = runs.motions[worst.record].time
    every = float(np.mean(np.concatenate(errors) ** 2))
    beyond = np.maximum(power - floor**2, 0.0)
    return Symptom(
        signal=name,
        unit=runs.kind.units[name],
        rms=scale * float(np.sqrt(every)),
        noise=scale * floor,
        speaks=every > (1.0 + runs.kind.practically_significant[1]) * floor**2,
        record=runs.motions[worst.record].name,
        begin=float(time[worst.first] - time[0]),
        end=float(time[worst.first + worst.samples - 1] - time[0]),
        share=float(beyond.max() / max(beyond.sum(), 1e-300)),
        below=_below(errors, runs.motions[0].step),
    )


def _error(runs: Runs, residual: Array, window: Window, channel: int) -> Array:
    rows = residual[window.row : window.row + window.rows]
    return np.asarray(rows.reshape(window.samples, len(runs.channels))[:, channel])


def _below(errors: list[Array], step: float) -> float:
    """Hz below which most of the power lies, less that of the noise, which is alike at all frequencies."""
    samples = min(len(e) for e in errors)
    spectrum = np.mean([np.abs(np.fft.rfft(e[:samples])) ** 2 for e in errors], axis=0)
    spectrum[1:-1] *= 2.0
    noise = float(np.median(spectrum[len(spectrum) // 2 :]))
    grown = np.cumsum(np.maximum(spectrum - noise, 0.0))
    frequency = np.fft.rfftfreq(samples, step)
    return float(frequency[int(np.searchsorted(grown, POWER_SHARE * grown[-1]))] + frequency[1])
