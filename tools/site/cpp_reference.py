"""Reference of the C++ templates: a page for each header, its declarations as Doxygen reads them, its own prose."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from tools.site.headers import HEADERS, Header, read
from tools.site.prose import escaped, indented, restructured, title

DOXYFILE = """\
INPUT = {include}/sms
FILE_PATTERNS = *.hpp
INCLUDE_PATH = {include}
OUTPUT_DIRECTORY = {out}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = "__attribute__(x)="
EXTRACT_ALL = YES
QUIET = YES
WARNINGS = NO
"""
SPACES = ("sms", "sms::frame")
"""Namespaces of what is public; sms::detail is not."""


@dataclass(frozen=True)
class Declaration:
    """A function, class, enumeration, alias or variable of a namespace."""

    kind: str
    name: str  #: with its namespace
    head: str  #: as the C++ domain of Sphinx reads it
    line: int
    members: tuple[Declaration, ...] = ()


def declarations(out: Path) -> dict[str, list[Declaration]]:
    """Header -> what it declares, in its order. Doxygen's files go to `out`."""
    out.mkdir(parents=True, exist_ok=True)
    settings = DOXYFILE.format(include=HEADERS.parent, out=out)
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, capture_output=True)
    found: dict[str, list[Declaration]] = {}
    for file in sorted((out / "xml").glob("*.xml")):
        compound = ElementTree.parse(file).getroot().find("compounddef")
        if compound is None:
            continue
        name = compound.findtext("compoundname", "")
        if compound.get("kind") == "namespace" and name in SPACES:
            for member in compound.iter("memberdef"):
                _file(found, member, _member(member, name))
        elif compound.get("kind") in ("struct", "class") and "detail" not in name:
            _file(found, compound, _class(compound, name))
    for those in found.values():
        those.sort(key=lambda d: d.line)
    return found


def _file(
    found: dict[str, list[Declaration]], element: ElementTree.Element, one: Declaration
) -> None:
    place = element.find("location")
    assert place is not None
    found.setdefault(Path(place.get("file", "")).name, []).append(one)


def _text(element: ElementTree.Element | None) -> str:
    return "" if element is None else re.sub(r"\s+", " ", "".join(element.itertext())).strip()


def _template(element: ElementTree.Element) -> str:
    """ "template <typename S> ", or nothing."""
    listed = element.find("templateparamlist")
    if listed is None:
        return ""
    words = []
    for param in listed.iterfind("param"):
        word = " ".join(w for w in (_text(param.find("type")), _text(param.find("declname"))) if w)
        default = _text(param.find("defval"))
        words.append(f"{word} = {default}" if default else word)
    return f"template <{', '.join(words)}> "


def _line(element: ElementTree.Element) -> int:
    place = element.find("location")
    return 0 if place is None else int(place.get("line", "0"))


def _member(member: ElementTree.Element, space: str) -> Declaration:
    kind, name = member.get("kind", ""), member.findtext("name", "")
    full = f"{space}::{name}" if space else name
    template, result = _template(member), _text(member.find("type"))
    if kind == "function":
        arguments = re.sub(r"\s*=\s*(default|delete|0)$", "", _text(member.find("argsstring")))
        head = f"{template}{result} {full}{arguments}"
    elif kind == "enum":
        values = tuple(
            Declaration("enumerator", _text(v.find("name")), _text(v.find("name")), _line(member))
            for v in member.iterfind("enumvalue")
        )
        scoped = member.get("strong") == "yes"
        return Declaration("enum-class" if scoped else "enum", full, full, _line(member), values)
    elif kind == "typedef":
        head = f"{template}{full} = {result.removeprefix('typedef ')}"
        return Declaration("type", full, head, _line(member))
    else:
        head = f"{result} {full}{_text(member.find('argsstring'))}"
    head = head.replace("SMS_RESTRICT ", "").replace("constexpr constexpr", "constexpr")
    return Declaration(
        "function" if kind == "function" else "var", full, head.strip(), _line(member)
    )


def _class(compound: ElementTree.Element, name: str) -> Declaration:
    members = [
        _member(m, "")
        for m in compound.iter("memberdef")
        if m.get("prot") == "public" and m.get("kind") != "friend"
    ]
    kind = compound.get("kind", "struct")
    head = f"{_template(compound)}{name}"
    return Declaration(
        kind, name, head, _line(compound), tuple(sorted(members, key=lambda m: m.line))
    )


def pages(found: dict[str, list[Declaration]]) -> Iterator[tuple[str, str]]:
    """(name, text) of every page."""
    for path in sorted(HEADERS.glob("*.hpp")):
        header = read(path.name)
        out = [*title(f"``{path.name}``"), *restructured(header.head), ""]
        for one in found.get(path.name, []):
            out += _described(header, one, top=True)
        yield f"cpp/{path.stem}", "\n".join(out) + "\n"


def _described(header: Header, one: Declaration, top: bool) -> Iterator[str]:
    domain = {"var": "var", "class": "class", "struct": "struct", "type": "type"}.get(
        one.kind, one.kind
    )
    if not one.name or one.name.startswith("@"):
        return
    yield from (f".. cpp:{domain}:: {one.head}", "")
    prose = restructured(header.comment_above(one.line)) if one.kind != "enumerator" else []
    behind = "" if top or one.kind == "enumerator" else header.comment_behind(one.line)
    yield from indented([*prose, "", escaped(behind)] if behind else prose)
    yield ""
    for member in one.members:
        yield from indented(list(_described(header, member, top=False)))
