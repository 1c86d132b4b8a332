"""Records that are sampled faster than a simulation needs, or that hold more than can be held against one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sms.errors import InputError
from sms.io.records import Finding, Record
from sms.io.rig import Rig

FASTEST = 1e3
"""Hz: twice what a valve of 100 Hz and its first harmonics hold; a faster log tells a simulation nothing more."""
MOST_SAMPLES = 200_000
"""Of all records together, once thinned: 200 s at 1 kHz. With a bench's four channels and thirty parameters, matrices
of sensitivities take about 1 GiB."""


def thinned(record: Record) -> Record:
    """Every n-th sample, down to FASTEST, and a note that says so; the record itself where it is no faster."""
    step = float(np.median(np.diff(record.signals["time"]))) if len(record) > 1 else 0.0
    every = round(1.0 / (FASTEST * step)) if step > 0.0 else 1
    if every < 2:
        return record
    kept = slice(None, None, every)
    note = Finding(
        "note",
        record.file,
        None,
        "time",
        f"sampled at {1.0 / step:.4g} Hz; a simulation needs no more than {FASTEST:g} Hz",
        f"one sample in {every} is used",
    )
    return replace(
        record,
        signals={name: values[kept] for name, values in record.signals.items()},
        findings=(*record.findings, note),
        lines=record.lines[kept],
    )


def raise_if_too_many(rig: Rig, records: Sequence[Record]) -> None:
    """InputError for more samples than a diagnosis can hold."""
    samples = sum(map(len, records))
    if samples > MOST_SAMPLES:
        raise InputError(
            f"{rig.path}, [[records]]: {samples} samples in {len(records)} records; a diagnosis holds "
            f"{MOST_SAMPLES}: give shorter records, or log at a lower rate"
        )
