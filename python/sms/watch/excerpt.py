"""A rig file and records for a full diagnosis: the machine when it was well, and since the alarm's onset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit

from sms.arrays import Array
from sms.io.rig import Rig
from sms.io.schema import read_rig_text
from sms.io.signals import SIGNAL_UNITS, column_name
from sms.io.write import write_table, write_text_atomically
from sms.watch.segments import RUN_UP, Segment

PIECES = 4
"""Of the rows since the onset: identify, validate, identify, validate."""
REFERENCE = 4
"""Records of the healthy machine, each of TOGETHER segments."""
TOGETHER = 2
LONGEST = 3
"""Segments in one of the pieces: a diagnosis of a minute takes minutes."""


def joined(segments: Sequence[Segment]) -> dict[str, Array]:
    """Segments that follow each other without a gap, the rows that two of them share once."""
    parts: dict[str, list[Array]] = {n: [] for n in segments[0].signals}
    last = -np.inf
    for segment in segments:
        fresh = segment.signals["time"] > last
        for name, values in segment.signals.items():
            parts[name].append(values[fresh])
        last = segment.end
    return {n: np.concatenate(v) for n, v in parts.items()}


def in_a_row(segments: Sequence[Segment]) -> list[list[Segment]]:
    """Groups of segments between which no row is missing."""
    groups: list[list[Segment]] = []
    for segment in segments:
        if groups and abs(segment.begin - groups[-1][-1].end) < 0.5 * RUN_UP:
            groups[-1].append(segment)
        else:
            groups.append([segment])
    return groups


def pieces_of(segments: Sequence[Segment], count: int, longest: int) -> list[list[Segment]]:
    """At most so many pieces of at most so many segments in a row, spread evenly over them."""
    pieces: list[list[Segment]] = []
    length = max(1, min(longest, len(segments) // count))
    for group in in_a_row(segments):
        pieces += [group[k : k + length] for k in range(0, len(group) - length + 1, length)]
    if len(pieces) <= count:
        return pieces
    places = np.linspace(0, len(pieces) - 1, count).round().astype(int)
    return [pieces[k] for k in places]


def write_excerpt(
    rig: Rig, folder: Path, healthy: Sequence[Segment], changed: Sequence[Segment]
) -> Path | None:
    """Write rig.toml and its records into a folder; the rig file. None where there are no two pieces to write."""
    pieces = pieces_of(changed, PIECES, LONGEST)
    if len(pieces) < 2:
        return None
    listed: list[dict[str, str]] = []
    for number, piece in enumerate(pieces_of(healthy, REFERENCE, TOGETHER), 1):
        listed.append(_written(folder, f"reference_{number}", "reference", piece))
    for number, piece in enumerate(pieces, 1):
        role = "identify" if number % 2 else "validate"
        listed.append(_written(folder, f"{role}_{(number + 1) // 2}", role, piece))
    path = folder / "rig.toml"
    write_text_atomically(path, _rig_text(rig, listed, list(changed[0].signals)))
    return path


def _written(folder: Path, name: str, role: str, piece: Sequence[Segment]) -> dict[str, str]:
    file = folder / f"{name}.csv"
    write_table(file, {column_name(s): v for s, v in joined(piece).items()})
    return {"file": file.name, "role": role, "name": name}


def _rig_text(rig: Rig, listed: Sequence[Mapping[str, str]], signals: Sequence[str]) -> str:
    """The rig file with these records, whose columns are signals in SI."""
    document: Any = tomlkit.parse(read_rig_text(rig.path))
    for table in ("data", "related", "records", "signals"):
        if table in document:
            del document[table]
    if rig.effects is not None:
        document["effects"] = {"file": str(rig.effects.resolve())}
    if rig.geometry is not None:
        document["rig"]["geometry"] = str(rig.geometry.resolve())
    document["signals"] = {s: _signal(rig, s) for s in signals}
    records = tomlkit.aot()
    for record in listed:
        records.append(tomlkit.item(dict(record)))
    document["records"] = records
    return str(tomlkit.dumps(document))


def _signal(rig: Rig, signal: str) -> dict[str, Any]:
    """What a signal's sensor is, its column in SI."""
    source, unit = rig.signals[signal], SIGNAL_UNITS[signal]
    told: dict[str, Any] = {"column": signal, "unit": unit}
    if source.gauge:
        told["gauge"] = True
    if source.noise is not None:
        told["noise"] = f"{source.noise:.6g} {unit}"
    if source.resolution > 0.0:
        told["resolution"] = f"{source.resolution:.6g} {unit}"
    if source.range is not None:
        told["range"] = [f"{end:.9g} {unit}" for end in source.range]
    if source.hold is not None:
        told["hold"] = source.hold
    return told
