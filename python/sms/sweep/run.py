"""Running a sweep: on the cores of this machine, or on an existing Dask cluster.

Each finished variant is a line of sweep.partial.jsonl at once, so that a sweep that was stopped goes
on where it was; the whole one is sweep.parquet.
"""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from itertools import islice
from multiprocessing.context import BaseContext
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from sms import StatusError
from sms.callbacks import Progress
from sms.cluster import client_of
from sms.errors import InputError
from sms.io.json_files import from_json_line, json_line
from sms.io.write import write_parquet, write_text_atomically
from sms.parameters import PARAMETERS
from sms.scenario.command import command_of
from sms.scenario.findings import findings_of
from sms.scenario.load import Scenario, scenario_from
from sms.scenario.plant import run_scenario
from sms.scenario.tank import TankRecord, run_tank, tank_findings
from sms.sweep.plan import Sweep

PARTIAL, WHOLE = "sweep.partial.jsonl", "sweep.parquet"
_AHEAD = 64  # variants handed out before the first has come back
METRICS: Mapping[str, str] = {
    "roll_largest_error": "rad",
    "roll_rms_error": "rad",
    "roll_lag": "s",
    "pitch_largest_error": "rad",
    "pitch_rms_error": "rad",
    "pitch_lag": "s",
    "height_largest_error": "m",
    "height_rms_error": "m",
    "height_lag": "s",
    "extension_rms_error": "m",
    "least_stroke": "m",
    "largest_speed": "m/s",
    "saturated_share": "1",
    "duration": "s",
}
"""What is kept of each variant, and its SI unit; NaN where it does not apply."""
TANK_METRICS: Mapping[str, str] = {
    "arrival": "s",
    "greatest_flow": "kg/s",
    "least_pressure": "Pa",
    "greatest_pressure": "Pa",
    "duration": "s",
}
"""The same of a tank; arrival: from when on its pressure is within 1 % of where the valve leads."""


