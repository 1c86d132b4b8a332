"""What the terminal says of a watch: an alarm, its verdict and its end, each once."""

from __future__ import annotations

import io
from pathlib import Path

from rich.console import Console
from sms.watch.alarm import Alarm
from sms.watch.background import Verdict
from sms.watch.terminal import Terminal
from sms.watch.watch import Status

ALARM = Alarm(1, 25.0, 5.0, "spool_lag", "effect", 8.0, 7.5, (), (), 4)
VERDICT = Verdict(1, "cause", "Model error found: a leak.", Path("alarm_0001"))


def status(time: float, alarm: Alarm | None = None, verdict: Verdict | None = None) -> Status:
    return Status(
        "watching",
        "running",
        time,
        segments=6,
        learned=120.0,
        wanted=120.0,
        waiting=0,
        lost=0,
        late=False,
        alarm=alarm,
        verdict=verdict,
    )


def test_an_alarm_its_verdict_and_its_end_are_said_once() -> None:
    written = io.StringIO()
    with Terminal(Console(file=written, width=120), live=False) as terminal:
        for moment in (
            status(20.0),
            status(25.0, ALARM),
            status(30.0, ALARM),
            status(90.0, ALARM, VERDICT),
            status(402.4, None, VERDICT),
            status(407.4, None, VERDICT),
        ):
            terminal.show(moment)
    assert written.getvalue().splitlines() == [
        "learned from 2 min of the healthy machine",
        ALARM.sentence,
        "alarm 1, diagnosed: Model error found: a leak.",
        "alarm 1 ended at 402 s",
    ]
