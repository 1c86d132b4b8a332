"""The rig files of the real cylinder, on stand-ins and on the real data where it is."""

from __future__ import annotations

import gzip
import os
from pathlib import Path

import numpy as np
import pytest
from io_support import AMBIENT, healthy_signals
from sms.io import check_record, check_rig, load_record, load_rig

CHECKOUT = Path(__file__).parents[2]
RIGS = sorted((CHECKOUT / "validation" / "measured" / "rigs").glob("cylinder_*.toml"))
FOLDER = "cylinder_friction_zillen"
BAR = (1, 3, 5, 7)
SHARED = ("O-ring", "KDN", "rerun1_O-ring257", "rerun3_O-ring257")
NOT_SHARED = ("O-ring257", "X-ring257")
"""Seals whose records are only where their rig file says."""


def write_stand_ins(folder: Path) -> None:
    """Files of the names and columns of the real ones, from the healthy record of the tests."""
    folder.mkdir()
    for name in (*SHARED, *NOT_SHARED):
        for bar in BAR:
            s = healthy_signals(gauge_pressure=bar * 1e5)
            if "257" in name:
                s["rod_force"] *= (25.7 / 25.0) ** 2
            gauge = (s["chamber_pressure_lower"] - AMBIENT) / 1e5
            unused = np.zeros_like(gauge)
            columns = [1e3 * s["time"], unused, unused, unused, 40.0 - 1e3 * s["extension"], gauge]
            table = np.column_stack([*columns, s["rod_force"]])
            text = "\n".join("\t".join(f"{cell:.3f}" for cell in row) for row in table)
            (folder / f"{name}_{bar}bar.csv.gz").write_bytes(gzip.compress(text.encode()))


@pytest.fixture(params=["stand-in", "as found"])
def data(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """SMS_DATA set to stand-ins, or to the real data where it is on this machine."""
    places = [os.environ.get("SMS_DATA", ""), str(CHECKOUT.parent / "shared" / "data")]
    real = [place for place in places if place and (Path(place) / FOLDER).is_dir()]
    if request.param == "as found" and real:
        monkeypatch.setenv("SMS_DATA", real[0])
        return "real"
    write_stand_ins(tmp_path / FOLDER)
    monkeypatch.setenv("SMS_DATA", str(tmp_path))
    return "stand-in"


def test_the_rig_files_are_here() -> None:
    assert [path.stem for path in RIGS] == [
        "cylinder_kdn",
        "cylinder_o_ring",
        "cylinder_o_ring_257",
        "cylinder_o_ring_rerun1",
        "cylinder_o_ring_rerun3",
        "cylinder_x_ring_257",
    ]


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_a_real_rig_file_reads_and_its_records_can_be_used(path: Path, data: str) -> None:
    try:
        rig = load_rig(path)
    except ValueError as error:
        if data == "real" and path.stem.endswith("_257") and "there is no file" in str(error):
            pytest.skip(f"its records are not at hand: {error}")
        raise
    assert (rig.kind, rig.skip_first) == ("cylinder", 15)
    assert rig.speed_above == pytest.approx(0.004)
    bore = 0.0257 if "257" in path.stem or "rerun" in path.stem else 0.025
    assert rig.declared("bore_diameter").value == pytest.approx(bore)
    assert rig.declared("bore_diameter").uncertainty == pytest.approx(2e-5)
    assert rig.declared("coulomb_force").fit
    roles = [
        ("1 bar", "identify"),
        ("5 bar", "identify"),
        ("3 bar", "validate"),
        ("7 bar", "validate"),
    ]
    assert [(record.name, record.role) for record in rig.records] == roles
    assert check_rig(rig) == ()
    for source in rig.records:
        record = load_record(rig, source)
        severities = {finding.severity for finding in check_record(rig, record)}
        assert "error" not in severities
        if data == "stand-in":
            assert not severities
        pressure = record.signals["chamber_pressure_lower"]
        assert np.median(pressure) == pytest.approx(float(source.name[0]) * 1e5, rel=0.05)
        assert record.gauge == {"chamber_pressure_lower"}
        assert record.signals["extension"].min() > 0.0
        assert record.signals["extension"].max() < 0.045


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_without_the_data_the_message_says_where_it_can_be_had(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SMS_DATA", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match="can be had from GitHub EvaZillen") as caught:
        load_rig(path)
    for word in (str(path), str(tmp_path.resolve()), "SMS_DATA"):
        assert word in str(caught.value)
