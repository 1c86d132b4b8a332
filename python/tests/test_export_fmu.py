"""Exported FMUs run in fmpy as `sms simulate` runs here; files: test_export_fmu_files.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_support import (
    PERIOD,
    SAID,
    SAME,
    TIME,
    TOLERANCE,
    Slave,
    outputs_of,
    same,
    simulated,
)
from sms import Params, simulate_bench, simulate_platform, simulate_tank

BOTH = pytest.mark.parametrize("version", ("2.0", "3.0"))


# ---- the motion ----------------------------------------------------------------------------------------------


@BOTH
def test_bench_runs_as_here(exported: Any, version: str) -> None:
    command = 5.0 + 1.5 * np.sign(np.sin(9.0 * TIME)) + 0.3 * np.sin(31.0 * TIME)
    load = np.where(TIME > 0.3, 60.0, 0.0)
    run = simulate_bench(command, load_force=load, extension=0.2, tolerance=TOLERANCE)
    inputs = {"valve_command": command, "load_force": load}
    steady = [name for name in outputs_of("bench") if name not in ("acceleration", "friction")]
    same(simulated(exported("bench", version), PERIOD, inputs, steady), run, "bench")
    # At a sample where the load jumps the run's row has the acceleration after it, the FMU's output that before.
    jumping = simulate_bench(command, extension=0.2, tolerance=TOLERANCE)
    inputs["load_force"] = 0.0 * load
    found = simulated(exported("bench", version), PERIOD, inputs, outputs_of("bench"))
    same(found, jumping, "bench")


@BOTH
def test_platform_runs_as_here(exported: Any, version: str) -> None:
    waves = [1.2 * np.sin(7.0 * TIME), -1.0 * np.sin(11.0 * TIME), 0.8 * np.sin(5.0 * TIME)]
    command = 5.0 + np.column_stack(waves)
    wrench = np.zeros((TIME.size, 6))
    wrench[:, 0], wrench[:, 4] = 40.0 * np.sin(3.0 * TIME), 20.0 * np.sin(4.0 * TIME)
    run = simulate_platform(command, controller="open_loop", wrench=wrench, tolerance=TOLERANCE)
    inputs = {f"valve_command_{leg}": command[:, leg - 1] for leg in (1, 2, 3)}
    inputs |= {"force_x": wrench[:, 0], "moment_y": wrench[:, 4]}
    steady = [n for n in outputs_of("platform") if "acceleration" not in n and "friction" not in n]
    same(simulated(exported("platform", version), PERIOD, inputs, steady), run, "platform")


@BOTH
def test_tank_runs_as_here(exported: Any, version: str) -> None:
    command = 5.0 + 2.0 * np.sign(np.sin(9.0 * TIME))
    run = simulate_tank(command, tolerance=TOLERANCE)
    found = simulated(
        exported("tank", version), PERIOD, {"valve_command": command}, outputs_of("tank")
    )
    same(found, run, "tank")


@BOTH
def test_laws_and_effects_run_as_here(exported: Any, version: str) -> None:
    """Every choice, and effects that sit between the plant's parts: dead time, a tube, a slow sensor, electronics."""
    command = 5.0 + 1.5 * np.sign(np.sin(9.0 * TIME))
    effects = {
        "command_delay": 3.4e-3,
        "tube_length": 2.0,
        "sensor_lag_extension": 0.02,
        "sensor_gain_chamber_pressure_lower": 0.05,
        "backlash": 1e-3,
        "presliding_share": 0.5,
        "supply_line_resistance": 1e6,
        "friction_lag": 0.02,
    }
    run = simulate_bench(
        command,
        extension=0.15,
        params=Params(**effects),
        friction_law="stribeck",
        chamber_law="energy",
        valve_law="iso_0_2_mpa",
        electronics=True,
        tolerance=1e-8,
    )
    starts = effects | {
        "start_extension": 0.15,
        "friction_law": 3,
        "chamber_law": 2,
        "valve_law": 2,
        "electronics": True,
        "integrator_tolerance": 1e-8,
    }
    found = simulated(
        exported("bench", version), PERIOD, {"valve_command": command}, outputs_of("bench"), starts
    )
    same(found, run, "bench")


