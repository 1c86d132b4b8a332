"""The fuzzer itself: cases that can be repeated, what it calls a failure; and, of a full test, a thousand cases."""

from __future__ import annotations

import gzip
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from validation.fuzz.cases import base_of, make, spoil
from validation.fuzz.inputs import BASES
from validation.fuzz.run import TRACEBACK, _child, judge

ROOT = Path(__file__).parents[3]


def fuzz(*options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "validation.fuzz", *options],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.full
def test_a_thousand_spoilt_inputs_are_answered_or_refused() -> None:
    result = fuzz("--seed", "1", "--count", "1000")
    assert result.returncode == 0, result.stdout + result.stderr


def test_some_spoilt_inputs_are_answered_or_refused() -> None:
    result = fuzz("--seed", "1", "--count", "240", "--only", "scenario")
    assert result.returncode == 0, result.stdout + result.stderr
    assert " 0 answered" not in result.stdout and " 0 refused" not in result.stdout


def test_a_case_can_be_repeated(tmp_path: Path) -> None:
    for base in BASES:
        (tmp_path / base.folder).mkdir(exist_ok=True)
        for name in ("rig.toml", "record.csv", "run.asc", "bus.dbc", "rps.toml", "poses.toml"):
            (tmp_path / base.folder / name).write_text('x = "1 m"\ny,z\n1,2\n' * 9)
    differ = 0
    for number in range(60):
        cases = [make(7, number, tmp_path, tmp_path / f"{number}{twin}") for twin in "ab"]
        assert cases[0] == cases[1]
        one, other = (
            {f.name: f.read_bytes() for f in (tmp_path / f"{number}{twin}").iterdir()}
            for twin in "ab"
        )
        assert one == other
        old = {f.name: f.read_bytes() for f in (tmp_path / cases[0].base.folder).iterdir()}
        differ += old != one or cases[0].command != cases[0].base.command
    assert differ > 30
    drawn = {base_of(7, number)[0] for number in range(2000)}
    assert drawn == set(BASES)


@pytest.mark.parametrize(("code", "said", "verdict"), [
    (0, "", "answered"),
    (0, "/x.py:3: RuntimeWarning: divide by zero\n", "more than a sentence"),
    (2, "sms: rig.toml: empty\n", "refused"),
    (2, "sms: rig.toml: 'a\nb' is not known\n", "more than a sentence"),
    (2, "Usage: sms\n╭─ Error ─╮\n", "refused"),
    (2, "", "more than a sentence"),
    (1, "sms: no rig answers\n", "ended as documented"),
    (1, "", "exit code 1"),
    (TRACEBACK, "", "traceback"),
    (-signal.SIGSEGV, "", "crash (SIGSEGV)"),
    (-signal.SIGALRM, "", "hang"),
])  # fmt: skip
def test_how_an_end_is_judged(tmp_path: Path, code: int, said: str, verdict: str) -> None:
    assert judge(code, said, tmp_path) == verdict


def test_the_help_of_several_commands_is_documented(tmp_path: Path) -> None:
    assert judge(2, "", tmp_path, "\n Usage: sms can [OPTIONS] COMMAND\n") == "ended as documented"
    assert judge(2, "", tmp_path, "extension 1: 3 mm\n") == "more than a sentence"


def test_what_is_left_of_a_refusal_and_an_answer_that_is_no_json(tmp_path: Path) -> None:
    (tmp_path / "x.json").write_text('{"a": NaN}')
    assert judge(2, "sms: no\n", tmp_path) == "left files"
    assert judge(0, "", tmp_path) == "no JSON"
    (tmp_path / "run.partial.csv").write_text("")
    assert judge(2, "sms: no\n", tmp_path) == "refused"


def test_a_child_that_crashes_or_hangs_ends_alone(tmp_path: Path) -> None:
    said = tmp_path / "said"
    assert _child(os.abort, said) == -signal.SIGABRT
    assert _child(lambda: time.sleep(60.0), said, patience=0.2) == -signal.SIGALRM
    assert _child(lambda: time.sleep(60.0), said, stopped=0.2) == TRACEBACK
    assert _child(lambda: np.zeros(2**33).sum(), said) == TRACEBACK  # 64 GiB
    assert "MemoryError" in (tmp_path / "said.err").read_text()


def test_a_packed_file_can_be_spoilt_twice(tmp_path: Path) -> None:
    """Seen: seed 1498533301 cut a packed file short, drew it again, and could not unpack it."""
    cut = tmp_path / "record.csv.gz"
    cut.write_bytes(gzip.compress(b"time,extension\n0,0.1\n")[:-12])
    assert spoil(cut, tmp_path, np.random.default_rng(1))[1].exists()
