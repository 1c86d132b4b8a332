// Params: the struct of params.def with one checked attribute per parameter, and the list itself.
#include <pybind11/operators.h>

#include <cmath>

#include "bind.hpp"

namespace sms_python {
namespace {

void set_checked(Params& params, int index, double value) {
  const sms_param_info& info = *sms_param_describe(index);
  const std::string unit = info.unit == std::string("1") ? "" : std::string(" ") + info.unit;
  if (!std::isfinite(value)) {
    raise_status(SMS_NOT_A_NUMBER, std::string(info.name) + " is not a finite number; allowed are " +
                                       number(info.lower) + " to " + number(info.upper) + unit);
  }
  if (value < info.lower || value > info.upper) {
    raise_status(SMS_OUT_OF_RANGE, std::string(info.name) + " = " + number(value) + unit + " is outside " +
                                       number(info.lower) + " to " + number(info.upper) + unit);
  }
  sms::param(params, index) = value;
}

std::string represent(const Params& params) {
  std::string text;
  for (int i = 0; i < sms::param_count; ++i) {
    const double value = sms::param(params, i);
    if (value < sms_param_describe(i)->value || value > sms_param_describe(i)->value) {
      text += (text.empty() ? "" : ", ") + std::string(sms_param_describe(i)->name) + "=" + number(value);
    }
  }
  return "Params(" + text + ")";
}

// What signals.def says of one signal.
struct SignalInfo {
  const char* name;
  const char* unit;
  const char* label;
  double low, high, sweep, noise;
  bool of_leg;
  bool has_sensor;
};

const SignalInfo signal_table[] = {
#define SMS_SIGNAL(name, unit, label, low, high, sweep) {#name, unit, label, low, high, sweep, 0.0, false, false},
#define SMS_LEG_SIGNAL(name, unit, label, low, high, sweep) {#name, unit, label, low, high, sweep, 0.0, true, false},
#define SMS_LEG_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate, lag, clock, \
                       datum, from, to, low, high, sweep, noise)                                                  \
  {#name, unit, label, low, high, sweep, noise, true, true},
#define SMS_SENSOR(name, unit, zero, zero_known, gain_known, linearity_known, label, value, rate, lag, clock, datum, \
                   from, to, low, high, sweep, noise)                                                                \
  {#name, unit, label, low, high, sweep, noise, false, true},
#include "sms/signals.def"
};

bool equal(const Params& a, const Params& b) {
  for (int i = 0; i < sms::param_count; ++i) {
    if (sms::param(a, i) < sms::param(b, i) || sms::param(a, i) > sms::param(b, i)) {
      return false;
    }
  }
  return true;
}

}  // namespace

int param_index(const std::string& name) {
  for (int i = 0; i < sms::param_count; ++i) {
    if (name == sms_param_describe(i)->name) {
      return i;
    }
  }
  throw py::key_error("there is no parameter '" + name + "'");
}

void bind_params(py::module_& m) {
  py::class_<sms_param_info>(m, "ParameterInfo", "What params.def says of one parameter.")
      .def_readonly("name", &sms_param_info::name)
      .def_readonly("unit", &sms_param_info::unit, "SI, as pint reads it; '1' where there is none")
      .def_readonly("lower", &sms_param_info::lower)
      .def_readonly("default", &sms_param_info::value)
      .def_readonly("upper", &sms_param_info::upper)
      .def_readonly("uncertainty", &sms_param_info::uncertainty, "half width within which the default is believed")
      .def_readonly("source", &sms_param_info::source)
      .def_readonly("doc", &sms_param_info::doc);
  m.def(
      "parameter_table",
      [] {
        py::list table;
        for (int i = 0; i < sms_param_count(); ++i) {
          table.append(py::cast(sms_param_describe(i), py::return_value_policy::reference));
        }
        return py::typing::List<sms_param_info>(table);
      },
      "Every parameter, in the order of params.def.");

  py::class_<SignalInfo>(m, "SignalInfo", "What signals.def says of one signal.")
      .def_readonly("name", &SignalInfo::name)
      .def_readonly("unit", &SignalInfo::unit, "SI, as pint reads it")
      .def_readonly("label", &SignalInfo::label, "what is measured, in words")
      .def_readonly("low", &SignalInfo::low, "What such a sensor usually reads: no less,")
      .def_readonly("high", &SignalInfo::high, "and no more.")
      .def_readonly("sweep", &SignalInfo::sweep, "What a run usually sweeps; 0 where the signal may stand still.")
      .def_readonly("noise", &SignalInfo::noise, "Standard deviation of a sample where none is declared; 0: not known.")
      .def_readonly("of_leg", &SignalInfo::of_leg, "Each actuator of the platform has one.")
      .def_readonly("has_sensor", &SignalInfo::has_sensor, "There are parameters for the errors of its sensor.");
  m.def(
      "signal_table",
      [] {
        py::list table;
        for (const SignalInfo& signal : signal_table) {
          table.append(py::cast(&signal, py::return_value_policy::reference));
        }
        return py::typing::List<SignalInfo>(table);
      },
      "Every measured signal, in the order of signals.def.");

  py::class_<Params> params(m, "Params",
                            "Every parameter of the machine in SI units, at its default unless given by keyword.\n\n"
                            "Setting one checks its bounds: OutOfRangeError, NotANumberError.");
  params.def(py::init([](const py::kwargs& values) {
    Params p;
    for (const auto& item : values) {
      const char* const name = PyUnicode_AsUTF8(item.first.ptr());
      if (name == nullptr) {  // no text: half a pair of surrogates
        throw py::error_already_set();
      }
      set_checked(p, param_index(name), number_of<double>(item.second, name));
    }
    return p;
  }));
  for (int i = 0; i < sms::param_count; ++i) {
    const sms_param_info& info = *sms_param_describe(i);
    const std::string doc = std::string(info.doc) + " [" + info.unit + "]; " + info.source;
    params.def_property(
        info.name, [i](const Params& p) { return sms::param(p, i); },
        [i](Params& p, double value) { set_checked(p, i, value); }, doc.c_str());
  }
  params.def("__getitem__", [](const Params& p, const std::string& name) { return sms::param(p, param_index(name)); })
      .def("__setitem__",
           [](Params& p, const std::string& name, double value) { set_checked(p, param_index(name), value); })
      .def("copy", [](const Params& p) { return Params(p); })
      .def("__eq__", &equal, py::is_operator())
      .def("__repr__", &represent);
  params.attr("__hash__") = py::none();
}

}  // namespace sms_python
