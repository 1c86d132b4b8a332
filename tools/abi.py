"""The C ABI against its record: what a program compiled with an older header would misread is refused.

    python -m tools.abi              compares the headers with libsms/abi/NUMBER.abi, by abidiff, and with the archive
    python -m tools.abi --record     writes that file

NUMBER is SMS_ABI of version.h. The structs and functions are those that a C compiler reads in sms.h: the shared object
that abidw looks at has an empty body for each declared function. That the templates behind them have the same layout is
asserted where they are compiled (libsms/src). The record is of x86-64; elsewhere only the archive is compared.
"""

from __future__ import annotations

import argparse
import platform
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
INCLUDE = ROOT / "libsms" / "include"
OUT = ROOT / "build" / "abi"
ARCHIVE = ROOT / "build" / "package" / "libsms" / "libsms.a"
PROTOTYPE = re.compile(r"([a-z_][\w ]*?[ *]+)(sms_\w+)\(([^()]*)\);")


def output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def number() -> int:
    text = (INCLUDE / "sms" / "version.h").read_text(encoding="utf-8")
    found = re.search(r"#define SMS_ABI (\d+)", text)
    if found is None:
        raise SystemExit("version.h has no SMS_ABI")
    return int(found[1])


def prototypes() -> dict[str, str]:
    """Name -> head of every function that sms.h declares and does not define."""
    text = output("cc", "-std=c99", "-E", "-P", "-I", str(INCLUDE), str(INCLUDE / "sms" / "sms.h"))
    flat = re.sub(r"\s+", " ", text)
    return {m[2]: f"{m[1]}{m[2]}({m[3]})" for m in PROTOTYPE.finditer(flat) if "return" not in m[1]}


def shared_object(heads: dict[str, str]) -> Path:
    OUT.mkdir(parents=True, exist_ok=True)
    source, library = OUT / "libsms.c", OUT / "libsms.so"
    bodies = "\n".join(f"{head} {{ abort(); }}" for head in heads.values())
    source.write_text(f'#include <stdlib.h>\n#include "sms/sms.h"\n{bodies}\n', encoding="utf-8")
    place = f"-ffile-prefix-map={ROOT}/="  # the record says nothing of the checkout's place
    flags = ("-std=c99", "-g", "-O0", "-fPIC", "-shared", place, "-I", str(INCLUDE))
    output("cc", *flags, str(source), "-o", str(library))
    return library


def record(library: Path, to: Path) -> None:
    stable = ("--no-corpus-path", "--no-comp-dir-path", "--no-show-locs", "--type-id-style", "hash")
    output("abidw", *stable, "--out-file", str(to), str(library))


def abidiff(*arguments: str) -> str:
    """What it reports, or why it could not; "" where there is nothing to report."""
    done = subprocess.run(("abidiff", *arguments), check=False, capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode else ""


def differences(recorded: Path, library: Path) -> str:
    """What is wrong with the record, in words; "" if nothing is."""
    if not recorded.exists():
        return f"there is no {recorded.relative_to(ROOT)}; write it with --record"
    changed = abidiff("--no-added-syms", str(recorded), str(library))
    if changed:
        remedy = "increase SMS_ABI in version.h, then write its record with --record"
        return f"{changed}a program compiled before would misread this: {remedy}"
    added = abidiff(str(recorded), str(library))
    return f"{added}what is new is not in the record; write it with --record" if added else ""


def not_in_archive(heads: dict[str, str]) -> str:
    """The functions that only the headers or only the archive have."""
    table = output("nm", "--defined-only", "--extern-only", "--format=posix", str(ARCHIVE))
    defined = {line.split()[0] for line in table.splitlines() if re.match(r"sms_\w+ T", line)}
    wrong = sorted(defined.symmetric_difference(heads))
    return f"only in the headers, or only in the archive: {', '.join(wrong)}" if wrong else ""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.abi")
    parser.add_argument("--record", action="store_true", help="write the record")
    writing = parser.parse_args().record
    heads = prototypes()
    recorded = ROOT / "libsms" / "abi" / f"{number()}.abi"
    wrong = (
        not_in_archive(heads) if ARCHIVE.exists() else f"there is no {ARCHIVE.relative_to(ROOT)}"
    )
    if not wrong and platform.machine() == "x86_64":
        library = shared_object(heads)
        if writing:
            record(library, recorded)
        wrong = differences(recorded, library)
    print(wrong or f"{len(heads)} functions, as recorded in {recorded.relative_to(ROOT)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
