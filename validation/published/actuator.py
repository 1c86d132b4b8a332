"""What brings the bench's travel, the chirp's gain and the speeds together, which one mass-flow gain cannot?

Facts: 87 mm of travel on the bench (section 7.2), -11 dB and -80 to -100 deg of the heave chirp at
1 Hz (section 8.1), 0.1 m/s per V at 5 V and 0.85 at 0.5 V (section 8.1). For every value of a
candidate the mass-flow gain is what gives -11 dB; the other facts then tell the candidates apart,
for both readings of the bench's 0.54 V: amplitude, and peak to peak. The chirp is replaced by a sine
at the frequency where its gain is read, which gives the same (a test holds that) in a tenth of the
time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from multiprocessing import Pool

import numpy as np
from sms import _core
from sms._core import Params
from sms.motion.speed import steady_motion
from sms.validation.actuator import share_of_weight, travel
from sms.validation.runs import response_at, run

from validation.published.candidates import ACTUATOR, Candidate, Settings

TRAVEL, GAIN, PHASE = 0.087, -11.0, -90.0  # m, dB, deg
SPEEDS = {5.0: 0.1, 0.5: 0.85}  # V: m/s per V
READINGS = {"amplitude": "0.54 V", "peak to peak": "0.27 V"}
_BANDS = {"travel": 0.08, "gain": 1.0, "phase": 10.0, "speed": 0.1}  # relative, dB, deg, relative
_AT, _LASTS, _SETTLED = 0.96, 6.25, 2.08  # Hz, s, s: two periods, then four that are looked at
_GAINS = 0.5, 8.0
_SECANTS, _CLOSE = 6, 0.05  # steps at most; dB
_GRID, _HALVINGS = 5, 2
_PROCESSES = 2


@dataclass(frozen=True)
class Outcome:
    """One plant against the facts."""

    settings: dict[str, float]
    reading: str
    travel: float  #: m
    gain: float  #: dB
    phase: float  #: deg
    speed_open: float  #: m/s per V
    speed_small: float

    def departures(self) -> tuple[float, ...]:
        """Of each fact, in bands: up to 1 agrees."""
        return (
            _logarithm(self.travel / TRAVEL) / _BANDS["travel"],
            abs(self.gain - GAIN) / _BANDS["gain"],
            abs(self.phase - PHASE) / _BANDS["phase"],
            _logarithm(self.speed_open / SPEEDS[5.0]) / _BANDS["speed"],
            _logarithm(self.speed_small / SPEEDS[0.5]) / _BANDS["speed"],
        )

    @property
    def met(self) -> int:
        """How many of the five facts agree."""
        return sum(departure <= 1.0 for departure in self.departures())

    @property
    def misfit(self) -> float:
        """Mean over the facts of ln(1 + departure^2)."""
        return float(np.log1p(np.array(self.departures()) ** 2).mean())


@dataclass(frozen=True)
class Found:
    """The best value of a candidate, together with the mass-flow gain; None: the gain alone."""

    candidate: Candidate | None
    value: float
    outcome: Outcome


def outcome_of(settings: Settings, reading: str) -> Outcome:
    """The bench, one frequency of the chirp, two steady speeds."""
    return _outcome(settings, reading, sine_response(settings))


def _outcome(settings: Settings, reading: str, response: tuple[float, float]) -> Outcome:
    bench = run("bench_sine", settings, excitation={"amplitude": READINGS[reading]})
    small, wide = (_speed(settings, volts) for volts in (0.5, 5.0))
    return Outcome(dict(settings), reading, travel(bench), *response, wide, small)


def sine_response(settings: Settings) -> tuple[float, float]:
    """Gain (dB) and phase (deg) of actuator 2 in heave at one frequency, P = 2."""
    record = run(
        "chirp_heave",
        settings,
        scenario={"duration": f"{_LASTS} s"},
        excitation={"first": f"{_AT} Hz", "last": f"{_AT} Hz"},
    )
    late = record.time >= _SETTLED
    periods = math.floor((_LASTS - _SETTLED) * _AT)
    rows = np.flatnonzero(late)[: round(periods / _AT / (record.time[1] - record.time[0]))]
    period = float(record.time[1] - record.time[0])
    x, y = record.setpoint[rows, 1], record.extension[rows, 1]
    value = response_at(x, y, period, 0.9 * _AT, 1.1 * _AT)
    return 20.0 * math.log10(abs(value)), math.degrees(np.angle(value))


def at_published_gain(settings: Settings) -> list[Outcome]:
    """With the mass-flow gain that gives -11 dB, for both readings of the bench's voltage.

    A secant over the gain's logarithm, in which the response is nearly straight.
    """
    low, high = (math.log(gain) for gain in _GAINS)
    x, slope = math.log(2.0), 8.7  # dB per unit of ln(gain), as if the response were in proportion
    last: tuple[float, float] | None = None
    for _ in range(_SECANTS):
        wanted = {**settings, "mass_flow_gain": math.exp(x)}
        response = sine_response(wanted)
        error = response[0] - GAIN
        if abs(error) < _CLOSE:
            break
        if last is not None and abs(x - last[0]) > 1e-9:
            slope = max((error - last[1]) / (x - last[0]), 2.0)
        last = x, error
        x = min(max(x - error / slope, low), high)
    return [_outcome(wanted, reading, response) for reading in READINGS]


def best_of(job: tuple[Candidate | None, Settings]) -> list[Found]:
    """The best value of a candidate for each reading; None: the mass-flow gain alone."""
    candidate, others = job
    if candidate is None:
        return [Found(None, math.nan, outcome) for outcome in at_published_gain(others)]
    tried: dict[float, list[Outcome]] = {}

    def misfit(value: float) -> float:
        return min(outcome.misfit for outcome in tried[value])

    def attempt(value: float) -> None:
        tried[value] = at_published_gain({**others, **candidate.settings(value)})

    for value in candidate.grid(_GRID):
        attempt(float(value))
    for _ in range(_HALVINGS):
        values = sorted(tried)
        best = min(range(len(values)), key=lambda row: misfit(values[row]))
        near = [row for row in (best - 1, best + 1) if 0 <= row < len(values)]
        side = min(near, key=lambda row: misfit(values[row]))
        attempt(candidate.between(values[best], values[side]))
    return [
        min(
            (Found(candidate, value, outcomes[k]) for value, outcomes in tried.items()),
            key=lambda found: found.outcome.misfit,
        )
        for k in range(len(READINGS))
    ]


def search() -> list[list[Found]]:
    """The gain alone and each candidate with it, best first; then all others on top of the best."""
    answer = [_ranked([(None, {}), *((c, {}) for c in ACTUATOR)])]
    best = next(found for found in answer[0] if found.candidate is not None)
    kept = {name: best.outcome.settings[name] for name in best.candidate.parameters}  # type: ignore[union-attr]
    jobs = [(c, kept) for c in ACTUATOR if not set(c.parameters) & set(kept)]
    return [*answer, _ranked(jobs)]


def _ranked(jobs: Sequence[tuple[Candidate | None, Settings]]) -> list[Found]:
    with Pool(_PROCESSES) as pool:
        found = [one for each in pool.map(best_of, jobs, chunksize=1) for one in each]
    return sorted(found, key=lambda one: one.outcome.misfit)


def _speed(settings: Settings, volts: float) -> float:
    """Steady, upwards under the load, m/s per V; NaN where there is none."""
    params = Params()
    for name, value in settings.items():
        params[name] = value
    command = float(_core.valve_command(params, volts))
    try:
        return steady_motion(command, share_of_weight(), params=params).velocity / volts
    except ValueError:
        return math.nan


def _logarithm(ratio: float) -> float:
    return abs(math.log(ratio)) if ratio > 0.0 else 50.0
