"""Reference of the TOML files, from the JSON schemas that `sms schema` writes."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from sms import schemas

from tools.site.prose import escaped, indented, restructured, title

Schema = Mapping[str, Any]
HEADS = {
    "rig": "Every table and key of a rig file, from the schema that ``sms schema rig`` writes and by which editors "
    "complete and check. What they are for and complete examples: :doc:`/rig_file`.",
    "scenario": "Every table and key of a scenario, from the schema that ``sms schema scenario`` writes. What they are "
    "for: :doc:`/simulation`.",
    "poses": "Every table and key of a rig file of ``sms calibrate geometry``, from the schema that ``sms schema "
    "poses`` writes. What they are for: :doc:`/calibration`.",
}


def pages() -> Iterator[tuple[str, str]]:
    """(name, text) of every page."""
    for subject in schemas.SUBJECTS:
        schema = json.loads(schemas.shipped(subject))
        label = {
            "rig": "Keys of a rig file",
            "scenario": "Keys of a scenario",
            "poses": "Keys of a rig file of poses",
        }[subject]
        out = [*title(label), HEADS[subject], ""]
        for name, entry in schema["properties"].items():
            out += _table(name, entry, schema, name in schema.get("required", ()))
        yield f"files/{subject}", "\n".join(out) + "\n"


def _resolved(entry: Schema, schema: Schema) -> Schema:
    while "$ref" in entry:
        entry = schema["$defs"][entry["$ref"].rpartition("/")[2]]
    for choice in entry.get("anyOf", ()):
        if "$ref" in choice and "properties" in _resolved(choice, schema):
            return _resolved(choice, schema)
    return entry


def _table(name: str, entry: Schema, schema: Schema, required: bool) -> Iterator[str]:
    of = _resolved(entry, schema)
    if of.get("type") == "array":
        yield from title(f"[[{name}]]", "-")
        of = _resolved(of["items"], schema)
    elif isinstance(of.get("additionalProperties"), dict):
        yield from title(f"[{name}.NAME]", "-")
        of = _resolved(of["additionalProperties"], schema)
    else:
        yield from title(f"[{name}]", "-")
    if required:
        yield from ("Required.", "")
    for variant in of.get("oneOf", (of,)):
        one = _resolved(variant, schema)
        yield from _text(one)
        each = _of_each_name(one, schema)
        if each:
            yield from (*_text(each), *_list(each, schema), "")
        for key, value in one.get("properties", {}).items():
            yield from _key(key, value, schema, key in one.get("required", ()), each is None)
        for pattern in one.get("patternProperties", {}):
            yield from (f"Also, of one leg of the platform: ``{pattern}``.", "")


def _of_each_name(of: Schema, schema: Schema) -> Schema | None:
    """The table that stands behind every name of a table of names, [signals] or [parameters]."""
    tables = [_resolved(entry, schema) for entry in of.get("properties", {}).values()]
    alike = tables and "properties" in tables[0] and all(table is tables[0] for table in tables)
    return tables[0] if alike else None


def _text(of: Schema) -> Iterator[str]:
    """What a table is, a paragraph."""
    if "description" in of:
        yield from (*restructured(_without_name(str(of["description"])).split("\n")), "")


def _without_name(text: str) -> str:
    """A table's docstring begins with its name, "[rig]: ...", which is the heading here."""
    head, colon, rest = text.partition("]: ")
    return rest[:1].upper() + rest[1:] if colon and head.startswith("[") else text


def _key(key: str, value: Schema, schema: Schema, required: bool, inside: bool) -> Iterator[str]:
    """A key; inside: of a table, with those that it has."""
    yield from (
        f".. describe:: {key}",
        "",
        *indented([f"*{_kind(value, schema)}*" + _rest(value, required)]),
        "",
    )
    of = _resolved(value, schema)
    if text := value.get("description") or of.get("description"):
        yield from (*indented(restructured(text.split("\n"))), "")
    if inside and "properties" in of:
        yield from (*indented(list(_list(of, schema))), "")


def _list(of: Schema, schema: Schema) -> Iterator[str]:
    """The keys of a table that stands inside of another, a line each."""
    for key, value in of["properties"].items():
        told = f"- ``{key}``: *{_kind(value, schema)}*" + _rest(
            value, key in of.get("required", ())
        )
        text = " ".join(value.get("description", "").split())
        yield f"{told}. {escaped(text)}" if text else told


def _rest(value: Schema, required: bool) -> str:
    if required:
        return ", required"
    default = value.get("default")
    return (
        ""
        if default is None or isinstance(default, dict)
        else f", default ``{json.dumps(default)}``"
    )


def _kind(value: Schema, schema: Schema) -> str:
    """A type in words."""
    if "enum" in value:
        return escaped(", ".join(str(v) for v in value["enum"]))
    if "const" in value:
        return escaped(str(value["const"]))
    if "$ref" in value:
        name = value["$ref"].rpartition("/")[2]
        of = schema["$defs"][name]
        return _kind(of, schema) if "anyOf" in of or "enum" in of else "table"
    if "anyOf" in value:
        kinds = [_kind(v, schema) for v in value["anyOf"] if v.get("type") != "null"]
        return ("; or " if any("," in kind for kind in kinds) else " or ").join(
            dict.fromkeys(kinds)
        )
    if "date" in value.get("format", ""):
        return "date"
    kind = value.get("type", "any")
    if isinstance(kind, list):
        return "text with a unit, or number"
    if kind == "array":
        return f"list of {_kind(value.get('items', {}), schema)}"
    return {"string": "text", "object": "table", "boolean": "true or false"}.get(kind, str(kind))
