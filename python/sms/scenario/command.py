"""What is sent to the plant over time: set-points of the three extensions, or volts on the valves."""

from __future__ import annotations

import math

import numpy as np

from sms.errors import InputError
from sms.io.toml_tables import TextOrNumber
from sms.kinematics import inverse_kinematics
from sms.motion.deck import (
    COLUMN_UNITS,
    DeckMotion,
    band_limited,
    faded,
    froude_scaled,
    part,
    read_deck_motion,
    resampled,
    sampling_for,
)
from sms.motion.feasible import fitted
from sms.motion.limits import limits_of
from sms.motion.sea import synthetic_deck_motion
from sms.scenario.excited import excited
from sms.scenario.load import HIGHEST_FREQUENCY, LONGEST, Scenario, find_file
from sms.scenario.schema import DeckMotionTable, SeaTable
from sms.scenario.sent import Command
from sms.scenario.tables import within

_SMOOTH = 0.02  # s, the longest step between samples of a motion that is checked


def command_of(scenario: Scenario) -> Command:
    """The command of a scenario.

    Raises: InputError when it leaves the workspace (and is not to be cut), and for anything else in
    the tables that cannot be.
    """
    if scenario.deck_motion is not None:
        return _deck(scenario, scenario.deck_motion)
    if scenario.sea is not None:
        return _sea(scenario, scenario.sea)
    assert scenario.excitation is not None  # one of the three is there: load.py
    return excited(scenario, scenario.excitation)


# ---- a deck's motion ----


def _deck(scenario: Scenario, table: DeckMotionTable) -> Command:
    where = scenario.where("deck_motion")
    axes = {name: getattr(table, name) for name in COLUMN_UNITS}
    units = {name: getattr(table, f"{name}_unit") for name in COLUMN_UNITS}
    motion = read_deck_motion(
        find_file(table.file, scenario.path, f"{where} file"),
        {name: column for name, column in axes.items() if column is not None},
        {name: unit for name, unit in units.items() if unit is not None},
        table.delimiter,
        where,
    )
    if not (math.isfinite(table.scale) and 1e-3 <= table.scale <= 1e4):
        raise InputError(
            f"{where} scale: {table.scale:g} is outside the allowed range, 1e-3 to 1e4"
        )
    if table.scale != 1.0:
        motion = froude_scaled(motion, table.scale)
    first = _seconds(scenario, "deck_motion", "first", table.first, 0.0)
    last = _seconds(scenario, "deck_motion", "last", table.last, motion.duration)
    if scenario.duration is not None:
        last = min(last, first + scenario.duration)
    low = within(table.band_low, "Hz", 0.0, HIGHEST_FREQUENCY, f"{where} band_low")
    high = within(table.band_high, "Hz", 0.0, HIGHEST_FREQUENCY, f"{where} band_high", above=True)
    motion = band_limited(motion, low, high)
    if (first, last) != (0.0, motion.duration):
        motion = part(motion, first, last)
    motion = resampled(motion, min(_SMOOTH, sampling_for(high)))
    asked = [name for name in ("roll", "pitch", "heave") if axes[name] is not None]
    return _followed(scenario, motion, table, "deck_motion", asked)


def _sea(scenario: Scenario, table: SeaTable) -> Command:
    duration = scenario.duration or 300.0
    motion = synthetic_deck_motion(
        table.state, duration, table.seed, _SMOOTH, params=scenario.params
    )
    asked = ["roll", "pitch"]
    if table.heave:
        asked.append("heave")
    else:
        words = "heave left out: Table 2.1 asks for none (heave = true adds it)"
        motion = DeckMotion(
            motion.time,
            motion.roll,
            motion.pitch,
            np.zeros(motion.time.size),
            motion.origin,
            (*motion.done, words),
        )
    return _followed(scenario, motion, table, "sea", asked)


def _followed(
    scenario: Scenario,
    motion: DeckMotion,
    table: DeckMotionTable | SeaTable,
    name: str,
    asked: list[str],
) -> Command:
    """The motion within the limits, at the controller's period, as set-points."""
    motion = faded(motion, _seconds(scenario, name, "fade", table.fade, 0.0))
    clearance = None
    if table.clearance is not None:
        where = scenario.where(name, "clearance")
        clearance = within(table.clearance, "m", 0.0, 0.5 * scenario.params.stroke, where)
    model = scenario.model
    limits = limits_of(scenario.params, scenario.height, clearance, model.valve_law, model.masses)
    where = scenario.where(name, asked[0] if name == "deck_motion" else "state")
    feasible = fitted(motion, limits, table.beyond, where)
    fine = resampled(feasible.motion, scenario.period)
    pose = np.column_stack([fine.roll, fine.pitch, scenario.height + fine.heave])
    extension = inverse_kinematics(*pose.T, params=scenario.params).extension
    words = (f"{motion.origin}: " + "; ".join(motion.done) + ".",)
    return Command(fine.time, extension, "m", pose, feasible, words)


def _seconds(
    scenario: Scenario, table: str, key: str, value: TextOrNumber | None, default: float
) -> float:
    if value is None:
        return default
    return within(value, "s", 0.0, LONGEST, scenario.where(table, key))
