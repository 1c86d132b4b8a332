"""Start values of an exported model: the published machine's, or those of a rig file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from sms.errors import InputError
from sms.fmi.binary import KINDS, variables_of
from sms.io.declarations import check_rod, read_declarations
from sms.io.schema import RigFile, parse_rig_text, read_rig_text
from sms.parameters import LEG_PARAMETERS, PARAMETERS, common_parameter, is_of_leg

_HAS_CONTROLLER = ("bench", "platform")


@dataclass(frozen=True)
class Starts:
    """By name of the variable, SI; what is not named begins as the published machine."""

    values: Mapping[str, float] = field(default_factory=dict)
    left_out: Mapping[str, float] = field(default_factory=dict)
    """Parameters of the rig file, other than their defaults, that this model has not."""


def starts_of_rig(kind: str, path: Path) -> Starts:
    """Start values of the model `kind` (one of KINDS) from a rig file, whose records need not be there.

    InputError says file, table, key and what to do; also for a rig of another kind.
    """
    file = parse_rig_text(read_rig_text(path), path)
    _check_kind(kind, file.rig.kind, path)
    names = {v.name: v for v in variables_of(kind)}
    declared = {name: known.value for name, known in read_declarations(path).items()}
    check_rod(declared, path)
    values: dict[str, float] = {}
    left_out: dict[str, float] = {}
    for name, value in declared.items():
        variable = _variable_of(name)
        if variable in names:
            values[variable] = value
        elif value != LEG_PARAMETERS[name].default and kind != "controller":
            left_out[name] = value
    values |= _choices(file, kind)
    return Starts(values | _rest(kind, values), left_out)


def _check_kind(kind: str, of_rig: str, path: Path) -> None:
    fits = _HAS_CONTROLLER if kind == "controller" else (kind,)
    if of_rig in fits:
        return
    if of_rig in KINDS:
        remedy = f"write sms export fmu {of_rig} {path}"
    else:
        remedy = f"what is exported has a motion in time: {', '.join(KINDS)}"
    raise InputError(
        f"{path}, [rig] kind: this is the rig file of a {of_rig}, and no {kind} is made of it; {remedy}"
    )


def _variable_of(parameter: str) -> str:
    """ "coulomb_force:2" is the variable "actuator_2.coulomb_force"."""
    if not is_of_leg(parameter):
        return parameter
    return f"actuator_{parameter.partition(':')[2]}.{common_parameter(parameter)}"


def _choices(file: RigFile, kind: str) -> dict[str, float]:
    """[model] and [control], as numbers of the enumerations and options that the model has."""
    said = {
        "valve_law": file.model.valve,
        "friction_law": file.model.friction,
        "chamber_law": file.model.chambers,
        "law": file.control.law,
    }
    options = {"compensated": file.control.compensated, "electronics": file.control.electronics}
    values: dict[str, float] = {}
    for variable in variables_of(kind):
        if variable.type == "enumeration" and variable.name in said:
            values[variable.name] = 1.0 + variable.choices.index(said[variable.name])
        elif variable.type == "boolean":
            values[variable.name] = float(options[variable.name])
    return values


def _rest(kind: str, values: Mapping[str, float]) -> dict[str, float]:
    """Where the rig's machine is at rest: mid-stroke, its valves closed."""
    if kind == "controller":
        return {}
    centre = values.get("valve_centre", PARAMETERS["valve_centre"].default)
    rest = {}
    for variable in variables_of(kind):
        if variable.causality == "input" and variable.unit == "V":
            leg = variable.name.rpartition("_")[2]
            rest[variable.name] = centre + values.get(f"actuator_{leg}.valve_centre", 0.0)
    if kind == "bench":
        rest["start_extension"] = 0.5 * values.get("stroke", PARAMETERS["stroke"].default)
    return rest
