"""Two days of one machine, diagnosed and compared: what the trials of pairs share."""

from __future__ import annotations

from datetime import UTC, datetime

from sms.demo.hidden import key_of
from sms.diagnosis import Diagnosis
from sms.diagnosis.effects.catalogue import catalogue
from sms.diagnosis.result import as_json
from sms.history import Answer, compare, read_answer

from validation.trials.answers import key_of as of_effect

WHEN = datetime(2026, 1, 15, tzinfo=UTC)
"""Stands for the day of either: they are told apart by their names."""


def as_answer(diagnosis: Diagnosis, name: str) -> Answer:
    """What `sms compare-diagnoses` reads of it."""
    return read_answer(as_json(diagnosis), name, WHEN)


def called_changed(kind: str, first: Answer, second: Answer) -> list[list[str]]:
    """What is called changed: of a cause its members, of a number of the declared model that and the effects that shift
    it."""
    explanations = {
        member.key: [key_of(m.effect, m.signal) for m in members]
        for answer in (first, second)
        for members in answer.causes
        for member in members
    }
    found = []
    for item in compare(first, second).items:
        if item.change == "changed" and item.about == "cause":
            found.append(explanations[item.key])
        elif item.change == "changed":
            shifts = [of_effect(e) for e in catalogue(kind) if item.parameter in e.parameters]
            found.append([item.parameter, *shifts])
    return found
