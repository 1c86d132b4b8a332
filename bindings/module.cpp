#include "bind.hpp"

namespace py = pybind11;

// As the compiler sees it, not as a build script believes it to be.
#ifdef __AVX2__
constexpr bool kAvx2 = true;
#else
constexpr bool kAvx2 = false;
#endif

namespace {

// pybind11 gives Params.__new__(Params) memory that no constructor has filled, and hands it to a method as it is. A
// slot of its own in each class has Python refuse __new__ with a TypeError; a call of the class goes through the slot,
// and then through the constructor.
newfunc pybind11_new = nullptr;

PyObject* new_before_constructor(PyTypeObject* type, PyObject* args, PyObject* kwargs) {
  return pybind11_new(type, args, kwargs);
}

void only_by_constructors(const py::module_& m) {
  for (const auto& member : m.attr("__dict__").cast<py::dict>()) {
    if (py::isinstance(member.second, reinterpret_cast<PyObject*>(py::detail::get_internals().default_metaclass))) {
      PyTypeObject* const type = reinterpret_cast<PyTypeObject*>(member.second.ptr());
      pybind11_new = pybind11_new == nullptr ? type->tp_new : pybind11_new;
      type->tp_new = &new_before_constructor;
    }
  }
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  m.doc() = "The C++ core of sms: parameters, equations, estimation. Use it through the package sms.";
  m.attr("__version__") = sms_version();
  m.attr("build_info") = sms_build_info();
  m.def(
      "uses_avx2", [] { return kAvx2; }, "Whether this copy of the core was compiled with AVX2.");
  sms_python::bind_status(m);
  sms_python::bind_params(m);
  sms_python::bind_cylinder(m);
  sms_python::bind_kinematics(m);
  sms_python::bind_parallel_mechanism(m);
  sms_python::bind_dynamics(m);
  sms_python::bind_pneumatics(m);
  sms_python::bind_friction(m);
  sms_python::bind_controller(m);
  sms_python::bind_plant(m);
  sms_python::bind_firmware(m);
  sms_python::bind_virtual_rig(m);
  sms_python::bind_fmu(m);
#ifdef SMS_WITH_ESTIMATION
  sms_python::bind_estimation(m);
  sms_python::bind_platform_problem(m);
  sms_python::bind_equations(m);
  m.attr("has_estimation") = true;
#else
  m.attr("has_estimation") = false;
#endif
  only_by_constructors(m);
}
