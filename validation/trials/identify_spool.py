"""How often the intervals of `sms identify spool` hold the truth, by the spool's measured position.

python -m validation.trials.identify_spool [--repeats 200] [--seed 1]
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from sms.identification.spool import identify_spool
from sms.units_display import words

from validation.trials import repeats
from validation.twins.spool_runs import draw

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


def table(trials: Sequence[dict[str, tuple[float, float, float]]]) -> list[str]:
    """Markdown."""
    lines = ["| parameter | covered | error, rms | as stated, rms |", "|---|---|---|---|"]
    for name, (factor, unit) in UNITS.items():
        rows = np.array([r[name] for r in trials if name in r])
        covered = np.mean(repeats.holds(rows))
        rms, stated = (factor * repeats.rms(v) for v in (rows[:, 1] - rows[:, 0], rows[:, 2]))
        lines.append(
            f"| {words(name)} | {100.0 * covered:.1f} % | {rms:.2g} {unit} | {stated:.2g} {unit} |"
        )
    return lines


def main() -> None:
    """Print the table."""
    options = repeats.parser_of("validation.trials.identify_spool").parse_args()
    repeats.report(map(repeat, repeats.seeds_of(options)), options, table)


if __name__ == "__main__":
    main()