def run_sweep(
    sweep: Sweep,
    out: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """All variants as a table, one row each, also written as sweep.parquet.

    Args:
        sweep: the plan.
        out: folder; what an interrupted run of the same sweep left there is used.
        workers: processes on this machine; by default one a core.
        scheduler: address of a Dask scheduler ("tcp://..."), in place of processes.
        progress: told the text and the share that is done.

    KeyboardInterrupt leaves sweep.partial.jsonl; the same call goes on from there.
    Raises: InputError.
    """
    tell = progress or (lambda text, share: None)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise InputError(
            f"{out}: cannot be made ({problem.strerror}); choose another output folder"
        ) from None
    done = _resumed(sweep, out / PARTIAL)
    left = [variant for variant in range(len(sweep.values)) if variant not in done]
    count = len(sweep.values)
    if left:
        with (out / PARTIAL).open("a", encoding="utf-8") as file:
            if not done and file.tell() == 0:
                file.write(json_line("sweep", {"sweep": sweep.digest}))
            results = (
                _on_cluster(sweep, left, scheduler)
                if scheduler is not None
                else _on_cores(sweep, left, workers)
            )
            for variant, row in results:
                done[variant] = row
                file.write(json_line("sweep", {"variant": variant, **row}))
                file.flush()
                tell(f"{len(done)} of {count} variants", len(done) / count)
    table = _table(sweep, done)
    write_parquet(out / WHOLE, {str(name): table[name].to_numpy() for name in table})
    (out / PARTIAL).unlink(missing_ok=True)
    return table


def evaluate(
    tables: Mapping[str, Any], path: str, settings: Mapping[str, float]
) -> dict[str, float | str | None]:
    """One variant: its metrics, or why there are none. Runs anywhere sms is installed."""
    try:
        scenario = scenario_from(tables, Path(path), settings)
        command = command_of(scenario)
        if scenario.plant == "tank":
            return _of_tank(scenario, run_tank(scenario, command))
        record = run_scenario(scenario, command)
        if record.time.size < 16:
            return {"ended": record.ended or "too short"}
        findings = findings_of(scenario, command, record)
    except (InputError, StatusError, ValueError) as problem:
        return {"ended": str(problem)}
    row: dict[str, float | str | None] = {"ended": record.ended}
    for following in findings.following:
        metrics = following.metrics
        row[f"{following.axis}_largest_error"] = abs(metrics.largest_error)
        row[f"{following.axis}_rms_error"] = metrics.rms_error
        row[f"{following.axis}_lag"] = metrics.lag if math.isfinite(metrics.lag) else None
    if record.unit == "m":
        error = record.extension - record.setpoint
        row["extension_rms_error"] = float(np.sqrt((error**2).mean()))
    row["least_stroke"] = findings.least_stroke
    row["largest_speed"] = findings.fastest
    row["saturated_share"] = findings.saturated
    row["duration"] = float(record.time[-1])
    return row


def _of_tank(scenario: Scenario, record: TankRecord) -> dict[str, float | str | None]:
    found = tank_findings(scenario, record)
    return {
        "ended": record.ended,
        "arrival": found.arrived,
        "greatest_flow": found.greatest_flow,
        "least_pressure": found.least_pressure,
        "greatest_pressure": found.greatest_pressure,
        "duration": float(record.time[-1]),
    }


def _resumed(sweep: Sweep, partial: Path) -> dict[int, dict[str, Any]]:
    """What an interrupted run left; a last line that was cut off is dropped."""
    if not partial.is_file():
        return {}
    lines = partial.read_text(encoding="utf-8").splitlines()
    rows: list[dict[str, Any]] = []
    for line in lines:
        try:
            rows.append(from_json_line(line))
        except ValueError:
            break
    if not rows:
        partial.unlink()
        return {}
    if rows[0].get("sweep") != sweep.digest:
        raise InputError(
            f"{partial}: left by another sweep; choose another folder with --out, or remove the file"
        )
    write_text_atomically(partial, "".join(json_line("sweep", row) for row in rows))
    return {int(row.pop("variant")): row for row in rows[1:]}


def _on_cores(
    sweep: Sweep, variants: list[int], workers: int | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Finished variants in the order they come, from processes of this machine."""
    context = _start_of_workers()
    count = min(workers or len(os.sched_getaffinity(0)), len(variants))
    pool = ProcessPoolExecutor(count, mp_context=context, initializer=_quiet)
    waiting: dict[Any, int] = {}
    ahead = iter(variants)
    try:
        for variant in islice(ahead, _AHEAD):
            waiting[_submit(pool, sweep, variant)] = variant
        while waiting:
            future = next(as_completed(waiting))
            variant = waiting.pop(future)
            yield variant, future.result()
            for following in islice(ahead, 1):
                waiting[_submit(pool, sweep, following)] = following
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _start_of_workers() -> BaseContext:
    """Workers begin with this package loaded once, and with nothing of this process's threads."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["sms.sweep.run"])
    return context


def _submit(pool: ProcessPoolExecutor, sweep: Sweep, variant: int) -> Any:
    return pool.submit(evaluate, sweep.tables, str(sweep.scenario), sweep.settings(variant))


def _quiet() -> None:
    """Workers leave Ctrl-C to the process that started them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _on_cluster(
    sweep: Sweep, variants: list[int], scheduler: str
) -> Iterator[tuple[int, dict[str, Any]]]:
    """The same from the workers of a Dask cluster."""
    with client_of(scheduler) as client:
        from distributed import as_completed as finished  # noqa: PLC0415 (an extra)

        futures = client.map(
            evaluate,
            [dict(sweep.tables)] * len(variants),
            [str(sweep.scenario)] * len(variants),
            [sweep.settings(variant) for variant in variants],
            pure=False,
        )
        which = {future.key: variant for future, variant in zip(futures, variants, strict=True)}
        for future in finished(futures):  # type: ignore[no-untyped-call]
            yield which[future.key], future.result()


def _table(sweep: Sweep, rows: Mapping[int, Mapping[str, Any]]) -> pd.DataFrame:
    """One row a variant: its number, parameters, metrics, and how it ended."""
    columns: dict[str, Any] = {"variant": np.arange(len(sweep.values))}
    for name, values in zip(sweep.names, sweep.values.T, strict=True):
        columns[f"{name} [{PARAMETERS[name].unit}]"] = values
    of_tank = sweep.tables.get("scenario", {}).get("plant") == "tank"
    for name, unit in (TANK_METRICS if of_tank else METRICS).items():
        numbers = [rows[variant].get(name) for variant in range(len(sweep.values))]
        columns[f"{name} [{unit}]"] = np.array(numbers, dtype=np.float64)
    columns["ended"] = [str(rows[variant]["ended"]) for variant in range(len(sweep.values))]
    return pd.DataFrame(columns)
