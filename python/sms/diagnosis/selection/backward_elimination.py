"""Causes that were found one after another, judged in the presence of each other.

A round names what explains most alone, while all that later rounds will find is still in the data. A rival that was as
good then may be out once the others are in the model, and a cause may turn out to have stood in for two others. So each
cause is taken out in turn: if the rest explain the records without it, it is dropped; else its rivals are fitted in its
place, and compared as in a round. And two that were found where one would do, a late command and a late pressure for a
late position, give way to a rival of one of them that needs no other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sms import _core
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import Effect
from sms.diagnosis.hypothesis import Data, Fitted, fit, unseen
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.validation import by_window, least_difference, told_apart
from sms.diagnosis.thresholds import ALIKE, IDLE, NEARLY_AS_GOOD, WORTH_OF_LEFT
from sms.estimation.least_squares import changed


def backward_elimination(
    classes: Sequence[list[Trial]], baseline: Fitted, data: Data
) -> tuple[list[list[Trial]], Fitted]:
    """The classes that are still needed, each with the rivals that are still as good, and the first ones' model."""
    final = classes[-1][0].fitted
    if len(classes) < 2:
        return list(classes), final
    kept, final = _in_presence(classes, final, baseline, data)
    while (fewer := _fewer(kept, final, baseline, data)) is not None:
        kept, final = _in_presence(*fewer, baseline, data)
    return kept, final


def _in_presence(
    classes: Sequence[list[Trial]], final: Fitted, baseline: Fitted, data: Data
) -> tuple[list[list[Trial]], Fitted]:
    """One cause after the other taken out and judged again."""
    kept, original = list(classes), _left(baseline, data).sum()
    for members in classes:
        place = next(i for i, c in enumerate(kept) if c is members)
        others = [c[0].effect for c in kept if c is not members]
        without = _model(others, baseline, final.params, data)
        rivals = [m for m in members if m.effect not in others]
        tried = [(m, _model([*others, m.effect], baseline, _near(final, m), data)) for m in rivals]
        best, fitted = _best(tried, data) if tried else (None, without)
        left, alone = _left(fitted, data).sum(), _left(without, data).sum()
        if best is None or _idle(alone, left, original):
            kept.pop(place)
            final = without
            continue
        final = fitted
        least = least_difference(alone, final, data)
        as_good = [
            _in_place(m, fitted, data)
            for m, fitted in tried
            if m is not best
            and not told_apart(
                _left(fitted, data) - _left(final, data),
                least if best.similarity[m.effect.key] > ALIKE else 0.0,
                _left(final, data),
            )
            and alone - _left(fitted, data).sum() >= NEARLY_AS_GOOD * (alone - left)
        ]
        kept[place] = [_in_place(best, final, data), *as_good]
    return kept, final


def _fewer(
    classes: Sequence[list[Trial]], final: Fitted, baseline: Fitted, data: Data
) -> tuple[list[list[Trial]], Fitted] | None:
    """The classes without one that is idle once a rival stands in another's place, and their model; None if none is."""
    original, left = _left(baseline, data).sum(), _left(final, data).sum()
    for gone in classes:
        kept = [c for c in classes if c is not gone]
        tried = []
        for members in kept:
            others = [c[0].effect for c in kept if c is not members]
            tried += [
                (m, _model([*others, m.effect], baseline, _near(final, m), data))
                for m in members[1:]
                if m.effect not in others
            ]
        if tried:
            _, fitted = _best(tried, data)
            if _idle(_left(fitted, data).sum(), left, original):
                return kept, fitted
    return None


def _idle(without: float, left: float, original: float) -> bool:
    """Whether a cause takes next to nothing: chi-square without it, with it, and of the baseline."""
    return without - left < min(IDLE * (original - left), WORTH_OF_LEFT * without)


def _near(final: Fitted, rival: Trial) -> _core.Params:
    """Where the fit with a rival begins: at the present model, the rival as its own round had it."""
    names = list(rival.effect.parameters)
    return changed(final.params, names, np.array([rival.fitted.params[n] for n in names]))


def _model(effects: Sequence[Effect], baseline: Fitted, near: _core.Params, data: Data) -> Fitted:
    hypothesis = baseline.hypothesis
    for effect in effects:
        hypothesis = hypothesis.with_effect(effect)
    start = baseline.params.copy()
    for name in hypothesis.free:
        start[name] = near[name]
    return fit(hypothesis, data.identify, start)


def _left(fitted: Fitted, data: Data) -> Array:
    """Chi-square by window, over seen and unseen records."""
    return by_window(fitted.fit.residual**2, unseen(fitted, data) ** 2, data)


def _best(tried: Sequence[tuple[Trial, Fitted]], data: Data) -> tuple[Trial, Fitted]:
    return min(tried, key=lambda t: float(_left(t[1], data).sum()))


def _in_place(member: Trial, fitted: Fitted, data: Data) -> Trial:
    squared = unseen(fitted, data) ** 2
    return Trial(
        member.effect,
        fitted,
        member.p_value,
        squared,
        gain=member.gain,
        gain_interval=member.gain_interval,
        similarity=member.similarity,
        accepted=True,
        identified=fitted.fit.residual**2,
        support=member.support,
        cross_validated=member.cross_validated,
    )
