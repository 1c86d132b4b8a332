"""Authenticated commands: a desk with the rig's key drives it, one without does not, and is told what to do."""

from __future__ import annotations

from pathlib import Path

import can
import numpy as np
import pytest
from link_support import desk_and_rig
from sms import _core
from sms.cli import app
from sms.io import InputError
from sms.link.codec import Sender, checksum, decode
from sms.link.drive import drive
from sms.link.key_file import read_key, readable_by_others
from sms.link.motion import PlatformMotion
from sms.link.parameters import read_parameter, write_parameters
from sms.link.rig_link import NotConnectedError, RefusedError
from typer.testing import CliRunner

from validation.random_cases import draw

KEY, OTHER = bytes(range(16)), bytes(range(1, 17))
_WORD = 0xFFFFFFFFFFFFFFFF


def gentle() -> PlatformMotion:
    time = np.arange(0.0, 1.0, 0.05)
    wave = np.sin(2.0 * np.pi * 0.5 * time)
    return PlatformMotion(time, 0.02 * wave, -0.01 * wave, 0.5 + 0.01 * wave)


def reference_siphash(key: bytes, message: bytes) -> int:
    """SipHash-2-4 as its paper has it."""

    def rotated(x: int, by: int) -> int:
        return (x << by | x >> (64 - by)) & _WORD

    k0, k1 = (int.from_bytes(half, "little") for half in (key[:8], key[8:]))
    v = [k0 ^ 0x736F6D6570736575, k1 ^ 0x646F72616E646F6D]
    v += [k0 ^ 0x6C7967656E657261, k1 ^ 0x7465646279746573]

    def rounds(count: int) -> None:
        for _ in range(count):
            for a, b, c, d, left, right in ((0, 1, 2, 3, 13, 16), (2, 1, 0, 3, 17, 21)):
                v[a], v[c] = (v[a] + v[b]) & _WORD, (v[c] + v[d]) & _WORD
                v[b], v[d] = rotated(v[b], left) ^ v[a], rotated(v[d], right) ^ v[c]
                v[a] = rotated(v[a], 32)

    padded = message + bytes(7 - len(message) % 8) + bytes([len(message) % 256])
    for i in range(0, len(padded), 8):
        block = int.from_bytes(padded[i : i + 8], "little")
        v[3] ^= block
        rounds(2)
        v[0] ^= block
    v[2] ^= 0xFF
    rounds(4)
    return v[0] ^ v[1] ^ v[2] ^ v[3]


def test_the_reference_is_the_published_hash() -> None:
    assert reference_siphash(KEY, bytes(range(15))) == 0xA129CA6149BE45E5


def test_the_mac_is_the_hash_of_nonce_content_counter_and_identifier() -> None:
    random = draw("test_the_mac_is_the_hash_of_nonce_content_counter_and_identifier")
    for _ in range(200):
        key, nonce, data = random.bytes(16), int(random.integers(2**63)), random.bytes(8)
        counter, identifier = int(random.integers(2**32)), int(random.integers(0x800))
        covered = nonce.to_bytes(8, "little") + data
        covered += counter.to_bytes(4, "little") + identifier.to_bytes(2, "little")
        mac = _core.command_mac(key, nonce, counter, identifier, data)
        assert mac == reference_siphash(key, covered) % 2**40
        assert mac != _core.command_mac(key, nonce, counter + 1, identifier, data)


def test_an_authenticator_says_counter_session_and_crc() -> None:
    sender = Sender(session=9, challenge=3, key=KEY)
    sender.hear_nonce(77)
    for counter in range(1, 4):
        frame = sender.frame("ParameterRead", {"parameter_index": counter})
        found = decode(sender.authenticator(frame))
        assert found is not None
        name, signals = found
        assert (name, signals["freshness"], signals["session"]) == (
            "CommandAuthenticator",
            counter,
            9,
        )
        assert signals["command_crc"] == checksum(frame.arbitration_id, 3, bytes(frame.data))
        mac = int(signals["mac_high"]) << 32 | int(signals["mac_low"])
        assert mac == _core.command_mac(KEY, 77, counter, 0x0C3, bytes(frame.data))
    assert KEY.hex() not in repr(sender)
    assert repr(KEY) not in repr(sender)


