"""What the rounds of a search brought."""

from __future__ import annotations

from dataclasses import dataclass

from sms.diagnosis.hypothesis import Fitted
from sms.diagnosis.selection.candidates import Trial


@dataclass(frozen=True)
class Round:
    """One round: every trial in it, and those that the data cannot tell from the best; or none."""

    trials: list[Trial]
    members: list[Trial]


@dataclass(frozen=True)
class Outcome:
    """What the rounds brought."""

    final: Fitted
    rounds: list[Round]
    found: list[list[Trial]]
    """One class of trials for each cause; the first of it stands for it in the final model."""
    named: bool = True
    """False when so much is left that none of what was found is named."""

    @property
    def groups(self) -> list[list[Trial]]:
        """What was found, if it is named."""
        return self.found if self.named else []

    def explained_by_one(self, share: float) -> bool:
        """Whether an effect took as much as that of what the baseline leaves, with one value for all records, on those
        that were fitted and on the others; named or not. What was judged by its own signal took of that alone.
        """
        first = self.rounds[0].trials if self.rounds else []
        whole = (t for t in first if not t.by_own_signal)
        return any(min(t.seen_share, t.gain) >= share for t in whole)
