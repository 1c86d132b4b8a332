"""What the header of a column says: words of its name, its unit, and whether a pressure is gauge or absolute.

Loggers write "pos [mm]", "pos (mm)", "pos / mm", "pos, mm" or "pos_mm", and pressures in "barg" or "Pa abs".
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from sms.errors import InputError
from sms.io.units import split_column_name, to_si

Reading = Literal["gauge", "absolute"]

_SPELLINGS = {
    **{u.lower(): u for u in ("s", "ms", "us", "min", "m", "cm", "mm", "um", "inch", "V", "mV")},
    **{u.lower(): u for u in ("Pa", "hPa", "kPa", "MPa", "bar", "mbar", "psi", "N", "kN", "lbf")},
    **{u.lower(): u for u in ("K", "degC", "degF", "deg", "rad", "mrad", "mA", "A", "%")},
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("msec", "milliseconds"), "ms"),
    **dict.fromkeys(("µs", "μs", "usec", "microseconds"), "us"),
    **dict.fromkeys(("µm", "μm"), "um"),
    **dict.fromkeys(("in", '"'), "inch"),
    **dict.fromkeys(("volt", "volts"), "V"),
    **dict.fromkeys(("°c", "c", "celsius"), "degC"),
    **dict.fromkeys(("°", "degree", "degrees"), "deg"),
    **dict.fromkeys(("percent", "pct"), "%"),
    "newton": "N",
}
"""Lower-case spelling of a unit -> as the unit parser knows it."""
_CASED = {"mPa": "MPa", "MV": "V", "Mm": "mm", "S": "s", "M": "m"}
_PRESSURE = re.compile(
    r"(m?bar|psi|[kMh]?Pa)[ _]?\(?(g|gauge|gage|rel|relative|a|abs|absolute)\)?", re.IGNORECASE
)
_BEHIND = (
    re.compile(r"(.+?)\s*[(\[{<]\s*([^()\[\]{}<>]*(?:\([^()]*\))?)\s*[)\]}>]"),
    re.compile(r"(.+?)\s*[/,]\s*([^\s/,]+(?: abs| gauge)?)"),
    re.compile(r"(.+?)\s+in\s+(\S+)"),
    re.compile(r"(.+?)[_ .]+([^\W_]+|%)"),
)
"""A name and, behind it, its unit, from the surest to the one that could be part of the name."""
SHORTEST = 3  #: letters of a name behind which "_s" or "_m" is a unit: "time_s", but not "p_s"


@dataclass(frozen=True)
class Header:
    """One column's header, taken apart."""

    name: str  #: without the unit
    unit: str | None  #: as the unit parser knows it
    reading: Reading | None
    understood: bool  #: a rig file needs to name no unit: brackets, in this very spelling

    @property
    def words(self) -> tuple[str, ...]:
        """Of the name, in small letters: "PistonPos_A2" -> piston pos a 2."""
        parted = re.sub(
            r"(?<=[a-z])(?=[A-Z])|(?<=[^\W\d_])(?=\d)|(?<=\d)(?=[^\W\d_])", " ", self.name
        )
        return tuple(re.findall(r"[^\W\d_]+|\d+", parted.lower()))


def known_unit(text: str) -> tuple[str, Reading | None] | None:
    """A unit as a person writes it, as the unit parser knows it; of a pressure, what it is counted from."""
    text = text.strip()
    pressure = _PRESSURE.fullmatch(text)
    if pressure:
        unit = _SPELLINGS[pressure[1].lower()]
        return unit, "absolute" if pressure[2][0].lower() == "a" else "gauge"
    found = _SPELLINGS.get(_CASED.get(text, text).lower())
    return None if found is None else (found, None)


def header_of(column: str) -> Header:
    """Take a header apart."""
    name, bracket = split_column_name(column)
    if bracket is not None:
        known = known_unit(bracket)
        if known is None and has_dimension(bracket):
            known = bracket, None
        if known is None:
            return Header(name, None, reading_of(bracket), False)
        reading = known[1] or reading_of(name)
        return Header(name, known[0], reading, known[0] == bracket)
    for pattern in _BEHIND:
        match = pattern.fullmatch(column.strip())
        known = known_unit(match[2]) if match else None
        if match is None or known is None:
            continue
        letters = sum(map(str.isalpha, match[1]))
        if pattern is _BEHIND[-1] and len(match[2]) == 1 and letters < SHORTEST:
            continue
        return Header(match[1], known[0], known[1] or reading_of(match[1]), False)
    return Header(name, None, reading_of(name), False)


def reading_of(text: str) -> Reading | None:
    """What words say of a pressure."""
    words = re.findall(r"[a-z]+", text.lower())
    if {"gauge", "gage", "rel", "relative"} & set(words):
        return "gauge"
    return "absolute" if {"abs", "absolute"} & set(words) else None


def has_dimension(unit: str, si_unit: str | None = None) -> bool:
    """Whether the unit parser knows a unit, and whether it is one of `si_unit`'s dimension."""
    for si in (
        (si_unit,) if si_unit else ("s", "m", "V", "Pa", "N", "K", "rad", "1", "m/s", "m/s^2")
    ):
        try:
            to_si(f"1 {unit}", si, "unit")
        except InputError:
            continue
        return True
    return False
