"""Alarms on a bus: what another node reads of them with the DBC."""

from __future__ import annotations

from importlib.resources import files

import can
import cantools
import pytest
from cantools.database.can import Database
from sms.diagnosis.effects.catalogue import catalogue
from sms.errors import InputError
from sms.io.can_frames import load_dbc
from sms.link.bus import BusAddress
from sms.watch.alarm_frame import OWN, AlarmFrame, checked

DBC = cantools.database.load_string(files("sms.watch").joinpath("alarm.dbc").read_text(), "dbc")
assert isinstance(DBC, Database)
MESSAGE = DBC.get_message_by_name("WatchAlarm")
IDENTIFIER = 0x1F0
ALARM = {
    "alarm": 258,
    "since_s": 100.0,
    "raised_s": 112.5,
    "z": 12.0,
    "threshold": 8.0,
    "guesses": [{"effect": "fitting_leakage of lower, leg 2"}, {"effect": "dead_band_width"}],
}


def told(*events: tuple[str, dict[str, object]]) -> list[dict[str, object]]:
    """What another node of the bus decodes."""
    address = BusAddress("virtual", "alarms")
    listening = can.Bus(interface="virtual", channel="alarms")
    frame = AlarmFrame(address, IDENTIFIER, load_dbc())
    try:
        assert [frame(event, content, "") for event, content in events] == [None] * len(events)
        received = []
        while (message := listening.recv(0.2)) is not None:
            assert message.arbitration_id == IDENTIFIER
            signals = MESSAGE.decode(bytes(message.data))
            assert isinstance(signals, dict)
            received.append(signals)
    finally:
        frame.close()
        listening.shutdown()
    return [
        {name: str(v) if not isinstance(v, float | int) else v for name, v in r.items()}
        for r in received
    ]


def test_another_node_reads_the_alarm_its_verdict_and_its_end() -> None:
    verdict = {"alarm": 258, "verdict": "cause", "causes": ["viscous_friction"], "time_s": 230.0}
    alarm, diagnosed, ended = told(
        ("alarm", ALARM),
        ("learned", {}),
        ("diagnosed", verdict),
        ("alarm_ended", {"alarm": 258, "time_s": 8000.0}),
    )
    assert alarm == {
        "watch_event": "alarm",
        "watch_verdict": "none",
        "alarm_number": 2,
        "alarm_age": 12.5,
        "fitting_effect": "fitting_leakage",
        "fitting_leg": 2,
        "evidence": 1.5,
    }
    assert (diagnosed["watch_event"], diagnosed["watch_verdict"]) == ("diagnosed", "cause")
    assert (diagnosed["fitting_effect"], diagnosed["fitting_leg"]) == ("viscous_friction", 0)
    assert diagnosed["alarm_age"] == pytest.approx(130.0)
    assert (ended["watch_event"], ended["alarm_age"]) == ("alarm_ended", 6553.5)


def test_an_effect_that_is_its_users_own_and_none_at_all() -> None:
    own, none = told(
        ("alarm", ALARM | {"guesses": [{"effect": "my_effect"}]}),
        ("alarm", ALARM | {"guesses": []}),
    )
    assert (own["fitting_effect"], none["fitting_effect"]) == (OWN, "none")


def test_the_dbc_knows_every_effect_that_can_fit() -> None:
    (effects,) = (s.choices for s in MESSAGE.signals if s.name == "fitting_effect")
    assert effects is not None
    known = {str(name) for name in effects.values()}
    assert {e.id for kind in ("bench", "platform", "tank") for e in catalogue(kind)} <= known


@pytest.mark.parametrize(
    ("identifier", "said"),
    [
        (-1, "not negative"),
        (0x20000000, "extended identifier"),
        (0xA0, "this is AttitudeSetpoint on this bus"),
    ],
)
def test_identifiers_that_are_refused(identifier: int, said: str) -> None:
    with pytest.raises(InputError, match=said):
        checked(identifier, load_dbc())
