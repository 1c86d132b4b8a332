// Equations with several results over numpy arrays that broadcast: one array a result, all of the common shape.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "bind.hpp"

namespace sms_python {

using Array = py::array_t<double, kInOrder>;

template <std::size_t Results, typename Equation, std::size_t... I>
std::array<Array, Results> broadcast(const Equation& equation, const std::array<Array, sizeof...(I)>& given,
                                     std::index_sequence<I...> /*each*/) {
  const py::tuple same(py::module_::import("numpy").attr("broadcast_arrays")(given[I]...));
  const std::array<Array, sizeof...(I)> arrays = {py::cast<Array>(same[I])...};
  const std::array<const double*, sizeof...(I)> in = {arrays[I].data()...};
  const std::vector<py::ssize_t> shape(arrays[0].shape(), arrays[0].shape() + arrays[0].ndim());
  std::array<Array, Results> results;
  std::array<double*, Results> out;
  for (std::size_t k = 0; k < Results; ++k) {
    results[k] = Array(shape);
    out[k] = results[k].mutable_data();
  }
  for (py::ssize_t i = 0; i < arrays[0].size(); ++i) {
    const std::array<double, Results> values = equation(in[I][i]...);
    for (std::size_t k = 0; k < Results; ++k) {
      out[k][i] = values[k];
    }
  }
  return results;
}

// equation(double...) returns std::array<double, Results>; all arrays broadcast against each other.
template <std::size_t Results, typename Equation, typename... Arrays>
std::array<Array, Results> broadcast(const Equation& equation, const Arrays&... arrays) {
  return broadcast<Results>(equation, std::array<Array, sizeof...(Arrays)>{arrays...},
                            std::make_index_sequence<sizeof...(Arrays)>());
}

// equation(double...) over arrays that broadcast: an array, or the number alone where all of them are numbers.
template <typename Equation, typename... Arrays>
py::object each(const Equation& equation, const Arrays&... arrays) {
  std::vector<py::ssize_t> common;
  for (const py::array* const array : {static_cast<const py::array*>(&arrays)...}) {
    const auto n = static_cast<std::size_t>(array->ndim());
    common.insert(common.begin(), n > common.size() ? n - common.size() : 0, 1);
    for (std::size_t k = 0; k < n; ++k) {
      py::ssize_t& size = common[common.size() - n + k];
      const py::ssize_t own = array->shape(static_cast<py::ssize_t>(k));
      if (own != size && own != 1 && size != 1) {
        throw py::value_error("arrays of " + std::to_string(size) + " and of " + std::to_string(own) +
                              " along one axis do not broadcast");
      }
      size = size == 1 ? own : size;
    }
  }
  return py::vectorize(equation)(arrays...);
}

using Two = py::typing::Tuple<Array, Array>;
using Three = py::typing::Tuple<Array, Array, Array>;
using Four = py::typing::Tuple<Array, Array, Array, Array>;

inline Two as_tuple(const std::array<Array, 2>& a) { return py::make_tuple(a[0], a[1]); }
inline Three as_tuple(const std::array<Array, 3>& a) { return py::make_tuple(a[0], a[1], a[2]); }
inline Four as_tuple(const std::array<Array, 4>& a) { return py::make_tuple(a[0], a[1], a[2], a[3]); }

}  // namespace sms_python
