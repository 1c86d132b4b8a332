"""From checked records to runs by role, as the rig's problems."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from sms.diagnosis.adequacy.repeatability import Ground
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit, residual_of
from sms.diagnosis.hypothesis import Data, baseline_hypothesis
from sms.diagnosis.result import Finding
from sms.estimation.block_statistics import windows_per_block
from sms.estimation.kind import Kind
from sms.estimation.noise import noise_of
from sms.estimation.run import Run
from sms.estimation.windows import Runs
from sms.io.records import Record
from sms.io.rig import Rig
from sms.rigs.kinds import kind_of


def make_data(rig: Rig, records: Sequence[Record]) -> Data:
    """The records by role, as the rig's problems. InputError for a kind of rig that has none."""
    kind = kind_of(rig)
    runs = [kind.make_run(rig, record) for record in records]
    data = split(rig, kind, runs, noise_of(rig, kind, runs))
    return data if kind.whitened else in_blocks(data)


def without_windows(data: Data) -> tuple[Finding, ...]:
    """What is wrong with records of which no window is left, since a reading is clipped in each."""
    found = []
    for runs in (data.identify, data.validate, data.test, data.reference):
        if runs is None or not any(run.clipped for run in runs.motions):
            continue
        left = {w.record for w in runs.problem.windows}
        found += [
            Finding(
                "error",
                run.name,
                None,
                None,
                "in every window of this record a reading sits at the end of its range",
                "choose a sensor of another range, or leave this record out",
            )
            for number, run in enumerate(runs.motions)
            if number not in left
        ]
    return tuple(found)


def split(rig: Rig, kind: Kind, runs: Sequence[Run], noise: dict[str, float]) -> Data:
    """Runs by role."""

    def of(role: str) -> Runs:
        return Runs(rig, tuple(r for r in runs if r.role == role), noise, kind)

    kept_out = of("test") if any(r.role == "test" for r in runs) else None
    reference = of("reference") if any(r.role == "reference" for r in runs) else None
    return Data(rig, of("identify"), of("validate"), kept_out, reference)


def in_blocks(data: Data) -> Data:
    """With as many windows in a block as the baseline's noise asks for, where that is not declared."""
    first = fit(baseline_hypothesis(data, effects_of(data.rig)), data.identify)

    def blocked(runs: Runs) -> Runs:
        inputs = runs.inputs
        ground = Ground.of(runs.record, runs.window, inputs["extension [m]"], inputs["direction"])
        noise = ground.without_repeats(residual_of(runs, first.params))
        return replace(runs, windows_per_block=windows_per_block(noise, runs.record, runs.window))

    return replace(
        data,
        identify=blocked(data.identify),
        validate=blocked(data.validate),
        test=None if data.test is None else blocked(data.test),
    )
