"""Detection limits in the excitations of the blind trials: the simulator's, by which a trial hides, and the core's.

    python -m validation.trials.detection_limits bench

A trial hides an effect at three times the limit of validation/twins/limits.py, and nothing else decides its size. That
limit comes from the simulator of the trials, which shares no code with the core: five of its standard errors beside all
that a machine may be off by, and in one signal as much as machines 2 % off leave there. Beside it stands what
`sms limits` finds with the core's derivatives on the healthy records of such a trial: the trial's limit in standard
errors of the core. Fewer than five would be a trial that hides less than it says.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table
from sms.diagnosis.design.detection_limits import limits_of
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.thresholds import DETECTION
from sms.estimation.noise import noise_of
from sms.estimation.run import make_run
from sms.io.rig import load_rig
from sms.rigs.kinds import KINDS
from sms.units_display import display_unit, significant

from validation.trials.answers import key_of
from validation.trials.machines import runs_rng
from validation.twins import effects, limits
from validation.twins.draw import PAIRS, draw, draw_runs, pair_key


@dataclass(frozen=True)
class InPair:
    """One effect in one pair of excitations."""

    limit: float | None
    """Of the trials, in the unit of the effect; None: not to be seen at any size that a machine survives."""
    standard_errors: float | None
    """The same in standard errors of the core; None where the core has another law, or no slope at zero."""


def limits_in_trials(kind: str, pair: tuple[str, str]) -> dict[str, InPair]:
    """Effect -> its limits in two records excited by this pair."""
    key = pair_key(pair)
    of_trials, of_core = limits.read(kind)[key], _of_core(kind, key)
    units = {e.key: e.unit for e in effects.on(kind, effects.CATALOGUE)}
    found = {}
    for name, limit in of_trials.items():
        core, unit = of_core.get(name, (None, ""))
        same = limit is not None and core is not None and unit == units.get(name)
        found[name] = InPair(limit, DETECTION * limit / core if same and limit and core else None)
    return found


def _of_core(kind: str, pair: str) -> dict[str, tuple[float | None, str]]:
    """Effect -> smallest size that the core sees in a healthy trial's records to identify with, and its unit.

    Of a shift: beyond the declared uncertainty.
    """
    seed = next(s for s in range(1000) if draw_runs(kind, runs_rng(s))[0] == pair)
    with tempfile.TemporaryDirectory() as folder:
        records = Path(folder) / "records"
        draw(kind, seed, records, Path(folder) / "truth.json", effects.NONE.key)
        rig = load_rig(records / "rig.toml")
        read, _ = read_and_check(rig)
    runs = [make_run(rig, r) for r in read if r.role == "identify"]
    hypotheses = effects_of(rig)
    found = limits_of(rig, KINDS[kind], runs, noise_of(rig, KINDS[kind], runs), hypotheses)
    units = [rig.table[e.parameters[0]].unit for e in hypotheses]
    return {
        key_of(e): (None if x.size is None else x.size - x.declared, unit)
        for e, x, unit in zip(hypotheses, found, units, strict=True)
    }


def table_of(kind: str) -> Table:
    """Effects by pairs: the trials' limit, and in brackets its standard errors by the core."""
    pairs = PAIRS[kind]
    columns = [limits_in_trials(kind, p) for p in track(pairs, "pairs", transient=True)]
    table = Table(title=f"{kind}: detection limit of the trials, two records", box=None)
    table.title_justify, table.title_style = "left", "bold"
    table.add_column("effect", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    for pair in pairs:
        table.add_column(" + ".join(pair), justify="right")
    for effect in effects.on(kind, effects.CATALOGUE):
        if effect.key not in columns[0]:
            continue
        row = [c[effect.key] for c in columns]
        least = min((x.limit for x in row if x.limit is not None), default=0.0)
        unit = display_unit(effect.unit, least)
        table.add_row(effect.key, unit.label, *(_cell(x, unit.scale) for x in row))
    return table


def _cell(found: InPair, scale: Callable[[float], float]) -> str:
    if found.limit is None:
        return "-"
    errors = "" if found.standard_errors is None else f" ({found.standard_errors:.0f})"
    return f"{significant(scale(found.limit), 2)}{errors}"


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.trials.detection_limits",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("rig", choices=sorted(PAIRS))
    Console(width=120).print(table_of(parser.parse_args().rig))


if __name__ == "__main__":
    main()
