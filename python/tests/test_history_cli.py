"""`sms history`, `sms compare-diagnoses` and `sms diagnose --history` at the prompt."""

from __future__ import annotations

import json
import os
import re
import sqlite3
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from cli_support import sms
from plant_support import LEAK as BENCH_LEAK
from plant_support import with_known_map, write_bench
from sms.history import read_answer
from sms.history.course import courses_of
from sms.history.declared import changes
from sms.io.json_files import SCHEMA_VERSIONS
from test_cli_diagnose import refused
from test_diagnosis_cylinder import make_rig

from validation.trials.history import BEGIN, LEAK, as_files, drawn_answer


@pytest.fixture
def growing(tmp_path: Path) -> Path:
    """A folder with twelve diagnoses, of which the leak grows from the sixth on."""
    rng = np.random.default_rng(5)
    texts = []
    for number in range(12):
        declared = {"parameters": {"moving_mass": {"value": 3.6 if number < 6 else 3.7}}}
        leak = 3.0 * max(number - 4, 0)
        when = BEGIN + timedelta(days=30.4 * number)
        texts.append(
            drawn_answer(rng, {LEAK: leak, "piston_leakage": 30.0}, when, declared=declared)
        )
    as_files(texts, tmp_path / "reports")
    return tmp_path


def test_a_history_is_filled_shown_and_written(growing: Path) -> None:
    told = sms(
        *("history", "m.sqlite", "--add", "reports", "--out", "page", "--json", "h.json"),
        *("--limit", f"{LEAK}=1e-9 kg/(s Pa)"),
        cwd=growing,
    )
    assert told.returncode == 0, told.stderr
    assert told.stdout.count("added to m.sqlite") == 12
    for words in (
        "Fitting leakage appeared",
        "grows by",
        "reaches 0.100 g/s per bar on about 2027",
    ):
        assert words in " ".join(told.stdout.split())
    content = json.loads((growing / "h.json").read_text())
    assert content["schema"] == "sms.history"
    assert content["schema_version"] == SCHEMA_VERSIONS["history"]
    leak = next(c for c in content["courses"] if c["parameter"] == LEAK)
    assert leak["grows"] and abs(leak["onset"][0] - 5) <= 2
    seal = next(c for c in content["courses"] if c["parameter"] == "piston_leakage")
    assert not (seal["grows"] or seal["moves"] or seal["changed"])
    changed = [d["changed_in_rig_file"] for d in content["diagnoses"]]
    assert [len(c) for c in changed] == [0] * 6 + [1] + [0] * 5
    assert "3.6" in changed[6][0] and "3.7" in changed[6][0]
    page = (growing / "page" / "history.html").read_text()
    assert "A drawn machine" in page and "Causes over time" in page and "<script src" not in page
    again = sms("history", "m.sqlite", "--add", "reports", "--out", "page", cwd=growing)
    assert again.stdout.count("not added again") == 12


