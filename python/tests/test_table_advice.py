"""The advice on tables: its page says what is measured today, its picture is one."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from validation.speed import table_advice
from validation.speed.log_plot import Curve, LogPlot, Mark
from validation.speed.table_page import Accuracy, length, size, smallest

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize("nodes", [5, 11, 41])
def test_the_page_has_the_errors_of_today(nodes: int) -> None:
    row = next(
        line
        for line in table_advice.PAGE.read_text().splitlines()
        if line.startswith(f"| {nodes} x {nodes} |")
    )
    f, d = (table_advice.flat(nodes, precision) for precision in ("float", "double"))
    assert f.numbers == d.numbers == 3 * nodes**2
    for error in (f.linear, d.linear, f.cubic, d.cubic):
        assert length(error) in row
    assert size(f.flash) in row


def test_the_smallest_table_below_a_limit() -> None:
    tables = {5: Accuracy(75, 2e-4, None), 9: Accuracy(243, 5e-5, 2e-6)}
    assert smallest(tables, 1e-4, cubic=False) == smallest(tables, 1e-4, cubic=True) == 9
    with pytest.raises(SystemExit, match="no table comes below 1e-06 m"):
        smallest(tables, 1e-6, cubic=False)


def test_lengths_and_sizes_as_a_person_reads_them() -> None:
    assert [length(x) for x in (2.83e-5, 7.24e-8, None)] == ["28 µm", "0.072 µm", ""]
    assert [size(n) for n in (1452, 484812)] == ["1452 B", "473 KiB"]


def test_the_picture_is_well_formed_and_its_points_are_where_they_belong() -> None:
    curve = Curve("a < b", [(10.0, 1.0), (1000.0, 0.01)], "#123456")
    marks = (Mark("limit", y=0.1), Mark("size", x=100.0))
    plot = LogPlot("x", "y", (10.0, 1000.0), (0.01, 1.0), (curve,), marks)
    root = ElementTree.fromstring(plot.svg())
    circles = [
        (float(c.get("cx", "nan")), float(c.get("cy", "nan"))) for c in root.iter(f"{SVG}circle")
    ]
    (left, top), (right, bottom) = circles
    assert left < right and top < bottom
    limit = [
        float(e.get("y1", "nan")) for e in root.iter(f"{SVG}line") if e.get("y1") == e.get("y2")
    ]
    assert any(abs(y - 0.5 * (top + bottom)) < 0.1 for y in limit)
    assert "a < b" in [e.text for e in root.iter(f"{SVG}text")]
    assert ElementTree.parse(Path(table_advice.PICTURE)).getroot().tag == f"{SVG}svg"
