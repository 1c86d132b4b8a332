"""`sms ik`, `fk`, `workspace` with --mechanism, and `sms path`: mechanisms given by a TOML file."""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import typer

from sms import StatusError
from sms.arrays import Array
from sms.errors import InputError
from sms.mechanism import COORDINATES, POSE, Mechanism, Solution
from sms.mechanism_file import load_mechanism

if TYPE_CHECKING:
    from sms.io.table import Table

NOT_DRIVABLE = 1


def ik(file: str, given: Mapping[str, float], as_json: bool) -> None:
    """Lengths of the legs in a pose whose coordinates that are not given are the home pose's."""
    mechanism = load_mechanism(file)
    for name in given:
        if name not in mechanism.driven:
            raise InputError(
                f"--{name}: it follows from {', '.join(mechanism.driven)}; leave it out"
            )
    pose = [given.get(name, at) for name, at in zip(COORDINATES, mechanism.home, strict=True)]
    found = mechanism.inverse(pose)
    _answer("mechanism_ik", mechanism, found, as_json)


def fk(file: str, length: Sequence[float], as_json: bool) -> None:
    """Pose of the actuated legs' lengths."""
    mechanism = load_mechanism(file)
    if len(length) != mechanism.freedoms:
        raise InputError(
            f"--length: {mechanism.freedoms} legs are actuated, {len(length)} lengths given; say --length once for each"
        )
    _answer("mechanism_fk", mechanism, mechanism.forward(length), as_json)


def workspace(file: str, out: Path, as_json: bool) -> None:
    """How far each driven coordinate alone goes."""
    from sms.io import write_text_atomically  # noqa: PLC0415 (pandas takes its time)
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.io.write import check_output_folder  # noqa: PLC0415
    from sms.mechanism_reach import reaches  # noqa: PLC0415

    mechanism = load_mechanism(file)
    check_output_folder(out)
    found = reaches(mechanism)
    rows = [
        {
            "coordinate": r.coordinate,
            "unit": dict(POSE)[r.coordinate],
            "end": r.end,
            "beyond": r.why,
            "largest_condition_number": r.condition,
        }
        for r in found
    ]
    content = {
        "mechanism": mechanism.name,
        "home": dict(zip(COORDINATES, mechanism.home, strict=True)),
        "reach": rows,
    }
    text = json_text("mechanism_workspace", content)
    write_text_atomically(out / "workspace.json", text)
    if as_json:
        print(text, end="")
        return
    for r in found:
        print(
            f"{r.coordinate:<6} {_quantity(r.coordinate, r.end):>12}   beyond: {r.why} "
            f"(condition number up to {r.condition:.3g})"
        )
    print(f"written: {out / 'workspace.json'}")


def path(poses: Path, mechanism: str, as_json: bool) -> None:
    """What is singular or out of reach on a path; Exit(NOT_DRIVABLE) where it cannot be driven."""
    from sms.io.json_files import json_text  # noqa: PLC0415

    of = load_mechanism(mechanism)
    wanted, lines = _read_poses(poses, of)
    try:
        found = of.inverse(wanted)
        singular = of.singularities(found.pose)
    except StatusError as problem:
        raise InputError(f"{poses}: {problem}") from None
    outside = of.outside_range(found.length)
    condition, _ = of.conditioning(found.pose)
    worst = int(np.argmax(condition))
    content: dict[str, Any] = {
        "mechanism": of.name,
        "drivable": not singular and not outside,
        "poses": len(wanted),
        "singularities": [
            {"after_line": lines[s.row], "fraction": s.fraction, **_pose_json(s.pose)}
            for s in singular
        ],
        "legs_outside_range": [
            {"line": lines[row], "leg": leg + 1, "length_m": float(found.length[row, leg])}
            for row, leg in outside
        ],
        "largest_condition_number": float(condition[worst]),
        "largest_condition_number_line": lines[worst],
    }
    if as_json:
        print(json_text("mechanism_path", content, [poses]), end="")
    else:
        for s in singular:
            print(
                f"singular {100 * s.fraction:.1f} % of the way from line {lines[s.row]} to {lines[s.row + 1]}: "
                f"{_pose_text(s.pose)}"
            )
        for row, leg in outside:
            print(
                f"line {lines[row]}: leg {leg + 1} would be {found.length[row, leg]:.6g} m, outside {_range(of, leg)}"
            )
        print(
            f"largest condition number of the {len(wanted)} poses: {condition[worst]:.4g}, line {lines[worst]}"
        )
        if content["drivable"]:
            print("the path can be driven")
    if not content["drivable"]:
        print(f"sms: {poses}: the path cannot be driven", file=sys.stderr)
        raise typer.Exit(NOT_DRIVABLE)


