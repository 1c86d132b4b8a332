"""End stops: how far they give way is not known, and a fit finds it where a piston reaches them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from plant_support import fitted_baseline, write_bench
from sms import _core
from sms.diagnosis import diagnose
from sms.parameters import PARAMETERS

pytestmark = pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")

STROKE = 0.27
"""m: the motions of plant_support go up to 0.28 m."""
SOFT = 6e5
"""N/m, an eighth of what is assumed of a stop."""


def write_bench_with_short_stroke(folder: Path, stiffness: float) -> Path:
    """A machine that is as declared but for its end stops, which one of its records reaches."""
    path = write_bench(folder, 31, {"stroke": STROKE, "end_stop_stiffness": stiffness})
    declared = f'[parameters]\nstroke = "{STROKE} m"\n'
    path.write_text(path.read_text().replace("[parameters]\n", declared, 1))
    return path


def test_the_stiffness_of_a_stop_is_fitted_where_a_piston_reaches_it(tmp_path: Path) -> None:
    found, _ = fitted_baseline(write_bench_with_short_stroke(tmp_path, SOFT))
    assert found.params["end_stop_stiffness"] == pytest.approx(SOFT, rel=0.2)
    assert np.mean(found.fit.residual**2) < 1.1


def test_of_a_motion_within_the_stroke_it_is_left_as_declared(tmp_path: Path) -> None:
    found, _ = fitted_baseline(write_bench(tmp_path, 31, {}))
    assert "end_stop_stiffness" not in found.hypothesis.free
    assert found.params["end_stop_stiffness"] == PARAMETERS["end_stop_stiffness"].default


def test_a_soft_stop_is_no_model_error(tmp_path: Path) -> None:
    answer = diagnose(write_bench_with_short_stroke(tmp_path, SOFT))
    assert answer.verdict == "no-evidence", answer.sentence
