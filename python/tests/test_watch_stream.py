"""Rows on their way to the watch: segments, states, files that grow, a queue that is bounded."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np
import pytest
from plant_support import write_bench
from sms.errors import InputError
from sms.io.records import load_record
from sms.io.rig import Rig, load_rig
from sms.watch.feed import Chunk, Feed
from sms.watch.recorder import PIECE, Recorder
from sms.watch.segments import RUN_UP, SEGMENT, Interruption, Segment, Segmenter
from sms.watch.source import follow, play

from validation.random_cases import draw

STEP = 0.01


def rows(begin: float, seconds: float) -> dict[str, np.ndarray]:
    time = begin + STEP * np.arange(round(seconds / STEP))
    return {"time": time, "extension": np.sin(time)}


def test_segments_follow_each_other_whatever_the_chunks_are() -> None:
    rng = draw("chunks of a stream")
    whole = rows(3.0, 33.0)
    cuts = np.sort(rng.integers(0, whole["time"].size, 60))
    segmenter, found = Segmenter(), []
    for part in np.split(np.arange(whole["time"].size), cuts):
        found += list(segmenter.push({n: v[part] for n, v in whole.items()}))
    assert len(found) == 6
    for number, segment in enumerate(found):
        assert isinstance(segment, Segment)
        assert segment.begin == pytest.approx(3.0 + RUN_UP + SEGMENT * number)
        assert segment.end == pytest.approx(segment.begin + SEGMENT)
        assert np.array_equal(segment.signals["extension"], np.sin(segment.signals["time"]))
    assert sum(v.size for v in segmenter._held.values()) < 2 * (SEGMENT + RUN_UP + 1.0) / STEP


def test_a_gap_a_restart_and_cells_that_are_no_numbers_are_states() -> None:
    segmenter = Segmenter()
    assert [type(f) for f in segmenter.push(rows(0.0, 6.0))] == [Segment]
    gap = list(segmenter.push(rows(9.0, 6.0)))
    assert [type(f) for f in gap] == [Interruption, Segment]
    assert gap[0] == Interruption("gap", pytest.approx(5.99), pytest.approx(3.01))
    assert isinstance(gap[1], Segment)
    assert gap[1].begin == pytest.approx(9.0 + RUN_UP)
    restarted = list(segmenter.push(rows(1.0, 4.0)))
    assert [f.cause for f in restarted if isinstance(f, Interruption)] == ["restarted"]
    spoilt = rows(5.0, 10.0)
    spoilt["extension"][200:300] = np.nan
    found = list(segmenter.push(spoilt))
    assert [f.cause for f in found if isinstance(f, Interruption)] == ["unreadable"]
    assert all(np.isfinite(f.signals["extension"]).all() for f in found if isinstance(f, Segment))


def test_rows_that_are_there_twice_count_once_and_a_fast_log_is_thinned() -> None:
    segmenter = Segmenter()
    first = rows(0.0, 3.0)
    again = {n: np.concatenate([v, v[-1:]]) for n, v in first.items()}
    list(segmenter.push(again))
    (segment,) = segmenter.push(rows(3.0, 3.0))
    assert isinstance(segment, Segment)
    assert np.allclose(np.diff(segment.signals["time"]), STEP)
    fast = Segmenter()
    time = 1e-4 * np.arange(60_000)
    (thin,) = fast.push({"time": time, "extension": time})
    assert isinstance(thin, Segment)
    assert np.allclose(np.diff(thin.signals["time"]), 1e-3)


def test_a_time_in_milliseconds_is_refused() -> None:
    with pytest.raises(InputError, match="unit of the column of time"):
        list(Segmenter().push({"time": 1e3 * np.arange(30.0), "extension": np.zeros(30)}))


# ---- files -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Rig:
    return load_rig(write_bench(tmp_path_factory.mktemp("watched"), 3, {}))


def test_a_played_record_is_the_record(rig: Rig) -> None:
    source = rig.records[0]
    whole = load_record(rig, source)
    chunks = list(play(rig, [source.file]))
    assert chunks[-1].condition == "ended"
    for name, values in whole.signals.items():
        told = np.concatenate([c.rows[name] for c in chunks if c.count])
        assert np.array_equal(told, values), name


def test_what_cannot_be_played_or_followed_is_one_sentence(rig: Rig, tmp_path: Path) -> None:
    stop = threading.Event()
    with pytest.raises(InputError, match="no such file"):
        play(rig, [tmp_path / "gone.csv"])
    with pytest.raises(InputError, match="backwards"):
        play(rig, [rig.records[0].file], -1.0)
    with pytest.raises(InputError, match="start the logger first"):
        follow(rig, tmp_path / "gone.csv", Feed(), stop)
    (tmp_path / "log.parquet").write_bytes(b"PAR1")
    with pytest.raises(InputError, match="can be followed"):
        follow(rig, tmp_path / "log.parquet", Feed(), stop)
    other = tmp_path / "other.csv"
    other.write_text("time [s],pressure [Pa]\n0,1\n1,2\n")
    with pytest.raises(InputError, match="valve_command"):
        list(play(rig, [other]))


def test_a_file_is_followed_while_it_grows(rig: Rig, tmp_path: Path) -> None:
    text = rig.records[0].file.read_text()
    lines = text.splitlines(keepends=True)
    file, feed, stop = tmp_path / "log.csv", Feed(), threading.Event()
    half = len("".join(lines[:200])) + 7  # in the middle of a line
    file.write_text(text[:half])
    follow(rig, file, feed, stop)
    taken = [feed.take(5.0)]
    with file.open("a") as log:
        log.write(text[half:])
        log.write("this is, no line, of it\n")
    wanted = len(lines) - 1 + 1
    end = time.monotonic() + 30.0
    while sum(c.count for c in taken if c) < wanted and time.monotonic() < end:
        taken.append(feed.take(1.0))
    stop.set()
    whole = load_record(rig, rig.records[0])
    told = np.concatenate([c.rows["extension"] for c in taken if c and c.count])
    assert np.array_equal(told[:-1], whole.signals["extension"])
    assert np.isnan(told[-1])


def test_a_file_that_begins_anew_is_read_from_its_beginning(rig: Rig, tmp_path: Path) -> None:
    text = rig.records[0].file.read_text()
    file, feed, stop = tmp_path / "log.csv", Feed(), threading.Event()
    file.write_text(text)
    follow(rig, file, feed, stop)
    count = text.count("\n") - 1
    got = 0
    while got < count:
        chunk = feed.take(5.0)
        assert chunk is not None
        got += chunk.count
    file.write_text("".join(text.splitlines(keepends=True)[:50]))
    chunk = feed.take(10.0)
    stop.set()
    assert chunk is not None
    assert chunk.count == 49


# ---- what is bounded -------------------------------------------------------------------------------


def test_a_queue_holds_no_more_than_it_may_and_counts_what_it_lost() -> None:
    feed = Feed(most_rows=1000)
    for k in range(100):
        feed.put(Chunk(rows(k, 1.0)))
        assert feed.waiting <= 1000
    assert feed.lost == 100 * 100 - 1000
    first = feed.take(0.0)
    assert first is not None
    assert first.rows["time"][0] == 90.0
    segmenter = Segmenter()
    list(segmenter.push(rows(0.0, 3.0)))
    found = list(segmenter.push(first.rows))
    assert [f.cause for f in found if isinstance(f, Interruption)] == ["gap"]


def test_a_file_waits_for_room_and_loses_nothing() -> None:
    feed, stop = Feed(most_rows=1000), threading.Event()

    def write() -> None:
        for k in range(30):
            feed.put_when_there_is_room(Chunk(rows(k, 1.0)), stop)
        feed.put(Chunk(condition="ended"))

    writer = threading.Thread(target=write)
    writer.start()
    begins = []
    for chunk in feed.chunks():
        assert feed.waiting <= 1000
        begins += [float(chunk.rows["time"][0])] if chunk.count else []
    writer.join()
    assert begins == [float(k) for k in range(30)]
    assert feed.lost == 0


def test_a_silent_stream_says_so_until_rows_come() -> None:
    feed = Feed()
    chunks = feed.chunks()
    assert [next(chunks).condition for _ in range(2)] == ["silent", "silent"]
    feed.put(Chunk(rows(0.0, 1.0)))
    assert next(chunks).count == 100
    feed.put(Chunk(condition="ended"))
    assert next(chunks).condition == "ended"
    assert next(chunks, None) is None


def test_rows_are_kept_for_so_many_hours(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path, 0.5)
    for k in range(300):
        recorder.add(rows(20.0 * k, 20.0))
    recorder.flush()
    files = sorted(tmp_path.iterdir())
    assert len(files) == round(0.5 * 3600.0 / PIECE)
    assert files == recorder.written
    with pytest.raises(InputError, match="more than 0"):
        Recorder(tmp_path, -1.0)
