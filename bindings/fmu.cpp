// The functions of an FMU for model exchange, called for many states of one instance: one call from Python where ctypes
// would need four for each state. Functions and instance are fmpy's, by their addresses; FMI 2.0 and 3.0 differ in one
// argument.
#include "rows.hpp"

namespace sms_python {
namespace {

using References = std::vector<std::uint32_t>;

template <typename Function>
Function* at(std::uintptr_t address) {
  return reinterpret_cast<Function*>(address);
}

// Status 0 is OK and 1 a warning, in either standard.
bool ok(int status) { return status == 0 || status == 1; }

class FmuCalls {
 public:
  FmuCalls(int version, std::uintptr_t instance, std::uintptr_t set_states, std::uintptr_t set_values,
           std::uintptr_t get_rates, std::uintptr_t get_values, std::uintptr_t get_directional, References states,
           References rates, References inputs, References outputs)
      : three_(version == 3),
        instance_(at<void>(instance)),
        set_states_(set_states),
        set_values_(set_values),
        get_rates_(get_rates),
        get_values_(get_values),
        get_directional_(get_directional),
        states_(std::move(states)),
        rates_(std::move(rates)),
        inputs_(std::move(inputs)),
        outputs_(std::move(outputs)) {
    if (version != 2 && version != 3) {
      throw py::value_error("the version of FMI is 2 or 3");
    }
    if (instance == 0 || set_states == 0 || set_values == 0 || get_rates == 0 || get_values == 0) {
      throw py::value_error("an instance and its functions are needed");
    }
    if (states_.size() != rates_.size()) {
      throw py::value_error("each state has a rate");
    }
  }

  // Rows (n, states) of rates; NaN where the FMU does not answer.
  Rows rates(const Rows& x, const Rows& u) const {
    return of_each(x, u, states_.size(), [this](double* out) { return ok(rates_at(out)); });
  }

  // Rows (n, outputs).
  Rows readings(const Rows& x, const Rows& u) const {
    return of_each(x, u, outputs_.size(), [this](double* out) { return ok(values_at(out)); });
  }

  // Rows (n, states * states): of each state in turn, the derivatives of all rates.
  Rows rate_slopes(const Rows& x, const Rows& u) const { return slopes(x, u, rates_); }

  // Rows (n, states * outputs).
  Rows reading_slopes(const Rows& x, const Rows& u) const { return slopes(x, u, outputs_); }

 private:
  template <typename Call>
  Rows of_each(const Rows& x, const Rows& u, std::size_t width, const Call& call) const {
    const py::ssize_t n = row_count(x, py::ssize_t(states_.size()));
    if (row_count(u, py::ssize_t(inputs_.size())) != n) {
      throw py::value_error("as many rows of inputs as of states are needed");
    }
    const Output out(n, py::ssize_t(width));
    for (py::ssize_t i = 0; i < n; ++i) {
      if (!(ok(place(x.data() + i * py::ssize_t(states_.size()), u.data() + i * py::ssize_t(inputs_.size()))) &&
            call(out.row(i)))) {
        out.clear(i);
      }
    }
    return out.array();
  }

  Rows slopes(const Rows& x, const Rows& u, const References& unknown) const {
    if (get_directional_ == 0) {
      throw py::value_error("this FMU has no directional derivatives");
    }
    return of_each(x, u, states_.size() * unknown.size(), [this, &unknown](double* out) {
      bool done = true;
      for (std::size_t k = 0; k < states_.size(); ++k, out += unknown.size()) {
        done = done && ok(directional(unknown, states_[k], out));
      }
      return done;
    });
  }

  int place(const double* x, const double* u) const {
    const int status = at<int(void*, const double*, std::size_t)>(set_states_)(instance_, x, states_.size());
    if (!ok(status) || inputs_.empty()) {
      return status;
    }
    const std::size_t n = inputs_.size();
    return three_ ? at<int(void*, const std::uint32_t*, std::size_t, const double*, std::size_t)>(set_values_)(
                        instance_, inputs_.data(), n, u, n)
                  : at<int(void*, const std::uint32_t*, std::size_t, const double*)>(set_values_)(instance_,
                                                                                                  inputs_.data(), n, u);
  }

  int rates_at(double* out) const {
    return at<int(void*, double*, std::size_t)>(get_rates_)(instance_, out, states_.size());
  }

  int values_at(double* out) const {
    const std::size_t n = outputs_.size();
    return three_ ? at<int(void*, const std::uint32_t*, std::size_t, double*, std::size_t)>(get_values_)(
                        instance_, outputs_.data(), n, out, n)
                  : at<int(void*, const std::uint32_t*, std::size_t, double*)>(get_values_)(instance_, outputs_.data(),
                                                                                            n, out);
  }

  int directional(const References& unknown, std::uint32_t known, double* out) const {
    using R = const std::uint32_t*;
    const double seed = 1.0;
    const std::size_t n = unknown.size();
    return three_ ? at<int(void*, R, std::size_t, R, std::size_t, const double*, std::size_t, double*, std::size_t)>(
                        get_directional_)(instance_, unknown.data(), n, &known, 1, &seed, 1, out, n)
                  : at<int(void*, R, std::size_t, R, std::size_t, const double*, double*)>(get_directional_)(
                        instance_, unknown.data(), n, &known, 1, &seed, out);
  }

  bool three_;
  void* instance_;
  std::uintptr_t set_states_, set_values_, get_rates_, get_values_, get_directional_;
  References states_, rates_, inputs_, outputs_;
};

}  // namespace

void bind_fmu(py::module_& m) {
  py::class_<FmuCalls>(m, "FmuCalls",
                       "Functions of an instance of an FMU for model exchange, by their addresses (0: none), and the "
                       "value references of its states, their rates, inputs and outputs. ValueError for what is none.")
      .def(py::init<int, std::uintptr_t, std::uintptr_t, std::uintptr_t, std::uintptr_t, std::uintptr_t, std::uintptr_t,
                    References, References, References, References>(),
           py::arg("version"), py::arg("instance"), py::arg("set_states"), py::arg("set_values"), py::arg("get_rates"),
           py::arg("get_values"), py::arg("get_directional"), py::arg("states"), py::arg("rates"), py::arg("inputs"),
           py::arg("outputs"))
      .def("rates", &FmuCalls::rates, py::arg("x"), py::arg("u"),
           "(n, states) rates at states (n, states) and inputs (n, inputs); NaN where the FMU does not answer.")
      .def("readings", &FmuCalls::readings, py::arg("x"), py::arg("u"), "(n, outputs), in the same way.")
      .def("rate_slopes", &FmuCalls::rate_slopes, py::arg("x"), py::arg("u"),
           "(n, states * states): of each state in turn, the derivatives of all rates.")
      .def("reading_slopes", &FmuCalls::reading_slopes, py::arg("x"), py::arg("u"),
           "(n, states * outputs), in the same way.");
}

}  // namespace sms_python
