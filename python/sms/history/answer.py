"""What a history and a comparison take from one diagnosis.json, older ones too, each with what it lacks in words."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from sms.errors import InputError
from sms.io.json_files import SCHEMA_VERSIONS, content_digest
from sms.io.measured import moment

LARGEST_JSON = 2**28
"""Bytes of a diagnosis.json; those of a platform have a hundredth of it."""
NAME = "diagnosis.json"


@dataclass(frozen=True)
class Estimate:
    """One parameter as a diagnosis has it, SI."""

    parameter: str
    unit: str
    value: float
    standard_error: float
    """NaN where the fit has none, as of a parameter at the end of what is allowed."""
    neutral: float
    """Declared, or the value of a term that is absent."""

    @property
    def shift(self) -> float:
        """Off its neutral value."""
        return self.value - self.neutral


@dataclass(frozen=True)
class Explanation:
    """One member of a cause: an effect, where it acts, and its parameters, the first of which is its size."""

    effect: str
    signal: str | None
    title: str
    estimates: tuple[Estimate, ...]

    @property
    def key(self) -> str:
        """Of the effect, for a reader too: "fitting_leakage lower"."""
        return f"{self.effect} {self.signal}" if self.signal else self.effect

    @property
    def sizes(self) -> tuple[Estimate, ...]:
        """The first parameter, and what else is a term that is absent otherwise, those with a standard error."""
        told = [e for e in self.estimates if math.isfinite(e.shift) and e.standard_error > 0.0]
        return tuple(e for e in told if e is self.estimates[0] or e.neutral == 0.0)


@dataclass(frozen=True)
class Answer:
    """One diagnosis."""

    source: str
    """The file it is from, for sentences."""
    text: str = field(repr=False)
    """The whole JSON."""
    digest: str
    """SHA-256 of what it says, but for when its records were measured."""
    title: str
    kind: str
    """Empty where an older file does not say it."""
    rig: str
    measured: datetime
    measured_from: str
    verdict: str
    sentence: str
    causes: tuple[tuple[Explanation, ...], ...]
    """Each with its members, the first one stands for it."""
    model: tuple[Estimate, ...]
    """The fit of the declared model, without any cause."""
    limits: Mapping[str, float]
    """Explanation.key -> the shift of its first parameter from which these records would have shown it."""
    unnamed: Mapping[str, Estimate]
    """Explanation.key -> the shift of its first parameter that would fit these records best; of what is not named."""
    not_testable: Mapping[str, str]
    """Explanation.key -> why these records say nothing of it."""
    declared: Mapping[str, Any]
    inputs: Mapping[str, str]
    next_experiment: str
    lacks: tuple[str, ...]
    """What an older file does not say, a sentence each."""

    def named(self, key: str) -> Explanation | None:
        """The explanation of this key among the causes' members."""
        return next((m for members in self.causes for m in members if m.key == key), None)

    @property
    def judges(self) -> bool:
        """Whether that no cause is named says something of the machine."""
        return self.verdict not in ("unknown", "data-fault")

    def not_named(self, named: Explanation) -> Estimate | None:
        """The estimate here of an effect that another diagnosis names: of its shift, or of the declared parameter that
        it shifts. None where this one does not say it, or names other causes, with which it was not estimated."""
        size = named.estimates[0]
        if not self.judges:
            return None
        if (shift := self.unnamed.get(named.key)) is not None:
            value = size.neutral + shift.value
            return replace(shift, parameter=size.parameter, value=value, neutral=size.neutral)
        if self.causes:
            return None
        model = next((e for e in self.model if e.parameter == size.parameter), None)
        return model if model is not None and math.isfinite(model.standard_error) else None


def read_answers(places: Iterable[Path]) -> list[Answer]:
    """Those of files, and of folders all diagnosis.json below them. InputError, one sentence, for the first bad one."""
    found = []
    for place in places:
        files = sorted(place.rglob(NAME)) if place.is_dir() else [place]
        if not files:
            raise InputError(
                f"{place}: there is no {NAME} in this folder or below; name one that holds what sms diagnose wrote"
            )
        found += [read_file(file) for file in files]
    return found


def read_file(path: Path) -> Answer:
    """The answer of one file. InputError where it is none."""
    try:
        with path.open("rb") as opened:
            content = opened.read(LARGEST_JSON + 1)
        changed = path.stat().st_mtime
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; name a {NAME}") from None
    except OSError as problem:
        raise InputError(f"{path}: cannot be read ({problem.strerror})") from None
    if len(content) > LARGEST_JSON:
        raise InputError(f"{path}: larger than any {NAME}; name one that sms diagnose wrote")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(
            f"{path}: not a text in UTF-8, as JSON is; name a {NAME} that sms diagnose wrote"
        ) from None
    return read_answer(text, str(path), datetime.fromtimestamp(changed, UTC))


