"""How many threads the core takes: from the option, from the environment, and what neither can be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import sms.diagnosis
from sms.cli.command import app
from sms.diagnosis import pipeline
from sms.errors import InputError
from sms.rigs.threads import VARIABLE, threads
from typer.testing import CliRunner


def test_the_environment_says_how_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    assert threads() == 2
    monkeypatch.setenv(VARIABLE, " 7 ")
    assert threads() == 7
    for wrong in ("many", "0", "-1", "2.5"):
        monkeypatch.setenv(VARIABLE, wrong)
        with pytest.raises(InputError, match=r"SMS_THREADS is .* 1 or more"):
            threads()


@pytest.mark.parametrize(("options", "seen"), [((), 5), (("--threads", "3"), 3)])
def test_the_option_goes_before_the_environment(
    options: tuple[str, ...], seen: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(VARIABLE, "5")
    asked: list[int] = []

    def instead(*_: Any) -> None:
        asked.append(threads())
        raise InputError("that is all")

    monkeypatch.setattr(sms.diagnosis, "diagnose", instead)
    out = str(tmp_path / "o")
    told = CliRunner().invoke(app, ["diagnose", "rig.toml", "--out", out, *options])
    assert str(told.exception) == "that is all"
    assert asked == [seen]


def test_no_threads_are_refused() -> None:
    assert CliRunner().invoke(app, ["diagnose", "rig.toml", "--threads", "0"]).exit_code == 2


def test_what_is_wrong_with_the_environment_is_no_fault_of_a_record(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(VARIABLE, "two")
    with pytest.raises(InputError, match=f"^{VARIABLE} is 'two'"):
        pipeline.diagnose("no rig file is looked for")
