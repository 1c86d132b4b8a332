"""What `sms simulate` leaves in its folder: the record, its findings, the page; whole files only."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from sms.io import write_parquet, write_table, write_text_atomically
from sms.io.json_files import json_text
from sms.report.page import write_page
from sms.report.simulation import simulation_html
from sms.scenario.findings import Findings
from sms.scenario.load import Scenario
from sms.scenario.record import Record
from sms.scenario.sent import Command
from sms.scenario.tank import TankFindings, TankRecord


def write_run(
    out: Path,
    scenario: Scenario,
    command: Command,
    record: Record | TankRecord,
    findings: Findings | TankFindings,
) -> list[Path]:
    """Write the record (CSV or Parquet), run.json and report.html; a partial run says so by name.

    Each file is there whole or not at all. What an earlier run of the other kind left is removed,
    so that a folder never holds a whole and a partial run side by side. InputError when the folder
    cannot be written.
    """
    stem = "run" if record.complete else "run.partial"
    step = max(1, round(scenario.every / scenario.period))
    written = record.every(step)
    table = out / f"{stem}.{scenario.output.format}"
    if scenario.output.format == "parquet":
        write_parquet(table, written.columns())
    else:
        write_table(table, written.columns())
    summary = out / f"{stem}.json"
    write_text_atomically(summary, run_json(scenario, command, record, findings))
    page = out / "report.html"
    write_page(page, simulation_html(scenario, command, record, findings))
    for other in ("run", "run.partial"):
        for ending in ("csv", "parquet", "json"):
            old = out / f"{other}.{ending}"
            if old not in (table, summary):
                old.unlink(missing_ok=True)
    return [table, summary, page]


def run_json(
    scenario: Scenario,
    command: Command,
    record: Record | TankRecord,
    findings: Findings | TankFindings,
) -> str:
    """The text of run.json."""
    content = summary_of(scenario, command, record, findings)
    return json_text("run", content, scenario.files)


def summary_of(
    scenario: Scenario,
    command: Command,
    record: Record | TankRecord,
    findings: Findings | TankFindings,
) -> dict[str, Any]:
    """For programs: what was run and what came out, SI units."""
    return {
        "title": scenario.title,
        "scenario": str(scenario.path),
        "complete": record.complete,
        "ended": record.ended,
        "duration_s": float(record.time[-1]) if record.time.size else 0.0,
        "planned_s": record.planned,
        "parameters": dict(scenario.changed),
        "motion": list(command.words),
        "cuts": [
            {
                "limit": cut.limit,
                "share_of_time": cut.share,
                "largest_rad": cut.largest,
                "at_s": cut.at,
                "sentence": cut.sentence,
            }
            for cut in (command.motion.cuts if command.motion else ())
        ],
        **findings.to_dict(),
    }
