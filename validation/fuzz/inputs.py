"""Inputs that are right, small enough to be answered in seconds; each is spoilt afterwards.

A `Base` is a folder of files and the command that answers them. Rigs and records are those of the independent
simulators (validation/twins), cut short; logs of a bus come from the virtual rig.
"""

from __future__ import annotations

import shutil
from collections.abc import Collection
from copy import copy
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from sms.io.signals import KINDS

SEED = 3
LOG_ENDINGS = (".asc", ".log", ".blf", ".csv", ".trc", ".mf4", ".db")


@dataclass(frozen=True)
class Base:
    """One command, the folder it runs in and how often it is drawn."""

    folder: str
    command: tuple[str, ...]
    weight: float = 1.0
    spoils: tuple[str, ...] = ("*.toml", "*.csv*")
    """Files that may be spoilt, by their names; none: the command's own words only."""
    words: float = 0.1
    """Share of cases in which the command's own words are spoilt, not a file."""
    program: str = "sms"


OUT = ("--out", "out")
RIG = ("rig.toml", *OUT)
PAIR = ("record.csv", "other.csv")
DRAFT = ("--yes", "--out", "out/rig.toml")
BASES = (
    Base("tank", ("diagnose", *RIG), 3.0),
    Base("bench", ("diagnose", *RIG), 1.0),
    Base("cylinder", ("diagnose", *RIG), 2.0),
    Base("platform", ("diagnose", *RIG), 0.4),
    Base("logged", ("diagnose", *RIG), 0.7, ("*.toml", "*.asc", "*.dbc")),
    Base("own", ("diagnose", *RIG), 1.0, ("own.toml",)),
    Base("tank", ("limits", *RIG), 0.7),
    Base("bench", ("new", "bench", *PAIR, *DRAFT), 1.5, PAIR, 0.3),
    Base("drafts", ("new", "tank", *PAIR, *DRAFT), 0.7, PAIR, 0.3),
    Base("bench", ("new", "bench", *PAIR, "--column", "extension=extension [m]", "--unit", "extension=mm",
                   "--scale", "extension=1e3", "--parameter", "stroke=300 mm",
                   "--validate", "1", *DRAFT), 1.0, PAIR, 0.9),
    Base("flow", ("identify", "flow", *RIG), 2.0),
    Base("friction", ("identify", "friction", *RIG), 2.0),
    Base("spool", ("identify", "spool", *RIG), 2.0),
    Base("bench", ("identify", "spool", *RIG), 0.7),
    Base("bench", ("identify", "actuator", *RIG), 1.5),
    Base("bench", ("noise", "record.csv", "--signal", "extension", *OUT), 2.0, ("record.csv",)),
    Base("bench", ("compare", *PAIR, *OUT), 2.0, PAIR),
    Base("scenario", ("simulate", "platform.toml", *OUT), 2.0, ("platform.toml",)),
    Base("scenario", ("simulate", "bench.toml", *OUT), 1.0, ("bench.toml",)),
    Base("scenario", ("simulate", "tank.toml", *OUT), 1.0, ("tank.toml",)),
    Base("scenario", ("simulate", "deck.toml", *OUT), 2.0, ("deck.*",)),
    Base("scenario", ("sweep", "sweep.toml", "--workers", "1", *OUT), 1.0, ("sweep.toml",)),
    Base("tank", ("export", "fmu", "tank", "rig.toml", "--fmi", "3.0", *OUT), 0.5, ("*.toml",), 0.3),
    Base("platform", ("export", "fmu", "platform", "rig.toml", *OUT), 0.5, ("*.toml",), 0.3),
    *(
        Base("logs", ("can", "table", f"run{ending}", "--out", "out/run.csv"), 0.7, (f"run{ending}",))
        for ending in LOG_ENDINGS
    ),
    Base("logs", ("can", "replay", "run.asc", "--speed", "0"), 0.5, ("run.asc",)),
    Base("logs", ("can", "monitor", "--log", "run.log", "--speed", "1000", "--seconds", "1"), 0.5,
         ("run.log",)),
    Base("logs", ("can", "drive", "deck.csv", "--scale", "1"), 0.3, ("deck.csv",), 0.5),
    Base("logs", ("can", "set", "position_gain=20"), 0.3, (), 1.0),
    Base("logs", ("can", "get", "position_gain", "--changed"), 0.2, (), 1.0),
    Base("logs", ("can", "record", "out/bus.asc", "--seconds", "0.2"), 0.2, (), 1.0),
    Base("logs", ("can", "rig", "--interface", "none", "--fault", "sensor_stuck:2@5s", "--effect",
                  "valve_leakage=2e-10", "--seed", "1"), 0.5, (), 1.0),
    Base("poses", ("calibrate", "geometry", "poses.toml", *OUT), 2.0, ("poses.toml", "poses.csv")),
    Base("poses", ("export", "c-params", "geometry.toml", "-o", "out/as_built.h"), 0.5, ("geometry.toml",)),
    Base("poses", ("simulate", "platform.toml", "--set", "geometry.toml", *OUT), 0.5, ("geometry.toml",)),
    Base("mechanism", ("ik", "--mechanism", "rps.toml", "--roll", "5", "--z", "1", "--deg"), 0.7, ("rps.toml",), 0.3),
    Base("mechanism", ("fk", "--mechanism", "rps.toml", "--length", "1.02", "--length", "1.03", "--length", "1.0"),
         0.7, ("rps.toml",), 0.3),
    Base("mechanism", ("fk", "--mechanism", "hexapod.toml", *(w for _ in range(6) for w in ("--length", "1.2"))),
         0.5, ("hexapod.toml",), 0.3),
    Base("mechanism", ("workspace", "--mechanism", "rps.toml"), 0.3, ("rps.toml",)),
    Base("mechanism", ("path", "--mechanism", "rps.toml", "path.csv", "--json"), 1.0, ("rps.toml", "path.csv")),
    Base("bench", ("watch", "rig.toml", "--play", "record.csv", "--learn", "120", "--quiet", *OUT), 0.7,
         ("rig.toml", "record.csv"), 0.3),
    Base("answers", ("history", "out/h.sqlite", "--add", "one.json", "--add", "two.json", *OUT), 1.0, ("*.json",)),
    Base("answers", ("compare-diagnoses", "one.json", "two.json", "--json", "out/c.json"), 0.7, ("*.json",)),
    Base("words", ("ik", "--roll", "5", "--pitch", "-2", "--height", "0.5", "--deg"), 1.0, (), 1.0),
    Base("words", ("fk", "--extension", "0.2", "0.21", "0.19", "--set", "stroke=0.4"), 1.0, (), 1.0),
    Base("words", ("workspace", "--set", "payload_mass=280", *OUT), 0.3, (), 1.0),
    Base("words", ("requirements", "--set", "payload_mass=280", "--controller", "pid", *OUT), 0.2,
         (), 1.0),
    Base("words", ("design", *OUT), 0.1, (), 1.0),
    Base("words", ("validate", "--only", "nothing", "--json", "rows.json", *OUT), 0.3, (), 1.0),
    Base("words", ("--height", "0.5", "--range", "0.1", "--step", "0.02", "--params", "stroke=0.4",
                   "--points", "100", "--seed", "1", "--max-error", "1e-2", "-o", "out/table.npz"),
         3.0, (), 1.0, "ik_tables"),
)  # fmt: skip

