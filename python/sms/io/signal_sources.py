"""[signals] of a rig file: which column holds a signal, and what its sensor and converter make of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from sms.errors import InputError, did_you_mean
from sms.io.schema import ControlTable, RigFile, SignalTable
from sms.io.signals import (
    KINDS,
    SIGNAL_UNITS,
    SIGNALS,
    column_name,
    is_pressure,
    with_controller_simulated,
    without_leg,
)
from sms.io.units import interval_to_si, to_si

Hold = Literal["previous", "linear", "stepped"]
Rounding = Literal["nearest", "down"]


@dataclass(frozen=True)
class SignalSource:
    """Which column holds a signal: value in SI = scale * column in SI + offset."""

    signal: str
    column: str  #: "stroke" or "stroke [mm]"
    unit: str | None = None  #: overrides the unit in the column's name
    scale: float = 1.0
    offset: float = 0.0  #: in the SI unit of the signal
    gauge: bool = False  #: the sensor reads against ambient
    optional: bool = False  #: a record may lack this column
    noise: float | None = None  #: declared standard deviation of one sample, SI; None: not declared
    resolution: float = 0.0  #: one step of the converter, SI
    rounding: Rounding | None = None  #: of the converter; None: not declared
    range: tuple[float, float] | None = (
        None  #: the smallest and largest reading, SI; None: not declared
    )
    hold: Hold | None = None  #: of a command, between its samples; None: as the record looks


def sources_of(
    file: RigFile, controls: Sequence[ControlTable], path: Path
) -> dict[str, SignalSource]:
    """Where each signal of a rig is; InputError for one that its kind has not, or that is needed and not listed."""
    kind = KINDS[file.rig.kind]
    drivers = {control.controller for control in controls}
    if "simulated" in drivers:
        kind = with_controller_simulated(kind, commanded="recorded" in drivers)
    # A record whose controller is not simulated may lack a set-point.
    spared = [s for s in kind.signals if without_leg(s) == "setpoint" and len(drivers) == 2]
    if file.signals is None:
        may_lack = (*kind.optional, *spared)
        return {s: SignalSource(s, column_name(s), optional=s in may_lack) for s in kind.signals}
    for signal in file.signals:
        if signal not in kind.signals:
            raise InputError(
                f"{path}, [signals]: a rig of kind '{file.rig.kind}' has no signal '{signal}'; "
                f"{did_you_mean(signal, kind.signals)}"
            )
    for signal in kind.needed:
        if signal not in file.signals:
            raise InputError(
                f"{path}, [signals]: the signal '{signal}' is needed but not listed; "
                f'add a line {signal} = "name of its column"'
            )
    found = {signal: _signal(signal, table, path) for signal, table in file.signals.items()}
    return found | {s: replace(found[s], optional=True) for s in spared}


def _signal(signal: str, table: SignalTable, path: Path) -> SignalSource:
    where = f"{path}, [signals] {signal}"
    offset = 0.0
    if table.offset is not None:
        offset = interval_to_si(table.offset, SIGNAL_UNITS[signal], f"{where}, offset")
    if table.gauge and not is_pressure(signal):
        raise InputError(f"{where}: only a pressure can be gauge; remove gauge = true")
    if table.scale == 0.0:
        raise InputError(f"{where}: scale = 0 leaves nothing of the column; write its real scale")
    if table.hold is not None and not signal.startswith("valve_command"):
        raise InputError(f"{where}: only a valve command can have a hold; remove hold")
    noise = None if table.noise is None else _size(signal, table.noise, f"{where}, noise")
    resolution = 0.0
    if table.resolution is not None:
        resolution = _size(signal, table.resolution, f"{where}, resolution")
    if table.rounding is not None and resolution == 0.0:
        raise InputError(f"{where}: rounding needs a step; write resolution too")
    return SignalSource(
        signal,
        table.column or column_name(signal),
        table.unit,
        table.scale,
        offset,
        table.gauge,
        noise=noise,
        resolution=resolution,
        rounding=table.rounding,
        range=_range(signal, table, where),
        hold=table.hold,
    )


def _range(signal: str, table: SignalTable, where: str) -> tuple[float, float] | None:
    """Where a sensor clips, as readings in SI."""
    if table.range is None:
        return None
    if signal == "time" or without_leg(signal) in ("valve_command", "setpoint"):
        raise InputError(f"{where}: only a sensor has a range; remove range")
    if len(table.range) != 2:
        raise InputError(f"{where}, range: write two readings, [smallest, largest]")
    low, high = (to_si(end, SIGNAL_UNITS[signal], f"{where}, range") for end in table.range)
    if low >= high:
        raise InputError(
            f"{where}, range: {table.range[0]} to {table.range[1]} is upside down; write the smaller end first"
        )
    return low, high


def _size(signal: str, text: str | float, where: str) -> float:
    """A noise or a resolution in SI: a difference, not negative."""
    size = interval_to_si(text, SIGNAL_UNITS[signal], where)
    if size < 0.0:
        raise InputError(f"{where}: {text} is negative; write its size")
    usual = SIGNALS[without_leg(signal)]
    if size > usual.high - usual.low:
        raise InputError(
            f"{where}: {text} is more than what such a sensor reads at all, {usual.low:g} to {usual.high:g} "
            f"{usual.unit}; check the number and its unit"
        )
    return size
