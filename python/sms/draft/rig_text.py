"""The text of a drafted rig file, with comments for who goes on with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import tomlkit

from sms.draft.columns import Columns
from sms.draft.given import Given
from sms.draft.interpretation import Interpretation
from sms.io.units import from_si, interval_from_si
from sms.parameters import PARAMETERS

SCHEMA = "rig.schema.json"  #: written beside the rig file
_AIR = ("ambient_pressure", "air_temperature", "supply_pressure")
_CYLINDER = ("stroke", "bore_diameter", "rod_diameter")
_VALVE = ("valve_centre", "mass_flow_gain")
_FRICTION = ("coulomb_force", "viscous_friction")
_DEAD = ("dead_volume_lower", "dead_volume_upper")
KNOWN = {
    "bench": (*_AIR, *_CYLINDER, "moving_mass", *_DEAD, *_VALVE, *_FRICTION),
    "platform": (*_AIR, *_CYLINDER, "payload_mass", "payload_cog_z", *_DEAD, *_VALVE, *_FRICTION),
    "tank": (*_AIR, "tank_volume", *_VALVE),
    "cylinder": ("ambient_pressure", *_CYLINDER, *_FRICTION),
}
"""What somebody who has a rig of a kind most likely knows of it, better than the defaults do."""
_UNITS = {"Pa": "kPa", "m": "mm", "m^3": "l", "1": ""}


@dataclass(frozen=True)
class Entry:
    """One entry of [[records]]."""

    file: str
    role: str
    name: str | None


def rig_text(
    kind: str,
    title: str,
    columns: Columns,
    signals: Sequence[Interpretation],
    given: Given,
    records: Sequence[Entry],
) -> str:
    """The whole file."""
    blocks = (
        _head(kind, title, len(records)),
        _data(columns),
        _signals(signals),
        _parameters(kind, given),
        *map(_record, records),
    )
    return "\n".join("\n".join(block) + "\n" for block in map(list, blocks) if block)


def _head(kind: str, title: str, count: int) -> Iterator[str]:
    yield f"#:schema ./{SCHEMA}"
    yield f"# A {kind}, drafted by `sms new` from {count} records. docs/rig_file.md explains every key."
    yield '# A number with a unit is text: "25 mm". See whether the guesses in [signals] are right, and write into'
    yield "# [parameters] what you know."
    yield ""
    yield "[rig]"
    yield f"kind = {_quoted(kind)}"
    yield f"title = {_quoted(title)}"


def _data(columns: Columns) -> Iterator[str]:
    if columns.delimiter == "comma" and columns.names is None:
        return
    yield "[data]"
    if columns.delimiter != "comma":
        yield f"delimiter = {_quoted(columns.delimiter)}"
    if columns.names is not None:
        yield f"columns = [{', '.join(map(_quoted, columns.names))}]"


def _signals(signals: Sequence[Interpretation]) -> Iterator[str]:
    yield "# value = scale * column + offset; gauge = true: the sensor reads against ambient. Add what data sheets say,"
    yield '# noise = "0.04 mm" (standard deviation of a sample), resolution = "0.11 mm" (a step of the converter).'
    yield "[signals]"
    for of in signals:
        yield f"{of.signal} = {_source(of)}  # {of.sure}: {_plain('; '.join(of.why))}"


def _source(of: Interpretation) -> str:
    """One entry; a bare text where the header says all."""
    keys = [f"column = {_quoted(of.column.name)}"]
    if not of.column.header.understood or of.unit != of.column.header.unit:
        keys.append(f"unit = {_quoted(of.unit)}")
    if of.scale is not None:
        keys.append(f"scale = {of.scale!r}")
    if of.offset is not None:
        keys.append(f"offset = {_quoted(of.offset)}")
    if of.gauge:
        keys.append("gauge = true")
    return _quoted(of.column.name) if len(keys) == 1 else "{ " + ", ".join(keys) + " }"


def _parameters(kind: str, given: Given) -> Iterator[str]:
    yield "# What is known, and its half width. In comments: defaults, which are those of another machine."
    yield "[parameters]"
    for name, text in given.parameter.items():
        yield f"{name} = {_value(text)}"
    for name in KNOWN[kind]:
        if name in given.parameter:
            continue
        row = PARAMETERS[name]
        unit = _UNITS.get(row.unit, row.unit)
        value, width = (
            from_si(row.default, unit, row.unit, name),
            interval_from_si(row.uncertainty, unit or "1", row.unit, name).removesuffix(" 1"),
        )
        yield (
            f"# {name} = {{ value = {_value(value)}, uncertainty = {_value(width)} }}  # {_plain(row.doc)}"
        )


def _value(text: str) -> str:
    """A number with a unit is text, one without is a number."""
    try:
        return repr(float(text))
    except ValueError:
        return _quoted(text)


def _record(entry: Entry) -> Iterator[str]:
    yield "[[records]]"
    yield f"file = {_quoted(entry.file)}"
    yield f"role = {_quoted(entry.role)}"
    if entry.name is not None:
        yield f"name = {_quoted(entry.name)}"


def _quoted(text: str) -> str:
    return tomlkit.string(text).as_string()


def _plain(text: str) -> str:
    """As a comment can hold it: on one line."""
    return "".join(c if c.isprintable() else " " for c in text)
