"""Mechanisms in a TOML file; docs/mechanisms.md has the format. Units stand in the keys: "base [mm]"."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sms.errors import InputError, did_you_mean
from sms.mechanism import COORDINATES, KINDS, POSE, Body, Leg, Mechanism

SHIPPED = Path(__file__).parent / "mechanisms"
_TABLES = ("mechanism", "home", "platform", "leg")
_LEG = {"base": "m", "platform": "m", "length": "m", "range": "m", "normal": None, "kind": None}
_MECHANISM = {"name": None, "driven": None, "characteristic_length": "m"}
_PLATFORM = {"mass": "kg", "cog": "m", "inertia": "kg m^2", "gravity": "m/s^2"}


def shipped() -> list[str]:
    """Names of the mechanisms that come with the package."""
    return sorted(file.stem for file in SHIPPED.glob("*.toml"))


def load_mechanism(path: str | os.PathLike[str]) -> Mechanism:
    """The mechanism of a file, or one that is shipped by its name. InputError names what is wrong where."""
    from sms.io.toml_tables import parse_toml, read_text  # noqa: PLC0415 (pydantic takes its time)

    file = Path(path)
    if str(path) in shipped() and not file.exists():
        file = SHIPPED / f"{path}.toml"
    if not os.path.exists(file):  # noqa: PTH110 (False also for what no path can be)
        raise InputError(
            f"{file}: there is no such mechanism file; name one, or one of {', '.join(shipped())}"
        )
    content = parse_toml(read_text(file, "mechanism file", "[[leg]]"), file)
    for name in content:
        if name not in _TABLES:
            raise InputError(f"{file}: [{name}] is not known here; {did_you_mean(name, _TABLES)}")
    about = _Table.of(content.get("mechanism", {}), f"{file}, [mechanism]", _MECHANISM)
    legs = content.get("leg")
    if not isinstance(legs, list) or not legs:
        raise InputError(f"{file}: there is no leg; write a [[leg]] for each")
    driven = about.words("driven", COORDINATES) if "driven" in about.values else COORDINATES
    try:
        return Mechanism(
            legs=tuple(_leg(table, f"{file}, leg {i}") for i, table in enumerate(legs, 1)),
            driven=driven,
            home=_home(content.get("home", {}), f"{file}, [home]"),
            characteristic_length=about.length("characteristic_length"),
            body=_body(content["platform"], f"{file}, [platform]")
            if "platform" in content
            else None,
            name=str(about.values.get("name", file.stem)),
        )
    except InputError as problem:
        text = str(problem)
        raise InputError(text if text.startswith(str(file)) else f"{file}: {text}") from None


@dataclass(frozen=True)
class _Table:
    """A table whose keys have lost their units and whose numbers are in SI."""

    values: Mapping[str, Any]
    where: str

    @staticmethod
    def of(table: object, where: str, units: Mapping[str, str | None]) -> _Table:
        from sms.io.units import split_column_name  # noqa: PLC0415 (pint takes its time)

        if not isinstance(table, dict):
            raise InputError(f"{where}: this must be a table")
        values: dict[str, Any] = {}
        for key, said in table.items():
            name, unit = split_column_name(key)
            if name not in units:
                raise InputError(f"{where}, {key}: not known here; {did_you_mean(name, units)}")
            if name in values:
                raise InputError(f"{where}, {key}: it is said twice; leave one out")
            si = units[name]
            if (unit is None) != (si is None):
                remedy = f"'\"{name} [{si}]\"'" if si else f"'{name}'"
                raise InputError(f"{where}, {key}: write {remedy}")
            values[name] = (
                said if si is None or unit is None else _numbers(said, unit, si, f"{where}, {key}")
            )
        return _Table(values, where)

    def vector(self, name: str, size: int = 3) -> tuple[float, ...]:
        if name not in self.values:
            raise InputError(f"{self.where}: {name} is missing")
        value = self.values[name]
        if not isinstance(value, np.ndarray):
            value = _numbers(value, "1", "1", f"{self.where}, {name}")
        if value.shape != (size,):
            raise InputError(f"{self.where}, {name}: {size} numbers are needed")
        return tuple(float(v) for v in value)

    def length(self, name: str) -> float | None:
        if name not in self.values:
            return None
        value = self.values[name]
        if value.ndim or not value > 0.0:
            raise InputError(f"{self.where}, {name}: one number above 0 is needed")
        return float(value)

    def words(self, name: str, known: Sequence[str]) -> tuple[str, ...]:
        said = self.values[name]
        if not isinstance(said, list):
            raise InputError(
                f"{self.where}, {name}: a list of names is needed, such as {list(known[2:5])}"
            )
        for word in said:
            if word not in known:
                raise InputError(f"{self.where}, {name}: '{word}' is none of {', '.join(known)}")
        return tuple(said)


def _numbers(said: object, unit: str, si: str, where: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    from sms.io.units import array_to_si  # noqa: PLC0415 (pint takes its time)

    flat = said
    while isinstance(flat, list):
        flat = [v for part in flat for v in (part if isinstance(part, list) else [part])]
        if not any(isinstance(v, list) for v in flat):
            break
    numbers = flat if isinstance(flat, list) else [flat]
    if any(isinstance(v, bool) or not isinstance(v, (int, float)) for v in numbers):
        raise InputError(f"{where}: '{said}' is not of plain numbers; the unit stands in the key")
    try:
        values = np.array(said, dtype=np.float64)
    except ValueError:
        raise InputError(f"{where}: its rows are of different lengths") from None
    if not np.isfinite(values).all():
        raise InputError(f"{where}: it must be of finite numbers")
    return array_to_si(values, unit, si, where)


def _three(values: tuple[float, ...]) -> tuple[float, float, float]:
    return values[0], values[1], values[2]


def _leg(table: object, where: str) -> Leg:
    of = _Table.of(table, where, _LEG)
    kind = of.values.get("kind", "actuated")
    if kind not in KINDS:
        raise InputError(f"{where}, kind: '{kind}' is none of {', '.join(KINDS)}")
    if kind != "fixed" and "length" in of.values:
        raise InputError(
            f'{where}, length: only a rod has one (kind = "fixed"); a range is "range [m]"'
        )
    limits = of.vector("range", 2) if "range" in of.values else None
    if limits is not None and not 0.0 <= limits[0] < limits[1]:
        raise InputError(f"{where}, range: the least length comes first, and is not below 0")
    if limits is not None and kind == "fixed":
        raise InputError(f"{where}, range: a rod has none; leave it out")
    return Leg(
        base=_three(of.vector("base")),
        platform=_three(of.vector("platform")),
        kind=kind,
        length=of.length("length"),
        range=None if limits is None else (limits[0], limits[1]),
        normal=_three(of.vector("normal")) if "normal" in of.values else None,
    )


def _home(table: object, where: str) -> tuple[float, ...]:
    of = _Table.of(table, where, dict(POSE))
    for name, value in of.values.items():
        if value.ndim:
            raise InputError(f"{where}, {name}: one number is needed")
    return tuple(float(of.values.get(name, 0.0)) for name in COORDINATES)


def _body(table: object, where: str) -> Body:
    of = _Table.of(table, where, _PLATFORM)
    mass = of.length("mass")
    if mass is None:
        raise InputError(f"{where}: mass is missing")
    if "inertia" not in of.values:
        raise InputError(f"{where}: inertia is missing")
    inertia = of.values["inertia"]
    if inertia.shape != (3, 3) or not np.array_equal(inertia, inertia.T):
        raise InputError(
            f"{where}, inertia: a symmetric matrix of three rows of three numbers is needed"
        )
    if not np.linalg.eigvalsh(inertia)[0] >= 0.0:
        raise InputError(f"{where}, inertia: no body has it: a principal moment is negative")
    gravity = _three(of.vector("gravity")) if "gravity" in of.values else (0.0, 0.0, -9.81)
    rows = tuple(_three(tuple(float(v) for v in row)) for row in inertia)
    return Body(mass=mass, cog=_three(of.vector("cog")), inertia=rows, gravity=gravity)