SCENARIO = """\
[scenario]
title = "Small"
plant = "{plant}"
duration = "1 s"
[model]
valve_law = "classic"
tolerance = 1e-6
[controller]
kind = "{controller}"
[parameters]
coulomb_force = "38 N"
[output]
every = "10 ms"
"""
SEA = """[sea]\nstate = 2\nseed = 1\nheave = true\nfade = "0.3 s"\n[start]\nheight = "0.5 m"\n"""
SINE = """[excitation]\nkind = "sine"\naxis = "actuators"\namplitude = "20 mm"\nfrequency = "1 Hz"
delay = "0.1 s"\n[start]\nextension = "0.2 m"\nload_force = "0 N"\n"""
STEPS = """[excitation]\nkind = "steps"\naxis = "actuators"\namplitude = "2 V"\nlevels = [1, -1]\nhold = "0.4 s"\n"""
DECK = """[deck_motion]\nfile = "deck.csv"\nscale = 1.0\nband_high = "1 Hz"\nfade = "0.3 s"\nbeyond = "clip"
time = "time"\nroll = "roll"\npitch = "pitch"\nheave = "heave [m]"\n"""
SWEEP = """\
[sweep]
scenario = "bench.toml"
samples = 2
seed = 1
draw = "latin_hypercube"

[vary.coulomb_force]
mean = "38 N"
deviation = "4 N"

[vary.supply_pressure]
grid = ["4.5 bar", "5 bar"]
"""
POSES = """\
[rig]
name = "drawn"
kind = "poses"
poses = "poses.csv"
[noise]
extension = "0.1 mm"
roll = "0.02 deg"
pitch = "0.02 deg"
[tolerances]
joint = "5 mm"
[distances.tape]
ground = ["0.1 m", "0 m", "0 m"]
platform = ["0.1 m", "0 m", "-1.5 m"]
noise = "1 m"
"""
GEOMETRY = """\
[parameters]
base_joint_1_x = { value = "1.3701 m", uncertainty = "1 mm" }
actuator_length_offset_2 = { value = "-0.3 mm", uncertainty = "0.2 mm" }
"sensor_gain_extension:2" = { value = 0.004, uncertainty = 1e-3 }
"""
OWN = """\
legs = []

[[effect]]
id = "rod_of_another_size"
kind = "shifted"
parameters = ["rod_diameter"]
block = "force"
title = "the rod has another diameter"
cause = "A cylinder of the same bore with a reinforced rod was mounted."
absolute = true
plausible = ["-10 mm", "25 mm"]
needs = ["motion"]
"""


