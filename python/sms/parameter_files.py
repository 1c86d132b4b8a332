"""Parameters in a file: `load_params` reads what `sms calibrate geometry` writes; `c_header` gives it to firmware."""

from __future__ import annotations

import os
from pathlib import Path

from sms import _core
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
    from sms.io.declarations import read_declarations  # noqa: PLC0415 (pint takes its time)

    return {name: known.value for name, known in read_declarations(Path(path)).items()}


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
