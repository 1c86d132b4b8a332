"""Parts of the selection by themselves: how reference records scatter, and which rivals share a class."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from sms.diagnosis.adequacy.residual_energy import Left
from sms.diagnosis.reference import _inflation
from sms.diagnosis.selection import ambiguity, backward_elimination, candidates, judgement, pairs
from sms.diagnosis.selection.candidates import Trial
from sms.diagnosis.selection.finite_steps import Step, chosen_by_step
from sms.diagnosis.selection.outcome import Outcome, Round

from validation.random_cases import draw

BLOCKS, SAMPLES, PARAMETERS = 60, 100, 6


def inflation(residual: Any, weak: int = 0) -> float:
    """Of least squares with some parameters that the records hardly see, and that are declared."""
    random = np.random.default_rng(1)
    jacobian = random.normal(size=(len(residual), PARAMETERS + weak))
    # What acts all through a block, as most parameters of a plant do.
    jacobian += 2.0 * np.repeat(random.normal(size=(BLOCKS, PARAMETERS + weak)), SAMPLES, axis=0)
    jacobian[:, PARAMETERS:] *= 1e-6
    block = np.repeat(np.arange(BLOCKS), SAMPLES)
    return _inflation(jacobian, residual, 0.1 * np.eye(PARAMETERS + weak), block)


@pytest.mark.parametrize("weak", [0, 12])
def test_reference_records_inflate_a_variance_by_what_lasts_through_a_block(weak: int) -> None:
    """And what they do not tell of has no say in it: it was a factor of 40 instead of 20 with thirty such numbers."""
    random = draw("inflation")
    white = random.normal(size=BLOCKS * SAMPLES)
    lasting = np.repeat(random.normal(size=BLOCKS), SAMPLES)
    assert 1.0 <= inflation(white, weak) < 1.8  # of 800 draws one is above 1.6
    # Of a residual that is half constant in a block, scores along columns that are so too scatter
    # by 0.5 x 0.8 x SAMPLES times their information.
    expected = 0.5 + 0.5 * 0.8 * SAMPLES
    found = inflation(np.sqrt(0.5) * (white + lasting), weak)
    assert 0.5 * expected < found < 2.0 * expected


def test_members_that_are_one_equation_are_not_ordered_by_rounding() -> None:
    def trial(key: str, lower: float) -> Trial:
        effect = SimpleNamespace(id=key, key=key, parameters=(key,))
        made = Trial(cast(Any, effect), cast(Any, None), 0.0, np.zeros(1))
        made.lower = lower
        return made

    for off in (-1e-12, 0.0, 1e-12):
        members = [trial("outlet", 0.9), trial("leak", 0.9 + off), trial("late", 0.95)]
        assert [t.effect.key for t in ambiguity._plainest(members)] == ["late", "leak", "outlet"]


def test_what_is_no_worse_than_the_last_cause_shares_its_class(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    worse = {"c"}
    monkeypatch.setattr(ambiguity, "_no_worse", lambda t, best, data: t.effect not in worse)

    def trial(effect: str, lower: float, accepted: bool = True) -> Trial:
        made = Trial(cast(Any, effect), cast(Any, None), 0.0, np.zeros(1))
        made.accepted, made.lower = accepted, lower
        return made

    trials = [trial(e, n) for n, e in enumerate("abcdef")] + [trial("z", 9.0, accepted=False)]
    best = trials[0]
    members = ambiguity.with_substitutes(Round(trials, [best]), cast(Any, None)).members
    # c is worse, z was not accepted; of the others the best two.
    assert [t.effect for t in members] == ["a", "f", "e"]
    assert all(t.support == pytest.approx(1.0 / 3.0) for t in members)


def test_what_leaves_less_at_the_end_of_what_is_plausible_shares_the_class(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A cylinder without Coulomb friction fits at 0 N, and pressure-dependent friction was named alone in its place."""
    monkeypatch.setattr(
        ambiguity, "implausible", lambda effect, fitted, data: effect.end and "at the end"
    )
    monkeypatch.setattr(ambiguity, "_similarity", lambda one, other, *_: other.effect.cosine)
    model, candidate = cast(Any, "model as it stands"), cast(Any, "with the effect")

    def trial(
        name: str, lower: float, end: bool = True, cosine: float = 1.0, gain: float = 0.9
    ) -> Trial:
        effect = SimpleNamespace(
            id=name, key=name, parameters=(name,), end=end and name, cosine=cosine
        )
        made = Trial(cast(Any, effect), candidate, 1e-9, np.zeros(1))
        made.lower, made.gain, made.seen_share, made.gain_interval = lower, gain, 0.9, (0.5, 1.0)
        made.accepted = not end
        return made

    named = trial("named", 5.0, end=False)
    tried = [
        named,
        trial("leaves less", 6.0),
        trial("leaves more", 4.0),
        trial("changes otherwise", 7.0, cosine=0.2),
        trial("worse on validation records", 8.0, gain=-0.1),
    ]
    by_chance = trial("by chance", 9.0)
    by_chance.p_value = 0.5
    members = ambiguity.ambiguity_group([*tried, by_chance], model, cast(Any, None))
    assert [m.effect.id for m in members] == ["named", "leaves less"]
    assert members[1].reason == "at the end, and leaves less than what is named"
    assert [m.support for m in members] == [0.5, 0.5]


