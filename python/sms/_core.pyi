"""
The C++ core of sms: parameters, equations, estimation. Use it through the package sms.
"""
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing
__all__: list[str] = ['BenchEquations', 'BenchLoopProblem', 'BenchProblem', 'BenchRecord', 'BenchSimulation', 'Calibration', 'Channel', 'Controller', 'ControllerOutputs', 'CylinderProblem', 'CylinderRecord', 'FirmwareSetting', 'Fit', 'FmuCalls', 'LegParams', 'NotANumberError', 'NotConvergedError', 'OutOfRangeError', 'OutOfWorkspaceError', 'ParallelMechanism', 'ParameterInfo', 'Params', 'PlatformBody', 'PlatformEquations', 'PlatformLoopProblem', 'PlatformProblem', 'PlatformRecord', 'PlatformSimulation', 'PoseProblem', 'Problem', 'SignalInfo', 'SpoolProblem', 'SpoolRecord', 'StatusError', 'TankEquations', 'TankPlantProblem', 'TankPlantRecord', 'TankProblem', 'TankSimulation', 'VirtualRig', 'Window', 'air_spring', 'alpha_beta', 'build_info', 'calibrate', 'carried_points', 'chamber_energy_rates', 'chamber_pressure_rate', 'chamber_volume', 'charge_flow', 'chirp', 'chirp_frequency', 'classic_mass_flow', 'closed_loop', 'command_crc', 'command_mac', 'conditioning', 'dac_filter', 'dead_band_coefficient', 'dead_band_gain', 'discharge_flow', 'dynamics_terms', 'firmware_hash', 'firmware_settings', 'fit', 'force_balance', 'force_range', 'force_share', 'forward_dynamics', 'forward_kinematics', 'forward_motion', 'frequency_response', 'friction', 'friction_stribeck', 'gains_situm', 'gains_specification_based', 'has_estimation', 'inverse_dynamics', 'inverse_kinematics', 'inverse_motion', 'is_stable', 'iso_mass_flow', 'jacobian', 'joint_angles', 'largest_angle', 'largest_stable_gain', 'linearise', 'mass_models', 'orifice_area', 'over_dead_band', 'pack_frame', 'parameter_table', 'pid', 'poles', 'pose_jacobian', 'pulse_width_voltage', 'raise_status', 'reach', 'rectangle_margin', 'reservoir_pressure_rate', 'rod_force', 'sampled_extension', 'signal_table', 'simplified_plant', 'six_leg_inverse', 'sonic_conductance', 'spool_cubic', 'spool_linear', 'state_feedback', 'status_string', 'stroke_margin', 'tank_pressure_rate', 'thermocouple_temperature', 'tube_delay', 'tube_transmission', 'unpack_frame', 'uses_avx2', 'valve_command', 'valve_mass_flow', 'valve_table']
class StatusError(ValueError):
    """
    A call into the core failed; nothing was changed.
    """
class NotANumberError(StatusError):
    """
    Raised when an input is not a finite number.
    """
class OutOfRangeError(StatusError):
    """
    Raised when an input is outside its range.
    """
class OutOfWorkspaceError(StatusError):
    """
    Raised when outside the workspace of the mechanism.
    """
class NotConvergedError(StatusError):
    """
    Raised when the iteration did not converge.
    """
class ParameterInfo:
    """
    What params.def says of one parameter.
    """
    @property
    def default(self) -> float:
        ...
    @property
    def doc(self) -> str:
        ...
    @property
    def lower(self) -> float:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def source(self) -> str:
        ...
    @property
    def uncertainty(self) -> float:
        """
        half width within which the default is believed
        """
    @property
    def unit(self) -> str:
        """
        SI, as pint reads it; '1' where there is none
        """
    @property
    def upper(self) -> float:
        ...
class SignalInfo:
    """
    What signals.def says of one signal.
    """
    @property
    def has_sensor(self) -> bool:
        """
        There are parameters for the errors of its sensor.
        """
    @property
    def high(self) -> float:
        """
        and no more.
        """
    @property
    def label(self) -> str:
        """
        what is measured, in words
        """
    @property
    def low(self) -> float:
        """
        What such a sensor usually reads: no less,
        """
    @property
    def name(self) -> str:
        ...
    @property
    def noise(self) -> float:
        """
        Standard deviation of a sample where none is declared; 0: not known.
        """
    @property
    def of_leg(self) -> bool:
        """
        Each actuator of the platform has one.
        """
    @property
    def sweep(self) -> float:
        """
        What a run usually sweeps; 0 where the signal may stand still.
        """
    @property
    def unit(self) -> str:
        """
        SI, as pint reads it
        """
