"""How often the intervals of `sms identify friction` hold the truth, and how often it claims what is not there.

    python -m validation.trials.identify_friction [--repeats 200] [--seed 1]

Each repeat is another cylinder of four runs (draw.py; 200 samples a second), whose friction differs by 3 percent from
run to run. The truth of Coulomb and viscous friction is their mean over all runs that could have been made. Terms that
the truth does not have are claimed falsely wherever they are "shown".
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sms.identification.friction import identify_friction
from sms.identification.friction_fit import FALSE
from sms.units_display import words

from validation.trials import repeats
from validation.twins.friction_runs import Friction, Run, draw

RUNS = (
    Run(0.10, 0.10, 20.0, "identify"),
    Run(0.20, 0.10, 15.0, "identify"),
    Run(0.33, 0.08, 12.0, "identify"),
    Run(0.45, 0.06, 10.0, "identify"),
)
RATE = 200.0
TRUTH = {
    "coulomb_force": Friction.coulomb,
    "viscous_friction": Friction.viscous,
    "stiction_force": Friction.stiction,
    "stribeck_acceleration_factor": Friction.factor,
    "coulomb_force_deceleration_change": 0.0,
    "viscous_friction_deceleration_change": 0.0,
    "exponential_friction_force": 0.0,
    "sensor_offset_rod_force": 0.0,
}


@dataclass(frozen=True)
class Repeat:
    """One cylinder: name -> (value, half width of the interval, shown)."""

    told: dict[str, tuple[float, float, bool]]

    @property
    def false(self) -> bool:
        """Whether a term is claimed that the truth does not have."""
        return any(shown for n, (_, _, shown) in self.told.items() if TRUTH[n] == 0.0)


def repeat(seed: int) -> Repeat:
    """Draw one cylinder and identify eq. 6.5."""
    with tempfile.TemporaryDirectory() as folder:
        rig = draw(Path(folder), seed, RUNS, rate=RATE)
        found = identify_friction(rig, choice=("acceleration_dependent",)).laws[0]
    return Repeat({t.name: (t.value, t.half_width, t.shown) for t in found.told})


def table(trials: Sequence[Repeat]) -> list[str]:
    """Markdown: coverage, errors, how often shown; then the false claims."""
    lines = [
        "| parameter | truth | fitted in | inside its bounds | covered | error, rms | significant |",
        "|---|---|---|---|---|---|---|",
    ]
    for name, truth in TRUTH.items():
        rows = np.array([r.told[name] for r in trials if name in r.told])
        if not len(rows):
            continue
        inside = rows[np.isfinite(rows[:, 1])]
        covered = np.abs(inside[:, 0] - truth) <= inside[:, 1]
        rms = repeats.rms(rows[:, 0] - truth)
        share = f"{100.0 * covered.mean():.1f} %" if len(inside) else ""
        lines.append(
            f"| {words(name)} | {truth:g} | {len(rows)} | {len(inside)} | {share} | {rms:.2g} | "
            f"{100.0 * rows[:, 2].mean():.0f} % |"
        )
    false = sum(r.false for r in trials)
    lines.append(
        f"\n{false} of {len(trials)} record sets claim a term that the truth does not have "
        f"({100.0 * false / len(trials):.1f} %; at most {100.0 * FALSE:g} % are meant to)"
    )
    return lines


def main() -> None:
    """Print the table."""
    options = repeats.parser_of("validation.trials.identify_friction").parse_args()
    repeats.report(map(repeat, repeats.seeds_of(options)), options, table)


if __name__ == "__main__":
    main()
