"""How often the stated intervals of `sms identify actuator` hold the truth, over seeded repeats.

    python -m validation.trials.identify_actuator [--repeats 200] [--seed 1] [--machine other] [--file trials.jsonl]

Each repeat is another machine within what its rig file declares, other excitations, other noise: three runs of three
seconds (draw.py). One repeat is one line of the file; a run that was stopped goes on where it ended. The table is of
all repeats in the file that were asked for.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from sms.identification.actuator import identify_actuator
from sms.io.json_files import from_json_line, json_line
from sms.parameters import PARAMETERS
from sms.units_display import display_unit, words

from validation.trials import repeats
from validation.twins.actuator_runs import Machine, draw


@dataclass(frozen=True)
class Repeat:
    """One machine identified: name -> (true, found, standard error) of what was fitted; SI."""

    seed: int
    told: dict[str, tuple[float, float, float]]
    residual_over_noise: float
    birge: float


def repeat(seed: int, machine: Machine) -> Repeat:
    """Draw one machine, identify it, open the truth."""
    with tempfile.TemporaryDirectory() as folder:
        truth = draw(Path(folder), seed, machine)
        fit = identify_actuator(Path(folder) / "rig.toml").fit
    told = {t.name: (truth[t.name], t.value, t.error) for t in fit.wanted if t.name in truth}
    return Repeat(seed, told, fit.found.scale, fit.birge)


def run(seeds: Sequence[int], file: Path, machine: Machine) -> Iterator[Repeat]:
    """Every repeat, those in the file first; new ones are added to it."""
    done: dict[int, Repeat] = {}
    if file.exists():
        for line in file.read_text().splitlines():
            values = from_json_line(line)
            values["told"] = {name: tuple(v) for name, v in values["told"].items()}
            done[values["seed"]] = Repeat(**values)
    for seed in seeds:
        if seed not in done:
            found = repeat(seed, machine)
            with file.open("a") as lines:
                lines.write(json_line("trials", asdict(found)))
            done[seed] = found
        yield done[seed]


def table(trials: Sequence[Repeat]) -> list[str]:
    """Markdown: how often the 95 percent interval held the truth, and how far off the estimates were."""
    names = list(dict.fromkeys(name for r in trials for name in r.told))
    lines = [
        "| parameter | fitted in | covered | error, rms | as stated, rms |",
        "|---|---|---|---|---|",
    ]
    for name in names:
        rows = np.array([r.told[name] for r in trials if name in r.told])
        rows = rows[np.isfinite(rows[:, 2])]
        covered = np.mean(repeats.holds(rows))
        unit = display_unit(PARAMETERS[name].unit, float(np.median(np.abs(rows[:, 0]))), name)
        rms, stated = (unit.factor * repeats.rms(v) for v in (rows[:, 1] - rows[:, 0], rows[:, 2]))
        lines.append(
            f"| {words(name)} | {len(rows)} of {len(trials)} | {100.0 * covered:.1f} % | "
            f"{rms:.2g} {unit.label} | {stated:.2g} {unit.label} |"
        )
    together = np.concatenate([list(r.told.values()) for r in trials])
    together = together[np.isfinite(together[:, 2])]
    held = repeats.holds(together)
    lines.append(
        f"\n{held.sum()} of {held.size} intervals hold the truth: {100.0 * held.mean():.1f} %"
    )
    return lines


def main() -> None:
    """Print the table."""
    parser = repeats.parser_of("validation.trials.identify_actuator")
    parser.add_argument("--machine", choices=("published", "other"), default="published")
    parser.add_argument("--file", type=Path, help="default: build/actuator_trials_MACHINE.jsonl")
    options = parser.parse_args()
    file = options.file or Path("build") / f"actuator_trials_{options.machine}.jsonl"
    file.parent.mkdir(parents=True, exist_ok=True)
    repeats.report(run(repeats.seeds_of(options), file, options.machine), options, table)


if __name__ == "__main__":
    main()
