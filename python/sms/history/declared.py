"""What changed in the rig file between two diagnoses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from sms.history.answer import Answer
from sms.io.signals import SIGNAL_UNITS
from sms.io.units import split_column_name
from sms.units_display import format_quantity, words


def changes(a: Answer, b: Answer) -> list[str]:
    """A sentence for each difference of what the two rig files declare."""
    if not a.declared or not b.declared:
        return list(_by_hash(a, b))
    units = {e.parameter: e.unit for answer in (a, b) for e in _estimates(answer)}
    return [
        *_parameters(a.declared, b.declared, units),
        *_signals(a.declared, b.declared),
        *_keys("[model]", a.declared.get("model") or {}, b.declared.get("model") or {}),
        *_keys("[control]", a.declared.get("control") or {}, b.declared.get("control") or {}),
    ]


def _by_hash(a: Answer, b: Answer) -> Iterator[str]:
    """All that older files tell: whether the rig file is another one."""
    if a.inputs.get(a.rig) and b.inputs.get(b.rig) and a.inputs[a.rig] != b.inputs[b.rig]:
        yield "the rig file is another one; what changed in it is not in a diagnosis.json as old as one of the two"


def _estimates(answer: Answer) -> Iterator[Any]:
    yield from answer.model
    for members in answer.causes:
        for member in members:
            yield from member.estimates


def _parameters(
    a: Mapping[str, Any], b: Mapping[str, Any], units: Mapping[str, str]
) -> Iterator[str]:
    before, after = a.get("parameters") or {}, b.get("parameters") or {}
    for name in dict.fromkeys([*before, *after]):
        was, now, unit = before.get(name), after.get(name), units.get(name, "")
        if was == now:
            continue
        shown = words(name)
        if was is None:
            yield f"{shown} is declared now: {_declaration(now, unit, name)}"
        elif now is None:
            yield f"{shown} is not declared any more; it was {_declaration(was, unit, name)}"
        else:
            yield (f"{shown}: {_declaration(was, unit, name)} → {_declaration(now, unit, name)}")


def _declaration(known: Any, unit: str, name: str) -> str:
    if known.get("fit"):
        return f"unknown, about {format_quantity(float(known['value']), unit, name)}"
    value, width = float(known["value"]), float(known.get("uncertainty") or 0.0)
    shown = format_quantity(value, unit, name, 6)
    return f"{shown} within {format_quantity(width, unit, name)}" if width else shown


def _signals(a: Mapping[str, Any], b: Mapping[str, Any]) -> Iterator[str]:
    before, after = a.get("signals") or {}, b.get("signals") or {}
    for name in dict.fromkeys([*before, *after]):
        where = f"[signals] {name}"
        if name not in before or name not in after:
            yield f"{where} {'is new' if name not in before else 'is gone'}"
        else:
            yield from _keys(where, _with_unit(name, before[name]), _with_unit(name, after[name]))


def _with_unit(signal: str, source: Mapping[str, Any]) -> dict[str, Any]:
    """The source of a signal, its unit said once: in the rig file, in the column's name, or SI for want of both."""
    column, unit = split_column_name(str(source.get("column") or ""))
    said = source.get("unit") or unit or SIGNAL_UNITS.get(signal)
    return {**source, "column": column, "unit": said}


def _keys(where: str, before: Mapping[str, Any], after: Mapping[str, Any]) -> Iterator[str]:
    for key in dict.fromkeys([*before, *after]):
        was, now = before.get(key), after.get(key)
        if was != now:
            yield f"{where} {key}: {_said(was)} → {_said(now)}"


def _said(value: object) -> str:
    if value is None:
        return "not said"
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:g}" if isinstance(value, float) else str(value)