def test_with_the_key_a_desk_drives_reads_and_writes() -> None:
    with desk_and_rig(rigs_key=KEY, desks_key=KEY) as (link, world):
        link.connect()
        link.request_mode("disabled")
        assert write_parameters(link, {"position_gain": 33.0})["position_gain"] == 33.0
        assert read_parameter(link, "position_gain") == 33.0
        stream = drive(link, gentle())
        assert np.nanmax(np.abs(stream.followed[:, 0])) > 0.01
        link.release()
        world.run(0.5)  # the nonce is another one now
        link.drain()
        link.connect()
        link.request_mode("disabled")


@pytest.mark.parametrize(
    ("desks_key", "said"),
    [
        (OTHER, "not authentic: its key is another one; check --key-file"),
        (None, "authenticated commands only; give its key: --key-file FILE"),
    ],
)
def test_without_the_key_nothing_moves_and_the_error_says_why(
    desks_key: bytes | None, said: str
) -> None:
    with desk_and_rig(rigs_key=KEY, desks_key=desks_key) as (link, world):
        with pytest.raises(RefusedError, match=said):
            link.connect()
        for mode in ("levelling", "disabled"):
            link.send(
                "ModeRequest", {"mode_request": mode, "control_law_request": 0, "acknowledge": 0}
            )
            world.run(0.1)
        assert (world.machine.truth.session, world.machine.truth.mode) == (0, 0)


def test_a_recorded_drive_played_again_moves_nothing() -> None:
    heard: list[can.Message] = []
    with desk_and_rig(rigs_key=KEY, desks_key=KEY) as (link, world):
        link.connect()
        link.listener = heard.append
        link.request_mode("levelling")
        link.request_mode("disabled")
        link.release()
        world.run(0.5)
        commands = [f for f in heard if f.arbitration_id < 0x100]
        assert len(commands) > 3
        for frame in commands:
            link.bus.send(frame)
            world.run(0.005)
            assert world.machine.truth.mode == 0
        assert world.machine.truth.session == 0


def test_a_key_for_a_rig_without_one_is_refused() -> None:
    with (
        desk_and_rig(desks_key=KEY) as (link, world),
        pytest.raises(NotConnectedError, match=r"the rig has no key .* or leave --key-file out"),
    ):
        link.connect()
    assert world.machine.frames_in == 0


def test_a_key_file_holds_32_digits_and_is_the_owners(tmp_path: Path) -> None:
    file = tmp_path / "rig.key"
    file.write_text(KEY.hex() + "\n")
    file.chmod(0o600)
    assert read_key(file) == KEY
    assert readable_by_others(file) is None
    file.chmod(0o644)
    assert "chmod 600" in (readable_by_others(file) or "")
    secret = "00112233445566778899aabbccddee"
    for text in ("", secret, "0" * 32, "\N{BULLET}", KEY.hex() * 2):
        file.write_text(text, encoding="utf-8")
        with pytest.raises(InputError) as caught:
            read_key(file)
        assert secret not in str(caught.value)
        assert "openssl rand -hex 16" in str(caught.value)
    with pytest.raises(InputError, match="cannot be read"):
        read_key(tmp_path / "none")


def test_the_commands_take_a_key_file(tmp_path: Path) -> None:
    file = tmp_path / "rig.key"
    file.write_text(KEY.hex())
    file.chmod(0o644)
    words = ["can", "get", "position_gain", "--key-file", str(file)]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert "position_gain = 40 V/m\n" in result.output
    assert "others on this computer can read the key" in result.output


def test_a_rig_without_a_key_says_once_that_its_bus_is_open(tmp_path: Path) -> None:
    words = ["can", "rig", "--seconds", "0.05", "--quiet"]
    words += ["--interface", "udp_multicast", "--channel", "239.74.163.2:43971"]
    said = "this bus is open: whoever is on it can command the rig"
    open_rig = CliRunner().invoke(app, words)
    assert open_rig.exit_code == 0, open_rig.output
    assert open_rig.output.count(said) == 1
    file = tmp_path / "rig.key"
    file.write_text(KEY.hex())
    assert said not in CliRunner().invoke(app, [*words, "--key-file", str(file)]).output
