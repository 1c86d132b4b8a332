"""Mechanisms given by data: legs between a base and one platform; `sms.load_mechanism` reads a file.

A leg is actuated, a rod of fixed length, or free to slide; a revolute joint at the base may keep it in a plane. Six
actuated legs are a hexapod, three and three rods the platform that this package is about, three with planes a 3-RPS.
A pose is (x, y, z, roll, pitch, yaw), m and rad, of the platform's origin in base axes, R = Rz(yaw) Ry(pitch) Rx(roll).
The equations are in libsms/include/sms/parallel_*.hpp; docs/mechanisms.md has them with the format of the file.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sms import _core
from sms.arrays import Array
from sms.errors import InputError
from sms.rows import Rows, vectors

POSE = (("x", "m"), ("y", "m"), ("z", "m"), ("roll", "rad"), ("pitch", "rad"), ("yaw", "rad"))
COORDINATES = tuple(name for name, _ in POSE)
_TWIST = tuple((f"velocity {a}", "m/s") for a in "xyz") + tuple(
    (f"angular velocity {a}", "rad/s") for a in "xyz"
)
_ACCELERATION = tuple((f"acceleration {a}", "m/s^2") for a in "xyz") + tuple(
    (f"angular acceleration {a}", "rad/s^2") for a in "xyz"
)
_WRENCH = tuple((f"force {a}", "N") for a in "xyz") + tuple((f"moment {a}", "N m") for a in "xyz")
_NOTHING = (0.0,) * 6
KINDS = ("actuated", "fixed", "free")


@dataclass(frozen=True, slots=True)
class Leg:
    """One leg, between a joint on the base and one on the platform."""

    base: tuple[float, float, float]  #: m, base axes
    platform: tuple[float, float, float]  #: m, platform axes, from the platform's origin
    kind: str = "actuated"  #: or "fixed", a rod; or "free", which slides passively
    length: float | None = None  #: of a rod, m
    range: tuple[float, float] | None = None  #: least and most length of another leg, m
    normal: tuple[float, float, float] | None = None  #: the leg stays across it, base axes


@dataclass(frozen=True, slots=True)
class Body:
    """The platform as a rigid body; the legs have no mass."""

    mass: float  #: kg
    cog: tuple[
        float, float, float
    ]  #: centre of gravity, m, platform axes, from the platform's origin
    inertia: tuple[tuple[float, float, float], ...]  #: about it, kg m^2, platform axes, (3, 3)
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)  #: m/s^2, base axes


@dataclass(frozen=True, slots=True)
class Solution:
    """Poses, and how the search for them ended."""

    pose: Array  #: (..., 6), m and rad
    length: Array  #: of every leg in it, m, (..., legs)
    iterations: NDArray[np.int32]  #: Newton steps taken
    residual: Array  #: largest error of a length or distance from a plane, m


@dataclass(frozen=True, slots=True)
class Singularity:
    """A singular pose on the way from one pose of a path to the next."""

    row: int  #: of the pose before it, from 0
    fraction: float  #: of the way from there to the next pose
    pose: Array  #: (6,)


@dataclass(frozen=True)
class Mechanism:
    """A mechanism given by data.

    Raises: InputError where legs, rods and planes do not determine a pose.
    """

    legs: tuple[Leg, ...]
    driven: tuple[str, ...] = COORDINATES  #: coordinates that are chosen, as many as actuated legs
    home: tuple[float, ...] = _NOTHING  #: pose of the wanted assembly mode: where searches start
    characteristic_length: float | None = (
        None  #: m; None: root mean square of the joints' distances
    )
    body: Body | None = None
    name: str = "mechanism"
    _of: _core.ParallelMechanism = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Build the core's mechanism."""
        self._check()
        order = [COORDINATES.index(name) for name in self.driven]
        order += [0] * (6 - len(order))
        nan = (np.nan,) * 3
        core = _core.ParallelMechanism(
            base=np.array([leg.base for leg in self.legs], dtype=float),
            platform=np.array([leg.platform for leg in self.legs], dtype=float),
            length_is=[KINDS.index(leg.kind) for leg in self.legs],
            fixed_length=[leg.length or 0.0 for leg in self.legs],
            normal=np.array([leg.normal or nan for leg in self.legs], dtype=float),
            driven=order,
            characteristic_length=self.characteristic_length or 0.0,
        )
        object.__setattr__(self, "_of", core)

    @property
    def freedoms(self) -> int:
        """Number of actuated legs."""
        return sum(leg.kind == "actuated" for leg in self.legs)

    @property
    def characteristic_length_in_use(self) -> float:
        """What a radian is weighed against in `conditioning`, m."""
        return float(self._of.characteristic_length)

    @property
    def actuated(self) -> list[int]:
        """Numbers of the actuated legs, from 0."""
        return [i for i, leg in enumerate(self.legs) if leg.kind == "actuated"]

    def inverse(self, pose: ArrayLike) -> Solution:
        """Leg lengths of poses (..., 6), whose coordinates that are not driven are found from what they are given as.

        Raises: NotANumberError; OutOfWorkspaceError, NotConvergedError where rods and planes leave no pose.
        """
        rows = vectors(pose=(POSE, pose))
        found, iterations, residual, singular, status = self._of.complete(*rows.parts)
        self._raise(rows, status, singular, "rods and planes leave no pose near the start")
        return self._solution(rows, found, iterations, residual)

    def forward(self, length: ArrayLike, start: ArrayLike | None = None) -> Solution:
        """Poses of the actuated legs' lengths, m, (..., freedoms), of the assembly mode of `start` (default: home).

        Raises: NotANumberError; OutOfWorkspaceError where the only pose found lies beyond a singularity, or a length
        is not positive; NotConvergedError.
        """
        columns = tuple((f"length {i + 1}", "m") for i in self.actuated)
        given = self.home if start is None else start
        rows = vectors(length=(columns, length), start=(POSE, given))
        found, iterations, residual, singular, status = self._of.forward(*rows.parts)
        self._raise(
            rows,
            status,
            singular,
            "no pose of this assembly mode was found; try a start nearer to it",
        )
        return self._solution(rows, found, iterations, residual)

    def jacobian(self, pose: ArrayLike) -> Array:
        """Rates of the six equations by the twist, (..., 6, 6): actuated legs, rods, planes; m/s per m/s and rad/s."""
        rows = self._poses(pose)
        return rows.shaped(self._of.jacobian(*rows.parts), 6, 6)

    def conditioning(self, pose: ArrayLike) -> tuple[Array, Array]:
        """Condition number (1 is best) and determinant (0 is singular) of the dimensionless Jacobian, each (...)."""
        rows = self._poses(pose)
        values = self._of.distance(*rows.parts)
        return rows.column(values, 0), rows.column(values, 1)

    def singularities(self, poses: ArrayLike) -> list[Singularity]:
        """Singular poses on the straight ways, in the driven coordinates, along poses (n, 6) of `inverse`.

        Raises: NotANumberError, OutOfWorkspaceError, NotConvergedError for a pose on the way that cannot be.
        """
        rows = vectors(pose=(POSE, poses))
        if len(rows.shape) != 1:
            raise ValueError(f"poses has shape {(*rows.shape, 6)}; a path has shape (n, 6)")
        rows.check_finite()
        crossing, status = self._of.crossings(*rows.parts)
        if status.any():
            row = int(np.flatnonzero(status)[0])
            _core.raise_status(
                int(status[row]), f"between rows {row} and {row + 1}: rods and planes leave no pose"
            )
        return [
            Singularity(int(i), float(crossing[i, 1]), crossing[i, 2:])
            for i in np.flatnonzero(crossing[:, 0])
        ]

    def inverse_dynamics(
        self,
        pose: ArrayLike,
        twist: ArrayLike = _NOTHING,
        acceleration: ArrayLike = _NOTHING,
        wrench: ArrayLike = _NOTHING,
    ) -> Array:
        """Forces of the six equations for a motion, N, (..., 6): actuated legs (positive pushes), rods, planes.

        Args:
            pose: (..., 6), as `inverse` gives it.
            twist: velocity of the platform's origin and angular velocity, base axes, m/s, rad/s.
            acceleration: their derivatives.
            wrench: what else acts on the platform, force and moment about its origin, N, N m.

        Raises: NotANumberError; NotConvergedError at a singular pose; InputError without a body.
        """
        rows = vectors(
            pose=(POSE, pose),
            twist=(_TWIST, twist),
            acceleration=(_ACCELERATION, acceleration),
            wrench=(_WRENCH, wrench),
        )
        force, status = self._of.leg_forces(self._body(), *rows.parts)
        self._raise(rows, status, np.ones_like(status, dtype=bool), "no forces hold it there")
        return rows.shaped(force, 6)

    def forward_dynamics(
        self, pose: ArrayLike, twist: ArrayLike, force: ArrayLike, wrench: ArrayLike = _NOTHING
    ) -> Array:
        """Acceleration of the platform, (..., 6), for the actuated legs' forces, N, (..., freedoms).

        The other arguments and what is raised: as `inverse_dynamics`.
        """
        columns = tuple((f"force of leg {i + 1}", "N") for i in self.actuated)
        rows = vectors(
            pose=(POSE, pose),
            twist=(_TWIST, twist),
            force=(columns, force),
            wrench=(_WRENCH, wrench),
        )
        acceleration, status = self._of.acceleration(self._body(), *rows.parts)
        self._raise(
            rows,
            status,
            np.ones_like(status, dtype=bool),
            "its acceleration is not determined there",
        )
        return rows.shaped(acceleration, 6)

    def outside_range(self, length: Array) -> list[tuple[int, int]]:
        """(row, leg) of every length (n, legs) outside its leg's range."""
        low = np.array([leg.range[0] if leg.range else -np.inf for leg in self.legs])
        high = np.array([leg.range[1] if leg.range else np.inf for leg in self.legs])
        return [(int(r), int(i)) for r, i in np.argwhere((length < low) | (length > high))]

    def _poses(self, pose: ArrayLike) -> Rows:
        rows = vectors(pose=(POSE, pose))
        rows.check_finite()
        return rows

    def _solution(
        self, rows: Rows, found: Array, iterations: NDArray[np.int32], residual: Array
    ) -> Solution:
        return Solution(
            pose=rows.shaped(found, 6),
            length=rows.shaped(self._of.lengths(found), len(self.legs)),
            iterations=rows.shaped(iterations),
            residual=rows.shaped(residual),
        )

    def _raise(
        self, rows: Rows, status: NDArray[np.int32], singular: NDArray[np.bool_], why: str
    ) -> None:
        if status.any():
            row = int(np.flatnonzero(status)[0])
            met = "the pose is singular: " if singular[row] else ""
            rows.check(status, lambda _: f"{met}{why}", _core.Params())

    def _body(self) -> _core.PlatformBody:
        if self.body is None:
            raise InputError(
                f"{self.name}: it has no body; give its mass, cog and inertia ([platform])"
            )
        b = self.body
        return _core.PlatformBody(
            b.mass, list(b.cog), np.array(b.inertia, dtype=float), list(b.gravity)
        )

    def _check(self) -> None:
        equations = sum((leg.kind != "free") + (leg.normal is not None) for leg in self.legs)
        if equations != 6:
            raise InputError(
                f"{self.name}: actuated legs, rods and planes are {equations} equations; six determine a pose"
            )
        if not self.freedoms:
            raise InputError(f"{self.name}: no leg is actuated; make one")
        if self.freedoms != len(self.driven) or len(set(self.driven)) != len(self.driven):
            raise InputError(
                f"{self.name}: {self.freedoms} legs are actuated, so driven must name as many coordinates, each once"
            )
        for number, leg in enumerate(self.legs, 1):
            if leg.kind == "free" and leg.normal is None:
                raise InputError(
                    f"{self.name}, leg {number}: free and without a plane it does nothing; leave it out"
                )
            if leg.kind == "fixed" and not (leg.length and leg.length > 0.0):
                raise InputError(f"{self.name}, leg {number}: a rod needs a length above 0 m")
            if leg.normal is not None and not sum(part * part for part in leg.normal) > 0.0:
                raise InputError(
                    f"{self.name}, leg {number}: normal is no direction; its length is 0"
                )
