"""Packs the measured records that the package ships: of each original the columns that rig files and scenarios use.

python -m tools.pack_data [FOLDER]           writes python/sms/data/*/*.csv.gz, LICENSE and originals.sha256
python -m tools.pack_data [FOLDER] --check   only says whether they are what the originals give

FOLDER holds the originals, by default $SMS_DATA or ../shared/data; README.md beside the packed records says where they
can be had. Numbers stay as they are written there, digit by digit; a header line names the columns that are kept.
An original whose hash is not the recorded one is refused.
"""

from __future__ import annotations

import argparse
import csv
import gzip
import io
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from sms.data import CYLINDER, WAVES

HASHES = "originals.sha256"
LICENCE = "LICENSE"
PUBLIC_DOMAIN = "CC0 1.0 Universal"


@dataclass(frozen=True)
class Set:
    """One data set: where it is packed to, and which columns are kept."""

    packed: Path
    kept: tuple[str, ...]
    header: tuple[str, ...] | None = None
    """Of originals without a header line, whose cells are separated by whitespace."""

    def rows(self, text: str) -> Iterator[Sequence[str]]:
        """The originals' rows, the names of the columns first."""
        if self.header is None:
            yield from csv.reader(text.splitlines())
            return
        yield self.header
        yield from (line.split() for line in text.splitlines() if line.strip())

    def table(self, original: Path) -> bytes:
        """The kept columns as CSV."""
        rows = self.rows(gzip.decompress(original.read_bytes()).decode("utf-8"))
        names = list(next(iter(rows)))
        places = [names.index(name) for name in self.kept]
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(self.kept)
        writer.writerows([row[place] for place in places] for row in rows)
        return out.getvalue().encode("utf-8")


SETS = (
    Set(
        CYLINDER,
        ("time [ms]", "stroke [mm]", "pressure [bar]", "force [N]"),
        (
            "time [ms]",
            "laser [V]",
            "pressure sensor [V]",
            "force sensor [V]",
            "stroke [mm]",
            "pressure [bar]",
            "force [N]",
        ),
    ),
    Set(WAVES, ("Time [s]", "Roll [rad]")),
)


def recorded(one: Set) -> dict[str, str]:
    """File name -> hash of the original, as recorded."""
    file = one.packed / HASHES
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    return {name: digest for digest, name in (line.split(maxsplit=1) for line in lines)}


def pack(one: Set, originals: Path, check: bool) -> list[str]:
    """Pack a set, or with `check` compare; what is wrong, a sentence each."""
    licence = (originals / LICENCE).read_bytes()
    if PUBLIC_DOMAIN not in licence.decode("utf-8"):
        return [f"{originals / LICENCE}: this is not {PUBLIC_DOMAIN}; it must not be shipped"]
    files = sorted(originals.glob("*.csv.gz"))
    hashes = {file.name: sha256(file.read_bytes()).hexdigest() for file in files}
    known = recorded(one)
    wrong = [
        f"{originals / name}: not the file that {one.packed / HASHES} records"
        for name in sorted(known.keys() | hashes.keys())
        if known and known.get(name) != hashes.get(name)
    ]
    if wrong:
        return wrong
    made = {one.packed / file.name: one.table(file) for file in files}
    if check:
        packed = [*one.packed.glob("*.csv.gz")]
        wrong = [f"{path}: no original gives it" for path in packed if path not in made]
        return wrong + [
            f"{path}: not what {originals / path.name} gives"
            for path, text in made.items()
            if not path.exists() or gzip.decompress(path.read_bytes()) != text
        ]
    for path, text in made.items():
        path.write_bytes(gzip.compress(text, 9, mtime=0))
    (one.packed / LICENCE).write_bytes(licence)
    lines = "".join(f"{digest}  {name}\n" for name, digest in hashes.items())
    (one.packed / HASHES).write_text(lines, encoding="utf-8")
    return []


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tools.pack_data",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    default = Path(os.environ.get("SMS_DATA", "../shared/data"))
    parser.add_argument("folder", type=Path, nargs="?", default=default)
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    arguments = parser.parse_args()
    wrong: list[str] = []
    for one in SETS:
        originals = arguments.folder / one.packed.name
        if not originals.is_dir():
            wrong.append(
                f"{originals}: there is no such folder; {one.packed / 'README.md'} says where to get it"
            )
            continue
        wrong += pack(one, originals, arguments.check)
        sizes = [file.stat().st_size for file in one.packed.glob("*.csv.gz")]
        print(f"{one.packed.name}: {len(sizes)} records, {sum(sizes) / 1e3:.0f} kB")
    for sentence in wrong:
        print(f"pack_data: {sentence}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
