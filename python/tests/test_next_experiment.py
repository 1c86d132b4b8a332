"""What to measure next where nothing has a name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from sms.diagnosis.design.detection_limits import published_rig
from sms.diagnosis.design.next_experiment import next_experiment, same_experiment
from sms.diagnosis.remainder import Hidden, Shape
from sms.rigs.kinds import KINDS


@pytest.mark.parametrize(
    ("signal", "title", "said"),
    [
        ("velocity [m/s]", "A run that moves velocity alone", "follows velocity or something"),
        (
            "time [s]",
            "The machine at rest, for as long as a run",
            "from outside, or with the motion",
        ),
    ],
)
def test_an_unknown_asks_for_a_run_that_can_be_made(signal: str, title: str, said: str) -> None:
    shape = Shape("force", signal, (0.0, 1.0), (0.0, 1.0), (0.1, 0.1), "N", 0.9)
    nothing: Any = None  # neither model nor records are asked
    asked = next_experiment(
        "unknown", [], nothing, nothing, Hidden({"force": (0.9, 0.8, 1.0)}, {}, shape)
    )
    assert asked is not None
    assert asked.title == title
    assert said in asked.purpose and "in force" in asked.purpose


@pytest.mark.parametrize("name", list(KINDS))
def test_a_proposed_record_holds_what_the_sensors_say(name: str) -> None:
    rig, kind = published_rig(name), KINDS[name]
    healthy, off = rig.start(), rig.start()
    off["sensor_offset_supply_pressure"] = 5e3
    run = kind.menu[0].simulated(rig, healthy, kind.outputs)
    wrong = kind.menu[0].simulated(rig, off, kind.outputs)
    assert run is not None and wrong is not None
    assert set(kind.outputs) <= set(run.signals)
    for signal, values in run.signals.items():
        more = 5e3 if signal == "supply_pressure" else 0.0
        np.testing.assert_allclose(wrong.signals[signal] - values, more, rtol=0.0, atol=1e-6)


@pytest.mark.parametrize("name", list(KINDS))
def test_a_run_of_the_menu_is_told_from_the_others_on_a_machine_that_is_a_little_off(
    name: str,
) -> None:
    rig, kind = published_rig(name), KINDS[name]
    as_fitted, machine = rig.start(), rig.start()
    machine["mass_flow_gain"] = 0.98 * rig.start()["mass_flow_gain"]
    machine["valve_centre"] = rig.start()["valve_centre"] + 0.005
    runs = [e.simulated(rig, as_fitted, kind.outputs) for e in kind.menu]
    records = [e.simulated(rig, machine, kind.outputs) for e in kind.menu]
    for i, run in enumerate(runs):
        for j, record in enumerate(records):
            if run is not None and record is not None:
                assert same_experiment(run, record) == (i == j), (
                    kind.menu[i].title,
                    kind.menu[j].title,
                )
