"""JSON schemas of rig files, of scenarios and of rig files of poses, for editors that complete and check.

They are made from the models that check the files. The shipped files are what `made` gives of today's models;
`./dev docs` writes them anew.
"""

from __future__ import annotations

import json
from importlib import resources
from typing import Any, Literal, get_args

Subject = Literal["rig", "scenario", "poses"]
SUBJECTS: tuple[Subject, ...] = get_args(Subject)
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_QUANTITY = {"type": ["string", "number"]}


def shipped(subject: Subject) -> str:
    """The text of the schema that is installed with this version."""
    return (resources.files(__name__) / f"{subject}.schema.json").read_text(encoding="utf-8")


def made(subject: Subject) -> str:
    """The text of the schema that the models of this version make."""
    schema = {"rig": _rig, "scenario": _scenario, "poses": _poses}[subject]()
    title = {
        "rig": "sms rig file",
        "scenario": "sms scenario",
        "poses": "sms rig file of poses",
    }[subject]
    return (
        json.dumps({"$schema": _DIALECT, **schema, "title": title}, indent=1, ensure_ascii=False)
        + "\n"
    )


def _rig() -> dict[str, Any]:
    from sms.io.schema import RigFile  # noqa: PLC0415 (what is shipped needs no model)
    from sms.io.signals import KINDS, SIGNAL_UNITS, label  # noqa: PLC0415
    from sms.parameters import LEG_PARAMETERS, PARAMETERS, is_of_leg  # noqa: PLC0415

    schema = RigFile.model_json_schema()
    definitions = schema["$defs"]
    definitions["Signal"] = {"anyOf": [{"type": "string"}, {"$ref": "#/$defs/SignalTable"}]}
    definitions["Parameter"] = {
        "anyOf": [{"type": ["string", "number"]}, {"$ref": "#/$defs/ParameterTable"}]
    }
    known = dict.fromkeys(s for kind in KINDS.values() for s in kind.signals)
    schema["properties"]["signals"] = {
        "description": schema["properties"]["signals"]["description"],
        "type": "object",
        "properties": {
            s: {
                "$ref": "#/$defs/Signal",
                "description": f"{s if s == 'time' else label(s)}, {SIGNAL_UNITS[s]}",
            }
            for s in known
        },
        "additionalProperties": False,
    }
    legs = sorted({name.rpartition(":")[0] for name in LEG_PARAMETERS if is_of_leg(name)})
    schema["properties"]["parameters"] = {
        "description": schema["properties"]["parameters"]["description"],
        "type": "object",
        "properties": _parameters(PARAMETERS, {"$ref": "#/$defs/Parameter"}),
        "patternProperties": {f"^({'|'.join(legs)}):[1-3]$": {"$ref": "#/$defs/Parameter"}},
        "additionalProperties": False,
    }
    return schema


def _scenario() -> dict[str, Any]:
    from sms.parameters import PARAMETERS  # noqa: PLC0415
    from sms.scenario.schema import EXCITATIONS, ScenarioFile  # noqa: PLC0415

    schema = ScenarioFile.model_json_schema()
    for table in EXCITATIONS.values():
        of_kind = table.model_json_schema()
        schema["$defs"] |= of_kind.pop("$defs", {})
        schema["$defs"][table.__name__] = of_kind
    schema["properties"]["excitation"] = {
        "oneOf": [{"$ref": f"#/$defs/{table.__name__}"} for table in EXCITATIONS.values()]
    }
    schema["properties"]["parameters"] = {
        "description": schema["properties"]["parameters"]["description"],
        "type": "object",
        "properties": _parameters(PARAMETERS, _QUANTITY),
        "additionalProperties": False,
    }
    return schema


def _poses() -> dict[str, Any]:
    from sms.calibration.schema import PosesFile  # noqa: PLC0415

    return PosesFile.model_json_schema()


def _parameters(table: Any, of_each: dict[str, Any]) -> dict[str, Any]:
    return {
        name: {**of_each, "description": row.doc if row.unit == "1" else f"{row.doc}, {row.unit}"}
        for name, row in table.items()
    }
