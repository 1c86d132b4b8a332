"""A cause's size: over all records, and in each of them alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sms import _core
from sms.diagnosis.adequacy.parameter_constancy import inconstancy
from sms.diagnosis.adequacy.subset_estimates import (
    found_value,
    record_by_record,
    variance_between,
)
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.fitting import fit, nuisance_of
from sms.diagnosis.hypothesis import Data, Fitted, baseline_hypothesis
from sms.diagnosis.pipeline import read_and_check
from sms.diagnosis.preparation import make_data
from sms.estimation.nuisance import project
from sms.io.rig import load_rig

from validation.random_cases import SEED
from validation.twins.draw import draw

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
LEAK = "fitting_leakage of lower"


def with_a_leak(folder: Path, kind: str, hidden: str, seed: int) -> tuple[Data, Fitted]:
    """The core with a leak to the outside, fitted to records in which `hidden` is hidden."""
    draw(kind, seed, folder / "rig", folder / "truth.json", hidden, 3.0)
    rig = load_rig(folder / "rig" / "rig.toml")
    read, _ = read_and_check(rig)
    data, effects = make_data(rig, read), effects_of(rig)
    leak = next(e for e in effects if e.key == LEAK)
    baseline = fit(baseline_hypothesis(data, effects), data.identify)
    return data, fit(baseline.hypothesis.with_effect(leak), data.identify, baseline.params)


def test_a_leak_has_one_size_everywhere_and_in_every_record(tmp_path: Path) -> None:
    print(f"seed {SEED}")
    data, fitted = with_a_leak(tmp_path, "tank", "fitting_leakage", SEED % 10_000)
    leak = fitted.hypothesis.causes[0]
    assert inconstancy(fitted, leak, data) is None
    found = found_value(fitted, leak, data)
    each = record_by_record(fitted, leak, data)
    assert set(each) == {r.name for part in (data.identify, data.validate) for r in part.motions}
    for value, error in each.values():
        assert value == pytest.approx(found.value, rel=0.25)
        assert 0.0 < error < 0.1 * found.value


def test_of_one_record_alone_it_is_the_linear_estimate_beside_all_that_is_free(
    tmp_path: Path,
) -> None:
    data, fitted = with_a_leak(tmp_path, "tank", "fitting_leakage", 3)
    runs = data.identify
    leak = fitted.hypothesis.causes[0]
    name = leak.parameters[0]
    others = nuisance_of(fitted).without(name)
    column = fitted.fit.jacobian[:, list(fitted.hypothesis.free).index(name)]
    each = record_by_record(fitted, leak, data)
    for number, run in enumerate(runs.motions):
        rows = runs.record == number
        alone = type(others)(others.names, others.jacobian[rows], others.pull, others.off)
        reduced = project(alone, column[rows][:, None], [name])[:, 0]
        full = np.concatenate([fitted.fit.residual[rows], alone.departure])
        value = fitted.params[name] - float(reduced @ full) / float(reduced @ reduced)
        assert each[run.name][0] == pytest.approx(value, rel=1e-6)


def test_the_variance_between_records_is_what_they_differ_by_beyond_their_errors() -> None:
    random = np.random.default_rng(SEED)
    print(f"seed {SEED}")
    errors = random.uniform(0.5, 2.0, (4000, 4))

    def mean_of(between: float) -> float:
        values = 7.0 + random.normal(0.0, np.hypot(errors, between))
        pairs = (list(zip(v, e, strict=True)) for v, e in zip(values, errors, strict=True))
        return float(np.mean([variance_between(p) for p in pairs]))

    assert mean_of(3.0) == pytest.approx(9.0, rel=0.15)
    assert mean_of(0.0) < 0.5
    alike = [(1.0, 0.3), (1.1, 0.3), (0.9, 0.2)]
    assert variance_between(alike) == 0.0
    assert variance_between([(1.0, 0.3)]) == variance_between([]) == 0.0
