"""The course of one size over all diagnoses of a machine: its points, and what they say of it.

A cause that a diagnosis does not name has its neutral value there, within the size L from which the records would have
shown it: an unknown within +-L, evenly, whose standard deviation is L / sqrt(3) (GUM, 4.3.7). A diagnosis that could
not have shown it, or that explains nothing (unknown, data-fault), has no point.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from sms.arrays import Array
from sms.diagnosis.thresholds import DETECTION
from sms.history.answer import Answer, Estimate, Explanation
from sms.history.change_point import ChangePoint, change_point
from sms.history.multiple import COVERAGE, LEVEL, holm
from sms.history.trend import Line, Reached, line_through, reaches

State = Literal["named", "not named", "fitted", "fitted beside a cause"]
EACH = LEVEL / 2.0
"""Chance of a change that is none among all courses, and of a trend that is none: together `LEVEL`."""
COUNTED: tuple[State, ...] = ("named", "not named", "fitted")
"""Points from which trend and change are judged."""


@dataclass(frozen=True)
class Point:
    """One diagnosis' word on a size, SI."""

    number: int
    """Of the diagnosis, from 0."""
    time: float
    """s since 1970."""
    value: float
    standard_error: float
    low: float
    high: float
    """95 percent interval; of a cause that is not named, what its records leave possible."""
    state: State
    limit: float | None = None
    """Of what is not named: its shift might be this large; None: the value is an estimate."""


@dataclass(frozen=True)
class Course:
    """One size over time."""

    about: Literal["cause", "model"]
    key: str
    title: str
    parameter: str
    unit: str
    neutral: float
    points: tuple[Point, ...]
    change: ChangePoint | None = None
    """The best one; whether it is one says `changed`."""
    changed: bool = False
    trend: Line | None = None
    moves: bool = False
    """Whether its trend is not zero, of all trends together at 2.5 percent."""
    reached: Reached | None = None

    @property
    def counted(self) -> tuple[Point, ...]:
        """The points from which it is judged, in order."""
        return tuple(p for p in self.points if p.state in COUNTED)

    @property
    def first_named(self) -> int | None:
        """Number of the first diagnosis that names it."""
        return next((p.number for p in self.points if p.state == "named"), None)

    @property
    def appeared(self) -> bool:
        """Whether it is named for the first time after a diagnosis that could have named it."""
        return self.points[0].state == "not named" and self.first_named is not None

    @property
    def went_away(self) -> bool:
        """Whether the last diagnosis would have shown it as large as it was named last: by 1.96 standard errors of both
        beyond its estimate, or beyond its limit, as two diagnoses are compared (difference.py)."""
        last = self.points[-1]
        named = [p for p in self.points if p.state == "named"]
        if last.state != "not named" or not named:
            return False
        if last.limit is None:
            shift, error = abs(named[-1].value - last.value), last.standard_error
        else:
            shift = abs(named[-1].value - self.neutral) - last.limit
            error = last.limit / DETECTION
        return shift > COVERAGE * math.hypot(named[-1].standard_error, error)

    @property
    def grows(self) -> bool:
        """Whether it moves away from its neutral value."""
        if self.trend is None or not self.moves:
            return False
        return self.trend.slope * (self.points[-1].value - self.neutral) > 0.0

    @property
    def onset(self) -> tuple[Point, Point, Point] | None:
        """First changed estimate, and between which two it lies with 95 percent."""
        if self.change is None or not self.changed:
            return None
        c, points = self.change, self.counted
        return points[c.first], points[c.earliest], points[c.latest]


def courses_of(answers: Sequence[Answer], limits: dict[str, float]) -> list[Course]:
    """Each cause's, then each parameter's of the declared model. answers: in the order of measurement."""
    found = [_cause_course(group, answers) for group in _groups(answers)]
    found += _model_courses(answers)
    return _judged([course for course in found if course.points], limits)


def _groups(answers: Sequence[Answer]) -> list[list[Explanation]]:
    """Explanations that were one class in any diagnosis, the one most often named first."""
    groups: list[dict[str, list[Explanation]]] = []
    for members in (m for answer in answers for m in answer.causes):
        keys = {m.key for m in members}
        joined = [g for g in groups if keys & g.keys()]
        merged: dict[str, list[Explanation]] = {}
        for group in joined:
            groups.remove(group)
            merged |= group
        for member in members:
            merged.setdefault(member.key, []).append(member)
        groups.append(merged)
    return [[max(g.values(), key=len)[0], *(m[0] for m in g.values())] for g in groups]


