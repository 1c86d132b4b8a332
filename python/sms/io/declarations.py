"""What is known of parameters: entries of [parameters], of a rig file or of a parameter file, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sms.errors import InputError, nearest
from sms.io.data_files import beside
from sms.io.schema import (
    ParameterFile,
    ParameterTable,
    RigTable,
    checked,
    parse_toml,
    read_text,
)
from sms.io.units import interval_to_si, to_si
from sms.parameters import LEG_PARAMETERS, PARAMETERS, Parameter


@dataclass(frozen=True)
class Declaration:
    """What is known of one parameter, in its SI unit."""

    value: float
    uncertainty: float  #: half width within which it may move unasked
    fit: bool = False  #: unknown: to be fitted, `value` is the start


def read_declarations(path: Path) -> dict[str, Declaration]:
    """What a rig file, whose records need not be there, or a parameter file says of parameters.

    Raises: InputError for what is not readable, not known, or outside the bounds of params.def.
    """
    tables = parse_toml(read_text(path, "parameter file", "[parameters]"), path)
    rig = tables.get("rig")
    if not isinstance(rig, Mapping):
        return _of_tables(tables, path)
    geometry = rig.get("geometry")
    known = _calibrated(geometry, path) if isinstance(geometry, str) else {}
    return known | _of_tables({"parameters": {}} | tables, path)


def as_calibrated(rig: RigTable, path: Path) -> tuple[Path | None, dict[str, Declaration]]:
    """The parameter file that [rig] geometry of the rig file `path` names, and what it says.

    The poses know parameters together far better than the half width of each alone says; so what is known better
    without the file, as a joint of the drawing is, stays known as well.
    """
    if rig.geometry is None:
        return None, {}
    if rig.kind != "platform":
        raise InputError(f"{path}, [rig] geometry: a {rig.kind} has no mechanism; leave it out")
    file = beside(path, rig.geometry, "[rig] geometry", "parameter file")
    return file, _calibrated(rig.geometry, path)


def _calibrated(geometry: str, path: Path) -> dict[str, Declaration]:
    """What the parameter file says that the rig file `path` names as its geometry."""
    file = beside(path, geometry, "[rig] geometry", "parameter file")
    found = _of_tables(parse_toml(read_text(file, "parameter file", "[parameters]"), file), file)
    half_widths = {
        name: min(known.uncertainty, LEG_PARAMETERS[name].uncertainty)
        for name, known in found.items()
    }
    return {name: Declaration(found[name].value, half_widths[name]) for name in found}


def _of_tables(tables: Mapping[str, Any], path: Path) -> dict[str, Declaration]:
    if "parameters" not in tables:
        raise InputError(
            f"{path}: the table [parameters] is missing; sms calibrate geometry writes one"
        )
    file = checked(ParameterFile, {"parameters": tables["parameters"]}, path)
    where = f"{path}, [parameters]"
    return {
        name: declaration(name, table, where, LEG_PARAMETERS)
        for name, table in file.parameters.items()
    }


def declaration(
    name: str,
    table: ParameterTable,
    where: str,
    known: Mapping[str, Parameter] = PARAMETERS,
) -> Declaration:
    where = f"{where} {name}"
    if name not in known:
        near = nearest(name, PARAMETERS)
        remedy = f"did you mean '{near}'?" if near else "see the table of parameters (params.def)"
        raise InputError(f"{where}: there is no such parameter; {remedy}")
    parameter = known[name]
    value, uncertainty = parameter.default, PARAMETERS.get(name, parameter).uncertainty
    if table.value is not None:
        value = to_si(table.value, parameter.unit, where)
        check_bounds(parameter, value, where)
    if table.uncertainty is not None:
        uncertainty = interval_to_si(table.uncertainty, parameter.unit, f"{where}, uncertainty")
        if uncertainty < 0.0:
            raise InputError(f"{where}: an uncertainty is not negative; write its half width")
        if uncertainty > (1.0 + 1e-9) * (parameter.upper - parameter.lower):
            raise InputError(
                f"{where}: an uncertainty of {table.uncertainty} is wider than the whole allowed range, "
                f"{parameter.lower:g} to {parameter.upper:g}{unit_after(parameter)}; write fit = true where nothing is "
                "known"
            )
    return Declaration(value, uncertainty, table.fit)


def parameters_of(kind: str) -> Mapping[str, Parameter]:
    """A platform has parameters of one leg, too: "chamber_leakage_lower:2"."""
    return LEG_PARAMETERS if kind == "platform" else PARAMETERS


def check_bounds(parameter: Parameter, value: float, where: str) -> None:
    """InputError, with the allowed range, unless lower <= value <= upper (SI)."""
    if not parameter.lower <= value <= parameter.upper:
        unit = unit_after(parameter)
        raise InputError(
            f"{where}: {value:g}{unit} is outside the allowed range "
            f"{parameter.lower:g} to {parameter.upper:g}{unit}; check the number and its unit"
        )


def check_rod(values: Mapping[str, float], path: Path) -> None:
    """InputError for a rod that is wider than its bore, m by name; what is not given is as in params.def."""
    rod, bore = (values.get(n, PARAMETERS[n].default) for n in ("rod_diameter", "bore_diameter"))
    if rod >= bore:
        raise InputError(
            f"{path}, [parameters]: a rod of {1e3 * rod:g} mm does not go into a bore of {1e3 * bore:g} mm; check "
            "rod_diameter, bore_diameter and their units"
        )


def unit_after(parameter: Parameter) -> str:
    """The unit as it follows a number; nothing of a plain number."""
    return "" if parameter.unit == "1" else f" {parameter.unit}"
