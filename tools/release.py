"""What a release holds beside wheels: the source archive, and the bill of materials.

python -m tools.release sdist     build/dist/sms-VERSION.tar.gz, which builds without git
python -m tools.release sbom      build/dist/sms-VERSION.cdx.json, CycloneDX 1.5
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.metadata
import json
import os
import re
import tomllib
import uuid
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "build" / "dist"
COMPILED = {  # CMake's name -> (name, licence); compiled into the module
    "Eigen3": ("Eigen", "MPL-2.0"),
    "Ceres": ("Ceres Solver", "BSD-3-Clause"),
    "pybind11": ("pybind11", "BSD-3-Clause"),
}


def version() -> str:
    """SMS_VERSION of version.h."""
    text = (ROOT / "libsms" / "include" / "sms" / "version.h").read_text(encoding="utf-8")
    found = re.search(r'#define SMS_VERSION "([^"]+)"', text)
    assert found is not None
    return found[1]


def sdist() -> Path:
    """The source archive, as pip's own build backend makes it."""
    from scikit_build_core.build import build_sdist  # noqa: PLC0415 (the SBOM needs no backend)

    OUT.mkdir(parents=True, exist_ok=True)
    os.chdir(ROOT)
    return OUT / build_sdist(str(OUT))


def declared() -> list[str]:
    """What pyproject.toml asks for, with every optional part of a user."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]

    def of(extra: str) -> Iterator[str]:
        for text in optional[extra]:
            needs = Requirement(text)
            if needs.name == "sms":
                for other in sorted(needs.extras):
                    yield from of(other)
            else:
                yield text

    return [*project["dependencies"], *of("full")]


def installed() -> dict[str, importlib.metadata.Distribution]:
    """What the package needs with every optional part, by normal name, as installed here."""
    found: dict[str, importlib.metadata.Distribution] = {}
    waiting = [(text, frozenset[str]()) for text in declared()]
    seen: set[tuple[str, frozenset[str]]] = set()
    while waiting:
        one = waiting.pop()
        needs = Requirement(one[0])
        if one in seen or not _applies(needs, one[1]):
            continue
        seen.add(one)
        try:
            of = importlib.metadata.distribution(needs.name)
        except importlib.metadata.PackageNotFoundError:
            raise SystemExit(f"{needs.name} is not installed: pip install 'sms[full]'") from None
        found[_normal(needs.name)] = of
        waiting += [(text, frozenset(needs.extras)) for text in of.requires or ()]
    return found


def _applies(needs: Requirement, extras: frozenset[str]) -> bool:
    """Whether it is needed on this machine, by one of whom these extras are asked."""
    asked = ("", *sorted(extras))
    return needs.marker is None or any(needs.marker.evaluate({"extra": e}) for e in asked)


def _normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def _licence(of: importlib.metadata.Distribution) -> list[dict[str, Any]]:
    """As the package states it: an SPDX expression, or a name."""
    if "License-Expression" in of.metadata:
        return [{"expression": of.metadata["License-Expression"]}]
    classified = [
        c.rpartition(" :: ")[2]
        for c in of.metadata.get_all("Classifier") or ()
        if "License ::" in c
    ]
    text = (of.metadata.get_all("License") or [""])[0].strip()
    name = ", ".join(classified) or (text if text and "\n" not in text and len(text) < 80 else "")
    return [{"license": {"name": name}}] if name else []


def compiled(build: Path) -> Iterator[dict[str, Any]]:
    """The libraries that CMake found for the compiled module, with the versions that it found."""
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    for package, (name, licence) in COMPILED.items():
        place = re.search(rf"^{package}_DIR:PATH=(.*)$", cache, re.MULTILINE)
        if place is None or "NOTFOUND" in place[1]:
            continue
        files = sorted(Path(place[1]).glob("*[Vv]ersion.cmake"))
        stated = [
            re.search(r'PACKAGE_VERSION "?([\d.]+)', f.read_text(encoding="utf-8")) for f in files
        ]
        yield {
            "type": "library",
            "bom-ref": f"compiled:{package.lower()}",
            "name": name,
            "version": next((m[1] for m in stated if m), "unknown"),
            "licenses": [{"license": {"id": licence}}],
            "properties": [{"name": "sms:how", "value": "compiled into sms._core"}],
        }
    yield {
        "type": "library",
        "bom-ref": "compiled:fmi-headers",
        "name": "FMI headers",
        "version": "3.0",
        "licenses": [{"license": {"id": "BSD-2-Clause"}}],
        "properties": [{"name": "sms:how", "value": "compiled into sms/fmu/sms_fmu.so"}],
    }


def sbom(build: Path) -> dict[str, Any]:
    """CycloneDX 1.5: components, and which needs which."""
    packages = installed()
    refs = {name: f"pkg:pypi/{name}@{of.version}" for name, of in packages.items()}
    inside = list(compiled(build))
    components = inside + [
        {
            "type": "library",
            "bom-ref": refs[name],
            "name": of.metadata["Name"],
            "version": of.version,
            "purl": refs[name],
            "licenses": _licence(of),
        }
        for name, of in sorted(packages.items())
    ]
    me = f"pkg:pypi/sms@{version()}"
    depends = [
        {"ref": me, "dependsOn": [c["bom-ref"] for c in inside] + sorted(_needs(declared(), refs))}
    ]
    depends += [
        {"ref": refs[name], "dependsOn": sorted(_needs(of.requires or (), refs))}
        for name, of in sorted(packages.items())
    ]
    serial = uuid.UUID(hashlib.sha256(json.dumps(components).encode()).hexdigest()[:32])
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "serialNumber": f"urn:uuid:{serial}",
        "version": 1,
        "metadata": {
            "component": {
                "type": "library",
                "bom-ref": me,
                "name": "sms",
                "version": version(),
                "purl": me,
                "licenses": [{"license": {"id": "BSD-3-Clause"}}],
            }
        },
        "components": components,
        "dependencies": depends,
    }


def _needs(requirements: Iterable[str], refs: dict[str, str]) -> set[str]:
    """Those that are among the components."""
    names = {_normal(Requirement(text).name) for text in requirements}
    return {refs[name] for name in names if name in refs}


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m tools.release", description=__doc__)
    parser.add_argument("what", choices=("sdist", "sbom"))
    parser.add_argument(
        "--build", type=Path, default=ROOT / "build" / "package", help="CMake's folder"
    )
    options = parser.parse_args()
    if options.what == "sdist":
        file = sdist()
        print(f"{file}: {file.stat().st_size / 1e6:.1f} MB")
        return
    OUT.mkdir(parents=True, exist_ok=True)
    file = OUT / f"sms-{version()}.cdx.json"
    bill = sbom(options.build)
    file.write_text(json.dumps(bill, indent=1) + "\n", encoding="utf-8")
    print(f"{file}: {len(bill['components'])} components")


if __name__ == "__main__":
    main()
