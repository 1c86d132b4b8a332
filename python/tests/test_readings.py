"""What the sensors of a simulated machine say: the truth where they are good, what the controller gets, and loggers."""

from __future__ import annotations

import numpy as np
import pytest
from sms import Params, _core, extensions_of, simulate_bench, simulate_platform, simulate_tank
from sms.simulation import Run

from validation.random_cases import draw

TIME = 1e-3 * np.arange(1000)


def bench(**truth: float) -> Run:
    wave = 0.2 + 0.05 * np.sin(6.0 * TIME)
    return simulate_bench(wave, controller="pid", params=Params(proportional_gain=20.0, **truth))


def test_good_sensors_say_the_truth_to_the_bit() -> None:
    run = bench()
    for signal in (
        "extension",
        "chamber_pressure_lower",
        "chamber_pressure_upper",
        "supply_pressure",
    ):
        assert np.array_equal(run.reading(signal), run[signal]), signal
    assert np.array_equal(run["measured_extension"], run["extension"])
    tank = simulate_tank(5.0 + np.sin(9.0 * TIME))
    for signal in ("tank_pressure", "tank_temperature", "supply_pressure"):
        assert np.array_equal(tank.reading(signal), tank[signal]), signal
    wave = 0.02 * np.sin(9.0 * TIME[:200])
    platform = simulate_platform(extensions_of(wave, wave, 0.5 + wave))
    for signal in ("extension_2", "chamber_pressure_upper_3", "roll", "pitch"):
        assert np.array_equal(platform.reading(signal), platform[signal]), signal


def test_the_controller_gets_what_its_sensor_says() -> None:
    gain = float(draw("gain of the position sensor").uniform(0.02, 0.1))
    wanted = np.full(3000, 0.25)
    params = Params(proportional_gain=20.0, integral_gain=20.0, sensor_gain_extension=gain)
    run = simulate_bench(wanted, controller="pid", extension=0.25 / (1.0 + gain), params=params)
    assert run["extension"][-1] * (1.0 + gain) == pytest.approx(0.25, abs=2e-3)
    assert np.array_equal(run["measured_extension"], run.reading("extension"))


def test_a_sensor_says_nothing_below_its_floor() -> None:
    floor = float(draw("floor of the tank's sensor").uniform(1.2e5, 2e5))
    params = Params(tank_initial_pressure=4e5, tank_pressure_floor=floor)
    tank = simulate_tank(np.full(4000, 3.0), params=params)
    assert tank["tank_pressure"][-1] < floor - 1e4
    assert np.array_equal(tank.reading("tank_pressure"), np.maximum(tank["tank_pressure"], floor))


def test_a_late_clock_moves_a_record_and_nothing_else() -> None:
    late = int(draw("late clock").integers(-40, 40))
    plain, skewed = bench(), bench(clock_skew_extension=late * 1e-3)
    assert np.array_equal(plain["extension"], skewed["extension"])
    there = np.arange(50, 950)
    assert skewed.reading("extension")[there] == pytest.approx(
        plain.reading("extension")[there - late], abs=1e-12
    )
    # Before the first sample the machine stood still; after the last nothing is known.
    held = skewed.reading("extension")[0 if late > 0 else -1]
    assert held == plain.reading("extension")[0 if late > 0 else -1] or late == 0


def test_a_channel_adds_noise_a_range_and_a_rounding() -> None:
    wave = 0.2 + 0.05 * np.sin(6.0 * TIME)
    channels = {
        "extension": _core.Channel(noise=1e-4),
        "chamber_pressure_lower": _core.Channel(resolution=1e3, rounding="down"),
        "chamber_pressure_upper": _core.Channel(low=3.3e5, high=3.4e5),
    }
    seed = int(draw("noise of a channel").integers(1 << 30))
    runs = [
        simulate_bench(wave, controller="pid", channels=channels, seed=s)
        for s in (seed, seed, seed + 1)
    ]
    off = runs[0].reading("extension") - runs[0]["extension"]
    assert np.std(off) == pytest.approx(1e-4, rel=0.2)
    assert np.array_equal(runs[0].rows, runs[1].rows)
    assert not np.array_equal(runs[0].reading("extension"), runs[2].reading("extension"))
    lower = runs[0]["chamber_pressure_lower"]
    assert np.allclose(runs[0].reading("chamber_pressure_lower"), 1e3 * np.floor(lower / 1e3))
    upper = runs[0]["chamber_pressure_upper"]
    assert np.array_equal(runs[0].reading("chamber_pressure_upper"), np.clip(upper, 3.3e5, 3.4e5))
    with pytest.raises(ValueError, match="no reading of pressure"):
        simulate_bench(wave[:5], channels={"pressure": _core.Channel()})


def test_a_run_goes_on_from_any_state() -> None:
    command = 5.0 + np.sin(9.0 * TIME)
    params = Params(friction_lag=0.05, presliding_share=0.5, heat_share=0.5)
    whole = simulate_bench(command, params=params, step=1e-3, stiff=True)
    states = whole.columns.index("acceleration")
    rest = simulate_bench(
        command[400:], params=params, step=1e-3, stiff=True, state=whole.rows[400, :states]
    )
    assert rest["extension"] == pytest.approx(whole["extension"][400:], abs=1e-12)
    with pytest.raises(ValueError, match="13 numbers"):
        simulate_bench(command[:5], state=[0.2, 0.0])


def test_a_platform_goes_on_from_any_state() -> None:
    wave = 0.03 * np.sin(9.0 * TIME[:300])
    volts = 5.0 + 20.0 * np.column_stack([wave, -wave, wave])
    whole = simulate_platform(volts, controller="open_loop", params=Params(friction_lag=0.02))
    states = whole.columns.index("yaw")
    rest = simulate_platform(
        volts[100:],
        controller="open_loop",
        params=Params(friction_lag=0.02),
        state=whole.rows[100, :states],
    )
    assert rest["roll"] == pytest.approx(whole["roll"][100:], abs=1e-6)


def test_the_stiff_step_is_as_near_as_its_size() -> None:
    command = 5.0 + np.sin(9.0 * TIME)
    exact = simulate_bench(command, tolerance=1e-9)["extension"]
    off = [
        np.max(np.abs(simulate_bench(command, step=h, stiff=True)["extension"] - exact))
        for h in (1e-3, 2.5e-4)
    ]
    assert off[0] < 2e-4 and off[1] < 0.5 * off[0]
    wave = 0.02 * np.sin(9.0 * TIME[:200])
    setpoint = extensions_of(wave, wave, 0.5 + wave)
    rolls = [
        simulate_platform(setpoint, **how)["roll"]
        for how in ({"tolerance": 1e-7}, {"step": 2.5e-4, "stiff": True})
    ]
    assert np.max(np.abs(rolls[0] - rolls[1])) < 1e-4
