"""Two diagnoses of one machine: what changed, what did not, and what cannot be told, by a test and not by eye.

A size that both have, d = b - a, is held against its standard error sqrt(se_a^2 + se_b^2). A diagnosis that names
nothing states of each effect the shift that would have fitted its records best; where the other one names an effect,
it is compared with that. Being named by one of the two selects such a pair: of an effect at its limit every second
pair is of this sort, and the differences that are large are among them. So their p-value counts twice.

An effect may have more than one size: a supply line's pressure loss is linear in the flow, turbulent, or both. What
only one diagnosis names is compared by the size that is farthest from nothing, and the p-value counts as often as there
are sizes.

Where there is no such estimate, it is only known that the effect is not beyond the size from which the records would
have shown it, the limit L. So only what goes beyond L counts: with the size s that the other names, (|s| - L) over
sqrt(se^2 + (L / 3)^2), L being three standard errors. This holds its level although it is the size that decides what is
named (a comparison with zero would not: of an effect at its limit every second diagnosis names it, and never one that
looks small). The estimates of the declared model's own parameters are compared where neither names a cause: a cause
that is not in the model moves them.

All tests together are judged by Holm's procedure at 5 percent; the chi-square of all is given beside it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal

import numpy as np
from scipy.stats import chi2

from sms.diagnosis.thresholds import DETECTION
from sms.errors import InputError
from sms.history.answer import Answer, Estimate, Explanation
from sms.history.multiple import COVERAGE, LEVEL, holm, seen_from, two_sided

Change = Literal["changed", "unchanged", "cannot be told"]
RELEVANT = 0.1
"""Of its value: the change of a parameter that matters where nothing is declared of its uncertainty. Judgement."""
INDEPENDENT = (
    "The estimates of the two diagnoses are taken as independent of each other. What both take from the same rig file "
    "(a declared value that is off) makes the difference smaller than this says, so that less is called changed."
)
NO_COVARIANCES = (
    "A diagnosis.json holds standard errors without covariances: the chi-square of all takes the sizes of one "
    "diagnosis as uncorrelated. What is called changed does not depend on that (Holm)."
)


@dataclass(frozen=True)
class Item:
    """One size in both diagnoses, SI. NaN is a number that is not there."""

    about: Literal["cause", "model"]
    key: str
    title: str
    parameter: str
    unit: str
    a: float
    a_error: float
    b: float
    b_error: float
    difference: float
    """b - a; of an effect that one does not name, with its neutral value in place of the estimate."""
    low: float
    high: float
    """95 percent interval of the difference."""
    smallest: float
    """The change that would have been seen with a chance of 80 percent."""
    z: float
    """Standard errors by which it differs."""
    change: Change
    reason: str
    """In words, what stands behind it; empty where the numbers say all."""
    absent: Literal["a", "b", ""] = ""
    """The diagnosis that does not name it."""
    selected: bool = False
    """It is compared since one of the two names it: its p-value is that of the difference twice."""
    chosen_from: int = 1
    """Of so many sizes of the effect the one farthest from nothing: its p-value counts as often."""
    p_value: float = math.nan
    p_holm: float = math.nan
    matters: float = 0.0
    """The change that the two should be able to tell, for the difference between unchanged and cannot be told."""


@dataclass(frozen=True)
class Difference:
    """Everything that two diagnoses, a the earlier, say of a change."""

    a: str
    b: str
    items: tuple[Item, ...]
    chi_square: float
    degrees: int
    p_value: float
    """Of all differences together."""
    change: Change
    sentence: str
    assumed: tuple[str, ...]
    would_tell: tuple[str, ...]
    verdicts: tuple[str, str] = field(default=("", ""))

    def to_dict(self) -> dict[str, Any]:
        """The contents of the JSON file."""
        return asdict(self)


def compare(a: Answer, b: Answer, any_machine: bool = False) -> Difference:
    """The difference of two diagnoses. InputError for those of two machines, unless any_machine."""
    if not any_machine and ((a.kind and b.kind and a.kind != b.kind) or a.title != b.title):
        raise InputError(
            f"{b.source} is of '{b.title}'{_kind(b)}, {a.source} of '{a.title}'{_kind(a)}: two machines; "
            "--any-machine compares them all the same"
        )
    found = judged([*_causes(a, b), *_model(a, b)])
    tested = [i for i in found if math.isfinite(i.z)]
    total = float(sum(i.z**2 for i in tested))
    p_value = float(chi2.sf(total, len(tested))) if tested else math.nan
    change = _overall(found)
    return Difference(
        a.source,
        b.source,
        tuple(found),
        total,
        len(tested),
        p_value,
        change,
        _sentence(a, b, found, change),
        _assumed(a, b, found),
        tuple(dict.fromkeys(_would_tell(a, b, found))),
        (a.verdict, b.verdict),
    )


def _kind(answer: Answer) -> str:
    return f" ({answer.kind})" if answer.kind else ""


# ---- what is compared ------------------------------------------------------------------------------


def _causes(a: Answer, b: Answer) -> Iterator[Item]:
    """Each cause of either once; one of a class is the other's where both classes hold it."""
    matched: set[int] = set()
    for members in a.causes:
        partner, here, there = _partner(members, b, matched)
        if partner is None or here is None or there is None:
            yield _one_sided(members[0], a, b, named_in_b=False)
        else:
            matched.add(partner)
            yield from _both(here, there, members, b.causes[partner])
    for number, members in enumerate(b.causes):
        if number not in matched:
            yield _one_sided(members[0], b, a, named_in_b=True)


