"""The diagnoses of one machine in one SQLite file, which several processes may open and any may die at.

A rollback journal, not a write-ahead log: what is written is small and rare, the history stays one file that can be
copied or lie on a network share (a write-ahead log has two more beside it, and shared memory). One transaction a
diagnosis, begun as a writer (BEGIN IMMEDIATE), so that two processes wait for each other instead of failing; killed
within it, the next process that opens the file rolls it back. Whoever finds the file locked waits `BUSY` seconds.

The file says that it is one of these (application_id) and in which version (user_version, and schema_version in
`meta`). The whole diagnosis.json is kept; the columns beside it are for queries of one's own, and are never read back.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Literal

from sms.errors import InputError
from sms.history.answer import Answer, read_answer
from sms.io.measured import moment

APPLICATION = 0x534D5348
"""PRAGMA application_id of a history, "SMSH"."""
VERSION = 1
"""Of the tables. Grows when a table is added or changed; an older file is then brought to it when it is opened."""
BUSY = 30.0
"""s for which a locked file is waited for: some thousand diagnoses are added in it."""
LEAST = 512
"""Bytes: the smallest page that an SQLite file can have."""
Origin = Literal["diagnose", "import", "watch"]
_TABLES = (
    "CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    """CREATE TABLE diagnosis (
        id INTEGER PRIMARY KEY,
        digest TEXT NOT NULL UNIQUE,        -- SHA-256 of what the JSON says, but for the time of measurement
        measured TEXT NOT NULL,             -- ISO 8601, UTC
        measured_from TEXT NOT NULL,        -- stated, or whose modification it is
        added TEXT NOT NULL,                -- ISO 8601, UTC
        origin TEXT NOT NULL,               -- diagnose, import, watch
        source TEXT NOT NULL,               -- the file it is from
        title TEXT NOT NULL,
        kind TEXT NOT NULL,
        verdict TEXT NOT NULL,
        sentence TEXT NOT NULL,
        json TEXT NOT NULL)                 -- the whole diagnosis.json""",
    """CREATE TABLE estimate (
        diagnosis INTEGER NOT NULL REFERENCES diagnosis (id),
        cause INTEGER,                      -- number of the cause; NULL: the declared model's fit
        member INTEGER,                     -- number within its class
        effect TEXT, signal TEXT,
        parameter TEXT NOT NULL,
        unit TEXT NOT NULL,
        value REAL, standard_error REAL, neutral REAL)""",
    """CREATE TABLE detection_limit (
        diagnosis INTEGER NOT NULL REFERENCES diagnosis (id),
        effect TEXT NOT NULL,
        size REAL)                          -- shift from which the records would have shown it""",
    "CREATE INDEX estimate_of ON estimate (diagnosis)",
    "CREATE INDEX limit_of ON detection_limit (diagnosis)",
)


@dataclass(frozen=True)
class Machine:
    """Whose history it is."""

    title: str
    kind: str
    """Empty where the first diagnosis did not say it."""


class Store:
    """A history on disk. Each call opens the file, does one thing in one transaction, and closes it."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def check(self, title: str, kind: str, machine: str | None = None) -> None:
        """InputError, before any work, where a diagnosis of this machine could not be added."""
        if not self.path.parent.is_dir():
            raise InputError(f"{self.path}: there is no such folder; make it, or choose another")
        if (known := self.machine()) is not None:
            self._refuse_another(known, title, kind, machine)

    def check_all(self, answers: Sequence[Answer], machine: str | None = None) -> None:
        """The same for several, which are also to be of one machine."""
        if not answers:
            return
        first = answers[0]
        self.check(first.title, first.kind, machine)
        known = self.machine() or Machine(machine or first.title, first.kind)
        for answer in answers:
            self._refuse_another(known, answer.title, answer.kind, machine)

    def machine(self) -> Machine | None:
        """Whose history it is; None where there is none yet. InputError where the file is no history."""
        if not self.path.exists():
            return None
        with self._opened() as connection:
            return _machine(connection)

    def add(self, answer: Answer, origin: Origin, machine: str | None = None) -> datetime | None:
        """Add one diagnosis. Of one that is there already, the time at which it was measured; else None.

        machine: a name by which whoever adds it says that it is this machine, whatever its title. InputError, and
        nothing is changed, for another machine.
        """
        with self._opened(to_write=True) as connection:
            known = _machine(connection)
            if known is None:
                _create(connection, machine or answer.title, answer.kind)
            else:
                self._refuse_another(known, answer.title, answer.kind, machine)
                if answer.kind and not known.kind and machine is None:
                    connection.execute(
                        "UPDATE meta SET value = ? WHERE key = 'kind'", [answer.kind]
                    )
            row = connection.execute(
                "SELECT measured FROM diagnosis WHERE digest = ?", [answer.digest]
            ).fetchone()
            if row is not None:
                return moment(str(row[0]))
            _insert(connection, answer, origin)
        return None

    def answers(self) -> list[Answer]:
        """Every diagnosis in the order of measurement, whole. InputError where the file is no history."""
        if not self.path.exists():
            raise InputError(
                f"{self.path}: there is no such history; sms diagnose RIG.toml --history {self.path} begins one"
            )
        with self._opened() as connection:
            if _machine(connection) is None:
                return []
            rows = connection.execute(
                "SELECT json, source, measured, measured_from FROM diagnosis ORDER BY measured, id"
            ).fetchall()
        return [
            _with_time(read_answer(text, source, moment(measured)), measured, origin)
            for text, source, measured, origin in rows
        ]

    def _refuse_another(self, known: Machine, title: str, kind: str, machine: str | None) -> None:
        if machine is not None:
            if machine != known.title:
                raise InputError(
                    f"{self.path}: this is the history of '{known.title}', not of '{machine}'; name that one, or "
                    "another file"
                )
            return
        other = title != known.title, bool(kind and known.kind and kind != known.kind)
        if any(other):
            word = f"'{title}'" + (f", a {kind}" if other[1] else "")
            of = f"'{known.title}'" + (f", a {known.kind}" if other[1] else "")
            raise InputError(
                f"{self.path}: this is the history of {of}, and the diagnosis is of {word}; choose another file, or "
                f'say that it is the same with --machine "{known.title}"'
            )

    @contextmanager
    def _opened(self, to_write: bool = False) -> Iterator[sqlite3.Connection]:
        """One transaction on a file that is a history, or empty where it may be begun: all of it or nothing."""
        location = f"{self.path.absolute().as_uri()}?mode={'rwc' if to_write else 'rw'}"
        try:
            with closing(
                sqlite3.connect(location, uri=True, timeout=BUSY, isolation_level=None)
            ) as connection:
                connection.execute("PRAGMA foreign_keys = ON")
                connection.execute("BEGIN IMMEDIATE" if to_write else "BEGIN")
                try:
                    self._check_is_one(connection)
                    yield connection
                except BaseException:
                    connection.execute("ROLLBACK")
                    raise
                connection.execute("COMMIT")
        except sqlite3.Error as problem:
            raise InputError(f"{self.path}: {_in_words(problem)}") from None

    def _check_is_one(self, connection: sqlite3.Connection) -> None:
        application, version, tables = (
            int(connection.execute(query).fetchone()[0])
            for query in (
                "PRAGMA application_id",
                "PRAGMA user_version",
                "SELECT count(*) FROM sqlite_master",
            )
        )
        if 0 < self.path.stat().st_size < LEAST:
            raise sqlite3.DatabaseError("file is not a database")  # which SQLite would overwrite
        if tables == 0 and application == 0:
            return  # nobody's yet, as a process leaves it that was killed before its first diagnosis
        if application != APPLICATION:
            raise InputError(
                f"{self.path}: an SQLite file of another program, not a history of sms; choose another file"
            )
        if version > VERSION:
            raise InputError(
                f"{self.path}: a history of version {version}, and this sms knows {VERSION}; use a newer sms"
            )


