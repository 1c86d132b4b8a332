"""Builds the site: `python -m tools.site`, which `./dev docs` runs.

The pages of docs/ are taken as they are; what is made is beside them in build/docs/source. A warning of Sphinx is an
error, and so is a public name that the site does not have.
"""

from __future__ import annotations

import argparse
import importlib
import re
import shutil
import sys
import zlib
from collections.abc import Iterable
from pathlib import Path

from sphinx.cmd.build import build_main

from tools.site import (
    c_reference,
    command_line,
    cpp_reference,
    file_reference,
    gallery,
    python_reference,
)

ROOT = Path(__file__).resolve().parents[2]
OUT = ROOT / "build" / "docs"
OUTSIDE = re.compile(r"\]\(((?:validation|libsms|python)/[^)]*(?<!\.md))\)")
PAGE = re.compile(r"\]\((validation/[^)]*\.md)\)")
UNLINKED = re.compile(r"\[([^\]]+)\]\((?:libsms|python)/[^)]*\.md\)")
LINKED = (
    ".github",
    "libsms",
    "packaging",
    "python",
    "validation",
    "README.md",
    "CHANGELOG.md",
    "LICENSE",
)
"""What pages refer to outside their folder."""


def main() -> int:
    """Make the pages, build, look for missing names."""
    parser = argparse.ArgumentParser(prog="python -m tools.site")
    parser.add_argument("--out", type=Path, default=OUT, help="folder for source/ and site/")
    out = parser.parse_args().out.resolve()
    declared = cpp_reference.declarations(out / "doxygen")
    stage(out, declared)
    arguments = ["-W", "--keep-going", "-q", "-b", "html", "-E", "-d", str(out / "doctrees")]
    if code := build_main([*arguments, str(out / "source"), str(out / "site")]):
        return int(code)
    missing = sorted(wanted(declared) - inventory(out / "site" / "objects.inv"))
    for name in missing:
        print(f"not in the site: {name}")
    if not missing:
        print(f"{out / 'site' / 'index.html'}: {len(list((out / 'site').rglob('*.html')))} pages")
    return 1 if missing else 0


def stage(out: Path, declared: dict[str, list[cpp_reference.Declaration]]) -> None:
    """build/docs/source: docs/ as it is, and the pages that are made; a page that has not changed keeps its time."""
    source = out / "source"
    for name in LINKED:
        link = out / name
        if not link.exists():
            link.symlink_to(ROOT / name)
    wanted_files: set[Path] = set()
    for name in ("README", "CHANGELOG"):
        text = (ROOT / f"{name}.md").read_text(encoding="utf-8")
        text = OUTSIDE.sub(r"](../\1)", UNLINKED.sub(r"\1", text.replace("](docs/", "](")))
        for page in PAGE.findall(text):
            wanted_files.add(_put(source / page, (ROOT / page).read_bytes()))
        wanted_files.add(_put(source / f"{name.lower()}.md", text.encode()))
    for file in (ROOT / "docs").rglob("*"):
        if file.is_file() and "__pycache__" not in file.parts:
            wanted_files.add(_put(source / file.relative_to(ROOT / "docs"), file.read_bytes()))
    kept = out / "gallery"
    made = [
        *c_reference.pages(),
        *cpp_reference.pages(declared),
        *command_line.pages(),
        *file_reference.pages(),
        *python_reference.pages(),
        *gallery.pages(kept),
    ]
    for name, text in [*made, *_lists(name for name, _ in made)]:
        wanted_files.add(_put(source / f"{name}.rst", text.encode()))
    for picture in (kept / "pictures").glob("*.svg"):
        for folder in ("gallery/pictures", "_static/gallery"):
            wanted_files.add(_put(source / folder / picture.name, picture.read_bytes()))
    for old in source.rglob("*"):
        if old.is_file() and old not in wanted_files:
            old.unlink()


def _lists(names: Iterable[str]) -> list[tuple[str, str]]:
    """The page that lists those of a folder."""
    heads = {
        "c": "C",
        "cpp": "C++",
        "command": "Command line",
        "files": "Files",
        "python": "Python",
    }
    folders: dict[str, list[str]] = {}
    for name in names:
        folder, _, page = name.partition("/")
        folders.setdefault(folder, []).append(page)
    return [
        (
            f"{folder}/index",
            "\n".join(
                [
                    head,
                    "=" * len(head),
                    "",
                    ".. toctree::",
                    "   :maxdepth: 1",
                    "",
                    *(f"   {page}" for page in folders[folder]),
                ]
            )
            + "\n",
        )
        for folder, head in heads.items()
    ]


def _put(file: Path, content: bytes) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists() or file.read_bytes() != content:
        file.write_bytes(content)
    return file


def wanted(declared: dict[str, list[cpp_reference.Declaration]]) -> set[str]:
    """Every public name: "py:sms.friction", "c:sms_friction", "cpp:sms::friction", "option:sms diagnose --seed"."""
    names = {f"c:{name}" for name in c_reference.public_names()}
    names |= {
        f"cpp:{_close(d.name)}"
        for those in declared.values()
        for d in those
        if not d.name.startswith("@")
    }
    for module in python_reference.MODULES:
        public = python_reference.public_names(importlib.import_module(module))
        names |= {f"py:{module}.{name}" for name in public}
    for command, click_command in command_line.commands():
        for parameter in click_command.params:
            if command_line.is_option(parameter):
                names.add(f"std:{command.replace(' ', '-')}.{parameter.opts[0]}")
    return names


def _close(name: str) -> str:
    """A name of C++ without the spaces that Doxygen and Sphinx set differently."""
    return name.replace("< ", "<").replace(" >", ">")


def inventory(file: Path) -> set[str]:
    """The names of a built site, as `wanted` writes them."""
    content = file.read_bytes()
    for _ in range(4):
        content = content.partition(b"\n")[2]
    found = set()
    for line in zlib.decompress(content).decode().splitlines():
        words = line.split(" ")
        at = next(
            i
            for i, w in enumerate(words)
            if ":" in w and i > 0 and words[i + 1].lstrip("-").isdigit()
        )
        name = " ".join(words[:at])
        found.add(f"{words[at].partition(':')[0]}:{_close(name)}")
    return found


if __name__ == "__main__":
    if shutil.which("doxygen") is None:
        sys.exit("doxygen is missing; ./dev docs installs it")
    sys.exit(main())
