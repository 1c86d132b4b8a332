"""What a notebook shows of results, the figures that they give one by one, and its progress bar."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import sms
from report_support import VERDICTS, diagnosis, emptied
from sms.diagnosis.result import Verdict
from sms.identification.friction import identify_friction
from sms.workspace_survey import survey
from test_diagnosis_cylinder import make_rig


def shown(result: Any) -> str:
    """What a notebook puts into its page: one block, whose style reaches nothing around it."""
    html = str(result._repr_html_())
    assert html.startswith('<div class="sms-view"><style>.sms-view {')
    assert html.endswith("</div>")
    assert ":root" not in html
    assert "<script" not in html
    assert html.count("<div") == html.count("</div>")
    return html


@pytest.mark.parametrize("verdict", VERDICTS)
def test_a_diagnosis_shows_its_verdict_and_gives_what_figures_it_has(verdict: Verdict) -> None:
    d = diagnosis(verdict)
    assert d.sentence in shown(d)
    assert len(shown(d)) < 100_000
    assert "Diagnosis" in shown(emptied(d))
    if verdict == "data-fault":
        with pytest.raises(ValueError, match="no figure 'gain': it has none"):
            d.figure("gain")
        return
    names = {bar.name: list(bar.x) for bar in d.figure("gain").data}
    assert names["baseline"] == [pytest.approx(g.baseline_rms / 0.3) for g in d.gain]
    assert ("extended" in names) == bool(d.causes)
    curves = d.figure("curves", record="7 bar")
    s = next(s for s in d.series if s.record == "7 bar")
    np.testing.assert_allclose(curves.data[0].y, s.measured)
    over = d.figure("residual", record="7 bar", over="extension").data[0]
    np.testing.assert_allclose(over.x, 1e3 * s.inputs["extension [m]"][s.used])
    np.testing.assert_allclose(over.y, (s.measured - s.baseline)[s.used])


def test_what_cannot_be_drawn_is_said() -> None:
    d = diagnosis("combination")
    with pytest.raises(ValueError, match="no figure 'gian': there is gain, curves, residual"):
        d.figure("gian")
    with pytest.raises(ValueError, match="nothing can be chosen"):
        d.figure("gain", record="7 bar")
    with pytest.raises(ValueError, match="there is no '8 bar'"):
        d.figure("curves", record="8 bar")
    with pytest.raises(ValueError, match="over='extensoin' is not recorded; did you mean"):
        d.figure("residual", over="extensoin")


def test_text_cannot_become_markup_in_a_notebook() -> None:
    evil = "<img src=x onerror=alert(1)>"
    html = shown(replace(diagnosis("combination"), title=evil, sentence=evil, rig=evil))
    assert "<img" not in html


def test_a_run_shows_its_columns_and_draws_one() -> None:
    run = sms.simulate_bench(np.full(100, 0.2), controller="pid")
    html = shown(run)
    assert "0.1 s simulated" in html or "0.099 s simulated" in html
    assert all(f">{column}<" in html for column in run.columns)
    np.testing.assert_array_equal(run.figure("extension").data[0].y, run["extension"])
    with pytest.raises(ValueError, match="no figure 'extent'"):
        run.figure("extent")


def test_a_platform_draws_its_legs_together() -> None:
    run = sms.simulate_platform(np.full((20, 3), 0.2), controller="pid")
    assert [line.name for line in run.figure("extension").data] == [
        "extension_1",
        "extension_2",
        "extension_3",
    ]


def test_a_workspace_shows_what_fits_and_draws_the_region() -> None:
    found = survey(sms.Params(stroke=0.1))
    assert "What the platform can reach" in shown(found)
    assert found.figure("region").data


def test_what_was_identified_shows_its_tables_and_draws_the_figures_of_its_page(
    tmp_path: Path,
) -> None:
    make_rig(tmp_path)
    found = identify_friction(tmp_path / "rig.toml", choice=("stribeck",))
    html = shown(found)
    assert "The laws" in html
    assert 'class="panels' not in html
    assert len(found.figure("map", number=1).data) == 3
    with pytest.raises(ValueError, match="numbers 0 to"):
        found.figure("map", number=99)
    assert found.figure("correlation").data[0].type == "heatmap"


# ---- progress ------------------------------------------------------------------------------------


def test_the_bar_of_a_notebook_moves_and_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    handle = SimpleNamespace(update=told.append)

    def display(html: str, display_id: bool) -> SimpleNamespace:
        told.append(html)
        return handle

    module = SimpleNamespace(display=display, HTML=str)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(display=module))
    monkeypatch.setitem(sys.modules, "IPython.display", module)
    with sms.notebook_progress() as tell:
        tell("fitting <b>", 0.25)
    assert 'value="0.250"' in told[1]
    assert "fitting &lt;b&gt;" in told[1]
    assert told[-1] == ""


def test_without_a_notebook_there_is_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "IPython.display", None)
    with sms.notebook_progress() as tell:
        tell("fitting", 0.5)
