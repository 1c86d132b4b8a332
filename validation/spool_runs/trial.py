"""How often the intervals of `sms identify spool` hold the truth, by the spool's measured position.

python -m validation.spool_runs.trial [--repeats 200] [--seed 1]
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path
from statistics import NormalDist

import numpy as np
from sms.identification.spool import identify_spool
from sms.units_display import words

from validation.spool_runs.draw import draw

LEVEL = NormalDist().inv_cdf(0.975)
UNITS = {
    "valve_frequency": (1.0, "Hz"),
    "valve_damping_ratio": (1.0, ""),
    "command_delay": (1e3, "ms"),
    "centre": (1e3, "mV"),
}


def repeat(seed: int) -> dict[str, tuple[float, float, float]]:
    """name -> (truth, estimate, standard error) of one valve."""
    with tempfile.TemporaryDirectory() as folder:
        spool = draw(Path(folder), seed)
        fit = identify_spool(Path(folder) / "rig.toml").position
    assert fit is not None
    best = fit.law("cubic")
    truth = {
        "valve_frequency": spool.frequency,
        "valve_damping_ratio": spool.damping,
        "command_delay": spool.delay,
    }
    told = {t.name: (truth[t.name], t.value, t.error) for t in best.told if t.name in truth}
    return told | {"centre": (spool.centre, *best.centre)}


def table(repeats: Sequence[dict[str, tuple[float, float, float]]]) -> list[str]:
    """Markdown."""
    lines = ["| parameter | covered | error, rms | as stated, rms |", "|---|---|---|---|"]
    for name, (factor, unit) in UNITS.items():
        rows = np.array([r[name] for r in repeats if name in r])
        off = rows[:, 1] - rows[:, 0]
        covered = np.mean(np.abs(off) <= LEVEL * rows[:, 2])
        rms, stated = (factor * float(np.sqrt(np.mean(v**2))) for v in (off, rows[:, 2]))
        lines.append(
            f"| {words(name)} | {100.0 * covered:.1f} % | {rms:.2g} {unit} | {stated:.2g} {unit} |"
        )
    return lines


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m validation.spool_runs.trial")
    parser.add_argument("--repeats", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1, help="of the first repeat")
    options = parser.parse_args()
    repeats = []
    for seed in range(options.seed, options.seed + options.repeats):
        repeats.append(repeat(seed))
        print(f"\r{len(repeats)} of {options.repeats}", end="", flush=True)
    print(f"\r{len(repeats)} repeats from seed {options.seed}\n")
    print("\n".join(table(repeats)))


if __name__ == "__main__":
    main()
