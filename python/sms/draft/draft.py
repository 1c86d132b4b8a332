"""The draft of a rig file: from records and what their user said to its text, and what was guessed for it."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from sms.draft.assignment import Match, assign
from sms.draft.columns import Columns
from sms.draft.given import Given
from sms.draft.interpretation import Interpretation, interpretations
from sms.draft.rig_text import Entry, rig_text
from sms.errors import InputError
from sms.io.signals import KINDS, of_legs, without_leg

DRAFTED = ("bench", "platform", "tank", "cylinder")
"""Kinds of rig that are diagnosed; those of the other two are said in a line by conditions of each record."""
JUDGED = 3  #: of so many records the last one judges


@dataclass(frozen=True)
class Draft:
    """A rig file, and how it came about."""

    text: str
    signals: tuple[Interpretation, ...]
    unused: tuple[tuple[str, str], ...]  #: columns that are no signal of it, and why
    roles: tuple[tuple[str, str], ...]  #: record, role


def draft_rig(
    columns: Columns,
    kind: str,
    out: Path,
    given: Given,
    validate: int | None = None,
    title: str = "",
) -> Draft:
    """The rig file `out` for these records. Question for what they do not tell, InputError for what is wrong.

    validate: how many records, the last ones, are kept to judge on; without it a third of them.
    """
    roles = _roles(columns.files, validate)
    matches = assign(columns, kind, given)
    kept, left_out = _usable(matches, kind, given)
    signals = tuple(interpretations(kept, given))
    names = _names(columns.files)
    entries = tuple(
        Entry(_beside(file, out), role, name)
        for file, role, name in zip(columns.files, roles, names, strict=True)
    )
    text = rig_text(kind, title or out.stem, columns, signals, given, entries)
    used = {match.column.name for match in kept.values()}
    unused = tuple(
        (c.name, left_out.get(c.name, "no signal of this kind of rig by its name and unit"))
        for c in columns.columns
        if c.name not in used
    )
    records = zip((e.file for e in entries), roles, strict=True)
    return Draft(text, signals, unused, tuple(records))


def _roles(files: Sequence[Path], validate: int | None) -> list[str]:
    """The last ones judge."""
    count = len(files)
    if count < 2:
        raise InputError(
            f"{files[0]}: one record only; a diagnosis fits on some and judges on others, so give two or more"
        )
    last = max(1, round(count / JUDGED)) if validate is None else validate
    if not 1 <= last < count:
        raise InputError(f"--validate {last}: of {count} records write 1 to {count - 1}")
    return ["identify"] * (count - last) + ["validate"] * last


def _usable(
    matches: dict[str, Match], kind: str, given: Given
) -> tuple[dict[str, Match], dict[str, str]]:
    """Without optional signals that cannot be read, or of which only some are there; column -> why."""
    kept, why = dict(matches), {}
    optional = [s for s in KINDS[kind].optional if s in kept and s not in given.column]
    for signal in optional:
        column = kept[signal].column
        if column.holes:
            why[column.name] = f"{signal}, but {column.holes} of its cells are no numbers"
            del kept[signal]
    for group in (("roll", "pitch"), of_legs("setpoint")):
        there = [signal for signal in group if signal in kept]
        if len(there) < len(group):
            for signal in there:
                if signal in optional:
                    missing = ", ".join(s for s in group if s not in kept)
                    why[kept.pop(signal).column.name] = (
                        f"{without_leg(signal)}, but {missing} lacks"
                    )
    return kept, why


def _beside(file: Path, out: Path) -> str:
    """How the rig file names a record: relative to its own folder."""
    return Path(os.path.relpath(file.resolve(), out.resolve().parent)).as_posix()


def _names(files: Sequence[Path]) -> list[str | None]:
    """Names for records whose files are called alike, in folders of their own."""
    resolved = [file.resolve() for file in files]
    for file, count in Counter(resolved).items():
        if count > 1:
            raise InputError(f"{file.name}: given twice; a record is used once")
    stems = [Path(file.name.removesuffix(".gz")).stem for file in resolved]
    alike = {stem for stem, count in Counter(stems).items() if count > 1}
    return [
        f"{file.parent.name}_{stem}_{number}" if stem in alike else None
        for number, (file, stem) in enumerate(zip(resolved, stems, strict=True), start=1)
    ]
