"""The kinds of rig that are simulated against their records, one entry a kind."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from sms.diagnosis.kind import Kind
from sms.diagnosis.kind_bench import BENCH
from sms.diagnosis.kind_platform import PLATFORM
from sms.diagnosis.kind_tank import TANK

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "tank": TANK,
        "bench": BENCH,
        "platform": PLATFORM,
    }
)
