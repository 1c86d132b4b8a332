"""When one of two rivals is out, from what they leave in each window."""

from __future__ import annotations

import numpy as np
from sms.diagnosis.selection.validation import told_apart


def test_a_rival_that_leaves_far_more_in_nearly_every_window_is_out_however_unlike_they_are() -> (
    None
):
    best = np.full(20, 400.0)
    worse = 400.0 * 10.0 ** np.linspace(-1.0, 5.0, 20)
    scatter = float(np.std(worse) * np.sqrt(len(worse)))
    assert worse.sum() < 3.0 * scatter  # the largest few are nearly all of it
    assert told_apart(worse, 0.0, best)
    few = np.where(np.arange(20) >= 17, worse, -1.0)  # in three windows only it may be those
    assert not told_apart(few, 0.0, best)


def test_a_rival_that_leaves_a_little_more_is_out_by_its_standard_errors_only() -> None:
    best = np.full(20, 400.0)
    assert not told_apart(np.tile([30.0, -28.0], 10), 0.0, best)
    steady = np.tile([30.0, 28.0], 10)
    assert told_apart(steady, 0.0, best)
    assert not told_apart(steady, 600.0, best)  # alike, and less than honest descriptions leave