def test_what_its_owner_wrote_is_escaped_on_the_page(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    title = "<script>alert(1)</script> [red]"
    texts = [drawn_answer(rng, {LEAK: 30.0}, title=title) for _ in range(2)]
    as_files(texts, tmp_path / "reports")
    told = sms("history", "m.sqlite", "--add", "reports", cwd=tmp_path)
    assert told.returncode == 0, told.stderr
    assert "[red]" in told.stdout
    assert "<script>alert" not in (tmp_path / "history" / "history.html").read_text()


def test_older_files_are_read_with_a_sentence_for_what_they_lack(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    for number in range(2):
        content = json.loads(drawn_answer(rng, {}))
        for key in ("schema", "schema_version", "kind", "measured", "measured_from", "declared"):
            del content[key]
        file = tmp_path / f"{number}.json"
        file.write_text(json.dumps(content))
        os.utime(file, (1.7e9 + 86400.0 * number,) * 2)
    told = sms("history", "m.sqlite", "--add", "0.json", "--add", "1.json", cwd=tmp_path)
    assert told.returncode == 0, told.stderr
    said = " ".join(told.stdout.split())
    assert "measured on 2023-11-14 (modification of the file diagnosis.json)" in said
    for words in (
        "does not say when",
        "does not say of what kind",
        "does not hold what its rig file",
    ):
        assert words in said
    dated = sms(
        *("history", "n.sqlite", "--add", "0.json", "--measured", "2024-02-03"), cwd=tmp_path
    )
    said = " ".join(dated.stdout.split())
    assert "measured on 2024-02-03 (stated)" in said and "does not say when" not in said


def spoilt(change: Callable[[dict[str, object]], object]) -> str:
    content = json.loads(drawn_answer(np.random.default_rng(3), {LEAK: 30.0}))
    change(content)
    return json.dumps(content)


BAD = {
    "no causes": (spoilt(lambda c: c.pop("causes")), "the key 'causes' is missing"),
    "cut off": (drawn_answer(np.random.default_rng(3), {})[:300], "not valid JSON"),
    "empty": ("", "not valid JSON"),
    "NaN": (spoilt(lambda c: c.update(seed=float("nan"))), "it holds NaN"),
    "a list": ("[1]", "not a JSON object"),
    "another file of sms": (spoilt(lambda c: c.update(schema="sms.run")), "this is sms.run"),
    "a newer one": (spoilt(lambda c: c.update(schema_version=9)), "schema_version is 9"),
    "causes of another shape": (spoilt(lambda c: c.update(causes=[1])), "not laid out"),
    "a size in words": (
        spoilt(lambda c: c["baseline"][0].update(value="much")),  # type: ignore[index]
        "is not a number",
    ),
    "a time that is none": (spoilt(lambda c: c.update(measured="soon")), "not laid out"),
    "no text": ("\udcff", "not a text in UTF-8"),
    "deep": ("[" * 100_000, "not JSON that can be read"),
}


@pytest.mark.parametrize("kind", BAD)
def test_bad_input_is_one_sentence_and_nothing_is_changed(tmp_path: Path, kind: str) -> None:
    text, words = BAD[kind]
    good, bad = tmp_path / "good.json", tmp_path / "bad.json"
    good.write_text(drawn_answer(np.random.default_rng(4), {}))
    bad.write_text(text, encoding="utf-8", errors="surrogateescape")
    refused(
        sms("history", "m.sqlite", "--add", "good.json", "--add", "bad.json", cwd=tmp_path),
        "bad.json",
        words,
    )
    refused(sms("compare-diagnoses", "good.json", "bad.json", cwd=tmp_path), "bad.json", words)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.json", "good.json"]


def test_files_that_are_no_history_and_options_that_say_nothing(tmp_path: Path) -> None:
    good = tmp_path / "good.json"
    good.write_text(drawn_answer(np.random.default_rng(4), {LEAK: 30.0}))
    (tmp_path / "text.sqlite").write_text("something else")
    (tmp_path / "empty").mkdir()
    with sqlite3.connect(tmp_path / "foreign.sqlite") as connection:
        connection.execute("CREATE TABLE song (title TEXT)")
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir() if p.is_file()}
    add = ("--add", "good.json")
    refused(sms("history", "text.sqlite", *add, cwd=tmp_path), "not an SQLite file")
    refused(sms("history", "foreign.sqlite", *add, cwd=tmp_path), "another program")
    refused(sms("history", "missing.sqlite", cwd=tmp_path), "there is no such history")
    refused(sms("history", "no/m.sqlite", *add, cwd=tmp_path), "there is no such folder")
    refused(sms("history", "m.sqlite", "--add", "empty", cwd=tmp_path), "no diagnosis.json")
    refused(sms("history", "m.sqlite", "--add", "gone.json", cwd=tmp_path), "no such file")
    refused(sms("history", "m.sqlite", *add, "--measured", "soon", cwd=tmp_path), "not a date")
    refused(sms("history", "m.sqlite", *add, "--limit", "leak", cwd=tmp_path), "PARAMETER=SIZE")
    refused(sms("history", "m.sqlite", "--machine", "A", cwd=tmp_path), "--add")
    refused(sms("diagnose", "rig.toml", "--machine", "A", cwd=tmp_path), "--history")
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir() if p.is_file()} == before


