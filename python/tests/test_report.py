"""The page and the console table: complete, self-contained, and unshaken by what is missing."""

from __future__ import annotations

import base64
import gzip
import hashlib
import io
import json
import re
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from plotly.offline import get_plotlyjs
from report_support import VERDICTS, cylinder_series, diagnosis, emptied, without_numbers
from rich.console import Console
from sms.diagnosis.result import Diagnosis, Verdict
from sms.report.assets import Place, placed
from sms.report.console import print_diagnosis
from sms.report.curves import LINE_POINTS, payload, thin
from sms.report.diagnosis import report_html
from sms.report.markup import table
from sms.report.page import write_page
from sms.report.verdict import VERDICT_WORDS

LARGEST_PAGE = 4e6  # bytes
MOST_PRINTED = 6  # pages
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")


# ---- reading the page back ----------------------------------------------------------------------


class Page(HTMLParser):
    """Collects what a test asks of a page; fails on tags that do not close."""

    VOID = frozenset({"meta", "br"})

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.scripts: list[str] = []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "script":
            self.scripts.append(data)
        elif self.open and self.open[-1] != "style":
            self.text += data

    def values(self, attribute: str) -> set[str]:
        return {found for _, attrs in self.tags if (found := attrs.get(attribute)) is not None}


def decode(text: str) -> np.ndarray[Any, np.dtype[np.float32]]:
    return np.frombuffer(base64.b64decode(text), "<f4")


def printed(d: Diagnosis, width: int = 80) -> str:
    out = io.StringIO()
    print_diagnosis(d, Console(file=out, width=width, color_system=None))
    return out.getvalue()


def flat(text: str) -> str:
    """Without the frame and line breaks that the console puts between words."""
    return " ".join(re.sub(r"[│╭╮╰╯─]", " ", text).split())


@cache
def html_of(verdict: Verdict) -> str:
    return report_html(diagnosis(verdict))


@cache
def page_of(verdict: Verdict) -> Page:
    return Page(html_of(verdict))


# ---- the page -----------------------------------------------------------------------------------


@pytest.mark.parametrize("verdict", VERDICTS)
def test_page_says_everything(verdict: Verdict) -> None:
    d = diagnosis(verdict)
    page = Page(report_html(d))
    assert page.values("data-verdict") == {verdict}
    assert VERDICT_WORDS[verdict] in page.text
    assert d.sentence in page.text
    named = [(c.effect, c.signal) for c in d.causes]
    named += [(m.effect, m.signal) for c in d.causes for m in c.alternatives]
    named += [(c.effect, c.signal) for c in d.candidates]
    named += [(n.effect, n.signal) for n in d.not_testable]
    for effect, signal in named:
        assert effect + (f" {signal}" if signal else "") in page.values("data-effect")
    for finding in d.findings:
        assert finding.message in page.text and finding.remedy in page.text
    for text in (*d.conclusion, *(n.reason for n in d.not_testable), *d.records, "0.1.0"):
        assert text in page.text
    anchors = {link.removeprefix("#") for link in page.values("href")}
    assert anchors <= page.values("id")


@pytest.mark.parametrize("verdict", VERDICTS)
def test_page_loads_nothing_from_elsewhere(verdict: Verdict) -> None:
    html, page = html_of(verdict), page_of(verdict)
    assert {tag for tag, _ in page.tags}.isdisjoint({"link", "img", "iframe", "object", "embed"})
    assert not page.values("src")
    assert all(link.startswith("#") for link in page.values("href"))
    style = html[html.index("<style>") : html.index("</style>")]
    assert "url(" not in style and "@import" not in style
    assert "default-src 'none'" in html
    assert len(html.encode()) < LARGEST_PAGE
    drawn = [script for script in page.scripts if "Plotly.react" in script]
    assert len(drawn) == (0 if verdict == "data-fault" else 1)


def test_numbers_are_in_engineering_units() -> None:
    text = page_of("combination").text
    for shown in ("0.750 ± 0.014 N per bar", "+0.870 ± 0.030 %", "25.0000 → 25.1080 ± 0.0039 mm"):
        assert shown in text
    assert "Hang a known weight" in text and "or one of 2 alternatives" in text


@pytest.mark.parametrize("verdict", ["no-evidence", "unknown"])
def test_without_a_cause_there_is_no_extended_model(verdict: Verdict) -> None:
    page = page_of(verdict)
    assert not re.search(r"Extended\b", page.text)
    curves = next(json.loads(s) for s in page.scripts if s.startswith('{"extended"'))
    assert curves["extended"] is False


