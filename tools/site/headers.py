"""What C and C++ headers say of themselves: the prose at their head, the comment before a declaration and behind it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HEADERS = Path(__file__).resolve().parents[2] / "libsms" / "include" / "sms"
TRAILING = re.compile(r"\s*(?:/\*(.*?)\*/|//(.*))\s*$")


@dataclass(frozen=True)
class Header:
    """One header, by lines."""

    path: Path
    lines: Sequence[str]

    @property
    def head(self) -> list[str]:
        """The comment that opens it."""
        return self.comment_above(self._first_of_code(), attached=False)

    def _first_of_code(self) -> int:
        block = self.lines[0].startswith("/*")
        for number, line in enumerate(self.lines, 1):
            if block and "*/" in line:
                return number + 1
            if not block and not line.startswith("//"):
                return number
        return len(self.lines)

    def comment_above(self, number: int, attached: bool = True) -> list[str]:
        """The comment that ends on the line before line `number` (from 1), without its marks."""
        end = number - 1
        if attached:
            while end > 0 and re.match(
                r"\s*(template\b|\[\[|inline\b|constexpr\b)", self.lines[end - 1]
            ):
                end -= 1
        if end < 1:
            return []
        last = self.lines[end - 1].strip()
        if last.startswith("//"):
            begin = end
            while begin > 1 and self.lines[begin - 2].strip().startswith("//"):
                begin -= 1
            return [re.sub(r"^\s*// ?", "", line) for line in self.lines[begin - 1 : end]]
        if last.endswith("*/"):
            begin = end
            while begin > 1 and "/*" not in self.lines[begin - 1]:
                begin -= 1
            block = list(self.lines[begin - 1 : end])
            if not block[0].strip().startswith("/*") or "----" in block[0]:
                return []
            return [self._unmarked(line) for line in block]
        return []

    @staticmethod
    def _unmarked(line: str) -> str:
        line = re.sub(r"^\s*/?\*+ ?", "", line.rstrip())
        return re.sub(r"\s*\*+/$", "", line)

    def comment_behind(self, number: int) -> str:
        """The comment at the end of line `number` (from 1)."""
        found = TRAILING.search(self.lines[number - 1])
        return (found[1] or found[2] or "").strip() if found else ""


def read(name: str) -> Header:
    """A header of libsms/include/sms."""
    path = HEADERS / name
    return Header(path, path.read_text(encoding="utf-8").split("\n"))
