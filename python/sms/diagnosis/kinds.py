"""The kinds of rig that are simulated against their records, one entry a kind."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from sms.diagnosis.kind import Kind
from sms.diagnosis.kind_bench import BENCH
from sms.diagnosis.kind_bench_loop import BENCH_LOOP, BENCH_LOOP_BLIND
from sms.diagnosis.kind_platform import PLATFORM
from sms.diagnosis.kind_tank import TANK
from sms.io.errors import InputError
from sms.io.rig import Rig

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "tank": TANK,
        "bench": BENCH,
        "platform": PLATFORM,
    }
)


def kind_of(rig: Rig) -> Kind:
    """A rig's kind, with its controller as the rig file says. InputError for one that is not simulated."""
    if rig.kind not in KINDS:
        raise InputError(
            f"{rig.path}: a {rig.kind} is not simulated against its records; "
            f"what is: {', '.join(KINDS)}"
        )
    if rig.control.controller == "recorded":
        return KINDS[rig.kind]
    if rig.kind != "bench":
        raise InputError(
            f"{rig.path}, [control] controller: a controller is simulated on a bench only, not on a {rig.kind}; "
            'write controller = "recorded" and record the command'
        )
    return BENCH_LOOP if "valve_command" in rig.signals else BENCH_LOOP_BLIND
