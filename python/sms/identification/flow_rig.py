"""The records of a flow test, from a rig file of kind "flow_test"."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sms.errors import InputError
from sms.identification.flow_record import FlowRecord
from sms.io.check import check_record, raise_if_unusable
from sms.io.records import Finding, Record, load_record
from sms.io.rig import RecordSource, Rig, load_rig


def load_flow_test(path: Path) -> tuple[Rig, tuple[FlowRecord, ...], tuple[Finding, ...]]:
    """The rig, its records for identification, and what the data check found.

    The spool's position and the supply pressure of a run stand in its `conditions`. InputError for
    another kind of rig and for data that cannot be used.
    """
    rig = load_rig(path)
    if rig.kind != "flow_test":
        raise InputError(
            f"{path}, [rig] kind: '{rig.kind}' records no flow test; sms identify flow reads rigs of "
            "kind 'flow_test' (a tank charged or discharged through a component)"
        )
    loaded = [(source, load_record(rig, source)) for source in rig.records]
    findings = [f for _, record in loaded for f in check_record(rig, record)]
    raise_if_unusable(findings)
    return rig, tuple(flow_record(rig, s, r) for s, r in loaded), tuple(findings)


def flow_record(rig: Rig, source: RecordSource, record: Record) -> FlowRecord:
    """One record with absolute pressures and what its conditions say."""

    def condition(name: str) -> float:
        return source.conditions.get(name, rig.declared(name).value)

    ambient = condition("ambient_pressure")

    def absolute(signal: str) -> float:
        return ambient if signal in record.gauge else 0.0

    supply = record.signals.get("supply_pressure")
    known = "spool_position" in source.conditions or "spool_position" in rig.parameters
    return FlowRecord(
        name=source.name,
        time=record.used("time"),
        pressure=record.used("tank_pressure") + absolute("tank_pressure"),
        supply=None if supply is None else supply[record.skipped :] + absolute("supply_pressure"),
        temperature=record.used("tank_temperature")
        if "tank_temperature" in record.signals
        else None,
        spool=condition("spool_position") if known else None,
        supply_pressure=condition("supply_pressure"),
        ambient_pressure=ambient,
        noise=rig.signals["tank_pressure"].noise,
        temperature_noise=rig.signals["tank_temperature"].noise
        if "tank_temperature" in rig.signals
        else None,
    )


def supplies(records: Sequence[FlowRecord]) -> list[float]:
    """The different supply pressures, Pa, rising; settings within 5 % are one."""
    found: list[float] = []
    for pressure in sorted(r.supply_pressure for r in records):
        if not found or pressure > 1.05 * found[-1]:
            found.append(pressure)
    return found