@BOTH
@pytest.mark.parametrize("law", ["pid", "state_feedback"])
def test_a_loop_of_two_fmus_is_the_loop_here(opened: Any, version: str, law: str) -> None:
    """The controllers step before the platform: what they read at a sample is at the valves from that sample on."""
    setpoint = 0.2 + 0.03 * np.column_stack(
        [np.sin(6.0 * TIME), np.cos(5.0 * TIME) - 1.0, np.sin(4.0 * TIME)]
    )
    run = simulate_platform(setpoint, controller=law, tolerance=TOLERANCE)
    platform = opened("platform", version)
    controllers = [opened("controller", version) for _ in range(3)]
    platform.begin()
    for controller in controllers:
        controller.begin(law=1 if law == "pid" else 2)
    rows = []
    for wanted in setpoint:
        measured = platform.get(*(f"measured_extension_{leg}" for leg in (1, 2, 3)))
        rows.append(platform.get("roll", "pitch", "height"))
        for leg, controller in enumerate(controllers):
            controller.set(setpoint=wanted[leg], measured_extension=measured[leg])
            controller.step(PERIOD)
            platform.set(**{f"valve_command_{leg + 1}": controller.get("valve_command")[0]})
        platform.step(PERIOD)
    here = np.column_stack([run[name] for name in ("roll", "pitch", "height")])
    assert np.ptp(here[:, 2]) > 1e-3
    assert np.abs(np.array(rows) - here).max() <= SAME * 0.2


@BOTH
def test_results_do_not_depend_on_the_step_of_the_master(opened: Any, version: str) -> None:
    """Inputs are looked at on multiples of the control period, whatever the communication step is."""
    ends = []
    for sizes in ([PERIOD] * 40, [4 * PERIOD] * 10, [0.4 * PERIOD] * 100, [2.5 * PERIOD] * 16):
        bench = opened("bench", version)
        bench.begin(valve_command=6.5)
        for size in sizes:
            bench.step(size)
        ends.append(bench.get("extension", "chamber_pressure_lower", "reading_extension"))
    assert ends[0] == pytest.approx(ends[1], rel=1e-14)
    assert ends[0] == pytest.approx(ends[2], rel=1e-12)
    assert ends[0] == pytest.approx(ends[3], rel=1e-12)


@BOTH
def test_between_two_samples_the_plant_is_where_it_is(opened: Any, version: str) -> None:
    bench = opened("bench", version)
    bench.begin(valve_command=8.0)
    bench.step(20 * PERIOD)
    first = bench.get("extension", "reading_extension")
    bench.step(0.5 * PERIOD)
    second = bench.get("extension", "reading_extension")
    bench.step(0.5 * PERIOD)
    third = bench.get("extension", "reading_extension")
    assert first[0] < second[0] < third[0]
    assert first[1] == second[1] < third[1]


# ---- instances and states ------------------------------------------------------------------------------------


@BOTH
def test_two_instances_know_nothing_of_each_other(opened: Any, version: str) -> None:
    one, other, alone = (opened("bench", version) for _ in range(3))
    one.begin(valve_command=6.0)
    other.begin(valve_command=3.0, coulomb_force=60.0)
    for _ in range(50):
        one.step(PERIOD)
        other.step(PERIOD)
    alone.begin(valve_command=6.0)
    for _ in range(50):
        alone.step(PERIOD)
    assert one.get("extension") == alone.get("extension") != other.get("extension")


@BOTH
@pytest.mark.parametrize("kind", ["bench", "platform", "tank"])
def test_a_state_is_gone_back_to_with_the_same_bits(opened: Any, kind: str, version: str) -> None:
    volts = "valve_command_1" if kind == "platform" else "valve_command"
    names = outputs_of(kind)
    slave = opened(kind, version)
    slave.begin()

    def run(of: Slave) -> list[list[float]]:
        rows = []
        for k in range(30):
            of.set(**{volts: 5.0 + 1.5 * np.sin(0.3 * k)})
            of.step(PERIOD if k % 3 else 1.3 * PERIOD)
            rows.append(of.get(*names))
        return rows

    run(slave)
    time, kept = slave.time, slave.state()
    first = run(slave)
    slave.go_to(kept, time)
    assert run(slave) == first
    fresh = opened(kind, version)  # never initialised
    fresh.go_to(kept, time)
    assert run(fresh) == first


