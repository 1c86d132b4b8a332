"""The JSON files of `sms`, for other programs: which file it is, in which version, and what it was made from.

Each is an object that begins with the same keys, and `json_text` is the only way to write one:

    schema           "sms.diagnosis", "sms.run", ...
    schema_version   grows when a key is taken away or comes to mean something else, not when one is added
    versions         of sms, its core, Python and numpy
    inputs           file name -> SHA-256 of its content, of every file that was read; absent where none was

Policy: docs/versions.md.
"""

from __future__ import annotations

import hashlib
import json
import math
import platform
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sms import _core

SCHEMA_VERSIONS: Mapping[str, int] = {
    "calibration": 1,
    "comparison": 1,
    "demo": 1,
    "diagnosis": 1,
    "diagnosis_comparison": 1,
    "forward_kinematics": 1,
    "history": 1,
    "identify_actuator": 1,
    "identify_flow": 1,
    "identify_friction": 1,
    "identify_spool": 1,
    "inverse_kinematics": 1,
    "measurements": 1,
    "mechanism_fk": 1,
    "mechanism_ik": 1,
    "mechanism_path": 1,
    "mechanism_workspace": 1,
    "noise": 1,
    "requirements": 1,
    "run": 1,
    "sweep": 1,
    "trials": 1,
    "validation": 1,
    "watch": 1,
    "watch_trials": 1,
    "workspace": 1,
}
"""Schema -> the version that is written."""


def json_text(schema: str, content: Mapping[str, Any], inputs: Iterable[Path] = ()) -> str:
    """The text of a JSON file: what it is, then `content`, whose NaN and infinities become null."""
    return json.dumps(document(schema, content, inputs), **_LAYOUT) + "\n"


def json_line(schema: str, content: Mapping[str, Any]) -> str:
    """One line of a file of JSON lines, each with its schema's version."""
    return json.dumps(plain({"schema_version": SCHEMA_VERSIONS[schema], **content})) + "\n"


def from_json_line(line: str) -> dict[str, Any]:
    """The content of a line of `json_line`, or of one without a version. ValueError for anything else."""
    content = json.loads(line)
    if not isinstance(content, dict):
        raise ValueError(f"not an object: {line[:40]!r}")
    content.pop("schema_version", None)
    return content


def document(
    schema: str, content: Mapping[str, Any], inputs: Iterable[Path] = ()
) -> dict[str, Any]:
    """What `json_text` writes, as a dictionary; a key of `content` goes before one of the same name."""
    head: dict[str, Any] = {
        "schema": f"sms.{schema}",
        "schema_version": SCHEMA_VERSIONS[schema],
        "versions": versions(),
    }
    if hashes := input_hashes(inputs):
        head["inputs"] = hashes
    found: dict[str, Any] = plain(head | dict(content))
    return found


def content_digest(content: Mapping[str, Any], without: Iterable[str] = ()) -> str:
    """SHA-256 of what a JSON file says, whatever its layout and the order of its keys; `without` keys of the top."""
    said = {key: value for key, value in content.items() if key not in set(without)}
    text = json.dumps(said, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def versions() -> dict[str, str]:
    """What computed the numbers."""
    return {
        "sms": _core.__version__,
        "core": _core.build_info,
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


def input_hashes(files: Iterable[Path]) -> dict[str, str]:
    """File name -> SHA-256 of its content; with its folder's where two have the same name.

    What is no regular file (a pipe) cannot be read twice, and is left out.
    """
    once = [f for f in dict.fromkeys(f.resolve() for f in files) if f.is_file()]
    names = [f.name for f in once]
    return {
        f.name if names.count(f.name) == 1 else f"{f.parent.name}/{f.name}": _sha256(f)
        for f in once
    }


def plain(value: Any) -> Any:
    """Only what JSON knows: no array, no NaN, no infinity."""
    if isinstance(value, Mapping):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


_LAYOUT: dict[str, Any] = {"indent": 1, "ensure_ascii": False, "allow_nan": False}


def _sha256(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()
