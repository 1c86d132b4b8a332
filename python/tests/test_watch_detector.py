"""The likelihood ratio over the onset: identities, and how often it is wrong, on drawn scores."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom, chi2
from sms.arrays import Array
from sms.diagnosis.effects.catalogue import catalogue
from sms.watch import healthy
from sms.watch.alarm import Judge, best_lag, guesses_of, sizes
from sms.watch.detector import DAY, FEWEST, LAGS, Detector, thresholds
from sms.watch.healthy import BLOCKS, Baseline, Sums, scatter
from sms.watch.segments import SEGMENT

from validation.random_cases import draw

EFFECTS = {e.key: e for e in catalogue("bench")}
NAMES = ("fitting_leakage of lower", "moving_mass", "coulomb_friction")
UNITS = np.array([1e-11, 0.05, 0.4])
"""Size that one segment tells to a standard error."""


def baseline(freedom: float = 1e9, segments: int = 10**9) -> Baseline:
    """Three effects and an energy, whose healthy sizes and scatter are known."""
    tests = [
        healthy.Test(n, EFFECTS[n], n != NAMES[0], True, "1", (-1e3 * u, 1e3 * u))
        for n, u in zip(NAMES, UNITS, strict=True)
    ]
    tests.append(healthy.Test("extension", None, False, True, of="signal"))
    inflation = np.array([4.0, 1.0, 9.0, 0.2])
    k = np.array([*(1.0 / UNITS**2 * np.array([4.0, 1.0, 9.0])), 1.0])
    return Baseline(
        innovations=None,  # type: ignore[arg-type]  # drawn sums need none
        tests=tests,
        kept=np.arange(3),
        imitated=np.zeros((3, 0)),
        mean=np.array([3e-12, 0.01, -0.1, 0.3]),
        mean_variance=1.0 / k / segments,
        inflation=inflation,
        freedom=np.full(4, freedom),
        segments=segments,
        begin=0.0,
        end=600.0,
    )


def drawn(b: Baseline, rng: np.random.Generator, number: int, size: Array | None = None) -> Sums:
    """One segment, with another information each time."""
    each = np.array([*(1.0 / UNITS**2 * np.array([4.0, 1.0, 9.0])), 1.0])
    k = each * np.array([*rng.uniform(0.2, 2.0, 3), 1.0])
    noise = np.sqrt(b.inflation * k) * rng.standard_normal(4)
    change = np.zeros(4) if size is None else size
    begin = SEGMENT * number
    return Sums(begin, begin + SEGMENT, (b.mean + change) * k + noise, k, k)


def test_the_score_of_a_known_shift_recovers_its_size() -> None:
    rng, b = draw("size of a shift"), baseline()
    size = np.array([30.0, -12.0, 8.0, 0.0]) * np.array([*UNITS, 1.0])
    segments = [drawn(b, rng, k, size) for k in range(40)]
    found, error, _ = sizes(b, segments)
    assert np.all(np.abs(found - size) < 5.0 * error)
    total = sum(s.response for s in segments)
    grown = error / np.sqrt(
        b.inflation / total
    )  # by a scatter that is a mean of squares, never below one
    squared = sum(s.response**2 for s in segments)
    freedom = np.min(total**2 / squared) - 1.0
    assert np.all(grown >= 1.0 - 1e-12)
    assert np.all(grown**2 <= chi2.isf(1e-7, freedom) / freedom)
    exact = [replace(s, shift=(b.mean + size) * s.response) for s in segments]
    assert sizes(b, exact)[0] == pytest.approx(size, abs=1e-9 * np.max(UNITS))


def test_the_error_of_the_healthy_size_counts() -> None:
    few, many = baseline(segments=10), baseline()
    k = np.array([*(1.0 / UNITS**2 * np.array([4.0, 1.0, 9.0])), 1.0])
    assert few.error(10.0 * k, 10.0 * k) == pytest.approx(
        np.sqrt(2.0) * many.error(10.0 * k, 10.0 * k)
    )


def test_single_looks_exceed_their_threshold_as_often_as_said() -> None:
    """One onset, so that looks are independent, and a threshold that is often exceeded."""
    rng, b = draw("rate of false alarms"), baseline()
    chance, count = 0.01, 1500
    detector = Detector(b, chance * DAY * len(LAGS) * len(b.tests), fewest=0)
    exceeded = 0
    for k in range(count):
        look = detector.push(drawn(b, rng, k))
        exceeded += int(np.sum(look.exceeds[0] >= 1.0))
    looks = count * len(b.tests)
    low, high = binom.interval(0.9999, looks, chance)
    assert low <= exceeded <= high


def test_healthy_segments_raise_no_more_alarms_than_stated() -> None:
    rng, b = draw("healthy stream"), baseline()
    rate, count = 100.0, 1500
    judge = Judge(Detector(b, rate))
    for k in range(count):
        judge.judge(judge.detector.push(drawn(b, rng, k)))
    assert judge.count <= binom.ppf(0.9999, 10**6, rate * count / DAY / 10**6)


def test_a_lower_rate_and_less_that_is_known_raise_the_threshold() -> None:
    sure, unsure = baseline(), baseline(freedom=10.0)
    assert np.all(thresholds(sure, 0.01) > thresholds(sure, 1.0))
    assert np.all(thresholds(unsure, 0.5) > thresholds(sure, 0.5))
    one_sided, two_sided = thresholds(sure, 0.5)[[0, 1]]
    assert one_sided < two_sided


@pytest.mark.parametrize("well", [13, 30, 55])
def test_a_change_is_alarmed_with_its_onset_and_named(well: int) -> None:
    """The onset is an estimate: it is off by no more than two segments in the median."""
    rng, b = draw("onset"), baseline()
    size = np.array([12.0, 0.0, 0.0, 0.0]) * np.array([*UNITS, 1.0])
    off = []
    for _ in range(5):
        judge = Judge(Detector(b, 0.5))
        for k in range(well):
            assert judge.judge(judge.detector.push(drawn(b, rng, k))) is None
        alarm = None
        for k in range(well, well + 20):
            alarm = judge.judge(judge.detector.push(drawn(b, rng, k, size))) or alarm
        assert alarm is not None
        off.append(abs(alarm.since - SEGMENT * well))
        assert alarm.guesses[0].effect == NAMES[0]
        assert abs(alarm.guesses[0].size - size[0]) < 5.0 * UNITS[0]
        assert alarm.guesses[0].low < alarm.guesses[0].size < alarm.guesses[0].high
    assert np.median(off) <= 2 * SEGMENT


def test_two_segments_that_happen_to_agree_are_no_evidence() -> None:
    """The chi-square of a stretch that short is as large as chance makes it, since its scatter is known with one
    degree of freedom: it must not outweigh an effect whose size is nearly the same in six."""
    b, detector = baseline(), Detector(baseline(), 0.5)
    rng = draw("two that agree")
    like_a_cause = 30.0 + np.array([4.0, -4.0, 3.0, -4.0, 4.0, -3.0])
    by_chance = np.array([5.0, 60.0, -40.0, 10.0, 25.0, 25.0 + rng.uniform(0.3, 0.6)])
    for k in range(6):
        response = np.array([*(100.0 / UNITS**2 * np.array([4.0, 1.0, 9.0])), 1.0])
        size = np.array([like_a_cause[k], by_chance[k], 0.0, 0.0]) * np.array([*UNITS, 1.0])
        shift = (b.mean + size) * response
        look = detector.push(Sums(SEGMENT * k, SEGMENT * (k + 1), shift, response, response))
    (chance, *_) = guesses_of(b, detector.last(2))
    (cause, *_) = guesses_of(b, detector.last(6))
    assert (chance.effect, cause.effect) == (NAMES[1], NAMES[0])
    assert chance.chi_square > cause.chi_square
    assert chance.likelihood_ratio < cause.likelihood_ratio
    assert best_lag(detector, look) == 6


def test_an_alarm_ends_after_a_repair_and_the_next_has_another_number() -> None:
    rng, b = draw("repair"), baseline()
    judge = Judge(Detector(b, 0.5))
    wrong = np.array([0.0, 15.0, 0.0, 0.0]) * np.array([*UNITS, 1.0])
    numbers = []
    for k in range(400):
        ill = 70 <= k < 90 or 250 <= k < 270
        alarm = judge.judge(judge.detector.push(drawn(b, rng, k, wrong if ill else None)))
        numbers.append(None if alarm is None else alarm.number)
        assert len(judge.detector.sums) <= LAGS[-1]
    assert set(numbers[:70]) == {None}
    assert numbers[89] == 1
    assert set(numbers[160:250]) == {None}
    assert numbers[269] == 2


@pytest.mark.parametrize("seed", [250, 1199033865])
def test_what_an_ended_alarm_has_seen_raises_no_other(seed: int) -> None:
    """Draws in which the longest stretch, which held the end of the fault, went over its threshold again."""
    rng, b = np.random.default_rng(seed), baseline()
    judge = Judge(Detector(b, 0.5))
    wrong = np.array([0.0, 15.0, 0.0, 0.0]) * np.array([*UNITS, 1.0])
    for k in range(160):
        judge.judge(judge.detector.push(drawn(b, rng, k, wrong if 70 <= k < 90 else None)))
    assert judge.count == 1


def test_one_wild_motion_is_no_alarm() -> None:
    """Less than four segments that are far off, whatever comes before and after."""
    rng, b = draw("wild segments"), baseline()
    quiet = replace(b, inflation=1e-12 * b.inflation)
    judge = Judge(Detector(b, 0.5))
    for k in range(80):
        size = np.full(4, 1e4) if 40 <= k < 40 + FEWEST - 1 else None
        assert judge.judge(judge.detector.push(drawn(quiet, rng, k, size))) is None


def test_a_sign_that_cannot_be_is_no_alarm_and_no_guess() -> None:
    """A leak does not fall below none, and an energy that falls is good."""
    rng, b = draw("wrong sign"), baseline()
    b = replace(b, tests=[replace(b.tests[0], room=(0.0, 1e-8)), *b.tests[1:]])
    judge = Judge(Detector(b, 0.5))
    size = np.array([-20.0 * UNITS[0], 0.0, 0.0, -3.0])
    segments = [drawn(b, rng, k, size) for k in range(40)]
    for s in segments:
        assert judge.judge(judge.detector.push(s)) is None
    assert guesses_of(b, segments) == ()


def test_an_effect_whose_size_differs_from_segment_to_segment_does_not_fit() -> None:
    rng, b = draw("misfit"), baseline()
    mixed = []
    for k in range(20):
        sizes_now = np.array([20.0, 20.0 * rng.choice([-0.8, 1.2]), 0.0, 0.0])
        mixed.append(drawn(b, rng, k, sizes_now * np.array([*UNITS, 1.0])))
    assert [g.effect for g in guesses_of(b, mixed)] == [NAMES[0]]


def test_scatter_is_that_of_blocks_where_segments_go_together() -> None:
    rng = draw("scatter")
    n = 8 * 40
    white = rng.standard_normal((n, 1))
    variance = np.ones((n, 1))
    degrees = n // max(BLOCKS) - 1
    least, most = chi2.ppf([1e-6, 1.0 - 1e-6], degrees) / degrees  # of so few blocks
    assert least < scatter(white, variance)[0] < most
    slow = np.repeat(rng.standard_normal((n // 8, 1)), 8, axis=0)
    inflation, freedom = scatter(slow, variance)
    assert 8.0 * least < inflation < 8.0 * most
    assert freedom == degrees
