"""The seals of the measured cylinder (Zillen, Vallery, Smit, TU Delft, CC0): what the diagnosis names on each.

    python -m validation.measured.seals [RIG ...]

Every seal is diagnosed on its records at 1 and 5 bar and judged on those at 3 and 7 bar, beside plain least squares of
the same force balance with the terms written out: Coulomb friction, friction that grows with pressure, and either a
gain or a zero offset. Records that are not at hand (SMS_DATA) are said and left out.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from sms.arrays import Array
from sms.data import cylinder_rig
from sms.diagnosis import Diagnosis, diagnose
from sms.errors import InputError
from sms.io.records import load_record
from sms.io.rig import Rig, load_rig
from sms.rigs.cylinder import prepare

RIGS = Path(__file__).parent / "rigs"
"""Of seals whose records are only where their rig file says; those of the others come with the package."""
SEALS = ("o_ring", "kdn", "o_ring_257", "x_ring_257")
TERMS = {"gain": ("coulomb", "pressure", "gain"), "zero offset": ("coulomb", "pressure", "zero")}


def rig_file(seal: str) -> Path:
    """The rig file of a seal."""
    beside = RIGS / f"cylinder_{seal}.toml"
    return beside if beside.exists() else cylinder_rig(f"cylinder_{seal}")


def columns(rig: Rig, role: str) -> tuple[dict[str, Array], Array]:
    """The balance's terms over the moving samples of a role's records, and what they have to make, N."""
    bore = 0.25 * np.pi * rig.declared("bore_diameter").value ** 2
    ambient = rig.declared("ambient_pressure").value
    terms: dict[str, list[Array]] = {name: [] for name in ("coulomb", "pressure", "gain", "zero")}
    lost = []
    for source in rig.records:
        if source.role == role:
            motion = prepare(rig, load_record(rig, source))
            use = motion.used
            direction = np.sign(motion.velocity[use])
            gauge = motion.signals["chamber_pressure_lower"][use]
            gauge = gauge if "chamber_pressure_lower" in motion.gauge else gauge - ambient
            terms["coulomb"].append(direction)
            terms["pressure"].append(direction * gauge)
            terms["gain"].append(gauge * bore)
            terms["zero"].append(np.ones_like(gauge))
            lost.append(gauge * bore - motion.signals["rod_force"][use])
    return {name: np.concatenate(parts) for name, parts in terms.items()}, np.concatenate(lost)


def least_squares(rig: Rig, terms: tuple[str, ...]) -> float:
    """RMS on the validation records of what was fitted on the others, N."""
    fitted, lost = columns(rig, "identify")
    held, unseen = columns(rig, "validate")
    sizes, *_ = np.linalg.lstsq(np.column_stack([fitted[t] for t in terms]), lost, rcond=None)
    return float(
        np.sqrt(np.mean((unseen - np.column_stack([held[t] for t in terms]) @ sizes) ** 2))
    )


def left(answer: Diagnosis) -> float:
    """RMS on the validation records of the extended model, N, pooled over its records."""
    return float(np.sqrt(np.mean([g.extended_rms**2 for g in answer.gain])))


def main() -> int:
    """Print the table."""
    asked = [Path(name) for name in sys.argv[1:]]
    print(
        "| seal | causes | unseen, declared [N] | extended [N] | least squares: gain [N] | zero offset [N] |"
    )
    print("|---|---|---|---|---|---|")
    for path in asked or map(rig_file, SEALS):
        try:
            answer = diagnose(path)
        except InputError as error:
            if asked:
                print(f"seals: {error}", file=sys.stderr)
                return 2
            print(f"{path.stem}: left out, {error}", file=sys.stderr)
            continue
        rig = load_rig(path)
        causes = "; ".join(
            " or ".join((cause.title, *(a.title for a in cause.alternatives)))
            for cause in answer.causes
        )
        before = float(np.sqrt(np.mean([g.baseline_rms**2 for g in answer.gain])))
        plain = " | ".join(f"{least_squares(rig, terms):.2f}" for terms in TERMS.values())
        print(
            f"| {answer.title} | {causes} | {before:.2f} | {left(answer):.2f} | {plain} |",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