def _create(connection: sqlite3.Connection, title: str, kind: str) -> None:
    for table in _TABLES:
        connection.execute(table)
    connection.executemany(
        "INSERT INTO meta VALUES (?, ?)",
        [("schema_version", str(VERSION)), ("title", title), ("kind", kind)],
    )
    connection.execute(f"PRAGMA application_id = {APPLICATION}")
    connection.execute(f"PRAGMA user_version = {VERSION}")


def _machine(connection: sqlite3.Connection) -> Machine | None:
    if int(connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]) == 0:
        return None
    meta = dict(connection.execute("SELECT key, value FROM meta").fetchall())
    return Machine(str(meta["title"]), str(meta["kind"]))


def _insert(connection: sqlite3.Connection, answer: Answer, origin: Origin) -> None:
    now = datetime.now(UTC).isoformat(timespec="seconds")
    measured = answer.measured.astimezone(UTC).isoformat(timespec="microseconds")
    number = connection.execute(
        "INSERT INTO diagnosis (digest, measured, measured_from, added, origin, source, title, kind, verdict, "
        "sentence, json) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        [
            answer.digest, measured, answer.measured_from, now, origin, answer.source, answer.title,
            answer.kind, answer.verdict, answer.sentence, answer.text,
        ],
    ).lastrowid  # fmt: skip
    rows: list[tuple[object, ...]] = [
        (number, cause, member, e.effect, e.signal, p.parameter, p.unit, p.value, p.standard_error, p.neutral)
        for cause, members in enumerate(answer.causes)
        for member, e in enumerate(members)
        for p in e.estimates
    ]  # fmt: skip
    rows += [
        (number, None, None, None, None, p.parameter, p.unit, p.value, p.standard_error, p.neutral)
        for p in answer.model
    ]
    connection.executemany("INSERT INTO estimate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", rows)
    connection.executemany(
        "INSERT INTO detection_limit VALUES (?, ?, ?)",
        [(number, effect, size) for effect, size in answer.limits.items()],
    )


def _with_time(answer: Answer, measured: str, origin: str) -> Answer:
    """As it was added: the time may have been said by an option."""
    return replace(answer, measured=moment(measured), measured_from=origin)


def _in_words(problem: sqlite3.Error) -> str:
    text = str(problem)
    if "not a database" in text:
        return "not an SQLite file, and so no history of sms; choose another file"
    if "locked" in text or "busy" in text:
        return f"another process has held it for {BUSY:.0f} s; try again when that has ended"
    if "malformed" in text or "no such" in text or isinstance(problem, sqlite3.IntegrityError):
        return f"damaged ({text}); take a copy of before, or begin another and add the diagnosis.json again"
    return (
        f"cannot be used as a history ({text}); check the path, its rights and the room on the disk"
    )
