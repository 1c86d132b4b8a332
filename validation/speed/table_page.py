"""The words and tables of docs/tables.md, and its picture; the numbers come from table_advice.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

from validation.speed.log_plot import Curve, LogPlot, Mark

Key = TypeVar("Key")

SENSOR_STEP = 0.450 / 4096  # m: 12 bits over the potentiometer (dissertation, section 7.3.3)
FLASH = 512 * 1024  # bytes of the TMS320F28335: 256 K words of 16 bits
LOOP = 150_000  # clock cycles of its 150 MHz in one period of the 1 kHz loop


@dataclass(frozen=True)
class Accuracy:
    """Largest errors of one table, m; None where cubic has too few nodes."""

    numbers: int
    linear: float
    cubic: float | None

    @property
    def flash(self) -> int:
        """Bytes in float."""
        return 4 * self.numbers


@dataclass(frozen=True)
class Cost:
    """One lookup or solve: x86-64 instructions, Newton steps, largest error (m)."""

    instructions: float
    steps: float
    error: float


def length(metres: float | None) -> str:
    """A length as a person reads it: 29 um, 0.073 um."""
    return (
        ""
        if metres is None
        else f"{1e6 * metres:.2g} µm"
        if metres < 1e-5
        else f"{1e6 * metres:.0f} µm"
    )


def size(flash: int) -> str:
    """Bytes as a person reads them."""
    return f"{flash} B" if flash < 10_000 else f"{flash / 1024:.0f} KiB"


def rows(lines: Sequence[Sequence[str]]) -> str:
    """A table in Markdown: the first line is its head."""
    head, *rest = lines
    rule = ["---"] + ["---:"] * (len(head) - 1)
    return "".join("| " + " | ".join(line) + " |\n" for line in (head, rule, *rest))


def size_table(floats: Mapping[int, Accuracy], doubles: Mapping[int, Accuracy]) -> str:
    """Error by size."""
    head = ["nodes", "step", "flash, float", "share of flash", "bilinear, float"]
    lines = [[*head, "bilinear, double", "bicubic, float", "bicubic, double"]]
    for n, f in floats.items():
        where = [f"{n} x {n}", f"{200 / (n - 1):.3g} mrad", size(f.flash), f"{f.flash / FLASH:.1%}"]
        errors = [f.linear, doubles[n].linear, f.cubic, doubles[n].cubic]
        lines.append([*where, *(length(e) for e in errors)])
    return rows(lines)


def cost_table(cost: Mapping[tuple[str, str], Cost]) -> str:
    """Instructions by work."""
    names = {
        "bilinear": "table, bilinear",
        "bicubic": "table, bicubic",
        "trilinear": "table with heights, trilinear",
        "tricubic": "table with heights, tricubic",
        "warm": "direct solve from the last pose (1 kHz)",
        "cold": "direct solve from the rest pose",
    }
    lines = [["", "float", "of a warm solve", "double", "of a warm solve"]]
    for work, name in names.items():
        cells = [name]
        for scalar in ("float", "double"):
            share = cost[work, scalar].instructions / cost["warm", scalar].instructions
            cells += [f"{cost[work, scalar].instructions:.0f}", f"{share:.2f}"]
        lines.append(cells)
    return rows(lines)


def height_table(tables: Mapping[tuple[int, int], Accuracy]) -> str:
    """Error by size, several heights."""
    lines = [["nodes", "flash, float", "share of flash", "trilinear", "tricubic"]]
    for (n, h), a in tables.items():
        where = [f"{n} x {n} x {h}", size(a.flash), f"{a.flash / FLASH:.1%}"]
        lines.append([*where, length(a.linear), length(a.cubic)])
    return rows(lines)


def smallest(tables: Mapping[Key, Accuracy], limit: float, cubic: bool) -> Key:
    """The first table whose error is below a limit, m."""
    for key, a in tables.items():
        error = a.cubic if cubic else a.linear
        if error is not None and error < limit:
            return key
    raise SystemExit(f"no table comes below {limit} m")


PAGE_TEXT = """\
# Does a lookup table pay?

Made by `python -m validation.speed.table_advice`, which measures every number here. Tables are at 0.5 m over -0.1 to
0.1 rad of roll and pitch (section 3.5 of the [source](source.md)), unless it says otherwise. An error is the largest of
an extension at {points:,} random points, against the solver in double.

## The answer

- **A table pays at {linear} x {linear} nodes, bilinear**: {linear_flash} of flash, wrong by {linear_error} at most,
  where the position sensors resolve {sensor} (12 bits over 450 mm). It takes {bilinear:.0f} instructions, the solver
  {warm:.0f}.
- **Where flash is scarcer than time, {cubic} x {cubic} nodes, bicubic**: {cubic_flash}, wrong by {cubic_error},
  {bicubic:.0f} instructions.
