"""Which column is which signal: the best fit of names and units first, no column twice.

A signal that is needed and has no column, or two that fit it alike, is a Question.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sms.draft.columns import Column, Columns
from sms.draft.given import Given, Question
from sms.draft.vocabulary import LETTER, OWN, STRONG, UNIT, WEAK, fit
from sms.errors import InputError, did_you_mean
from sms.io.signals import KINDS, LEGS, Kind, label, without_leg

ALIKE = 0.1  #: of two fits: what they must differ by, or the column can be either
_WHY = {
    OWN: "the name of the signal",
    STRONG: "by its name",
    WEAK: "by a short form in its name",
    LETTER: "by a letter or word that can mean it",
    UNIT: "the only column in a unit of it",
}


@dataclass(frozen=True)
class Match:
    """A column for a signal."""

    column: Column
    sure: bool
    why: str
    doubtful: bool = False


def assign(columns: Columns, kind: str, given: Given) -> dict[str, Match]:
    """Signal -> its column, in the order of the kind. Optional signals may lack."""
    known = KINDS[kind]
    _check_names(columns, known, given)
    found = {
        signal: Match(_column_said(columns, signal, name), True, "given")
        for signal, name in given.column.items()
    }
    first_leg = _first_leg(columns) if kind == "platform" else None
    fits = _fits(columns, known, found, first_leg, one_chamber=kind in ("tank", "cylinder"))
    while (best := _clearest(fits)) is not None:
        signal, name, worth = best
        column = next(c for c in columns.columns if c.name == name)
        found[signal] = Match(column, worth >= STRONG, _WHY[worth], worth == UNIT)
        fits.pop(signal)
        for others in fits.values():
            others.pop(name, None)
    if "time" not in found:
        found["time"] = _running(columns, found)
    for signal in known.needed:
        if signal not in found:
            raise _question(columns, signal, fits.get(signal, {}))
        if found[signal].doubtful and not given.accept:
            raise _doubt(columns, signal, found[signal])
    return {
        signal: found[signal]
        for signal in known.signals
        if _wanted(found.get(signal), signal in known.needed)
    }


def _wanted(match: Match | None, needed: bool) -> bool:
    """Whether a signal is taken: an optional one has to be one by its name."""
    return match is not None and (needed or not match.doubtful)


def _check_names(columns: Columns, known: Kind, given: Given) -> None:
    for subject in ("column", "unit", "offset", "scale"):
        for name in getattr(given, subject):
            stems = {without_leg(s) for s in known.signals}
            allowed = known.signals if subject == "column" else {*known.signals, *stems}
            if name not in allowed:
                raise InputError(
                    f"--{subject} {name}: no such signal; {did_you_mean(name, allowed)}"
                )
    used = list(given.column.values())
    for name in used:
        if used.count(name) > 1:
            raise InputError(f"--column: '{name}' is given for two signals; a column is one signal")


def _column_said(columns: Columns, signal: str, name: str) -> Column:
    column = columns.called(name)
    if column is None:
        remedy = did_you_mean(name, [n for c in columns.columns for n in (c.name, c.header.name)])
        raise InputError(f"--column {signal}: all records have no column '{name}'; {remedy}")
    return column


def _fits(
    columns: Columns,
    known: Kind,
    found: Mapping[str, Match],
    first_leg: int | None,
    one_chamber: bool,
) -> dict[str, dict[str, float]]:
    """Signal -> column -> how well it fits, of those that are not settled."""
    taken = {match.column.name for match in found.values()}
    table: dict[str, dict[str, float]] = {}
    for signal in known.signals:
        if signal in found:
            continue
        table[signal] = {}
        for column in columns.columns:
            words = column.header.words
            if without_leg(signal) != signal and first_leg is not None:
                leg, words = _leg_of(words)
                if leg is None or leg - first_leg + 1 != int(signal[-1]):
                    continue
            worth = fit(signal, column, words, one_chamber)
            if worth > 0.0 and column.name not in taken and column.readings.size:
                table[signal][column.name] = OWN if column.header.name == signal else worth
    return table


def _leg_of(words: tuple[str, ...]) -> tuple[int | None, tuple[str, ...]]:
    """The one number in a name, and the words without it; of two, it cannot be told which is the leg's."""
    numbers = [word for word in words if word.isdigit()]
    if len(numbers) != 1 or int(numbers[0]) > max(LEGS):
        return None, words
    return int(numbers[0]), tuple(word for word in words if not word.isdigit())


def _first_leg(columns: Columns) -> int:
    """Whether legs are counted from 0 or from 1."""
    commands = {_leg_of(c.header.words)[0] for c in columns.columns if "p" not in c.header.words}
    return 0 if 0 in commands and max(LEGS) not in commands else 1


def _clearest(fits: Mapping[str, Mapping[str, float]]) -> tuple[str, str, float] | None:
    """The signal, column and fit of the best match that no other column comes near."""
    best: tuple[str, str, float] | None = None
    for signal, candidates in fits.items():
        ranked = sorted(candidates.items(), key=lambda item: -item[1])
        if not ranked or (len(ranked) > 1 and ranked[0][1] - ranked[1][1] < ALIKE):
            continue
        if best is None or ranked[0][1] > best[2]:
            best = (signal, *ranked[0])
    return best


def _running(columns: Columns, found: Mapping[str, Match]) -> Match:
    """Time by its readings: the only column that runs evenly upwards."""
    taken = {match.column.name for match in found.values()}
    running = {c.name: c for c in columns.columns if c.name not in taken and c.step is not None}
    if len(running) != 1:
        raise _question(columns, "time", dict.fromkeys(running, UNIT))
    return Match(next(iter(running.values())), False, "the only column that runs evenly upwards")


def _question(columns: Columns, signal: str, candidates: Mapping[str, float]) -> Question:
    what = "time" if signal == "time" else f"{label(signal)} ({signal})"
    alike = [n for n, worth in candidates.items() if worth > max(candidates.values()) - ALIKE]
    if len(alike) > 1:
        which = " and ".join(f"'{name}'" for name in alike)
        problem = f"{columns.files[0]}: the columns {which} can both be the {what}"
        return Question("column", signal, problem, f'"{alike[0]}"', choices=tuple(alike))
    problem = f"{columns.files[0]}: no column can be told to be the {what}, of {columns.listed}"
    names = tuple(column.name for column in columns.columns)
    return Question("column", signal, problem, '"name of its column"', choices=names)


def _doubt(columns: Columns, signal: str, match: Match) -> Question:
    what = f"{label(signal)} ({signal})"
    problem = f"{columns.files[0]}: no column is named like the {what}, '{match.column.name}' is {match.why}"
    return Question(
        "column", signal, problem, f'"{match.column.name}"', suggestion=match.column.name
    )
