"""The page of `sms noise`: spectrum, distribution and the stretch itself."""

from __future__ import annotations

import numpy as np
import scipy.signal

from sms.arrays import Array
from sms.identification.noise import Noise
from sms.report.markup import esc
from sms.report.panels import figure, panel, panels_page, thinned, trace, view


def noise_html(
    title: str, unit: str, time: Array, values: Array, noise: Noise, said: list[str]
) -> str:
    """The whole page as text."""
    spectra = view(
        "", "frequency [Hz]",
        [panel(f"density [dB, {unit}²/Hz]", [
            trace(noise.spectrum.frequency, noise.spectrum.decibel, "as recorded", "baseline"),
            trace(noise.filtered.frequency, noise.filtered.decibel, "alpha-beta filtered", "extended"),
        ])], x_log=True,
    )  # fmt: skip
    left = scipy.signal.detrend(values, type="linear")
    count, edges = np.histogram(left, bins=40)
    middle = 0.5 * (edges[1:] + edges[:-1])
    normal = left.size * (edges[1] - edges[0]) / (noise.sd * np.sqrt(2 * np.pi))
    bell = normal * np.exp(-0.5 * (middle / noise.sd) ** 2)
    histogram = view(
        "", f"reading less trend [{unit}]",
        [panel("samples", [
            trace(middle, count, "recorded", "measured", "lines+markers"),
            trace(middle, bell, "normal", "extended", dash="dot"),
        ], from_zero=True)],
    )  # fmt: skip
    rows = thinned(time, values)
    stretch = view(
        "", "time [s]", [panel(f"[{unit}]", [trace(time[rows], values[rows], "", "measured")])]
    )
    items = "".join(f"<li>{esc(text)}</li>" for text in said)
    body = (
        f"<h1>{esc(title)}</h1><ul class='said'>{items}</ul>"
        + figure("spectrum", "Power spectral density", [spectra], "By Welch's method.")
        + figure("histogram", "Distribution", [histogram], "", "low")
        + figure("stretch", "The stretch", [stretch], "", "low")
    )
    figures = {"spectrum": [spectra], "histogram": [histogram], "stretch": [stretch]}
    return panels_page(f"Noise: {title}", body, figures)
