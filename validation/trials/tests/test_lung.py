"""The test lung: its equations, what is known beforehand and from what, and how answers are scored."""

from __future__ import annotations

import gzip
import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sms.diagnosis import Diagnosis, own
from sms.diagnosis.result import Cause, ParameterValue
from sms.io import InputError

from validation.random_cases import draw
from validation.trials import lung
from validation.trials.lung_calibration import Calibration, calibrate, known, noise
from validation.trials.lung_model import (
    CMH2O,
    ML,
    ML_PER_CMH2O,
    REFERENCE_FLOW,
    TESTS,
    Known,
    Setting,
    Test,
    derivative,
    model,
    read_tests,
)

Test.__test__ = False  # type: ignore[attr-defined]  # a record of the lung, not a test of pytest's
DATA = "test_lung_respiraworks"
ROOT = Path(__file__).parents[3]
PLACES = [
    Path(p) / DATA for p in (os.environ.get("SMS_DATA"), ROOT.parent / "shared" / "data") if p
]
FOLDER = next((p for p in PLACES if p.is_dir()), None)
needs_data = pytest.mark.skipif(
    FOLDER is None,
    reason=f"the records of the test lung ({DATA}: GitHub RespiraWorks/Ventilator, Apache-2.0) are not here; "
    "set SMS_DATA to the folder that holds them",
)


def calibrations(rng: np.random.Generator) -> list[Calibration]:
    """Two days of the eight tests, with scatter of a few percent."""
    return [
        Calibration(
            f"{day}_pc_{number}",
            day,
            setting,
            0.95 + 0.03 * rng.normal(),
            setting.resistor**0.9 * 0.5 * CMH2O * np.exp(0.1 * rng.normal()),
            0.3 + 0.05 * rng.normal(),
            (0.5 + 0.2 * rng.normal()) * ML_PER_CMH2O,
            2.0 * ML * rng.normal(),
            ML * (2.0 + rng.random()),
        )
        for day in ("air", "oxy")
        for number, setting in TESTS.items()
    ]


def recorded(name: str, truth: Setting) -> Test:
    nothing = np.zeros(10)
    return Test(name, name.partition("_")[0], truth, nothing, nothing, nothing, nothing)


def answer_of(causes: Sequence[tuple[tuple[str, ...], str, float]]) -> Diagnosis:
    """Members, parameter and its value of each cause."""
    return Diagnosis(
        "lung",
        "lung",
        (),
        {},
        1,
        verdict="cause" if causes else "unknown",
        causes=tuple(
            Cause(
                *(members[0], None, "shifted parameter", "", "", "", members, ()),
                parameters=(ParameterValue(name, value, 0.01 * value, "1", 1.0),),
                p_value=0.0,
                consistency={},
                separated_by="",
                support=1.0,
            )
            for members, name, value in causes
        ),
    )


# ---- equations -------------------------------------------------------------------------------------


def test_the_flow_is_the_one_whose_drop_is_there() -> None:
    """The closed form against the law it solves, both ways through the resistor."""
    rng = draw("the flow is the one whose drop is there")
    flow = REFERENCE_FLOW * rng.uniform(-3.0, 3.0, 1000)
    share, drop = rng.uniform(0.02, 0.98, 1000), CMH2O * rng.uniform(0.5, 50.0, 1000)
    compliance = ML_PER_CMH2O * rng.uniform(5.0, 100.0, 1000)
    volume = ML * rng.uniform(-100.0, 900.0, 1000)
    x = flow / REFERENCE_FLOW
    pressure = volume / compliance + drop * (share * x + (1.0 - share) * x * np.abs(x))
    p = own.Values(
        compliance=compliance, resistor_drop=drop, linear_share=share, leak=0.0, flow_zero=0.0
    )
    found, zero = derivative(p, np.stack([volume, 0.0 * volume]), pressure[None])
    assert found == pytest.approx(flow, rel=1e-9, abs=1e-12)
    assert np.all(zero == 0.0)


def test_a_leak_leaves_the_lung_and_stays_in_the_reading() -> None:
    p = model({"compliance": Known(20.0 * ML_PER_CMH2O, 0.0)}, ML).values()
    p["resistor_drop"], p["linear_share"] = 5.0 * CMH2O, 0.3
    at = np.array([[200.0 * ML], [0.0]])
    tight = np.array(derivative(p, at, np.array([[15.0 * CMH2O]])))
    p["leak"] = ML_PER_CMH2O
    leaky = np.array(derivative(p, at, np.array([[15.0 * CMH2O]])))
    assert leaky[0] - tight[0] == pytest.approx(-10.0 * ML)
    assert np.sum(leaky, axis=0) == pytest.approx(np.sum(tight, axis=0))


# ---- what is known beforehand ----------------------------------------------------------------------


def test_the_record_that_is_judged_says_nothing_of_what_is_declared() -> None:
    """Its own calibration may be anything."""
    rng = draw("the record that is judged says nothing of what is declared")
    rows = calibrations(rng)
    judged = int(rng.integers(len(rows)))
    test = recorded(rows[judged].test, rows[judged].setting)
    absurd = replace(rows[judged], compliance_ratio=7.0, resistor_drop=1e6, rms=1.0)
    other = [*rows[:judged], absurd, *rows[judged + 1 :]]
    for setting in TESTS.values():
        assert known(setting, test, rows) == known(setting, test, other)
    assert noise(test, rows) == noise(test, other)
    neighbour = recorded("oxy_pc_3" if rows[judged].test != "oxy_pc_3" else "oxy_pc_1", TESTS[3])
    assert known(TESTS[3], neighbour, rows) != known(TESTS[3], neighbour, other)


