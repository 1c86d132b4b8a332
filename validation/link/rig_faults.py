"""Every fault that is expected of a rig, through the whole chain of desk, bus, controller and plant.

    python -m validation.link.rig_faults

The controller alone is tried by validation.firmware.faults, exactly and with limits of time. Here the virtual rig
(libsms/firmware/virtual_rig.hpp) follows a motion under a desk, over python-can's virtual bus, in simulated time.
Then something goes wrong. Measured at every millisecond: when the controller says so, which mode it takes, how far
and how fast the pistons went. Then the cause is taken away, and the way back is gone. A trial fails when a fault is
not said, the mode is another one, a piston leaves the stroke, or the way back leads nowhere.

The table in docs/rig_faults.md is what this program prints.
"""

from __future__ import annotations

import argparse
import statistics
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from validation.link.rig_fault_stage import Stage, mode_name
from validation.link.rig_fault_trials import MINUTE, TRIALS, Trial

PAGE = Path(__file__).resolve().parents[2] / "docs" / "rig_faults.md"
STROKE = 0.4  #: m
FASTEST = 1.0  #: m/s; no piston may be faster: the limit of the set-points' rate


@dataclass
class Outcome:
    """What one trial showed."""

    trial: Trial
    detected: list[float] = field(default_factory=list)  #: s, of each seed
    modes: set[str] = field(default_factory=set)
    least: float = np.inf  #: extension, m
    most: float = -np.inf
    fastest: float = 0.0  #: m/s
    failures: list[str] = field(default_factory=list)


def run_trial(trial: Trial, seed: int, seconds: float, outcome: Outcome) -> None:
    """One fault with one seed."""
    stage = Stage(1000 * TRIALS.index(trial) + seed if trial in TRIALS else seed)
    try:
        stage.world.forget()
        own = trial.run(stage, seconds)
        world = stage.world
        said = [at - world.since for name, at in world.first_said.items() if name in trial.says]
        detected = own if own is not None else min(said, default=None)
        mode = mode_name(stage.rig.truth.mode)
        outcome.modes.add(mode)
        if detected is None:
            names = ", ".join(stage.world.first_said) or "nothing"
            outcome.failures.append(f"seed {seed}: not said; said was {names}")
        else:
            outcome.detected.append(detected)
        if mode not in trial.modes:
            outcome.failures.append(f"seed {seed}: the mode is {mode}")
        trial.cure(stage)
        if trial.by_itself:
            stage.stream(2.0)
        if not (trial.by_itself and mode_name(stage.rig.truth.mode) == "tracking") and (
            trial.by_itself or not stage.come_back()
        ):
            outcome.failures.append(f"seed {seed}: it does not come back")
        outcome.least = min(outcome.least, world.extension[0])
        outcome.most = max(outcome.most, world.extension[1])
        outcome.fastest = max(outcome.fastest, world.fastest)
        if world.extension[0] < 0.0 or world.extension[1] > STROKE:
            outcome.failures.append(f"seed {seed}: a piston ran into its end")
        if world.fastest > FASTEST:
            outcome.failures.append(f"seed {seed}: a piston moved at {world.fastest:.2f} m/s")
    finally:
        stage.close()


# ---- the page ------------------------------------------------------------------------------------------------------

HEAD = """\
# Faults through the whole chain

Made by `python -m validation.link.rig_faults`: every fault is made on the virtual rig, that is on the firmware's own
application over the simulated plant, while it tracks a motion of 2.3 deg roll, 1.7 deg pitch and 30 mm heave under a
desk on python-can's virtual bus, in simulated time; each with {seeds} seeds. The controller alone, with the limits of
time that it has to keep: [faults.md](faults.md).

- *detected*: from the fault to the first millisecond in which the controller says it; median and worst. Where
  frames are disturbed that includes the time until the first command frame is hit.
- *pistons*: the extensions reached in the whole trial, with the way back, of a stroke of 0 to 400 mm; the fastest.
- A row without a remark passed all its checks: the fault is said, the mode is the one given, no piston touched an end
  or was faster than {fastest:g} m/s, and the way back led to tracking.

| fault | detected, ms | mode | what the platform does | how it comes back | pistons | remark |
|---|---|---|---|---|---|---|
"""


def row(outcome: Outcome) -> str:
    """One line of the table."""
    trial = outcome.trial
    times = [1e3 * t for t in outcome.detected]
    detected = f"{statistics.median(times):.0f}, {max(times):.0f}" if times else "never"
    cells = (
        trial.fault,
        detected,
        ", ".join(sorted(outcome.modes)),
        trial.does,
        trial.comes_back,
        f"{1e3 * outcome.least:.0f} to {1e3 * outcome.most:.0f} mm, {outcome.fastest:.2f} m/s",
        "; ".join(outcome.failures),
    )
    return "| " + " | ".join(cells) + " |\n"


def main() -> None:
    """Run the trials, print the table, write the page."""
    parser = argparse.ArgumentParser(
        prog="python -m validation.link.rig_faults", description=__doc__
    )
    parser.add_argument("--seeds", type=int, default=5, help="how often each fault is tried")
    parser.add_argument("--short", type=float, help="trials of a minute last only so many seconds")
    parser.add_argument("--only", help="only faults with this word")
    parser.add_argument("--no-page", action="store_true", help="do not write docs/rig_faults.md")
    options = parser.parse_args()
    text = HEAD.format(seeds=options.seeds, fastest=FASTEST)
    failed = False
    for trial in TRIALS:
        if options.only and options.only not in trial.fault:
            continue
        outcome = Outcome(trial)
        for seed in range(1, options.seeds + 1):
            run_trial(trial, seed, min(trial.seconds, options.short or MINUTE), outcome)
        failed = failed or bool(outcome.failures)
        line = row(outcome)
        print(line, end="", flush=True)
        text += line
    if not options.no_page and options.only is None and options.short is None:
        PAGE.write_text(text)
        print(f"written: {PAGE}")
    raise SystemExit(failed)


if __name__ == "__main__":
    main()
