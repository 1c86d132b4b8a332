"""What is shipped of others' measurements: complete, packed as said, in the public domain, and usable."""

from __future__ import annotations

import gzip
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from io_support import AMBIENT, healthy_signals
from sms.data import CYLINDER, FOLDER, SCENARIOS, WAVES, cylinder_rig, scenario_file
from sms.io import InputError, check_record, check_rig, load_record, load_rig
from sms.scenario import load_scenario

CHECKOUT = Path(__file__).parents[2]
ORIGINALS = CHECKOUT.parent / "shared" / "data"
RIGS = ("cylinder_o_ring", "cylinder_kdn", "cylinder_o_ring_rerun1", "cylinder_o_ring_rerun3")
ELSEWHERE = sorted((CHECKOUT / "validation" / "measured" / "rigs").glob("cylinder_*.toml"))
LARGEST = 2e6
"""bytes, of all of it."""


@pytest.mark.parametrize("name", RIGS)
def test_a_real_rig_file_reads_and_its_records_can_be_used(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)  # where no ../shared/data is
    rig = load_rig(cylinder_rig(name))
    assert (rig.kind, rig.skip_first) == ("cylinder", 15)
    assert rig.speed_above == pytest.approx(0.004)
    bore = 0.0257 if "rerun" in name else 0.025
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
        pressure = record.signals["chamber_pressure_lower"]
        assert np.median(pressure) == pytest.approx(float(source.name[0]) * 1e5, rel=0.02)
        assert record.gauge == {"chamber_pressure_lower"}
        assert record.signals["extension"].min() > 0.0
        assert record.signals["extension"].max() < 0.045


# ---- seals whose records are not shipped ----


def write_stand_ins(folder: Path) -> None:
    """Files of the names and columns of the originals, from the healthy record of the tests."""
    folder.mkdir()
    for name in ("O-ring257", "X-ring257"):
        for bar in (1, 3, 5, 7):
            s = healthy_signals(gauge_pressure=bar * 1e5)
            s["rod_force"] *= (25.7 / 25.0) ** 2
            gauge = (s["chamber_pressure_lower"] - AMBIENT) / 1e5
            unused = np.zeros_like(gauge)
            columns = [1e3 * s["time"], unused, unused, unused, 40.0 - 1e3 * s["extension"], gauge]
            table = np.column_stack([*columns, s["rod_force"]])
            text = "\n".join("\t".join(f"{cell:.3f}" for cell in row) for row in table)
            (folder / f"{name}_{bar}bar.csv.gz").write_bytes(gzip.compress(text.encode()))


@pytest.mark.parametrize("path", ELSEWHERE, ids=lambda path: path.stem)
def test_originals_are_read_as_they_are(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_stand_ins(tmp_path / CYLINDER.name)
    monkeypatch.setenv("SMS_DATA", str(tmp_path))
    rig = load_rig(path)
    assert rig.declared("bore_diameter").value == pytest.approx(0.0257)
    assert check_rig(rig) == ()
    for source in rig.records:
        record = load_record(rig, source)
        assert not check_record(rig, record)
        pressure = record.signals["chamber_pressure_lower"]
        assert np.median(pressure) == pytest.approx(float(source.name[0]) * 1e5, rel=0.02)


@pytest.mark.parametrize("path", ELSEWHERE, ids=lambda path: path.stem)
def test_without_the_data_the_message_says_where_it_can_be_had(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SMS_DATA", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="can be had from GitHub EvaZillen") as caught:
        load_rig(path)
    for word in (str(path), str(tmp_path.resolve()), "SMS_DATA"):
        assert word in str(caught.value)


# ---- shipped ----


def test_a_shipped_scenario_is_asked_for_by_its_name(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    assert set(SCENARIOS) == {"waves_3012", "waves_3061"}
    for name, path in SCENARIOS.items():
        assert scenario_file(Path(name)) == path
        assert load_scenario(path).deck_motion is not None
    own = tmp_path / "waves_3012"
    own.write_text("")
    assert scenario_file(own) == own and scenario_file(Path("waves_3012")) == Path("waves_3012")
    assert scenario_file(Path("waves_3013.toml")) == Path("waves_3013.toml"), (
        "a file's name is the user's own"
    )
    with pytest.raises(InputError, match="did you mean 'waves_3061'"):
        scenario_file(Path("waves_3013"))


def test_a_cylinder_that_is_not_there_is_a_sentence() -> None:
    with pytest.raises(InputError, match="install sms again"):
        cylinder_rig("cylinder_of_another")


@pytest.mark.parametrize("folder", [CYLINDER, WAVES], ids=lambda path: path.name)
def test_licence_and_origin_stand_beside_the_records(folder: Path) -> None:
    assert (folder / "LICENSE").read_text().splitlines()[2] == "CC0 1.0 Universal"
    origin = (folder / "README.md").read_text()
    assert "GitHub" in origin and "commit" in origin
    listed = [line.split()[1] for line in (folder / "originals.sha256").read_text().splitlines()]
    assert sorted(listed) == sorted(file.name for file in folder.glob("*.csv.gz"))


def test_all_of_it_is_small() -> None:
    assert 0 < sum(file.stat().st_size for file in FOLDER.rglob("*.*")) < LARGEST


@pytest.mark.skipif(
    not (ORIGINALS / CYLINDER.name).is_dir(),
    reason=f"the originals are not at hand (looked in {ORIGINALS})",
)
def test_what_is_packed_is_what_the_originals_give() -> None:
    command = [sys.executable, "-m", "tools.pack_data", str(ORIGINALS), "--check"]
    result = subprocess.run(command, cwd=CHECKOUT, capture_output=True, text=True, check=False)
    assert (result.returncode, result.stderr) == (0, "")
    assert "16 records" in result.stdout and "2 records" in result.stdout