def test_what_a_later_round_names_is_not_put_out() -> None:
    said = diagnosis("combination")
    early = [
        replace(c, round=1, accepted=False, reason="helps less than the best", p_value=1e-9)
        for c in said.candidates
        if c.round == 2
    ]
    cards = re.findall(
        r'<article class="card cause".*?</article>',
        report_html(replace(said, candidates=(*said.candidates, *early))),
        re.DOTALL,
    )
    assert "direction" in cards[0].partition("Considered and rejected")[2]
    for card in cards:
        assert "pressure_dependent" not in card.partition("Considered and rejected")[2]


def test_a_fault_in_the_data_comes_first() -> None:
    html = html_of("data-fault")
    assert html.index('id="data-check"') < html.index('id="provenance"')
    assert "Effects tested" not in html


@pytest.mark.parametrize("verdict", VERDICTS)
def test_nothing_and_nan_do_no_harm(verdict: Verdict) -> None:
    for d in (emptied(diagnosis(verdict)), without_numbers(diagnosis(verdict))):
        page = Page(report_html(d))
        assert VERDICT_WORDS[verdict] in page.text
        assert not re.search(r"\b(nan|inf|None)\b", page.text)
        console = printed(d)
        assert VERDICT_WORDS[verdict] in console
        assert not re.search(r"\b(nan|inf|None)\b", console)


def test_text_cannot_become_markup() -> None:
    evil = "</script><script>alert(1)</script>"
    d = replace(diagnosis("combination"), title=evil, sentence=evil, rig=evil, conclusion=(evil,))
    d = replace(d, notes=evil)
    d = replace(d, series=tuple(replace(s, record=evil) for s in d.series))
    page = Page(report_html(d))
    assert sum(tag == "script" for tag, _ in page.tags) == 3
    assert evil in page.text


def test_a_page_runs_its_own_scripts_and_no_other() -> None:
    page = Page(report_html(diagnosis("combination")))
    (policy,) = [
        a["content"] or ""
        for tag, a in page.tags
        if tag == "meta" and a.get("http-equiv") == "Content-Security-Policy"
    ]
    allowed = policy.partition("script-src ")[2].partition(";")[0].split()
    assert [a.get("type") for tag, a in page.tags if tag == "script"] == [
        "application/json",
        "application/gzip",
        None,
    ]
    _, packed, own = page.scripts
    unpacked = gzip.decompress(base64.b64decode(packed)).decode()
    assert unpacked == get_plotlyjs()
    digests = [hashlib.sha256(s.encode()).digest() for s in (unpacked, own)]
    assert allowed == [f"'sha256-{base64.b64encode(d).decode()}'" for d in digests]
    without = Page(report_html(replace(diagnosis("combination"), series=())))
    assert not without.scripts
    assert any("script-src 'none'" in (a.get("content") or "") for _, a in without.tags)


def test_pages_of_a_folder_share_one_library_beside_them(tmp_path: Path) -> None:
    with placed(Place.beside):
        html = report_html(diagnosis("combination"))
    for name in ("one.html", "two.html"):
        write_page(tmp_path / name, html)
    library = [file for file in tmp_path.iterdir() if file.suffix == ".js"]
    assert [file.read_text() for file in library] == [get_plotlyjs()]
    assert Page(html).values("src") == {library[0].name}
    assert len(html.encode()) < 1e6
    assert Page(html_of("combination")).values("src") == set()


def test_a_long_table_is_printed_in_part_and_says_so() -> None:
    said = table("caption", ("a", "b"), [(str(n), "x") for n in range(9)], on_paper=4)
    assert said.count("class=screen") == 5
    assert "The first 4 of 9" in said
    assert "screen" not in table("caption", ("a", "b"), [("1", "x")], on_paper=4)


