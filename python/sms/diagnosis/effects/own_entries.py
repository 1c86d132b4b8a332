"""A user's own effects: the file that [effects] of a rig file names, checked, as entries of the catalogue.

Keys as in pneumatic.toml, of which a person has to write only what is needed: id, kind, parameters, block, title, cause
and plausible. A range and a step are numbers in SI, as there, or text with a unit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from sms.diagnosis.selection.excitation import CHECKS, RUN_CHECKS
from sms.errors import InputError, did_you_mean
from sms.io.rig import Rig
from sms.io.signals import KINDS, without_leg
from sms.io.toml_tables import Table, TextOrNumber, checked, parse_toml, place, read_text
from sms.io.units import interval_to_si
from sms.parameters import PARAMETERS, common_parameter

Word = Annotated[str, Field(min_length=1)]


class OwnEffect(Table):
    """One [[effect]]."""

    id: Word
    kind: Literal["missing", "shifted"]
    parameters: list[str] = Field(min_length=1)
    block: str
    title: Word
    cause: Word
    signature: str = ""
    needs: list[str] = Field(default_factory=list)
    plausible: list[TextOrNumber]
    separated_by: str = ""
    step: TextOrNumber | None = None
    absolute: bool = False
    kinds: list[str] | None = Field(default=None, min_length=1)
    signals: list[str] | None = Field(default=None, min_length=1)
    parts: list[str] | None = Field(default=None, min_length=1)
    chambers: Literal["polytropic", "energy"] | None = None
    controller: Literal["recorded", "pid", "state_feedback"] | None = None


class OwnEffects(Table):
    """The whole file."""

    effect: list[OwnEffect] = Field(min_length=1)
    legs: list[str] = Field(default_factory=list)
    """Of a platform: the effects that one leg may have alone."""


@dataclass(frozen=True)
class Known:
    """What the catalogue has already: ids, and what each effect of it is made of; and the blocks it knows."""

    ids: Set[str]
    parameters: Mapping[tuple[str, ...], str]
    """-> the name of the effect"""
    blocks: Sequence[str]


def parameters_of(entry: Mapping[str, Any], where: str | None) -> tuple[str, ...]:
    """The parameters of an entry for one signal or part."""
    return tuple(_of_leg(filled(p, where)) for p in entry["parameters"])


def filled(text: str, where: str | None) -> str:
    """With the signal or part that it is about."""
    return text if where is None else text.replace("{signal}", where).replace("{part}", where)


def _of_leg(parameter: str) -> str:
    """The parameter of a leg's sensor: "sensor_gain_extension_2" -> "sensor_gain_extension:2"."""
    common = without_leg(parameter)
    return (
        parameter
        if parameter in PARAMETERS
        else common + parameter[len(common) :].replace("_", ":")
    )


def places_of(entry: Mapping[str, Any]) -> list[str | None]:
    """The signals or parts that an entry can sit on; [None] where there is only one."""
    return list(entry.get("signals", entry.get("parts", [None])))


# ---- reading and checking ------------------------------------------------------------------------


def own_entries(rig: Rig, known: Known) -> tuple[list[dict[str, Any]], list[str]]:
    """The entries of a rig's own file that are for its kind, and the ids that one leg may have alone; or none.

    InputError for the first mistake in it.
    """
    path = rig.effects
    if path is None:
        return [], []
    tables = parse_toml(read_text(path, "file of effects", "one [[effect]]"), path)
    _refuse_expressions(tables, path)
    file = checked(OwnEffects, tables, path)
    entries, said = [], set()
    for number, effect in enumerate(file.effect):
        where = f"{path}, {place('effect', number)}"
        _check_words(effect, rig.kind, known, where)
        if effect.id in said:
            raise InputError(f"{where}, id: there are two effects '{effect.id}'; give each its own")
        said.add(effect.id)
        if rig.kind in (effect.kinds or [rig.kind]):
            entries.append(_entry(effect, rig, known, where))
    for leg in file.legs:
        if leg not in said:
            raise InputError(
                f"{path}, legs: there is no effect '{leg}' here; {did_you_mean(leg, said)}"
            )
    return entries, file.legs if rig.kind == "platform" else []


def _refuse_expressions(tables: Mapping[str, Any], path: Path) -> None:
    effects = tables.get("effect")
    for number, effect in enumerate(effects if isinstance(effects, list) else []):
        for key in ("expression", "equation"):
            if isinstance(effect, Mapping) and key in effect:
                raise InputError(
                    f"{path}, {place('effect', number, key)}: a term that is an expression of the signals cannot be "
                    "carried by the simulation; name a parameter of docs/parameters.md under parameters, or write the "
                    "plant as a model of your own (docs/own_model.md)"
                )