- **More nodes than that buy what no sensor of the machine sees.** From {equal} x {equal} on ({equal_flash}) a bilinear
  table is as accurate as the solver in float ({warm_error}). The 201 x 201 table of section 3.5 takes
  {published_flash}, {published_share:.0%} of the flash of the TMS320F28335, and is {beyond:.0f} times finer than the
  sensors.
- **For several heights, {deep} nodes, trilinear**: {deep_flash} for 0.45 to 0.55 m, wrong by {deep_error},
  {trilinear:.0f} instructions. Tricubic does not pay: {tricubic:.0f} instructions, the solver {warm:.0f}.
- **Time alone hardly asks for a table.** At 1 kHz it spares {spared:.0f} instructions a period; at one clock cycle
  each that is {share:.1%} of the {loop:,} cycles there are. What a table has, and the solver has not, is code
  without an iteration.

![error by size](tables.svg)

## Size and error

Half the step divides the error of linear interpolation by 4, that of the spline by 8, until in float rounding is all
that is left. Tables are solved in double and rounded once: a fine one in float is more accurate than a solve in float.

{sizes}
*Flash* counts the extensions; the TMS320F28335 has 256 K words of 16 bits.

## Instructions

Counted by callgrind on x86-64, one call after the other along a motion sampled at 1 kHz. Scalar code: {compiler},
`{flags}`. They are not those of a C28x and say nothing of clock
cycles or of the wait states of a flash; what carries over is how they compare. The solver took {warm_steps:.1f} Newton
steps warm and {cold_steps:.1f} cold in float, {warm_steps_double:.1f} and {cold_steps_double:.1f} in double; 20 are
the bound.

{costs}
A lookup takes the same number whatever the size of the table. The solver also gives yaw, x and y.

## Several heights

In float, from 0.45 to 0.55 m. Cubic needs four nodes on every axis.

{heights}"""


def page(
    floats: Mapping[int, Accuracy],
    doubles: Mapping[int, Accuracy],
    heights: Mapping[tuple[int, int], Accuracy],
    cost: Mapping[tuple[str, str], Cost],
    points: int,
    compiler: str,
    flags: str,
) -> str:
    """docs/tables.md."""
    warm, cold = cost["warm", "float"], cost["cold", "float"]
    linear, cubic = (smallest(floats, SENSOR_STEP / 3, c) for c in (False, True))
    equal = smallest(floats, warm.error, False)
    deep = smallest(heights, SENSOR_STEP / 3, False)
    spared = warm.instructions - cost["bilinear", "float"].instructions
    return PAGE_TEXT.format(
        **{work: cost[work, "float"].instructions for work, scalar in cost if scalar == "float"},
        points=points,
        linear=linear,
        linear_flash=size(floats[linear].flash),
        linear_error=length(floats[linear].linear),
        sensor=length(SENSOR_STEP),
        cubic=cubic,
        cubic_flash=size(floats[cubic].flash),
        cubic_error=length(floats[cubic].cubic),
        equal=equal,
        equal_flash=size(floats[equal].flash),
        warm_error=length(warm.error),
        published_flash=size(floats[201].flash),
        published_share=floats[201].flash / FLASH,
        beyond=SENSOR_STEP / floats[201].linear,
        deep=" x ".join(map(str, (deep[0], *deep))),
        deep_flash=size(heights[deep].flash),
        deep_error=length(heights[deep].linear),
        spared=spared,
        share=spared / LOOP,
        loop=LOOP,
        sizes=size_table(floats, doubles),
        compiler=compiler,
        flags=flags,
        warm_steps=warm.steps,
        cold_steps=cold.steps,
        warm_steps_double=cost["warm", "double"].steps,
        cold_steps_double=cost["cold", "double"].steps,
        costs=cost_table(cost),
        heights=height_table(heights),
    )


def picture(
    floats: Mapping[int, Accuracy], doubles: Mapping[int, Accuracy], solver: Cost
) -> LogPlot:
    """Largest error over the flash of a table."""

    def curve(label: str, tables: Mapping[int, Accuracy], cubic: bool, dashed: bool) -> Curve:
        errors = [(floats[n].flash, a.cubic if cubic else a.linear) for n, a in tables.items()]
        points = [(float(flash), error) for flash, error in errors if error is not None]
        return Curve(label, points, "#c04020" if cubic else "#2060a0", dashed)

    return LogPlot(
        x_label="extensions in flash, float [byte]",
        y_label="largest error of an extension [m]",
        x_range=(2e2, 3e6),
        y_range=(1e-12, 1e-3),
        curves=(
            curve("bilinear, float", floats, False, False),
            curve("bilinear, double", doubles, False, True),
            curve("bicubic, float", floats, True, False),
            curve("bicubic, double", doubles, True, True),
        ),
        marks=(
            Mark("the position sensor resolves this", y=SENSOR_STEP),
            Mark("direct solve in float", y=solver.error),
            Mark("flash of the DSP", x=float(FLASH)),
        ),
    )