def _read_poses(file: Path, mechanism: Mechanism) -> tuple[Array, list[int]]:
    """Poses of a table, (n, 6), and the line of each."""
    from sms.io.table_files import open_table  # noqa: PLC0415
    from sms.io.units import split_column_name  # noqa: PLC0415

    table = open_table(file)
    columns = {
        split_column_name(name)[0].lower(): number for number, name in enumerate(table.names)
    }
    if not set(columns) & set(mechanism.driven):
        raise InputError(
            f"{file}: no column is driven; name them like 'z [m]', of {', '.join(mechanism.driven)}"
        )
    known = [
        _column(table, columns[name], unit, name) if name in columns else None
        for name, unit in POSE
    ]
    count = next(values.size for values in known if values is not None)
    if not count:
        raise InputError(f"{file}: there is no pose; write one a line")
    parts = [
        np.full(count, at) if values is None else values
        for values, at in zip(known, mechanism.home, strict=True)
    ]
    return np.stack(parts, axis=-1), [int(line) for line in table.lines]


def _column(table: Table, number: int, si_unit: str, name: str) -> Array:
    from sms.io.units import array_to_si, split_column_name  # noqa: PLC0415

    values, bad = table.numbers(number)
    if bad:
        raise InputError(
            f"{table.file}, line {int(table.lines[bad[0][0]])}, {name}: '{bad[0][1]}' is not a number"
        )
    unit = split_column_name(table.names[number])[1]
    where = f"{table.file}, column '{table.names[number]}'"
    if unit is None:
        raise InputError(f"{where}: the unit is missing; name it '{name} [{si_unit}]'")
    if not np.isfinite(values).all():
        line = int(table.lines[int(np.flatnonzero(~np.isfinite(values))[0])])
        raise InputError(f"{table.file}, line {line}, {name}: the number is missing; write one")
    return array_to_si(values, unit, si_unit, where)


def _answer(schema: str, mechanism: Mechanism, found: Solution, as_json: bool) -> None:
    from sms.io.json_files import json_text  # noqa: PLC0415

    condition, determinant = (float(v) for v in mechanism.conditioning(found.pose))
    if as_json:
        values = {
            "mechanism": mechanism.name,
            "length_m": [float(v) for v in found.length],
            **_pose_json(found.pose),
            "condition_number": condition,
            "determinant": determinant,
            "iterations": int(found.iterations),
            "residual_m": float(found.residual),
        }
        print(json_text(schema, values), end="")
    else:
        for number, (leg, length) in enumerate(zip(mechanism.legs, found.length, strict=True), 1):
            print(f"leg {number}      {1e3 * length:.4f} mm   ({leg.kind})")
        for name, value in zip(COORDINATES, found.pose, strict=True):
            print(f"{name:<9}  {_quantity(name, float(value))}")
        print(f"condition number {condition:.4g}, determinant {determinant:.4g}")
        print(f"{int(found.iterations)} Newton steps, residual {float(found.residual):.1g} m")
    for _, leg_number in mechanism.outside_range(np.atleast_2d(found.length)):
        print(
            f"sms: leg {leg_number + 1} = {found.length[leg_number]:.4f} m is outside {_range(mechanism, leg_number)}: "
            "the mechanism cannot reach this pose",
            file=sys.stderr,
        )


def _range(mechanism: Mechanism, leg: int) -> str:
    limits = mechanism.legs[leg].range
    return f"{limits[0]:g} to {limits[1]:g} m" if limits else "any range"


def _pose_json(pose: Array) -> dict[str, float]:
    return {f"{name}_{unit}": float(value) for (name, unit), value in zip(POSE, pose, strict=True)}


def _pose_text(pose: Array) -> str:
    return ", ".join(
        f"{name} {_quantity(name, float(v))}" for name, v in zip(COORDINATES, pose, strict=True)
    )


def _quantity(name: str, value: float) -> str:
    return f"{math.degrees(value):.4f}°" if name in COORDINATES[3:] else f"{1e3 * value:.3f} mm"
