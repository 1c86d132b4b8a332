"""Pneumatic motion platform: its equations, and what measured data says about them."""

from sms import _dispatch  # noqa: F401  # first: decides which copy of the core sms._core is
from sms._core import (
    Channel,
    LegParams,
    NotANumberError,
    NotConvergedError,
    OutOfRangeError,
    OutOfWorkspaceError,
    Params,
    StatusError,
    __version__,
)
from sms.cylinder import friction, rod_force
from sms.dynamics import (
    Energies,
    LinearModel,
    Modes,
    bias_force,
    eigenfrequencies,
    energies,
    forward_dynamics,
    gravity_force,
    holding_force,
    inverse_dynamics,
    linearise,
    mass_matrix,
)
from sms.kinematics import (
    ForwardKinematics,
    InverseKinematics,
    Motion,
    forward_kinematics,
    forward_motion,
    inverse_kinematics,
    inverse_motion,
    jacobian,
    pose_jacobian,
    six_leg_inverse,
)
from sms.mechanism import Mechanism
from sms.mechanism_file import load_mechanism
from sms.parameter_files import load_params
from sms.simulation import (
    Run,
    SimulationStoppedError,
    extensions_of,
    simulate_bench,
    simulate_platform,
    simulate_tank,
)
from sms.views import notebook_progress

__all__ = [
    "Channel",
    "Energies",
    "ForwardKinematics",
    "InverseKinematics",
    "LegParams",
    "LinearModel",
    "Mechanism",
    "Modes",
    "Motion",
    "NotANumberError",
    "NotConvergedError",
    "OutOfRangeError",
    "OutOfWorkspaceError",
    "Params",
    "Run",
    "SimulationStoppedError",
    "StatusError",
    "__version__",
    "bias_force",
    "eigenfrequencies",
    "energies",
    "extensions_of",
    "forward_dynamics",
    "forward_kinematics",
    "forward_motion",
    "friction",
    "gravity_force",
    "holding_force",
    "inverse_dynamics",
    "inverse_kinematics",
    "inverse_motion",
    "jacobian",
    "linearise",
    "load_mechanism",
    "load_params",
    "mass_matrix",
    "notebook_progress",
    "pose_jacobian",
    "rod_force",
    "simulate_bench",
    "simulate_platform",
    "simulate_tank",
    "six_leg_inverse",
]
