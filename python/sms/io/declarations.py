"""What is known of parameters: entries of [parameters], of a rig file or of a parameter file, in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sms.errors import InputError, nearest
from sms.io.data_files import beside
from sms.io.schema import ParameterFile, ParameterTable, RigTable
from sms.io.toml_tables import checked, parse_toml, read_text
from sms.io.units import interval_to_si, to_si
from sms.parameters import LEG_PARAMETERS, PARAMETERS, Parameter

LEAST_SHARE = 1e-15
"""Of a parameter's range: the least uncertainty but 0. Its square has to be a number. Numerics."""


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
        return _of_parameter_file(tables, path)
    geometry = rig.get("geometry")
    known = _calibrated(_named(geometry, path)) if isinstance(geometry, str) else {}
    return known | _of_tables(tables, path)


def as_calibrated(rig: RigTable, path: Path) -> tuple[Path | None, dict[str, Declaration]]:
    """The parameter file that [rig] geometry of the rig file `path` names, and what it says.

    The poses know parameters together far better than the half width of each alone says; so what is known better
    without the file, as a joint of the drawing is, stays known as well.
    """
    if rig.geometry is None:
        return None, {}
    if rig.kind != "platform":
        raise InputError(f"{path}, [rig] geometry: a {rig.kind} has no mechanism; leave it out")
    file = _named(rig.geometry, path)
    return file, _calibrated(file)


def _named(geometry: str, path: Path) -> Path:
    """The file that the rig file `path` names as its geometry."""
    return beside(path, geometry, "[rig] geometry", "parameter file")


def _calibrated(file: Path) -> dict[str, Declaration]:
    """Of a parameter file the values, and of its half widths those that are narrower than the default ones."""
    tables = parse_toml(read_text(file, "parameter file", "[parameters]"), file)
    return {
        name: Declaration(known.value, min(known.uncertainty, LEG_PARAMETERS[name].uncertainty))
        for name, known in _of_parameter_file(tables, file).items()
    }


def _of_parameter_file(tables: Mapping[str, Any], path: Path) -> dict[str, Declaration]:
    """As `_of_tables`; InputError where there is nothing, or an entry has no value."""
    entries = tables.get("parameters")
    if not entries:
        raise InputError(
            f"{path}: the table [parameters] is missing; sms calibrate geometry writes one"
        )
    declared = _of_tables(tables, path)
    for name, entry in entries.items():
        if isinstance(entry, Mapping) and "value" not in entry:
            unit = unit_after(LEG_PARAMETERS[name])
            raise InputError(
                f'{path}, [parameters] {name}: no value; write {{ value = "1.2{unit}" }}'
            )
    return declared


def _of_tables(tables: Mapping[str, Any], path: Path) -> dict[str, Declaration]:
    """The entries of [parameters], if there are any."""
    file = checked(ParameterFile, {"parameters": tables.get("parameters", {})}, path)
    where = f"{path}, [parameters]"
    return {
        name: declaration(name, table, where, LEG_PARAMETERS)
        for name, table in file.parameters.items()
    }


def least_uncertainty(parameter: Parameter) -> float:
    """The least half width that is read but for 0, which is that of a value known exactly."""
    return LEAST_SHARE * (parameter.upper - parameter.lower)


def declaration(
    name: str,
    table: ParameterTable,
    where: str,
    known: Mapping[str, Parameter] = PARAMETERS,
) -> Declaration:
    """One entry in SI units, its default where it says nothing; InputError begins with `where`."""
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
        if 0.0 < uncertainty < least_uncertainty(parameter):
            raise InputError(
                f"{where}: an uncertainty of {table.uncertainty} is beyond what can be calculated with; write 0 where "
                "the value is known exactly"
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
