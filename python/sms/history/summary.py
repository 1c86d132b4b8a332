"""The whole history of a machine: every diagnosis in the order of its records' time, and what became of each size."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from sms.errors import InputError, did_you_mean
from sms.history import wording
from sms.history.answer import Answer
from sms.history.course import Course, courses_of
from sms.history.declared import changes
from sms.history.store import Machine
from sms.io.units import to_si


@dataclass(frozen=True)
class Entry:
    """One diagnosis."""

    measured: str
    date: str
    """For a person: with the time of day where another diagnosis has the same date."""
    measured_from: str
    verdict: str
    sentence: str
    causes: tuple[str, ...]
    changed_in_rig_file: tuple[str, ...]
    """Since the diagnosis before it."""
    source: str
    digest: str


@dataclass(frozen=True)
class History:
    """What `sms history` says."""

    machine: Machine
    entries: tuple[Entry, ...]
    courses: tuple[Course, ...]
    sentences: tuple[str, ...]
    lacks: tuple[str, ...]

    def to_dict(self) -> dict[str, Any]:
        """The contents of the JSON file; times of points in s since 1970, all else in SI."""
        return {
            "machine": asdict(self.machine),
            "sentences": list(self.sentences),
            "diagnoses": [asdict(e) for e in self.entries],
            "courses": [_course(c) for c in self.courses],
            "lacks": list(self.lacks),
        }


def history_of(
    machine: Machine, answers: Sequence[Answer], limits: Mapping[str, str] | None = None
) -> History:
    """answers: of one machine, in any order. limits: parameter -> a size with or without its unit, "5e-10"."""
    ordered = sorted(answers, key=lambda a: a.measured)
    courses = courses_of(ordered, _limits_si(limits or {}, ordered))
    entries = []
    shown = wording.dates([a.measured.timestamp() for a in ordered])
    for number, answer in enumerate(ordered):
        before = changes(ordered[number - 1], answer) if number else []
        entries.append(
            Entry(
                answer.measured.isoformat(timespec="seconds"),
                shown[number],
                answer.measured_from,
                answer.verdict,
                answer.sentence,
                tuple(members[0].title or members[0].key for members in answer.causes),
                tuple(before),
                answer.source,
                answer.digest,
            )
        )
    said = wording.sentences(courses) if len(ordered) > 1 else ["One diagnosis has no history yet."]
    lacks = tuple(dict.fromkeys(text for a in ordered for text in _lacks(a)))
    return History(machine, tuple(entries), tuple(courses), tuple(said), lacks)


def _lacks(answer: Answer) -> list[str]:
    """What it does not say, but for the time where that was said when it was added."""
    if answer.measured_from != "stated":
        return list(answer.lacks)
    return [text for text in answer.lacks if "measured" not in text]


def _limits_si(limits: Mapping[str, str], answers: Sequence[Answer]) -> dict[str, float]:
    units = {
        e.parameter: e.unit
        for a in answers
        for e in (*a.model, *(x for members in a.causes for m in members for x in m.estimates))
    }
    found = {}
    for name, text in limits.items():
        if name not in units:
            known = f"; {did_you_mean(name, units)}" if units else ""
            raise InputError(
                f"--limit {name}: no diagnosis of this history has this parameter{known}"
            )
        found[name] = _size(text, units[name], f"--limit {name}")
    return found


def _size(text: str, unit: str, where: str) -> float:
    """A plain number is in SI."""
    try:
        number = float(text)
    except ValueError:
        return to_si(text, unit, where)
    if not math.isfinite(number):
        raise InputError(f"{where}: '{text}' is no size; write a number")
    return number


def _course(course: Course) -> dict[str, Any]:
    found = asdict(course)
    onset = course.onset
    return found | {
        "appeared": course.appeared,
        "went_away": course.went_away,
        "grows": course.grows,
        "first_named": course.first_named,
        "onset": None if onset is None else [p.number for p in onset],
        "in_words": wording.sentences([course]),
    }
