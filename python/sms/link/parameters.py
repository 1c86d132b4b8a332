"""Parameters of a rig over the bus: read one, or write a set in two phases, all of it or nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import can
import numpy as np

from sms import _core
from sms.errors import InputError, did_you_mean
from sms.io.units import to_si
from sms.link.codec import Value, decode, message
from sms.link.rig_link import ANSWER, TRIES, LinkError, NotConnectedError, RefusedError, RigLink
from sms.parameters import PARAMETERS

_CONFIRM = message("ParameterConfirm").frame_id

#: `confirm_result`, docs/protocol.md, as a sentence goes on after "the rig refuses it: "
_RESULTS = {
    "unknown_index": "it does not know this parameter",
    "out_of_range": "the value is outside the allowed range",
    "not_a_number": "the value is not a number",
    "wrong_hash": "its list of parameters is another one",
    "moving": "the platform is not disabled; ask for the mode disabled first",
    "discarded": "the transaction was discarded; nothing was changed",
    "impossible_machine": "these parameters together are no machine; nothing was changed",
    "too_many": "a transaction takes no more parameters; nothing was changed, write them in two parts",
}
#: What loss on the bus can bring about: the transaction is then begun again.
_TRY_AGAIN = ("no_transaction", "wrong_count", "timed_out")


@dataclass(frozen=True)
class RigParameter:
    """What is known of something that a rig lets read and write."""

    index: int  #: on the bus
    name: str
    unit: str  #: SI; "1" is dimensionless
    lower: float
    default: float
    upper: float
    live: bool  #: may also be written while the platform is levelled


@cache
def known_parameters() -> Mapping[str, RigParameter]:
    """The parameters of params.def and the firmware's own settings, by name."""
    machine = [
        RigParameter(i, p.name, p.unit, p.lower, p.default, p.upper, False)
        for i, p in enumerate(PARAMETERS.values())
    ]
    settings = [
        RigParameter(s.index, s.name, s.unit, s.lower, s.default, s.upper, s.live)
        for s in _core.firmware_settings()
    ]
    return {p.name: p for p in (*machine, *settings)}


def read_parameter(link: RigLink, name: str) -> float:
    """The value in effect, in the parameter's SI unit. RefusedError, NotConnectedError."""
    index = known_parameter(name).index
    answer = _ask(link, "ParameterRead", {"parameter_index": index}, "read", index)
    return float(answer["parameter_value"])


def write_parameters(link: RigLink, values: Mapping[str, float]) -> dict[str, float]:
    """Set parameters, SI, all at once between two ticks of the rig; what is in effect afterwards.

    The values are checked here first. InputError; RefusedError when the rig refuses one: then none
    is changed. A confirmation that gets lost begins the whole transaction again.
    """
    indices = {name: known_parameter(name).index for name in values}
    for name, value in values.items():
        _check(name, value)
    for _ in range(TRIES):
        try:
            return _transaction(link, values, indices)
        except _LostError:
            continue
    raise NotConnectedError("the rig confirms too little for a transaction; check the bus")


class _LostError(LinkError):
    """A confirmation of a write did not come: it may have counted, so begin again."""


def _transaction(
    link: RigLink, values: Mapping[str, float], indices: Mapping[str, int]
) -> dict[str, float]:
    _ask(link, "ParameterBegin", {"params_hash": _core.firmware_hash()}, "begin", None)
    stored = {}
    for name, value in values.items():
        content: dict[str, Value] = {"parameter_index": indices[name], "parameter_value": value}
        answer = _ask(link, "ParameterWrite", content, "write", indices[name], once=True)
        stored[name] = float(answer["parameter_value"])
    _ask(
        link,
        "ParameterCommit",
        {"commit_action": "apply", "commit_count": len(values)},
        "commit",
        None,
    )
    return stored


def _ask(
    link: RigLink,
    name: str,
    content: Mapping[str, Value],
    operation: str,
    index: int | None,
    *,
    once: bool = False,
) -> Mapping[str, Value]:
    """Send a parameter frame until its confirmation comes; its signals."""
    for _ in range(1 if once else TRIES):
        sent = link.sender.frame(name, content)
        link.transmit(sent)
        end = link.clock() + ANSWER
        while (frame := link.poll(end)) is not None:
            if frame.arbitration_id == _CONFIRM and (answer := decode(frame)) is not None:
                signals = answer[1]
                if _answers(signals, sent, operation, index):
                    return _checked(signals, operation)
    if once:
        raise _LostError
    raise NotConnectedError(f"the rig did not confirm the {operation} of a parameter")


def _answers(
    signals: Mapping[str, Value], sent: can.Message, operation: str, index: int | None
) -> bool:
    """Whether a confirmation is that of one sent frame."""
    return (
        signals["confirm_alive"] == sent.data[1] & 0x0F
        and signals["confirm_session"] == sent.data[1] >> 4
        and signals["confirm_operation"] == operation
        and (index is None or signals["parameter_index"] == index)
    )


def _checked(signals: Mapping[str, Value], operation: str) -> Mapping[str, Value]:
    result = str(signals["confirm_result"])
    if result in _TRY_AGAIN and operation != "begin":
        raise _LostError
    if result != "ok":
        raise RefusedError(f"the rig refuses the {operation}: {_RESULTS.get(result, result)}")
    return signals


def known_parameter(name: str) -> RigParameter:
    """What is known of a parameter. InputError for a name that no rig knows."""
    known = known_parameters()
    if name not in known:
        remedy = did_you_mean(name, known, "`sms can get` without a name lists all")
        raise InputError(f"there is no parameter '{name}'; {remedy}")
    return known[name]


def _check(name: str, value: float) -> None:
    parameter = known_parameters()[name]
    if not math.isfinite(value) or not parameter.lower <= value <= parameter.upper:
        raise InputError(
            f"{name} = {value:g} {parameter.unit} is outside the allowed range "
            f"{parameter.lower:g} to {parameter.upper:g} {parameter.unit}; check number and unit"
        )


def is_default(name: str, value: float) -> bool:
    """Whether a value read over the bus is the default, in the single precision of the rig."""
    return bool(np.float32(known_parameters()[name].default) == np.float32(value))


def parse_setting(text: str) -> tuple[str, float]:
    """("bore_diameter", 0.1) from "bore_diameter=100 mm"; a number alone is in SI. InputError."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not equals:
        raise InputError(f"{text}: write NAME=VALUE, for instance position_gain=20")
    unit = known_parameter(name).unit
    try:
        return name, float(value)
    except ValueError:
        return name, to_si(value, unit, name)