def _partner(
    members: Sequence[Explanation], b: Answer, taken: set[int]
) -> tuple[int | None, Explanation | None, Explanation | None]:
    for mine in members:
        for number, others in enumerate(b.causes):
            for other in others:
                if number not in taken and other.key == mine.key:
                    return number, mine, other
    return None, None, None


def _both(
    here: Explanation,
    there: Explanation,
    mine: Sequence[Explanation],
    theirs: Sequence[Explanation],
) -> Iterator[Item]:
    """Every parameter of an effect that both name."""
    others = {e.parameter: e for e in there.estimates}
    reason = ""
    if len(mine) > 1 or len(theirs) > 1:
        reason = "one of a class that the signals cannot tell apart; compared as this member of it"
    for one in here.estimates:
        if (other := others.get(one.parameter)) is not None:
            size = max(abs(one.shift), abs(other.shift))
            yield _two_estimates("cause", here.key, here.title, one, other, size, reason)


def _two_estimates(
    about: Literal["cause", "model"],
    key: str,
    title: str,
    a: Estimate,
    b: Estimate,
    matters: float,
    reason: str = "",
) -> Item:
    error = math.hypot(a.standard_error, b.standard_error)
    difference = b.value - a.value
    if not math.isfinite(error) or not math.isfinite(difference):
        reason = "the fit of one of the two has no standard error for it"
        error = math.nan
    return Item(
        about, key, title, a.parameter, a.unit, a.value, a.standard_error, b.value,
        b.standard_error, difference, difference - COVERAGE * error,
        difference + COVERAGE * error, error, difference / error, "cannot be told", reason,
        matters=matters,
    )  # fmt: skip


def _one_sided(named: Explanation, own: Answer, other: Answer, named_in_b: bool) -> Item:
    """An effect that only one of the two names, `own`; `other` does not."""
    absent: Literal["a", "b"] = "a" if named_in_b else "b"
    sizes = named.sizes
    size = max(sizes, key=lambda e: abs(e.shift) / e.standard_error, default=named.estimates[0])
    chosen_from = max(len(sizes), 1)
    first = size is named.estimates[0]
    if first and (unnamed := other.not_named(named)) is not None:
        a, b = (unnamed, size) if named_in_b else (size, unnamed)
        reason = f"{other.source} does not name it; in brackets is the size that would fit its records best"
        item = _two_estimates("cause", named.key, named.title, a, b, abs(size.shift), reason)
        return replace(item, absent=absent, selected=True, chosen_from=chosen_from)
    sign = 1.0 if named_in_b else -1.0
    limit, reason = limit_of(named, size, own, other)
    neutral = Estimate(size.parameter, size.unit, size.neutral, limit / DETECTION, size.neutral)
    a, b = (neutral, size) if named_in_b else (size, neutral)
    error = math.hypot(size.standard_error, limit / DETECTION)
    beyond = max(abs(size.shift) - limit, 0.0)
    middle = sign * size.shift
    if not math.isfinite(error + size.shift):
        error, reason = math.nan, reason or "the fit has no standard error for it"
    reach = limit + COVERAGE * error
    return Item(
        "cause", named.key, named.title, size.parameter, size.unit, a.value, a.standard_error,
        b.value, b.standard_error, middle, middle - reach, middle + reach, error,
        beyond / error, "cannot be told", reason, matters=abs(size.shift),
        absent=absent, chosen_from=chosen_from,
    )  # fmt: skip


def limit_of(named: Explanation, size: Estimate, own: Answer, other: Answer) -> tuple[float, str]:
    """The shift of a size up to which the other diagnosis may have missed the effect, and what that number is from; NaN
    if unknown."""
    if not other.judges:
        return math.nan, f"{other.source} names no cause, its verdict is {other.verdict}"
    if (why := other.not_testable.get(named.key)) is not None:
        return math.nan, f"{other.source} could not have seen it, {why}"
    limit = other.limits.get(named.key, math.nan)
    if size is named.estimates[0] and math.isfinite(limit):
        return limit, ""
    return DETECTION * coarser(own, other) * size.standard_error, (
        f"{other.source} does not say from which size it would show it; three standard errors of the other diagnosis "
        "are taken, times how much larger the errors are of what both estimate"
    )


