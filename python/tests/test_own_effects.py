"""Effects of a user's own, in a file beside the rig file: found like those of the catalogue, and checked."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from plant_support import RIG, write_bench, write_platform
from sms import _core
from sms.diagnosis import diagnose
from sms.diagnosis.effects.catalogue import catalogue, effects_of, own_effects
from sms.io import InputError, load_rig
from sms.report.files import write_diagnosis

ENTRY = """
[[effect]]
id = "rod_of_another_size"
kind = "shifted"
parameters = ["rod_diameter"]
block = "force"
title = "the rod has another diameter"
cause = "A cylinder of the same bore with a reinforced rod was mounted."
signature = "the upper chamber's pressure is higher than it should be"
needs = ["motion"]
absolute = true
plausible = ["-10 mm", "25 mm"]
separated_by = "Measure the rod with a gauge."
"""
TRUTH = 0.04  # m, declared as 25 mm


def with_effects(path: Path, entry: str = ENTRY) -> Path:
    """A rig file that names a file of effects."""
    (path.parent / "own.toml").write_text(entry)
    path.write_text(path.read_text() + '\n[effects]\nfile = "own.toml"\n')
    return path


def bare_rig(folder: Path, kind: str = "bench", more: str = "") -> Path:
    """A rig file whose records are there and empty."""
    text = RIG if kind == "bench" else f'[rig]\nkind = "{kind}"\n'
    for name, role in (("one", "identify"), ("two", "validate")):
        (folder / f"{name}.csv").touch()
        text += f'\n[[records]]\nfile = "{name}.csv"\nrole = "{role}"\n'
    (folder / "rig.toml").write_text(text + more)
    return folder / "rig.toml"


def failure(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        effects_of(load_rig(path))
    return str(caught.value)


@pytest.mark.full
@pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
def test_what_only_the_users_file_knows_is_not_named_without_it(tmp_path: Path) -> None:
    answer = diagnose(write_bench(tmp_path, 3, {"rod_diameter": TRUTH}))
    assert answer.verdict != "cause"
    assert all(p.name != "rod_diameter" for c in answer.causes for p in c.parameters)


@pytest.mark.full
@pytest.mark.skipif(not _core.has_estimation, reason="built without Ceres")
def test_what_only_the_users_file_knows_is_named_with_it(tmp_path: Path) -> None:
    assert all("rod_diameter" not in e.parameters for e in catalogue("bench"))
    path = write_bench(tmp_path, 3, {"rod_diameter": TRUTH})
    answer = diagnose(with_effects(path))
    # A rod is the upper chamber's area, for which a gain of either pressure sensor makes up.
    assert answer.verdict == "class"
    (cause,) = answer.causes
    assert cause.members == ("rod_of_another_size", "sensor_gain")
    assert cause.share > 0.99
    (rod,) = cause.parameters
    assert rod.value == pytest.approx(TRUTH, abs=max(3.0 * rod.standard_error, 2e-4))
    assert all(g.extended_rms < 1.3 * g.noise_floor for g in answer.gain)

    _, data, extended = write_diagnosis(answer, path, tmp_path / "report")[:3]
    assert "rod has another diameter" in (tmp_path / "report" / "report.html").read_text()
    said = json.loads(data.read_text())["causes"][0]
    assert (said["effect"], said["block"]) == ("rod_of_another_size", "force")
    assert said["explanation"].endswith(
        "In the records: the upper chamber's pressure is higher than it should be."
    )
    again = load_rig(extended)
    assert again.parameters["rod_diameter"].value == pytest.approx(rod.value)
    assert [e.id for e in effects_of(again)][-1] == "rod_of_another_size"
    assert diagnose(extended).verdict == "no-evidence"


def test_an_entry_is_an_effect_of_its_rig_in_si(tmp_path: Path) -> None:
    path = with_effects(bare_rig(tmp_path), ENTRY.replace('"shifted"', '"shifted"\nstep = "1 mm"'))
    known, own = catalogue("bench"), effects_of(load_rig(path))[-1]
    assert own.key == "rod_of_another_size" and own not in known
    assert own.plausible == pytest.approx((-0.01, 0.025))
    assert own.plausible_range(0.025) == pytest.approx((0.015, 0.05))
    assert own.step == pytest.approx(1e-3)
    relative = ENTRY.replace("absolute = true\n", "").replace(
        '["-10 mm", "25 mm"]', '[-0.4, "60 %"]'
    )
    (tmp_path / "own.toml").write_text(relative)
    own = effects_of(load_rig(path))[-1]
    assert own.plausible_range(0.025) == pytest.approx((0.015, 0.04))


def test_an_entry_for_another_kind_of_rig_is_left_out(tmp_path: Path) -> None:
    path = with_effects(bare_rig(tmp_path), ENTRY + 'kinds = ["platform"]\n')
    assert len(effects_of(load_rig(path))) == len(effects_of(load_rig(bare_rig(tmp_path))))


def test_signals_parts_and_legs_are_as_in_the_catalogue(tmp_path: Path) -> None:
    entries = (
        'legs = ["rod_of_another_size"]\n'
        + ENTRY
        + """