def read_answer(text: str, source: str, file_changed: datetime) -> Answer:
    """The answer in a JSON text. file_changed: stands for the time of measurement where an older file has none."""
    content = _parsed(text, source)
    if (schema := content.get("schema", "sms.diagnosis")) != "sms.diagnosis":
        raise InputError(f"{source}: this is {schema}, not a diagnosis; name a {NAME}")
    version = content.get("schema_version", 1)
    if version != SCHEMA_VERSIONS["diagnosis"]:
        raise InputError(
            f"{source}: its schema_version is {version}, and this sms reads {SCHEMA_VERSIONS['diagnosis']}; "
            "use the sms that wrote it, or a newer one"
        )
    for key in ("verdict", "causes"):
        if key not in content:
            raise InputError(
                f"{source}: the key '{key}' is missing, so this is no diagnosis; name a {NAME} that sms diagnose wrote"
            )
    try:
        return _answer(content, text, source, file_changed)
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as problem:
        raise InputError(
            f"{source}: not laid out as a diagnosis is ({type(problem).__name__}: {problem}); name a {NAME} that "
            "sms diagnose wrote"
        ) from None


def _parsed(text: str, source: str) -> dict[str, Any]:
    def refuse(constant: str) -> float:
        raise InputError(
            f"{source}: it holds {constant}, which JSON has not and sms never writes; write it again with sms diagnose"
        )

    try:
        content = json.loads(text, parse_constant=refuse)
    except json.JSONDecodeError as problem:
        raise InputError(
            f"{source}, line {problem.lineno}: not valid JSON ({problem.msg}), perhaps cut off; copy it again, or "
            "diagnose again"
        ) from None
    except InputError:
        raise
    except (RecursionError, ValueError):
        raise InputError(f"{source}: not JSON that can be read; name a {NAME}") from None
    if not isinstance(content, dict):
        raise InputError(f"{source}: not a JSON object; name a {NAME} that sms diagnose wrote")
    return content


def _answer(content: dict[str, Any], text: str, source: str, file_changed: datetime) -> Answer:
    lacks = []
    measured, measured_from = file_changed, "modification of the file diagnosis.json"
    if content.get("measured"):
        measured = moment(_text(content["measured"]))
        measured_from = _text(content.get("measured_from") or "stated")
    else:
        lacks.append(
            f"{source} does not say when its records were measured: the time at which the file was changed last is "
            "taken, unless --measured says it"
        )
    if not content.get("kind"):
        lacks.append(
            f"{source} does not say of what kind its rig is: that it is the same machine was judged by the title alone"
        )
    if not content.get("declared"):
        lacks.append(
            f"{source} does not hold what its rig file declared: what changed in there is not known"
        )
    causes = tuple(_members(cause) for cause in content["causes"])
    return Answer(
        source=_text(source),
        text=text,
        digest=content_digest(content, ("measured", "measured_from")),
        title=_text(content.get("title", "")),
        kind=_text(content.get("kind") or ""),
        rig=_text(content.get("rig", "")),
        measured=measured,
        measured_from=measured_from,
        verdict=_text(content["verdict"]),
        sentence=_text(content.get("sentence", "")),
        causes=causes,
        model=tuple(_estimate(p) for p in content.get("baseline") or ()),
        limits=_limits(content),
        unnamed=_unnamed(content),
        not_testable={_key(n): _text(n["reason"]) for n in content.get("not_testable") or ()},
        declared=dict(content.get("declared") or {}),
        inputs=dict(content.get("inputs") or {}),
        next_experiment=_experiment(content.get("next_experiment")),
        lacks=tuple(lacks),
    )


def _members(cause: Mapping[str, Any]) -> tuple[Explanation, ...]:
    """The cause itself first, then the others of its class."""
    first = _explanation(cause)
    others = [_explanation(m) for m in cause.get("alternatives") or ()]
    return (first, *(m for m in others if m.key != first.key))


def _explanation(found: Mapping[str, Any]) -> Explanation:
    estimates = tuple(_estimate(p) for p in found["parameters"])
    if not estimates:
        raise ValueError("a cause without a parameter")
    signal = None if found.get("signal") is None else _text(found["signal"])
    return Explanation(_text(found["effect"]), signal, _text(found.get("title", "")), estimates)


def _estimate(found: Mapping[str, Any]) -> Estimate:
    error = _number(found["standard_error"])
    return Estimate(
        _text(found["name"]),
        _text(found["unit"]),
        _number(found["value"]),
        error if error > 0.0 else math.nan,
        _number(found["old_value"]),
    )


def _number(value: object) -> float:
    """A number; NaN for null, which stands for it in JSON."""
    if value is None:
        return math.nan
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{value!r} is not a number")
    return float(value) if math.isfinite(value) else math.nan


def _limits(content: Mapping[str, Any]) -> dict[str, float]:
    return {_key(h): _number(h["size"]) for h in content.get("still_hidden") or ()}


def _unnamed(content: Mapping[str, Any]) -> dict[str, Estimate]:
    """As shifts: neutral is 0."""
    found = {}
    for hidden in content.get("still_hidden") or ():
        size = _number(hidden.get("estimate"))
        error = _number(hidden.get("standard_error"))
        if math.isfinite(size) and error > 0.0:
            parameter, unit = _text(hidden["parameter"]), _text(hidden["unit"])
            found[_key(hidden)] = Estimate(parameter, unit, size, error, 0.0)
    return found


def _key(found: Mapping[str, Any]) -> str:
    effect, signal = _text(found["effect"]), found.get("signal")
    return f"{effect} {signal}" if signal else effect


def _experiment(found: Mapping[str, Any] | None) -> str:
    return "" if not found else f"{found['title']}: {found['purpose']}"


def _text(value: object) -> str:
    """As UTF-8 has it: half a letter, which JSON can hold, becomes its code."""
    return str(value).encode("utf-8", "backslashreplace").decode("utf-8")
