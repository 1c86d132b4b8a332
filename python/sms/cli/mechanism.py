"""The commands `sms ik`, `sms fk`, `sms workspace` and `sms path`; of a mechanism given by data: by_data.py."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sms.cli.assets import Assets
from sms.errors import InputError, did_you_mean
from sms.report.assets import Place

if TYPE_CHECKING:
    from sms import ForwardKinematics, InverseKinematics, Params

AsJson = Annotated[
    bool, typer.Option("--json", help="Print JSON, in SI units, for another program.")
]
Settings = Annotated[
    list[str],
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="A parameter other than its default, in SI units; may be repeated. "
        "docs/parameters.md lists them. A file (geometry.toml) sets all that its [parameters] hold.",
    ),
]

MechanismFile = Annotated[
    str | None,
    typer.Option(
        "--mechanism",
        metavar="FILE",
        help="A mechanism given by data (docs/mechanisms.md): a TOML file, or one that is shipped: "
        "*three_rps*, *dietmaier_hexapod*.",
    ),
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command(
        epilog="Example: **sms ik --roll 5 --pitch -2 --height 0.5 --deg** prints the three "
        "extensions for a roll of 5° and a pitch of −2° at mid-stroke."
    )(ik)
    app.command(epilog="Example: **sms fk --extension 0.2 0.21 0.19 --json**")(fk)
    app.command(
        epilog="Example: **sms workspace --set payload_mass=280** checks the specified payload; "
        "look at workspace/workspace.html in a browser."
    )(workspace)
    app.command(
        epilog="Example: **sms path --mechanism three_rps poses.csv**; poses.csv has a row a pose and columns such "
        "as *z [m]*, *roll [deg]*."
    )(path)


def ik(
    roll: Annotated[float | None, typer.Option(help="Roll, rad (degrees with --deg).")] = None,
    pitch: Annotated[float | None, typer.Option(help="Pitch, rad (degrees with --deg).")] = None,
    height: Annotated[
        float | None,
        typer.Option(help="Height of the top frame's centre of gravity above ground, m."),
    ] = None,
    yaw: Annotated[float | None, typer.Option(help="With --mechanism: yaw, as roll.")] = None,
    x: Annotated[
        float | None, typer.Option("--x", help="With --mechanism: of its origin, m.")
    ] = None,
    y: Annotated[float | None, typer.Option("--y", help="With --mechanism: as x.")] = None,
    z: Annotated[float | None, typer.Option("--z", help="With --mechanism: as x.")] = None,
    deg: Annotated[bool, typer.Option("--deg", help="Angles are in degrees.")] = False,
    settings: Settings = [],  # noqa: B006 (typer copies it)
    mechanism: MechanismFile = None,
    as_json: AsJson = False,
) -> None:
    """Inverse kinematics: the actuators' extensions for a roll, a pitch and a height.

    With --mechanism: the legs' lengths; a coordinate that is not said is the home pose's.
    """
    unit = math.pi / 180.0 if deg else 1.0
    only_with_mechanism = {"x": x, "y": y, "z": z, "yaw": yaw}
    if mechanism is not None:
        _refuse_with_mechanism(settings, {"--height": height})
        said = {**only_with_mechanism, "roll": roll, "pitch": pitch}
        angles = ("roll", "pitch", "yaw")
        given = {
            name: value * (unit if name in angles else 1.0)
            for name, value in said.items()
            if value is not None
        }
        from sms.cli import by_data  # noqa: PLC0415 (numpy and the core; --help must not wait for them)

        with bad_input():
            by_data.ik(mechanism, given, as_json)
        return
    for name, value in only_with_mechanism.items():
        if value is not None:
            raise InputError(f"--{name}: it follows from roll, pitch and height; leave it out")
    if roll is None or pitch is None or height is None:
        missing = [
            n for n, v in (("roll", roll), ("pitch", pitch), ("height", height)) if v is None
        ]
        raise InputError(f"ik: --{missing[0]} is missing; say roll, pitch and height")
    from sms import inverse_kinematics  # noqa: PLC0415

    with bad_input():
        params = machine(settings)
        found = inverse_kinematics(unit * roll, unit * pitch, height, params=params)
    extension = [float(e) for e in found.extension]
    if as_json:
        values = {"extension_m": extension, **_parasitic(found), **_convergence(found)}
        _print_json("inverse_kinematics", values)
    else:
        print(f"extension  {_millimetres(extension)}   (stroke 0 to {1e3 * params.stroke:g} mm)")
        print(f"yaw        {_angle(found.yaw)}")
        print(f"x, y       {_millimetres([float(found.x), float(found.y)])}")
        print(_effort(found))
    _warn_outside(extension, params, "the machine cannot reach this pose")


def fk(
    extension: Annotated[
        tuple[float, float, float] | None, typer.Option(help="Of the three actuators, m.")
    ] = None,
    length: Annotated[
        list[float],
        typer.Option(
            help="With --mechanism: of an actuated leg, m; once for each, in their order."
        ),
    ] = [],  # noqa: B006 (typer copies it)
    settings: Settings = [],  # noqa: B006 (typer copies it)
    mechanism: MechanismFile = None,
    as_json: AsJson = False,
) -> None:
    """Forward kinematics: the platform's pose for three extensions.

    With --mechanism: for the lengths of its actuated legs, in the assembly mode of its home pose.
    """
    if mechanism is not None:
        _refuse_with_mechanism(settings, {"--extension": extension})
        from sms.cli import by_data  # noqa: PLC0415

        with bad_input():
            by_data.fk(mechanism, length, as_json)
        return
    if length:
        raise InputError(
            "--length: it is of a mechanism given by data; say --mechanism, or --extension"
        )
    if extension is None:
        raise InputError("fk: --extension is missing; give three, m")
    from sms import forward_kinematics  # noqa: PLC0415

    with bad_input():
        params = machine(settings)
        found = forward_kinematics(extension, params=params)
    if as_json:
        values = {
            "roll_rad": float(found.roll),
            "pitch_rad": float(found.pitch),
            "height_m": float(found.height),
            **_parasitic(found),
            **_convergence(found),
        }
        _print_json("forward_kinematics", values)
    else:
        print(f"roll       {_angle(found.roll)}")
        print(f"pitch      {_angle(found.pitch)}")
        print(f"height     {_millimetres([float(found.height)])}")
        print(f"yaw        {_angle(found.yaw)}")
        print(f"x, y       {_millimetres([float(found.x), float(found.y)])}")
        print(_effort(found))
    _warn_outside(extension, params, "the machine cannot have these extensions")


def workspace(
    out: Annotated[Path, typer.Option(help="Folder for workspace.html and workspace.json.")] = Path(
        "workspace"
    ),
    settings: Settings = [],  # noqa: B006 (typer copies it)
    mechanism: MechanismFile = None,
    as_json: AsJson = False,
    assets: Assets = Place.inside,
) -> None:
    """What the platform can reach: roll and pitch by height, with the required ranges drawn in.

    Also the stroke left over, the joints' angles, the distance from singularity, and whether the
    supply pressure can carry the payload. With --mechanism: how far each driven coordinate alone goes
    from the home pose, and what ends it; workspace.json only.
    """
    if mechanism is not None:
        _refuse_with_mechanism(settings, {})
        from sms.cli import by_data  # noqa: PLC0415

        by_data.workspace(mechanism, out, as_json)
        return
    from sms.io import write_text_atomically  # noqa: PLC0415 (pandas takes its time; --help must not)
    from sms.io.json_files import json_text  # noqa: PLC0415
    from sms.report.page import write_page  # noqa: PLC0415
    from sms.report.workspace import workspace_html  # noqa: PLC0415
    from sms.workspace_findings import findings, to_dict  # noqa: PLC0415
    from sms.workspace_survey import survey  # noqa: PLC0415

    with bad_input():
        surveyed = survey(machine(settings))
    text = json_text("workspace", to_dict(surveyed))
    files = out / "workspace.html", out / "workspace.json"
    write_page(files[0], workspace_html(surveyed))
    write_text_atomically(files[1], text)
    if as_json:
        print(text, end="")
        return
    for finding in findings(surveyed):
        print(f"- {finding}")
    print(f"written: {files[0]}, {files[1]}")


def path(
    poses: Annotated[
        Path,
        typer.Argument(
            help="A table with a pose a row: *x [m]* ... *yaw [deg]*; what lacks is the home pose's."
        ),
    ],
    mechanism: MechanismFile = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON, in SI units, for another program.")
    ] = False,
) -> None:
    """Is there a singular pose, or a leg out of its range, on a path? Said before the motion is driven.

    The path is straight, in the driven coordinates, from each pose to the next. The exit code is 1 where it cannot be
    driven.
    """
    if mechanism is None:
        raise InputError("--mechanism: name the mechanism's file, such as three_rps")
    from sms.cli import by_data  # noqa: PLC0415

    by_data.path(poses, mechanism, as_json)


def _refuse_with_mechanism(settings: Sequence[str], others: Mapping[str, object]) -> None:
    """InputError for an option that is of the built-in platform."""
    for name, value in {"--set": list(settings) or None, **others}.items():
        if value is not None:
            raise InputError(f"{name}: it is of the built-in platform; leave it or --mechanism out")


@contextmanager
def bad_input() -> Iterator[None]:
    """A status of the core, raised by what a person typed, as the person's error."""
    from sms import StatusError  # noqa: PLC0415

    try:
        yield
    except StatusError as problem:
        raise InputError(str(problem)) from None


