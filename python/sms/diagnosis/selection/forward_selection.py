"""Forward selection on strokes: rounds until nothing more is found. Rigs that are simulated have stepwise.py."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms.callbacks import Progress
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted
from sms.diagnosis.other_records import unseen
from sms.diagnosis.selection.candidates import try_effects
from sms.diagnosis.selection.outcome import Outcome, Round
from sms.diagnosis.selection.validation import Yardstick, ambiguity_group, judge
from sms.diagnosis.thresholds import MOST_CAUSES


def forward_selection(
    baseline: Fitted,
    data: Data,
    effects: Sequence[Effect],
    floor: float,
    rng: np.random.Generator,
    progress: Progress,
) -> Outcome:
    """Until nothing more is found: the best effect joins the model, with those that look alike.

    floor: mean square of what no model of the state explains.
    """
    original = float(np.mean(unseen(baseline, data) ** 2))
    yardstick = Yardstick(original, floor)
    current, rounds = baseline, []
    remaining = list(effects)
    for number in range(1, MOST_CAUSES + 1):
        if not remaining:
            break
        done = 0.1 + 0.75 * number / (MOST_CAUSES + 1)
        progress(f"round {number}: {len(remaining)} effects", done)
        trials = try_effects(current, data, remaining, rng)
        judge(trials, current, data, yardstick, rng)
        members = ambiguity_group(trials, current, data, rng)
        rounds.append(Round(trials, members))
        if not members:
            break
        current = members[0].fitted
        remaining = [e for e in remaining if e.key not in {m.effect.key for m in members}]
    found = [r.members for r in rounds if r.members]
    return Outcome(current, rounds, found)
