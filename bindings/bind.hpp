// What the files of the bindings share: one function each that adds a subject to the module.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <type_traits>

#include "sms/params.hpp"

namespace sms_python {

namespace py = pybind11;
using Params = sms::Params<double>;

// Doubles of a numpy array, as far apart as numpy keeps them or, in order, as C would; copied where they lie at
// addresses at which no double may lie, as in a field of packed records.
constexpr int kAnyOrder = py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;
constexpr int kInOrder = kAnyOrder | py::array::c_style;

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

// As a sentence has it.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

// NotANumberError for one that no converter could have read.
inline void need_finite(double value, const char* name) {
  if (!std::isfinite(value)) {
    raise_status(SMS_NOT_A_NUMBER, std::string(name) + " is not a finite number");
  }
}

// A step of time, s: ValueError for one that is none, or so short or long that a count of steps is no int.
inline double time_step(const char* name, double value) {
  constexpr double kLeast = 1e-7, kMost = 1e6;
  if (!(value >= kLeast && value <= kMost)) {
    throw py::value_error(std::string(name) + " = " + number(value) + " s; a step of time above zero is needed, from " +
                          number(kLeast) + " to " + number(kMost) + " s");
  }
  return value;
}

// What Python gives as a number of type Number; TypeError that names it.
template <typename Number>
Number number_of(const py::handle& given, const std::string& name) {
  py::detail::make_caster<Number> number;
  if (!number.load(given, true)) {
    PyErr_Clear();
    throw py::type_error(name + " has to be " + (std::is_integral<Number>::value ? "an unsigned integer" : "a number") +
                         ", not " + Py_TYPE(given.ptr())->tp_name);
  }
  return py::detail::cast_op<Number>(number);
}

// ParamIndex of a name; KeyError naming the nearest right ones is Python's part (sms.parameters).
int param_index(const std::string& name);

}  // namespace sms_python