def _cause_course(group: Sequence[Explanation], answers: Sequence[Answer]) -> Course:
    stands = group[0]
    size = stands.estimates[0]
    errors = [
        e.standard_error
        for a in answers
        if (m := a.named(stands.key)) is not None
        and math.isfinite((e := m.estimates[0]).standard_error)
    ]
    usual = DETECTION * float(np.median(errors)) if errors else math.nan
    points = []
    for number, answer in enumerate(answers):
        named = answer.named(stands.key)
        if named is not None:
            point = _estimated(number, answer, named.estimates[0], "named")
        elif any(answer.named(m.key) for m in group):
            continue  # named as another of its class, whose size is one of another kind
        else:
            point = _not_named(number, answer, stands, size, usual)
        if point is not None:
            points.append(point)
    return Course(
        "cause", stands.key, stands.title, size.parameter, size.unit, size.neutral, tuple(points)
    )


def _estimated(number: int, answer: Answer, found: Estimate, state: State) -> Point | None:
    error = found.standard_error
    if not math.isfinite(found.value) or not math.isfinite(error):
        return None
    reach = COVERAGE * error
    time = answer.measured.timestamp()
    return Point(number, time, found.value, error, found.value - reach, found.value + reach, state)


def _not_named(
    number: int, answer: Answer, stands: Explanation, size: Estimate, usual: float
) -> Point | None:
    """None where this diagnosis could not have named it. usual: the limit, where it does not say one."""
    if not answer.judges or stands.key in answer.not_testable:
        return None
    if (estimate := answer.not_named(stands)) is not None:
        return _estimated(number, answer, estimate, "not named")
    limit = answer.limits.get(stands.key, math.nan)
    limit = limit if math.isfinite(limit) else usual
    if not math.isfinite(limit) or limit <= 0.0:
        return None
    declared = answer.declared.get("parameters", {}).get(size.parameter, {})
    value = float(declared.get("value", size.neutral))
    time = answer.measured.timestamp()
    error = limit / math.sqrt(3.0)
    return Point(number, time, value, error, value - limit, value + limit, "not named", limit)


def _model_courses(answers: Sequence[Answer]) -> list[Course]:
    """Parameters of which two diagnoses have an estimate."""
    estimates: dict[str, list[tuple[int, Answer, Estimate]]] = {}
    for number, answer in enumerate(answers):
        for e in answer.model:
            if math.isfinite(e.standard_error):
                estimates.setdefault(e.parameter, []).append((number, answer, e))
    found = []
    for name, seen in estimates.items():
        points = [
            _estimated(n, a, e, "fitted" if a.verdict == "no-evidence" else "fitted beside a cause")
            for n, a, e in seen
        ]
        kept = tuple(p for p in points if p is not None)
        last = seen[-1][2]
        if len(kept) > 1:
            found.append(Course("model", "", "", name, last.unit, last.neutral, kept))
    return found


# ---- judgement -------------------------------------------------------------------------------------


def _judged(courses: Sequence[Course], limits: dict[str, float]) -> list[Course]:
    """With change, trend and date, all judged together."""
    changes = [change_point(*_arrays(c.counted)) for c in courses]
    chances = holm([math.nan if c is None else c.p_value for c in changes])
    out = [
        replace(course, change=change, changed=bool(chance < EACH))
        for course, change, chance in zip(courses, changes, chances, strict=True)
    ]
    lines = [line_through(*_arrays(_since_change(c))) for c in out]
    chances = holm([math.nan if x is None else x.p_value for x in lines])
    return [
        replace(
            course,
            trend=line,
            moves=bool(chance < EACH),
            reached=reaches(line, limits[course.parameter])
            if line is not None and chance < EACH and course.parameter in limits
            else None,
        )
        for course, line, chance in zip(out, lines, chances, strict=True)
    ]


def _since_change(course: Course) -> tuple[Point, ...]:
    """The points on the course that it is on now."""
    points = course.counted
    if course.change is None or not course.changed:
        return points
    # A ramp begins at the last estimate before the first changed one.
    begin = course.change.first - (1 if course.change.course == "ramp" else 0)
    return points[max(begin, 0) :]


def _arrays(points: Sequence[Point]) -> tuple[Array, Array, Array]:
    return (
        np.array([p.time for p in points]),
        np.array([p.value for p in points]),
        np.array([p.standard_error for p in points]),
    )
