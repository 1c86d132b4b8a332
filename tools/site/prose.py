"""The plain prose of comments and docstrings as reStructuredText: nothing in it is markup but what is meant."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

INDENT = 2  #: so much or more, outside a list, is set as it stands: a formula, a drawing
ITEM = re.compile(r"^- ")
SECTION = re.compile(r"^(Args|Arguments|Returns|Raises|Yields|Attributes|Example|Examples|Note):$")
CODE = re.compile(r"(`+)([^`]+?)\1")
MARKUP = re.compile(r"([\\*|])|(?<=\w)(_)(?!\w)")


def escaped(text: str) -> str:
    """Prose in which `names` are literals and no other character is markup."""
    parts, last = [], 0
    for code in CODE.finditer(text):
        end = "\\ " if re.match(r"\w", text[code.end() :]) else ""
        parts += [_plain(text[last : code.start()]), f"``{code[2].strip()}``{end}"]
        last = code.end()
    return "".join([*parts, _plain(text[last:])])


def _plain(text: str) -> str:
    return MARKUP.sub(lambda m: "\\" + m[0], text).replace("`", "\\`")


def restructured(lines: Sequence[str]) -> list[str]:
    """Paragraphs and lists as such, what is set off by its indent as a literal block."""
    out: list[str] = []
    literal: list[str] = []

    def flush() -> None:
        while literal and not literal[-1].strip():
            literal.pop()
        if literal:
            block = textwrap.dedent("\n".join(literal)).split("\n")
            out.extend(["", "::", "", *(f"   {line}".rstrip() for line in block), ""])
            literal.clear()

    in_item = False
    for line in lines:
        indent = len(line) - len(line.lstrip())
        if not line.strip():
            if literal:
                literal.append("")
            else:
                out.append("")
            in_item = False
        elif ITEM.match(line.lstrip()) and indent <= INDENT and not literal:
            if not in_item:
                out.append("")
            in_item = True
            out.append("- " + escaped(line.lstrip()[2:]))
        elif indent >= INDENT and in_item:
            out.append("  " + escaped(line.strip()))
        elif indent >= INDENT or (literal and indent):
            literal.append(line)
        else:
            flush()
            if in_item:
                out.append("")
                in_item = False
            out.append(escaped(line.strip()))
    flush()
    return out


def docstring(lines: Sequence[str]) -> list[str]:
    """A docstring's lines; what stands under "Args:" and its like is left to napoleon, its words escaped."""
    out: list[str] = []
    prose: list[str] = []
    section = False
    for line in lines:
        if SECTION.match(line):
            out += [*restructured(prose), "", line]
            prose, section = [], True
        elif section and (line.startswith(" ") or not line.strip()):
            out.append(re.match(r" *", line)[0] + escaped(line.strip()))  # type: ignore[index]
        else:
            section = False
            prose.append(line)
    return [*out, *restructured(prose)]


def title(text: str, underline: str = "=") -> list[str]:
    """A heading."""
    return [text, underline * len(text), ""]


def indented(lines: Sequence[str], by: int = 3) -> list[str]:
    """As the content of a directive."""
    return [" " * by + line if line.strip() else "" for line in lines]
