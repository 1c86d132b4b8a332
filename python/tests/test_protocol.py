"""The firmware's codec against the definition of the bus: every signal, at its corners and in between."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cantools
import pytest
from cantools.database.can import Message, Signal
from sms import _core

from tools.generate_frames import DBC, is_physical
from validation.random_cases import SEED

DATABASE = cantools.database.load_file(DBC)
MESSAGES: list[Message] = list(DATABASE.messages)  # type: ignore[union-attr]
LARGEST_32 = 3.4028234663852886e38


def raw_range(signal: Signal) -> tuple[int, int]:
    if signal.is_signed:
        return -(2 ** (signal.length - 1)), 2 ** (signal.length - 1) - 1
    return 0, 2**signal.length - 1


def corners(signal: Signal) -> list[int]:
    """Raw values at both ends, at every single bit, and next to zero."""
    least, most = raw_range(signal)
    bits = [2**k for k in range(signal.length - (1 if signal.is_signed else 0))]
    return sorted({least, least + 1, most, most - 1, 0, *bits, *(-b for b in bits if -b >= least)})


def is_no_value(signal: Signal, raw: int) -> bool:
    least, most = raw_range(signal)
    return is_physical(signal) and raw == (least if signal.is_signed else most)


def reals() -> list[float]:
    return [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.1,
        1e-45,
        LARGEST_32,
        -LARGEST_32,
        math.inf,
        -math.inf,
        math.nan,
    ]


def by_dbc(message: Message, raw: dict[str, Any]) -> bytes:
    return message.encode(raw, scaling=False, strict=False)


def fields(message: Message) -> list[Signal]:
    return [s for s in message.signals if s.name not in ("reserved", "crc")]


def zeros(message: Message) -> dict[str, Any]:
    return {s.name: 0.0 if s.is_float else 0 for s in message.signals}


def value_of(signal: Signal, raw: Any) -> Any:
    """What the codec makes of a raw value."""
    if signal.is_float or not is_physical(signal):
        return raw
    return math.nan if is_no_value(signal, raw) else float(signal.scale) * raw + signal.offset


def cases(message: Message) -> Iterator[dict[str, Any]]:
    """Each signal at its corners, the others at zero; then all of them anywhere."""
    for signal in fields(message):
        for raw in reals() if signal.is_float else corners(signal):
            yield {**zeros(message), signal.name: raw}
    generator = random.Random(SEED)
    for _ in range(200):
        anywhere = zeros(message)
        for signal in fields(message):
            if signal.is_float:
                anywhere[signal.name] = generator.uniform(-1e6, 1e6)
            else:
                anywhere[signal.name] = generator.randint(*raw_range(signal))
        yield anywhere


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: m.name)
def test_the_codec_is_the_dbc(message: Message) -> None:
    for raw in cases(message):
        octets = by_dbc(message, raw)
        values = {s.name: value_of(s, raw[s.name]) for s in fields(message)}
        assert _core.pack_frame(message.name, values) == octets, f"{raw}, SMS_TEST_SEED={SEED}"
        read = _core.unpack_frame(message.name, octets)
        assert read is not None
        for signal in fields(message):
            expected, got = values[signal.name], read[signal.name]
            if isinstance(expected, float) and math.isnan(expected):
                assert math.isnan(got)
            elif signal.is_float or is_physical(signal):
                assert got == pytest.approx(expected, rel=1e-6, abs=abs(float(signal.scale)) * 0.01)
            else:
                assert got == expected


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: m.name)
def test_beyond_its_range_a_signal_stays_at_the_last_value_that_has_a_meaning(
    message: Message,
) -> None:
    for signal in filter(is_physical, fields(message)):
        least, most = raw_range(signal)
        ends = (least + 1, most) if signal.is_signed else (least, most - 1)
        for beyond, raw in zip((-1e9, 1e9), ends, strict=True):
            values = {s.name: value_of(s, 0) for s in fields(message)}
            octets = _core.pack_frame(message.name, {**values, signal.name: beyond})
            assert octets == by_dbc(message, {**zeros(message), signal.name: raw})


@pytest.mark.parametrize("message", MESSAGES, ids=lambda m: m.name)
def test_a_frame_with_reserved_bits_or_another_length_is_not_whole(message: Message) -> None:
    octets = by_dbc(message, zeros(message))
    assert _core.unpack_frame(message.name, octets) is not None
    assert _core.unpack_frame(message.name, octets[:7]) is None
    for signal in (s for s in message.signals if s.name == "reserved"):
        for bit in range(signal.length):
            assert (
                _core.unpack_frame(
                    message.name, by_dbc(message, {**zeros(message), "reserved": 2**bit})
                )
                is None
            )


def test_the_crc_is_the_one_that_the_protocol_names() -> None:
    """Bit by bit, as the standard defines it, over identifier, challenge and octets 1 to 7."""

    def crc8(data: bytes) -> int:
        crc = 0xFF
        for octet in data:
            crc ^= octet
            for _ in range(8):
                crc = (crc << 1 ^ 0x1D if crc & 0x80 else crc << 1) & 0xFF
        return crc ^ 0xFF

    assert crc8(b"123456789") == 0x4B
    generator = random.Random(SEED)
    for _ in range(1000):
        identifier, challenge = generator.randrange(2048), generator.randrange(256)
        data = generator.randbytes(8)
        expected = crc8(bytes([identifier & 0xFF, identifier >> 8, challenge]) + data[1:])
        assert _core.command_crc(identifier, challenge, data) == expected


def test_every_single_and_double_error_in_a_command_is_seen() -> None:
    data = bytes([0, 0x51, 1, 2, 3, 4, 5, 6])
    sealed = bytes([_core.command_crc(0xA0, 7, data)]) + data[1:]
    word = int.from_bytes(sealed, "little")
    for i in range(64):
        for j in range(i, 64):
            changed = (word ^ (1 << i) ^ (1 << j if j != i else 0)).to_bytes(8, "little")
            assert _core.command_crc(0xA0, 7, changed) != changed[0]


def test_the_definition_is_installed_beside_the_module() -> None:
    assert (Path(_core.__file__).parent / "sms.dbc").read_bytes() == DBC.read_bytes()


def test_parameters_have_one_index_each() -> None:
    settings = _core.firmware_settings()
    assert [s.index for s in settings] == list(range(4096, 4096 + len(settings)))
    assert len({s.name for s in settings} | {p.name for p in _core.parameter_table()}) == len(
        settings
    ) + len(_core.parameter_table())
    assert all(s.lower <= s.default <= s.upper for s in settings)
