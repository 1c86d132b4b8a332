"""The file of a history: whole diagnoses only, whoever dies; and what is no history is refused, and left as it is."""

from __future__ import annotations

import json
import os
import signal
import sqlite3
import time
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from sms.errors import InputError
from sms.history import Answer, Machine, Store
from sms.history.store import APPLICATION, VERSION

from validation.trials.history import LEAK, drawn_answer, read

KILLED = 30


def answer(number: int, **more: object) -> Answer:
    return read(drawn_answer(np.random.default_rng(number), {LEAK: 9.0}, **more), f"a{number}")  # type: ignore[arg-type]


def adding(file: Path, seed: int, count: int) -> int:
    """The number of a process that adds so many diagnoses. A fork: it begins where everything is imported."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            for number in range(count):
                text = drawn_answer(np.random.default_rng([seed, number]), {})
                Store(file).add(read(text, f"{seed}-{number}"), "import")
            code = 0
        finally:
            os._exit(code)
    return child


def check_whole(file: Path) -> int:
    """How many diagnoses there are; each whole, with all that stands beside it."""
    answers = Store(file).answers()
    with sqlite3.connect(file) as connection:
        assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        if connection.execute("SELECT count(*) FROM sqlite_schema").fetchone() == (0,):
            # It ended before the first diagnosis; the tables come with that.
            assert not answers
            return 0
        rows = connection.execute(
            "SELECT json, (SELECT count(*) FROM estimate WHERE diagnosis = id), "
            "(SELECT count(*) FROM detection_limit WHERE diagnosis = id) FROM diagnosis"
        ).fetchall()
    for text, estimates, limits in rows:
        content = json.loads(text)
        assert estimates == len(content["causes"]) + len(content["baseline"])
        assert limits == len(content["still_hidden"])
    assert len(answers) == len(rows)
    return len(rows)


def test_killed_at_any_moment_the_file_holds_whole_diagnoses(tmp_path: Path) -> None:
    file = tmp_path / "machine.sqlite"
    rng = np.random.default_rng(7)
    counts = [0]
    for seed in range(KILLED):
        child = adding(file, seed, 100_000)
        time.sleep(float(rng.uniform(0.0, 0.1)))
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        counts.append(check_whole(file) if file.exists() else 0)
    assert counts == sorted(counts) and counts[-1] > KILLED
    assert Store(file).add(answer(1), "import") is None
    assert check_whole(file) == counts[-1] + 1


def test_several_processes_at_once_lose_nothing(tmp_path: Path) -> None:
    file = tmp_path / "machine.sqlite"
    children = [adding(file, seed, 40) for seed in (1, 2, 3)]
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0, 0]
    assert check_whole(file) == 120
    assert len({a.source for a in Store(file).answers()}) == 120


def test_the_same_diagnosis_twice_is_said_and_not_doubled(tmp_path: Path) -> None:
    store = Store(tmp_path / "machine.sqlite")
    first = answer(1)
    assert store.add(first, "diagnose") is None
    again = json.dumps(dict(reversed(json.loads(first.text).items())))  # laid out otherwise
    assert store.add(read(again), "import") == first.measured
    assert len(store.answers()) == 1


def test_the_file_says_what_it_is(tmp_path: Path) -> None:
    file = tmp_path / "machine.sqlite"
    Store(file).add(answer(1), "diagnose")
    with sqlite3.connect(file) as connection:
        assert connection.execute("PRAGMA application_id").fetchone() == (APPLICATION,)
        assert connection.execute("PRAGMA user_version").fetchone() == (VERSION,)
        assert connection.execute("PRAGMA journal_mode").fetchone() == ("delete",)
        meta = dict(connection.execute("SELECT key, value FROM meta"))
    assert meta == {"schema_version": str(VERSION), "title": "A drawn machine", "kind": "bench"}
    assert Store(file).machine() == Machine("A drawn machine", "bench")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["machine.sqlite"]


def test_they_come_in_the_order_of_measurement(tmp_path: Path) -> None:
    store = Store(tmp_path / "machine.sqlite")
    for number, day in enumerate(("2026-03-01", "2026-01-01", "2026-02-01T12:00:00+01:00")):
        store.add(answer(number, measured=datetime.fromisoformat(day)), "import")
    found = [a.measured.isoformat() for a in store.answers()]
    assert found == [
        "2026-01-01T00:00:00+00:00",
        "2026-02-01T11:00:00+00:00",
        "2026-03-01T00:00:00+00:00",
    ]


@pytest.mark.parametrize("key", ["title", "kind"])
def test_another_machine_is_refused_unless_it_is_named(tmp_path: Path, key: str) -> None:
    store = Store(tmp_path / "machine.sqlite")
    store.add(answer(1), "import")
    other = answer(2, **{key: "platform"})
    before = store.path.read_bytes()
    with pytest.raises(InputError, match='--machine "A drawn machine"'):
        store.add(other, "import")
    with pytest.raises(InputError, match="not of 'Another'"):
        store.add(other, "import", "Another")
    assert store.path.read_bytes() == before
    assert store.add(other, "import", "A drawn machine") is None
    assert len(store.answers()) == 2


def foreign(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE song (title TEXT)")


def newer(path: Path) -> None:
    Store(path).add(answer(1), "import")
    with sqlite3.connect(path) as connection:
        connection.execute(f"PRAGMA user_version = {VERSION + 1}")


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda path: path.write_text("title = 1\n"), "not an SQLite file"),
        (lambda path: path.write_bytes(b"x"), "not an SQLite file"),
        (foreign, "another program"),
        (newer, "use a newer sms"),
    ],
)
def test_what_is_no_history_is_refused_and_stays(tmp_path: Path, make: object, words: str) -> None:
    path = tmp_path / "machine.sqlite"
    make(path)  # type: ignore[operator]
    before = path.read_bytes()
    store = Store(path)
    for call in (lambda: store.add(answer(1), "import"), store.answers, store.machine):
        with pytest.raises(InputError, match=words):
            call()
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["machine.sqlite"]


def test_a_file_that_a_killed_process_left_empty_is_begun(tmp_path: Path) -> None:
    path = tmp_path / "machine.sqlite"
    path.touch()
    assert Store(path).machine() is None
    assert Store(path).add(answer(1), "import") is None
    assert check_whole(path) == 1
