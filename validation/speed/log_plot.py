"""A picture with two logarithmic axes, as SVG text: what docs/*.svg need, without a plotting library."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape

WIDTH, HEIGHT = 760, 460
LEFT, RIGHT, TOP, BOTTOM = 84, 24, 24, 60
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Curve:
    """Points (x, y), both positive, joined by a line."""

    label: str
    points: Sequence[tuple[float, float]]
    colour: str
    dashed: bool = False


@dataclass(frozen=True)
class Mark:
    """A straight line across the picture at one value of x or of y."""

    label: str
    x: float | None = None
    y: float | None = None


@dataclass(frozen=True)
class LogPlot:
    """The whole picture; ranges are (lower, upper)."""

    x_label: str
    y_label: str
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    curves: Sequence[Curve]
    marks: Sequence[Mark] = field(default=())

    def _x(self, value: float) -> float:
        lower, upper = map(math.log10, self.x_range)
        return LEFT + (math.log10(value) - lower) / (upper - lower) * (WIDTH - LEFT - RIGHT)

    def _y(self, value: float) -> float:
        lower, upper = map(math.log10, self.y_range)
        return (
            HEIGHT
            - BOTTOM
            - (math.log10(value) - lower) / (upper - lower) * (HEIGHT - TOP - BOTTOM)
        )

    def _grid(self) -> list[str]:
        lines = []
        right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
        for power in _powers(self.x_range):
            x = self._x(10.0**power)
            lines.append(_line(x, TOP, x, bottom, "#e0e0e0"))
            lines.append(_text(x, bottom + 18, _power(power), "middle"))
        for power in _powers(self.y_range):
            y = self._y(10.0**power)
            lines.append(_line(LEFT, y, right, y, "#e0e0e0"))
            lines.append(_text(LEFT - 8, y + 4, _power(power), "end"))
        lines.append(_text((LEFT + right) / 2, HEIGHT - 18, self.x_label, "middle"))
        middle = (TOP + bottom) / 2
        lines.append(
            f'<text transform="translate(22 {middle:.1f}) rotate(-90)" text-anchor="middle">'
            f"{escape(self.y_label)}</text>"
        )
        return lines

    def _marks(self) -> list[str]:
        lines = []
        for mark in self.marks:
            if mark.x is not None:
                x = self._x(mark.x)
                lines.append(_line(x, TOP, x, HEIGHT - BOTTOM, "#808080", "2 3"))
                lines.append(_text(x - 6, TOP + 14, mark.label, "end"))
            if mark.y is not None:
                y = self._y(mark.y)
                lines.append(_line(LEFT, y, WIDTH - RIGHT, y, "#808080", "2 3"))
                lines.append(_text(WIDTH - RIGHT - 6, y - 5, mark.label, "end"))
        return lines

    def _curves(self) -> list[str]:
        lines = []
        for number, curve in enumerate(self.curves):
            path = " ".join(f"{self._x(x):.1f},{self._y(y):.1f}" for x, y in curve.points)
            dash = ' stroke-dasharray="6 4"' if curve.dashed else ""
            style = f'fill="none" stroke="{curve.colour}" stroke-width="2"{dash}'
            lines.append(f'<polyline points="{path}" {style}/>')
            if not curve.dashed:
                lines += [
                    f'<circle cx="{self._x(x):.1f}" cy="{self._y(y):.1f}" r="3" '
                    f'fill="{curve.colour}"/>'
                    for x, y in curve.points
                ]
            x, y = LEFT + 14, HEIGHT - BOTTOM - 14 - 18 * (len(self.curves) - 1 - number)
            lines.append(f'<polyline points="{x},{y} {x + 28},{y}" {style}/>')
            lines.append(_text(x + 36, y + 4, curve.label, "start"))
        return lines

    def svg(self) -> str:
        """The picture as one SVG document."""
        body = "\n".join([*self._grid(), *self._marks(), *self._curves()])
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" '
            f'font-family="sans-serif" font-size="12" fill="#202020">\n'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n{body}\n</svg>\n'
        )


def _powers(limits: tuple[float, float]) -> range:
    lower, upper = (math.log10(v) for v in limits)
    return range(math.ceil(lower - 1e-9), math.floor(upper + 1e-9) + 1)


def _power(exponent: int) -> str:
    return "10" + str(exponent).translate(SUPERSCRIPT)


def _line(x1: float, y1: float, x2: float, y2: float, colour: str, dash: str = "") -> str:
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return (
        f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}"{dashed}/>'
    )


def _text(x: float, y: float, words: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(words)}</text>'
