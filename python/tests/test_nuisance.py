"""What known parameters can undo of an effect, against a projection that is worked out anew for every effect."""

from __future__ import annotations

import numpy as np
import pytest
from sms.estimation.nuisance import Joint, Nuisance, project, pulls

from validation.random_cases import draw


@pytest.mark.parametrize("declared", ["nothing", "each", "together"])
def test_an_effect_that_is_a_known_parameter_is_judged_beside_all_others(declared: str) -> None:
    random = draw(f"nuisance, {declared}")
    rows, k = 60, 7
    jacobian = random.normal(size=(rows, k)) * 10.0 ** random.uniform(-6.0, 6.0, k)
    jacobian[:, 1] = jacobian[:, 0] * 1e3 + 1e-3 * jacobian[:, 1]
    names = [f"p{i}" for i in range(k)]
    size = 10.0 ** random.uniform(-3.0, 3.0, 5) / np.linalg.norm(jacobian[:, :5], axis=0)
    known = dict(zip(names[:5], size, strict=True)) if declared != "nothing" else {}
    mixed = np.diag(size) @ random.normal(size=(5, 5))
    joint = Joint(tuple(names[:5]), mixed @ mixed.T) if declared == "together" else None
    pull = pulls(names, known, joint)
    nuisance = Nuisance(names, jacobian, pull, np.zeros(k))
    columns = np.column_stack([jacobian, random.normal(size=(rows, 2))])
    found = project(nuisance, columns, [*names, "a", "b"])
    for i, name in enumerate([*names, "a", "b"]):
        others = nuisance.without(name) if name in names else nuisance
        q = others.basis()
        full = others.with_declared(columns[:, i])
        wanted = full - q @ (q.T @ full)
        scale = np.linalg.norm(columns[:, i])
        np.testing.assert_allclose(found[:, i] / scale, wanted / scale, atol=1e-8)
