"""Instructions by function: what the names of functions become, and what the command refuses."""

from __future__ import annotations

import pytest

from validation.speed.callgrind import by_function
from validation.speed.profile import main

LISTED = """
1,200 (60.0%)  ???:sms_status sms::derivative<double>(sms::Platform<double> const&, double) [/build/sms_bench]
  500 (25.0%)  ???:__ieee754_pow_fma [/lib/libm.so.6]
  300 (15.0%)  ???:sms::(anonymous namespace)::derivative<float>(int) [/build/sms_bench]
"""


def test_instructions_are_added_up_by_short_names() -> None:
    assert by_function(LISTED) == {"derivative": 1500, "__ieee754_pow_fma": 500}


@pytest.mark.parametrize(("said", "answer"), [
    ("now", "is no NAME=PROGRAM"),
    ("now=/nowhere/sms_bench", "./dev bench builds it"),
])  # fmt: skip
def test_a_build_that_cannot_be_counted_is_refused(
    said: str, answer: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["profile", said])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert answer in capsys.readouterr().err
