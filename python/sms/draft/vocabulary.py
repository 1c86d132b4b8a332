"""Words by which people name the signals of a pneumatic rig, and how well a column's name fits a signal.

English, German and the letters of the literature: u for the command, x for the position, p1 and p2 for the chambers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sms.draft.columns import Column
from sms.draft.header import has_dimension
from sms.io.signals import SIGNAL_UNITS, without_leg

OWN, STRONG, WEAK, LETTER, UNIT = 2.0, 1.0, 0.8, 0.6, 0.4
"""How well: the project's own name; a word for it; a word that can mean it; one letter; the unit alone."""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


@dataclass(frozen=True)
class Vocabulary:
    """Words for one signal. A column with a word of `never` is another one."""

    strong: frozenset[str]
    weak: frozenset[str] = frozenset()
    letters: frozenset[str] = frozenset()  #: count when nothing but a number stands beside them
    never: frozenset[str] = frozenset()


_DERIVED = _words(
    "velocity speed vel geschwindigkeit acceleration accel acc error err fehler rate flow durchfluss deriv dot est "
    "estimated model sim simulated amb ambient atm atmospheric room raum index counter count"
)
_POSITION = _words(
    "position pos extension displacement stroke travel weg hub lvdt potentiometer pot length elongation"
)
_WANTED = _words(
    "setpoint sp reference ref target desired des demand demanded soll sollwert wanted commanded set"
)
_COMMAND = _words("valve command cmd ventil stellsignal stellgroesse stell servo solenoid")
_PRESSURE = _words("p pa pb ps pt pressure press druck pr")
_FORCE = _words("force load loadcell kraft cell")
_LOWER = _words("lower low bottom cap blind below unten piston kolben kolbenseite")
_UPPER = _words("upper up top above oben annulus annular ring rod stange stangenseite")
_SUPPLY = _words("supply sup line reservoir source versorgung rail mains feed manifold vorrat ps")
_TANK = _words("tank vessel receiver kessel behaelter behälter")

VOCABULARY: Mapping[str, Vocabulary] = {
    "time": Vocabulary(
        _words("time zeit timestamp temps clock elapsed"), _words("sec seconds ms"), _words("t")
    ),
    "valve_command": Vocabulary(
        _COMMAND,
        _words("voltage spannung control input ao dac u"),
        _words("u v"),
        _DERIVED | _POSITION | _PRESSURE | {"spool"},
    ),
    "extension": Vocabulary(
        _POSITION,
        _words("piston rod kolben"),
        _words("x y z s"),
        _DERIVED | _WANTED | _COMMAND | _PRESSURE | _FORCE | {"spool"},
    ),
    "setpoint": Vocabulary(
        _WANTED, _words("command cmd"), _words("w r"), _DERIVED | {"valve", "u"}
    ),
    "spool_position": Vocabulary(_words("spool schieber"), never=_DERIVED | _WANTED),
    "rod_force": Vocabulary(_FORCE, letters=_words("f"), never=_DERIVED | {"friction"}),
    "tank_temperature": Vocabulary(
        _words("temperature temp temperatur thermocouple"), _words("t"), never=_DERIVED
    ),
    "roll": Vocabulary(_words("roll wanken wank"), _words("phi rx"), never=_DERIVED | _WANTED),
    "pitch": Vocabulary(
        _words("pitch nicken nick stampf"), _words("theta ry"), never=_DERIVED | _WANTED
    ),
}
PRESSURES: Mapping[str, Vocabulary] = {
    "chamber_pressure_lower": Vocabulary(_LOWER, never=_UPPER | _SUPPLY | _TANK),
    "chamber_pressure_upper": Vocabulary(_UPPER, never=_LOWER | _SUPPLY | _TANK),
    "supply_pressure": Vocabulary(_SUPPLY, _words("s 0"), never=_LOWER | _UPPER | _TANK),
    "tank_pressure": Vocabulary(_TANK, _words("t pt chamber"), never=_SUPPLY | {"s", "0"}),
}
"""Of columns that are a pressure by their unit or a word of their name."""
_SIDES = (_words("a pa head extend"), _words("b pb retract")), (_words("1"), _words("2"))
"""Of the lower and the upper chamber; a letter says more than a number, which may be the actuator's."""
_ALONE = {"tank_pressure", "chamber_pressure_lower"}
"""Pressures that a column named just "pressure" can be, on a rig that has one."""


def fit(signal: str, column: Column, words: tuple[str, ...], one_chamber: bool) -> float:
    """How well a column fits a signal, 0: not at all. words: of its name, without the number of its leg."""
    stem = without_leg(signal)
    unit = column.header.unit
    percent = stem == "valve_command" and unit == "%"
    if unit is not None and not percent and not has_dimension(unit, SIGNAL_UNITS[signal]):
        return 0.0
    if column.header.name == signal:
        return OWN
    present = frozenset(words)
    if stem in PRESSURES:
        return _pressure(stem, present, unit is not None, one_chamber)
    known = VOCABULARY[stem]
    if present & known.never:
        return 0.0
    if present & known.strong:
        return STRONG
    letters = tuple(word for word in words if not word.isdigit())
    if present & known.weak and (stem != "tank_temperature" or unit is not None):
        return WEAK
    if len(letters) == 1 and letters[0] in known.letters:
        return LETTER
    by_unit = (
        unit is not None
        and not percent
        and stem not in ("setpoint", "spool_position", "time", "roll", "pitch")
    )
    return UNIT if by_unit and not present & _DERIVED else 0.0


def _pressure(stem: str, present: frozenset[str], by_unit: bool, one_chamber: bool) -> float:
    known = PRESSURES[stem]
    if not (by_unit or present & _PRESSURE) or present & (known.never | _DERIVED):
        return 0.0
    if present & known.strong:
        return STRONG
    if present & known.weak or stem == _side(present):
        return WEAK
    return LETTER if one_chamber and stem in _ALONE else 0.0


def _side(present: frozenset[str]) -> str | None:
    """Which chamber a letter or a number means, if one does."""
    for lower, upper in _SIDES:
        if bool(present & lower) != bool(present & upper):
            return f"chamber_pressure_{'lower' if present & lower else 'upper'}"
        if present & lower:
            return None
    return None