def is_file(setting: str) -> bool:
    """Whether a --set names a parameter file."""
    return "=" not in setting and setting.endswith(".toml")


def files_first(settings: Sequence[str]) -> list[str]:
    """Each --set in the order in which it holds: what is set by name goes before what a file says."""
    return sorted(settings, key=lambda setting: not is_file(setting))


def machine(settings: Sequence[str]) -> Params:
    """The default parameters with each "name=value" and each file (.toml) set. InputError, OutOfRangeError."""
    from sms import Params, StatusError, load_params  # noqa: PLC0415
    from sms.parameters import PARAMETERS  # noqa: PLC0415

    params = Params()
    for setting in files_first(settings):
        if is_file(setting):
            params = load_params(setting)
            continue
        name, equals, value = (part.strip() for part in setting.partition("="))
        if not equals:
            raise InputError(f"--set {setting}: write NAME=VALUE, for instance payload_mass=280")
        if name not in PARAMETERS:
            raise InputError(
                f"--set {setting}: {did_you_mean(name, PARAMETERS, 'docs/parameters.md lists all')}"
            )
        try:
            params[name] = float(value)
        except StatusError:
            raise
        except ValueError:
            unit = PARAMETERS[name].unit
            raise InputError(f"--set {setting}: '{value}' is not a number in {unit}") from None
    return params