def write_inputs(root: Path, folders: Collection[str]) -> None:
    """These folders of BASES, and those beside them that are made together."""
    if set(folders) <= {"scenario"}:  # made from nothing: the machines of the others take seconds
        _scenarios(root / "scenario")
        return
    for kind in ("tank", "bench", "platform"):
        _twin(kind, root / kind)
    _cylinder(root / "cylinder")
    _test_benches(root)
    (root / "drafts").mkdir()
    for kind, folder in (("bench", "bench"), ("tank", "drafts")):
        for file, name in zip(sorted((root / kind).glob("*.csv"))[:2], PAIR, strict=True):
            shutil.copy(file, root / folder / name)
    shutil.copytree(root / "bench", root / "own")
    with (root / "own" / "rig.toml").open("a") as rig:
        rig.write('\n[effects]\nfile = "own.toml"\n')
    (root / "own" / "own.toml").write_text(OWN)
    _scenarios(root / "scenario")
    _logs(root)
    _poses(root / "poses")
    shutil.copy(root / "scenario" / "platform.toml", root / "poses")
    _mechanisms(root / "mechanism")
    _answers(root)
    (root / "words").mkdir()


def _twin(kind: str, folder: Path) -> None:
    from validation.twins.draw import RIGS, draw_trial, write_trial  # noqa: PLC0415 (compiles)

    trial = draw_trial(kind, SEED, "none", 3.0)
    short: Any = copy(RIGS[kind])
    short.duration = 2.0 if kind == "platform" else 3.0
    two = trial.runs[1:3]  # one to identify with, one to validate with
    write_trial(replace(trial, rig=short, runs=two), folder, folder.with_suffix(".truth"))


def _cylinder(folder: Path) -> None:
    from validation.twins.cylinder.draw import draw  # noqa: PLC0415

    draw(SEED, folder, folder.with_suffix(".truth"), "none")
    for file in folder.glob("*.csv"):
        lines = file.read_text().splitlines()
        file.write_text("\n".join(lines[:1500]) + "\n")


def _test_benches(root: Path) -> None:
    from validation.twins import flow_runs, flow_test, friction_runs, spool_runs  # noqa: PLC0415

    tests = [(s, replace(t, duration=3.0)) for s, t in flow_test.matrix()[20:56:12]]
    flow_runs.draw(root / "flow", SEED, tests)
    runs = tuple(
        spool_runs.Run(n, r, 500.0)
        for n, r in (("steps", "identify"), ("triangle", "identify"), ("multisine", "validate"))
    )
    spool_runs.draw(root / "spool", SEED, runs)
    strokes = tuple(
        friction_runs.Run(f, 0.05, 3.0, role)
        for f, role in ((0.5, "identify"), (0.8, "identify"), (0.6, "validate"))
    )
    friction_runs.draw(root / "friction", SEED, strokes, rate=250.0)


def _scenarios(folder: Path) -> None:
    folder.mkdir()
    for name, plant, controller, motion in (
        ("platform", "platform", "pid", SEA),
        ("bench", "bench", "state_feedback", SINE),
        ("tank", "tank", "open_loop", STEPS),
        ("deck", "platform", "pid", DECK),
    ):
        text = SCENARIO.format(plant=plant, controller=controller)
        (folder / f"{name}.toml").write_text(text + motion)
    (folder / "sweep.toml").write_text(SWEEP)
    _deck(folder / "deck.csv")


