"""Forces of one pneumatic cylinder. Equations: libsms/include/sms/friction.hpp, piston.hpp."""

from __future__ import annotations

from numpy.typing import ArrayLike

from sms import _core
from sms._core import Params
from sms.arrays import Array
from sms.rows import Rows, scalars


def friction(
    velocity: ArrayLike,
    acceleration: ArrayLike = 0.0,
    extension: ArrayLike | None = None,
    pressure_lower: ArrayLike | None = None,
    pressure_upper: ArrayLike | None = None,
    params: Params | None = None,
) -> Array:
    """Friction force of a cylinder (N), positive against extension; inputs broadcast.

    Args:
        velocity: m/s, positive while extending.
        acceleration: m/s^2.
        extension: m; by default mid-stroke.
        pressure_lower: absolute, Pa, of the chamber that extends the rod; by default ambient.
        pressure_upper: absolute, Pa, of the other chamber; by default ambient.
        params: the cylinder.

    Equation: eq. 6.5 to 6.7 with the effects on friction. Raises: NotANumberError.
    """
    params = params or Params()
    rows = _piston(params, velocity, acceleration, extension, pressure_lower, pressure_upper)
    return rows.shaped(_core.friction(params, *rows.parts))


def rod_force(
    velocity: ArrayLike,
    acceleration: ArrayLike = 0.0,
    extension: ArrayLike | None = None,
    pressure_lower: ArrayLike | None = None,
    pressure_upper: ArrayLike | None = None,
    params: Params | None = None,
) -> Array:
    """Force with which the rod pushes on its load (N); arguments as in `friction`.

    Equation: the force balance of eq. 6.4 and 4.34. Raises: NotANumberError.
    """
    params = params or Params()
    rows = _piston(params, velocity, acceleration, extension, pressure_lower, pressure_upper)
    return rows.shaped(_core.rod_force(params, *rows.parts))


def _piston(
    params: Params,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    extension: ArrayLike | None,
    pressure_lower: ArrayLike | None,
    pressure_upper: ArrayLike | None,
) -> Rows:
    """The five numbers in the order of the core: extension first."""
    ambient = params.ambient_pressure
    rows = scalars(
        extension=("m", 0.5 * params.stroke if extension is None else extension),
        velocity=("m/s", velocity),
        acceleration=("m/s^2", acceleration),
        pressure_lower=("Pa", ambient if pressure_lower is None else pressure_lower),
        pressure_upper=("Pa", ambient if pressure_upper is None else pressure_upper),
    )
    rows.check_finite()
    return rows