[[effect]]
id = "drift"
kind = "missing"
signals = ["extension_1", "extension_2"]
parameters = ["sensor_lag_{signal}", "sensor_gain_{signal}"]
block = "sensors"
title = "the {signal} sensor is slow and wrong"
cause = "Both."
plausible = ["0 ms", "50 ms"]
"""
    )
    path = with_effects(write_platform(tmp_path, 1, {}, 0.1), entries)
    own = own_effects(load_rig(path))
    assert [(e.id, e.signal, e.parameters[0]) for e in own] == [
        ("rod_of_another_size", None, "rod_diameter"),
        ("drift", "extension_1", "sensor_lag_extension:1"),
        ("drift", "extension_2", "sensor_lag_extension:2"),
        *(("rod_of_another_size", f"leg {k}", f"rod_diameter:{k}") for k in (1, 2, 3)),
    ]
    assert own[1].title == "the position of leg 1 sensor is slow and wrong"
    assert own[1].of_sensor and own[1].cause == "Both."
    assert own[3].plausible_range(math.nan) == pytest.approx((-0.01, 0.025))


@pytest.mark.parametrize(("old", "new", "words"), [
    ('"rod_diameter"]', '"rod_diametr"]', ["parameters", "'rod_diametr'", "did you mean 'rod_diameter'?"]),
    ('["-10 mm", "25 mm"]', '["25 mm", "-10 mm"]', ["25 mm to -10 mm is upside down"]),
    ('["-10 mm", "25 mm"]', '["5 mm", "25 mm"]', ["does not hold 0", "how far rod_diameter is off"]),
    ('["-10 mm", "25 mm"]', '["-10 N", "25 N"]', ["plausible", "N"]),
    ('["-10 mm", "25 mm"]', '["25 mm"]', ["[[effect]] number 1, plausible", "two numbers"]),
    ("absolute = true", "", ["plausible", "mm"]),
    ('"rod_of_another_size"', '"backlash"', ["the catalogue has an effect 'backlash' already"]),
    ('"rod_diameter"]', '"backlash"]', ["an effect of backlash is in the catalogue already, 'backlash'"]),
    ('"force"', '"forces"', ["block", "'forces'", "did you mean 'force'?"]),
    ('["motion"]', '["motoin"]', ["needs", "did you mean 'motion'?"]),
    ('"shifted"', '"missing"', ["rod_diameter is 0.025 m", 'write kind = "shifted"']),
    ('"shifted"', '"shifed"', ["[[effect]] number 1, kind", "did you mean 'shifted'?"]),
    ("title =", "titel =", ["'titel'", "did you mean 'title'?"]),
    ('title = "the rod has another diameter"\n', "", ["the key 'title' is missing"]),
    ("[[effect]]", "[effect]", ["[[effect]] with double brackets"]),
    ("[[effect]]", 'legs = ["rod"]\n[[effect]]', ["legs", "no effect 'rod'"]),
    ("absolute = true", 'absolute = true\nstep = "-1 mm"', ["step", "positive"]),
    ("absolute = true", 'absolute = true\nsignals = ["extensoin"]', ["signals", "did you mean 'extension'?"]),
    ("absolute = true", 'absolute = true\nkinds = ["benhc"]', ["kinds", "did you mean 'bench'?"]),
    ("parameters =", 'expression = "velocity**2"\nparameters =', ["expression of the signals", "docs/own_model.md"]),
    ("[[effect]]", "effect", ["not valid TOML"]),
    (ENTRY, "", ["is empty; it needs one [[effect]]"]),
    (ENTRY, ENTRY + ENTRY, ["number 2", "two effects 'rod_of_another_size'"]),
])  # fmt: skip
def test_a_mistake_is_said_in_a_sentence(
    tmp_path: Path, old: str, new: str, words: list[str]
) -> None:
    assert old in ENTRY
    said = failure(with_effects(bare_rig(tmp_path), ENTRY.replace(old, new)))
    assert said.startswith(str(tmp_path / "own.toml"))
    for word in words:
        assert word in said, said


def test_a_range_beyond_what_the_parameter_may_be_and_a_share_of_nothing(tmp_path: Path) -> None:
    term = ENTRY.replace('"shifted"', '"missing"').replace("rod_diameter", "panhard_friction")
    nothing = term.replace('["-10 mm", "25 mm"]', "[-1.0, 0.0]")
    path = with_effects(bare_rig(tmp_path), nothing)
    assert "leaves panhard_friction no room within 0 to" in failure(path)
    share = term.replace('"missing"', '"shifted"').replace("absolute = true\n", "")
    (tmp_path / "own.toml").write_text(share)
    assert "declared as 0" in failure(path) and "absolute = true" in failure(path)


def test_a_file_that_is_not_there_is_said_by_the_rig_file(tmp_path: Path) -> None:
    path = with_effects(bare_rig(tmp_path))
    (tmp_path / "own.toml").rename(tmp_path / "owm.toml")
    assert "[effects] file: there is no file of effects" in failure(path)
    assert "did you mean 'owm.toml'?" in failure(path)


def test_a_mistake_is_said_before_records_are_read(tmp_path: Path) -> None:
    path = with_effects(bare_rig(tmp_path), ENTRY.replace('"force"', '"forces"'))
    with pytest.raises(InputError, match="'forces' is not known"):
        diagnose(path)
