"""The fuzzer of the compiled module: what it finds in the module, what it calls a failure, and a few hundred calls."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sms import _core
from typer.testing import CliRunner

from validation.fuzz import bindings
from validation.fuzz.__main__ import app
from validation.fuzz.bindings import Outcome, run
from validation.fuzz.calls import RETURNED, NotMadeError, judge
from validation.fuzz.signatures import Function, functions_of

ROOT = Path(__file__).parents[3]
SEED = 20


@pytest.fixture(scope="module")
def outcomes() -> list[Outcome]:
    return list(run(_core, SEED, range(3 * len(functions_of(_core)))))


def test_each_function_is_called_and_none_fails(outcomes: list[Outcome]) -> None:
    assert {one.function for one in outcomes} == {f.label for f in functions_of(_core)}
    assert [one for one in outcomes if one.failed] == []


def test_calls_are_mostly_right_and_often_spoilt(outcomes: list[Outcome]) -> None:
    counts = Counter(one.verdict for one in outcomes)
    assert counts[RETURNED] > 0.5 * len(outcomes)
    assert counts["not made"] < 0.1 * len(outcomes)
    assert counts["TypeError"] > 20 and counts["ValueError"] > 20


def test_a_call_can_be_repeated(outcomes: list[Outcome]) -> None:
    some = range(100, 160)
    again = list(run(_core, SEED, some))
    assert [(one.number, one.verdict) for one in again] == [
        (one.number, one.verdict) for one in outcomes if one.number in some
    ]


def test_everything_in_the_module_is_found() -> None:
    found = functions_of(_core)
    labels = {f.label for f in found}
    for name, thing in vars(_core).items():
        if isinstance(thing, type):
            assert any(f.owner == name for f in found) != issubclass(thing, Exception), name
        elif callable(thing):
            assert name in labels
    advance = next(f for f in found if f.label == "BenchSimulation.advance")
    assert [a.name for a in advance.arguments] == ["setpoint", "noise", "load"]


@pytest.mark.parametrize(("wrong", "verdict"), [
    (ValueError("an array of shape (n, 3) is needed"), ("ValueError", False)),
    (MemoryError(), ("MemoryError", False)),
    (NotMadeError("ValueError: no"), ("not made", False)),
    (IndexError("map::at"), ("IndexError", True)),
    (KeyError("extension"), ("KeyError", True)),
    (SystemError("a result with an exception set"), ("SystemError", True)),
])  # fmt: skip
def test_how_an_exception_is_judged(wrong: BaseException, verdict: tuple[str, bool]) -> None:
    assert judge(wrong) == verdict


def ends(how: Callable[[], Any], monkeypatch: pytest.MonkeyPatch) -> Iterator[Outcome]:
    """The outcomes of a module whose one function does that."""
    monkeypatch.setattr(bindings, "functions_of", lambda _: [Function(None, "f", "call")])
    monkeypatch.setattr(bindings, "PATIENCE", 1)
    core: Any = SimpleNamespace(f=how, build_info="", Params=_core.Params)
    return run(core, SEED, range(2))


def test_a_call_that_ends_the_process_or_does_not_end_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def forever() -> None:
        while True:
            np.zeros(3).sum()

    crashed = list(ends(os.abort, monkeypatch))
    assert [(one.number, one.verdict) for one in crashed] == [
        (0, "crash (SIGABRT)"),
        (1, "crash (SIGABRT)"),
    ]
    assert all(one.failed for one in crashed)
    assert next(ends(forever, monkeypatch)).verdict == "hang"


def test_the_command_prints_a_table() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "validation.fuzz", "bindings", "--seed", "3", "--count", "500", "--only", "pid"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert "seed 3: " in done.stdout and "calls: " in done.stdout


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--only", "nosuchfunction"], "no function of the module holds 'nosuchfunction'"),
        (["--module", "no_module.so"], "sanitize-module"),
    ],
)
def test_what_is_not_there_is_named(given: list[str], said: str) -> None:
    answer = CliRunner().invoke(app, ["bindings", *given], env={"COLUMNS": "300"})
    assert answer.exit_code == 2
    assert said in " ".join(answer.output.replace("│", " ").split())
