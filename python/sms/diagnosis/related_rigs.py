"""The causes of one rig looked up on its relatives: what stays when the seal, or only the mounting, changes?

A rig file names others of the same bench under [[related]], each with what differs there. The extended
model is fitted to all records of each, so that a parameter can be followed from rig to rig.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.fitting import fit
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.result import ParameterValue, Related
from sms.estimation.noise import noise_of
from sms.estimation.windows import Runs
from sms.io.records import load_record
from sms.io.rig import Rig, load_rig
from sms.parameters import PARAMETERS
from sms.rigs.kinds import kind_of


def related_rigs(rig: Rig, extended: Fitted, effects: Sequence[Effect]) -> tuple[Related, ...]:
    """The causes' parameters on this rig and on each related one; empty without causes or relatives."""
    causes = extended.hypothesis.causes
    if not causes or not rig.related:
        return ()
    rows = [_row(rig, "", causes, effects)]
    for relative in rig.related:
        rows.append(_row(load_rig(relative.file), relative.differs, causes, effects))
    return tuple(rows)


def _row(rig: Rig, differs: str, causes: tuple[Effect, ...], effects: Sequence[Effect]) -> Related:
    kind = kind_of(rig)
    motions = tuple(kind.make_run(rig, load_record(rig, source)) for source in rig.records)
    everything = Runs(rig, motions, noise_of(rig, kind, motions), kind)
    hypothesis = baseline_hypothesis(Data(rig, everything, everything), effects)
    for cause in causes:
        hypothesis = replace(hypothesis.with_effect(cause), causes=causes)
    fitted = fit(hypothesis, everything)
    names = [name for name, declared in rig.parameters.items() if declared.fit]
    names += [name for cause in causes for name in cause.parameters]
    values = tuple(
        ParameterValue(
            n, fitted.params[n], fitted.standard_error(n), PARAMETERS[n].unit, rig.declared(n).value
        )
        for n in dict.fromkeys(names)
        if n in hypothesis.free
    )
    return Related(rig.path.name, rig.title, differs, values)
