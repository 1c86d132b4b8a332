"""The command `sms trials` finds the checkout that it is called in; what it does there is tested beside the trials."""

from __future__ import annotations

from pathlib import Path

import pytest
from sms.cli import app
from sms.cli.trials import _checkout
from sms.io import InputError
from typer.testing import CliRunner

ROOT = Path(__file__).resolve().parents[2]


def test_the_checkout_is_found_from_any_folder_in_it() -> None:
    assert _checkout(ROOT) == ROOT
    assert _checkout(ROOT / "docs") == ROOT


def test_outside_of_a_checkout_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="is not in a checkout of the project"):
        CliRunner().invoke(app, ["trials", "--count", "1"], catch_exceptions=False)


def test_a_rig_that_nobody_simulates_is_named_with_those_that_are() -> None:
    with pytest.raises(InputError, match="no virtual 'boat'; choose bench, platform, tank"):
        CliRunner().invoke(app, ["trials", "--rig", "boat"], catch_exceptions=False)
