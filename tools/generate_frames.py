"""libsms/include/sms/frames.def, made from the definition of the bus, libsms/firmware/sms.dbc."""

from __future__ import annotations

from pathlib import Path

import cantools
from cantools.database.can import Database, Message, Signal

DBC = Path(__file__).resolve().parent.parent / "libsms" / "firmware" / "sms.dbc"

HEAD = """\
/* The frames of the bus and the values of its enumerations: made by ./dev docs from libsms/firmware/sms.dbc, the one
 * place where they are defined. protocol.hpp makes structs, codec and enumerations of them.
 *
 *   SMS_FRAME(frame, identifier) ... SMS_FRAME_END(frame)
 *   SMS_RAW(name, start, length)          an integer, start and length in bits
 *   SMS_UNSIGNED(name, start, step, offset), SMS_SIGNED(name, start, step, offset)
 *                                         16 bits, a physical value in SI; all ones, or the least one, is "no value"
 *   SMS_REAL32(name, start)               IEEE 754 single precision
 *   SMS_RESERVED(start, length)           zero
 *   SMS_CRC(start)                        the check of a command frame */
#ifndef SMS_VALUES
#define SMS_VALUES(table)
#define SMS_VALUE(name, number)
#define SMS_VALUES_END
#endif
#ifndef SMS_FRAME
#define SMS_FRAME(frame, identifier)
#define SMS_FRAME_END(frame)
#endif
#ifndef SMS_RAW
#define SMS_RAW(name, start, length)
#define SMS_UNSIGNED(name, start, step, offset)
#define SMS_SIGNED(name, start, step, offset)
#define SMS_REAL32(name, start)
#endif
#ifndef SMS_RESERVED
#define SMS_RESERVED(start, length)
#endif
#ifndef SMS_CRC
#define SMS_CRC(start)
#endif
"""
MACROS = (
    "VALUES",
    "VALUE",
    "VALUES_END",
    "FRAME",
    "FRAME_END",
    "RAW",
    "UNSIGNED",
    "SIGNED",
    "REAL32",
    "RESERVED",
    "CRC",
)
PHYSICAL_UNITS = ("m", "rad", "V", "Pa")


def is_physical(signal: Signal) -> bool:
    """Whether the codec turns it into SI, a float; other signals stay the integers they are."""
    return signal.length == 16 and signal.unit in PHYSICAL_UNITS


def _row(signal: Signal) -> str:
    if signal.name == "reserved":
        return f"SMS_RESERVED({signal.start}, {signal.length})"
    if signal.name == "crc":
        return f"SMS_CRC({signal.start})"
    if signal.is_float:
        return f"SMS_REAL32({signal.name}, {signal.start})"
    if is_physical(signal):
        kind = "SIGNED" if signal.is_signed else "UNSIGNED"
        step, offset = float(signal.scale), float(signal.offset)
        return f"SMS_{kind}({signal.name}, {signal.start}, {step!r}, {offset!r})"
    return f"SMS_RAW({signal.name}, {signal.start}, {signal.length})"


def _frame(message: Message) -> str:
    rows = "".join(f"{_row(signal)}\n" for signal in message.signals)
    head = f"SMS_FRAME({message.name}, 0x{message.frame_id:03X})"
    return f"\n{head}\n{rows}SMS_FRAME_END({message.name})\n"


def frames() -> str:
    """The text of frames.def."""
    database = cantools.database.load_file(DBC, strict=True)
    assert isinstance(database, Database)
    assert database.dbc is not None
    tables = "".join(
        f"\nSMS_VALUES({name})\n"
        + "".join(f"SMS_VALUE({value}, {number})\n" for number, value in values.items())
        + "SMS_VALUES_END\n"
        for name, values in database.dbc.value_tables.items()
    )
    messages = "".join(_frame(message) for message in database.messages)
    undefine = "".join(f"#undef SMS_{macro}\n" for macro in MACROS)
    return f"{HEAD}{tables}{messages}\n{undefine}"
