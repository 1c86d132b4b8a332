"""The core against reference values that were computed elsewhere, in extended precision.

They are not part of the repository: SMS_SHARED names their folder, by default `shared` beside the
checkout.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from validation.reference import check_components

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("SMS_SHARED", ROOT.parent / "shared"))
COMPONENTS = SHARED / "reference" / "components"

with_reference = pytest.mark.skipif(
    not COMPONENTS.is_dir(),
    reason=f"there are no reference values in {COMPONENTS}; set SMS_SHARED to where they are",
)


@with_reference
@pytest.mark.parametrize("name", check_components.IMPLEMENTED)
def test_every_implemented_component_agrees_with_its_reference(name: str) -> None:
    comparison = check_components.compare(name, check_components.read(COMPONENTS)[name])
    assert comparison.cases > 0
    assert comparison.right, comparison


@with_reference
def test_friction_agrees_to_1e_11() -> None:
    reference = check_components.read(COMPONENTS)["friction"]
    assert reference["rtol"] <= 1e-11
    assert check_components.compare("friction", reference).right


def test_a_wrong_value_and_a_nan_are_seen(tmp_path: Path) -> None:
    parameters = {
        **{"F_S": 77.27, "F_C1": 38.0, "F_C2": 38.0, "sigma1": 530.0, "sigma2": 530.0},
        **{"v_S": 0.05, "delta": 1.4, "zeta": 0.9, "gamma_f": 13.0, "eps_f": 0.005, "F_UE": 0.0},
    }
    for force, right in ((91.0, True), (91.0 + 1e-8, False), (float("nan"), False)):
        case = {"in": {"v": 0.1, "a": 0.0}, "out": {"F_N": force}}
        reference = {"rtol": 1e-11, "parameters": parameters, "cases": [case]}
        (tmp_path / "friction.json").write_text(json.dumps(reference))
        read = check_components.read(tmp_path)["friction"]
        assert check_components.compare("friction", read).right is right


def test_an_unknown_subject_is_not_called_right_or_wrong(tmp_path: Path) -> None:
    (tmp_path / "perpetuum.json").write_text('{"rtol": 1.0, "cases": []}')
    references = check_components.read(tmp_path)
    comparison = check_components.compare("perpetuum", references["perpetuum"])
    assert not comparison.implemented


@pytest.mark.parametrize("text", ["[1, 2]", "{}", '{"cases": '])
def test_a_file_that_is_no_reference_is_named(tmp_path: Path, text: str) -> None:
    (tmp_path / "friction.json").write_text(text)
    with pytest.raises(ValueError, match=r"friction\.json"):
        check_components.read(tmp_path)


def test_an_empty_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="holds no reference file"):
        check_components.read(tmp_path)
