"""Bad input of the compiled module that `validation.fuzz bindings` found no answer to: each is refused in words now."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sms import _core

Array = NDArray[np.float64]
SAMPLES = 60
NOISE = {
    "extension": 1e-4,
    "chamber_pressure_lower": 500.0,
    "chamber_pressure_upper": 500.0,
    "supply_pressure": 500.0,
}


def record(**changed: Any) -> _core.BenchRecord:
    pressure = np.full(SAMPLES, 3e5)
    return _core.BenchRecord(**{
        "step": 5e-3,
        "command": np.full(SAMPLES, 5.0),
        "extension": np.full(SAMPLES, 0.2),
        "pressure_lower": pressure,
        "pressure_upper": pressure,
    } | changed)  # fmt: skip


def problem(**changed: Any) -> _core.BenchProblem:
    return _core.BenchProblem(**{"records": [record()], "noise": NOISE, "window": 0.1} | changed)


def made_by_new(name: str) -> Any:
    cls = getattr(_core, name)
    return cls.__new__(cls)


@pytest.mark.parametrize(
    "name", ["Params", "LegParams", "BenchProblem", "CylinderProblem", "Controller", "VirtualRig"]
)
def test_an_object_without_its_constructor_is_none(name: str) -> None:
    with pytest.raises(TypeError, match="not safe"):
        made_by_new(name)


def test_a_class_of_python_derives_from_one_of_the_core() -> None:
    class Heavier(_core.Params):
        def __init__(self) -> None:
            super().__init__(payload_mass=2.0)

    assert Heavier().payload_mass == 2.0
    assert Heavier().copy() == _core.Params(payload_mass=2.0)


@pytest.mark.parametrize(("call", "error", "words"), [
    (lambda: problem().hidden(_core.Params(), 1), ValueError, "knots = 1; from 2 to"),
    (lambda: problem().hidden(_core.Params(), 10**6), ValueError, "knots = 1000000; from 2 to"),
    (lambda: problem().state(_core.Params(), 2**32), IndexError, "window 4294967296 of 2, which count from 0"),
    (lambda: problem(noise={"extension": 1e-4}), KeyError, "noise has no standard deviation of '"),
    (lambda: problem(noise=NOISE | {"extension": 0.0}), ValueError, "noise of extension is 0; a standard dev"),
    (lambda: problem(records=[record(command=[], setpoint=np.zeros(SAMPLES))]), ValueError, "record 0 has no command"),
    (lambda: problem(threads=0), ValueError, "threads = 0; at least one"),
    (lambda: _core.raise_status(1, "half\x00whole"), _core.NotANumberError, "half\x00whole"),
    (lambda: _core.Params(**{"\udcff": 1.0}), UnicodeEncodeError, "surrogates not allowed"),
    (lambda: _core.Params(coulomb_force="20"), TypeError, "coulomb_force has to be a number, not str"),
    (lambda: _core.pack_frame("ModeRequest", {}), KeyError, "'ModeRequest' has a signal '.*', values has none"),
    (lambda: _core.status_string(99), ValueError, "status = 99 is none of the numbers from 0 to 5"),
    (lambda: _core.Controller().counts([0.2] * 3, [3e5] * 3, [3e5] * 3, np.nan), _core.NotANumberError, "supply is"),
    (lambda: _core.Controller(reset_cause=7), ValueError, "reset_cause = 7 is none of the numbers from 0 to 2"),
    (lambda: _core.dynamics_terms(_core.Params(), -1, np.zeros((1, 3)), np.zeros((1, 3))), ValueError, "masses = -1"),
    (lambda: _core.reservoir_pressure_rate(_core.Params(), np.zeros(7), np.zeros(2)), ValueError, "7 and of 2"),
])  # fmt: skip
def test_what_was_wrong_is_said(
    call: Callable[[], object], error: type[Exception] | tuple[type[Exception], ...], words: str
) -> None:
    with pytest.raises(error, match=words):
        call()


def test_more_threads_than_windows_are_not_made() -> None:
    found = problem(threads=2**31 - 1).errors(_core.Params())
    assert found.tobytes() == problem().errors(_core.Params()).tobytes()


def test_a_load_of_the_processor_that_is_no_number_is_none() -> None:
    answers = [_core.Controller().tick([0] * 10, load=load).frames for load in (0.0, np.nan, -1.0)]
    assert answers[0] == answers[1] == answers[2]


def test_two_threads_may_ask_one_problem() -> None:
    shared, params = problem(), _core.Params()
    wrong: list[Exception] = []

    def ask() -> None:
        try:
            for _ in range(5):
                shared.evaluate(params, ["coulomb_force", "mass_flow_gain"])
                shared.settle(params)
                assert len(shared.windows) == 2
        except Exception as error:
            wrong.append(error)

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


@pytest.mark.parametrize("shape", [(), (3,), (2, 3)])
def test_equations_broadcast_as_before(shape: tuple[int, ...]) -> None:
    p, voltage = _core.Params(), np.linspace(4.0, 6.0, int(np.prod(shape))).reshape(shape)
    one = _core.thermocouple_temperature(p, voltage, 295.0)
    assert np.shape(one) == shape
    assert isinstance(one, float) == (shape == ())
    column = _core.thermocouple_temperature(p, voltage[..., None], np.array([290.0, 295.0]))
    np.testing.assert_array_equal(column[..., 1], one)
