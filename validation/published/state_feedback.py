"""Which candidate turns the limit cycle of (40, 1, -0.005) into the published step response?

Facts of section 8.2: rise 0.5672 s, no overshoot, no motion left at loop gains of 1 and 15 (and 0.5,
looked at when a value is found), a rise time that does not depend on the loop gain above 1. A
forward search: every candidate alone, the best kept, the next best ones on top of it. Twice, because
the source has the rates from two places: from differentiators on the controller, whose corner is not
published (100 rad/s is assumed), and as states of the co-simulation's plant (section 7.3.1), next to
no lag, for which a corner of 1000 rad/s stands. What a candidate is not asked for, the limit cycle
without acceleration feedback (K_a = 0), is looked at afterwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from multiprocessing import Pool

import numpy as np
from sms.validation.steps import HOLD, LOOP_GAINS, feedback, worst

from validation.published.candidates import STATE_FEEDBACK, Candidate, Settings

RISE, MOTION, OVERSHOOT = 0.5672, 2e-3, 0.01  # s, m, 1
RISE_BAND, SAME_BAND = 0.05, 0.1  # relative
ROUNDS = 2
SOURCES: dict[str, dict[str, float]] = {
    "differentiators, 100 rad/s": {},
    "states of the plant": {"differentiator_corner": 1000.0},
}
_GRID, _HALVINGS = 7, 3
_CARRIED = 6  # candidates that go on into the next round
_PROCESSES = 2
_SHORT = 2.0  # s, of each level while searching


@dataclass(frozen=True)
class Outcome:
    """One plant and controller against the facts."""

    settings: dict[str, float]
    rise: float  #: up, loop gain 1, s
    overshoot: float  #: the larger of up and down, loop gain 1
    motion: tuple[float, ...]  #: left at loop gains 1 and 15, and 0.5 when complete, m
    sameness: float  #: rise at 15 over that at 1

    def departures(self) -> tuple[float, ...]:
        """Of each fact, in bands: up to 1 agrees."""
        return (
            _logarithm(self.rise / RISE) / RISE_BAND,
            max(self.overshoot, 0.0) / OVERSHOOT,
            *(motion / MOTION for motion in self.motion),
            _logarithm(self.sameness) / SAME_BAND,
        )

    @property
    def met(self) -> int:
        """How many facts agree: of five, or of six when complete."""
        return sum(departure <= 1.0 for departure in self.departures())

    @property
    def misfit(self) -> float:
        """Mean over the facts of ln(1 + departure^2): one fact far out does not hide the others."""
        values = np.nan_to_num(np.array(self.departures()), nan=1e3, posinf=1e3)
        return float(np.log1p(values**2).mean())


@dataclass(frozen=True)
class Found:
    """The best value of a candidate on top of others."""

    candidate: Candidate
    value: float
    outcome: Outcome


def outcome_of(settings: Settings, complete: bool = True) -> Outcome:
    """Both steps at each loop gain; while searching two of them, and shorter."""
    low, one, fifteen = LOOP_GAINS
    hold = HOLD if complete else _SHORT
    own, high = (feedback({**settings, "loop_gain": gain}, hold) for gain in (one, fifteen))
    motion = [worst(own, "motion"), worst(high, "motion")]
    if complete:
        motion.append(worst(feedback({**settings, "loop_gain": low}), "motion"))
    return Outcome(
        settings=dict(settings),
        rise=own[0].rise,
        overshoot=worst(own, "overshoot"),
        motion=tuple(motion),
        sameness=high[0].rise / own[0].rise,
    )


def best_of(job: tuple[Candidate, Settings]) -> Found:
    """A candidate's best value: a grid, then halvings around its best point."""
    candidate, others = job

    def at(value: float) -> Found:
        settings = {**others, **candidate.settings(value)}
        return Found(candidate, value, outcome_of(settings, complete=False))

    tried = [at(float(value)) for value in candidate.grid(_GRID)]
    for _ in range(_HALVINGS):
        tried.sort(key=lambda found: found.value)
        best = min(range(len(tried)), key=lambda row: tried[row].outcome.misfit)
        near = [row for row in (best - 1, best + 1) if 0 <= row < len(tried)]
        side = min(near, key=lambda row: tried[row].outcome.misfit)
        tried.append(at(candidate.between(tried[best].value, tried[side].value)))
    best_found = min(tried, key=lambda found: found.outcome.misfit)
    return replace(best_found, outcome=outcome_of(best_found.outcome.settings))


def search(base: Settings, rounds: int = ROUNDS) -> list[list[Found]]:
    """For each round its candidates, best first; the best of a round stays for the next."""
    kept = dict(base)
    candidates: tuple[Candidate, ...] = STATE_FEEDBACK
    answer = []
    for _ in range(rounds):
        jobs = [(c, kept) for c in candidates if not set(c.parameters) & set(kept)]
        with Pool(_PROCESSES) as pool:
            found = sorted(pool.map(best_of, jobs, chunksize=1), key=lambda f: f.outcome.misfit)
        answer.append(found)
        kept = found[0].outcome.settings
        candidates = tuple(f.candidate for f in found[:_CARRIED])
    return answer


def without_acceleration(settings: Settings) -> float:
    """Motion left with K_a = 0, the largest over the loop gains, m; published: a limit cycle."""
    zero = {**settings, "acceleration_gain": 0.0}
    return max(worst(feedback({**zero, "loop_gain": gain}), "motion") for gain in LOOP_GAINS)


def _logarithm(ratio: float) -> float:
    return abs(math.log(ratio)) if ratio > 0.0 else math.inf