def _poses(folder: Path) -> None:
    """Poses of the platform as drawn, with an inclinometer and a tape; and a geometry such as they bring."""
    import sms  # noqa: PLC0415

    folder.mkdir()
    random = np.random.default_rng(SEED)
    low = -sms.Params()["reference_point_z"]
    q = random.uniform([-0.2, -0.2, low + 0.1], [0.2, 0.2, low + 0.3], (15, 3))
    columns = {
        f"extension_{leg} [mm]": 1e3 * column
        for leg, column in enumerate(sms.inverse_kinematics(*q.T).extension.T, 1)
    }
    columns |= {"roll [deg]": np.degrees(q[:, 0]), "pitch [deg]": np.degrees(q[:, 1])}
    pd.DataFrame(columns | {"distance_tape [m]": 1.5 + q[:, 2]}).to_csv(
        folder / "poses.csv", index=False
    )
    (folder / "poses.toml").write_text(POSES)
    (folder / "geometry.toml").write_text(GEOMETRY)


def _mechanisms(folder: Path) -> None:
    from sms import mechanisms  # noqa: PLC0415

    folder.mkdir()
    for name, shipped in (("rps", "three_rps"), ("hexapod", "dietmaier_hexapod")):
        text = resources.files(mechanisms).joinpath(f"{shipped}.toml").read_text(encoding="utf-8")
        (folder / f"{name}.toml").write_text(text)
    turned = np.linspace(0.0, 10.0, 6)
    pd.DataFrame({"z [mm]": 1000.0 + turned, "roll [deg]": turned}).to_csv(
        folder / "path.csv", index=False
    )


def _answers(root: Path) -> None:
    """Two diagnoses of the tank."""
    from sms.diagnosis import diagnose  # noqa: PLC0415
    from sms.diagnosis.result import as_json  # noqa: PLC0415

    folder = root / "answers"
    folder.mkdir()
    text = as_json(diagnose(root / "tank" / "rig.toml"))
    for name in ("one", "two"):
        (folder / f"{name}.json").write_text(text)


def _deck(file: Path) -> None:
    time = np.arange(0.0, 4.0, 0.05)
    columns = {"time [s]": time, "roll [deg]": np.sin(time), "pitch [deg]": np.cos(time) - 1.0}
    pd.DataFrame(columns | {"heave [m]": 0.01 * np.sin(2.0 * time)}).to_csv(file, index=False)


def _logs(root: Path) -> None:
    """A second of the bus in each format, and a platform whose records are such logs."""
    import can  # noqa: PLC0415 (takes its time)
    from sms.io.can_frames import DBC_FILE, load_dbc  # noqa: PLC0415

    folder, logged = root / "logs", root / "logged"
    folder.mkdir()
    logged.mkdir()
    messages = [m for m in load_dbc().messages if not m.is_multiplexed()]
    frames = []
    for tick in range(150):
        share = 0.5 + 0.1 * np.sin(0.1 * tick)
        for place, message in enumerate(messages):
            values = {
                s.name: float(s.minimum or 0.0) * (1.0 - share) + float(s.maximum or 1.0) * share
                for s in message.signals
            }
            if "sample_time" in values:
                values["sample_time"] = 0.01 * tick
            data = message.encode(values, strict=False)
            time = 1.7e9 + 0.01 * tick + 1e-4 * place
            frames.append(can.Message(time, message.frame_id, message.is_extended_frame, data=data))
    for ending in LOG_ENDINGS:
        with can.Logger(folder / f"run{ending}") as log:
            for frame in frames:
                log(frame)
    _deck(folder / "deck.csv")
    text = '[rig]\nkind = "platform"\n\n[data]\ndbc = "bus.dbc"\n\n[signals]\n'
    text += "".join(f'{signal} = "{signal}"\n' for signal in KINDS["platform"].needed)
    shutil.copy(DBC_FILE, logged / "bus.dbc")
    for name, role in (("one", "identify"), ("two", "validate")):
        shutil.copy(folder / "run.asc", logged / f"{name}.asc")
        text += f'\n[[records]]\nfile = "{name}.asc"\nrole = "{role}"\n'
    (logged / "rig.toml").write_text(text)
