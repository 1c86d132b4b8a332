"""The mechanism's published numbers (Tables 3.1 and 3.2, read as SPEC.md says), SI, z down.

Data only, under the names that validation/reference/multibody/mechanism.py asks for.
"""

from __future__ import annotations


def _point(name: str, x: float, y: float, z: float) -> dict[str, float]:
    return {f"{name}_x": x, f"{name}_y": y, f"{name}_z": z}


MECHANISM: dict[str, float] = {
    "gravity": 9.81,
    **_point("base_joint_1", 1.365209, 1.193e-05, -0.145639),
    **_point("base_joint_2", -0.682551, -1.182264, -0.145639),
    **_point("base_joint_3", -0.682551, 1.182287, -0.145639),
    **_point("base_joint_4", -0.319907, 0.929612, -0.055),
    **_point("base_joint_5", 0.965021, -0.187758, -0.055),
    **_point("base_joint_6", -0.64505, -0.741866, -0.055),
    **_point("platform_joint_1", 1.214681, 1.19e-05, -0.853818),
    **_point("platform_joint_2", -0.607287, -1.051903, -0.853818),
    **_point("platform_joint_3", -0.607287, 1.051926, -0.853818),
    **_point("platform_joint_4", 1.024004, 0.15382, -0.1532),
    **_point("platform_joint_5", -0.378746, -0.963675, -0.1532),
    **_point("platform_joint_6", -0.64515, 0.80989, -0.1532),
    **_point("reference_point", 0.001626, -0.001617, -0.297561),
    "actuator_length_offset_1": 0.0,
    "actuator_length_offset_2": 0.0,
    "actuator_length_offset_3": 0.0,
    "panhard_length_offset_1": 0.0,
    "panhard_length_offset_2": 0.0,
    "panhard_length_offset_3": 0.0,
    "top_frame_mass": 52.19322,
    **_point("top_frame_cog", 0.001626, -0.001617, -0.297561),
    "top_frame_inertia_xx": 21.091744,
    "top_frame_inertia_yy": 21.091744,
    "top_frame_inertia_zz": 37.049942,
    "payload_mass": 255.08,
    **_point("payload_cog", 0.0, 0.0, -1.3922),
    "payload_inertia_xx": 57.58,
    "payload_inertia_yy": 78.58,
    "payload_inertia_zz": 42.28,
    "payload_inertia_xy": 0.0,
    "payload_inertia_xz": 0.0,
    "payload_inertia_yz": 0.0,
    "cylinder_mass": 10.0532,
    **_point("cylinder_cog", 1.30836, 0.0169, -0.446408),
    "cylinder_inertia_xx": 0.35875,
    "cylinder_inertia_yy": 0.362328,
    "cylinder_inertia_zz": 0.050876,
    "cylinder_inertia_xy": -0.00496809906637675,
    "cylinder_inertia_xz": -0.06582086176517518,
    "cylinder_inertia_yz": 0.0,
    "piston_mass": 3.76156,
    **_point("piston_cog", 1.294688, 0.01068, -0.48219),
    "piston_inertia_xx": 0.180557,
    "piston_inertia_yy": 0.185953,
    "piston_inertia_zz": 0.012805,
    "piston_inertia_xy": -0.00174244311241429,
    "piston_inertia_xz": -0.03623024348363902,
    "piston_inertia_yz": 0.0,
    "panhard_mass": 1.66732,
    "panhard_inertia_transverse": 0.616673,
    "panhard_inertia_axial": 0.00026,
}
