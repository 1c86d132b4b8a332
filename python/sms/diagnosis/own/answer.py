"""What a diagnosis says of a plant of one's own: as of a rig, and the extended model itself."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from sms.diagnosis.own.model import Model
from sms.diagnosis.result import Diagnosis
from sms.errors import InputError
from sms.report.files import COVERAGE


@dataclass(frozen=True)
class Answer(Diagnosis):
    """A diagnosis, with a model that runs."""

    model: Model | None = field(default=None, repr=False)
    """The model that was asked about, with the longest step that was found for it."""
    extended: Model | None = field(default=None, repr=False)
    """The same with the causes, and with what was fitted beside them; of a class with its first member. With an unknown
    whose curve was asked for, the model that carries the curve. None where neither is there."""

    def to_dict(self) -> dict[str, Any]:
        """The contents of diagnosis.json: everything but curves and functions."""
        plain = {f.name: getattr(self, f.name) for f in fields(Diagnosis)}
        return Diagnosis(**plain).to_dict()


def extended_model(model: Model, diagnosis: Diagnosis) -> Model:
    """The model as the causes have it: their values, known to two standard errors, and what was fitted beside them.

    What was fitted beside them keeps what is declared of its uncertainty.
    """
    causes = {p.name: p for cause in diagnosis.causes for p in cause.parameters}
    beside = {p.name: p.value for p in diagnosis.refitted}
    there = model.with_values(beside | {n: p.value for n, p in causes.items()})
    known = [
        replace(p, uncertainty=COVERAGE * causes[p.name].standard_error, fit=False)
        if p.name in causes
        else p
        for p in there.parameters
    ]
    return replace(there, parameters=known)


def parameters_text(model: Model, header: str) -> str:
    """The values of a model as TOML, for `read_parameters`; each with its uncertainty, and whether it is fitted."""
    lines = [f"# {line}" for line in header.splitlines()]
    lines += ["", "[parameters]"]
    for p in model.parameters:
        entry = f"value = {p.value!r}, uncertainty = {p.uncertainty!r}"
        entry += ", fit = true" if p.fit else ""
        lines.append(f"{p.name} = {{ {entry} }}  # {p.unit}")
    return "\n".join(lines) + "\n"


def read_parameters(path: str | os.PathLike[str], model: Model) -> Model:
    """The model with the values of an extended.toml that `write_diagnosis` wrote of one like it.

    InputError for a file that is none, or a parameter that the model does not have.
    """
    path = Path(path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8")).get("parameters")
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: this cannot be read as TOML: {error}") from None
    if not isinstance(table, Mapping):
        raise InputError(
            f"{path}: there is no table [parameters]; take the extended.toml of a diagnosis"
        )
    for name, entry in table.items():
        if not isinstance(entry, Mapping) or not isinstance(entry.get("value"), int | float):
            raise InputError(
                f"{path}, [parameters], {name}: this has no value; write {name} = {{ value = 1.0 }}"
            )
    there = model.with_values({n: e["value"] for n, e in table.items()})
    declared = [
        replace(
            p,
            uncertainty=float(table[p.name].get("uncertainty", p.uncertainty)),
            fit=bool(table[p.name].get("fit", False)),
        )
        if p.name in table
        else p
        for p in there.parameters
    ]
    return replace(there, parameters=declared)
