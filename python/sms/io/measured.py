"""When the records of a rig were measured, and what its rig file declares: what the history of a machine goes by.

The rig file says the time, `[rig] measured = 2026-11-25`. Where it does not, the latest modification of the records'
files stands for it, which copying may have changed: so each time says what it was taken from.
"""

from __future__ import annotations

from dataclasses import asdict
from datetime import UTC, datetime
from typing import Any, Literal

from sms.errors import InputError
from sms.io.rig import Rig

MeasuredFrom = Literal["stated", "modification of the records", ""]


def measured_time(rig: Rig) -> tuple[str, MeasuredFrom]:
    """ISO 8601 and its origin. Records of the healthy machine (role reference) are of an earlier day: not counted."""
    if rig.measured is not None:
        return rig.measured.isoformat(), "stated"
    files = [r.file for r in rig.records if r.role != "reference"] or [r.file for r in rig.records]
    latest = max(file.stat().st_mtime for file in files)
    return datetime.fromtimestamp(latest, UTC).isoformat(timespec="seconds"), (
        "modification of the records"
    )


def parse_measured(text: str, where: str) -> str:
    """A date or a date and time as ISO 8601 has it, for an option. InputError for anything else."""
    try:
        moment(text)
    except ValueError:
        raise InputError(
            f"{where} {text}: not a date; write it like 2026-11-25 or 2026-11-25T14:30"
        ) from None
    return text


def moment(text: str) -> datetime:
    """The instant of an ISO 8601 text; a date is its midnight, and without a zone UTC is taken. ValueError if none."""
    found = datetime.fromisoformat(text)
    return found.replace(tzinfo=UTC) if found.tzinfo is None else found.astimezone(UTC)


def declared_of(rig: Rig) -> dict[str, Any]:
    """What the rig file declares, in SI: model, control, signals, parameters that it mentions."""
    return {
        "model": rig.model.model_dump(),
        "control": rig.control.model_dump(),
        "signals": {name: asdict(source) for name, source in rig.signals.items()},
        "parameters": {name: asdict(known) for name, known in rig.parameters.items()},
    }
