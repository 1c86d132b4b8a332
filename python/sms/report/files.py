"""A diagnosis on disk: report.html, diagnosis.json and extended.toml, each there whole or not at all.

The curve of an unknown goes to empirical.csv where it was asked for.
"""

from __future__ import annotations

from pathlib import Path

from sms.diagnosis.localisation.empirical_term import table_of
from sms.diagnosis.result import Diagnosis, as_json
from sms.io.declarations import Declaration
from sms.io.write import write_extended_rig, write_text_atomically
from sms.report.diagnosis import report_html
from sms.report.page import write_page

COVERAGE = 2.0
"""Standard errors that become the declared uncertainty of a found parameter: about 95 percent."""


def write_diagnosis(diagnosis: Diagnosis, rig: Path, out: Path) -> tuple[Path, ...]:
    """Write the files into the folder `out`, made if need be. InputError if that cannot be done."""
    extended, page, data = out / "extended.toml", out / "report.html", out / "diagnosis.json"
    text = as_json(diagnosis)
    html = report_html(diagnosis)
    write_extended_rig(rig, extended, extension_of(diagnosis), header_of(diagnosis))
    write_page(page, html)
    write_text_atomically(data, text)
    if diagnosis.empirical is None:
        return page, data, extended
    curve = out / "empirical.csv"
    write_text_atomically(curve, table_of(diagnosis.empirical))
    return page, data, extended, curve


def extension_of(diagnosis: Diagnosis) -> dict[str, Declaration]:
    """The found parameters as a rig file declares them: value, and COVERAGE standard errors."""
    return {
        p.name: Declaration(p.value, COVERAGE * p.standard_error)
        for cause in diagnosis.causes
        for p in cause.parameters
    }


def header_of(diagnosis: Diagnosis) -> str:
    lines = [
        f"Extended by sms {diagnosis.versions['sms']} from {diagnosis.rig}, seed {diagnosis.seed}.",
        f"Verdict: {diagnosis.verdict}. {diagnosis.sentence}",
    ]
    return "\n".join(lines)