class Params:
    """
    Every parameter of the machine in SI units, at its default unless given by keyword.
    
    Setting one checks its bounds: OutOfRangeError, NotANumberError.
    """
    __hash__: typing.ClassVar[None] = None
    def __eq__(self, arg0: Params) -> bool:
        ...
    def __getitem__(self, arg0: str) -> float:
        ...
    def __init__(self, **kwargs) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setitem__(self, arg0: str, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def copy(self) -> Params:
        ...
    @property
    def acceleration_gain(self) -> float:
        """
        state feedback, K_a; positive damps [V s^2/m]; published, Table E.1
        """
    @acceleration_gain.setter
    def acceleration_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def actuator_length_offset_1(self) -> float:
        """
        length of actuator 1 at zero extension, less |P1 - B1| at rest [m]; derived: at rest the actuator is retracted
        """
    @actuator_length_offset_1.setter
    def actuator_length_offset_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def actuator_length_offset_2(self) -> float:
        """
        length of actuator 2 at zero extension, less |P2 - B2| at rest [m]; derived: at rest the actuator is retracted
        """
    @actuator_length_offset_2.setter
    def actuator_length_offset_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def actuator_length_offset_3(self) -> float:
        """
        length of actuator 3 at zero extension, less |P3 - B3| at rest [m]; derived: at rest the actuator is retracted
        """
    @actuator_length_offset_3.setter
    def actuator_length_offset_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def adc_bits(self) -> float:
        """
        bits of the analog to digital converter [1]; published, section 7.3.2
        """
    @adc_bits.setter
    def adc_bits(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def air_temperature(self) -> float:
        """
        temperature of the supplied and of the ambient air, T [K]; published, section 4.1.3.3.1
        """
    @air_temperature.setter
    def air_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def air_viscosity(self) -> float:
        """
        dynamic viscosity of air [Pa s]; published, textbooks: air at 293 K
        """
    @air_viscosity.setter
    def air_viscosity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def ambient_pressure(self) -> float:
        """
        ambient pressure, absolute [Pa]; published, 1,400 m above sea level (section 5.2)
        """
    @ambient_pressure.setter
    def ambient_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def anti_alias_frequency(self) -> float:
        """
        corner of the first-order filter in front of the converter [Hz]; published, section 7.3.3 (48 Hz at 100 samples a second)
        """
    @anti_alias_frequency.setter
    def anti_alias_frequency(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def backlash(self) -> float:
        """
        backlash: play between piston rod and position sensor [m]; neutral
        """
    @backlash.setter
    def backlash(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def barrel_diameter(self) -> float:
        """
        inner diameter of the barrel, d_B [m]; published, Table 4.1
        """
    @barrel_diameter.setter
    def barrel_diameter(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_1_x(self) -> float:
        """
        B1, base joint of actuator 1, x [m]; published, Table 3.2
        """
    @base_joint_1_x.setter
    def base_joint_1_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_1_y(self) -> float:
        """
        B1, base joint of actuator 1, y [m]; published, Table 3.2
        """
    @base_joint_1_y.setter
    def base_joint_1_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_1_z(self) -> float:
        """
        B1, base joint of actuator 1, z (down) [m]; published, Table 3.2
        """
    @base_joint_1_z.setter
    def base_joint_1_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_2_x(self) -> float:
        """
        B2, base joint of actuator 2, x [m]; published, Table 3.2
        """
    @base_joint_2_x.setter
    def base_joint_2_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_2_y(self) -> float:
        """
        B2, base joint of actuator 2, y [m]; published, Table 3.2
        """
    @base_joint_2_y.setter
    def base_joint_2_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_2_z(self) -> float:
        """
        B2, base joint of actuator 2, z (down) [m]; published, Table 3.2
        """
    @base_joint_2_z.setter
    def base_joint_2_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_3_x(self) -> float:
        """
        B3, base joint of actuator 3, x [m]; published, Table 3.2
        """
    @base_joint_3_x.setter
    def base_joint_3_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_3_y(self) -> float:
        """
        B3, base joint of actuator 3, y [m]; published, Table 3.2
        """
    @base_joint_3_y.setter
    def base_joint_3_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_3_z(self) -> float:
        """
        B3, base joint of actuator 3, z (down) [m]; published, Table 3.2
        """
    @base_joint_3_z.setter
    def base_joint_3_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_4_x(self) -> float:
        """
        B4, base joint of Panhard rod 1, x [m]; published, Table 3.2
        """
    @base_joint_4_x.setter
    def base_joint_4_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_4_y(self) -> float:
        """
        B4, base joint of Panhard rod 1, y [m]; published, Table 3.2
        """
    @base_joint_4_y.setter
    def base_joint_4_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_4_z(self) -> float:
        """
        B4, base joint of Panhard rod 1, z (down) [m]; published, Table 3.2
        """
    @base_joint_4_z.setter
    def base_joint_4_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_5_x(self) -> float:
        """
        B5, base joint of Panhard rod 2, x [m]; published, Table 3.2
        """
    @base_joint_5_x.setter
    def base_joint_5_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_5_y(self) -> float:
        """
        B5, base joint of Panhard rod 2, y [m]; published, Table 3.2
        """
    @base_joint_5_y.setter
    def base_joint_5_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_5_z(self) -> float:
        """
        B5, base joint of Panhard rod 2, z (down) [m]; published, Table 3.2
        """
    @base_joint_5_z.setter
    def base_joint_5_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_6_x(self) -> float:
        """
        B6, base joint of Panhard rod 3, x [m]; published, Table 3.2
        """
    @base_joint_6_x.setter
    def base_joint_6_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_6_y(self) -> float:
        """
        B6, base joint of Panhard rod 3, y [m]; published, Table 3.2
        """
    @base_joint_6_y.setter
    def base_joint_6_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def base_joint_6_z(self) -> float:
        """
        B6, base joint of Panhard rod 3, z (down) [m]; published, Table 3.2
        """
    @base_joint_6_z.setter
    def base_joint_6_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def bore_diameter(self) -> float:
        """
        diameter of the piston [m]; published, section 6.1
        """
    @bore_diameter.setter
    def bore_diameter(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def breakaway_ratio(self) -> float:
        """
        deformation up to which the seals are elastic, over that at which they slide; 0: plain LuGre [1]; assumed, the value usual since Dupont et al. (2002)
        """
    @breakaway_ratio.setter
    def breakaway_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def bristle_damping(self) -> float:
        """
        damping of the seals' own deformation [N s/m]; assumed, below what keeps the model passive
        """
    @bristle_damping.setter
    def bristle_damping(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def bristle_stiffness(self) -> float:
        """
        stiffness of the seals before they slide, sigma_0; at its lower bound 38 N bend a lip by 4 mm, its own section [N/m]; assumed, a lip seal yields some 0.5 mm before it slides
        """
    @bristle_stiffness.setter
    def bristle_stiffness(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def chamber_leakage_index_lower(self) -> float:
        """
        exponent of that flow over the pressure difference [1]; assumed, as piston_leakage_index
        """
    @chamber_leakage_index_lower.setter
    def chamber_leakage_index_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def chamber_leakage_index_upper(self) -> float:
        """
        exponent of that flow over the pressure difference [1]; assumed, as piston_leakage_index
        """
    @chamber_leakage_index_upper.setter
    def chamber_leakage_index_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def chamber_leakage_lower(self) -> float:
        """
        chamber_leakage: flow from the lower chamber to ambient per pressure difference, where that is half of the pressure [kg/(s Pa)]; neutral
        """
    @chamber_leakage_lower.setter
    def chamber_leakage_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def chamber_leakage_upper(self) -> float:
        """
        chamber_leakage: flow from the upper chamber to ambient per pressure difference, where that is half of the pressure [kg/(s Pa)]; neutral
        """
    @chamber_leakage_upper.setter
    def chamber_leakage_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def clock_skew_attitude(self) -> float:
        """
        clock_skew: by how much the attitude logger's clock is late against the others [s]; neutral
        """
    @clock_skew_attitude.setter
    def clock_skew_attitude(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def clock_skew_chamber_pressure(self) -> float:
        """
        clock_skew: by how much the pressure logger's clock is late against the others [s]; neutral
        """
    @clock_skew_chamber_pressure.setter
    def clock_skew_chamber_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def clock_skew_extension(self) -> float:
        """
        clock_skew: by how much the position logger's clock is late against the others [s]; neutral
        """
    @clock_skew_extension.setter
    def clock_skew_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def clock_skew_tank(self) -> float:
        """
        clock_skew: by how much the clock of the tank's sensors is late against that of command and supply [s]; neutral
        """
    @clock_skew_tank.setter
    def clock_skew_tank(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def command_delay(self) -> float:
        """
        command_delay: dead time between the controller and the valve's input [s]; neutral
        """
    @command_delay.setter
    def command_delay(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def command_offset(self) -> float:
        """
        what the controller adds to close the valve; the valve's own centre is valve_centre [V]; published, section 7.3.1
        """
    @command_offset.setter
    def command_offset(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def component_conductance(self) -> float:
        """
        sonic conductance of the component under test, C (eq. 5.8) [m^3/(s Pa)]; assumed, a start: what the test is made for
        """
    @component_conductance.setter
    def component_conductance(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def component_critical_ratio(self) -> float:
        """
        critical pressure ratio of the component under test, b (eq. 5.8) [1]; assumed, a start: what the test is made for
        """
    @component_critical_ratio.setter
    def component_critical_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def component_subsonic_index(self) -> float:
        """
        subsonic index of the component under test, m (eq. 5.8) [1]; assumed, a start: what the test is made for
        """
    @component_subsonic_index.setter
    def component_subsonic_index(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def compression_heat_ratio(self) -> float:
        """
        ratio of heat capacities for the piston's work, alpha [1]; published, section 4.1.3.2.1
        """
    @compression_heat_ratio.setter
    def compression_heat_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def control_period(self) -> float:
        """
        sampling period, T_s [s]; published, section 7.3.3
        """
    @control_period.setter
    def control_period(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def coulomb_force(self) -> float:
        """
        Coulomb friction while speeding up, F_C1 [N]; published, section 6.5
        """
    @coulomb_force.setter
    def coulomb_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def coulomb_force_deceleration_change(self) -> float:
        """
        F_C2 - F_C1: Coulomb friction while slowing down, less that while speeding up [N]; published, section 6.5 (F_C2 = F_C1)
        """
    @coulomb_force_deceleration_change.setter
    def coulomb_force_deceleration_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cushion_damping(self) -> float:
        """
        end_cushioning: force per speed at the very end, rising from zero over the cushion length [N s/m]; neutral
        """
    @cushion_damping.setter
    def cushion_damping(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cushion_length(self) -> float:
        """
        end cushioning acts over this length before either end [m]; published, section 6.1 (data sheet)
        """
    @cushion_length.setter
    def cushion_length(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_cog_x(self) -> float:
        """
        centre of gravity of the cylinder with position sensor of actuator 1 at rest, x [m]; published, Table 3.1
        """
    @cylinder_cog_x.setter
    def cylinder_cog_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_cog_y(self) -> float:
        """
        centre of gravity of the cylinder with position sensor of actuator 1 at rest, y [m]; published, Table 3.1
        """
    @cylinder_cog_y.setter
    def cylinder_cog_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_cog_z(self) -> float:
        """
        centre of gravity of the cylinder with position sensor of actuator 1 at rest, z (down) [m]; published, Table 3.1
        """
    @cylinder_cog_z.setter
    def cylinder_cog_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_xx(self) -> float:
        """
        inertia of that cylinder with position sensor, I_xx [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @cylinder_inertia_xx.setter
    def cylinder_inertia_xx(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_xy(self) -> float:
        """
        inertia of that cylinder with position sensor, I_xy [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @cylinder_inertia_xy.setter
    def cylinder_inertia_xy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_xz(self) -> float:
        """
        inertia of that cylinder with position sensor, I_xz [kg m^2]; derived: slender along the actuator, see bodies.hpp
        """
    @cylinder_inertia_xz.setter
    def cylinder_inertia_xz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_yy(self) -> float:
        """
        inertia of that cylinder with position sensor, I_yy [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @cylinder_inertia_yy.setter
    def cylinder_inertia_yy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_yz(self) -> float:
        """
        inertia of that cylinder with position sensor, I_yz [kg m^2]; derived: the actuator stands in the x-z plane
        """
    @cylinder_inertia_yz.setter
    def cylinder_inertia_yz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_inertia_zz(self) -> float:
        """
        inertia of that cylinder with position sensor, I_zz [kg m^2]; published, Table 3.1
        """
    @cylinder_inertia_zz.setter
    def cylinder_inertia_zz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def cylinder_mass(self) -> float:
        """
        cylinder with position sensor, one of three, m [kg]; published, Table 3.1
        """
    @cylinder_mass.setter
    def cylinder_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dac_filter_damping_ratio(self) -> float:
        """
        damping ratio of that filter [1]; published, section 7.3.3: Butterworth
        """
    @dac_filter_damping_ratio.setter
    def dac_filter_damping_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dac_filter_frequency(self) -> float:
        """
        natural frequency of the second-order filter behind the pulse width [Hz]; published, section 7.3.3
        """
    @dac_filter_frequency.setter
    def dac_filter_frequency(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dead_band_change(self) -> float:
        """
        dead_band_width: the valve opens this much further from its centre than the tables say [V]; neutral
        """
    @dead_band_change.setter
    def dead_band_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dead_band_sharpness(self) -> float:
        """
        dead-band compensation: how fast it adds it, c_DB [1/V]; published, section 7.3.5
        """
    @dead_band_sharpness.setter
    def dead_band_sharpness(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dead_band_step(self) -> float:
        """
        dead-band compensation: the step it adds, b_DB; 0: none [V]; published, section 7.3.5
        """
    @dead_band_step.setter
    def dead_band_step(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dead_volume_lower(self) -> float:
        """
        volume of the lower chamber when retracted, V_da [m^3]; assumed, not published: the piston's end and the port
        """
    @dead_volume_lower.setter
    def dead_volume_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def dead_volume_upper(self) -> float:
        """
        volume of the upper chamber when extended, V_db [m^3]; assumed, not published: the piston's end and the port
        """
    @dead_volume_upper.setter
    def dead_volume_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def derivative_gain(self) -> float:
        """
        G_D of eq. 7.4 [V s/m]; published, section 7.3.6
        """
    @derivative_gain.setter
    def derivative_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def differentiator_corner(self) -> float:
        """
        corner of the filtered differentiators, N of eq. 7.4; state feedback uses it too [rad/s]; assumed, not published
        """
    @differentiator_corner.setter
    def differentiator_corner(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def direction_friction(self) -> float:
        """
        direction_dependent_friction: Coulomb friction is larger by this while extending, smaller while retracting [N]; neutral
        """
    @direction_friction.setter
    def direction_friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def discharge_coefficient(self) -> float:
        """
        flow through an orifice over that of an ideal nozzle, C_d [1]; published, section 5.3.2 (the maker's value)
        """
    @discharge_coefficient.setter
    def discharge_coefficient(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def end_stop_damping(self) -> float:
        """
        growth of the contact force with the speed of impact (Hunt and Crossley) [s/m]; assumed: a rebound of about 0.6 at 0.3 m/s
        """
    @end_stop_damping.setter
    def end_stop_damping(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def end_stop_stiffness(self) -> float:
        """
        stiffness of the contact at both ends of the stroke [N/m]; assumed: metal on metal, 0.2 mm under the static load; an elastic buffer gives way by ten times as much
        """
    @end_stop_stiffness.setter
    def end_stop_stiffness(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def exhaust_flow_change(self) -> float:
        """
        exhaust_restriction: relative change of the conductance to the exhaust, as by its silencer [1]; neutral
        """
    @exhaust_flow_change.setter
    def exhaust_flow_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def exponential_friction_force(self) -> float:
        """
        amplitude of the upturn at high speed, F_UE (eq. 6.6) [N]; assumed: not published, identifiable from fast runs
        """
    @exponential_friction_force.setter
    def exponential_friction_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def exponential_friction_rate(self) -> float:
        """
        growth of that upturn, gamma_f (eq. 6.6) [s/m]; published, section 6.5
        """
    @exponential_friction_rate.setter
    def exponential_friction_rate(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_1(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 0.6 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_1.setter
    def flow_map_feed_lower_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_2(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 0.75 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_2.setter
    def flow_map_feed_lower_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_3(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 0.95 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_3.setter
    def flow_map_feed_lower_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_4(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 1.25 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_4.setter
    def flow_map_feed_lower_4(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_5(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 1.8 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_5.setter
    def flow_map_feed_lower_5(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_lower_6(self) -> float:
        """
        relative error of the tables' flow into the lower chamber at an opening of 3.0 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_lower_6.setter
    def flow_map_feed_lower_6(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_1(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 0.6 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_1.setter
    def flow_map_feed_upper_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_2(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 0.75 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_2.setter
    def flow_map_feed_upper_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_3(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 0.95 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_3.setter
    def flow_map_feed_upper_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_4(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 1.25 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_4.setter
    def flow_map_feed_upper_4(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_5(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 1.8 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_5.setter
    def flow_map_feed_upper_5(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_feed_upper_6(self) -> float:
        """
        relative error of the tables' flow into the upper chamber at an opening of 3.0 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_feed_upper_6.setter
    def flow_map_feed_upper_6(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_1(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 0.6 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_1.setter
    def flow_map_vent_lower_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_2(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 0.75 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_2.setter
    def flow_map_vent_lower_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_3(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 0.95 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_3.setter
    def flow_map_vent_lower_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_4(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 1.25 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_4.setter
    def flow_map_vent_lower_4(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_5(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 1.8 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_5.setter
    def flow_map_vent_lower_5(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_lower_6(self) -> float:
        """
        relative error of the tables' flow out of the lower chamber at an opening of 3.0 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_lower_6.setter
    def flow_map_vent_lower_6(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_1(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 0.6 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_1.setter
    def flow_map_vent_upper_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_2(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 0.75 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_2.setter
    def flow_map_vent_upper_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_3(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 0.95 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_3.setter
    def flow_map_vent_upper_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_4(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 1.25 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_4.setter
    def flow_map_vent_upper_4(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_5(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 1.8 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_5.setter
    def flow_map_vent_upper_5(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def flow_map_vent_upper_6(self) -> float:
        """
        relative error of the tables' flow out of the upper chamber at an opening of 3.0 V [1]; derived: spread of Tables 5.1 and 5.2
        """
    @flow_map_vent_upper_6.setter
    def flow_map_vent_upper_6(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def frame_compliance(self) -> float:
        """
        frame_compliance: by how much the mount yields per newton, seen by a position sensor that stands on the ground [m/N]; neutral
        """
    @frame_compliance.setter
    def frame_compliance(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_lag(self) -> float:
        """
        friction_lag: by how much the lubricant film, and with it friction, is late against the speed [s]; neutral
        """
    @friction_lag.setter
    def friction_lag(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_extend_1(self) -> float:
        """
        relative error of the friction curve, extending at 0.03 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_extend_1.setter
    def friction_map_extend_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_extend_2(self) -> float:
        """
        relative error of the friction curve, extending at 0.12 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_extend_2.setter
    def friction_map_extend_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_extend_3(self) -> float:
        """
        relative error of the friction curve, extending at 0.3 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_extend_3.setter
    def friction_map_extend_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_retract_1(self) -> float:
        """
        relative error of the friction curve, retracting at 0.03 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_retract_1.setter
    def friction_map_retract_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_retract_2(self) -> float:
        """
        relative error of the friction curve, retracting at 0.12 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_retract_2.setter
    def friction_map_retract_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def friction_map_retract_3(self) -> float:
        """
        relative error of the friction curve, retracting at 0.3 m/s [1]; assumed, a few percent (section 7.3)
        """
    @friction_map_retract_3.setter
    def friction_map_retract_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def gas_constant(self) -> float:
        """
        gas constant of (moist) air, R [J/(kg K)]; published, section 4.1.3.3.1 and ISO 6358
        """
    @gas_constant.setter
    def gas_constant(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def gravity(self) -> float:
        """
        acceleration of free fall [m/s^2]; published, section 3.3
        """
    @gravity.setter
    def gravity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def heat_capacity_ratio(self) -> float:
        """
        c_p / c_v of air, kappa [1]; published, section 4.1.2.2.3
        """
    @heat_capacity_ratio.setter
    def heat_capacity_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def heat_share(self) -> float:
        """
        heat_transfer: from air that follows the polytropic law, in a tank at constant temperature (0), to the full energy equation with heat through the wall (1) [1]; neutral
        """
    @heat_share.setter
    def heat_share(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def heat_transfer_coefficient(self) -> float:
        """
        heat from wall to air per area and degree, h [W/(m^2 K)]; assumed, of the order of forced convection in air; enters the full energy equation only
        """
    @heat_transfer_coefficient.setter
    def heat_transfer_coefficient(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def inflow_heat_ratio(self) -> float:
        """
        ratio of heat capacities for air that enters, alpha_i [1]; published, section 4.1.3.2.1: charging is nearly adiabatic
        """
    @inflow_heat_ratio.setter
    def inflow_heat_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def integral_gain(self) -> float:
        """
        G_I of eq. 7.4 [V/(m s)]; published, section 7.3.6
        """
    @integral_gain.setter
    def integral_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def land_width(self) -> float:
        """
        width of the spool's seal, w_S [m]; published, Table 4.1
        """
    @land_width.setter
    def land_width(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def leakage_critical_ratio(self) -> float:
        """
        critical pressure ratio of that gap [1]; assumed, a labyrinth of many throttles: 0; one throttle: 0.53
        """
    @leakage_critical_ratio.setter
    def leakage_critical_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def leakage_index(self) -> float:
        """
        subsonic index of that gap [1]; assumed, a labyrinth: 2; the first rows of the tables, which are leakage, have 1.14 and 1.32 when charging
        """
    @leakage_index.setter
    def leakage_index(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def loop_gain(self) -> float:
        """
        state feedback, K_c [1]; published, section 8.2
        """
    @loop_gain.setter
    def loop_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def mass_flow_gain(self) -> float:
        """
        flow through the valve on a cylinder over that of the tables, which were measured on a tank [1]; published, section 7.1.1: 1.5 to 1.65
        """
    @mass_flow_gain.setter
    def mass_flow_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def moving_mass(self) -> float:
        """
        piston, rod and what moves with them on the bench, M_p [kg]; published, Table 6.1 (3.528 kg printed in Table 4.2)
        """
    @moving_mass.setter
    def moving_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def opening_duration(self) -> float:
        """
        time over which the valve opens [s]; derived: half a period of the spool's 65 Hz
        """
    @opening_duration.setter
    def opening_duration(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def opening_time(self) -> float:
        """
        when the valve begins to open, on the record's clock [s]; assumed: set by the test
        """
    @opening_time.setter
    def opening_time(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def outflow_heat_ratio(self) -> float:
        """
        ratio of heat capacities for air that leaves, alpha_o [1]; published, section 4.1.3.2.1: discharging is nearly isothermal
        """
    @outflow_heat_ratio.setter
    def outflow_heat_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_friction(self) -> float:
        """
        panhard_friction: viscous moment of the joints of one Panhard rod per its turning speed [N m s/rad]; neutral
        """
    @panhard_friction.setter
    def panhard_friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_inertia_axial(self) -> float:
        """
        inertia of the Panhard rod about its axis [kg m^2]; derived: Table 3.1, row Panhard 2, I_xx less the rise of the rod
        """
    @panhard_inertia_axial.setter
    def panhard_inertia_axial(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_inertia_transverse(self) -> float:
        """
        inertia of the Panhard rod across its axis [kg m^2]; published, Table 3.1, row Panhard 2, I_yy
        """
    @panhard_inertia_transverse.setter
    def panhard_inertia_transverse(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_length_offset_1(self) -> float:
        """
        length of Panhard rod 1, less |P4 - B4| at rest [m]; derived: the rods hold the rest pose
        """
    @panhard_length_offset_1.setter
    def panhard_length_offset_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_length_offset_2(self) -> float:
        """
        length of Panhard rod 2, less |P5 - B5| at rest [m]; derived: the rods hold the rest pose
        """
    @panhard_length_offset_2.setter
    def panhard_length_offset_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_length_offset_3(self) -> float:
        """
        length of Panhard rod 3, less |P6 - B6| at rest [m]; derived: the rods hold the rest pose
        """
    @panhard_length_offset_3.setter
    def panhard_length_offset_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def panhard_mass(self) -> float:
        """
        Panhard rod, one of three, m; its centre of gravity is half-way [kg]; published, Table 3.1
        """
    @panhard_mass.setter
    def panhard_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_cog_x(self) -> float:
        """
        centre of gravity of the payload, x [m]; published, Table 3.1
        """
    @payload_cog_x.setter
    def payload_cog_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_cog_y(self) -> float:
        """
        centre of gravity of the payload, y [m]; published, Table 3.1
        """
    @payload_cog_y.setter
    def payload_cog_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_cog_z(self) -> float:
        """
        centre of gravity of the payload, z (down) [m]; published, Table 3.1
        """
    @payload_cog_z.setter
    def payload_cog_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_xx(self) -> float:
        """
        inertia of the payload, I_xx [kg m^2]; published, Table 3.1
        """
    @payload_inertia_xx.setter
    def payload_inertia_xx(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_xy(self) -> float:
        """
        inertia of the payload, I_xy [kg m^2]; published, Table 3.1 gives no products
        """
    @payload_inertia_xy.setter
    def payload_inertia_xy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_xz(self) -> float:
        """
        inertia of the payload, I_xz [kg m^2]; published, Table 3.1 gives no products
        """
    @payload_inertia_xz.setter
    def payload_inertia_xz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_yy(self) -> float:
        """
        inertia of the payload, I_yy [kg m^2]; published, Table 3.1
        """
    @payload_inertia_yy.setter
    def payload_inertia_yy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_yz(self) -> float:
        """
        inertia of the payload, I_yz [kg m^2]; published, Table 3.1 gives no products
        """
    @payload_inertia_yz.setter
    def payload_inertia_yz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_inertia_zz(self) -> float:
        """
        inertia of the payload, I_zz [kg m^2]; published, Table 3.1
        """
    @payload_inertia_zz.setter
    def payload_inertia_zz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def payload_mass(self) -> float:
        """
        what stands on the top frame (SAT), m [kg]; published, Table 3.1
        """
    @payload_mass.setter
    def payload_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_cog_x(self) -> float:
        """
        centre of gravity of the piston and rod of actuator 1 at rest, x [m]; published, Table 3.1
        """
    @piston_cog_x.setter
    def piston_cog_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_cog_y(self) -> float:
        """
        centre of gravity of the piston and rod of actuator 1 at rest, y [m]; published, Table 3.1
        """
    @piston_cog_y.setter
    def piston_cog_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_cog_z(self) -> float:
        """
        centre of gravity of the piston and rod of actuator 1 at rest, z (down) [m]; published, Table 3.1
        """
    @piston_cog_z.setter
    def piston_cog_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_xx(self) -> float:
        """
        inertia of that piston and rod, I_xx [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @piston_inertia_xx.setter
    def piston_inertia_xx(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_xy(self) -> float:
        """
        inertia of that piston and rod, I_xy [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @piston_inertia_xy.setter
    def piston_inertia_xy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_xz(self) -> float:
        """
        inertia of that piston and rod, I_xz [kg m^2]; derived: slender along the actuator, see bodies.hpp
        """
    @piston_inertia_xz.setter
    def piston_inertia_xz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_yy(self) -> float:
        """
        inertia of that piston and rod, I_yy [kg m^2]; derived: Table 3.1, rows 1 and 3, see bodies.hpp
        """
    @piston_inertia_yy.setter
    def piston_inertia_yy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_yz(self) -> float:
        """
        inertia of that piston and rod, I_yz [kg m^2]; derived: the actuator stands in the x-z plane
        """
    @piston_inertia_yz.setter
    def piston_inertia_yz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_inertia_zz(self) -> float:
        """
        inertia of that piston and rod, I_zz [kg m^2]; published, Table 3.1
        """
    @piston_inertia_zz.setter
    def piston_inertia_zz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_leakage(self) -> float:
        """
        piston_leakage: flow past the piston per pressure difference, where one pressure is half of the other [kg/(s Pa)]; neutral
        """
    @piston_leakage.setter
    def piston_leakage(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_leakage_index(self) -> float:
        """
        exponent of that flow over the pressure difference [1]; assumed, a laminar gap: 1; turbulent: 0.5; a nozzle that chokes: 0.4
        """
    @piston_leakage_index.setter
    def piston_leakage_index(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def piston_mass(self) -> float:
        """
        piston and rod, one of three, m [kg]; published, Table 3.1 (4.2 says 3.528 kg, 6.1 says 3.639 kg)
        """
    @piston_mass.setter
    def piston_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_1_x(self) -> float:
        """
        P1, platform joint of actuator 1, x [m]; published, Table 3.2
        """
    @platform_joint_1_x.setter
    def platform_joint_1_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_1_y(self) -> float:
        """
        P1, platform joint of actuator 1, y [m]; published, Table 3.2
        """
    @platform_joint_1_y.setter
    def platform_joint_1_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_1_z(self) -> float:
        """
        P1, platform joint of actuator 1, z (down) [m]; published, Table 3.2
        """
    @platform_joint_1_z.setter
    def platform_joint_1_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_2_x(self) -> float:
        """
        P2, platform joint of actuator 2, x [m]; published, Table 3.2
        """
    @platform_joint_2_x.setter
    def platform_joint_2_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_2_y(self) -> float:
        """
        P2, platform joint of actuator 2, y [m]; published, Table 3.2
        """
    @platform_joint_2_y.setter
    def platform_joint_2_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_2_z(self) -> float:
        """
        P2, platform joint of actuator 2, z (down) [m]; published, Table 3.2
        """
    @platform_joint_2_z.setter
    def platform_joint_2_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_3_x(self) -> float:
        """
        P3, platform joint of actuator 3, x [m]; published, Table 3.2
        """
    @platform_joint_3_x.setter
    def platform_joint_3_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_3_y(self) -> float:
        """
        P3, platform joint of actuator 3, y [m]; published, Table 3.2
        """
    @platform_joint_3_y.setter
    def platform_joint_3_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_3_z(self) -> float:
        """
        P3, platform joint of actuator 3, z (down) [m]; published, Table 3.2
        """
    @platform_joint_3_z.setter
    def platform_joint_3_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_4_x(self) -> float:
        """
        P4, platform joint of Panhard rod 1, x [m]; published, Table 3.2
        """
    @platform_joint_4_x.setter
    def platform_joint_4_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_4_y(self) -> float:
        """
        P4, platform joint of Panhard rod 1, y [m]; published, Table 3.2
        """
    @platform_joint_4_y.setter
    def platform_joint_4_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_4_z(self) -> float:
        """
        P4, platform joint of Panhard rod 1, z (down) [m]; published, Table 3.2
        """
    @platform_joint_4_z.setter
    def platform_joint_4_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_5_x(self) -> float:
        """
        P5, platform joint of Panhard rod 2, x [m]; published, Table 3.2
        """
    @platform_joint_5_x.setter
    def platform_joint_5_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_5_y(self) -> float:
        """
        P5, platform joint of Panhard rod 2, y [m]; published, Table 3.2
        """
    @platform_joint_5_y.setter
    def platform_joint_5_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_5_z(self) -> float:
        """
        P5, platform joint of Panhard rod 2, z (down) [m]; published, Table 3.2
        """
    @platform_joint_5_z.setter
    def platform_joint_5_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_6_x(self) -> float:
        """
        P6, platform joint of Panhard rod 3, x [m]; published, Table 3.2
        """
    @platform_joint_6_x.setter
    def platform_joint_6_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_6_y(self) -> float:
        """
        P6, platform joint of Panhard rod 3, y [m]; published, Table 3.2
        """
    @platform_joint_6_y.setter
    def platform_joint_6_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def platform_joint_6_z(self) -> float:
        """
        P6, platform joint of Panhard rod 3, z (down) [m]; published, Table 3.2
        """
    @platform_joint_6_z.setter
    def platform_joint_6_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def port_angle(self) -> float:
        """
        angle of an orifice around the barrel, theta_S [rad]; published, Table 4.1
        """
    @port_angle.setter
    def port_angle(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def port_count(self) -> float:
        """
        orifices of a port, N [1]; published, Table 4.1
        """
    @port_count.setter
    def port_count(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def port_width(self) -> float:
        """
        width of a port's orifices, w_O [m]; published, Table 4.1
        """
    @port_width.setter
    def port_width(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def position_friction(self) -> float:
        """
        position_dependent_friction: relative growth of friction per metre of extension beyond mid-stroke [1/m]; neutral
        """
    @position_friction.setter
    def position_friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def position_gain(self) -> float:
        """
        state feedback, K_p [V/m]; published, Table E.1
        """
    @position_gain.setter
    def position_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def potentiometer_margin(self) -> float:
        """
        where on that travel the retracted piston is [m]; assumed, the stroke lies in the middle of that travel
        """
    @potentiometer_margin.setter
    def potentiometer_margin(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def potentiometer_range(self) -> float:
        """
        travel over which the position sensor spans the converter [m]; published, section 7.3.3
        """
    @potentiometer_range.setter
    def potentiometer_range(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def presliding_share(self) -> float:
        """
        presliding: share of the friction that the seals carry by their deformation before they slide [1]; neutral
        """
    @presliding_share.setter
    def presliding_share(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def pressure_friction(self) -> float:
        """
        pressure_dependent_friction: friction per pascal of p_lower + p_upper - 2 p_ambient, from lips pressed on the bore [N/Pa]; neutral
        """
    @pressure_friction.setter
    def pressure_friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def pressure_stiction(self) -> float:
        """
        pressure_dependent_friction: relative growth of static less Coulomb friction per pascal of the same pressures; pressure_friction / coulomb_force where all dry friction grows alike [1/Pa]; neutral
        """
    @pressure_stiction.setter
    def pressure_stiction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def proportional_gain(self) -> float:
        """
        G_P of eq. 7.4 [V/m]; published, section 7.3.6
        """
    @proportional_gain.setter
    def proportional_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def pwm_steps(self) -> float:
        """
        steps of the pulse width between 0 and 10 V [1]; derived: 150 MHz over 10 us up and down, section 7.3.2
        """
    @pwm_steps.setter
    def pwm_steps(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reference_density(self) -> float:
        """
        density of air at the reference state, rho_0 [kg/m^3]; published, ISO 6358; section A's p_0 / (R T_0) is 1.1845
        """
    @reference_density.setter
    def reference_density(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reference_point_x(self) -> float:
        """
        point of the platform whose height, x and y a pose states, x [m]; published, Table 3.1: centre of gravity of the top frame
        """
    @reference_point_x.setter
    def reference_point_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reference_point_y(self) -> float:
        """
        point of the platform whose height, x and y a pose states, y [m]; published, Table 3.1: centre of gravity of the top frame
        """
    @reference_point_y.setter
    def reference_point_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reference_point_z(self) -> float:
        """
        point of the platform whose height, x and y a pose states, z (down) [m]; published, Table 3.1: centre of gravity of the top frame
        """
    @reference_point_z.setter
    def reference_point_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reference_temperature(self) -> float:
        """
        temperature of that state, T_0 [K]; published, section A and ISO 6358
        """
    @reference_temperature.setter
    def reference_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def reservoir_volume(self) -> float:
        """
        volume of the reservoir at each valve, V_R [m^3]; published, section 4.1.5
        """
    @reservoir_volume.setter
    def reservoir_volume(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def rod_diameter(self) -> float:
        """
        diameter of the piston rod [m]; published, section 6.1
        """
    @rod_diameter.setter
    def rod_diameter(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_datum_chamber_pressure_lower(self) -> float:
        """
        signal at which the sensor of chamber_pressure_lower itself reads nothing; a gain error is a share of what it reads from there [Pa]; assumed, where a record's column is zero
        """
    @sensor_datum_chamber_pressure_lower.setter
    def sensor_datum_chamber_pressure_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_datum_chamber_pressure_upper(self) -> float:
        """
        signal at which the sensor of chamber_pressure_upper itself reads nothing; a gain error is a share of what it reads from there [Pa]; assumed, where a record's column is zero
        """
    @sensor_datum_chamber_pressure_upper.setter
    def sensor_datum_chamber_pressure_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_datum_extension(self) -> float:
        """
        signal at which the sensor of extension itself reads nothing; a gain error is a share of what it reads from there [m]; assumed, where a record's column is zero
        """
    @sensor_datum_extension.setter
    def sensor_datum_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_datum_supply_pressure(self) -> float:
        """
        signal at which the sensor of supply_pressure itself reads nothing; a gain error is a share of what it reads from there [Pa]; assumed, where a record's column is zero
        """
    @sensor_datum_supply_pressure.setter
    def sensor_datum_supply_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_datum_tank_pressure(self) -> float:
        """
        signal at which the sensor of tank_pressure itself reads nothing; a gain error is a share of what it reads from there [Pa]; assumed, where a record's column is zero
        """
    @sensor_datum_tank_pressure.setter
    def sensor_datum_tank_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_chamber_pressure_lower(self) -> float:
        """
        sensor_gain: relative gain error of the lower chamber pressure sensor [1]; neutral
        """
    @sensor_gain_chamber_pressure_lower.setter
    def sensor_gain_chamber_pressure_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_chamber_pressure_upper(self) -> float:
        """
        sensor_gain: relative gain error of the upper chamber pressure sensor [1]; neutral
        """
    @sensor_gain_chamber_pressure_upper.setter
    def sensor_gain_chamber_pressure_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_extension(self) -> float:
        """
        sensor_gain: relative gain error of the position sensor [1]; neutral
        """
    @sensor_gain_extension.setter
    def sensor_gain_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_pitch(self) -> float:
        """
        sensor_gain: relative gain error of the pitch sensor [1]; neutral
        """
    @sensor_gain_pitch.setter
    def sensor_gain_pitch(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_rod_force(self) -> float:
        """
        sensor_gain: relative gain error of the rod force sensor [1]; neutral
        """
    @sensor_gain_rod_force.setter
    def sensor_gain_rod_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_roll(self) -> float:
        """
        sensor_gain: relative gain error of the roll sensor [1]; neutral
        """
    @sensor_gain_roll.setter
    def sensor_gain_roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_supply_pressure(self) -> float:
        """
        sensor_gain: relative gain error of the supply pressure sensor [1]; neutral
        """
    @sensor_gain_supply_pressure.setter
    def sensor_gain_supply_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_tank_pressure(self) -> float:
        """
        sensor_gain: relative gain error of the tank pressure sensor [1]; neutral
        """
    @sensor_gain_tank_pressure.setter
    def sensor_gain_tank_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_gain_tank_temperature(self) -> float:
        """
        sensor_gain: relative gain error of the tank temperature sensor [1]; neutral
        """
    @sensor_gain_tank_temperature.setter
    def sensor_gain_tank_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_chamber_pressure_lower(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of chamber_pressure_lower is late [s]; neutral
        """
    @sensor_lag_chamber_pressure_lower.setter
    def sensor_lag_chamber_pressure_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_chamber_pressure_upper(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of chamber_pressure_upper is late [s]; neutral
        """
    @sensor_lag_chamber_pressure_upper.setter
    def sensor_lag_chamber_pressure_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_extension(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of extension is late [s]; neutral
        """
    @sensor_lag_extension.setter
    def sensor_lag_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_pitch(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of pitch is late [s]; neutral
        """
    @sensor_lag_pitch.setter
    def sensor_lag_pitch(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_roll(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of roll is late [s]; neutral
        """
    @sensor_lag_roll.setter
    def sensor_lag_roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_lag_tank_pressure(self) -> float:
        """
        sensor_lag: by how much the filter of the sensor of tank_pressure is late [s]; neutral
        """
    @sensor_lag_tank_pressure.setter
    def sensor_lag_tank_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_chamber_pressure_lower(self) -> float:
        """
        by how much the lower chamber pressure sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_chamber_pressure_lower.setter
    def sensor_linearity_chamber_pressure_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_chamber_pressure_upper(self) -> float:
        """
        by how much the upper chamber pressure sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_chamber_pressure_upper.setter
    def sensor_linearity_chamber_pressure_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_extension(self) -> float:
        """
        by how much the position sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_extension.setter
    def sensor_linearity_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_pitch(self) -> float:
        """
        by how much the pitch sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_pitch.setter
    def sensor_linearity_pitch(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_rod_force(self) -> float:
        """
        by how much the rod force sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_rod_force.setter
    def sensor_linearity_rod_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_roll(self) -> float:
        """
        by how much the roll sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_roll.setter
    def sensor_linearity_roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_supply_pressure(self) -> float:
        """
        by how much the supply pressure sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_supply_pressure.setter
    def sensor_linearity_supply_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_tank_pressure(self) -> float:
        """
        by how much the tank pressure sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_tank_pressure.setter
    def sensor_linearity_tank_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_linearity_tank_temperature(self) -> float:
        """
        by how much the tank temperature sensor's readings bow off their best straight line, of its span [1]; neutral
        """
    @sensor_linearity_tank_temperature.setter
    def sensor_linearity_tank_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_chamber_pressure_lower(self) -> float:
        """
        sensor_offset: zero error of the lower chamber pressure sensor [Pa]; neutral
        """
    @sensor_offset_chamber_pressure_lower.setter
    def sensor_offset_chamber_pressure_lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_chamber_pressure_upper(self) -> float:
        """
        sensor_offset: zero error of the upper chamber pressure sensor [Pa]; neutral
        """
    @sensor_offset_chamber_pressure_upper.setter
    def sensor_offset_chamber_pressure_upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_extension(self) -> float:
        """
        sensor_offset: zero error of the position sensor [m]; neutral
        """
    @sensor_offset_extension.setter
    def sensor_offset_extension(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_pitch(self) -> float:
        """
        sensor_offset: zero error of the pitch sensor [rad]; neutral
        """
    @sensor_offset_pitch.setter
    def sensor_offset_pitch(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_rod_force(self) -> float:
        """
        sensor_offset: zero error of the rod force sensor [N]; neutral
        """
    @sensor_offset_rod_force.setter
    def sensor_offset_rod_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_roll(self) -> float:
        """
        sensor_offset: zero error of the roll sensor [rad]; neutral
        """
    @sensor_offset_roll.setter
    def sensor_offset_roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_supply_pressure(self) -> float:
        """
        sensor_offset: zero error of the supply pressure sensor [Pa]; neutral
        """
    @sensor_offset_supply_pressure.setter
    def sensor_offset_supply_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_tank_pressure(self) -> float:
        """
        sensor_offset: zero error of the tank pressure sensor [Pa]; neutral
        """
    @sensor_offset_tank_pressure.setter
    def sensor_offset_tank_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def sensor_offset_tank_temperature(self) -> float:
        """
        sensor_offset: zero error of the tank temperature sensor [K]; neutral
        """
    @sensor_offset_tank_temperature.setter
    def sensor_offset_tank_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_cubic_0(self) -> float:
        """
        spool at 0 V [m]; published, eq. 4.1
        """
    @spool_cubic_0.setter
    def spool_cubic_0(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_cubic_1(self) -> float:
        """
        spool over command, linear term [m/V]; published, eq. 4.1
        """
    @spool_cubic_1.setter
    def spool_cubic_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_cubic_2(self) -> float:
        """
        spool over command, square term [m/V^2]; published, eq. 4.1
        """
    @spool_cubic_2.setter
    def spool_cubic_2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_cubic_3(self) -> float:
        """
        spool over command, cubic term [m/V^3]; published, eq. 4.1
        """
    @spool_cubic_3.setter
    def spool_cubic_3(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_limit(self) -> float:
        """
        largest deflection of the spool, x_Smax [m]; published, Table 4.1
        """
    @spool_limit.setter
    def spool_limit(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_linear_0(self) -> float:
        """
        spool over command, the linear law at 0 V [m]; published, eq. 4.2
        """
    @spool_linear_0.setter
    def spool_linear_0(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_linear_1(self) -> float:
        """
        spool over command, slope of the linear law [m/V]; published, eq. 4.2
        """
    @spool_linear_1.setter
    def spool_linear_1(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def spool_position(self) -> float:
        """
        where the spool is held during a flow test, from its pneumatic centre; enters the classic law only [m]; assumed: set by the test
        """
    @spool_position.setter
    def spool_position(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stiction_force(self) -> float:
        """
        static friction, F_S [N]; published, section 6.5
        """
    @stiction_force.setter
    def stiction_force(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stiction_shape(self) -> float:
        """
        form of that rise: 0 the sine, 1 a hyperbolic tangent of the same slope, between: a mixture [1]; assumed: eq. 6.7 is a regularisation, its form was not measured
        """
    @stiction_shape.setter
    def stiction_shape(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stiction_velocity(self) -> float:
        """
        below it the friction force is led through zero by a sine, eps_f (eq. 6.7) [m/s]; published, section 6.5
        """
    @stiction_velocity.setter
    def stiction_velocity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stribeck_acceleration_factor(self) -> float:
        """
        the Stribeck velocity is |a| zeta v_S; zeta = 0: no Stribeck term [s^2/m]; published, section 6.5
        """
    @stribeck_acceleration_factor.setter
    def stribeck_acceleration_factor(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stribeck_exponent(self) -> float:
        """
        shape of that fall, delta [1]; published, section 6.5
        """
    @stribeck_exponent.setter
    def stribeck_exponent(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stribeck_velocity(self) -> float:
        """
        velocity scale of the fall from static to Coulomb friction, v_S [m/s]; published, section 6.5
        """
    @stribeck_velocity.setter
    def stribeck_velocity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def stroke(self) -> float:
        """
        travel from retracted to extended [m]; published, section 4.1.3
        """
    @stroke.setter
    def stroke(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def supply_line_resistance(self) -> float:
        """
        supply_droop: pressure lost in the supply line per mass flow; 0: the valve sees the supply pressure [Pa s/kg]; neutral
        """
    @supply_line_resistance.setter
    def supply_line_resistance(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def supply_line_turbulence(self) -> float:
        """
        supply_droop: pressure lost there besides per mass flow squared [Pa s^2/kg^2]; neutral
        """
    @supply_line_turbulence.setter
    def supply_line_turbulence(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def supply_pressure(self) -> float:
        """
        pressure in front of the supply line, absolute, p_s [Pa]; published, 0.4 MPa gauge over 86 kPa (section 5.2)
        """
    @supply_pressure.setter
    def supply_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_flow_change(self) -> float:
        """
        flow_conductance of a tank: relative change of the valve's flow against its tables, which were measured on one [1]; neutral
        """
    @tank_flow_change.setter
    def tank_flow_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_inflow_heat_change(self) -> float:
        """
        polytropic_index of a tank: relative change of the ratio of heat capacities for air that enters, against that of the tank on which the valve's tables were measured [1]; neutral
        """
    @tank_inflow_heat_change.setter
    def tank_inflow_heat_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_initial_pressure(self) -> float:
        """
        pressure in the tank before the valve opens, absolute [Pa]; assumed: set by the test
        """
    @tank_initial_pressure.setter
    def tank_initial_pressure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_line_resistance(self) -> float:
        """
        line_pressure_loss: the sensor, which sits in the line (section 5.4.2), reads this more than the tank per mass flow into it [Pa s/kg]; neutral
        """
    @tank_line_resistance.setter
    def tank_line_resistance(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_pressure_ceiling(self) -> float:
        """
        pressure_sensor_ceiling: the tank's pressure sensor reads no more, absolute [Pa]; neutral
        """
    @tank_pressure_ceiling.setter
    def tank_pressure_ceiling(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_pressure_floor(self) -> float:
        """
        pressure_sensor_floor: the tank's pressure sensor reads no less, absolute (about 100 mbar gauge in section 5.3.1) [Pa]; neutral
        """
    @tank_pressure_floor.setter
    def tank_pressure_floor(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_volume(self) -> float:
        """
        volume of the tank, V_c [m^3]; published, section 5.4.3
        """
    @tank_volume.setter
    def tank_volume(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tank_wall_area(self) -> float:
        """
        inner surface of the tank; enters the full energy equation only [m^2]; assumed, a cylinder of 5 l, twice as long as wide
        """
    @tank_wall_area.setter
    def tank_wall_area(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def thermocouple_gain(self) -> float:
        """
        amplification of the thermocouples' voltage [1]; published, section 5.2.2
        """
    @thermocouple_gain.setter
    def thermocouple_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def thermocouple_time_constant(self) -> float:
        """
        thermocouple_lag: the thermocouple follows the air with this time constant (0.4 to 6 s, section 5.2.2) [s]; neutral
        """
    @thermocouple_time_constant.setter
    def thermocouple_time_constant(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_cog_x(self) -> float:
        """
        centre of gravity of the top frame, x [m]; published, Table 3.1
        """
    @top_frame_cog_x.setter
    def top_frame_cog_x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_cog_y(self) -> float:
        """
        centre of gravity of the top frame, y [m]; published, Table 3.1
        """
    @top_frame_cog_y.setter
    def top_frame_cog_y(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_cog_z(self) -> float:
        """
        centre of gravity of the top frame, z (down) [m]; published, Table 3.1
        """
    @top_frame_cog_z.setter
    def top_frame_cog_z(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_inertia_xx(self) -> float:
        """
        inertia of the top frame, I_xx [kg m^2]; published, Table 3.1
        """
    @top_frame_inertia_xx.setter
    def top_frame_inertia_xx(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_inertia_yy(self) -> float:
        """
        inertia of the top frame, I_yy [kg m^2]; published, Table 3.1
        """
    @top_frame_inertia_yy.setter
    def top_frame_inertia_yy(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_inertia_zz(self) -> float:
        """
        inertia of the top frame, I_zz [kg m^2]; published, Table 3.1
        """
    @top_frame_inertia_zz.setter
    def top_frame_inertia_zz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def top_frame_mass(self) -> float:
        """
        top frame, m [kg]; published, Table 3.1
        """
    @top_frame_mass.setter
    def top_frame_mass(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tube_diameter(self) -> float:
        """
        inner diameter of the tube [m]; published, section 4.1.4: PUN-10x1.5
        """
    @tube_diameter.setter
    def tube_diameter(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tube_length(self) -> float:
        """
        tube: length between valve and chamber (under 0.3 m on the machine, section 4.1.4); adds volume, loss and delay [m]; neutral
        """
    @tube_length.setter
    def tube_length(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def tube_loss_factor(self) -> float:
        """
        loss in the tube over that of a smooth straight one: fittings and bends add to it [1]; neutral
        """
    @tube_loss_factor.setter
    def tube_loss_factor(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def valve_centre(self) -> float:
        """
        command at which the valve is closed [V]; published, Tables 5.1 and 5.2 are symmetric about it (4.92 V was found)
        """
    @valve_centre.setter
    def valve_centre(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def valve_damping_ratio(self) -> float:
        """
        damping ratio of the spool [1]; assumed, with it -3 dB falls on the natural frequency
        """
    @valve_damping_ratio.setter
    def valve_damping_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def valve_frequency(self) -> float:
        """
        natural frequency of the spool [Hz]; published, section 4.1.4: -3 dB at full stroke
        """
    @valve_frequency.setter
    def valve_frequency(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def valve_leakage(self) -> float:
        """
        valve_leakage: sonic conductance of the gap past the spool, open on all four edges at any command [m^3/(s Pa)]; neutral
        """
    @valve_leakage.setter
    def valve_leakage(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def velocity_gain(self) -> float:
        """
        state feedback, K_v [V s/m]; published, Table E.1
        """
    @velocity_gain.setter
    def velocity_gain(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def viscous_friction(self) -> float:
        """
        slope of friction over velocity while speeding up, sigma_1 [N s/m]; published, section 6.5
        """
    @viscous_friction.setter
    def viscous_friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def viscous_friction_deceleration_change(self) -> float:
        """
        sigma_2 - sigma_1: the slope while slowing down, less that while speeding up [N s/m]; published, section 6.5 (sigma_2 = sigma_1)
        """
    @viscous_friction_deceleration_change.setter
    def viscous_friction_deceleration_change(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    @property
    def wall_temperature(self) -> float:
        """
        temperature of the cylinder's and of the tank's wall [K]; assumed, the walls are at room temperature
        """
    @wall_temperature.setter
    def wall_temperature(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
class PlatformBody:
    """
    Mass, centre of gravity, inertia about it, gravity; SI.
    """
    def __init__(self, mass: typing.SupportsFloat | typing.SupportsIndex, cog: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], inertia: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], gravity: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"]) -> None:
        ...
class ParallelMechanism:
    """
    A mechanism given by data; see sms.mechanism.Mechanism.
    """
    def __init__(self, base: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], platform: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], length_is: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], fixed_length: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], driven: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], characteristic_length: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def acceleration(self, body: PlatformBody, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], twist: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wrench: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
        """
        (n, 6) each, (n, freedoms) forces -> (n, 6) acceleration; status.
        """
    def complete(self, coordinates: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.bool], numpy.typing.NDArray[numpy.int32]]:
        """
        (n, 6) -> (n, 6) pose that fits rods and planes, Newton steps, residual, singular, status.
        """
    def crossings(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
        """
        (n, 6) -> (n - 1, 8) whether found, fraction of the way, coordinates; status.
        """
    def distance(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) -> (n, 2) condition number, determinant.
        """
    def forward(self, length: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.bool], numpy.typing.NDArray[numpy.int32]]:
        """
        (n, freedoms) lengths, (n, 6) starts -> (n, 6) pose, Newton steps, residual, singular, status.
        """
    def jacobian(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) -> (n, 36) of the six equations by the twist.
        """
    def leg_forces(self, body: PlatformBody, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], twist: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], wrench: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
        """
        (n, 6) each -> (n, 6) forces of the six equations, N; status.
        """
    def lengths(self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) -> (n, legs), m.
        """
    @property
    def characteristic_length(self) -> float:
        """
        m.
        """
    @property
    def freedoms(self) -> int:
        """
        Number of actuated legs.
        """
class Channel:
    """
    What a logger's channel makes of a reading: noise, range, rounding (sensor.hpp).
    """
    def __init__(self, *, noise: typing.SupportsFloat | typing.SupportsIndex = 0.0, low: typing.SupportsFloat | typing.SupportsIndex = -1.7976931348623157e+308, high: typing.SupportsFloat | typing.SupportsIndex = 1.7976931348623157e+308, resolution: typing.SupportsFloat | typing.SupportsIndex = 0.0, rounding: str = 'nearest') -> None:
        """
        noise: standard deviation; low, high: where the reading stays; resolution: step of the converter, which rounds to the "nearest" or "down".
        """
class BenchSimulation:
    """
    One actuator under sampled control (simulate.hpp).
    """
    def __init__(self, *, params: Params, controller: Params, valve_law: str, friction_law: str, chamber_law: str, control: str, compensated: bool, electronics: bool, extension: typing.SupportsFloat | typing.SupportsIndex, load_force: typing.SupportsFloat | typing.SupportsIndex, mean_pressure: typing.SupportsFloat | typing.SupportsIndex, tolerance: typing.SupportsFloat | typing.SupportsIndex, step: typing.SupportsFloat | typing.SupportsIndex, stiff: bool = False, state: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None) -> None:
        ...
    def advance(self, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], load: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        (rows (n, columns), status, rows done) of n control periods; setpoint and noise (n, legs), load (n, 1 or 6).
        """
    def record(self, rows: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], channels: collections.abc.Sequence[Channel], draws: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        The rows of a whole run with their readings as loggers have them: late clocks, then a Channel a reading; draws (n, readings), standard normal.
        """
    def why(self, status: typing.SupportsInt | typing.SupportsIndex) -> str:
        """
        What a status of advance() means for this plant, in words.
        """
    @property
    def columns(self) -> list[str]:
        """
        What each column of a row is.
        """
    @property
    def evaluations(self) -> int:
        """
        Of the plant's derivative, so far.
        """
    @property
    def readings(self) -> list[str]:
        """
        The last of those columns: what the sensors say.
        """
    @property
    def rejected(self) -> int:
        """
        Steps that were tried again smaller, so far.
        """
    @property
    def state(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Where the plant is, as the first columns of a row.
        """
    @property
    def steps(self) -> int:
        """
        Of the integrator, so far.
        """
    @property
    def time(self) -> float:
        """
        s, where the plant is.
        """
class PlatformSimulation:
    """
    The platform under sampled control (simulate.hpp).
    """
    def __init__(self, *, params: typing.Annotated[collections.abc.Sequence[Params], "FixedSize(3)"], controller: Params, valve_law: str, friction_law: str, chamber_law: str, masses: typing.SupportsInt | typing.SupportsIndex, control: str, compensated: bool, electronics: bool, q: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], mean_pressure: typing.SupportsFloat | typing.SupportsIndex, tolerance: typing.SupportsFloat | typing.SupportsIndex, step: typing.SupportsFloat | typing.SupportsIndex, stiff: bool = False, state: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None) -> None:
        ...
    def advance(self, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], load: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        (rows (n, columns), status, rows done) of n control periods; setpoint and noise (n, legs), load (n, 1 or 6).
        """
    def record(self, rows: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], channels: collections.abc.Sequence[Channel], draws: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        The rows of a whole run with their readings as loggers have them: late clocks, then a Channel a reading; draws (n, readings), standard normal.
        """
    def why(self, status: typing.SupportsInt | typing.SupportsIndex) -> str:
        """
        What a status of advance() means for this plant, in words.
        """
    @property
    def columns(self) -> list[str]:
        """
        What each column of a row is.
        """
    @property
    def evaluations(self) -> int:
        """
        Of the plant's derivative, so far.
        """
    @property
    def readings(self) -> list[str]:
        """
        The last of those columns: what the sensors say.
        """
    @property
    def rejected(self) -> int:
        """
        Steps that were tried again smaller, so far.
        """
    @property
    def state(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Where the plant is, as the first columns of a row.
        """
    @property
    def steps(self) -> int:
        """
        Of the integrator, so far.
        """
    @property
    def time(self) -> float:
        """
        s, where the plant is.
        """
class TankSimulation:
    """
    The tank of the flow test behind its valve (tank.hpp).
    """
    def __init__(self, *, params: Params, valve_law: str, chamber_law: str, pressure: typing.SupportsFloat | typing.SupportsIndex, tolerance: typing.SupportsFloat | typing.SupportsIndex, step: typing.SupportsFloat | typing.SupportsIndex, stiff: bool = False, state: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None) -> None:
        ...
    def advance(self, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], load: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple:
        """
        (rows (n, columns), status, rows done) of n control periods; setpoint and noise (n, legs), load (n, 1 or 6).
        """
    def record(self, rows: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], channels: collections.abc.Sequence[Channel], draws: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        The rows of a whole run with their readings as loggers have them: late clocks, then a Channel a reading; draws (n, readings), standard normal.
        """
    def why(self, status: typing.SupportsInt | typing.SupportsIndex) -> str:
        """
        What a status of advance() means for this plant, in words.
        """
    @property
    def columns(self) -> list[str]:
        """
        What each column of a row is.
        """
    @property
    def evaluations(self) -> int:
        """
        Of the plant's derivative, so far.
        """
    @property
    def readings(self) -> list[str]:
        """
        The last of those columns: what the sensors say.
        """
    @property
    def rejected(self) -> int:
        """
        Steps that were tried again smaller, so far.
        """
    @property
    def state(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Where the plant is, as the first columns of a row.
        """
    @property
    def steps(self) -> int:
        """
        Of the integrator, so far.
        """
    @property
    def time(self) -> float:
        """
        s, where the plant is.
        """
class FirmwareSetting:
    """
    What settings.def says of one setting of the firmware.
    """
    @property
    def default(self) -> float:
        ...
    @property
    def doc(self) -> str:
        ...
    @property
    def index(self) -> int:
        """
        parameter_index on the bus
        """
    @property
    def live(self) -> bool:
        """
        may be written while the platform is levelled
        """
    @property
    def lower(self) -> float:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def unit(self) -> str:
        ...
    @property
    def upper(self) -> float:
        ...
class ControllerOutputs:
    """
    What the controller puts out in one period.
    """
    @property
    def characters(self) -> bytes:
        """
        characters for the console, at most 11
        """
    @property
    def feed_watchdog(self) -> bool:
        """
        whether the board is to restart its watchdog
        """
    @property
    def frames(self) -> list[tuple[int, bytes]]:
        """
        frames to be sent: (identifier, 8 octets), in this order
        """
    @property
    def pulse_width(self) -> list[int]:
        """
        counts out of pwm_steps, one for each valve
        """
    @property
    def valve_command(self) -> list[float]:
        """
        mean voltage of those pulses, V
        """
class Controller:
    """
    The application of the firmware (libsms/firmware), one call of tick() a control period.
    """
    def __init__(self, params: Params = ..., settings: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, reset_cause: typing.SupportsInt | typing.SupportsIndex = 0, seed: typing.SupportsInt | typing.SupportsIndex = 0, key: bytes = b'', nonce: typing.SupportsInt | typing.SupportsIndex = 0) -> None:
        """
        As after a reset. settings: values by name (firmware_settings()); reset_cause: 0 power on, 1 watchdog, 2 request; seed: of the first challenge, another one each time; key: 16 octets, then only authentic commands are obeyed; nonce: 64 bits that this key never had before.
        """
    def counts(self, extension: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], chamber_pressure_lower: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], chamber_pressure_upper: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], supply_pressure: typing.SupportsFloat | typing.SupportsIndex) -> list[int]:
        """
        The 10 counts that good sensors give: extension (3,), m; pressures (3,), Pa absolute; supply, Pa absolute.
        """
    def parameter(self, name: str) -> float:
        """
        A parameter or setting that is in effect.
        """
    def tick(self, converted: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], frames: collections.abc.Sequence[tuple[typing.SupportsInt | typing.SupportsIndex, bytes]] = [], characters: str = '', enabled: bool = True, bus_off: bool = False, missed_ticks: typing.SupportsInt | typing.SupportsIndex = 0, load: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> ControllerOutputs:
        """
        One control period (1 ms). converted: 10 counts of 12 bits, see counts(); frames: at most 8 received ones, (identifier, octets); characters: at most 16 from the console; enabled: the enable switch is closed; missed_ticks: periods without a tick before this one; load: duration of the last tick over the period.
        """
    @property
    def control_law(self) -> int:
        """
        value table ControlLaw
        """
    @property
    def extension(self) -> tuple:
        """
        as the controller measures it, m
        """
    @property
    def extension_setpoint(self) -> tuple:
        """
        behind all limits, m
        """
    @property
    def faults(self) -> int:
        """
        bit n - 1 is fault n of the value table Fault
        """
    @property
    def mode(self) -> int:
        """
        value table Mode
        """
    @property
    def session(self) -> int:
        """
        the session in control: 0 nobody, 15 the console
        """
    @property
    def time(self) -> float:
        """
        s since reset
        """
class VirtualRig:
    """
    The firmware's application over a simulated platform (libsms/firmware/virtual_rig.hpp).
    """
    def __init__(self, *, params: typing.Annotated[collections.abc.Sequence[Params], "FixedSize(3)"], height: typing.SupportsFloat | typing.SupportsIndex, mean_pressure: typing.SupportsFloat | typing.SupportsIndex, step: typing.SupportsFloat | typing.SupportsIndex, position_noise: typing.SupportsFloat | typing.SupportsIndex, pressure_noise: typing.SupportsFloat | typing.SupportsIndex, seed: typing.SupportsInt | typing.SupportsIndex, key: bytes = b'', nonce: typing.SupportsInt | typing.SupportsIndex = 0) -> None:
        """
        params of the plant, one set a leg; height m, mean_pressure Pa, step of the integrator s, noise in counts; key: 16 octets, then only authentic commands are obeyed; nonce: 64 bits, others in each run.
        """
    def clear_fault(self, name: str) -> None:
        ...
    def receive(self, identifier: typing.SupportsInt | typing.SupportsIndex, data: bytes) -> bool:
        """
        Hand a frame to the controller; False: too many are waiting, it is lost.
        """
    def set_fault(self, name: str, leg: typing.SupportsInt | typing.SupportsIndex, amount: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def step(self, periods: typing.SupportsInt | typing.SupportsIndex) -> list:
        """
        Run so many control periods; the frames sent: (time s, identifier, data).
        """
    @property
    def chamber_pressure_lower(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        The truth, Pa.
        """
    @property
    def chamber_pressure_upper(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        The truth, Pa.
        """
    @property
    def evaluations(self) -> int:
        """
        Of the plant's derivative, so far.
        """
    @property
    def extension(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        The truth, m.
        """
    @property
    def extension_rate(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        The truth, m/s.
        """
    @property
    def faults(self) -> int:
        """
        Bit n - 1 is fault n of the value table Fault.
        """
    @property
    def mode(self) -> int:
        """
        Of the controller, value table Mode.
        """
    @property
    def pose(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        The truth: roll, pitch, rad; height, m.
        """
    @property
    def session(self) -> int:
        """
        The session in control, 0: nobody.
        """
    @property
    def time(self) -> float:
        """
        s
        """
class FmuCalls:
    """
    Functions of an instance of an FMU for model exchange, by their addresses (0: none), and the value references of its states, their rates, inputs and outputs. ValueError for what is none.
    """
    def __init__(self, version: typing.SupportsInt | typing.SupportsIndex, instance: typing.SupportsInt | typing.SupportsIndex, set_states: typing.SupportsInt | typing.SupportsIndex, set_values: typing.SupportsInt | typing.SupportsIndex, get_rates: typing.SupportsInt | typing.SupportsIndex, get_values: typing.SupportsInt | typing.SupportsIndex, get_directional: typing.SupportsInt | typing.SupportsIndex, states: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], rates: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], inputs: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], outputs: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]) -> None:
        ...
    def rate_slopes(self, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, states * states): of each state in turn, the derivatives of all rates.
        """
    def rates(self, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, states) rates at states (n, states) and inputs (n, inputs); NaN where the FMU does not answer.
        """
    def reading_slopes(self, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, states * outputs), in the same way.
        """
    def readings(self, x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], u: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, outputs), in the same way.
        """
class CylinderRecord:
    """
    The compared samples of one record of the rig 'cylinder', as read; arrays (n,), SI.
    """
    def __init__(self, *, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], rod_force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., gauge_lower: bool = False, gauge_upper: bool = False, time: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ...) -> None:
        ...
class Problem:
    """
    A model held against measured records.
    """
    def evaluate(self, params: Params, free: collections.abc.Sequence[str] = []) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (residual (rows,), jacobian (rows, free)): predicted minus measured, and its exact derivatives.
        """
    @property
    def rows(self) -> int:
        ...
class CylinderProblem(Problem):
    def __init__(self, records: collections.abc.Sequence[CylinderRecord], law: str = 'acceleration_dependent') -> None:
        """
        law: acceleration_dependent, two_branch, stribeck; dahl and lugre need the records' time.
        """
class TankProblem(Problem):
    """
    One charge or discharge of a tank: time s, pressure Pa absolute as read, temperature K of a thermocouple and supply Pa absolute where they were measured; arrays (n,). Residuals: pressures, then temperatures.
    """
    def __init__(self, *, time: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], charge: bool, temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., supply: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., law: str = 'iso', heat: str = 'polytropic') -> None:
        ...
    @property
    def step(self) -> float:
        """
        s, of the integration
        """
class Window:
    """
    A stretch of a record that is simulated from an initial state of its own.
    """
    @property
    def first(self) -> int:
        ...
    @property
    def record(self) -> int:
        ...
    @property
    def row(self) -> int:
        ...
    @property
    def rows(self) -> int:
        ...
    @property
    def samples(self) -> int:
        ...
    @property
    def start(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Where the search for its initial state begins.
        """
class BenchRecord:
    """
    One evenly sampled record of the rig 'bench'; arrays (n,), SI.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., hold: str = 'linear') -> None:
        """
        setpoint: of a loop that is simulated, where command may be empty: not measured. hold: what the valve has between two samples of the command, "linear" or the "previous" one.
        """
class BenchProblem(Problem):
    """
    Prediction errors over windows, in units of the noise: for each sample of a window, each output.
    """
    def __init__(self, *, records: collections.abc.Sequence[BenchRecord], noise: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex], friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic', window: typing.SupportsFloat | typing.SupportsIndex = 1.0, longest_step: typing.SupportsFloat | typing.SupportsIndex = 0.001, longest_step_elsewhere: typing.SupportsFloat | typing.SupportsIndex | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        noise: standard deviation of a sample of extension, chamber_pressure_lower, chamber_pressure_upper and supply_pressure. longest_step: of the integration, s; longest_step_elsewhere: where the recorded extension says that the piston is well on its way; None: the same. Hidden inputs: a force, N, and flows into either chamber, kg/s.
        """
    def errors(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): predicted less measured over the noise, at the best initial states.
        """
    def hidden(self, params: Params, knots: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.
        """
    def jump_samples(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]"]:
        """
        (windows, commands x 8): the samples of the record that show them; -1 where there are fewer.
        """
    def jumps(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command come further ahead of the sample that shows them; zeros where there are fewer.
        """
    def set_ahead(self, record: typing.SupportsInt | typing.SupportsIndex, command: typing.SupportsInt | typing.SupportsIndex, ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.
        """
    def settle(self, params: Params) -> None:
        """
        Let later searches for initial states begin at the best ones of these parameters.
        """
    def state(self, params: Params, window: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        State of the plant where a window begins, at the initial state found last; simulate_bench and simulate_tank go on from it.
        """
    @property
    def windows(self) -> list[Window]:
        ...
class BenchLoopProblem(Problem):
    """
    Prediction errors over windows, in units of the noise: for each sample of a window, each output.
    """
    def __init__(self, *, records: collections.abc.Sequence[BenchRecord], noise: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex], said: Params, law: str = 'pid', compensated: bool = True, electronics: bool = False, friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic', window: typing.SupportsFloat | typing.SupportsIndex = 1.0, longest_step: typing.SupportsFloat | typing.SupportsIndex = 0.001, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        BenchProblem with the controller simulated. noise: of valve_command too, which is the last output where it is recorded. said: the controller as declared. A fourth hidden input: a voltage at the controller's output, V.
        """
    def errors(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): predicted less measured over the noise, at the best initial states.
        """
    def hidden(self, params: Params, knots: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.
        """
    def jump_samples(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]"]:
        """
        (windows, commands x 8): the samples of the record that show them; -1 where there are fewer.
        """
    def jumps(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command come further ahead of the sample that shows them; zeros where there are fewer.
        """
    def set_ahead(self, record: typing.SupportsInt | typing.SupportsIndex, command: typing.SupportsInt | typing.SupportsIndex, ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.
        """
    def settle(self, params: Params) -> None:
        """
        Let later searches for initial states begin at the best ones of these parameters.
        """
    @property
    def windows(self) -> list[Window]:
        ...
class TankPlantRecord:
    """
    One evenly sampled record of the rig 'tank'; arrays (n,), SI, empty where there is no sensor.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, hold: str = 'linear', valve: str = 'iso_0_4_mpa') -> None:
        ...
class TankPlantProblem(Problem):
    """
    Prediction errors over windows, in units of the noise: for each sample of a window, each output.
    """
    def __init__(self, *, records: collections.abc.Sequence[TankPlantRecord], noise: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex], chambers: str = 'polytropic', window: typing.SupportsFloat | typing.SupportsIndex = 1.0, longest_step: typing.SupportsFloat | typing.SupportsIndex = 0.001, longest_step_elsewhere: typing.SupportsFloat | typing.SupportsIndex | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        noise: standard deviation of a sample of tank_pressure, tank_temperature and supply_pressure. longest_step: of the integration, s; longest_step_elsewhere: where the command has rested for long; None: the same. Hidden inputs: a flow into the tank, kg/s, and a pressure at the head of the supply line, Pa.
        """
    def errors(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): predicted less measured over the noise, at the best initial states.
        """
    def hidden(self, params: Params, knots: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.
        """
    def jump_samples(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]"]:
        """
        (windows, commands x 8): the samples of the record that show them; -1 where there are fewer.
        """
    def jumps(self, params: Params) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command come further ahead of the sample that shows them; zeros where there are fewer.
        """
    def set_ahead(self, record: typing.SupportsInt | typing.SupportsIndex, command: typing.SupportsInt | typing.SupportsIndex, ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.
        """
    def settle(self, params: Params) -> None:
        """
        Let later searches for initial states begin at the best ones of these parameters.
        """
    def state(self, params: Params, window: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        State of the plant where a window begins, at the initial state found last; simulate_bench and simulate_tank go on from it.
        """
    @property
    def windows(self) -> list[Window]:
        ...
class SpoolRecord:
    """
    Command and measured spool position, evenly sampled; (n,), SI.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        ...
    @property
    def first_compared(self) -> int:
        """
        Sample from which on positions are compared; before it the spool is run up.
        """
class SpoolProblem(Problem):
    """
    Predicted less measured spool position, m.
    """
    def __init__(self, records: collections.abc.Sequence[SpoolRecord], law: str = 'cubic') -> None:
        """
        law: cubic (eq. 4.1) or linear (eq. 4.2).
        """
class Fit:
    """
    The result of a least-squares fit.
    """
    @property
    def at_bound(self) -> list[bool]:
        ...
    @property
    def condition(self) -> float:
        """
        condition number of the weighted jacobian with columns of length one
        """
    @property
    def converged(self) -> bool:
        ...
    @property
    def cost(self) -> float:
        """
        sum of the squared weighted residuals
        """
    @property
    def iterations(self) -> int:
        ...
    @property
    def jacobian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, free), not weighted
        """
    @property
    def message(self) -> str:
        ...
    @property
    def params(self) -> Params:
        ...
    @property
    def residual(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,), predicted minus measured at params, not weighted
        """
class LegParams(Params):
    """
    Parameters of a machine with three legs: "name" is that of all legs, "name:2" by how much that of leg 2 is larger, zero unless it is set.
    """
    def __getitem__(self, arg0: str) -> float:
        ...
    def __init__(self, common: Params = ...) -> None:
        ...
    def __setitem__(self, arg0: str, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def copy(self) -> LegParams:
        ...
    @property
    def legs(self) -> list[Params]:
        """
        What each leg has, as simulate_platform takes it.
        """
class PoseProblem:
    """
    Measured poses against the forward kinematics of the extensions read with them, whitened: extension (n, 3) m, pose (n, 6 + distances) roll, pitch, height, yaw, x, y in rad and m and distances between marks (distances, 3), which are given in world axes with the platform at rest; NaN where it was not measured; noises (3,) and (6 + distances,), standard deviations.
    """
    def __init__(self, *, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], extension_noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pose_noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], start: LegParams, ground_marks: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., platform_marks: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ...) -> None:
        ...
    def evaluate(self, params: LegParams, free: collections.abc.Sequence[str] = []) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (residual (rows,), jacobian (rows, free)): predicted minus measured over the noise, and its derivatives.
        """
    def predict(self, params: LegParams) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, 6 + distances): what the pose sensors should read; NaN where the parameters have no pose.
        """
    @property
    def first_row(self) -> list[int]:
        """
        Of each pose, and the number of rows.
        """
    @property
    def rows(self) -> int:
        ...
class Calibration:
    """
    The mechanism that comes closest to measured poses.
    """
    @property
    def converged(self) -> bool:
        ...
    @property
    def iterations(self) -> int:
        ...
    @property
    def jacobian(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, free), whitened, at params
        """
    @property
    def message(self) -> str:
        ...
    @property
    def params(self) -> LegParams:
        ...
    @property
    def residual(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,), whitened, at params
        """
class PlatformRecord:
    """
    One evenly sampled record of the rig 'platform'; arrays (n, 3), a column a leg, SI.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"], supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., roll: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., pitch: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"] = ..., hold: str = 'linear') -> None:
        """
        setpoint: of a loop that is simulated, where command may be empty: not measured. hold: what the valves have between two samples of the commands, "linear" or the "previous" one.
        """
class PlatformProblem:
    """
    Prediction errors over windows, in units of the noise: for each sample of a window, each output.
    """
    def __init__(self, *, records: collections.abc.Sequence[PlatformRecord], noise: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex], friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic', masses: typing.SupportsInt | typing.SupportsIndex = 0, window: typing.SupportsFloat | typing.SupportsIndex = 1.0, longest_step: typing.SupportsFloat | typing.SupportsIndex = 0.0025, longest_step_elsewhere: typing.SupportsFloat | typing.SupportsIndex | None = None, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        noise: standard deviation of a sample of extension_1 .. 3, chamber_pressure_lower_1 .. 3, chamber_pressure_upper_1 .. 3, supply_pressure, roll and pitch. longest_step: of the integration, s; longest_step_elsewhere: where the recorded extensions say that all pistons are well on their way; None: the same. Hidden inputs: forces on the three pistons, N, and flows into the three lower and the three upper chambers, kg/s.
        """
    def errors(self, params: LegParams) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): predicted less measured over the noise, at the best initial states.
        """
    def evaluate(self, params: LegParams, free: collections.abc.Sequence[str] = []) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (residual (rows,), jacobian (rows, free)): predicted minus measured over the noise, and its derivatives.
        """
    def hidden(self, params: LegParams, knots: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.
        """
    def jump_samples(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]"]:
        """
        (windows, commands x 8): the samples of the record that show them; -1 where there are fewer.
        """
    def jumps(self, params: LegParams) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command come further ahead of the sample that shows them; zeros where there are fewer.
        """
    def set_ahead(self, record: typing.SupportsInt | typing.SupportsIndex, command: typing.SupportsInt | typing.SupportsIndex, ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.
        """
    def settle(self, params: LegParams) -> None:
        """
        Let later searches for initial states begin at the best ones of these parameters.
        """
    @property
    def rows(self) -> int:
        ...
    @property
    def windows(self) -> list[Window]:
        ...
class PlatformLoopProblem:
    """
    Prediction errors over windows, in units of the noise: for each sample of a window, each output.
    """
    def __init__(self, *, records: collections.abc.Sequence[PlatformRecord], noise: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex], said: LegParams, law: str = 'pid', compensated: bool = True, electronics: bool = False, friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic', masses: typing.SupportsInt | typing.SupportsIndex = 0, window: typing.SupportsFloat | typing.SupportsIndex = 1.0, longest_step: typing.SupportsFloat | typing.SupportsIndex = 0.0025, threads: typing.SupportsInt | typing.SupportsIndex = 1) -> None:
        """
        PlatformProblem with the controller of each leg simulated. noise: of valve_command_1 .. 3 too, which are the last outputs where they are recorded. said: the machine as declared. Three more hidden inputs: a voltage at each controller's output, V.
        """
    def errors(self, params: LegParams) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (rows,): predicted less measured over the noise, at the best initial states.
        """
    def evaluate(self, params: LegParams, free: collections.abc.Sequence[str] = []) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (residual (rows,), jacobian (rows, free)): predicted minus measured over the noise, and its derivatives.
        """
    def hidden(self, params: LegParams, knots: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, inputs x knots): derivatives against inputs that are hidden in the equations, in each window.
        """
    def jump_samples(self) -> typing.Annotated[numpy.typing.NDArray[numpy.int32], "[m, n]"]:
        """
        (windows, commands x 8): the samples of the record that show them; -1 where there are fewer.
        """
    def jumps(self, params: LegParams) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (rows, commands x 8): derivatives against the time, s, by which the largest jumps of each window's command come further ahead of the sample that shows them; zeros where there are fewer.
        """
    def set_ahead(self, record: typing.SupportsInt | typing.SupportsIndex, command: typing.SupportsInt | typing.SupportsIndex, ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None:
        """
        ahead (samples,), s: by how much the jump that a sample shows came ahead of it. From now on that is known.
        """
    def settle(self, params: LegParams) -> None:
        """
        Let later searches for initial states begin at the best ones of these parameters.
        """
    @property
    def rows(self) -> int:
        ...
    @property
    def windows(self) -> list[Window]:
        ...
class BenchEquations(Problem):
    """
    The force balance, N, the air in lower and upper chamber, kg/s, and the supply, Pa, where it is read: each fed with measured signals, model less measured, sample by sample. Arrays (n, k): value, rate, second derivative.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic') -> None:
        ...
class TankEquations(Problem):
    """
    The air in the tank, kg/s, thermometer, K, and supply, Pa, where they are read: each fed with measured signals, model less measured, sample by sample. Arrays (n, k): value, rate.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"], temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic') -> None:
        ...
class PlatformEquations:
    """
    Three forces, N, flows into three lower and three upper chambers, kg/s, then supply, Pa, roll and pitch, rad, where they are read: each fed with measured signals, model less measured, sample by sample. A list of three has one array a leg, (n, k): value, rate, second derivative.
    """
    def __init__(self, *, step: typing.SupportsFloat | typing.SupportsIndex, command: typing.Annotated[collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]], "FixedSize(3)"], extension: typing.Annotated[collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]], "FixedSize(3)"], pressure_lower: typing.Annotated[collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]], "FixedSize(3)"], pressure_upper: typing.Annotated[collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"]], "FixedSize(3)"], supply_pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., roll: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., pitch: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"] = ..., conditions: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, friction: str = 'acceleration_dependent', valve: str = 'iso_0_4_mpa', chambers: str = 'polytropic', masses: typing.SupportsInt | typing.SupportsIndex = 0) -> None:
        ...
    def evaluate(self, params: LegParams, free: collections.abc.Sequence[str] = []) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]:
        """
        (residual (rows,), jacobian (rows, free)): model less measured, and its derivatives.
        """
    @property
    def rows(self) -> int:
        ...
def air_spring(params: Params, mean_pressure: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Spring constant of both chambers, N/m (eq. 8.2); Pa absolute.
    """
def alpha_beta(measured: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex, alpha: typing.SupportsFloat | typing.SupportsIndex, beta: typing.SupportsFloat | typing.SupportsIndex, value: typing.SupportsFloat | typing.SupportsIndex, rate: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (values, rates), each (n,), of the alpha-beta filter that starts at value and rate.
    """
def calibrate(problem: PoseProblem, start: LegParams, free: collections.abc.Sequence[str], tolerance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"], huber: typing.SupportsFloat | typing.SupportsIndex = 0.0, max_iterations: typing.SupportsInt | typing.SupportsIndex = 100) -> Calibration:
    """
    Least squares over the parameters `free`, each held to its start by a standard deviation `tolerance`, by Huber's loss on poses beyond `huber` standard deviations; ValueError for a bad start.
    """
def carried_points(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], at_rest: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    """
    (n, 6) poses, (k, 3) points of the platform in the rest pose -> (n, 3 k) where they are, m, world axes.
    """
def chamber_energy_rates(params: Params, chamber: str, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], inflow: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], outflow: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], inflow_temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (Pa/s, K/s, kg/s) by the full energy equation with heat from the wall (eq. 4.27).
    """
def chamber_pressure_rate(params: Params, chamber: str, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], inflow: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], outflow: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Rate of pressure, Pa/s (eq. 4.30, 4.32); flows in kg/s.
    """
def chamber_volume(params: Params, chamber: str, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Volume, m^3 (eq. 4.31), tube included.
    """
def charge_flow(params: Params, opening: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], law: str = 'iso_0_4_mpa') -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (C, b, m) of the port that is fed at an opening of |command - centre|, V.
    """
def chirp(time: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], amplitude: typing.SupportsFloat | typing.SupportsIndex, first: typing.SupportsFloat | typing.SupportsIndex, last: typing.SupportsFloat | typing.SupportsIndex, duration: typing.SupportsFloat | typing.SupportsIndex) -> typing.Any:
    """
    The chirp of eq. 7.3, in the unit of the amplitude; frequencies in Hz, times in s.
    """
def chirp_frequency(time: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], first: typing.SupportsFloat | typing.SupportsIndex, last: typing.SupportsFloat | typing.SupportsIndex, duration: typing.SupportsFloat | typing.SupportsIndex) -> typing.Any:
    """
    Its frequency, Hz.
    """
def classic_mass_flow(params: Params, area: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_from: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_to: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Mass flow through an orifice, kg/s (eq. 4.20 to 4.22); area m^2, pressures Pa absolute, temperature K.
    """
def closed_loop(velocity_gain: typing.SupportsFloat | typing.SupportsIndex, natural_frequency: typing.SupportsFloat | typing.SupportsIndex, damping_ratio: typing.SupportsFloat | typing.SupportsIndex, position: typing.SupportsFloat | typing.SupportsIndex, velocity: typing.SupportsFloat | typing.SupportsIndex = 0.0, acceleration: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> tuple[float, float, float]:
    """
    (square, linear, constant) of the denominator s^3 + square s^2 + linear s + constant under the gains given (eq. 8.4, 8.5); the numerator is the constant.
    """
def command_crc(identifier: typing.SupportsInt | typing.SupportsIndex, challenge: typing.SupportsInt | typing.SupportsIndex, data: bytes) -> int:
    """
    The CRC of a command frame (docs/protocol.md): what its first octet has to be; data are its 8 octets.
    """
def command_mac(key: bytes, nonce: typing.SupportsInt | typing.SupportsIndex, counter: typing.SupportsInt | typing.SupportsIndex, identifier: typing.SupportsInt | typing.SupportsIndex, data: bytes) -> int:
    """
    The MAC of a command frame (docs/protocol.md), 40 bits: SipHash-2-4 with a key of 16 octets over nonce, data, counter and identifier.
    """
def conditioning(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 6) poses -> (n, 2) condition numbers of rods and of all links, status.
    """
def dac_filter(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], dt: typing.SupportsFloat | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
    """
    What the filter behind the pulse width makes of a record (n,), V, each sample held for dt.
    """
def dead_band_coefficient(params: Params) -> float:
    """
    a (eq. 7.6)
    """
def dead_band_gain(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Slope of the dead-band compensation (eq. 7.7).
    """
def discharge_flow(params: Params, opening: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], law: str = 'iso_0_4_mpa') -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (C, b, m) of the port that is vented at an opening of |command - centre|, V.
    """
def dynamics_terms(params: Params, masses: typing.SupportsInt | typing.SupportsIndex, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qdot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 32) sms_dynamics, status.
    """
def firmware_hash() -> int:
    """
    Hash over params.def and settings.def, params_hash of the bus.
    """
def firmware_settings() -> list[FirmwareSetting]:
    """
    The list of settings.def; parameter_index on the bus is that of params.def below it.
    """
def fit(problem: Problem, start: Params, free: collections.abc.Sequence[tuple[str, typing.SupportsFloat | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex, typing.SupportsFloat | typing.SupportsIndex]], weight: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] = ..., max_iterations: typing.SupportsInt | typing.SupportsIndex = 100, tolerance: typing.SupportsFloat | typing.SupportsIndex = 1e-12, huber: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> Fit:
    """
    Least squares over the parameters free = [(name, lower, upper, pull), ...], by Huber's loss beyond `huber` weighted units; ValueError for a bad start and for a parameter to which the records are insensitive.
    """
def force_balance(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], mass: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], drive: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], deflection: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] = 0.0, law: str = 'acceleration_dependent') -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (acceleration, m/s^2; friction, N; rate of the seals' deflection, m/s) of mass a = drive - friction, solved for a where friction depends on it; drive, N, is all other force, deflection, m, that of the seals. law: acceleration_dependent, two_branch, stribeck, dahl, lugre.
    """
def force_range(params: Params) -> tuple[float, float]:
    """
    What a cylinder can push and pull with, N.
    """
def force_share(params: Params, force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    """
    (n, 3) actuator forces -> (n, 1) largest share of what the supply pressure gives.
    """
def forward_dynamics(params: Params, masses: typing.SupportsInt | typing.SupportsIndex, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qdot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], external_force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], external_moment: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 3) q'', status.
    """
def forward_kinematics(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) extension -> (n, 6) pose (roll, pitch, height, yaw, x, y), Newton steps, residual, status.
    """
def forward_motion(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], extension_rate: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], extension_acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 18) sms_motion, status.
    """
def frequency_response(square: typing.SupportsFloat | typing.SupportsIndex, linear: typing.SupportsFloat | typing.SupportsIndex, constant: typing.SupportsFloat | typing.SupportsIndex, frequency: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (amplitude ratio, phase in rad) of the closed loop over frequencies in Hz.
    """
def friction(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Friction force, N (eq. 6.5 to 6.7 with its effects).
    """
def friction_stribeck(params: Params, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    The simple friction law, N (eq. 4.33).
    """
def gains_situm(velocity_gain: typing.SupportsFloat | typing.SupportsIndex, natural_frequency: typing.SupportsFloat | typing.SupportsIndex, damping_ratio: typing.SupportsFloat | typing.SupportsIndex, alpha: typing.SupportsFloat | typing.SupportsIndex, as_printed: bool = False) -> tuple[float, float, float]:
    """
    (K_p, K_v, K_a), eq. 8.8 to 8.10; as_printed keeps the misprint of eq. 8.9.
    """
def gains_specification_based(velocity_gain: typing.SupportsFloat | typing.SupportsIndex, natural_frequency: typing.SupportsFloat | typing.SupportsIndex, damping_ratio: typing.SupportsFloat | typing.SupportsIndex, alpha: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, float, float]:
    """
    (K_p, K_v, K_a), eq. 8.13 to 8.15.
    """
def inverse_dynamics(params: Params, masses: typing.SupportsInt | typing.SupportsIndex, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qdot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qddot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], external_force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], external_moment: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 3) actuator forces, status.
    """
def inverse_kinematics(params: Params, roll: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pitch: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], height: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n,) each -> (n, 6) pose, (n, 3) extension, Newton steps, residual, status.
    """
def inverse_motion(params: Params, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qdot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], qddot: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 18) sms_motion, status.
    """
def is_stable(square: typing.SupportsFloat | typing.SupportsIndex, linear: typing.SupportsFloat | typing.SupportsIndex, constant: typing.SupportsFloat | typing.SupportsIndex) -> bool:
    """
    Routh and Hurwitz.
    """
def iso_mass_flow(params: Params, sonic_conductance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], critical_ratio: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], subsonic_index: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_from: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_to: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], temperature: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Mass flow through a component, kg/s (eq. 5.8, 5.9); C in m^3/(s Pa), pressures Pa absolute, temperature K.
    """
def jacobian(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 6) poses -> (n, 9) d extension / d(roll, pitch, height), status.
    """
def joint_angles(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 6) poses -> (n, 12) turn of base, then platform joints, rad, status.
    """
def largest_stable_gain(velocity_gain: typing.SupportsFloat | typing.SupportsIndex, natural_frequency: typing.SupportsFloat | typing.SupportsIndex, damping_ratio: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Largest K_p of a stable loop, V/m.
    """
def linearise(params: Params, masses: typing.SupportsInt | typing.SupportsIndex, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], stiffness: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], damping: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) each -> (n, 96) sms_linear_model, status.
    """
def mass_models() -> list[str]:
    """
    The names of sms_mass_model, in its order.
    """
def orifice_area(params: Params, spool: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Area of one port, m^2 (eq. 4.4), spool in m.
    """
def over_dead_band(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Dead-band compensation, V (eq. 7.5).
    """
def pack_frame(name: str, values: dict) -> bytes:
    """
    The firmware's codec: 8 octets of a frame from its signals; physical ones as float, others as int.
    """
def parameter_table() -> list[ParameterInfo]:
    """
    Every parameter, in the order of params.def.
    """
def pid(params: Params, error: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], limit: typing.SupportsFloat | typing.SupportsIndex = 5.0, anti_windup: bool = False) -> numpy.typing.NDArray[numpy.float64]:
    """
    Output of the PID controller from rest, V (eq. 7.4); error (n,), m, one sample a control_period.
    """
def poles(square: typing.SupportsFloat | typing.SupportsIndex, linear: typing.SupportsFloat | typing.SupportsIndex, constant: typing.SupportsFloat | typing.SupportsIndex) -> list[complex]:
    """
    The three poles, rad/s.
    """
def pose_jacobian(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 6) poses -> (n, 18) d extension / d pose, status.
    """
def pulse_width_voltage(params: Params, command: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    The mean voltage of the pulses for a command, V.
    """
def raise_status(status: typing.SupportsInt | typing.SupportsIndex, message: str) -> typing.Never:
    """
    Raises the exception of a status other than 0.
    """
def reach(params: Params, direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) height, unit vector of (roll, pitch) -> (n, 1) largest angle, rad, status.
    """
def rectangle_margin(params: Params, rectangle: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 3) height, roll limit, pitch limit -> (n, 1) least stroke margin on the edges, m, status.
    """
def reservoir_pressure_rate(params: Params, pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], drawn: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Rate of pressure in the reservoir, Pa/s; drawn kg/s.
    """
def rod_force(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Force of the rod on its load, N (eq. 6.4).
    """
def sampled_extension(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    What the controller takes for the extension, m: potentiometer, ADC.
    """
def signal_table() -> list[SignalInfo]:
    """
    Every measured signal, in the order of signals.def.
    """
def simplified_plant(params: Params, mean_pressure: typing.SupportsFloat | typing.SupportsIndex, mass: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, float]:
    """
    (natural frequency, rad/s; damping ratio), eq. 8.2 and 8.3; Pa absolute, kg.
    """
def six_leg_inverse(params: Params, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.int32]]:
    """
    (n, 6) free poses -> (n, 6) lengths of all links, status.
    """
def sonic_conductance(params: Params, area: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    C of an orifice, m^3/(s Pa) (eq. 5.10).
    """
def spool_cubic(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Spool over command, m (eq. 4.1), not clamped.
    """
def spool_linear(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Spool over command, m (eq. 4.2), not clamped.
    """
def state_feedback(params: Params, setpoint: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    """
    Output of the state feedback from rest, V (Figure 8.3); records (n,), m, one sample a control_period.
    """
def status_string(status: typing.SupportsInt | typing.SupportsIndex) -> str:
    """
    What a status means, in a few words.
    """
def stroke_margin(params: Params, extension: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    """
    (n, 3) -> (n, 1) m.
    """
def tank_pressure_rate(params: Params, sonic_conductance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], critical_ratio: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], subsonic_index: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_outside: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Rate of pressure in the tank, Pa/s (eq. 5.5 with 5.8).
    """
def thermocouple_temperature(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], cold_junction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Temperature, K (eq. 5.11, 5.12), from the amplified voltage and the cold junction's temperature, K.
    """
def tube_delay(params: Params) -> float:
    """
    s
    """
def tube_transmission(params: Params, mass_flow: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Part of a mass flow that the tube lets through.
    """
def unpack_frame(name: str, data: bytes) -> typing.Any:
    """
    The firmware's codec: the signals of a frame; None when the frame is not whole.
    """
def uses_avx2() -> bool:
    """
    Whether this copy of the core was compiled with AVX2.
    """
def valve_command(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> typing.Any:
    """
    Command at the valve, V, from the controller's output, compensated.
    """
def valve_mass_flow(params: Params, voltage: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_supply: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], pressure_exhaust: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], law: str = 'iso_0_4_mpa') -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    (supply to lower, lower to exhaust, supply to upper, upper to exhaust), kg/s, mass_flow_gain and leaks included; pressures Pa absolute.
    """
def valve_table(law: str) -> dict[str, numpy.typing.NDArray[numpy.float64]]:
    """
    The rows of a measured table, arrays (28,): spool [m], opening [V], charge_ and discharge_ C [m^3/(s Pa)], b, m.
    """
__version__: str = '0.2.0'
build_info: str = 'libsms 0.2.0 float+double c++201402L no-exceptions no-rtti'
has_estimation: bool = True
largest_angle: float = 0.6
