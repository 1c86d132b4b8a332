"""Friction by seal from the measured cylinder (Zillen, Vallery, Smit, TU Delft, CC0): what its runs show.

    python -m validation.measured.friction

Each rig file in sms/data is one seal or one repeat of a test. The runs are slow (4 to 14 mm/s),
so the table says little by design: what these motions cannot show is left out of it.
"""

from __future__ import annotations

from sms.data import cylinder_rig
from sms.identification.friction import FrictionResult, identify_friction
from sms.identification.friction_fit import EQUATION

RIGS = ("cylinder_o_ring", "cylinder_kdn", "cylinder_o_ring_rerun1", "cylinder_o_ring_rerun3")
LAW = "stribeck"


def line(name: str, result: FrictionResult) -> str:
    """One rig as a row: the simplest law, since no other is shown to be better here."""
    fit = result.law(LAW)
    told = {t.name: t for t in fit.told}
    c = told["coulomb_force"]
    others = [n for n, t in told.items() if not t.shown and not n.startswith("sensor_")]
    others += [n for n, _ in fit.left_out]
    return (
        f"| {name} | {1e3 * result.speed[0]:.1f} to {1e3 * result.speed[1]:.1f} "
        f"| {c.value:.2f} ± {c.error:.2f} | {c.scatter:.2f} | {fit.rms_identify:.2f} "
        f"| {fit.rms_validate:.2f} | {', '.join(others)} |"
    )


def main() -> None:
    """Print the table."""
    print(f"{EQUATION[LAW]}:\n")
    print("| rig | speed [mm/s] | Coulomb force [N] | scatter of runs [N] | residual [N] | residual, unseen runs [N] "
          "| not significant |")  # fmt: skip
    print("|---|---|---|---|---|---|---|")
    for name in RIGS:
        print(line(name, identify_friction(cylinder_rig(name))), flush=True)


if __name__ == "__main__":
    main()
