"""Frames of the desk: counter, session and CRC; what cannot be sent; what carries no value."""

from __future__ import annotations

import can
import pytest
from sms.io import InputError
from sms.link import codec
from sms.link.codec import (
    CHECKED,
    CONTROLLER,
    HOST,
    Sender,
    bus_definition,
    checksum,
    decode,
    sent_by,
)

from validation.random_cases import draw

LEVEL = {"roll_setpoint": 0.01, "pitch_setpoint": -0.02, "height_setpoint": 0.5}


def reference_crc(octets: bytes) -> int:
    """CRC-8/SAE-J1850 bit by bit."""
    crc = 0xFF
    for octet in octets:
        crc ^= octet
        for _ in range(8):
            crc = (crc << 1 ^ (0x1D if crc & 0x80 else 0)) & 0xFF
    return crc ^ 0xFF


def test_the_reference_is_the_published_code() -> None:
    assert reference_crc(b"123456789") == 0x4B


def test_the_checksum_covers_identifier_challenge_and_content() -> None:
    random = draw("test_the_checksum_covers_identifier_challenge_and_content")
    for _ in range(200):
        identifier, challenge = int(random.integers(0x800)), int(random.integers(256))
        data = random.bytes(8)
        covered = bytes([identifier & 0xFF, identifier >> 8, challenge]) + data[1:]
        assert checksum(identifier, challenge, data) == reference_crc(covered)
        assert checksum(identifier, challenge, data) != checksum(identifier ^ 1, challenge, data)
        assert checksum(identifier, challenge, data) != checksum(identifier, challenge ^ 7, data)


def test_counters_run_for_each_message_alone() -> None:
    sender = Sender(session=9, challenge=77)
    alive = []
    for _ in range(20):
        frame = sender.frame("AttitudeSetpoint", LEVEL)
        found = decode(frame)
        assert found is not None
        name, signals = found
        assert (name, signals["session"]) == ("AttitudeSetpoint", 9)
        assert signals["crc"] == checksum(frame.arbitration_id, 77, bytes(frame.data))
        assert signals["pitch_setpoint"] == pytest.approx(-0.02, abs=5e-6)
        alive.append(signals["alive"])
        request = {"mode_request": "levelling", "control_law_request": 0, "acknowledge": "no"}
        sender.frame("ModeRequest", request)
    assert alive == [i % 16 for i in range(20)]


def test_what_cannot_be_sent_is_said() -> None:
    sender = Sender(session=1)
    with pytest.raises(InputError, match="did you mean 'AttitudeSetpoint'"):
        sender.frame("AttitudeSetpont", LEVEL)
    with pytest.raises(InputError, match=r"AttitudeSetpoint: .*roll_setpoint"):
        sender.frame("AttitudeSetpoint", LEVEL | {"roll_setpoint": 1.0})
    with pytest.raises(InputError, match=r"AttitudeSetpoint: .*height_setpoint"):
        sender.frame("AttitudeSetpoint", {"roll_setpoint": 0.0, "pitch_setpoint": 0.0})


def test_a_signal_without_value_is_left_out() -> None:
    frame = can.Message(
        arbitration_id=0x115, is_extended_id=False, data=b"\x00\x80\x01\x80\xff\xff\0\0"
    )
    found = decode(frame)
    assert found is not None
    assert found[0] == "Attitude"
    assert set(found[1]) == {"pitch", "sample_time"}
    assert found[1]["pitch"] == pytest.approx(-0.32767)


def test_foreign_frames_are_nothing() -> None:
    assert decode(can.Message(arbitration_id=0x7FF, data=bytes(8), is_extended_id=False)) is None
    assert decode(can.Message(arbitration_id=0x115, data=bytes(3), is_extended_id=False)) is None
    assert decode(can.Message(arbitration_id=0x115, data=bytes(8), is_extended_id=True)) is None
    assert decode(can.Message(is_error_frame=True)) is None


def test_every_command_is_protected_and_no_name_means_two_things() -> None:
    senders = {**sent_by(HOST), **sent_by(CONTROLLER)}
    assert len(senders) == len(bus_definition().messages)
    for message in sent_by(HOST).values():
        if message.name == "CommandAuthenticator":  # it protects them
            continue
        assert [signal.name for signal in message.signals][:3] == list(CHECKED), message.name
    units: dict[str, str | None] = {}
    for message in bus_definition().messages:
        assert message.length == 8
        for signal in message.signals:
            assert units.setdefault(signal.name, signal.unit) == signal.unit, signal.name


def test_times_are_those_of_the_bus_definition() -> None:
    assert codec.period("AttitudeSetpoint") == 0.01
    assert codec.time_out("ControllerHeartbeat") == 0.3