@BOTH
def test_a_controller_goes_back_too(opened: Any, version: str) -> None:
    one = opened("controller", version)
    one.begin(integral_gain=5.0)

    def run() -> list[float]:
        rows = []
        for k in range(10):
            one.set(setpoint=0.2, measured_extension=0.19 + 1e-3 * k)
            one.step(PERIOD)
            rows += one.get("valve_command")
        return rows

    run()
    time, kept = one.time, one.state()
    first = run()
    one.go_to(kept, time)
    assert run() == first


@BOTH
def test_octets_that_are_no_state_are_refused(opened: Any, version: str) -> None:
    bench, tank = opened("bench", version), opened("tank", version)
    bench.begin()
    kept = bench.state()
    assert "no state" in bench.refused(lambda: bench.go_to(b"nothing", 0.0))
    assert "no state" in bench.refused(lambda: bench.go_to(kept[:-9], 0.0))
    assert "another model" in tank.refused(lambda: tank.go_to(kept, 0.0))


@BOTH
def test_reset_is_a_new_instance(opened: Any, version: str) -> None:
    bench, fresh = opened("bench", version), opened("bench", version)
    bench.begin(valve_command=7.0, coulomb_force=80.0)
    for _ in range(20):
        bench.step(PERIOD)
    bench.fmu.reset()
    for slave in (bench, fresh):
        slave.begin(start=3.0, valve_command=6.0)
        for _ in range(20):
            slave.step(PERIOD)
    names = outputs_of("bench")
    assert bench.get(*names) == fresh.get(*names)


# ---- what is refused -----------------------------------------------------------------------------------------


@BOTH
def test_a_bad_step_is_refused_in_a_sentence_and_the_run_goes_on(opened: Any, version: str) -> None:
    bench, fresh = opened("bench", version), opened("bench", version)
    for slave in (bench, fresh):
        slave.begin(valve_command=6.0)
        slave.step(PERIOD)
    bench.set(valve_command=float("nan"))
    assert "valve_command is nan" in bench.refused(lambda: bench.step(PERIOD))
    bench.set(valve_command=6.0)
    for size in (-PERIOD, 0.0, float("nan"), float("inf")):
        assert "communication step of" in bench.refused(lambda s=size: bench.step(s))
    bench.time += 1.0
    assert "the instance is at 0.001 s" in bench.refused(lambda: bench.step(PERIOD))
    bench.time -= 1.0
    for slave in (bench, fresh):
        slave.step(PERIOD)
    assert bench.get("extension") == fresh.get("extension")


@BOTH
def test_a_parameter_out_of_bounds_is_refused_with_name_value_and_range(
    opened: Any, version: str
) -> None:
    bench = opened("bench", version)
    said = bench.refused(lambda: bench.begin(supply_pressure=5e6))
    assert said == "the parameter supply_pressure is 5000000 Pa; allowed are 50000 to 1200000 Pa"
    bench.set(supply_pressure=float("nan"))
    assert "supply_pressure is nan" in bench.refused(bench.fmu.exitInitializationMode)
    bench.set(supply_pressure=5e5, rod_diameter=0.2)
    assert "does not go into a bore" in bench.refused(bench.fmu.exitInitializationMode)
    bench.set(rod_diameter=0.02)
    bench.fmu.exitInitializationMode()
    assert "is fixed" in bench.refused(lambda: bench.set(supply_pressure=5e5))
    assert "cannot be set" in bench.refused(lambda: bench.set(extension=0.1))


@BOTH
def test_a_platform_of_one_leg_apart(opened: Any, version: str) -> None:
    platform = opened("platform", version)
    said = platform.refused(lambda: platform.begin(actuator_2__coulomb_force=-60.0))
    assert "actuator_2.coulomb_force" in said
    platform.set(actuator_2__coulomb_force=0.0, start_height=5.0)
    assert "workspace" in platform.refused(platform.fmu.exitInitializationMode)


@BOTH
def test_a_binary_of_another_version_is_refused(
    exported: Any, tmp_path: Path, version: str
) -> None:
    with pytest.raises(Exception, match="nstantiate"):
        Slave(exported("bench", version), tmp_path / "unpacked", token="sms 0.0.1 bench")
    assert "export the FMU again" in SAID[-1]
