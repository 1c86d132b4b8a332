"""An FMU as a file: modelDescription.xml, the binary of this machine, the sources, and the licences."""

from __future__ import annotations

import io
import platform
import zipfile
from pathlib import Path

from sms.errors import InputError, did_you_mean
from sms.fmi.binary import KINDS, folder, library_file
from sms.fmi.description import build_description, identifier, model_description
from sms.fmi.starts import Starts
from sms.io.write import write_bytes_atomically

VERSIONS = ("2.0", "3.0")
_SUFFIXES = {"Linux": ".so", "Darwin": ".dylib"}
_ALWAYS = 1980, 1, 1, 0, 0, 0
"""The date of every file in it: equal models, equal octets."""

_THIRD_PARTY = """The binary contains, compiled from unmodified sources:

Eigen 3.4       MPL-2.0; source: https://gitlab.com/libeigen/eigen
the compiler's run-time support (libstdc++, libgcc)   GPL-3.0 with the GCC Runtime Library Exception 3.1

The files fmi2*.h and fmi3*.h in sources/ are the headers of the Modelica Association Project "FMI" under the 2-Clause
BSD License; sources/LICENSE_FMI is its text.
"""


def export_fmu(kind: str, out: Path, version: str = "2.0", starts: Starts | None = None) -> None:
    """Write the model `kind` (one of KINDS) as an FMU for co-simulation; whole, or not at all.

    Args:
        kind: "bench", "platform", "tank" or "controller".
        out: the file; its folder must exist.
        version: of FMI, "2.0" or "3.0".
        starts: start values of its parameters, such as `starts_of_rig` reads them.

    Raises: InputError for a kind or a version that is not known, and for a file that cannot be written.
    """
    check(kind, version, out)
    write_bytes_atomically(out, packed(kind, version, starts or Starts()))


def check(kind: str, version: str, out: Path) -> None:
    """InputError, before anything is read, for what cannot be exported or written."""
    if kind not in KINDS:
        raise InputError(f"{kind}: there is no such model to export; {did_you_mean(kind, KINDS)}")
    if version not in VERSIONS:
        raise InputError(f"--fmi {version}: allowed are {' and '.join(VERSIONS)}")
    if out.is_dir():
        raise InputError(f"{out}: this is a folder; name a file in it, like {out / kind}.fmu")
    if not out.absolute().parent.is_dir():
        raise InputError(f"{out}: there is no folder '{out.parent}'; make it, or choose another")


def packed(kind: str, version: str, starts: Starts) -> bytes:
    """The octets of the FMU."""
    files = _sources(version)
    compiled = sorted(name for name in files if name.endswith(".cpp"))
    texts = {
        "modelDescription.xml": model_description(kind, version, starts.values, compiled),
        "documentation/licenses/license.txt": (folder() / "sources" / "LICENSE").read_text("utf-8"),
        "documentation/licenses/third_party.txt": _THIRD_PARTY,
    }
    if version == "3.0":
        texts["sources/buildDescription.xml"] = build_description(kind, compiled)
    contents = {name: text.encode() for name, text in texts.items()}
    contents |= {f"sources/{name}": file.read_bytes() for name, file in files.items()}
    contents[_binary_name(kind, version)] = library_file().read_bytes()
    packing = io.BytesIO()
    with zipfile.ZipFile(packing, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in contents.items():
            info = zipfile.ZipInfo(name, _ALWAYS)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, content)
    return packing.getvalue()


def _sources(version: str) -> dict[str, Path]:
    """By name below sources/; of the two standards the one that is asked for, its headers beside the rest."""
    base = folder() / "sources"
    other = "fmi3" if version == "2.0" else "fmi2"
    found = {}
    for file in sorted(base.rglob("*")):
        place = file.relative_to(base).as_posix()
        name = (
            "LICENSE_FMI" if place == "third_party/LICENSE" else place.removeprefix("third_party/")
        )
        if file.is_file() and not name.startswith(other):
            found[name] = file
    return found


def _binary_name(kind: str, version: str) -> str:
    """Where FMI looks for the binary of this machine. InputError on one of which that is not known."""
    system, machine = platform.system(), platform.machine().lower()
    if system not in _SUFFIXES:
        raise InputError(f"an FMU cannot be exported on {system}; Linux and macOS can")
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine, machine)
    place = f"{machine}-{system.lower()}"
    if version == "2.0" and machine == "x86_64":
        place = {"Linux": "linux64", "Darwin": "darwin64"}[system]
    return f"binaries/{place}/{identifier(kind)}{_SUFFIXES[system]}"
