"""The closed-loop chirps (section 7.3.5): heave, roll and pitch, P = 2, 0.05 to 1 Hz in 60 s."""

from __future__ import annotations

import math

import numpy as np

from sms.scenario import Record
from sms.validation.figures import FIGURES, Row
from sms.validation.runs import response_at, run

_LEADING = 1  # actuator 2, always excited
_END = 0.92, 1.0  # Hz, the last of the sweep: one bin of 60 s alone is noisy
_SLOW = 0.08, 0.12  # Hz
_HALF_BAND = 0.03  # Hz
_HALF_POWER = 1.0 / math.sqrt(2.0)


def heave() -> list[Row]:
    """Gain, phase and bandwidth of actuator 2."""
    record = run("chirp_heave")
    gain, phase = gain_and_phase(record)
    slow = _response(record, *_SLOW)
    remark = f"over {_END[0]:g} to {_END[1]:g} Hz, where the sweep ends"
    return [
        FIGURES["heave_gain"].row(gain, remark),
        FIGURES["heave_phase"].row(phase, remark),
        FIGURES["heave_phase_slow"].row(math.degrees(np.angle(slow))),
        FIGURES["heave_bandwidth"].row(bandwidth(record)),
    ]


def roll() -> list[Row]:
    """Bandwidth; actuator 1 is held, 2 and 3 go opposite ways."""
    return [FIGURES["roll_bandwidth"].row(bandwidth(run("chirp_roll")))]


def pitch() -> list[Row]:
    """Bandwidth; actuator 1 goes against 2 and 3."""
    return [FIGURES["pitch_bandwidth"].row(bandwidth(run("chirp_pitch")))]


def bandwidth(record: Record) -> float:
    """The first frequency at which actuator 2 gives less than -3 dB, Hz; 1 Hz if there is none."""
    for centre in np.arange(0.1, 1.0, 0.01):
        gain = abs(_response(record, centre - _HALF_BAND, centre + _HALF_BAND))
        if gain < _HALF_POWER:
            return float(centre)
    return 1.0


def gain_and_phase(record: Record) -> tuple[float, float]:
    """Of actuator 2 at the end of the sweep, dB and degrees."""
    end = _response(record, *_END)
    return 20.0 * math.log10(abs(end)), math.degrees(np.angle(end))


def _response(record: Record, low: float, high: float) -> complex:
    period = float(record.time[1] - record.time[0])
    x, y = record.setpoint[:, _LEADING], record.extension[:, _LEADING]
    return response_at(x, y, period, low, high)
