"""Reference of the command line: a page for each command, from the help that the commands themselves print."""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum
from typing import Any

import typer.main
from sms.cli import app

from tools.site.prose import escaped, indented, restructured, title

BOLD = re.compile(r"\*\*(.+?)\*\*")
ITALIC = re.compile(r"(?<!\*)\*(\w[^*]*?)\*(?!\*)")


def commands() -> Iterator[tuple[str, Any]]:
    """("sms diagnose", the command), ..., those of groups too."""
    yield from _below("sms", typer.main.get_command(app))


def _below(name: str, command: Any) -> Iterator[tuple[str, Any]]:
    children = getattr(command, "commands", {})
    for word, child in sorted(children.items()):
        if getattr(child, "commands", None):
            yield from _below(f"{name} {word}", child)
        else:
            yield f"{name} {word}", child


def pages() -> Iterator[tuple[str, str]]:
    """(name, text) of every page."""
    for name, command in commands():
        out = [*title(name), *_prose(command.help or ""), "", f".. program:: {name}", ""]
        out += ["::", "", f"   {_usage(name, command)}", ""]
        for parameter in command.params:
            out += _parameter(parameter)
        if command.epilog:
            out += ["", *_marked(command.epilog)]
        yield f"command/{name.removeprefix('sms ').replace(' ', '_')}", "\n".join(out) + "\n"


def _usage(name: str, command: Any) -> str:
    arguments = [
        p.name.upper() + ("..." if p.nargs == -1 else "")
        for p in command.params
        if not is_option(p)
    ]
    return " ".join([name, "[OPTIONS]", *arguments])


def is_option(parameter: Any) -> bool:
    """Whether it is an option, not an argument."""
    return str(parameter.opts[0]).startswith("-")


def _parameter(parameter: Any) -> Iterator[str]:
    told = _default(parameter)
    value = "" if getattr(parameter, "is_flag", False) else f" <{_metavar(parameter)}>"
    if is_option(parameter):
        names = [*parameter.opts, *parameter.secondary_opts]
        yield f".. option:: {', '.join(f'{name}{value}' for name in names)}"
    else:
        yield f".. option:: {parameter.name.upper()}"
    yield ""
    yield from indented([*_prose(str(parameter.help or "")), *(["", told] if told else [])])
    yield ""


def _metavar(parameter: Any) -> str:
    """What stands for the value: the words that may be chosen, or its type. Of click and of typer's own core."""
    if parameter.metavar:
        return str(parameter.metavar)
    described = getattr(parameter, "type_descriptor", None)
    kind = described.annotation if described else getattr(parameter.type, "name", "value")
    if isinstance(kind, type) and issubclass(kind, Enum):
        return "|".join(str(member.value) for member in kind)
    return str(getattr(kind, "__name__", kind)).lower().strip("[]")


def _default(parameter: Any) -> str:
    value = parameter.default
    if parameter.required:
        return "Required."
    if value is None or value is False or callable(value) or value in ([], (), ""):
        return ""
    return f"Default: ``{getattr(value, 'value', value)}``."


def _prose(text: str) -> list[str]:
    lines: list[str] = []
    for paragraph in text.replace("\b", "").split("\n\n"):
        lines += [*_marked(" ".join(paragraph.split())), ""]
    return lines


def _marked(text: str) -> list[str]:
    """The help's **commands** and *words*; all else is prose."""
    marked = ITALIC.sub(r"`\1`", BOLD.sub(r"`\1`", text))
    return [escaped(marked)] if "\n" not in marked else restructured(marked.split("\n"))
