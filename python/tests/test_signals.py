"""signals.def is the one list of measured signals: what Python knows of them is made from it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from sms import _core
from sms.diagnosis.design.detection_limits import published_rig
from sms.diagnosis.effects.catalogue import catalogue
from sms.io.plausible import usual_range
from sms.io.records import Record
from sms.io.signals import KINDS, LEGS, SIGNAL_UNITS, SIGNALS, column_name, label, without_leg
from sms.parameters import PARAMETERS

PACKAGE = Path(_core.__file__).parent


def test_every_signal_of_every_rig_is_a_row() -> None:
    assert {s.name for s in _core.signal_table()} == set(SIGNALS)
    for kind in KINDS.values():
        for signal in kind.signals:
            assert signal == "time" or without_leg(signal) in SIGNALS, signal
            assert signal in SIGNAL_UNITS, signal
    for name, signal in SIGNALS.items():
        assert signal.low < signal.high and signal.label
        assert 0.0 <= signal.sweep < signal.high - signal.low and signal.noise >= 0.0
        assert signal.has_sensor == (f"sensor_gain_{name}" in PARAMETERS), name
        for leg in LEGS:
            assert (f"{name}_{leg}" in SIGNAL_UNITS) == signal.of_leg, name
        if signal.has_sensor:
            assert PARAMETERS[f"sensor_offset_{name}"].unit == signal.unit
            assert signal.label in PARAMETERS[f"sensor_gain_{name}"].doc
    assert column_name("chamber_pressure_upper_2") == "chamber_pressure_upper_2 [Pa]"
    assert label("extension_3") == "position of leg 3"


def test_the_catalogue_says_signals_as_the_list_does() -> None:
    for kind in ("cylinder", "tank", "bench", "platform"):
        for effect in catalogue(kind):
            if effect.of_sensor and effect.signal is not None:
                assert label(effect.signal) in effect.title, effect.key


def test_what_no_sensor_reads_is_said() -> None:
    rig = published_rig("tank")
    time = np.arange(5.0)
    for name, good, bad in (
        ("tank_pressure", 3e5, 3e8),
        ("tank_temperature", 293.0, 20.0),
        ("valve_command", 5.0, 5000.0),
    ):
        for value, count in ((good, 0), (bad, 1)):
            signals = {"time": time, name: np.array([good, good, value, good, np.nan])}
            record = Record(
                "run", "identify", Path("run.csv"), signals, frozenset(), (), np.arange(1, 6)
            )
            found = list(usual_range(rig, record))
            assert len(found) == count, (name, value)
            assert all(f.severity == "warning" and f.line == 3 for f in found)


def _second_lists(tree: ast.AST) -> Iterator[int]:
    """Lines where a unit, a label or a size stands beside the name of a signal."""
    names, units = set(SIGNALS), {s.unit for s in SIGNALS.values()}
    words = units | ({s.label for s in SIGNALS.values()} - names)

    def is_name(node: ast.AST | None) -> bool:
        return isinstance(node, ast.Constant) and node.value in names

    def says(node: ast.AST) -> bool:
        return isinstance(node, ast.Constant) and (
            isinstance(node.value, float) or node.value in words
        )

    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            pairs = zip(node.keys, node.values, strict=True)
            if any(is_name(key) and says(value) for key, value in pairs):
                yield node.lineno
        elif isinstance(node, ast.Tuple) and len(node.elts) == 2:
            name, said = node.elts
            if is_name(name) and says(said):
                yield node.lineno


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ('UNITS = {"extension": "m"}', 1),
        ('LABELS = {"rod_force": "rod force"}', 1),
        ('RANGE = {"x": 1.0, "tank_pressure": 1e5}', 1),
        ('COLUMNS = (("tank_temperature", "K"),)', 1),
        ('ORDER = {"tank_pressure": 1, "height": "m"}', 0),
    ],
)
def test_a_second_list_would_be_seen(text: str, count: int) -> None:
    assert len(list(_second_lists(ast.parse(text)))) == count


def test_there_is_no_second_list() -> None:
    # Of a deck, a pose or a set-point on the bus: they name axes of a motion, not sensors.
    motions = {"motion/deck.py", "link/motion.py", "kinematics.py"}
    second = [
        f"{path.relative_to(PACKAGE)}:{line}"
        for path in sorted(PACKAGE.rglob("*.py"))
        for line in _second_lists(ast.parse(path.read_text(encoding="utf-8")))
        if path.relative_to(PACKAGE).as_posix() not in motions
    ]
    assert not second
