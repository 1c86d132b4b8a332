"""Records that others measured and gave to the public domain, with rig files and scenarios that use them.

One folder a data set; its README.md says where it comes from, LICENSE under what terms, originals.sha256 from which
files `python -m tools.pack_data` made it.
"""

from __future__ import annotations

from pathlib import Path

from sms.errors import InputError, did_you_mean

FOLDER = Path(__file__).parent
CYLINDER = FOLDER / "cylinder_friction_zillen"
WAVES = FOLDER / "ship_section_waves_sundsdal"
SCENARIOS = {path.stem: path for path in sorted(WAVES.glob("*.toml"))}
"""Scenarios that are shipped, by name."""


def scenario_file(named: Path) -> Path:
    """A user's file, or where there is none of that name the scenario that is shipped under it. InputError for a bare
    name that is neither.
    """
    if named.exists() or named.suffix or len(named.parts) > 1:
        return named
    if str(named) not in SCENARIOS:
        raise InputError(
            f"{named}: there is no such scenario file, and none is shipped under that name; "
            f"{did_you_mean(str(named), SCENARIOS)}"
        )
    return SCENARIOS[str(named)]


def cylinder_rig(name: str) -> Path:
    """The rig file of a shipped cylinder: "cylinder_o_ring", "cylinder_kdn", reruns. InputError if there is none."""
    path = CYLINDER / f"{name}.toml"
    if not path.is_file():
        raise InputError(f"{path}: this file of the package is missing; install sms again")
    return path
