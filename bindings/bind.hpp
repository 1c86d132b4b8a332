// What the files of the bindings share: one function each that adds a subject to the module.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "sms/params.hpp"

namespace sms_python {

namespace py = pybind11;
using Params = sms::Params<double>;

void bind_status(py::module_& m);
void bind_params(py::module_& m);
void bind_cylinder(py::module_& m);
void bind_kinematics(py::module_& m);
void bind_parallel_mechanism(py::module_& m);
void bind_dynamics(py::module_& m);
void bind_pneumatics(py::module_& m);
void bind_friction(py::module_& m);
void bind_controller(py::module_& m);
void bind_plant(py::module_& m);
void bind_firmware(py::module_& m);
void bind_virtual_rig(py::module_& m);
void bind_fmu(py::module_& m);
#ifdef SMS_WITH_ESTIMATION
void bind_estimation(py::module_& m);
void bind_platform_problem(py::module_& m);
void bind_equations(py::module_& m);
#endif

// Raises the Python exception that belongs to a status other than SMS_OK.
[[noreturn]] void raise_status(sms_status status, const std::string& message);

// ParamIndex of a name; KeyError naming the nearest right ones is Python's part (sms.parameters).
int param_index(const std::string& name);

}  // namespace sms_python
