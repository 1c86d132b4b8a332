// What the templates need to know of their scalar, and the fixed-size vectors they are written in.
//
// S is float on the controller, double in simulation, a Jet in a fit: a number `a` with derivatives `v`
// (estimation/jet.hpp). ValueOf<Jet<N>> is double, ValueOf of a plain number is itself. An iterated solution runs in
// ValueOf<S> and ends with one Newton step in S: by the implicit function theorem that step carries the exact first
// derivatives.
#pragma once

#include <Eigen/Core>
#include <cmath>
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

// A condition on a plain number is a bool, on several side by side (lanes.hpp) one for each. Templates for both ask all or
// any of it, take one of two values by it, or renew what they keep where it holds.
inline bool all(bool condition) { return condition; }
inline bool any(bool condition) { return condition; }
template <typename T>
inline T select(bool condition, const T& one, const T& other) {
  return condition ? one : other;
}

template <typename T>
inline void renew(bool condition, T& kept, const T& fresh) {
  if (condition) {
    kept = fresh;
  }
}

template <typename V>
inline V larger(const V& a, const V& b) {
  return select(a < b, b, a);
}

// Largest component, without its sign.
template <typename V>
inline V largest_magnitude(const Vec3<V>& v) {
  using std::abs;
  return larger(larger(abs(v(0)), abs(v(1))), abs(v(2)));
}

// Sums of three products in one order on every processor; Eigen's depends on how many numbers it multiplies at a time.
template <typename S>
inline S dot(const Vec3<S>& a, const Vec3<S>& b) {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}
template <typename S>
inline Vec3<S> product(const Mat3<S>& m, const Vec3<S>& v) {
  return {m(0, 0) * v(0) + m(0, 1) * v(1) + m(0, 2) * v(2), m(1, 0) * v(0) + m(1, 1) * v(1) + m(1, 2) * v(2),
          m(2, 0) * v(0) + m(2, 1) * v(1) + m(2, 2) * v(2)};
}

template <typename S>
inline Mat3<S> product(const Mat3<S>& a, const Mat3<S>& b) {
  Mat3<S> c;
  for (int k = 0; k < 3; ++k) {
    c.col(k) = product(a, Vec3<S>(b.col(k)));
  }
  return c;
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
  const S scale = S(1) / dot(a, b_c);
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
