"""Commands of a test excitation: one axis of the pose, or each actuator by itself."""

from __future__ import annotations

import numpy as np

from sms._core import OutOfWorkspaceError
from sms.arrays import Array
from sms.errors import InputError
from sms.io.toml_tables import TextOrNumber
from sms.kinematics import inverse_kinematics
from sms.motion.excitation import aprbs, chirp, sine, steps
from sms.scenario.load import HIGHEST_FREQUENCY, LONGEST, Scenario
from sms.scenario.schema import AprbsTable, ChirpTable, ExcitationTable, SineTable, StepsTable
from sms.scenario.sent import Command
from sms.scenario.tables import within


def excited(scenario: Scenario, table: ExcitationTable) -> Command:
    """The command of [excitation]. InputError when it leaves the stroke or the valve's 0 to 10 V."""
    assert scenario.duration is not None
    count = round(scenario.duration / scenario.period) + 1
    time: Array = scenario.period * np.arange(float(count))
    axis: str = table.axis
    if scenario.plant != "platform" or scenario.controller == "open_loop":
        if axis not in ("actuators", "heave"):
            raise InputError(
                f"{scenario.where('excitation', 'axis')}: '{axis}' needs the whole platform under a "
                "closed loop; allowed here are actuators, heave (all of them alike)"
            )
        axis = "actuators"
    if axis == "actuators":
        return _each_actuator(scenario, table, time)
    return _one_axis(scenario, table, time, axis)


def _each_actuator(scenario: Scenario, table: ExcitationTable, time: Array) -> Command:
    """Volts, or extensions about the start."""
    unit = "V" if scenario.controller == "open_loop" else "m"
    width = 3 if scenario.plant == "platform" else 1
    amplitudes = _amplitudes(scenario, table, unit, width)
    values = np.column_stack([_signal(scenario, table, time, a, unit) for a in amplitudes])
    if unit == "V":
        values = values + scenario.params.command_offset
        _check_volts(scenario, time, values)
    else:
        values = values + _rest_extension(scenario, width)
        _check_stroke(scenario, time, values)
    where = "the valve" if scenario.plant == "tank" else "each actuator"
    words = (f"{_words(table)} on {where}, in {unit}.",)
    return Command(time, values, unit, None, None, words)


def _one_axis(scenario: Scenario, table: ExcitationTable, time: Array, axis: str) -> Command:
    unit = "m" if axis == "heave" else "rad"
    (amplitude,) = _amplitudes(scenario, table, unit, 1)
    pose = np.zeros((time.size, 3))
    pose[:, 2] = scenario.height
    column = ("roll", "pitch", "heave").index(axis)
    pose[:, column] += _signal(scenario, table, time, amplitude, unit)
    where = scenario.where("excitation", "amplitude")
    try:
        extension = inverse_kinematics(*pose.T, params=scenario.params).extension
    except OutOfWorkspaceError as problem:
        raise InputError(f"{where}: {problem}") from None
    _check_stroke(scenario, time, extension)
    return Command(time, extension, "m", pose, None, (f"{_words(table)} in {axis}.",))


def _rest_extension(scenario: Scenario, width: int) -> Array:
    if width == 1:
        return np.array([scenario.extension])
    level = inverse_kinematics(0.0, 0.0, scenario.height, params=scenario.params)
    return np.asarray(level.extension)


def _check_volts(scenario: Scenario, time: Array, volts: Array) -> None:
    beyond = np.abs(volts - 5.0)
    row, number = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    if beyond[row, number] > 5.0 + 1e-9:
        raise InputError(
            f"{scenario.where('excitation', 'amplitude')}: at {time[row]:.3f} s valve {number + 1} "
            f"would get {volts[row, number]:.2f} V, 0 to 10 V is allowed (the excitation is added to "
            f"{scenario.params.command_offset:g} V)"
        )


def _check_stroke(scenario: Scenario, time: Array, extension: Array) -> None:
    stroke = scenario.params.stroke
    beyond = np.maximum(-extension, extension - stroke)
    row, number = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    if beyond[row, number] > 0.0:
        raise InputError(
            f"{scenario.where('excitation', 'amplitude')}: at {time[row]:.3f} s actuator "
            f"{number + 1} would be at {1e3 * extension[row, number]:.1f} mm, outside the stroke, 0 "
            f"to {1e3 * stroke:g} mm; make the amplitude smaller"
        )


def _amplitudes(scenario: Scenario, table: ExcitationTable, unit: str, width: int) -> list[float]:
    """One for each actuator, in SI; a single one stands for all."""
    given = table.amplitude
    where = scenario.where("excitation", "amplitude")
    listed = given if isinstance(given, list) else [given] * width
    if len(listed) != width:
        raise InputError(
            f"{where}: {len(listed)} values are given; one value or {width} are allowed here"
        )
    most = {"V": 10.0, "rad": 0.6, "m": 10.0}[unit]
    return [within(value, unit, -most, most, where) for value in listed]


def _signal(
    scenario: Scenario, table: ExcitationTable, time: Array, amplitude: float, unit: str
) -> Array:
    """The excitation from its delay on; before, nothing."""

    def hertz(key: str, value: TextOrNumber) -> float:
        return within(value, "Hz", 0.0, HIGHEST_FREQUENCY, scenario.where("excitation", key))

    def seconds(key: str, value: TextOrNumber) -> float:
        where = scenario.where("excitation", key)
        return within(value, "s", 0.0, LONGEST, where, above=key != "delay")

    delay = seconds("delay", table.delay)
    late = np.maximum(time - delay, 0.0)
    if isinstance(table, SineTable):
        offset = 0.0
        if table.offset is not None:
            offset = scenario.number("excitation", "offset", table.offset, unit)
        jump = 0.0
        if table.jump is not None:
            jump = scenario.number("excitation", "jump", table.jump, unit)
        values = sine(late, amplitude, hertz("frequency", table.frequency), offset, jump)
    elif isinstance(table, ChirpTable):
        sweep = float(late[-1])
        if table.sweep is not None:
            sweep = seconds("sweep", table.sweep)
        first, last = hertz("first", table.first), hertz("last", table.last)
        values = chirp(late, amplitude, first, last, sweep)
    elif isinstance(table, AprbsTable):
        shortest, longest = seconds("shortest", table.shortest), seconds("longest", table.longest)
        values = aprbs(late, amplitude, shortest, longest, table.seed)
    elif isinstance(table, StepsTable):
        levels = [amplitude * level for level in table.levels]
        values = steps(late, levels, seconds("hold", table.hold))
    else:
        raise TypeError(f"no excitation: {table!r}")
    return np.where(time < delay, 0.0, values)


def _words(table: ExcitationTable) -> str:
    values = {k: v for k, v in table.model_dump().items() if v is not None}
    kind = values.pop("kind", "")
    values.pop("axis", None)
    return f"{kind} with " + ", ".join(f"{key} {value}" for key, value in values.items())
