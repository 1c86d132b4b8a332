"""All experiments in the order of the source, and how they are run."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from sms.validation import (
    actuator,
    chirps,
    findings,
    mechanism,
    open_loop,
    paper,
    requirements,
    steps,
    tank,
)
from sms.validation.figures import Row

Experiment = Callable[[], list[Row]]

EXPERIMENTS: dict[str, Experiment] = {
    "requirements": requirements.table_2_1,
    "force control": mechanism.force_control,
    "round trip": mechanism.round_trip,
    "tank": tank.two_laws,
    "bench sine": actuator.sine,
    "open loop": open_loop.runs,
    "dead band": paper.dead_band,
    "heave chirp": chirps.heave,
    "roll chirp": chirps.roll,
    "pitch chirp": chirps.pitch,
    "chambers at rest": actuator.at_rest,
    "velocity per volt": actuator.speeds,
    "simplified plant": paper.simplified_plant,
    "appendix E": paper.appendix_e,
    "linear steps": paper.linear_steps,
    "proportional control": steps.proportional,
    "state feedback": steps.state_feedback,
    "appendix E, full model": steps.appendix_e,
    "found, actuator": findings.actuator,
    "found, state feedback": findings.state_feedback,
    "found, appendix E": findings.appendix_e,
    "found, requirements": findings.requirements,
}


def validate(
    names: Iterable[str] | None = None, progress: Callable[[str, float], None] | None = None
) -> list[Row]:
    """Run experiments, all of them or those named, and give their rows in order.

    `progress` is told what runs now and the share that is done. KeyError for an unknown name.
    """
    chosen = list(EXPERIMENTS if names is None else names)
    rows: list[Row] = []
    for done, name in enumerate(chosen):
        if progress is not None:
            progress(name, done / len(chosen))
        rows += EXPERIMENTS[name]()
    return rows
