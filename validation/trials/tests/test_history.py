"""Two diagnoses compared, and a series of them: the level of what is called changed, and the power."""

from __future__ import annotations

import numpy as np
from sms.history import compare

from validation.trials.history import (
    LEAK,
    drawn_answer,
    history_shares,
    leak_course,
    onset_found,
    pair_shares,
    read,
)

PAIRS = 200
SEED = 41


def test_a_pair_of_an_unchanged_machine_is_called_changed_in_five_percent_at_the_most() -> None:
    """The share of a fixed seed, so that its lower bound is what a level above 5 percent would move."""
    shares = pair_shares(PAIRS, SEED)
    unchanged, one, two, three = (s.count / s.of for s in shares)
    # 0.05 + 1.645 sqrt(0.05 * 0.95 / 200): a level of 5 percent is exceeded by more once in twenty seeds.
    assert unchanged <= 0.05 + 1.645 * np.sqrt(0.05 * 0.95 / PAIRS)
    assert one < two < three
    assert three > 0.9


def test_a_leak_that_grows_over_twelve_records_is_named_with_its_onset_within_two() -> None:
    rng = np.random.default_rng(SEED)
    onsets = [3, 4, 5, 6, 7, 8] * 7
    found = [onset_found(leak_course(rng, onset, 1.0)[0], onset) for onset in onsets]
    assert sum(found) >= 0.9 * len(found)


def test_a_steady_machine_is_left_in_peace() -> None:
    share = history_shares(60, SEED)[-1]
    assert share.count <= 6  # P(more than 6 of 60 at 5 percent) = 3 percent


def test_what_is_named_once_at_its_limit_is_not_called_changed() -> None:
    """The size that decides whether it is named is not held against zero."""
    rng = np.random.default_rng(SEED)
    pairs = [
        (read(drawn_answer(rng, {LEAK: 3.0}), "a"), read(drawn_answer(rng, {LEAK: 3.0}), "b"))
        for _ in range(200)
    ]
    once = [compare(a, b) for a, b in pairs if len(a.causes) != len(b.causes)]
    assert len(once) > 60
    assert sum(d.change == "changed" for d in once) <= 0.05 * len(once)
