// Two numbers side by side, so that one template works on two links at once: actuator i and Panhard rod i obey the same
// equations. Every operation on a Pair is the operation on either half, and rounds as that does; for double a desk
// processor takes both in one instruction.
#pragma once

#include <cmath>

#include "sms/scalar.hpp"

namespace sms {

namespace detail {
template <typename S>
struct Both {
  S first, second;
  Both operator+(const Both& b) const { return {first + b.first, second + b.second}; }
  Both operator-(const Both& b) const { return {first - b.first, second - b.second}; }
  Both operator*(const Both& b) const { return {first * b.first, second * b.second}; }
  Both operator/(const Both& b) const { return {first / b.first, second / b.second}; }
  Both operator-() const { return {-first, -second}; }
  static S first_of(const Both& b) { return b.first; }
  static S second_of(const Both& b) { return b.second; }
};
template <typename S>
struct BothOf : Both<S> {
  using type = Both<S>;
};
#if defined(__GNUC__) && (defined(__SSE2__) || defined(__aarch64__))
template <>
struct BothOf<double> {
  using type = double __attribute__((vector_size(16)));
  static double first_of(const type& b) { return b[0]; }
  static double second_of(const type& b) { return b[1]; }
};
#endif
}  // namespace detail

template <typename S>
class Pair {
 public:
  using Of = detail::BothOf<S>;
  using Both = typename Of::type;
  Pair() = default;
  explicit Pair(int both) : Pair(S(both)) {}
  explicit Pair(const S& both) : Pair(both, both) {}
  Pair(const S& actuator, const S& rod) : both_{actuator, rod} {}
  S actuator() const { return Of::first_of(both_); }
  S rod() const { return Of::second_of(both_); }
  S sum() const { return actuator() + rod(); }

  friend Pair operator+(const Pair& a, const Pair& b) { return Pair(Both(a.both_ + b.both_)); }
  friend Pair operator-(const Pair& a, const Pair& b) { return Pair(Both(a.both_ - b.both_)); }
  friend Pair operator*(const Pair& a, const Pair& b) { return Pair(Both(a.both_ * b.both_)); }
  friend Pair operator/(const Pair& a, const Pair& b) { return Pair(Both(a.both_ / b.both_)); }
  friend Pair operator-(const Pair& a) { return Pair(Both(-a.both_)); }
  Pair& operator+=(const Pair& b) { return *this = *this + b; }
  Pair& operator-=(const Pair& b) { return *this = *this - b; }
  Pair& operator*=(const Pair& b) { return *this = *this * b; }
  friend Pair sqrt(const Pair& a) {
    using std::sqrt;
    return Pair(S(sqrt(a.actuator())), S(sqrt(a.rod())));
  }

 private:
  explicit Pair(const Both& both) : both_(both) {}
  Both both_;
};

// a's in the first half and b's in the second; the same number in both.
template <typename S, int R, int C>
inline Eigen::Matrix<Pair<S>, R, C> pair_of(const Eigen::Matrix<S, R, C>& a, const Eigen::Matrix<S, R, C>& b) {
  Eigen::Matrix<Pair<S>, R, C> pair;
  for (int i = 0; i < R * C; ++i) {
    pair(i % R, i / R) = Pair<S>(a(i % R, i / R), b(i % R, i / R));
  }
  return pair;
}

template <typename S, int R, int C>
inline Eigen::Matrix<Pair<S>, R, C> pair_of(const Eigen::Matrix<S, R, C>& both) {
  return pair_of(both, both);
}

template <typename S, int R, int C>
inline Eigen::Matrix<S, R, C> sum(const Eigen::Matrix<Pair<S>, R, C>& pair) {
  Eigen::Matrix<S, R, C> both;
  for (int i = 0; i < R * C; ++i) {
    both(i % R, i / R) = pair(i % R, i / R).sum();
  }
  return both;
}

}  // namespace sms

namespace Eigen {
template <typename S>
struct NumTraits<sms::Pair<S>> : NumTraits<S> {
  using Real = sms::Pair<S>;
  using NonInteger = sms::Pair<S>;
  using Nested = sms::Pair<S>;
  using Literal = sms::Pair<S>;
};
}  // namespace Eigen
