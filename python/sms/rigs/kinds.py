"""The kinds of rig, one entry a kind: those that are simulated against their records, and the cylinder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from sms.errors import InputError
from sms.estimation.kind import Kind
from sms.io.rig import Rig
from sms.io.signals import without_leg
from sms.rigs.bench import BENCH
from sms.rigs.bench_loop import BENCH_LOOP, BENCH_LOOP_BLIND
from sms.rigs.cylinder import CYLINDER
from sms.rigs.platform import PLATFORM
from sms.rigs.platform_loop import PLATFORM_LOOP, PLATFORM_LOOP_BLIND
from sms.rigs.tank import TANK

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "tank": TANK,
        "bench": BENCH,
        "platform": PLATFORM,
    }
)
LOOPS: Mapping[str, tuple[Kind, Kind]] = MappingProxyType(
    {
        "bench": (BENCH_LOOP, BENCH_LOOP_BLIND),
        "platform": (PLATFORM_LOOP, PLATFORM_LOOP_BLIND),
    }
)
"""Where a controller can be simulated: with its command recorded, and without."""


def kind_of(rig: Rig) -> Kind:
    """A rig's kind, with its controller as the rig file says.

    InputError for one that is not simulated, and where of signals that belong together only some are listed.
    """
    if rig.kind == "cylinder":
        return CYLINDER
    if rig.kind not in KINDS:
        raise InputError(
            f"{rig.path}: a {rig.kind} is not simulated against its records; "
            f"what is: {', '.join(KINDS)}"
        )
    _recorded(rig, "the attitude", ["roll", "pitch"])
    if rig.control.controller == "recorded":
        return KINDS[rig.kind]
    if rig.kind not in LOOPS:
        raise InputError(
            f"{rig.path}, [control] controller: a controller is simulated on a bench or a platform, not on a "
            f'{rig.kind}; write controller = "recorded" and record the command'
        )
    held, blind = LOOPS[rig.kind]
    commands = [s for s in held.outputs if without_leg(s) == "valve_command"]
    return held if _recorded(rig, "the commands", commands) else blind


def _recorded(rig: Rig, what: str, signals: Sequence[str]) -> bool:
    """Whether signals that belong together are recorded; InputError where only some are."""
    listed = [s for s in signals if s in rig.signals]
    if listed and len(listed) < len(signals):
        raise InputError(
            f"{rig.path}, [signals]: of {what} there is only {', '.join(listed)}; list all of them, or none"
        )
    return bool(listed)
