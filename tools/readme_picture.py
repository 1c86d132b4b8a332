"""The README's picture: what `sms demo` finds, as curves before and after, with cause and size beside.

python -m tools.readme_picture        (needs Chromium: apt-get install chromium)
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from sms.cli.demo import verdict_of
from sms.demo import Hidden, draw_hidden, write_bench
from sms.demo.bench import streams
from sms.diagnosis import Diagnosis
from sms.diagnosis.effects.catalogue import effects_of
from sms.diagnosis.free_run import WHOLE
from sms.diagnosis.pipeline import blank_answer, read_and_check
from sms.diagnosis.preparation import make_data
from sms.diagnosis.simulated import Case, complete, investigate
from sms.io.rig import load_rig
from sms.report.markup import esc
from sms.report.page import asset, page
from sms.report.page import plots as scripts
from sms.report.plots import Figure, Line, figures_html, payload
from sms.units_display import axis_unit, capital, format_aligned, format_quantity, words

from tools.chromium import chromium, photograph

PICTURE = Path(__file__).parents[1] / "docs" / "demo.png"
SIZE = (1200, 640)
EFFECT, SEED = "fitting_leakage:lower", 7
SHOWN = ("chamber_pressure_lower", "extension")
STYLE = """
main { padding: 18px 22px; max-width: none; display: grid; grid-template-columns: minmax(0, 1fr) 330px; gap: 24px; }
.figures { grid-template-columns: 1fr; margin: 0; gap: 12px; }
aside { align-self: center; }
.modebar { display: none; }
.sentence { margin-bottom: 1.2rem; }
td, th { padding: .25rem .9rem .25rem 0; text-align: left; }
"""


def diagnosed(rig_file: Path) -> tuple[Diagnosis, Case]:
    """The answer, and the fitted models that it stands for."""
    rig = load_rig(rig_file)
    records, findings = read_and_check(rig)
    rng, silent = np.random.default_rng(1), lambda text, done: None
    case = investigate(make_data(rig, records), effects_of(rig), rng, silent)
    return complete(blank_answer(rig, records, findings, 1), case, rng, silent), case


def figures_of(case: Case) -> list[Figure]:
    """The unseen record, and free runs of the model before and after from its beginning to its end."""
    runs = case.data.validate
    (run,) = runs.motions
    whole = replace(runs, motions=(replace(run, window=WHOLE),), complete=True)
    errors = {
        "simulated, before": ("baseline", whole.problem.errors(case.baseline.params)),
        "simulated, after": ("extended", whole.problem.errors(case.final.params)),
    }
    found = []
    for signal in SHOWN:
        unit = axis_unit(runs.kind.units[signal])
        rows = whole.channel == whole.channels.index(signal)
        at = whole.sample[rows]
        time, read = run.time[at], run.signals[signal][at]
        lines = [Line("measured", time, unit.factor * read, "measured")]
        for name, (colour, error) in errors.items():
            simulated = read + whole.noise[signal] * error[rows]
            dash = "dash" if colour == "extended" else ""  # what it covers is seen
            lines.append(Line(name, time, unit.factor * simulated, colour, dash))
        title = f"{capital(words(signal))} on a record that the fit has not seen"
        axis = f"[{unit.label}]"
        found.append(Figure(signal, title, "time [s]", axis, lines, height=235))
    return found


def beside(answer: Diagnosis, hidden: Hidden) -> str:
    """The cause, its size and what it is worth."""
    rows = []
    for run in answer.free_run:
        if run.signal in SHOWN:
            before, after = map(esc, format_aligned([run.baseline_rms, run.extended_rms], run.unit))
            rows.append(
                f"<tr><th>{esc(capital(words(run.signal)))}</th><td>{before}</td><td><strong>{after}</strong></td></tr>"
            )
    truth = format_quantity(hidden.value, hidden.unit, hidden.parameter)
    return (
        f'<aside><p class="chip {answer.verdict}">found</p><p class="sentence">{esc(capital(verdict_of(answer)))}</p>'
        f"<p>Hidden was {esc(truth)}, sealed beforehand.</p>"
        f"<table><tr><th>RMS error</th><td>before</td><td>after</td></tr>{''.join(rows)}</table></aside>"
    )


def html(answer: Diagnosis, case: Case, hidden: Hidden) -> str:
    """The page that is photographed."""
    figures = figures_of(case)
    body = f"<main>{figures_html(figures)}{beside(answer, hidden)}</main>"
    return page("sms demo", body, scripts(payload(figures), "plots.js"), asset("plots.css") + STYLE)


def main() -> int:
    argparse.ArgumentParser(prog="python -m tools.readme_picture", description=__doc__).parse_args()
    browser = chromium()
    if browser is None:
        print("readme_picture: no Chromium here; apt-get install chromium", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for_effect, for_machine, for_noise, _ = streams(SEED)
        hidden = draw_hidden(EFFECT, for_effect)
        answer, case = diagnosed(write_bench(folder, hidden, for_machine, for_noise))
        if not hidden.named_by(answer):
            print(
                f"readme_picture: {verdict_of(answer)}, which is not what was hidden",
                file=sys.stderr,
            )
            return 1
        file = folder / "picture.html"
        file.write_text(html(answer, case, hidden), encoding="utf-8")
        until = "--virtual-time-budget=8000"
        photograph(browser, file.as_uri(), PICTURE, SIZE, folder / "profile", until)
    print(PICTURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