def test_another_machine_is_refused_and_nothing_of_its_company_is_added(tmp_path: Path) -> None:
    rng = np.random.default_rng(6)
    texts = [drawn_answer(rng, {}), drawn_answer(rng, {}, title="Another machine")]
    as_files(texts, tmp_path / "reports")
    refused(
        sms("history", "m.sqlite", "--add", "reports", cwd=tmp_path), "Another machine", "--machine"
    )
    assert not (tmp_path / "m.sqlite").exists()
    told = sms(
        *("history", "m.sqlite", "--add", "reports", "--machine", "A drawn machine"), cwd=tmp_path
    )
    assert told.returncode == 0 and told.stdout.count("added to") == 2


def test_two_diagnoses_are_compared(growing: Path) -> None:
    first, last = (f"reports/{n:02d}/diagnosis.json" for n in (0, 11))
    told = sms("compare-diagnoses", first, last, "--json", "c.json", cwd=growing)
    assert told.returncode == 0, told.stderr
    assert told.stdout.startswith("Changed: fitting leakage")
    content = json.loads((growing / "c.json").read_text())
    assert content["schema"] == "sms.diagnosis_comparison" and len(content["inputs"]) == 2
    changes = {i["parameter"]: i["change"] for i in content["items"]}
    assert changes == {LEAK: "changed", "piston_leakage": "unchanged"}
    same = sms("compare-diagnoses", first, first, cwd=growing)
    assert "Nothing changed" in same.stdout


@pytest.mark.parametrize("verdict", ["unknown", "data-fault"])
def test_of_a_verdict_without_causes_nothing_is_told(tmp_path: Path, verdict: str) -> None:
    rng = np.random.default_rng(8)
    texts = [drawn_answer(rng, {LEAK: 30.0}), drawn_answer(rng, {}, verdict=verdict, causes=[])]
    a, b = as_files(texts, tmp_path)
    told = sms("compare-diagnoses", str(a), str(b), cwd=tmp_path)
    said = " ".join(told.stdout.split())
    assert "cannot be told" in said and f"verdict is {verdict}" in said
    told = sms("compare-diagnoses", str(b), str(b), cwd=tmp_path)
    assert "Nothing can be compared" in told.stdout


def test_a_cylinder_is_diagnosed_into_its_history(tmp_path: Path) -> None:
    rig = make_rig(tmp_path, pressure_friction=3e-6)
    for file in tmp_path.glob("*.csv"):
        os.utime(file, (1.75e9, 1.75e9))
    once = sms("diagnose", rig.name, "--history", "m.sqlite", cwd=tmp_path)
    assert once.returncode == 0, once.stderr
    day = datetime.fromtimestamp(1.75e9, UTC).date()
    said = " ".join(once.stdout.split())
    assert f"measured on {day} (modification of the records)" in said
    again = sms(
        "diagnose", rig.name, "--history", "m.sqlite", "--measured", "2026-01-02", cwd=tmp_path
    )
    assert "not added again" in again.stdout
    found = json.loads((tmp_path / "diagnosis" / "diagnosis.json").read_text())
    assert (found["measured"], found["measured_from"]) == ("2026-01-02", "stated")
    assert found["kind"] == "cylinder" and "coulomb_force" in found["declared"]["parameters"]
    text = re.sub("title = .*", 'title = "Another"', rig.read_text(), count=1)
    rig.write_text(text)
    refused(sms("diagnose", rig.name, "--history", "m.sqlite", cwd=tmp_path), "--machine")


