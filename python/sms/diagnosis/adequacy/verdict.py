"""The verdict, from what the extended model leaves and from what its causes are asked."""

from __future__ import annotations

from collections.abc import Sequence

from sms.diagnosis.adequacy.hysteresis import Hysteresis, hysteresis
from sms.diagnosis.adequacy.parameter_constancy import Inconstancy, inconstancy
from sms.diagnosis.adequacy.residual_energy import Left
from sms.diagnosis.fitting import with_sensitivities
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.result import Verdict
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.outcome import Outcome


def inconstancy_of(outcome: Outcome, data: Data, adequate: bool) -> Inconstancy | Hysteresis | None:
    """Of the first class in which nothing is what it is called: how that shows of the one that comes nearest."""
    for members in outcome.found:
        nearest, *others = members
        law = _not_as_named(nearest, outcome.final, data, adequate)
        if law is not None and not any(
            _stands(m, law, outcome.final, data, adequate) for m in others
        ):
            return law
    return None


def _stands(
    member: Trial, law: Inconstancy | Hysteresis, nearest: Fitted, data: Data, adequate: bool
) -> bool:
    """Whether another of the class is what it is called, and leaves less than the nearest one with that other law."""
    fitted = with_sensitivities(member.fitted, data.identify)
    if _not_as_named(member, fitted, data, adequate) is not None:
        return False
    if isinstance(law, Hysteresis):
        return True
    its, left = (Left.by(f, data).excess("validate") for f in (member.fitted, nearest))
    return its < (1.0 - law.takes) * left


def _not_as_named(
    member: Trial, fitted: Fitted, data: Data, adequate: bool
) -> Inconstancy | Hysteresis | None:
    """What leaves no more than is tolerated has the right law as far as can be said; a play is another matter."""
    changes = None if adequate else inconstancy(fitted, member.effect, data)
    return changes or hysteresis(fitted, member.effect, data)


def decide(outcome: Outcome, adequate: bool) -> Verdict:
    """One of the verdicts, data-fault aside: the causes that stand, whatever they leave; else whether much is wrong."""
    if not outcome.groups:
        return "no-evidence" if adequate and not outcome.found else "unknown"
    return of_causes(outcome.groups)


def of_causes(groups: Sequence[Sequence[Trial]]) -> Verdict:
    """The verdict where causes are named: one class of trials for each."""
    if len(groups) > 1:
        return "combination"
    return "cause" if len(groups[0]) == 1 else "class"