def browse(file: Path, *flags: str) -> str:
    """With a profile of its own beside the file, so that several browsers run at once."""
    assert CHROMIUM is not None
    usual = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=8000"]
    profile = tempfile.mkdtemp(prefix="profile-", dir=file.parent)
    command = [CHROMIUM, *usual, f"--user-data-dir={profile}", *flags, file.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here; ./dev test --full installs it")
def test_a_browser_draws_with_the_library_beside_and_prints_few_pages(tmp_path: Path) -> None:
    file, printed, alone = (
        tmp_path / n for n in ("report.html", "report.pdf", "alone/report.html")
    )
    with placed(Place.beside):
        write_page(file, report_html(diagnosis("combination")))
    assert list(tmp_path.glob("*.js"))
    alone.parent.mkdir()
    shutil.copy(file, alone)
    # A browser waits for seconds before it draws: the three wait together.
    asked = ((file, "--dump-dom"), (file, f"--print-to-pdf={printed}"), (alone, "--dump-dom"))
    with ThreadPoolExecutor() as browsers:
        drawn, _, without = browsers.map(browse, *zip(*asked, strict=True))
    assert 'class="main-svg"' in drawn
    pages = len(re.findall(rb"/Type\s*/Page\b", printed.read_bytes()))
    assert 1 < pages <= MOST_PRINTED
    assert "could not be drawn" in without


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium here; ./dev test --full installs it")
def test_a_browser_draws_the_page_and_refuses_a_script_that_was_smuggled_in(tmp_path: Path) -> None:
    smuggled = "<script>document.title = 'it ran'</script><img src=x onerror=\"document.title = 'it ran'\">"
    html = report_html(diagnosis("combination"))
    file = tmp_path / "report.html"
    file.write_text(html.replace("<main>", f"<main>{smuggled}"), encoding="utf-8")
    shown = browse(file, "--dump-dom")
    assert "it ran" in shown  # the text of the script is there
    assert "<title>it ran" not in shown
    assert 'class="main-svg"' in shown  # and the page's own have drawn


# ---- the curves ---------------------------------------------------------------------------------


def test_curves_carry_the_numbers() -> None:
    d = diagnosis("combination")
    data = payload(d)
    assert [r["label"] for r in data["records"]] == ["3 bar", "7 bar", "1 bar", "5 bar"]
    first, s = data["records"][0], d.series[2]
    np.testing.assert_allclose(decode(first["measured"]), s.measured, rtol=1e-6)
    drawn = decode(first["baseline"])
    np.testing.assert_array_equal(np.isnan(drawn), ~s.used)
    np.testing.assert_allclose(
        decode(first["views"][1]["x"]), 1e3 * s.inputs["extension [m]"], 1e-6
    )
    assert first["floor"] == 0.3 and data["records"][2]["floor"] is None
    group = data["groups"][0]
    titles = [panel["title"] for panel in group["panels"]]
    assert group["label"] == "all records"
    names = ["extension [mm]", "velocity [mm/s]", "chamber pressure lower [bar]", "direction"]
    assert titles == [*names, "time [s]"]


def test_means_show_friction_that_grows_with_pressure_in_each_direction() -> None:
    panel = payload(diagnosis("combination"))["groups"][0]["panels"][2]
    up, down = panel["baseline"]["means"]
    assert (up["side"], down["side"]) == ("extending", "retracting")
    gap = decode(up["y"]) - decode(down["y"])
    assert gap[-1] - gap[0] == pytest.approx(-2.0 * 0.75 * 6.0, abs=0.2)
    after = panel["extended"]["means"]
    assert max(np.abs(decode(side["y"])).max() for side in after) < 0.1


def test_a_jump_of_time_interrupts_the_line() -> None:
    s = cylinder_series("1 bar", "identify", 1e5, rows=100)
    s = replace(s, time=np.where(np.arange(100) < 40, s.time, s.time + 5.0))
    measured = decode(payload(replace(diagnosis("cause"), series=(s,)))["records"][0]["measured"])
    assert np.flatnonzero(np.isnan(measured)).tolist() == [40]


def test_thinning_keeps_extremes_within_its_budget() -> None:
    curve = np.sin(np.linspace(0.0, 50.0, 100_000))
    curve[77_777], curve[12_345] = 9.0, -9.0
    keep = thin((curve, -curve), 1000)
    assert keep.size <= 1000 and {77_777, 12_345} <= set(keep.tolist())
    assert np.all(np.diff(keep) > 0)
    assert thin((curve[:500],), 1000).tolist() == list(range(500))
    assert thin((np.full(5000, np.nan),), 100).size <= 100


def test_long_records_do_not_make_a_large_page() -> None:
    long = cylinder_series("long", "validate", 3e5, rows=50_000)
    series = tuple(replace(long, record=f"record {k}") for k in range(30))
    d = replace(diagnosis("combination"), series=series)
    rows = sum(decode(r["measured"]).size for r in payload(d)["records"])
    assert rows <= LINE_POINTS
    assert len(report_html(d).encode()) < LARGEST_PAGE


# ---- the console --------------------------------------------------------------------------------


@pytest.mark.parametrize("width", [80, 120])
@pytest.mark.parametrize("verdict", VERDICTS)
def test_console(verdict: Verdict, width: int) -> None:
    d = diagnosis(verdict)
    text = printed(d, width)
    assert all(len(line) <= width for line in text.splitlines())
    assert VERDICT_WORDS[verdict] in text and d.sentence in flat(text)
    assert len(text.splitlines()) < 40
    for cause in d.causes:
        for title in (cause.title, *(m.title for m in cause.alternatives)):
            assert all(word in flat(text).lower() for word in title.lower().split())
    if d.causes:
        assert "−62 %" in text and "1.10 N" in text
    if verdict == "data-fault":
        assert "line 412" in text and "mend the cable" in flat(text)
