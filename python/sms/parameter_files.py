"""Parameters in a file: `load_params` reads what `sms calibrate geometry` writes; `c_header` gives it to firmware."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path

from sms import _core
from sms.errors import InputError, did_you_mean
from sms.parameters import LEG_PARAMETERS, PARAMETERS, is_of_leg


def load_params(path: str | os.PathLike[str]) -> _core.LegParams:
    """The default parameters with those of a file's [parameters]; every function takes them as its `params`.

    The file is geometry.toml, or any TOML whose [parameters] has name = value or name = {value = ...}, with units
    ("1.365 m") as in a rig file. A name "sensor_gain_extension:2" is what leg 2 has more.

    Raises: InputError for what is not readable, not known, or outside the bounds of params.def.
    """
    params = _core.LegParams()
    for name, value in read_values(path).items():
        params[name] = value
    return params


def read_values(path: str | os.PathLike[str]) -> dict[str, float]:
    """What the [parameters] of such a file say, SI, by name; InputError as `load_params`."""
    from sms.io.units import to_si  # noqa: PLC0415 (pint takes its time)

    file = Path(path)
    try:
        content = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as problem:
        raise InputError(
            f"{file}: cannot be read ({problem.strerror}); name a parameter file"
        ) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        raise InputError(f"{file}: not TOML ({problem}); correct that line") from None
    table = content.get("parameters")
    if not isinstance(table, dict) or not table:
        raise InputError(
            f"{file}: the table [parameters] is missing; sms calibrate geometry writes one"
        )
    values = {}
    for name, said in table.items():
        where = f"{file}, [parameters] {name}"
        if name not in LEG_PARAMETERS:
            near = did_you_mean(name, PARAMETERS, "docs/parameters.md lists all")
            raise InputError(f"{where}: not a parameter; {near}")
        text = said.get("value") if isinstance(said, dict) else said
        if not isinstance(text, (int, float, str)) or isinstance(text, bool):
            raise InputError(
                f'{where}: no value; write {{ value = "1.2 {LEG_PARAMETERS[name].unit}" }}'
            )
        row = LEG_PARAMETERS[name]
        value = to_si(text, row.unit, where)
        if not row.lower <= value <= row.upper:
            raise InputError(
                f"{where}: {value:g} {row.unit} is outside {row.lower:g} to {row.upper:g}; correct it"
            )
        values[name] = value
    return values


def c_header(params: _core.LegParams, source: str) -> str:
    """A C header with `static inline void sms_params_as_built(sms_params *p)`, which sets what is not the default.

    What one leg has more has no place in sms_params and stands in a comment.
    """
    default = _core.Params()
    lines = [
        f"/* {source}: the parameters that differ from the defaults of params.def. */",
        "#ifndef SMS_PARAMS_AS_BUILT_H",
        "#define SMS_PARAMS_AS_BUILT_H",
        "",
        '#include "sms/sms.h"',
        "",
        "/* p: filled by sms_params_default before. */",
        "static inline void sms_params_as_built(sms_params *p) {",
    ]
    for name, row in PARAMETERS.items():
        if params[name] != default[name]:
            unit = "" if row.unit == "1" else f" {row.unit};"
            lines.append(f"  p->{name} = {params[name]!r}; /*{unit} default {default[name]!r} */")
    for name in filter(is_of_leg, LEG_PARAMETERS):
        if params[name] != 0.0:
            lines.append(
                f"  /* {name} = {params[name]!r}: of one leg's sensor, for its own calibration */"
            )
    return "\n".join([*lines, "}", "", "#endif", ""])
