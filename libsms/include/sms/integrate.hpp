// A plant through time, in steps of a fixed size.
//
//   x' = f(t, x),    k1 = f(t, x)             k2 = f(t + h/2, x + h/2 k1)
//                    k3 = f(t + h/2, x + h/2 k2)    k4 = f(t + h, x + h k3)
//   x(t + h) = x + h/6 (k1 + 2 k2 + 2 k3 + k4)
//
// The classical Runge-Kutta method of fourth order. It does the same work in every step, which is what firmware in the
// loop needs, and it is a smooth function of its input, which is what a fit needs: in a Jet it carries the exact
// derivatives of the discrete solution. Explicit, so a step has to stay below 2.7 times the fastest time constant: 1 ms
// does for the spool, 0.2 ms for a chamber that is nearly closed and nearly empty or for contact at an end. For a step
// that finds its own size see integrate_adaptive.hpp.
//
// A state is a plain struct of S and nothing else; to the method it is a vector.
#pragma once

#include <type_traits>

#include "sms/scalar.hpp"
#include "sms/sms.h"

namespace sms {

template <typename State>
struct StateVector {
  using Scalar = typename State::Scalar;
  static_assert(std::is_standard_layout<State>::value && sizeof(State) % sizeof(Scalar) == 0, "a struct of S");
  static constexpr int size = int(sizeof(State) / sizeof(Scalar));
  using Vector = Eigen::Matrix<Scalar, size, 1>;
};

template <typename State>
Eigen::Map<typename StateVector<State>::Vector> vector_of(State& state) {
  return Eigen::Map<typename StateVector<State>::Vector>(reinterpret_cast<typename State::Scalar*>(&state));
}

template <typename State>
Eigen::Map<const typename StateVector<State>::Vector> vector_of(const State& state) {
  return Eigen::Map<const typename StateVector<State>::Vector>(reinterpret_cast<const typename State::Scalar*>(&state));
}

// One step of size h; f(t, state, rate) gives a status. On any but SMS_OK the state stays as it was.
template <typename State, typename Derivative>
sms_status runge_kutta_step(Derivative&& f, const typename State::Scalar& t, const typename State::Scalar& h,
                            State& state) {
  using S = typename State::Scalar;
  State k1, k2, k3, k4, at;
  const auto x = vector_of(state);
  auto moved = vector_of(at);
  sms_status status = f(t, const_cast<const State&>(state), k1);
  if (status != SMS_OK) {
    return status;
  }
  const S half = S(0.5) * h;
  moved = x + half * vector_of(k1);
  status = f(S(t + half), const_cast<const State&>(at), k2);
  if (status != SMS_OK) {
    return status;
  }
  moved = x + half * vector_of(k2);
  status = f(S(t + half), const_cast<const State&>(at), k3);
  if (status != SMS_OK) {
    return status;
  }
  moved = x + h * vector_of(k3);
  status = f(S(t + h), const_cast<const State&>(at), k4);
  if (status != SMS_OK) {
    return status;
  }
  vector_of(state) += (h / S(6)) * (vector_of(k1) + S(2) * (vector_of(k2) + vector_of(k3)) + vector_of(k4));
  return SMS_OK;
}

}  // namespace sms