@pytest.mark.full
def test_a_leak_that_grows_on_a_bench_is_followed(tmp_path: Path) -> None:
    """Simulated records through the whole command: healthy, a leak, twice that leak."""
    for number, leak in enumerate((0.0, BENCH_LEAK, 2.0 * BENCH_LEAK)):
        folder = tmp_path / f"{number}"
        folder.mkdir()
        rig = write_bench(folder, 10 + number, {"piston_leakage": leak} if leak else {})
        rig = with_known_map(rig)
        text = rig.read_text()
        assert "[rig]" in text
        rig.write_text(text.replace("[rig]", f"[rig]\nmeasured = 2026-0{number + 1}-15", 1))
        told = sms(
            *(
                "diagnose",
                str(rig),
                "--out",
                f"out{number}",
                "--history",
                "m.sqlite",
                "--threads",
                "1",
            ),
            cwd=tmp_path,
        )
        assert told.returncode == 0, told.stderr
    shown = sms("history", "m.sqlite", "--json", "h.json", cwd=tmp_path)
    assert shown.returncode == 0, shown.stderr
    content = json.loads((tmp_path / "h.json").read_text())
    verdicts = [d["verdict"] for d in content["diagnoses"]]
    assert verdicts == ["no-evidence", "cause", "cause"]
    (leak_course,) = [c for c in content["courses"] if c["about"] == "cause"]
    assert leak_course["parameter"] == "piston_leakage" and leak_course["appeared"]
    pair = sms("compare-diagnoses", "out1/diagnosis.json", "out2/diagnosis.json", cwd=tmp_path)
    assert pair.stdout.startswith("Changed: ")
    assert sms(
        "compare-diagnoses", "out0/diagnosis.json", "out2/diagnosis.json", cwd=tmp_path
    ).stdout.startswith("Changed")


def test_a_leak_is_followed_from_before_it_is_large_enough_to_be_named() -> None:
    rng = np.random.default_rng(11)
    answers = []
    for number in range(12):
        truth = {LEAK: 8.0 * max(number - 3, 0)}
        when = BEGIN + timedelta(days=30.4 * number)
        text = drawn_answer(rng, truth, when, named_from=30.0)
        answers.append(read_answer(text, f"{number}", BEGIN))
    (leak,) = (c for c in courses_of(answers, {}) if c.parameter == LEAK)
    assert leak.first_named is not None and leak.first_named >= 7
    assert leak.grows and leak.onset is not None
    assert abs(leak.onset[0].number - 4) <= 1


def test_what_went_away_is_told_by_its_estimate() -> None:
    rng = np.random.default_rng(12)
    answers = [
        read_answer(drawn_answer(rng, {LEAK: size}, BEGIN, named_from=30.0), f"{number}", BEGIN)
        for number, size in enumerate((0.0, 33.0, 0.0))
    ]
    (leak,) = courses_of(answers, {})[:1]
    assert leak.appeared and leak.went_away


def test_diagnoses_of_one_day_are_told_apart_by_the_time(tmp_path: Path) -> None:
    rng = np.random.default_rng(13)
    moments = (BEGIN, BEGIN + timedelta(days=1), BEGIN + timedelta(days=1, hours=2, minutes=5))
    texts = [
        drawn_answer(rng, {LEAK: size}, moment)
        for moment, size in zip(moments, (0.0, 30.0, 0.0), strict=True)
    ]
    as_files(texts, tmp_path / "reports")
    told = " ".join(sms("history", "m.sqlite", "--add", "reports", cwd=tmp_path).stdout.split())
    assert "2026-01-15 " in told and "2026-01-15 00:00" not in told
    assert "first named in the diagnosis of 2026-01-16 00:00." in told
    assert "the diagnosis of 2026-01-16 02:05 would have shown it." in told


def test_a_column_that_is_named_with_its_unit_is_no_change_of_the_rig_file() -> None:
    rng = np.random.default_rng(14)
    written = ({"column": "pressure [Pa]", "unit": None}, {"column": "pressure", "unit": "Pa"})
    other = {"column": "pressure", "unit": "bar"}
    answers = [
        read_answer(
            drawn_answer(rng, {}, declared={"signals": {"tank_pressure": source}}), "a", BEGIN
        )
        for source in (*written, other)
    ]
    assert changes(answers[0], answers[1]) == []
    assert changes(answers[1], answers[2]) == ["[signals] tank_pressure unit: Pa → bar"]
