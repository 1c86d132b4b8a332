"""Which copy of the core is loaded, as far as an installation with a single one shows it; the rest: packaging/wheel."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from sms import _core, _dispatch


def imported_with(choice: str) -> subprocess.CompletedProcess[str]:
    code = "from sms import _core; print(_core.uses_avx2())"
    environment = {**os.environ, "SMS_AVX2": choice}
    return subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("runs_avx2", [True, False])
def test_the_processor_decides_unless_told_otherwise(runs_avx2: bool) -> None:
    assert _dispatch.takes_second("AUTO", runs_avx2) == runs_avx2
    assert not _dispatch.takes_second("OFF", runs_avx2)


def test_avx2_is_refused_where_it_does_not_run() -> None:
    assert _dispatch.takes_second("ON", True)
    with pytest.raises(ImportError, match="which this processor does not run"):
        _dispatch.takes_second("ON", False)


def test_a_word_that_is_no_choice() -> None:
    done = imported_with("maybe")
    assert done.returncode != 0
    assert "SMS_AVX2 is one of AUTO, ON, OFF, not 'maybe'" in done.stderr


def test_the_command_says_a_wrong_choice_in_a_sentence(tmp_path: Path) -> None:
    command = tmp_path / "sms"
    command.write_text("import sms\n", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(command)],
        env={**os.environ, "SMS_AVX2": "maybe"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stderr == "sms: SMS_AVX2 is one of AUTO, ON, OFF, not 'maybe'\n"


@pytest.mark.skipif(_dispatch.second_copy() is not None, reason="an installation of two copies")
def test_a_single_core_is_what_it_was_compiled_to_be() -> None:
    same, other = ("ON", "OFF") if _core.uses_avx2() else ("OFF", "ON")
    done = imported_with(same)
    assert done.stdout.strip() == str(_core.uses_avx2()), done.stderr
    done = imported_with(other)
    assert done.returncode != 0
    assert f"SMS_AVX2={other}: this installation has a single core" in done.stderr


def test_the_help_of_the_command_waits_for_no_numbers() -> None:
    code = (
        "import sys; sys.argv = ['sms', '--help']\n"
        "from sms.cli import main\n"
        "try:\n    main()\nfinally:\n"
        "    print(sorted({'numpy', 'scipy', 'pandas', 'sms._core'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[-1] == "[]", done.stderr


def test_every_public_name_is_there() -> None:
    code = "import sms; print(len([getattr(sms, n) for n in sms.__all__]), len(set(dir(sms))))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    count, listed = map(int, done.stdout.split())
    assert count > 40, done.stderr
    assert listed >= count
