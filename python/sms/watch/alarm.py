"""An alarm: since when, where, and which effects fit how well, as a first guess.

The guess is by one linear step: of each effect the size that the score says, and what of the squares of all tests
together it takes. An effect far from its healthy value is another simulation, and two effects that look alike here
are not told apart: that is what the diagnosis is for that follows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.stats import t as student

from sms.arrays import Array
from sms.diagnosis.thresholds import DETECTION
from sms.units_display import display_unit, significant
from sms.watch.detector import LAGS, Detector, Look
from sms.watch.healthy import Baseline, Sums

SHOWN = 5
LEAST = 2
"""Segments that a guess takes: one alone does not show whether an effect has the same size in the next."""
ENDS = 0.75
"""Of the threshold, below which an alarm ends: one that is about there is not raised again and again. Judgement."""
SEEN = DETECTION
"""Standard errors."""
FITS = 0.5
"""Of the likelihood ratio of the best, as chi-square: an effect with less is not among those that fit. Judgement."""


@dataclass(frozen=True)
class Guess:
    """One effect that fits."""

    effect: str
    title: str
    parameter: str
    unit: str
    size: float
    """Change of the parameter since the machine was well, SI."""
    low: float
    high: float
    """Its interval of 95 %, to first order."""
    chi_square: float
    """What it takes of the likelihood ratio, its size within what is plausible."""
    freedom: float
    """With which the scatter is known that this is in units of: that of the healthy machine, or, where the segments
    scatter more, of these alone."""

    @property
    def likelihood_ratio(self) -> float:
        """The same where the scatter is not known beforehand, twice the logarithm. Two segments that happen to ask for
        nearly one size have hardly any scatter, and their chi-square has no bound."""
        return (self.freedom + 1.0) * float(np.log1p(self.chi_square / self.freedom))

    def __str__(self) -> str:
        """ "fitting leakage, lower chamber: +0.52 (0.41 to 0.63) g/(s MPa)"."""
        shown = display_unit(self.unit, self.size, self.parameter)
        size, low, high = (significant(shown.scale(v), 2) for v in (self.size, self.low, self.high))
        sign = "+" if self.size > 0.0 else ""
        return f"{self.title}: {sign}{size} ({low} to {high}) {shown.label}".rstrip()


@dataclass(frozen=True)
class Alarm:
    """What is said of a change while it stands."""

    number: int
    raised: float
    """s, in the time of the stream."""
    since: float
    """s: the onset that fits best."""
    test: str
    of: str
    """"effect", "signal" or "equation": what exceeded its threshold first."""
    z: float
    threshold: float
    places: tuple[tuple[str, str, float], ...]
    """Signals and equations whose innovations have grown, the most significant first: (which, "signal" or "equation",
    z)."""
    guesses: tuple[Guess, ...]
    """Effects that fit, the best first; none where no effect explains it."""
    segments: int = 0
    """Up to now, that the guesses are of."""

    @property
    def sentence(self) -> str:
        """For a person."""
        where = ""
        for of in ("equation", "signal"):
            named = [name for name, kind, _ in self.places if kind == of][:2]
            if named:
                where += f", {of} {' and '.join(named)}"
        what = (
            f"fits: {'; '.join(str(g) for g in self.guesses[:3])}"
            if self.guesses
            else "no effect of the catalogue fits"
        )
        return f"alarm {self.number}: since {self.since:.0f} s{where}; {what}"

    def to_dict(self) -> dict[str, Any]:
        """For the log."""
        return {
            "alarm": self.number,
            "raised_s": self.raised,
            "since_s": self.since,
            "test": self.test,
            "of": self.of,
            "z": self.z,
            "threshold": self.threshold,
            "segments": self.segments,
            "places": [{"name": n, "of": of, "z": z} for n, of, z in self.places],
            "guesses": [
                {
                    "effect": g.effect,
                    "parameter": g.parameter,
                    "unit": g.unit,
                    "size": g.size,
                    "interval": [g.low, g.high],
                    "chi_square": g.chi_square,
                }
                for g in self.guesses
            ],
            "sentence": self.sentence,
        }


@dataclass
class Judge:
    """Raises an alarm, refines what it says while it stands, and lets it end.

    It stands until every test at every onset is well below its threshold again: after a repair the longest stretches
    hold what was wrong for five minutes more. What comes after has to show itself in what comes after: the segments of
    an alarm that has ended raise no other.
    """

    detector: Detector
    standing: Alarm | None = None
    count: int = 0
    _lag: int = field(default=0, repr=False)

    def judge(self, look: Look) -> Alarm | None:
        """The alarm that stands after this look."""
        if look.highest < (1.0 if self.standing is None else ENDS):
            if self.standing is not None:
                self.detector.sums.clear()
            self.standing = None
            return None
        test = self.detector.baseline.tests[look.test]
        if self.standing is None:
            self.count += 1
            lag = self._lag = best_lag(self.detector, look)
            at = look.lags.index(look.lag)
            z, threshold = float(look.z[at, look.test]), float(self.detector.thresholds[look.test])
            first = (
                self.count,
                look.end,
                "effect" if test.effect else test.of,
                test.name,
                z,
                threshold,
            )
        else:
            a = self.standing
            # The stretch that was found first and all since, as long as they are held.
            lag = self._lag = min(self._lag + 1, len(self.detector.sums))
            first = (a.number, a.raised, a.of, a.test, a.z, a.threshold)
        stretch = self.detector.last(lag)
        number, raised, of, name, z, threshold = first
        guesses = guesses_of(self.detector.baseline, stretch)
        since = (
            onset(self.detector, look, guesses) if self.standing is None else self.standing.since
        )
        self.standing = Alarm(
            number,
            raised,
            since,
            name,
            of,
            z,
            threshold,
            places_of(self.detector.baseline, stretch),
            guesses,
            lag,
        )
        return self.standing


def best_lag(detector: Detector, look: Look) -> int:
    """Segments, up to now, that the effect which fits best explains best; of a change that no effect fits, those since
    the onset for the test that is highest."""
    found = [(0.0, look.lag)]
    for lag in (n for n in LAGS if LEAST <= n <= len(detector.sums)):
        guesses = guesses_of(detector.baseline, detector.last(lag))
        found.append((max((g.likelihood_ratio for g in guesses), default=0.0), lag))
    return max(found)[1]


def onset(detector: Detector, look: Look, guesses: Sequence[Guess]) -> float:
    """s: the most likely beginning for the effect that fits best; of a change that no effect fits, for the test that is
    highest.

    By the detector's statistic, in which a segment counts only so much: one whose initial state went astray would begin
    the change after itself. Every segment can be the first: the grid on which the detector looks bounds its false
    alarms, and this is after the alarm.
    """
    tests = [t.name for t in detector.baseline.tests]
    test = tests.index(guesses[0].effect) if guesses else look.test
    lags = range(1, len(detector.sums) + 1)
    lag = max(lags, key=lambda n: abs(float(detector.z(n)[test])))
    return detector.last(lag)[0].begin


def sizes(baseline: Baseline, segments: Sequence[Sums]) -> tuple[Array, Array, Array]:
    """(t,) each: by how much each test's size is off from the healthy one, its standard error, and the freedom with
    which that is known.

    What an effect leaves of the segments counts in its error where it is more than healthy segments scatter: one that
    does not fit has another size in each.
    """
    shift, response, variance = (
        np.array([getattr(s, name) for s in segments]) for name in ("shift", "response", "variance")
    )
    total = response.sum(axis=0)
    told = total > 0.0
    size = shift.sum(axis=0) / np.where(told, total, np.inf) - baseline.mean
    error = baseline.error(total, variance.sum(axis=0))
    left = shift - (size + baseline.mean) * response
    healthy = np.maximum(baseline.inflation * variance.sum(axis=0), 1e-300)
    own = max(len(segments) - 1, 1)
    scatter = np.sum(left**2, axis=0) / healthy * len(segments) / own
    error = error * np.sqrt(np.maximum(scatter, 1.0))
    freedom = np.where(scatter > 1.0, np.minimum(own, baseline.freedom), baseline.freedom)
    return np.where(told, size, 0.0), np.where(told, error, np.inf), freedom


def places_of(baseline: Baseline, segments: Sequence[Sums]) -> tuple[tuple[str, str, float], ...]:
    """Energies that have grown by more than three standard errors."""
    size, error, _ = sizes(baseline, segments)
    found = [
        (t.name, t.of, float(size[k] / error[k]))
        for k, t in enumerate(baseline.tests)
        if t.effect is None and size[k] > 3.0 * error[k]
    ]
    return tuple(sorted(found, key=lambda f: -f[2]))


def guesses_of(baseline: Baseline, segments: Sequence[Sums]) -> tuple[Guess, ...]:
    """The effects that fit these segments; none of fewer than LEAST."""
    if len(segments) < LEAST:
        return ()
    size, error, freedom = sizes(baseline, segments)
    found = []
    for k, test in enumerate(baseline.tests):
        if test.effect is None or not np.isfinite(error[k]):
            continue
        step = float(np.clip(size[k], *test.room))
        gain = step * (2.0 * float(size[k]) - step) / float(error[k]) ** 2
        if gain < SEEN**2:
            continue
        half = float(student.ppf(0.975, freedom[k]) * error[k])
        found.append(
            Guess(
                test.name,
                test.effect.title,
                test.effect.parameters[0],
                test.unit,
                float(size[k]),
                float(size[k]) - half,
                float(size[k]) + half,
                gain,
                float(freedom[k]),
            )
        )
    found.sort(key=lambda g: -g.chi_square)
    return tuple(g for g in found[:SHOWN] if g.chi_square >= FITS * found[0].chi_square)