def coarser(own: Answer, other: Answer) -> float:
    """By what factor standard errors of the other are larger, the median over what both estimate; 1 at least."""
    mine = {e.parameter: e.standard_error for e in _estimates(own)}
    ratios = [
        e.standard_error / mine[e.parameter] for e in _estimates(other) if e.parameter in mine
    ]
    finite = [r for r in ratios if math.isfinite(r)]
    return max(float(np.median(finite)), 1.0) if finite else 1.0


def _estimates(answer: Answer) -> list[Estimate]:
    first = [e for members in answer.causes for e in members[0].estimates]
    return [*answer.model, *first]


def _model(a: Answer, b: Answer) -> Iterator[Item]:
    """The declared model's own parameters, which are right where nothing is wrong with it."""
    if not (a.verdict == b.verdict == "no-evidence"):
        return
    others = {e.parameter: e for e in b.model}
    for one in a.model:
        other = others.get(one.parameter)
        if other is None:
            continue
        known = b.declared.get("parameters", {}).get(one.parameter, {})
        width = 0.0 if known.get("fit") else float(known.get("uncertainty") or 0.0)
        matters = width or RELEVANT * max(abs(one.value), abs(other.value))
        if one.neutral != other.neutral:
            reason = "declared otherwise in the two rig files"
            yield _two_estimates("model", "", "", one, other, matters, reason)
        else:
            yield _two_estimates("model", "", "", one, other, matters)


# ---- judgement -------------------------------------------------------------------------------------


def judged(items: Sequence[Item]) -> list[Item]:
    """The items with their p values and what follows; their `smallest` is a standard error until then."""
    p_values = [
        min(two_sided(i.z) * i.chosen_from * (2.0 if i.selected else 1.0), 1.0)
        if math.isfinite(i.z)
        else math.nan
        for i in items
    ]
    seen = seen_from(int(np.isfinite(p_values).sum()))
    out = []
    for item, p, corrected in zip(items, p_values, holm(p_values), strict=True):
        bound = max((item.high - item.low) / 2.0 - COVERAGE * item.smallest, 0.0)
        smallest = bound + seen * item.smallest
        change: Change = "cannot be told"
        if corrected < LEVEL:
            change = "changed"
        elif math.isfinite(p) and smallest <= item.matters:
            change = "unchanged"
        out.append(replace(item, p_value=p, p_holm=corrected, smallest=smallest, change=change))
    return out


def _overall(items: Sequence[Item]) -> Change:
    changes = {i.change for i in items}
    if "changed" in changes:
        return "changed"
    return "unchanged" if "unchanged" in changes and not _untold(items) else "cannot be told"


def _untold(items: Sequence[Item]) -> list[Item]:
    """Causes of which it cannot be told; a parameter of the model that the records do not tell of is no reason."""
    return [i for i in items if i.change == "cannot be told" and i.about == "cause"]


def _sentence(a: Answer, b: Answer, items: Sequence[Item], change: Change) -> str:
    if not items:
        if a.judges and b.judges:
            return "Neither names a cause, and neither holds an estimate that could be compared."
        blind = a if not a.judges else b
        return (
            f"Nothing can be compared: the verdict of {blind.source} is {blind.verdict}, which holds no size of a "
            "cause."
        )
    changed = [_name(i) for i in items if i.change == "changed"]
    counts = {c: sum(i.change == c for i in items) for c in ("unchanged", "cannot be told")}
    rest = f"{counts['unchanged']} unchanged, of {counts['cannot be told']} it cannot be told"
    if changed:
        return f"Changed: {', '.join(changed)} ({rest})."
    if change == "unchanged":
        return f"Nothing changed by as much as these records would show ({rest})."
    return f"Whether something changed cannot be told ({rest})."


def _name(item: Item) -> str:
    return item.title or item.parameter.replace("_", " ")


def _assumed(a: Answer, b: Answer, items: Sequence[Item]) -> tuple[str, ...]:
    said = [INDEPENDENT, NO_COVARIANCES] if items else []
    if items and not any(i.about == "model" for i in items):
        said.append(
            "The declared model's own parameters are not compared: a cause that is named, or an error that is not, "
            "moves their estimates."
        )
    return (*said, *a.lacks, *b.lacks)


def _would_tell(a: Answer, b: Answer, items: Sequence[Item]) -> Iterator[str]:
    """The records by which what cannot be told now could be."""
    untold = _untold(items)
    for answer in (b, a):
        if untold and answer.next_experiment:
            yield f"{answer.source} proposes: {answer.next_experiment}"
    for item in untold:
        if item.matters > 0.0 and math.isfinite(item.smallest):
            times = (item.smallest / item.matters) ** 2
            if times > 1.0:
                yield (
                    f"{_name(item)}: records like these, about {times:.1f} times as long, would show a change by all "
                    "of it"
                )
