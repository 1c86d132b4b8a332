"""Judgements on coloured residuals: false alarms stay rare where counting samples fails; sizes come out right."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom
from sms.diagnosis.adequacy.repeatability import repeatability
from sms.estimation.block_statistics import (
    covariance_from,
    covariance_of,
    leveraged_covariance,
    merge_windows,
    project_off,
    resampled,
    score_test,
    weighted_ms,
    windows_per_block,
)

from validation.random_cases import draw


@pytest.fixture
def rng() -> np.random.Generator:
    return draw("statistics")


def coloured(rng: np.random.Generator, n: int, correlation: float) -> np.ndarray:
    noise = rng.normal(size=n) * np.sqrt(1.0 - correlation**2)
    out = np.empty(n)
    out[0] = rng.normal()
    for i in range(1, n):
        out[i] = correlation * out[i - 1] + noise[i]
    return out


def test_a_covariance_does_not_depend_on_the_units_of_the_parameters(
    rng: np.random.Generator,
) -> None:
    """A leak in m^3/(s Pa) beside a mass in kg: columns that differ by 1e12 tell of both."""
    jacobian = rng.normal(size=(200, 4))
    units = np.array([1e12, 1.0, 1e-6, 1e4])
    plain, scaled = (covariance_from(j.T @ j) for j in (jacobian, jacobian * units))
    np.testing.assert_allclose(scaled * np.outer(units, units), plain, rtol=1e-9)
    unseen = np.zeros((3, 3))
    unseen[:2, :2] = np.diag([1e24, 1.0])
    assert np.diag(covariance_from(unseen)) == pytest.approx([1e-24, 1.0, 0.0])


def test_healthy_but_coloured_data_names_nothing(rng: np.random.Generator) -> None:
    """The regression test of the whole idea: 28 candidates, correlation time 0.5 s at 100 Hz.

    Of a dozen blocks the level of 5 percent is 6.2: 111 alarms in 1800 draws. The bound is exceeded by chance once in
    100 000 runs.
    """
    strokes, samples, candidates, repeats = 40, 150, 28, 60
    stroke = np.repeat(np.arange(strokes), samples)
    n = len(stroke)
    alarms = naive_alarms = 0
    for _ in range(repeats):
        residual = coloured(rng, n, np.exp(-0.01 / 0.5))
        columns = np.column_stack([coloured(rng, n, 0.99) for _ in range(candidates)])
        columns = project_off(columns, np.ones((n, 1)))
        residual = project_off(residual[:, None], np.ones((n, 1)))[:, 0]
        record = np.zeros(n, dtype=np.int64)
        block = merge_windows(record, stroke, windows_per_block(residual, record, stroke))
        alarms += bool(np.min(score_test(columns, residual, block, rng, draws=999).p_value) < 0.05)
        naive = np.abs(columns.T @ residual) / np.linalg.norm(columns, axis=0) / residual.std()
        naive_alarms += bool(
            np.max(naive) > 3.1
        )  # Bonferroni at 5 percent, samples taken as independent
    assert naive_alarms >= 0.95 * repeats, (
        "the data would not fool a naive test: nothing is shown here"
    )
    most = int(binom.isf(1e-5, repeats, 0.062))
    assert alarms <= most, f"{alarms} alarms in {repeats}, 4 are expected"


def test_an_effect_at_ten_standard_errors_is_found(rng: np.random.Generator) -> None:
    strokes, samples = 40, 150
    stroke = np.repeat(np.arange(strokes), samples)
    column = np.sign(np.sin(stroke * np.pi + 0.5))[:, None]
    noise = coloured(rng, len(stroke), 0.98)
    error = np.sqrt(covariance_of(column, noise, stroke)[0, 0])
    scores = score_test(column, noise + 10.0 * error * column[:, 0], stroke, rng)
    assert scores.p_value[0] < 1e-3


def test_robust_errors_cover_the_scatter_of_estimates(rng: np.random.Generator) -> None:
    strokes, samples = 30, 100
    stroke = np.repeat(np.arange(strokes), samples)
    column = np.column_stack([np.sign(np.sin(stroke * np.pi + 0.5)), np.ones(len(stroke))])
    estimates, errors = [], []
    for _ in range(200):
        y = np.concatenate([coloured(rng, samples, 0.97) for _ in range(strokes)])
        beta = np.linalg.lstsq(column, y, rcond=None)[0]
        estimates.append(beta[0])
        errors.append(np.sqrt(covariance_of(column, y - column @ beta, stroke)[0, 0]))
    assert 0.8 < np.mean(errors) / np.std(estimates) < 1.25


def test_what_is_declared_of_a_twin_counts_in_a_standard_error(rng: np.random.Generator) -> None:
    """A gain and a bore scale one column: what is declared of the bore is all that tells how large the gain is."""
    strokes, samples, width = 30, 100, 0.04
    stroke = np.repeat(np.arange(strokes), samples)
    push = np.sign(np.sin(stroke * np.pi + 0.5)) + 2.0
    column = np.column_stack([push, push, np.ones(len(stroke))])
    known = np.diag([0.0, width**-2, 0.0])
    departures, errors = [], []
    for _ in range(200):
        truth = np.array([0.3, width * rng.normal(), 0.1])
        noise = np.concatenate([coloured(rng, samples, 0.97) for _ in range(strokes)])
        y = column @ truth + 0.1 * noise
        weight = float(np.mean(y**2))
        beta = np.linalg.solve(column.T @ column + weight * known, column.T @ y)
        covariance = covariance_of(column, y - column @ beta, stroke, known, weight)
        departures.append(beta[0] - truth[0])
        errors.append(np.sqrt(covariance[0, 0]))
    assert 0.8 < np.mean(errors) / np.std(departures) < 1.25


def test_a_block_is_as_large_as_if_it_had_no_part_in_the_fit(rng: np.random.Generator) -> None:
    """CR2 as it is defined, with the matrices that the sum over parameters avoids."""
    jacobian, residual = rng.normal(size=(60, 7)), rng.normal(size=60)
    block, known, weight = np.repeat(np.arange(6), 10), 2.0 * np.eye(7), 1.7
    scale = 10.0 ** rng.uniform(-6.0, 6.0, 7)
    bread = np.linalg.inv(jacobian.T @ jacobian + weight * known)
    scatter = weight**2 * known
    for number in range(6):
        own = jacobian[block == number]
        value, vector = np.linalg.eigh(np.eye(10) - own @ bread @ own.T)
        score = own.T @ ((vector / np.sqrt(value)) @ vector.T @ residual[block == number])
        scatter = scatter + np.outer(score, score)
    units = np.outer(scale, scale)
    found = leveraged_covariance(jacobian * scale, residual, block, known * units, weight)
    np.testing.assert_allclose(found * units, bread @ scatter @ bread, rtol=1e-9, atol=1e-15)


def test_errors_hold_with_more_parameters_than_blocks(rng: np.random.Generator) -> None:
    """Thirty numbers known roughly before, twenty blocks, each with a level of all its columns. The fit has made the
    residuals small that say how sure it is; most of that is made up for."""
    blocks, samples, count, width = 20, 60, 30, 1.0
    block = np.repeat(np.arange(blocks), samples)
    known = np.diag(np.full(count, width**-2))
    leveraged, plain = [], []
    for _ in range(60):
        columns = np.repeat(rng.normal(size=(blocks, count)), samples, axis=0)
        columns += 0.3 * rng.normal(size=columns.shape)
        truth = width * rng.normal(size=count)
        noise = [coloured(rng, samples, 0.97) for _ in range(blocks)]
        y = columns @ truth + np.concatenate(noise)
        beta = np.linalg.solve(columns.T @ columns + known, columns.T @ y)
        left = y - columns @ beta
        for of, z in ((leveraged_covariance, leveraged), (covariance_of, plain)):
            z.append((beta - truth) / np.sqrt(np.diag(of(columns, left, block, known, 1.0))))
    too_small, more_so = (np.sqrt(np.mean(np.square(z))) for z in (leveraged, plain))
    assert 1.0 < too_small < 2.5 < more_so


def test_projection_leaves_nothing_of_what_the_nuisance_spans(rng: np.random.Generator) -> None:
    nuisance = rng.normal(size=(200, 3)) * np.array([1e6, 1.0, 1e-6])
    inside = nuisance @ np.array([[1e-6], [2.0], [3e5]])
    assert np.linalg.norm(project_off(inside, nuisance)) < 1e-9 * np.linalg.norm(inside)
    outside = project_off(rng.normal(size=(200, 2)), nuisance)
    assert np.max(np.abs(nuisance.T @ outside) / np.linalg.norm(nuisance, axis=0)[:, None]) < 1e-9


def simulated_strokes(rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    samples, strokes, records = 200, 20, 2
    stroke = np.repeat(np.arange(strokes * records), samples)
    record = stroke // strokes
    direction = np.where(stroke % 2 == 0, 1.0, -1.0)
    extension = np.tile(np.linspace(0.0, 0.04, samples), strokes * records) + rng.normal(
        0, 1e-5, len(stroke)
    )
    return stroke, record, direction, extension


def test_what_repeats_is_told_from_what_does_not(rng: np.random.Generator) -> None:
    stroke, record, direction, extension = simulated_strokes(rng)
    noise = rng.normal(0.0, 0.3, len(stroke))
    between = rng.normal(0.0, 0.2, 40)[stroke]
    pattern = 0.5 * np.sin(extension / 0.04 * 2.0 * np.pi)
    split = repeatability(noise + between + pattern, record, stroke, extension, direction, rng)
    assert split.repeats == pytest.approx(0.125, rel=0.25)
    assert split.stroke == pytest.approx(0.13, rel=0.3)
    assert split.sample == pytest.approx(0.09, rel=0.1)
    assert split.repeats_p_value < 0.01
    healthy = repeatability(noise + between, record, stroke, extension, direction, rng)
    assert healthy.repeats < 0.02


def test_a_drift_is_told_from_scatter(rng: np.random.Generator) -> None:
    drifts = []
    for _ in range(9):
        stroke, record, direction, extension = simulated_strokes(rng)
        scatter = rng.normal(0.0, 0.2, 40)[stroke]
        order = (stroke % 20 - 9.5) / 9.5
        split = repeatability(scatter + 0.5 * order, record, stroke, extension, direction, rng)
        drifts.append(split.drift)
        assert split.drift_p_value < 0.01
        assert repeatability(scatter, record, stroke, extension, direction, rng).drift < 0.02
    assert np.median(drifts) == pytest.approx(np.mean((0.5 * order) ** 2), rel=0.4)


def test_blocks_hold_several_strokes_only_where_noise_lasts_long(rng: np.random.Generator) -> None:
    stroke, record, *_ = simulated_strokes(rng)
    assert windows_per_block(rng.normal(size=len(stroke)), record, stroke) == 1
    assert windows_per_block(coloured(rng, len(stroke), 0.99), record, stroke) > 1
    block = merge_windows(record, stroke, 3)
    assert len(np.unique(block)) == 14  # 20 strokes a record in threes, twice
    assert np.all(np.diff(block) >= 0)


def test_resampling_keeps_each_records_number_of_strokes(rng: np.random.Generator) -> None:
    stroke, record, *_ = simulated_strokes(rng)
    counts = resampled(record, stroke, rng, draws=50)
    assert np.all(counts[:, :20].sum(axis=1) == 20)
    assert np.all(counts[:, 20:].sum(axis=1) == 20)
    ones = np.ones((1, 40))
    squared = rng.normal(size=len(stroke)) ** 2
    assert weighted_ms(squared, stroke, ones)[0] == pytest.approx(squared.mean())
