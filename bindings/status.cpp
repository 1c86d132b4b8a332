// One Python exception per status of the C ABI, all of them ValueErrors.
#include "choice.hpp"

namespace sms_python {
namespace {

struct StatusException {
  sms_status status;
  const char* name;
  PyObject* type;
};

StatusException exceptions[] = {
    {SMS_NOT_A_NUMBER, "NotANumberError", nullptr},
    {SMS_OUT_OF_RANGE, "OutOfRangeError", nullptr},
    {SMS_OUT_OF_WORKSPACE, "OutOfWorkspaceError", nullptr},
    {SMS_NOT_CONVERGED, "NotConvergedError", nullptr},
};

constexpr int kStatuses = SMS_WRONG_ABI + 1;

}  // namespace

void bind_status(py::module_& m) {
  const auto add = [&m](const char* name, const std::string& doc, PyObject* base) {
    PyObject* type = PyErr_NewExceptionWithDoc((std::string("sms._core.") + name).c_str(), doc.c_str(), base, nullptr);
    m.add_object(name, py::reinterpret_borrow<py::object>(type));
    return type;
  };
  PyObject* base = add("StatusError", "A call into the core failed; nothing was changed.", PyExc_ValueError);
  for (StatusException& e : exceptions) {
    e.type = add(e.name, std::string("Raised when ") + sms_status_string(e.status) + ".", base);
  }
  m.def(
      "raise_status",
      [](int status, const std::string& message) -> py::typing::Never {
        raise_status(choice<sms_status>("status", status, kStatuses), message);
      },
      py::arg("status"), py::arg("message"), "Raises the exception of a status other than 0.");
  m.def(
      "status_string", [](int status) { return sms_status_string(choice<sms_status>("status", status, kStatuses)); },
      py::arg("status"), "What a status means, in a few words.");
}

void raise_status(sms_status status, const std::string& message) {
  for (const StatusException& e : exceptions) {
    if (e.status == status) {
      PyErr_SetObject(e.type, py::str(message).ptr());  // all of it: PyErr_SetString ends at a zero
      throw py::error_already_set();
    }
  }
  throw std::runtime_error(message);
}

}  // namespace sms_python