@pytest.mark.parametrize(
    ("worse_by", "class_of"),
    [
        ({"b": 2.5, "c": 2.5}, "abc"),  # three, none worse by three standard errors
        ({"b": 2.5, "c": 3.5}, "ab"),
        ({"b": 2.5, "c": 1.0, "d": 2.5, "e": 1.5}, "ace"),  # a crowd: two standard errors
        ({"b": 1.0, "c": 1.0, "d": 1.0, "e": 1.0}, "abcde"),  # nothing tells these apart
    ],
)
def test_of_a_crowd_those_stay_that_are_hardly_worse(
    worse_by: dict[str, float], class_of: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_worse(trial: Trial, best: Trial, data: Any, standard_errors: float = 3.0) -> bool:
        return worse_by[trial.effect.key] <= standard_errors

    monkeypatch.setattr(ambiguity, "_no_worse", no_worse)
    monkeypatch.setattr(ambiguity, "_similarity", lambda one, other, current, data: 0.95)
    accepted = []
    for name in ("a", *worse_by):
        effect = SimpleNamespace(key=name, id=name, parameters=(name,))
        trial = Trial(cast(Any, effect), cast(Any, None), 0.0, np.zeros(1))
        trial.lower = 10.0 - worse_by.get(name, 0.0)
        accepted.append(trial)
    members = ambiguity.alike(accepted, cast(Any, None), cast(Any, None))
    assert "".join(sorted(m.effect.id for m in members)) == class_of


@pytest.mark.parametrize(
    ("left", "on_identify", "in_its_own_signal", "asked"),
    [
        (10.0, 0.02, 0.02, False),  # takes next to nothing where it was fitted
        (10.0, 0.5, 0.02, True),
        (10.0, 0.05, 0.6, True),  # what its equation gives alone, and hardly seen beside the others
        (10.0, -0.3, -0.3, False),
        (1e-3, 0.02, 0.02, True),  # of hardly anything
    ],
)
def test_what_takes_nothing_where_it_was_fitted_is_not_fitted_again_elsewhere(
    left: float,
    on_identify: float,
    in_its_own_signal: float,
    asked: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = Left(np.full((8, 2), 1.0 + left), np.full((3, 2), 11.0))
    own = 1.0 + left * (1.0 - in_its_own_signal)
    other = 1.0 + left * (1.0 - (2.0 * on_identify - in_its_own_signal))
    after = np.tile([other, own], (8, 1))
    monkeypatch.setattr(Left, "where_fitted", lambda self, fitted, data: Left(after, self.validate))
    monkeypatch.setattr(judgement, "channel_of_its_own", lambda effect, data: 1)
    trial = Trial(cast(Any, "effect"), cast(Any, "with the effect"), 1e-9)
    runs = SimpleNamespace(kind=SimpleNamespace(practically_significant=(0.1, 1.0)))
    data = cast(Any, SimpleNamespace(healthy=None, identify=runs))
    objection = judgement.no_help(trial, cast(Any, "without"), data, before, 0.5, 10)
    assert (trial.lower > 0.0) == (on_identify > 0.0)
    said = f"takes {100.0 * on_identify:.0f} % of what is left on the identification records"
    assert objection == ("" if asked else said.replace("-", "−"))


def test_pairs_are_filled_up_with_what_was_not_fitted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a lung with two wrong settings one promised nothing alone, and nothing beside the best candidate either."""
    current = cast(Any, "model as it stands")

    def none_helps(effects: list[Any], *model: Any) -> list[Step]:
        return [Step(0.0, current, np.zeros(1)) for _ in effects]

    monkeypatch.setattr(pairs, "best_steps", none_helps)
    trials = []
    for name, p_value, lower in (
        ("a", 0.5, 0.0),
        ("b", 0.1, 3.0),
        ("c", 0.2, 0.0),
        ("d", 0.1, 5.0),
    ):
        fitted = "its own" if lower > 0.0 else current
        trial = Trial(cast(Any, name), cast(Any, fitted), p_value, np.zeros(1))
        trial.lower = lower
        trials.append(trial)
    data = cast(Any, SimpleNamespace(healthy=None))
    tried = pairs._most_promising(trials, current, data)
    assert {"".join(sorted(cast(Any, t.effect) for t in pair[:2])) for pair in tried} == {
        "bd",
        "cd",
        "ad",
        "bc",
        "ab",
    }


def test_what_is_hidden_beside_a_cause_is_tried_beside_it_although_another_leads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of a valve's centre and a late position the best alone was heat, and the time offset was not tried."""
    current = cast(Any, "model as it stands")
    hidden = Step(100.0, current, np.zeros(1))

    def beside(effects: list[Any], model: Any, *rest: Any) -> list[Step]:
        nothing = Step(0.0, current, np.zeros(1))
        return [hidden if (model, e) == ("centre", "clock") else nothing for e in effects]

    monkeypatch.setattr(pairs, "best_steps", beside)
    trials = []
    for name, lower in (
        ("heat", 5.0),
        ("centre", 4.0),
        ("leak", 3.0),
        ("lag", 2.0),
        ("tube", 1.0),
        ("clock", -9.0),
    ):
        trial = Trial(cast(Any, name), cast(Any, name), 0.5, np.zeros(1))
        trial.lower = lower
        trials.append(trial)
    tried = pairs._most_promising(trials, current, cast(Any, SimpleNamespace(healthy=None)))
    assert ("centre", "clock", hidden) in [(a.effect, b.effect, step) for a, b, step in tried]
    assert len(tried) <= 9


def test_several_names_of_one_change_take_one_of_the_places_that_are_fitted() -> None:
    """A zero, a gain and a setting shift one reading alike: the supply that droops came after them, not fitted."""
    shift, droop, other, fourth = np.eye(4)
    current = cast(Any, "model as it stands")
    steps = [
        Step(9.0, current, shift),
        Step(8.9, current, -2.0 * shift),  # another direction
        Step(8.8, current, 3.0 * shift),
        Step(8.7, current, shift + 0.01 * other),
        Step(3.0, current, droop),
        Step(2.0, current, other),
        Step(1.0, current, fourth),
        Step(0.0, current, fourth),
    ]
    first, alike = chosen_by_step(steps)
    assert first == [0, 1, 4]
    assert alike == [2, 3]
    assert chosen_by_step([Step(0.0, current, shift)]) == ([], [])


def test_of_nothing_a_cause_takes_no_share() -> None:
    """A healthy machine was named for it: nothing was left on its identification records, 6 % taken on the others."""
    data = cast(
        Any,
        SimpleNamespace(
            healthy=None,
            identify=SimpleNamespace(kind=SimpleNamespace(practically_significant=(0.15, 0.3))),
        ),
    )
    trial = Trial(cast(Any, "e"), cast(Any, None), 0.0, np.zeros(1))
    trial.seen_share, trial.gain = 1.0, 0.06

    def refused(identify: float, validate: float) -> bool:
        left = Left(np.full((8, 2), 1.0 + identify), np.full((8, 2), 1.0 + validate))
        return bool(judgement._leaves_much(trial, 0.5, judgement._telling(left, data)))

    assert refused(identify=0.0, validate=2.0)
    assert not refused(identify=5.0, validate=2.0)
    assert not refused(identify=5.0, validate=0.1)
    assert not refused(identify=0.0, validate=0.1)  # of so little neither says more than the other


def test_the_end_of_what_shapes_an_effect_is_nothing_against_its_size() -> None:
    """A tube without loss is a tube."""
    table = {"length": "m", "loss": "1"}
    entry = {n: SimpleNamespace(unit=unit, upper=20.0) for n, unit in table.items()}
    data = cast(Any, SimpleNamespace(rig=SimpleNamespace(table=entry)))

    def objection(sizes: int | None, **values: float) -> str:
        free = [name for name, value in values.items() if 0.0 < value < 20.0]
        start = {"length": 0.0, "loss": 1.0}
        fitted = SimpleNamespace(
            params=values, movable=free, hypothesis=SimpleNamespace(start=start)
        )
        effect = SimpleNamespace(parameters=("length", "loss"), sizes=sizes)
        return judgement.implausible(cast(Any, effect), cast(Any, fitted), data)

    assert objection(1, length=3.0, loss=0.5) == ""
    assert objection(1, length=3.0, loss=0.0) == ""
    assert objection(1, length=20.0, loss=0.5).startswith("fits best at or beyond 20")
    assert objection(None, length=3.0, loss=0.0).startswith("fits best at or beyond 0")


def test_what_ends_up_within_what_is_declared_or_at_its_end_is_no_cause(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        backward_elimination, "with_these", lambda found, *rest: [m[0] for m in found]
    )
    monkeypatch.setattr(backward_elimination, "_without_one", lambda *rest: None)
    at_its_end: set[str] = set()

    def implausible(effect: Any, final: Any, data: Any) -> str:
        return "fits best at its end" if effect.parameters[0] in at_its_end else ""

    monkeypatch.setattr(backward_elimination, "implausible", implausible)
    distance: dict[str, float] = {}
    monkeypatch.setattr(
        backward_elimination,
        "_distance_from_nothing",
        lambda effect, *rest: (distance.get(effect.parameters[0], 9.0), 1),
    )

    def found(name: str) -> list[Trial]:
        made = Trial(
            cast(Any, SimpleNamespace(parameters=(name,))), cast(Any, None), 0.0, np.zeros(1)
        )
        made.accepted = True
        return [made]

    hypothesis = SimpleNamespace(start={"mass": 3.6, "leak": 0.0}, known={"mass": 0.2})
    baseline = cast(Any, SimpleNamespace(hypothesis=hypothesis))
    # Of what the baseline does not free, the declared half width counts.
    declared = SimpleNamespace(uncertainty=1e-10)
    data = cast(Any, SimpleNamespace(rig=SimpleNamespace(declared=lambda name: declared)))
    mass, leak = found("mass"), found("leak")
    outcome = Outcome(cast(Any, None), [], [mass, leak])

    def without(value: float) -> Outcome | None:
        final = cast(Any, SimpleNamespace(params={"mass": value, "leak": 1e-9}))
        return backward_elimination.without_untenable(outcome, final, baseline, data)

    assert without(3.9) is None
    fewer = without(3.7)
    assert fewer is not None
    assert fewer.found == [leak]
    assert not mass[0].accepted
    assert leak[0].accepted
    at_its_end.add("leak")
    fewer = without(3.9)
    assert fewer is not None
    assert fewer.found == [mass]
    assert leak[0].reason == "in the final model fits best at its end"
    at_its_end.clear()
    distance["leak"] = 3.0  # of 95 %: 3.84
    fewer = without(3.9)
    assert fewer is not None
    assert fewer.found == [mass]
    outcome = Outcome(cast(Any, None), [], [leak])  # alone it took what there was, as sure as that
    assert without(3.9) is None


def test_records_that_one_effect_explains_do_not_contradict_each_other() -> None:
    """Whether or not the effect is named in the end."""
    trial = Trial(cast(Any, None), cast(Any, None), 0.0, np.zeros(1))
    trial.seen_share, trial.gain = 0.85, 0.95
    explained = Outcome(cast(Any, None), [Round([trial], [])], [])
    assert explained.explained_by_one(0.8)
    assert not explained.explained_by_one(0.9)
    assert not Outcome(cast(Any, None), [], []).explained_by_one(0.0)
    trial.by_own_signal = True  # of that one alone
    assert not explained.explained_by_one(0.8)


def test_a_single_cause_within_its_error_is_none_unless_it_takes_nearly_all_of_much(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    distance = {"leak": 4.0, "gain": 9.0}  # of 95 %: 3.84
    monkeypatch.setattr(
        backward_elimination,
        "_distance_from_nothing",
        lambda effect, *rest: (distance[effect.parameters[0]], 1),
    )
    monkeypatch.setattr(backward_elimination, "generalised", lambda fitted, data: fitted)
    monkeypatch.setattr(Left, "by", lambda *model: None)
    monkeypatch.setattr(backward_elimination, "small", lambda left, least: bool(least[0] > 1.0))
    baseline = cast(Any, SimpleNamespace(hypothesis=SimpleNamespace(start={})))

    def trial(name: str, share: float) -> Trial:
        effect = cast(Any, SimpleNamespace(parameters=(name,)))
        made = Trial(effect, cast(Any, None), 0.0, np.zeros(1))
        made.seen_share = made.gain = share
        return made

    def stands(members: list[Trial], tolerated: float = 0.0) -> bool:
        outcome = Outcome(cast(Any, None), [], [members])
        left = backward_elimination.without_insignificant(
            outcome, cast(Any, None), baseline, cast(Any, None), np.full(1, tolerated)
        )
        return left is outcome

    assert stands([trial("leak", 0.5)])
    distance["leak"] = 3.7
    assert not stands([trial("leak", 0.5)])
    assert stands([trial("leak", 0.5), trial("gain", 0.5)])  # of a class another is beyond doubt
    assert stands([trial("leak", 0.9)])
    by_own = trial("leak", 0.9)
    by_own.by_own_signal = True
    assert not stands([by_own])
    assert not stands([trial("leak", 0.9)], tolerated=9.0)


@pytest.mark.parametrize(
    ("off", "alike", "sizes", "expected"),
    [
        ((1.5, 0.0), 0.0, None, 2.25),
        ((2.0, 1.0), 0.0, None, 5.0),
        ((1.5, -1.5), 0.99, None, 450.0),  # each may be nothing, both together not
        ((1.5, 1.5), 0.99, None, 2.25 * 2.0 / 1.99),
        ((2.0, 9.0), 0.0, 1, 4.0),
        (
            (0.6, -1.9),
            -0.907,
            1,
            0.36 / (1.0 - 0.907**2),
        ),  # a presliding that was named, as nothing is
        ((1.5, -1.5), 0.99, 1, 2.25 / (1.0 - 0.99**2)),
    ],
)
def test_how_far_an_effect_is_from_what_is_declared(
    off: tuple[float, float], alike: float, sizes: int | None, expected: float
) -> None:
    """A tube's length and diameter are known as one combination; a conductance of 1.57 +- 0.21 beside it was 1.50. Of
    an effect with one size the other parameter shapes what that switches on.
    """
    error = np.array([2.0, 3e-3])
    covariance = np.outer(error, error) * np.array([[1.0, alike], [alike, 1.0]])
    final = SimpleNamespace(
        params={"length": 1.0 + off[0] * 2.0, "diameter": 0.009 + off[1] * 3e-3},
        movable=["length", "diameter"],
        standard_error=dict(zip(("length", "diameter"), error, strict=True)).get,
        hypothesis=SimpleNamespace(free={"length": None, "diameter": None}),
        covariance=covariance,
    )
    tube = cast(Any, SimpleNamespace(parameters=("length", "diameter"), sizes=sizes))
    declared = cast(Any, {"length": 1.0, "diameter": 0.009})
    distance, count = backward_elimination._distance_from_nothing(tube, cast(Any, final), declared)
    assert distance == pytest.approx(expected)
    assert count == 2


def test_who_leaves_least_is_carried_on_and_what_is_alike_to_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A rough fit of a late position stopped at 4 ms of 17, and its rival alone was carried on."""
    at_their_ends = {"a": 4.0, "b": 3.0, "c": 9.0, "d": 1.0, "e": 0.5}
    carried_on: list[str] = []

    def to_its_end(fitted: Any, data: Any) -> Any:
        carried_on.append(fitted[0])
        return fitted[0], at_their_ends[fitted[0]]

    monkeypatch.setattr(candidates, "converged", to_its_end)
    monkeypatch.setattr(candidates, "without_sensitivities", lambda fitted: fitted)
    rough = {"a": 5.0, "b": 8.0, "c": 9.5, "d": 3.5, "e": 20.0}
    settled = candidates.leaders_settled(
        cast(Any, {name: (name, left) for name, left in rough.items()}),
        lambda fitted: float(cast(Any, fitted)[1]),
        lambda one, other: {one, other} == {"d", "b"},
        cast(Any, None),
    )
    # d leads, and brings b, alike to it, along; nobody else is better than d then, whatever e might become.
    assert carried_on == ["b", "d"]
    assert {k: cast(Any, v)[1] for k, v in settled.items()} == rough | {"b": 3.0, "d": 1.0}


def test_a_leader_that_another_overtakes_hands_over(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = {"a": 4.0, "b": 3.0}
    monkeypatch.setattr(candidates, "converged", lambda fitted, data: (fitted[0], ends[fitted[0]]))
    monkeypatch.setattr(candidates, "without_sensitivities", lambda fitted: fitted)
    settled = candidates.leaders_settled(
        cast(Any, {"a": ("a", 4.0), "b": ("b", 4.5), "c": ("c", 7.0)}),
        lambda fitted: float(cast(Any, fitted)[1]),
        lambda one, other: False,
        cast(Any, None),
    )
    assert cast(Any, settled)["b"] == ("b", 4.5)
    ends["a"] = 6.0  # carried on, it leaves more in the measure that leaders are chosen by
    settled = candidates.leaders_settled(
        cast(Any, {"a": ("a", 4.0), "b": ("b", 4.5), "c": ("c", 7.0)}),
        lambda fitted: float(cast(Any, fitted)[1]),
        lambda one, other: False,
        cast(Any, None),
    )
    assert cast(Any, settled) == {"a": ("a", 6.0), "b": ("b", 3.0), "c": ("c", 7.0)}


def test_what_a_cause_took_beside_another_that_is_gone_it_has_to_take_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A time offset was named that took 1 % of the error: it stood beside a tube, which had ended beyond its range."""
    left_by = {"": 10.0, "clock": 9.8, "tube": 1.0}

    def with_these(found: Any, baseline: Any, final: Any, data: Any) -> Any:
        return "".join(m[0].effect for m in found)

    monkeypatch.setattr(backward_elimination, "with_these", with_these)
    monkeypatch.setattr(
        Left,
        "by",
        lambda fitted, data: Left(
            np.full((4, 1), 1.0 + left_by[fitted]), np.full((4, 1), 1.0 + left_by[fitted])
        ),
    )
    monkeypatch.setattr(backward_elimination, "channel_of_its_own", lambda effect, data: None)
    monkeypatch.setattr(backward_elimination, "settled", lambda fitted, left, data: False)
    monkeypatch.setattr(backward_elimination, "with_systematic_error", lambda fitted, runs: fitted)
    sure: set[str] = set()
    monkeypatch.setattr(backward_elimination, "beyond_doubt", lambda e, *rest: e in sure)

    def eliminated(name: str, healthy: str | None) -> tuple[list[list[Trial]], str]:
        trial = Trial(cast(Any, name), cast(Any, None), 0.0, np.zeros(1))
        data = cast(Any, SimpleNamespace(healthy=healthy, identify=None))
        found, current = backward_elimination.backward_elimination(
            [[trial]], cast(Any, ""), cast(Any, name), data
        )
        return found, cast(str, current)

    # Beside records of the healthy machine a size that is beyond doubt is missed, although little more is left.
    assert eliminated("clock", "well") == ([], "")
    sure.add("clock")
    assert eliminated("clock", "well")[1] == "clock"
    assert eliminated("clock", None)[1] == ""
    for name, stands in (("clock", False), ("tube", True)):
        trial = Trial(cast(Any, name), cast(Any, None), 0.0, np.zeros(1))
        trial.accepted = True
        found, current = backward_elimination.backward_elimination(
            [[trial]], cast(Any, ""), cast(Any, name), cast(Any, SimpleNamespace(healthy=None))
        )
        assert (found == [[trial]]) == stands
        assert cast(Any, current) == (name if stands else "")
        assert trial.accepted == stands
        assert bool(trial.reason) != stands