def _print_json(schema: str, values: Mapping[str, object]) -> None:
    from sms.io.json_files import json_text  # noqa: PLC0415 (pandas takes its time; --help must not)

    print(json_text(schema, values), end="")


def _parasitic(found: InverseKinematics | ForwardKinematics) -> dict[str, float]:
    return {"yaw_rad": float(found.yaw), "x_m": float(found.x), "y_m": float(found.y)}


def _convergence(found: InverseKinematics | ForwardKinematics) -> dict[str, float]:
    return {"iterations": int(found.iterations), "residual_m": float(found.residual)}


def _effort(found: InverseKinematics | ForwardKinematics) -> str:
    return f"{int(found.iterations)} Newton steps, residual {float(found.residual):.1g} m"


def _angle(angle: object) -> str:
    value = float(angle)  # type: ignore[arg-type]
    return f"{math.degrees(value):.5f}°   ({value:.7f} rad)"


def _millimetres(values: Sequence[float]) -> str:
    return "  ".join(f"{1e3 * value:.4f}" for value in values) + " mm"


def _warn_outside(extension: Sequence[float], params: Params, so: str) -> None:
    for number, value in enumerate(extension, 1):
        if not 0.0 <= value <= params.stroke:
            print(
                f"sms: extension {number} = {value:.4f} m is outside the stroke, 0 to "
                f"{params.stroke:g} m: {so}",
                file=sys.stderr,
            )
