"""What a trial's folder holds: records, and a rig file that says what the owner of the rig knows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np

from validation.twins.air import Array
from validation.twins.declared import PRESSURES
from validation.twins.instruments import Channel, channel_of
from validation.twins.measured import VirtualRig


class Listed(Protocol):
    """A record as a rig file lists it."""

    @property
    def name(self) -> str:
        """Of the record and of its file."""

    @property
    def role(self) -> str:
        """identify or validate."""


def unit_of_column(name: str) -> str:
    """SI unit of a record's column."""
    if name == "time":
        return "s"
    if name.startswith("setpoint"):
        return "m"
    return channel_of(name).unit


_DECIMALS = {"s": 4, "V": 6, "m": 7, "Pa": 1, "K": 4, "rad": 7}


def write_record(path: Path, columns: Mapping[str, Array]) -> None:
    units = [unit_of_column(name) for name in columns]
    np.savetxt(
        path,
        np.column_stack(list(columns.values())),
        fmt=[f"%.{_DECIMALS[unit]}f" for unit in units],
        delimiter=",",
        header=",".join(f"{n} [{u}]" for n, u in zip(columns, units, strict=True)),
        comments="",
    )


def rig_file(
    rig: VirtualRig,
    runs: Sequence[Listed],
    channels: Mapping[str, Channel],
    spread: float,
    calibrated: bool,
) -> str:
    """What the rig's owner knows; nothing in it depends on the effect.

    calibrated: zero and gain of the pressure sensors are known exactly, and not only as those of any such sensor.
    """
    rows = ["time = " + '"time"']
    # Held from one row to the next, or from one of the commands between two rows, of which the owner knows nothing.
    held = rig.clock.held
    declared = "previous" if held else "linear"
    known = not held or rig.clock.period == rig.sample_step
    for command in rig.commands:
        source = f'{{ column = "{command}", hold = "{declared}" }}' if known else f'"{command}"'
        rows.append(f"{command} = {source}")
    for signal in rig.signals:
        channel = channel_of(signal, channels)
        noise_text = f"{spread * channel.deviation:.3g} {channel.unit}"
        step = f"{channel.step:.4g} {channel.unit}"
        rows.append(
            f'{signal} = {{ column = "{signal}", noise = "{noise_text}", resolution = "{step}" }}'
        )
    parameters = [
        f"{d.parameter} = {{ value = {_quantity(d.value, d.unit)}, "
        f"uncertainty = {_quantity(d.half_width, d.unit)} }}"
        for d in rig.declared
    ]
    if calibrated:
        parameters += sensors_as_calibrated(rig.signals)
    command = (
        f"A controller of {1.0 / rig.clock.period:g} Hz holds its command."
        if held
        else "The command runs straight from one sample to the next."
    )
    return "\n".join(
        [
            "[rig]",
            f'kind = "{rig.kind}"',
            f'title = "{rig.title}"',
            f'notes = "Made by an independent simulator. {command}"',
            "",
            "[signals]",
            *rows,
            "",
            "[parameters]",
            *parameters,
            "",
            *(entry(run) for run in runs),
        ]
    )


def sensors_as_calibrated(signals: Sequence[str]) -> list[str]:
    """Rows for [parameters], of the sensors for which the core allows an error where nothing is declared."""
    rows = []
    for stem in PRESSURES:
        if any(signal.startswith(stem) for signal in signals):
            rows.append(f'sensor_offset_{stem} = {{ value = "0 Pa", uncertainty = "0 Pa" }}')
            rows.append(f"sensor_gain_{stem} = {{ value = 0.0, uncertainty = 0.0 }}")
    return rows


def entry(run: Listed, conditions: Mapping[str, str] | None = None) -> str:
    """The record's table; conditions: parameter -> its value in this run, with its unit."""
    told = ", ".join(f'{name} = "{value}"' for name, value in (conditions or {}).items())
    last = f"conditions = {{ {told} }}\n" if told else ""
    return f'[[records]]\nfile = "{run.name}.csv"\nrole = "{run.role}"\nname = "{run.name}"\n{last}'


def _quantity(value: float, unit: str) -> str:
    return f"{value:g}" if unit == "1" else f'"{value:g} {unit}"'
