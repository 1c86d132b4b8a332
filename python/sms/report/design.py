"""The state-feedback designs as one HTML page and as rows for the console."""

from __future__ import annotations

import math

import numpy as np

from sms import _core
from sms.design import (
    Design,
    SimplifiedPlant,
    bode,
    closed_loop,
    designs,
    open_loop,
    platform_state_space,
    readings,
    root_locus,
    step_response,
)
from sms.report.markup import esc, section, table
from sms.report.page import asset, page, plots
from sms.report.plots import Figure, Line, figures_html, payload
from sms.units_display import capital, format_quantity, significant

HEADERS = (
    "gains",
    "K_p, V/m",
    "K_v, V s/m",
    "K_a, V s²/m",
    "rise time",
    "overshoot",
    "-3 dB",
    "poles, rad/s",
)
_LOOP_GAINS = np.geomspace(0.02, 30.0, 400)
_FREQUENCY = np.geomspace(0.05, 20.0, 400)
_TIME = np.linspace(0.0, 2.0, 400)
_COLOURS = ("measured", "extended", "baseline", "good", "warn", "bad")


def table_rows(found: list[Design]) -> list[list[str]]:
    """One row a design, in the order of HEADERS, as text."""
    return [
        [
            design.name,
            significant(design.position, 4),
            significant(design.velocity, 4),
            significant(design.acceleration, 4),
            format_quantity(design.rise_time, "s") if design.stable else "not stable",
            f"{100.0 * design.overshoot:.2f} %" if design.stable else "",
            format_quantity(design.bandwidth, "Hz") if design.stable else "",
            ", ".join(_pole(pole) for pole in design.poles if pole.imag >= -1e-9),
        ]
        for design in found
    ]


def plant_words(plant: SimplifiedPlant) -> str:
    """A reading of the simplified plant in one line."""
    return (
        f"C_0 = {plant.velocity_gain:.3f} m/s per V, w_s = {plant.natural_frequency:.2f} rad/s, "
        f"zeta = {plant.damping_ratio:.4f} ({plant.reading})"
    )


def design_html() -> str:
    """The whole page, of which plotly.js is 2 MB."""
    figures: list[Figure] = []
    parts = []
    for number, plant in enumerate(readings()):
        found = designs(plant)
        cells = [[esc(cell) for cell in row] for row in table_rows(found)]
        own = _figures(number, found)
        figures += own
        parts.append(
            section(
                f"reading-{number}",
                capital(plant.reading.partition(":")[0]),
                table("Gains and the linear loop they give.", HEADERS, cells) + figures_html(own),
                plant_words(plant),
            )
        )
    body = (
        "<main><h1>State feedback on the simplified plant</h1>"
        "<p class='lead'>Section 8.1 models an actuator under its load as a third-order system. Its "
        "published numbers contradict each other, so each reading is shown on its own. What the full "
        "plant does under the same gains is a matter of <code>sms simulate</code>.</p>"
        + "".join(parts)
        + section("platform", "The platform linearised, level at mid-stroke", _platform())
        + f"<p class='small'>sms {_core.__version__}</p></main>"
    )
    return page("Design", body, plots(payload(figures), "plots.js"), asset("plots.css"))


def _figures(number: int, found: list[Design]) -> list[Figure]:
    stable = [design for design in found if design.stable]
    steps, gains, phases, loci = [], [], [], []
    for design in found:
        colour = _COLOURS[found.index(design) % len(_COLOURS)]
        if design in stable:
            steps.append(Line(design.name, _TIME, 1e3 * step_response(design, _TIME), colour))
            amplitude, phase = bode(closed_loop(design), _FREQUENCY)
            gains.append(Line(design.name, _FREQUENCY, 20.0 * np.log10(amplitude), colour))
            phases.append(Line(design.name, _FREQUENCY, np.degrees(phase), colour))
        poles = root_locus(design, _LOOP_GAINS)
        flat = np.concatenate([np.append(branch, np.nan) for branch in poles.T])
        loci.append(Line(design.name, flat.real, flat.imag, colour))
        at = np.array(design.poles)
        loci.append(Line("", at.real, at.imag, colour, mode="markers", symbol="x"))
    opened = []
    for design in found:
        amplitude, _ = bode(open_loop(design), _FREQUENCY)
        colour = _COLOURS[found.index(design) % len(_COLOURS)]
        opened.append(Line(design.name, _FREQUENCY, 20.0 * np.log10(amplitude), colour))
    return [
        Figure(
            f"step-{number}", "Step of 0.1 m", "time in s", "extension in mm", steps,
            "The colours are the same in all figures of this reading.", wide=True, height=380,
        ),
        Figure(
            f"locus-{number}", "Root locus over the loop gain", "real part in rad/s",
            "imaginary part in rad/s", loci, "From 0.02 to 30 times the gains; crosses: at the gains.",
            marks=({"x": 0.0},), legend=False, range_x=(-60.0, 20.0), range_y=(-50.0, 50.0),
        ),
        Figure(
            f"open-{number}", "Open loop: gain", "frequency in Hz", "gain in dB", opened,
            log_x=True, marks=({"y": 0.0},), legend=False,
        ),
        Figure(
            f"gain-{number}", "Closed loop: gain", "frequency in Hz", "gain in dB", gains,
            "Dotted: -3 dB.", log_x=True, marks=({"y": -3.0},), legend=False,
        ),
        Figure(
            f"phase-{number}", "Closed loop: phase", "frequency in Hz", "phase in °", phases,
            log_x=True, legend=False,
        ),
    ]  # fmt: skip


def _platform() -> str:
    """Eigenvalues of the linearised platform on its air springs."""
    poles = np.asarray(platform_state_space().poles())
    rows = [
        [f"{abs(pole) / (2.0 * math.pi):.3f} Hz", f"{-pole.real / abs(pole):.3f}", esc(_pole(pole))]
        for pole in sorted(poles, key=abs)
        if pole.imag >= 0.0
    ]
    caption = "On closed chambers (air springs at 333.5 kPa) with the viscous friction."
    return table(
        caption, ("natural frequency", "damping ratio", "eigenvalue, rad/s"), rows, "shares"
    )


def _pole(pole: complex) -> str:
    if abs(pole.imag) < 1e-6 * abs(pole):
        return f"{pole.real:.2f}".replace("-", "−")
    return f"{pole.real:.2f} ± {abs(pole.imag):.2f}i".replace("-", "−")
