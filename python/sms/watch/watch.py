"""The watch: rows in, states and alarms out.

learning   until so many seconds of the healthy machine are there (its reference records count), then fitted
watching   segment by segment
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from sms.arrays import Array
from sms.callbacks import Progress
from sms.errors import InputError
from sms.io.check import check_record, raise_if_unreadable
from sms.io.records import load_record
from sms.io.rig import Rig
from sms.watch.alarm import Alarm, Judge
from sms.watch.background import Diagnosis, Verdict
from sms.watch.detector import LAGS, Detector, Look
from sms.watch.excerpt import write_excerpt
from sms.watch.feed import Chunk
from sms.watch.healthy import LEAST, Baseline, learn
from sms.watch.log import EventLog, Listener
from sms.watch.recorder import Recorder
from sms.watch.segments import SEGMENT, Interruption, Segment, Segmenter

Phase = Literal["learning", "watching"]
KEPT_HEALTHY = 24
"""Segments of the healthy machine that are held for diagnoses: two minutes, evenly chosen."""
LONGEST = 7200.0
"""s that can be learned from: an hour of a bench at 1 kHz takes 200 MB."""
LATE = 4 * SEGMENT
"""s that wait in the queue, from where on the watch is said to be late."""


@dataclass(frozen=True)
class Options:
    """Of a watch."""

    learn: float = 600.0
    """s of the healthy machine that it learns from."""
    false_alarms_per_day: float = 0.5
    diagnose_after: float | None = 60.0
    """s since the onset, of rows, after which an alarm is diagnosed; None: never."""

    def check(self) -> None:
        """InputError for what cannot be."""
        if not self.learn >= LEAST * SEGMENT:
            raise InputError(
                f"--learn {self.learn:g}: {LEAST * SEGMENT:g} s at least tell how the readings of a healthy machine "
                "scatter; ten minutes (600) are good"
            )
        if self.learn > LONGEST:
            raise InputError(
                f"--learn {self.learn:g}: rows that are learned from are held in memory; write {LONGEST:g} at the most"
            )
        if not 0.0 < self.false_alarms_per_day <= 100.0:
            raise InputError(
                f"--false-alarms-per-day {self.false_alarms_per_day:g}: write more than 0, and 100 at the most"
            )
        if self.diagnose_after is not None and not 4 * SEGMENT <= self.diagnose_after <= 300.0:
            raise InputError(
                f"--diagnose-after {self.diagnose_after:g}: so many seconds of rows are diagnosed; write "
                f"{4 * SEGMENT:g} to 300"
            )


@dataclass(frozen=True)
class Status:
    """What is shown."""

    phase: Phase
    condition: str
    """Of the stream: "running", "gap", "silent", "bus fault: ...", ..."""
    time: float
    """s, of the newest row."""
    segments: int
    """Looked at."""
    learned: float
    """s of the healthy machine."""
    wanted: float
    waiting: int
    """Rows in the queue."""
    lost: int
    """Rows that were dropped."""
    late: bool
    tests: Sequence[str] = ()
    """Names of what is looked at, in the order of a look."""
    look: Look | None = None
    alarm: Alarm | None = None
    verdict: Verdict | None = None
    diagnosing: bool = False


@dataclass(eq=False)
class Watch:
    """One machine watched. It holds the rows of five minutes, and some of the healthy machine."""

    rig: Rig
    options: Options
    out: Path
    log: EventLog
    recorder: Recorder | None = None
    listeners: Sequence[Listener] = ()
    show: Callable[[Status], None] = lambda status: None
    on_look: Callable[[Look, Alarm | None], None] = lambda look, alarm: None
    """Called for each segment, with the alarm that stands."""
    progress: Progress = lambda text, done: None
    baseline: Baseline | None = None
    verdicts: list[Verdict] = field(default_factory=list)
    alarms: list[Alarm] = field(default_factory=list)
    """As they were raised; one that stands is refined in `judge`."""

    def __post_init__(self) -> None:
        self.segmenter = Segmenter()
        self.healthy: list[Segment] = []
        self.recent: deque[Segment] = deque(maxlen=LAGS[-1])
        self.judge: Judge | None = None
        self.condition, self.time, self.segments = "starting", 0.0, 0
        self.look: Look | None = None
        self._diagnosis: Diagnosis | None = None
        self._asked: set[int] = set()
        self._waiting, self._lost = 0, 0
        for source in self.rig.records:
            if source.role == "reference":
                record = load_record(self.rig, source)
                raise_if_unreadable(record, check_record(self.rig, record))
                found = Segmenter().push(record.signals)
                self.healthy += [s for s in found if isinstance(s, Segment)]
        self.from_reference = len(self.healthy)

    # ---- rows ------------------------------------------------------------------------------------

    def run(
        self, chunks: Iterable[Chunk], backlog: Callable[[], tuple[int, int]] = lambda: (0, 0)
    ) -> None:
        """Watch until the stream ends. backlog: rows that wait, and rows that were lost.

        InputError where it ends before the healthy machine is learned, or since it cannot be read.
        """
        if self.learned >= self.options.learn:
            self._learn()
        for chunk in chunks:
            self._waiting, lost = backlog()
            if lost > self._lost:
                self.log.write("late", {"time_s": self.time, "rows_lost": lost - self._lost})
                self._lost = lost
            if chunk.count:
                self.push(chunk.rows)
                continue
            self._state(chunk.condition, chunk.detail)
            if chunk.condition == "ended" and chunk.detail:
                raise InputError(chunk.detail)
        if self.recorder is not None:
            self.recorder.flush()
        if self.baseline is None:
            raise InputError(
                f"the stream ended after {self.learned:g} s of the healthy machine, and {self.options.learn:g} s are "
                "to be learned from; give more rows, or a shorter --learn"
            )

    def push(self, rows: Mapping[str, Array]) -> None:
        """More rows, signal -> (n,) in SI."""
        if self.recorder is not None:
            self.recorder.add(rows)
        for found in self.segmenter.push(rows):
            if isinstance(found, Interruption):
                self._interrupted(found)
            else:
                self._segment(found)
        times = rows["time"][np.isfinite(rows["time"])]
        self.time = float(times[-1]) if times.size else self.time
        if self.condition != "running" and times.size:
            self.condition = "running"
        self._show()

    def _state(self, condition: str, detail: str) -> None:
        if condition == "restarted":
            self.segmenter.cut()
        before, self.condition = self.condition, f"{condition}: {detail}" if detail else condition
        if self.condition != before:
            self.log.write("state", {"state": condition, "detail": detail, "time_s": self.time})
        self._collect()
        self._show()

    def _interrupted(self, found: Interruption) -> None:
        self.condition = found.cause
        told = {"state": found.cause, "time_s": found.time, "length_s": found.length}
        self.log.write("state", told)
        self._show()

    @property
    def learned(self) -> float:
        """s of the healthy machine."""
        return SEGMENT * len(self.healthy)

    def _segment(self, segment: Segment) -> None:
        if self.baseline is None:
            self.healthy.append(segment)
            if self.learned >= self.options.learn:
                self._learn()
            return
        self.segments += 1
        self.recent.append(segment)
        scores = self.baseline.innovations.of_segment(segment)
        if scores is None:
            self.condition = "clipped"
            return
        assert self.judge is not None
        before = self.judge.standing
        self.look = self.judge.detector.push(self.baseline.sums(scores))
        after = self.judge.judge(self.look)
        self.on_look(self.look, after)
        if before is None and after is not None:
            self.alarms.append(after)
            self._tell("alarm", after.to_dict())
        elif before is not None and after is None:
            self._tell("alarm_ended", {"alarm": before.number, "time_s": segment.end})
        if after is not None:
            self._ask(after, segment.end)
        self._collect()

    def _learn(self) -> None:
        self.condition = "learning"
        self._show()
        self.baseline = learn(self.rig, self.healthy, self.progress)
        self.judge = Judge(Detector(self.baseline, self.options.false_alarms_per_day))
        places = np.linspace(0, len(self.healthy) - 1, min(KEPT_HEALTHY, len(self.healthy)))
        told = {
            "begin_s": self.baseline.begin,
            "end_s": self.baseline.end,
            "segments": self.baseline.segments,
            "of_reference_records": self.from_reference,
            "tests": [t.name for t in self.baseline.tests],
            "not_watched": list(self.baseline.not_watched),
            "false_alarms_per_day": self.options.false_alarms_per_day,
        }
        # Of two in a row each, as an excerpt joins them.
        starts = sorted({int(k) // 2 * 2 for k in places})
        self.healthy = [s for k in starts for s in self.healthy[k : k + 2]]
        self.log.write("learned", told)

    # ---- alarms ----------------------------------------------------------------------------------

    def _tell(self, event: str, content: Mapping[str, Any]) -> None:
        line = self.log.write(event, content)
        for listener in self.listeners:
            if (problem := listener(event, content, line)) is not None:
                self.log.write("note", {"sentence": problem})

    def _ask(self, alarm: Alarm, now: float) -> None:
        after = self.options.diagnose_after
        if after is None or self._diagnosis is not None or alarm.number in self._asked:
            return
        if alarm.segments * SEGMENT < after:
            return
        self._asked.add(alarm.number)
        changed = [s for s in self.recent if s.begin >= alarm.since - 0.5 * SEGMENT]
        folder = self.out / f"alarm_{alarm.number:04d}"
        rig = write_excerpt(self.rig, folder, self.healthy, changed)
        if rig is None:
            self.log.write("note", {"sentence": "too few rows in a row for a diagnosis"})
            return
        self.log.write("refined", alarm.to_dict() | {"time_s": now})
        self._diagnosis = Diagnosis(alarm.number, rig)

    def _collect(self) -> None:
        if self._diagnosis is not None and (verdict := self._diagnosis.poll()) is not None:
            self._conclude(verdict)

    def _conclude(self, verdict: Verdict) -> None:
        self._diagnosis = None
        self.verdicts.append(verdict)
        self._tell("diagnosed", verdict.to_dict() | {"time_s": self.time})
        self._show()

    def finish(self) -> None:
        """Wait for a diagnosis that runs."""
        if self._diagnosis is not None:
            self.condition = "ended"
            self._show()
            self._conclude(self._diagnosis.wait())

    def close(self) -> None:
        """End what runs, write what is held."""
        if self._diagnosis is not None:
            self._diagnosis.stop()
        if self.recorder is not None:
            self.recorder.flush()
        self.log.close()

    @property
    def status(self) -> Status:
        """As it stands."""
        step = self.segmenter.step or 0.01
        return Status(
            "learning" if self.baseline is None else "watching",
            self.condition,
            self.time,
            self.segments,
            self.learned if self.baseline is None else self.baseline.segments * SEGMENT,
            self.options.learn,
            self._waiting,
            self._lost,
            self._waiting * step > LATE,
            () if self.baseline is None else [t.name for t in self.baseline.tests],
            self.look,
            None if self.judge is None else self.judge.standing,
            self.verdicts[-1] if self.verdicts else None,
            self._diagnosis is not None,
        )

    def _show(self) -> None:
        self.show(self.status)