def test_half_widths_hold_one_more_record_nineteen_times_in_twenty() -> None:
    rng = draw("half widths hold one more record nineteen times in twenty")
    inside = []
    for _ in range(200):
        rows = calibrations(rng)
        for row in (rows[1], rows[12]):
            told = known(row.setting, recorded(row.test, row.setting), rows)
            drop = told["resistor_drop"]
            inside.append(
                abs(np.log(row.resistor_drop / drop.value))
                <= np.log1p(drop.half_width / drop.value)
            )
            hoses = told["circuit_compliance"]
            inside.append(abs(row.circuit_compliance - hoses.value) <= hoses.half_width)
    assert np.mean(inside) == pytest.approx(0.95, abs=0.035)


def test_a_resistor_without_another_record_lies_on_the_line_of_the_others() -> None:
    rows = [r for r in calibrations(np.random.default_rng(1)) if r.day == "air"]
    last = recorded("air_pc_8", TESTS[8])
    told = known(TESTS[8], last, rows)["resistor_drop"]
    assert told.value == pytest.approx(10.0**0.9 * 0.5 * CMH2O, rel=0.2)
    assert told.half_width > 0.0


# ---- files and scores ------------------------------------------------------------------------------


def test_files_that_are_none_are_refused(tmp_path: Path) -> None:
    with gzip.open(tmp_path / "air_pc_9.dat.gz", "wt") as file:
        file.write("time(sec)  pc_setpoint  pressure  volume\n0.0 1 2 3\n")
    with pytest.raises(InputError, match="with N from 1 to 8"):
        read_tests(tmp_path)
    (tmp_path / "air_pc_9.dat.gz").rename(tmp_path / "air_pc_1.dat.gz")
    with gzip.open(tmp_path / "air_pc_1.dat.gz", "wt") as file:
        file.write("time  pressure\n0.0 1.0\n")
    with pytest.raises(InputError, match="the columns are not"):
        read_tests(tmp_path)


def test_each_question_is_asked_once_and_a_limit_spreads_them() -> None:
    tests = [recorded(f"air_pc_{n}", s) for n, s in TESTS.items()]
    every = lung.questions(tests)
    assert len({(s, t.name) for s, t in every}) == len(every) == 7 * 8
    assert sum(not lung.wrong_settings(s, t.truth) for s, t in every) == 8
    assert len(lung.questions(tests, 10)) == 10
    assert len({t.name for _, t in lung.questions(tests, 10)}) == 8


def test_answers_are_scored_by_what_was_set() -> None:
    truth = {"compliance": Known(2.0, 0.1), "resistor_drop": Known(5.0, 0.5)}
    test = recorded("air_pc_6", TESTS[6])

    def of(declared: Setting, *causes: tuple[tuple[str, ...], str, float]) -> lung.Answer:
        return lung.scored(declared, test, truth, answer_of(causes), 1.0)

    spring, resistor = (("compliance",), "compliance", 2.05), (("resistor",), "resistor_drop", 9.0)
    assert of(TESTS[7], spring).right
    assert of(TESTS[7], spring).within == [True]
    assert of(TESTS[4], resistor).within == [False]
    assert of(TESTS[7], resistor).wrong_name
    assert not of(TESTS[7], spring, resistor).right
    assert of(TESTS[1], spring, resistor).right
    assert not of(TESTS[1], spring).right
    assert not of(TESTS[1], spring).wrong_name
    assert of(TESTS[6]).right
    assert of(TESTS[6], spring).wrong_name
    assert of(TESTS[7], (("leak", "compliance", "volume_gain"), "leak", 1.0)).right
    crowd = (("leak", "compliance", "volume_gain", "circuit_compliance"), "leak", 1.0)
    assert not of(TESTS[7], crowd).right


# ---- the real records ------------------------------------------------------------------------------


@needs_data
def test_the_model_describes_the_real_records() -> None:
    """A stronger spring and a wider resistor come out as they were set, and little is left."""
    assert FOLDER is not None
    chosen = [t for t in read_tests(FOLDER) if t.name in ("oxy1_pc_2", "oxy1_pc_7", "redo_pc_4")]
    two, seven, redo = (calibrate(t) for t in chosen)
    for found in (two, seven, redo):
        assert found.compliance_ratio == pytest.approx(0.9, abs=0.1)
        assert found.rms < 3.0 * ML
    assert seven.resistor_drop / two.resistor_drop == pytest.approx(3.3, rel=0.2)
    assert redo.resistor_drop / two.resistor_drop == pytest.approx(1.0, rel=0.2)


@needs_data
def test_stretches_are_whole_and_reach_both_roles() -> None:
    assert FOLDER is not None
    for test in read_tests(FOLDER):
        records = test.records
        assert [r.role for r in records] == ["identify", "validate"] * 2
        assert sum(len(r.signals["time"]) for r in records) == len(test.time)
        assert np.ptp([len(r.signals["time"]) for r in records]) <= 1
