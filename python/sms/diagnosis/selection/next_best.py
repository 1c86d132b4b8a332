"""What is named where the cause that left least does not stand: the next best account of the same error.

Several effects may each take what is left, and the one that leaves least be known so roughly that its size may be
nothing: a zero of a sensor whose converter may round down, where the supply's set point is off by as much. That one
account cannot be shown is nothing against another.
"""

from __future__ import annotations

from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.selection.ambiguity import alike
from sms.diagnosis.selection.candidates import converged
from sms.diagnosis.selection.outcome import Outcome, Round


def next_best(outcome: Outcome, baseline: Fitted, data: Data) -> Outcome | None:
    """The class of those that were accepted in the first round and not refused since, if any is left, and its model."""
    first = outcome.rounds[0]
    accepted = sorted((t for t in first.trials if t.accepted), key=lambda t: -t.lower)
    if not accepted:
        return None
    members = alike(accepted, baseline, data)
    members[0].fitted = converged(members[0].fitted, data)
    rounds = [Round(first.trials, members), *outcome.rounds[1:]]
    return Outcome(members[0].fitted, rounds, [members])
