"""What the compiled FMU library says of itself: the variables of each model, and its token (libsms/fmi/describe.h).

It lies beside the compiled module, with the sources it was made of; nothing is compiled when an FMU is exported.
"""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from sms import _core
from sms.errors import InputError

KINDS = ("bench", "platform", "tank", "controller")
_TYPES = ("real", "enumeration", "boolean")
_CAUSALITIES = ("independent", "parameter", "input", "output", "local")
_UNBOUNDED = 1e300


@dataclass(frozen=True)
class Variable:
    """One variable of an exported model; its place in the list is its value reference."""

    name: str
    unit: str  #: SI, as pint reads it; "1" is dimensionless
    doc: str
    choices: tuple[str, ...]  #: of an enumeration, from 1 on
    type: str  #: "real", "enumeration" or "boolean"
    causality: str  #: "independent", "parameter", "input", "output" or "local"
    sampled: bool  #: changes at multiples of the control period alone
    start: float
    lower: float | None
    upper: float | None


class _Described(ctypes.Structure):
    """sms_fmu_variable."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("unit", ctypes.c_char_p),
        ("doc", ctypes.c_char_p),
        ("choices", ctypes.c_char_p),
        ("type", ctypes.c_int),
        ("causality", ctypes.c_int),
        ("sampled", ctypes.c_int),
        ("start", ctypes.c_double),
        ("lower", ctypes.c_double),
        ("upper", ctypes.c_double),
    )


def folder() -> Path:
    """Where the library and its sources are installed."""
    return Path(_core.__file__).parent / "fmu"


def library_file() -> Path:
    """The compiled library. InputError where the package was built without it."""
    file = folder() / "sms_fmu.so"
    if not file.is_file():
        raise InputError(
            f"{file}: there is no such file, so sms was built without its library for FMUs; ./dev build in a "
            "checkout makes it, elsewhere install sms again, with -Ccmake.define.SMS_FMU=ON where it is compiled"
        )
    return file


@cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(library_file()))
    library.sms_fmu_token.restype = ctypes.c_char_p
    library.sms_fmu_token.argtypes = (ctypes.c_int,)
    library.sms_fmu_describe.argtypes = (
        ctypes.c_int,
        ctypes.c_int,
        ctypes.POINTER(_Described),
    )
    return library


def token_of(kind: str, starts: Mapping[str, float]) -> str:
    """What modelDescription.xml has to carry for this library; with it the library learns of start values, SI."""
    token = bytes(_library().sms_fmu_token(KINDS.index(kind))).decode()
    for reference, variable in enumerate(variables_of(kind)):
        start = starts.get(variable.name, variable.start)
        if start != variable.start:
            token += f" {reference}={struct.pack('>d', start).hex()}"
    return token


@cache
def variables_of(kind: str) -> tuple[Variable, ...]:
    """The variables of one of KINDS, in the order of their value references."""
    found: list[Variable] = []
    row = _Described()
    while _library().sms_fmu_describe(KINDS.index(kind), len(found), ctypes.byref(row)):
        found.append(
            Variable(
                name=row.name.decode(),
                unit=row.unit.decode(),
                doc=row.doc.decode(),
                choices=tuple(row.choices.decode().split()),
                type=_TYPES[row.type],
                causality=_CAUSALITIES[row.causality],
                sampled=bool(row.sampled),
                start=row.start,
                lower=None if row.lower <= -_UNBOUNDED else row.lower,
                upper=None if row.upper >= _UNBOUNDED else row.upper,
            )
        )
    return tuple(found)