def _check_words(effect: OwnEffect, kind: str, known: Known, where: str) -> None:
    """The words that are of a list."""
    excitations: Mapping[str, Callable[..., str]] = CHECKS if kind == "cylinder" else RUN_CHECKS
    lists: tuple[tuple[str, Sequence[str], Sequence[str]], ...] = (
        ("block", [effect.block], known.blocks),
        ("kinds", effect.kinds or [], list(KINDS)),
        ("needs", effect.needs, list(excitations)),
        ("signals", effect.signals or [], KINDS[kind].signals),
    )
    if kind not in (effect.kinds or [kind]):  # what it needs and reads is of another rig
        lists = lists[:2]
    for key, words, allowed in lists:
        for word in words:
            if word not in allowed:
                raise InputError(
                    f"{where}, {key}: '{word}' is not known; {did_you_mean(word, allowed)}"
                )
    if effect.id in known.ids:
        raise InputError(
            f"{where}, id: the catalogue has an effect '{effect.id}' already; choose another id"
        )
    if effect.signals is not None and effect.parts is not None:
        raise InputError(f"{where}: it has both signals and parts; leave one of them out")


def _entry(effect: OwnEffect, rig: Rig, known: Known, where: str) -> dict[str, Any]:
    """As an entry of the catalogue, in SI."""
    entry = effect.model_dump(exclude_none=True)
    for at in places_of(entry):
        names = parameters_of(entry, at)
        for name in names:
            if name not in rig.table:
                raise InputError(
                    f"{where}, parameters: there is no parameter '{name}'; "
                    f"{did_you_mean(name, PARAMETERS, 'docs/parameters.md has all')}"
                )
        if names in known.parameters:
            raise InputError(
                f"{where}, parameters: an effect of {', '.join(names)} is in the catalogue already, "
                f"'{known.parameters[names]}'; take this one out"
            )
        low, high, step = _sizes(effect, names[0], rig, where)
        entry |= {"plausible": [low, high]} | ({} if step is None else {"step": step})
    return entry


def _sizes(effect: OwnEffect, name: str, rig: Rig, where: str) -> tuple[float, float, float | None]:
    """Range and step for its first parameter, which is its size."""
    parameter = rig.table[name]
    relative = effect.kind == "shifted" and not effect.absolute
    declared = rig.declared(common_parameter(name)).value
    if effect.kind == "missing" and parameter.default != 0.0:
        raise InputError(
            f"{where}, kind: {name} is {parameter.default:g} {parameter.unit} in a machine without the effect, and a "
            'missing term is 0 there; write kind = "shifted"'
        )
    if relative and declared == 0.0:
        raise InputError(
            f"{where}, plausible: {name} is declared as 0, and a share of it is 0 too; write absolute = true, and the "
            f"range in {parameter.unit}"
        )
    if len(effect.plausible) != 2:
        raise InputError(f"{where}, plausible: a range is two numbers, [smallest, largest]")
    unit = "1" if relative else parameter.unit
    low, high = (_in_si(end, unit, f"{where}, plausible") for end in effect.plausible)
    said = f"{effect.plausible[0]} to {effect.plausible[1]}"
    if low >= high:
        raise InputError(f"{where}, plausible: {said} is upside down; write the smaller end first")
    if not low <= 0.0 <= high:
        raise InputError(
            f"{where}, plausible: {said} does not hold 0, which is the machine without the effect; it is a range of "
            + ("the term's size" if effect.kind == "missing" else f"how far {name} is off")
        )
    about = 0.0 if effect.kind == "missing" or common_parameter(name) != name else declared
    span = declared if relative else 1.0
    least, most = sorted((about + span * low, about + span * high))
    if min(most, parameter.upper) <= max(least, parameter.lower):
        raise InputError(
            f"{where}, plausible: {said} leaves {name} no room within {parameter.lower:g} to {parameter.upper:g} "
            f"{parameter.unit}, where it must lie"
        )
    if effect.step is None:
        return low, high, None
    step = _in_si(effect.step, parameter.unit, f"{where}, step")
    if not 0.0 < step <= most - least:
        raise InputError(
            f"{where}, step: {effect.step} is no size within what is plausible; write a positive one"
        )
    return low, high, step


def _in_si(said: str | float, unit: str, where: str) -> float:
    """A size in SI: a number as it is, or text with a unit."""
    return float(said) if isinstance(said, (int, float)) else interval_to_si(said, unit, where)
