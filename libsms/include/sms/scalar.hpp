// What the templates need to know of their scalar, and the fixed-size vectors they are written in.
//
// S is float on the controller, double in simulation, a Jet in a fit: a number `a` with derivatives `v`
// (estimation/jet.hpp). ValueOf<Jet<N>> is double, ValueOf of a plain number is itself. An iterated solution runs in
// ValueOf<S> and ends with one Newton step in S: by the implicit function theorem that step carries the exact first
// derivatives.
#pragma once

#include <Eigen/Core>
#include <type_traits>
#include <utility>

namespace sms {

template <typename S>
using Vec3 = Eigen::Matrix<S, 3, 1>;
template <typename S>
using Mat3 = Eigen::Matrix<S, 3, 3>;

namespace detail {
template <typename...>
struct Void {
  using type = void;
};
template <typename S, typename = void>
struct Value {
  using type = S;
  static const S& of(const S& s) { return s; }
};
template <typename Jet>
struct Value<Jet, typename Void<decltype(std::declval<Jet>().a), decltype(std::declval<Jet>().v)>::type> {
  using type = typename std::decay<decltype(std::declval<Jet>().a)>::type;
  static const type& of(const Jet& s) { return s.a; }
};
}  // namespace detail

template <typename S>
using ValueOf = typename detail::Value<S>::type;

template <typename S>
ValueOf<S> value_of(const S& s) {
  return detail::Value<S>::of(s);
}

template <typename S>
Vec3<ValueOf<S>> value_of(const Vec3<S>& v) {
  return {value_of(v(0)), value_of(v(1)), value_of(v(2))};
}

template <typename S>
Mat3<ValueOf<S>> value_of(const Mat3<S>& m) {
  Mat3<ValueOf<S>> value;
  for (int i = 0; i < 9; ++i) {
    value(i % 3, i / 3) = value_of(m(i % 3, i / 3));
  }
  return value;
}

// Neither NaN nor infinite.
template <typename S>
bool is_finite(const S& s) {
  const ValueOf<S> value = value_of(s);
  return value - value >= ValueOf<S>(0);
}

template <typename S>
bool is_finite(const Vec3<S>& v) {
  return is_finite(v(0)) && is_finite(v(1)) && is_finite(v(2));
}

template <typename S>
inline Vec3<S> cross(const Vec3<S>& a, const Vec3<S>& b) {
  return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
}

// By cofactors, without a pivot or a branch: enough for the matrices of this mechanism, whose condition numbers stay
// below 2.
template <typename S>
inline Mat3<S> inverse(const Mat3<S>& m) {
  const Vec3<S> a = m.col(0), b = m.col(1), c = m.col(2);
  const Vec3<S> b_c = cross(b, c);
  const S scale = S(1) / a.dot(b_c);
  Mat3<S> result;
  result.row(0) = scale * b_c;
  result.row(1) = scale * cross(c, a);
  result.row(2) = scale * cross(a, b);
  return result;
}

// x of m x = right, likewise: Cramer's rule.
template <typename S>
inline Vec3<S> solution(const Mat3<S>& m, const Vec3<S>& right) {
  const Vec3<S> a = m.col(0), b = m.col(1), c = m.col(2);
  const Vec3<S> b_c = cross(b, c);
  const S scale = S(1) / a.dot(b_c);
  return {scale * b_c.dot(right), scale * cross(c, a).dot(right), scale * cross(a, b).dot(right)};
}

}  // namespace sms
