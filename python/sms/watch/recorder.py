"""Everything that came in, as records of some minutes each, the oldest removed: so that an alarm can be looked into."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from sms.arrays import Array
from sms.errors import InputError
from sms.io.signals import SIGNAL_UNITS, column_name
from sms.io.write import write_table

PIECE = 600.0
"""s of rows in one file."""


class Recorder:
    """Writes rows_000001.csv.gz, ... and keeps the last `hours`."""

    def __init__(self, folder: Path, hours: float) -> None:
        if not hours > 0.0:
            raise InputError(
                f"--keep {hours:g}: how many hours of rows are kept; write more than 0"
            )
        self.folder = folder
        self.most = max(1, int(np.ceil(hours * 3600.0 / PIECE)))
        """Files."""
        self.written: list[Path] = []
        self._held: list[Mapping[str, Array]] = []
        self._begin: float | None = None
        self._number = 0

    def add(self, rows: Mapping[str, Array]) -> None:
        """Rows as they came, signal -> (n,) in SI."""
        times = rows["time"][np.isfinite(rows["time"])]
        if not times.size:
            return
        if self._begin is None:
            self._begin = float(times[0])
        self._held.append(rows)
        if not 0.0 <= float(times[-1]) - self._begin < PIECE:  # full, or the clock went back
            self.flush()

    def flush(self) -> None:
        """Write what is held."""
        if not self._held:
            return
        names = [n for n in self._held[0] if all(n in rows for rows in self._held)]
        self._number += 1
        path = self.folder / f"rows_{self._number:06d}.csv.gz"
        write_table(
            path, {column_name(n): np.concatenate([r[n] for r in self._held]) for n in names}
        )
        assert all(n in SIGNAL_UNITS for n in names)
        self._held, self._begin = [], None
        self.written.append(path)
        while len(self.written) > self.most:
            self.written.pop(0).unlink(missing_ok=True)
